//! The method of Dormand and Prince of order 5(4).

use super::{Coefficients, Embedded, Estimate, RungeKutta, Tableau};

/// The method of Dormand and Prince: order 5 with an estimate of order 4, 6 evaluations per step.
///
/// Interpolation of order 4, no further evaluation. For tolerances of 1e-3 to 1e-6.
pub type DormandPrince5 = RungeKutta<DormandPrince5Tableau>;

/// Coefficients: Hairer, Nørsett, Wanner I, table II.5.2; interpolation: subroutine DOPRI5 of the same book (d₁ to d₇).
#[derive(Debug, Clone, Copy)]
pub struct DormandPrince5Tableau;

impl Tableau for DormandPrince5Tableau {
    const COEFFICIENTS: Coefficients = Coefficients {
        order: 5,
        nodes: &[1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0],
        rows: &[
            &[(0, 1.0 / 5.0)],
            &[(0, 3.0 / 40.0), (1, 9.0 / 40.0)],
            &[(0, 44.0 / 45.0), (1, -56.0 / 15.0), (2, 32.0 / 9.0)],
            &[
                (0, 19372.0 / 6561.0),
                (1, -25360.0 / 2187.0),
                (2, 64448.0 / 6561.0),
                (3, -212.0 / 729.0),
            ],
            &[
                (0, 9017.0 / 3168.0),
                (1, -355.0 / 33.0),
                (2, 46732.0 / 5247.0),
                (3, 49.0 / 176.0),
                (4, -5103.0 / 18656.0),
            ],
        ],
        weights: &[
            (0, 35.0 / 384.0),
            (2, 500.0 / 1113.0),
            (3, 125.0 / 192.0),
            (4, -2187.0 / 6784.0),
            (5, 11.0 / 84.0),
        ],
        error: Estimate::WithNewDerivative(&[
            (0, 71.0 / 57600.0),
            (2, -71.0 / 16695.0),
            (3, 71.0 / 1920.0),
            (4, -17253.0 / 339200.0),
            (5, 22.0 / 525.0),
            (6, -1.0 / 40.0),
        ]),
        dense_nodes: &[],
        dense_rows: &[],
        dense: &[&[
            (0, -12715105075.0 / 11282082432.0),
            (2, 87487479700.0 / 32700410799.0),
            (3, -10690763975.0 / 1880347072.0),
            (4, 701980252875.0 / 199316789632.0),
            (5, -1453857185.0 / 822651844.0),
            (6, 69997945.0 / 29380423.0),
        ]],
    };
}

/// Step control of subroutine DOPRI5: β = 0.04.
impl Embedded for DormandPrince5Tableau {
    const EXPONENT: u32 = 5;
    const BETA: f64 = 0.04;
    const SAFETY: f64 = 0.9;
}

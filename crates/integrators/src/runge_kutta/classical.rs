//! The classical method of order 4.

use super::{Coefficients, Estimate, RungeKutta, Tableau};

/// The classical Runge-Kutta method: order 4, fixed step, 4 evaluations per step.
///
/// Interpolation by the cubic Hermite polynomial: order 3 between the steps (local error O(h⁴)), no further evaluation.
pub type Rk4 = RungeKutta<ClassicalTableau>;

/// Kutta's coefficients (Hairer, Nørsett, Wanner I, table II.1.2, left).
#[derive(Debug, Clone, Copy)]
pub struct ClassicalTableau;

impl Tableau for ClassicalTableau {
    const COEFFICIENTS: Coefficients = Coefficients {
        order: 4,
        nodes: &[0.5, 0.5, 1.0],
        rows: &[&[(0, 0.5)], &[(1, 0.5)], &[(2, 1.0)]],
        weights: &[(0, 1.0 / 6.0), (1, 1.0 / 3.0), (2, 1.0 / 3.0), (3, 1.0 / 6.0)],
        error: Estimate::None,
        dense_nodes: &[],
        dense_rows: &[],
        dense: &[],
    };
}

impl Rk4 {
    /// With steps of this length.
    #[must_use]
    pub fn new(step: f64) -> Self {
        Self::fixed(step)
    }
}

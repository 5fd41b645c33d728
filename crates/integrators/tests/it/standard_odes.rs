//! Problems of the test set for IVP solvers (benchmark 05-standard-odes) as data, for tests here and for comparisons elsewhere.

use linkdyn_integrators::{EvalError, Ode, SecondOrder};

/// A problem with its solution at the end.
#[derive(Clone, Copy, Debug)]
pub struct Standard {
    /// Name.
    pub name: &'static str,
    /// Right-hand side: t, y and what becomes y'.
    pub rhs: fn(f64, &[f64], &mut [f64]),
    /// State at t = 0.
    pub start: &'static [f64],
    /// End of the run.
    pub end: f64,
    /// State there, from the test set.
    pub exact: &'static [f64],
    /// Absolute tolerance in units of the relative one.
    pub ratio: f64,
}

impl Standard {
    /// Digits of the worst component at the end, relative to its value.
    pub fn digits(&self, y: &[f64]) -> f64 {
        let digits = |(y, exact): (&f64, &f64)| -((y - exact) / exact).abs().log10();
        let digits = y.iter().zip(self.exact).map(digits);
        // What is not a number has no digits.
        digits.fold(f64::INFINITY, |worst, d| if d >= worst { worst } else { d })
    }
}

impl Ode for Standard {
    fn dim(&self) -> usize {
        self.start.len()
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        (self.rhs)(t, y, dy);
        Ok(())
    }
}

impl SecondOrder for Standard {
    fn pairs(&self) -> usize {
        0
    }
}

/// Eight reactions with light.
pub const HIRES: Standard = Standard {
    name: "HIRES",
    rhs: |_, y, dy| {
        let reaction = 280.0 * y[5] * y[7];
        dy[0] = -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007;
        dy[1] = 1.71 * y[0] - 8.75 * y[1];
        dy[2] = -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4];
        dy[3] = 8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3];
        dy[4] = -1.745 * y[4] + 0.43 * (y[5] + y[6]);
        dy[5] = -reaction + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6];
        dy[6] = reaction - 1.81 * y[6];
        dy[7] = -dy[6];
    },
    start: &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057],
    end: 321.8122,
    exact: &[
        0.0007371312573325668,
        0.0001442485726316185,
        5.888729740967575e-05,
        0.001175651343283149,
        0.002386356198831331,
        0.006238968252742796,
        0.002849998395185769,
        0.002850001604814231,
    ],
    ratio: 1e-2,
};

/// Van der Pol's oscillator with a damping of 1000.
pub const VAN_DER_POL: Standard = Standard {
    name: "van der Pol",
    rhs: |_, y, dy| (dy[0], dy[1]) = (y[1], 1000.0 * (1.0 - y[0] * y[0]) * y[1] - y[0]),
    start: &[2.0, 0.0],
    end: 2000.0,
    exact: &[1.706167732170469, -0.0008928097010248125],
    ratio: 1.0,
};

/// Robertson's three reactions.
pub const ROBERTSON: Standard = Standard {
    name: "Robertson",
    rhs: |_, y, dy| {
        (dy[0], dy[2]) = (-0.04 * y[0] + 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
        dy[1] = -dy[0] - dy[2];
    },
    start: &[1.0, 0.0, 0.0],
    end: 1e11,
    exact: &[2.083340149701255e-08, 8.333360770334713e-14, 0.999999979166505],
    ratio: 1e-6,
};

/// Places, then speeds of the stars at t = 0.
pub const PLEIADES_START: [f64; 28] = [
    3.0, 3.0, -1.0, -3.0, 2.0, -2.0, 2.0, 3.0, -3.0, 2.0, 0.0, 0.0, -4.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.75, -1.5,
    0.0, 0.0, 0.0, -1.25, 1.0, 0.0, 0.0,
];
/// The same at t = 3.
pub const PLEIADES_END: [f64; 28] = [
    0.3706139143970502,
    3.237284092057233,
    -3.222559032418324,
    0.659709145577531,
    0.3425581707156584,
    1.562172101400631,
    -0.7003092922212495,
    -3.943437585517392,
    -3.27138097397255,
    5.225081843456543,
    -2.59061243497747,
    1.198213693392275,
    -0.2429682344935824,
    1.09144924042898,
    3.417003806314313,
    1.354584501625501,
    -2.590065597810775,
    2.025053734714242,
    -1.155815100160448,
    -0.8072988170223021,
    0.595239635420871,
    -3.74124496123401,
    0.377345968575063,
    0.9386858869551074,
    0.3667922227200571,
    -0.347404635380849,
    2.344915448180937,
    -1.947020434263292,
];

/// Seven stars in a plane (Hairer, Nørsett, Wanner I, II.10).
pub const PLEIADES: Standard = Standard {
    name: "Pleiades",
    rhs: |_, y, dy| {
        let (place, rate) = y.split_at(14);
        dy[..14].copy_from_slice(rate);
        for i in 0..7 {
            let (mut ax, mut ay) = (0.0, 0.0);
            for j in (0..7).filter(|&j| j != i) {
                let (dx, dy) = (place[j] - place[i], place[7 + j] - place[7 + i]);
                let pull = (j + 1) as f64 / (dx * dx + dy * dy).powf(1.5);
                ax += pull * dx;
                ay += pull * dy;
            }
            (dy[14 + i], dy[21 + i]) = (ax, ay);
        }
    },
    start: &PLEIADES_START,
    end: 3.0,
    exact: &PLEIADES_END,
    ratio: 1.0,
};

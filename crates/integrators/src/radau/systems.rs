//! The linear systems of a step: one real, one complex.

use num_complex::Complex64;

use crate::linear::Singular;
use crate::reduced::{Layout, Reduced};

/// Both systems, for the real and the complex eigenvalue of A⁻¹ (Hairer, Wanner II, IV.8), each with its factors.
#[derive(Debug, Clone)]
pub(crate) struct Systems {
    layout: Layout,
    real: Reduced<f64>,
    complex: Reduced<Complex64>,
    /// The step for which factors exist.
    h: Option<f64>,
}

/// The steps may differ by this part of their length and still use the same factors: t + h is rounded. It slows Newton's method no
/// more than that.
const SAME_STEP: f64 = 1e-4;

impl Systems {
    pub(crate) fn new(layout: Layout, real: f64, complex: Complex64) -> Self {
        let size = layout.active - layout.pairs;
        Self {
            layout,
            real: Reduced::new(real, size),
            complex: Reduced::new(complex, size),
            h: None,
        }
    }

    /// Whether the factors serve for a step of length `h`.
    pub(crate) fn fit(&self, h: f64) -> bool {
        self.h.is_some_and(|own| (h - own).abs() <= SAME_STEP * own.abs())
    }

    /// Drops the factors: the matrix J has changed.
    pub(crate) fn clear(&mut self) {
        self.h = None;
    }

    /// Factorises two matrices.
    pub(crate) fn factorise(&mut self, jacobian: &[f64], h: f64) -> Result<(), Singular> {
        self.h = None;
        self.real.factorise(self.layout, jacobian, h)?;
        self.complex.factorise(self.layout, jacobian, h)?;
        self.h = Some(h);
        Ok(())
    }

    /// Solves (γ − h J) x = r in place, with the h and the `jacobian` of the factors.
    pub(crate) fn solve_real(&mut self, jacobian: &[f64], r: &mut [f64]) {
        let h = self.h.unwrap_or(0.0);
        let (get, set) = (|r: &[f64], i: usize| r[i], |r: &mut [f64], i: usize, x: f64| r[i] = x);
        self.real.solve(self.layout, (jacobian, h), r, get, set);
    }

    /// Solves (α + iβ − h J) (x + i y) = r + i s in place.
    pub(crate) fn solve_complex(&mut self, jacobian: &[f64], r: (&mut [f64], &mut [f64])) {
        let h = self.h.unwrap_or(0.0);
        let mut r = r;
        let get = |r: &(&mut [f64], &mut [f64]), i: usize| Complex64::new(r.0[i], r.1[i]);
        let set = |r: &mut (&mut [f64], &mut [f64]), i: usize, x: Complex64| (r.0[i], r.1[i]) = (x.re, x.im);
        self.complex.solve(self.layout, (jacobian, h), &mut r, get, set);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]
        /// The solutions fulfil the equations of the full matrix, whatever was eliminated.
        #[test]
        fn solutions_fulfil_the_full_equations(
            pairs in 0_usize..4,
            others in 0_usize..3,
            algebraic in 0_usize..3,
            quadratures in 0_usize..3,
            h in prop_oneof![-1.0..1.0, Just(1e-9)],
            entries in proptest::collection::vec(-1.0..1.0, 144),
            right in proptest::collection::vec(-1.0..1.0, 20),
        ) {
            let active = 2 * pairs + others + algebraic;
            let dim = active + quadratures;
            let layout = Layout { dim, pairs, active, algebraic };
            let differential = layout.differential();
            let entry = |i: usize, j: usize| match (i < pairs, j < active) {
                (true, _) => f64::from(u8::from(j == pairs + i)),
                // Algebraic equations can be solved for their components.
                (false, true) if i == j && i >= differential => -10.0 / h,
                (false, true) => entries[i * dim + j],
                (false, false) => 0.0,
            };
            let factor = |i: usize| if i < differential { 1.0 } else { 0.0 };
            let mut jacobian: Vec<f64> = (0..dim * dim).map(|ij| entry(ij / dim, ij % dim)).collect();
            let mut systems = Systems::new(layout, 10.0, Complex64::new(10.0, 3.0));
            // What stands in the rows of the positions is known, and not read.
            jacobian[..pairs * dim].fill(f64::NAN);
            systems.factorise(&jacobian, h).unwrap();
            let (mut x, mut u, mut v) = (right[..active].to_vec(), right[..active].to_vec(), right[10..][..active].to_vec());
            systems.solve_real(&jacobian, &mut x);
            systems.solve_complex(&jacobian, (&mut u, &mut v));
            for i in 0..active {
                let times = |x: &[f64]| (0..active).map(|j| h * entry(i, j) * x[j]).sum::<f64>();
                prop_assert!((10.0 * factor(i) * x[i] - times(&x) - right[i]).abs() < 1e-13);
                prop_assert!((factor(i) * (10.0 * u[i] - 3.0 * v[i]) - times(&u) - right[i]).abs() < 1e-13);
                prop_assert!((factor(i) * (3.0 * u[i] + 10.0 * v[i]) - times(&v) - right[10 + i]).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn factors_serve_for_steps_that_differ_by_rounding() {
        let layout = Layout {
            dim: 1,
            pairs: 0,
            active: 1,
            algebraic: 0,
        };
        let mut systems = Systems::new(layout, 1.0, Complex64::new(1.0, 1.0));
        assert!(!systems.fit(0.1));
        systems.factorise(&[2.0], 0.1).unwrap();
        assert!(systems.fit(0.1_f64.next_up()) && !systems.fit(0.11) && !systems.fit(-0.1));
        // 1 − 0.5 · 2 = 0.
        assert_eq!(systems.factorise(&[2.0], 0.5), Err(Singular));
        assert!(!systems.fit(0.1) && !systems.fit(0.5));
        systems.factorise(&[2.0], 0.1).unwrap();
        systems.clear();
        assert!(!systems.fit(0.1));
    }
}

//! Where an explicit Runge-Kutta method is stable, by its own steps on the simplest problem.
//!
//! On y' = λ y a step is multiplication by a polynomial R(hλ) (Hairer, Wanner II, IV.2). One step with h = 1 on a chain
//! y₀' = 0, yₖ' = yₖ₋₁ from (1, 0, 0, ...) leaves its coefficients as the state.

use linkdyn_mechanisms::integrators::{
    Dop853Tableau, DormandPrince5Tableau, EvalError, Integration, Method, Ode, Rk4, RungeKutta, Settings,
};
use nalgebra::Complex;

/// More than the stages of any method here.
const DEGREE: usize = 16;
/// A factor a step that counts as growth: e after a thousand steps.
const GROWTH: f64 = 1.001;
/// Step along the ray, and its end: beyond it no method of up to a dozen stages is stable.
const SCAN: f64 = 0.01;
const END: f64 = 40.0;

/// The chain.
struct Chain;

impl Ode for Chain {
    fn dim(&self) -> usize {
        DEGREE
    }

    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        dy[0] = 0.0;
        dy[1..].copy_from_slice(&y[..DEGREE - 1]);
        Ok(())
    }
}

/// A stability polynomial by its coefficients from the constant one on.
#[derive(Clone, Debug)]
pub struct Polynomial(Vec<f64>);

impl Polynomial {
    /// That of a method by name; `None` for methods that are not explicit Runge-Kutta methods.
    pub fn of(method: &str) -> Option<Self> {
        match method {
            "rk4" => Self::by_a_step(Rk4::new(1.0)),
            "dopri5" => Self::by_a_step(RungeKutta::<DormandPrince5Tableau>::fixed(1.0)),
            "dop853" => Self::by_a_step(RungeKutta::<Dop853Tableau>::fixed(1.0)),
            _ => None,
        }
    }

    fn by_a_step(method: impl Method<Chain>) -> Option<Self> {
        let mut start = vec![0.0; DEGREE];
        start[0] = 1.0;
        let mut integration = Integration::new(Chain, method, 0.0, &start, Settings::default()).ok()?;
        integration.advance(1.0).ok()?;
        Some(Self(integration.state().1.to_vec()))
    }

    /// R(z).
    fn at(&self, z: Complex<f64>) -> Complex<f64> {
        self.0.iter().rev().fold(Complex::new(0.0, 0.0), |sum, &c| sum * z + c)
    }

    /// Largest h up to which no step makes a solution of y' = λ y grow that does not grow by itself; infinite for λ = 0 and where
    /// all steps are as good.
    pub fn largest_step(&self, lambda: Complex<f64>) -> f64 {
        let size = lambda.norm();
        if size == 0.0 {
            return f64::INFINITY;
        }
        let ray = lambda / size;
        let stable = |r: f64| self.at(r * ray).norm() <= GROWTH * (r * ray.re.max(0.0)).exp();
        let beyond = (1..)
            .map(|i| f64::from(i) * SCAN)
            .take_while(|&r| r <= END)
            .find(|&r| !stable(r));
        let Some(mut bad) = beyond else {
            return f64::INFINITY;
        };
        let mut good = bad - SCAN;
        for _ in 0..40 {
            let middle = 0.5 * (good + bad);
            if stable(middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        good / size
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_begin_like_the_exponential_up_to_their_order() {
        for (method, order) in [("rk4", 4), ("dopri5", 5), ("dop853", 8)] {
            let Polynomial(c) = Polynomial::of(method).expect("explicit");
            let mut factorial = 1.0;
            for (k, c) in c.iter().enumerate() {
                factorial *= k.max(1) as f64;
                let same = (c * factorial - 1.0).abs() < 1e-12;
                assert_eq!(same, k <= order, "{method}: coefficient {k} is {c}");
            }
        }
        assert!(Polynomial::of("radau5").is_none());
    }

    #[test]
    fn bounds_are_those_known() {
        // RK4: -2.785 and 2 √2 i (Hairer, Wanner II, IV.2); DOPRI5: -3.307.
        let reach = |method: &str, re: f64, im: f64| {
            Polynomial::of(method)
                .expect("explicit")
                .largest_step(Complex::new(re, im))
        };
        assert!((reach("rk4", -1.0, 0.0) - 2.7853).abs() < 2e-3);
        assert!((reach("rk4", 0.0, 1.0) - 8_f64.sqrt()).abs() < 2e-3);
        assert!((reach("rk4", -1e6, 0.0) * 1e6 - 2.7853).abs() < 2e-3);
        assert!((reach("dopri5", -1.0, 0.0) - 3.3066).abs() < 3e-3);
        // By the tableau of another program (SciPy 1.x), numerically: -6.394 and 5.961 i.
        assert!((reach("dop853", -1.0, 0.0) - 6.394).abs() < 2e-3);
        assert!((reach("dop853", 0.0, 1.0) - 5.961).abs() < 2e-3);
        assert_eq!(reach("rk4", 0.0, 0.0), f64::INFINITY);
        assert_eq!(reach("rk4", 1.0, 0.0), f64::INFINITY);
    }
}

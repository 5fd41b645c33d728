//! Newmark's method for problems of second order.

use crate::{Counted, EvalError, Method, SecondOrder, SettingsError, Step, Weights, hermite};

/// When the corrector of an implicit formula stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Corrector {
    /// After this many iterations, at least 1.
    Times(u32),
    /// When no component changes by more than `change` · max(1, |yᵢ|), which must happen within `at_most` iterations.
    Until {
        /// Largest change of the last iteration, > 0.
        change: f64,
        /// Most iterations, at least 1.
        at_most: u32,
    },
}

/// Why the corrector stopped without a result.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the corrector has not settled after {iterations} iterations, last change {change:e}; a shorter step may help")]
pub struct NotSettled {
    /// Iterations made.
    pub iterations: u32,
    /// Largest change in the last one, as in [`Corrector::Until`].
    pub change: f64,
}

/// Newmark's method of fixed step with functional iteration (Newmark, J. Eng. Mech. Div. ASCE 85, 1959, pp. 67-94):
///
/// q₁ = q₀ + h v₀ + h² ((½ − β) a₀ + β a₁), v₁ = v₀ + h ((1 − γ) a₀ + γ a₁), and the trapezoidal rule for what is of first order.
///
/// Order 2 for γ = ½, else 1. The iteration begins with the derivatives at the start of the step and costs one evaluation each
/// time; one more at the accepted state closes the step. Interpolation by the cubic Hermite polynomial.
#[derive(Debug, Clone)]
pub struct Newmark {
    step: f64,
    corrector: Corrector,
    beta: f64,
    gamma: f64,
    pairs: usize,
    /// Derivatives at the start of the step, in the iteration, and at the end of the step.
    f_old: Vec<f64>,
    f: Vec<f64>,
    f_new: Vec<f64>,
    moved_on: bool,
}

impl Newmark {
    /// With steps of this length, β = ¼ and γ = ½ (constant average acceleration).
    #[must_use]
    pub fn new(step: f64, corrector: Corrector) -> Self {
        Self {
            step,
            corrector,
            beta: 0.25,
            gamma: 0.5,
            pairs: 0,
            f_old: Vec::new(),
            f: Vec::new(),
            f_new: Vec::new(),
            moved_on: false,
        }
    }

    /// With other coefficients, 0 ≤ β ≤ ½ and 0 ≤ γ ≤ 1.
    #[must_use]
    pub fn with_coefficients(mut self, beta: f64, gamma: f64) -> Self {
        (self.beta, self.gamma) = (beta, gamma);
        self
    }

    /// One pass of the corrector with the derivatives `f` at the end of the step; returns the largest change.
    fn correct(&self, Step { h, y, .. }: Step<'_>, y_new: &mut [f64]) -> f64 {
        let (n, pairs) = (y.len(), self.pairs);
        let (a0, a1) = (&self.f_old, &self.f);
        let mut change = 0.0;
        let mut put = |i: usize, value: f64| {
            let difference = (value - y_new[i]).abs() / value.abs().max(1.0);
            // A difference that is not a number must not be lost.
            if difference.is_nan() || difference > change {
                change = difference;
            }
            y_new[i] = value;
        };
        for q in 0..pairs {
            let v = pairs + q;
            put(
                q,
                y[q] + h * (y[v] + h * ((0.5 - self.beta) * a0[v] + self.beta * a1[v])),
            );
            put(v, y[v] + h * ((1.0 - self.gamma) * a0[v] + self.gamma * a1[v]));
        }
        for z in 2 * pairs..n {
            put(z, y[z] + 0.5 * h * (a0[z] + a1[z]));
        }
        change
    }
}

impl<P: SecondOrder + ?Sized> Method<P> for Newmark {
    fn order(&self) -> u32 {
        if self.gamma == 0.5 { 2 } else { 1 }
    }

    fn prepare(&mut self, problem: &P) -> Result<(), SettingsError> {
        let (n, pairs) = (problem.dim(), problem.pairs());
        if 2 * pairs > n {
            return Err(SettingsError::Method(
                "more pairs of positions and rates than components",
            ));
        }
        if !(0.0..=0.5).contains(&self.beta) || !(0.0..=1.0).contains(&self.gamma) {
            return Err(SettingsError::Method("needed: 0 <= beta <= 1/2, 0 <= gamma <= 1"));
        }
        match self.corrector {
            Corrector::Times(0) | Corrector::Until { at_most: 0, .. } => {
                return Err(SettingsError::Method("the corrector needs at least one iteration"));
            }
            Corrector::Until { change, .. } if change.is_nan() || change <= 0.0 => {
                return Err(SettingsError::Method(
                    "the change at which the corrector stops must be > 0",
                ));
            }
            _ => {}
        }
        self.pairs = pairs;
        (self.f_old, self.f, self.f_new) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        Ok(())
    }

    fn restart(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        self.moved_on = false;
        problem.rhs(t, y, &mut self.f_old)
    }

    fn attempt(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        _weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError> {
        if std::mem::take(&mut self.moved_on) {
            std::mem::swap(&mut self.f_old, &mut self.f_new);
        }
        let (most, goal) = match self.corrector {
            Corrector::Times(times) => (times, None),
            Corrector::Until { change, at_most } => (at_most, Some(change)),
        };
        error.fill(0.0);
        self.f.copy_from_slice(&self.f_old);
        self.correct(step, y_new);
        let mut change = f64::INFINITY;
        for _ in 0..most {
            problem.count_iteration();
            problem.rhs(step.t + step.h, y_new, &mut self.f)?;
            change = self.correct(step, y_new);
            // What is not finite the driver refuses.
            if change.is_nan() || goal.is_some_and(|goal| change <= goal) {
                return Ok(0.0);
            }
        }
        match goal {
            None => Ok(0.0),
            Some(_) => Err(EvalError::Retry(
                NotSettled {
                    iterations: most,
                    change,
                }
                .into(),
            )),
        }
    }

    fn close(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        _projected: bool,
    ) -> Result<&[f64], EvalError> {
        problem.rhs(step.t + step.h, y_new, &mut self.f_new)?;
        Ok(&self.f_new)
    }

    fn accept(&mut self, _h: f64) {
        self.moved_on = true;
    }

    fn retreat(&mut self) {
        self.moved_on = false;
    }

    fn derivative(&self) -> &[f64] {
        if self.moved_on { &self.f_new } else { &self.f_old }
    }

    fn next_step(&mut self, _h: f64, _error: f64) -> f64 {
        self.step
    }

    fn interpolate(
        &mut self,
        _problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        theta: f64,
        y: &mut [f64],
    ) -> Result<(), EvalError> {
        hermite::interpolate(theta, step.h, [step.y, &self.f_old], [y_new, &self.f_new], y);
        Ok(())
    }

    fn fixed_step(&self) -> Option<f64> {
        Some(self.step)
    }
}

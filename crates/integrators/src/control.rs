//! Step-size control and the choice of the first step.

use crate::{Counted, EvalError, Ode, Weights};

/// Chooses the next step from the error of this one and of the one before (Hairer, Nørsett, Wanner I, IV.2 and II.4).
///
/// h' = h · clamp(safety · err^−α · err_old^β), α = 1/q − 0.75 β, where the estimate behaves as h^q.
#[derive(Debug, Clone)]
pub(crate) struct StepControl {
    alpha: f64,
    beta: f64,
    safety: f64,
    shrink: f64,
    grow: f64,
    old_error: f64,
}

impl StepControl {
    /// For an error estimate of order h^`exponent`.
    pub(crate) fn new(exponent: u32, beta: f64, safety: f64) -> Self {
        Self {
            alpha: 1.0 / f64::from(exponent) - 0.75 * beta,
            beta,
            safety,
            shrink: 0.2,
            grow: 10.0,
            old_error: 1e-4,
        }
    }

    /// The step after one of length `h` with this norm of error.
    pub(crate) fn next(&mut self, h: f64, error: f64) -> f64 {
        if error > 1.0 {
            return h * (self.safety * error.powf(-self.alpha)).max(self.shrink);
        }
        let error = error.max(1e-10);
        let mut factor = self.safety * error.powf(-self.alpha);
        if self.beta > 0.0 {
            factor *= self.old_error.powf(self.beta);
        }
        self.old_error = error.max(1e-4);
        h * factor.clamp(self.shrink, self.grow)
    }
}

/// A first step for a method of this order, not longer than `limit` (Hairer, Nørsett, Wanner I, II.4 "Starting step size").
///
/// `scratch` is overwritten. Costs one evaluation.
pub(crate) fn first_step<P: Ode + ?Sized>(
    problem: &mut Counted<'_, P>,
    (t, direction, limit): (f64, f64, f64),
    (y, f): (&[f64], &[f64]),
    order: u32,
    weights: &Weights,
    scratch: [&mut [f64]; 2],
) -> Result<f64, EvalError> {
    let [y_euler, f_euler] = scratch;
    let d0 = weights.norm(y, y, y);
    let d1 = weights.norm(y, y, f);
    let h0 = if d0 < 1e-5 || d1 < 1e-5 { 1e-6 } else { 0.01 * d0 / d1 }.min(limit);
    for ((euler, y), f) in y_euler.iter_mut().zip(y).zip(f) {
        *euler = y + direction * h0 * f;
    }
    match problem.rhs(t + direction * h0, y_euler, f_euler) {
        Ok(()) => {}
        Err(EvalError::Retry(_)) => return Ok(0.01 * h0),
        Err(abort) => return Err(abort),
    }
    for (change, f) in f_euler.iter_mut().zip(f) {
        *change -= f;
    }
    let d2 = weights.norm(y, y, f_euler) / h0;
    let h1 = match d1.max(d2) {
        d if d <= 1e-15 => f64::max(1e-6, 1e-3 * h0),
        d => (0.01 / d).powf(1.0 / f64::from(order + 1)),
    };
    let h = h1.min(100.0 * h0).min(limit);
    Ok(if h > 0.0 { h } else { 0.01 * h0 })
}

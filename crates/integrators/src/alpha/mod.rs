//! The generalised-α method for problems of second order with constraints.

mod coefficients;
mod newton;

use crate::control::StepControl;
use crate::newton::{Convergence, Verdict};
use crate::{
    Constrained, Counted, Equations, EvalError, Form, Method, NotSettled, SettingsError, SingularConstraints, Step,
    Weights, hermite,
};
use coefficients::Coefficients;
use newton::Newton;

/// The generalised-α method of order 2 for [constrained problems](Constrained) in the form [`Form::Index3`] (Arnold and Brüls 2007):
///
/// q₁ = q₀ + h v₀ + h² ((½ − β) a₀ + β a₁), v₁ = v₀ + h ((1 − γ) a₀ + γ a₁),
/// (1 − α_m) a₁ + α_m a₀ = (1 − α_f) v'₁ + α_f v'₀,
///
/// with M v'₁ = f − Gᵀ λ₁ and g(t₁, q₁) = 0 solved by Newton's method, whose matrix serves for as many steps as it can. Positions,
/// rates and multipliers are of order 2; a is an auxiliary variable of the method that starts, and goes on where the length of the step
/// changes, at the time to which it belongs. With [projection](Equations::with_projection) the rates keep g' = 0 too.
///
/// Local errors of positions and rates are estimated from the changes of a, those of rates multiplied by h as for any component of
/// [index](crate::Ode::index) 2: where the step changes, so
/// does their error across the constraints. With steps that vary, multipliers are accurate with projection only. Each iteration costs one
/// evaluation of the [terms](crate::Terms), a new matrix one more and n for differences, unless the problem gives its tangents.
#[derive(Debug, Clone)]
pub struct GeneralisedAlpha {
    coefficients: Coefficients,
    fixed: Option<f64>,
    newton: Newton,
    control: StepControl,
    /// At the state reached; and at the end of the attempt or, once it is accepted, at its beginning.
    now: Memory,
    other: Memory,
    /// Nothing is known of the rate of v' yet.
    fresh: bool,
    a_start: Vec<f64>,
    predicted: Vec<f64>,
    /// Newton's iteration converges so slowly that the next step shall have a new matrix.
    outdated: bool,
    left: f64,
    shorten: Option<f64>,
}

/// What is known at a state.
#[derive(Debug, Clone, Default)]
struct Memory {
    /// (v, v', λ'), the last as the slope of the step before.
    f: Vec<f64>,
    /// v''.
    jerk: Vec<f64>,
    /// (a − v') / h.
    offset: Vec<f64>,
}

/// Spectral radius by default: what oscillates within a step loses a fifth of its size with each.
const RADIUS: f64 = 0.8;

/// Most iterations of an adaptive step, and of a fixed one, which cannot be shortened.
const MOST_ITERATIONS: u32 = 7;
const MOST_ITERATIONS_FIXED: u32 = 20;

/// Where changes shrink more slowly than this, a new matrix is cheaper than the iterations that it saves.
const SLOW: f64 = 0.1;

/// Part of the tolerance that may remain of Newton's iteration.
const GOAL: f64 = 0.01;

/// Steps that would change by no more than this stay as they are.
const NOT_WORTH_A_NEW_MATRIX: std::ops::RangeInclusive<f64> = 0.9..=1.3;

/// Part of a step over which v'' is found at a start: truncation and rounding of it are small beside the error of a step.
const FIRST_PART: f64 = 1e-3;

impl Default for GeneralisedAlpha {
    /// With a spectral radius of 0.8 and steps chosen by the tolerances.
    fn default() -> Self {
        Self {
            coefficients: Coefficients::of_radius(RADIUS),
            fixed: None,
            newton: Newton::default(),
            control: StepControl::new(3, 0.0, 0.9),
            now: Memory::default(),
            other: Memory::default(),
            fresh: true,
            a_start: Vec::new(),
            predicted: Vec::new(),
            outdated: true,
            left: 1.0,
            shorten: None,
        }
    }
}

impl GeneralisedAlpha {
    /// With steps of this length, whatever the tolerances; Newton's iteration goes on to rounding.
    #[must_use]
    pub fn fixed(step: f64) -> Self {
        Self {
            fixed: Some(step),
            ..Self::default()
        }
    }

    /// With another spectral radius for infinite frequency, 0 ≤ radius ≤ 1: 0 damps what is fast most, 1 not at all
    /// (Chung and Hulbert 1993).
    #[must_use]
    pub fn with_radius(mut self, radius: f64) -> Self {
        self.coefficients = Coefficients::of_radius(radius);
        self
    }

    /// As the method of Hilber, Hughes and Taylor with 0 ≤ α ≤ 1/2, here without the sign of its paper; beyond 1/3 it damps less again.
    #[must_use]
    pub fn with_hht(mut self, alpha: f64) -> Self {
        self.coefficients = Coefficients::hht(alpha);
        self
    }

    /// As the trapezoidal rule of Newmark. It damps nothing: multipliers oscillate, without growing only where rates are projected.
    #[must_use]
    pub fn with_trapezoidal(self) -> Self {
        self.with_hht(0.0)
    }

    /// Sets the iteration on a state at t + h that continues the step before.
    fn predict(&mut self, Step { h, y, .. }: Step<'_>) {
        let Coefficients {
            alpha_m,
            alpha_f,
            beta,
            gamma,
        } = self.coefficients;
        let (n, newton) = (self.a_start.len(), &mut self.newton);
        for i in 0..n {
            let rate = self.now.f[n + i];
            let a0 = rate + h * self.now.offset[i];
            let predicted = rate + h * self.now.jerk[i];
            let a1 = ((1.0 - alpha_f) * predicted + alpha_f * rate - alpha_m * a0) / (1.0 - alpha_m);
            (self.a_start[i], self.predicted[i], newton.rate[i]) = (a0, predicted, predicted);
            newton.y[i] = y[i] + h * (y[n + i] + h * ((0.5 - beta) * a0 + beta * a1));
            newton.y[n + i] = y[n + i] + h * ((1.0 - gamma) * a0 + gamma * a1);
        }
        for ((target, lambda), slope) in newton.lambda.iter_mut().zip(&y[2 * n..]).zip(&self.now.f[2 * n..]) {
            *target = lambda + h * slope;
        }
    }

    /// Newton's iteration on what was predicted; on failure tells iterations and the last change.
    fn solve<P: Constrained>(
        &mut self,
        problem: &mut Counted<'_, Equations<P>>,
        step: Step<'_>,
        weights: &Weights,
        change: &mut [f64],
    ) -> Result<Result<(), (u32, f64)>, EvalError> {
        let (t, h) = (step.t + step.h, step.h);
        self.predict(step);
        let new = self.outdated || !self.newton.fit(h);
        if new {
            problem.count_factorisations(1);
            if self.newton.refresh(problem, (t, h), &self.coefficients)?.is_err() {
                return Err(EvalError::Retry(Box::new(SingularConstraints { time: t })));
            }
        }
        let rounding = f64::EPSILON / weights.least_relative();
        let convergence = match self.fixed {
            None => Convergence::new(MOST_ITERATIONS, rounding.max(GOAL), true, self.left),
            Some(_) => Convergence::new(MOST_ITERATIONS_FIXED, rounding, false, 1.0),
        };
        let mut convergence = convergence.with_patience();
        loop {
            problem.count_iteration();
            self.newton.iterate(problem, (t, h), &self.coefficients, change)?;
            match convergence.judge(weights.norm(step.y, step.y, change)) {
                Verdict::GoOn => {}
                Verdict::Converged => break,
                Verdict::Failed { .. } if !new => {
                    // Once more, with what is true here.
                    self.outdated = true;
                    return self.solve(problem, step, weights, change);
                }
                Verdict::Failed { .. } => return Ok(Err((convergence.iterations(), convergence.change()))),
            }
        }
        self.left = convergence.left();
        self.outdated = convergence.contraction() > SLOW;
        Ok(Ok(()))
    }
}

impl<P: Constrained> Method<Equations<P>> for GeneralisedAlpha {
    fn order(&self) -> u32 {
        2
    }

    fn prepare(&mut self, problem: &Equations<P>) -> Result<(), SettingsError> {
        if problem.form() != Form::Index3 {
            return Err(SettingsError::Method(
                "the generalised-alpha method takes the form Index3",
            ));
        }
        self.coefficients.check()?;
        let (n, m) = problem.counts();
        self.newton = Newton::new(n, m);
        for memory in [&mut self.now, &mut self.other] {
            *memory = Memory {
                f: vec![0.0; 2 * n + m],
                jerk: vec![0.0; n],
                offset: vec![0.0; n],
            };
        }
        (self.a_start, self.predicted) = (vec![0.0; n], vec![0.0; n]);
        Ok(())
    }

    fn restart(&mut self, problem: &mut Counted<'_, Equations<P>>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        let n = self.a_start.len();
        let accelerations = &problem.for_evaluation().accelerate(t, y)?[..n];
        self.now.f[n..2 * n].copy_from_slice(accelerations);
        self.now.f[..n].copy_from_slice(&y[n..2 * n]);
        self.now.f[2 * n..].fill(0.0);
        (self.fresh, self.outdated, self.left, self.shorten) = (true, true, 1.0, None);
        Ok(())
    }

    fn attempt(
        &mut self,
        problem: &mut Counted<'_, Equations<P>>,
        step: Step<'_>,
        weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError> {
        let (n, h) = (self.a_start.len(), step.h);
        self.shorten = None;
        if self.fresh {
            // v'' by a short step.
            let s = FIRST_PART * h;
            let ahead = &mut self.newton.y;
            ahead.copy_from_slice(step.y);
            for i in 0..n {
                let (v, a) = (step.y[n + i], self.now.f[n + i]);
                (ahead[i], ahead[n + i]) = (step.y[i] + s * (v + 0.5 * s * a), v + s * a);
            }
            let ahead = problem.for_evaluation().accelerate(step.t + s, ahead)?;
            for i in 0..n {
                self.now.jerk[i] = (ahead[i] - self.now.f[n + i]) / s;
                self.now.offset[i] = self.coefficients.offset() * self.now.jerk[i];
            }
        }
        if let Err((iterations, change)) = self.solve(problem, step, weights, error)? {
            if self.fixed.is_some() {
                return Err(EvalError::Retry(Box::new(NotSettled { iterations, change })));
            }
            problem.count_divergence();
            self.shorten = Some(0.5);
            y_new.copy_from_slice(step.y);
            return Ok(2.0);
        }
        let newton = &self.newton;
        y_new[..2 * n].copy_from_slice(&newton.y[..2 * n]);
        y_new[2 * n..].copy_from_slice(&newton.lambda);
        let Coefficients { alpha_m, alpha_f, .. } = self.coefficients;
        let (of_positions, of_rates) = self.coefficients.local_errors();
        error.fill(0.0);
        let Memory { f, jerk, offset } = &mut self.other;
        for i in 0..n {
            let (before, rate) = (self.now.f[n + i], newton.rate[i]);
            let a = ((1.0 - alpha_f) * rate + alpha_f * before - alpha_m * self.a_start[i]) / (1.0 - alpha_m);
            (f[n + i], jerk[i], offset[i]) = (rate, (rate - before) / h, (a - rate) / h);
            error[i] = of_positions * h * h * (a - self.a_start[i]);
            error[n + i] = of_rates * h * h.abs() * (rate - self.predicted[i]);
        }
        for ((slope, new), old) in f[2 * n..].iter_mut().zip(&y_new[2 * n..]).zip(&step.y[2 * n..]) {
            *slope = (new - old) / h;
        }
        if self.fixed.is_some() {
            error.fill(0.0);
            return Ok(0.0);
        }
        Ok(weights.norm(step.y, y_new, error))
    }

    fn close(
        &mut self,
        _problem: &mut Counted<'_, Equations<P>>,
        _step: Step<'_>,
        y_new: &[f64],
        _projected: bool,
    ) -> Result<&[f64], EvalError> {
        let n = self.a_start.len();
        self.other.f[..n].copy_from_slice(&y_new[n..2 * n]);
        Ok(&self.other.f)
    }

    fn accept(&mut self, _h: f64) {
        std::mem::swap(&mut self.now, &mut self.other);
        self.fresh = false;
    }

    fn retreat(&mut self) {
        std::mem::swap(&mut self.now, &mut self.other);
    }

    fn derivative(&self) -> &[f64] {
        &self.now.f
    }

    fn next_step(&mut self, h: f64, error: f64) -> f64 {
        match (self.fixed, self.shorten.take()) {
            (Some(step), _) => step,
            (None, Some(factor)) => factor * h,
            (None, None) => {
                let next = self.control.next(h, error);
                // The matrix serves again.
                if error <= 1.0 && NOT_WORTH_A_NEW_MATRIX.contains(&(next / h)) {
                    h
                } else {
                    next
                }
            }
        }
    }

    fn interpolate(
        &mut self,
        _problem: &mut Counted<'_, Equations<P>>,
        step: Step<'_>,
        y_new: &[f64],
        theta: f64,
        y: &mut [f64],
    ) -> Result<(), EvalError> {
        hermite::interpolate(theta, step.h, [step.y, &self.other.f], [y_new, &self.now.f], y);
        Ok(())
    }

    fn fixed_step(&self) -> Option<f64> {
        self.fixed
    }

    fn solves_algebraic(&self) -> bool {
        true
    }
}

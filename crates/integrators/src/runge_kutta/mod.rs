//! Explicit Runge-Kutta methods: one engine, tableaus as data.

mod classical;
mod dop853;
mod dormand_prince5;
#[cfg(test)]
mod tests;

use std::marker::PhantomData;

use crate::control::StepControl;
use crate::sums::{add, combine};
use crate::{Counted, EvalError, Method, Ode, SettingsError, Step, Weights};

pub use classical::{ClassicalTableau, Rk4};
pub use dop853::{Dop853, Dop853Tableau};
pub use dormand_prince5::{DormandPrince5, DormandPrince5Tableau};

/// Nonzero coefficients of a linear combination of stages: (index of the stage, coefficient).
type Row = &'static [(usize, f64)];

/// The coefficients of an explicit method of S stages.
///
/// Stage 0 is f(t, y), stage S is f(t + h, y₁) at the new state y₁; stages S + 1 onward serve interpolation only.
#[derive(Debug)]
pub struct Coefficients {
    order: u32,
    /// cᵢ of the stages 1 to S − 1.
    nodes: &'static [f64],
    /// aᵢⱼ of the stages 1 to S − 1.
    rows: &'static [Row],
    /// bⱼ.
    weights: Row,
    error: Estimate,
    /// cᵢ of the stages S + 1 onward.
    dense_nodes: &'static [f64],
    /// aᵢⱼ of the stages S + 1 onward.
    dense_rows: &'static [Row],
    /// Terms of the interpolation beyond the cubic Hermite polynomial.
    dense: &'static [Row],
}

/// How a method estimates its error.
#[derive(Debug)]
enum Estimate {
    /// Not at all.
    None,
    /// By an embedded formula which uses the stage S.
    WithNewDerivative(Row),
    /// By two formulas of orders 5 and 3 (Hairer, Nørsett, Wanner I, eq. II.10.17).
    Pair { fifth: Row, third: Row },
}

/// A set of coefficients, as a type.
pub trait Tableau {
    /// The coefficients.
    const COEFFICIENTS: Coefficients;
}

/// A tableau with an estimate of the error, so that steps can be chosen by tolerance.
pub trait Embedded: Tableau {
    /// Order of the error estimate as a power of the step.
    const EXPONENT: u32;
    /// Coefficient of the integral part of the step control.
    const BETA: f64;
    /// Safety factor of the step control.
    const SAFETY: f64;
}

/// An explicit Runge-Kutta method with the coefficients `T`.
///
/// Interpolation continues the cubic Hermite polynomial of the step by terms of higher degree, if the tableau has any
/// (Hairer, Nørsett, Wanner I, II.6); it is once continuously differentiable also where states are projected.
#[derive(Debug, Clone)]
pub struct RungeKutta<T> {
    steps: Steps,
    /// All stages, one after the other.
    stages: Vec<f64>,
    /// State at which a stage is evaluated.
    y_stage: Vec<f64>,
    /// Coefficients of the interpolation beyond y₀, one vector after the other.
    dense: Vec<f64>,
    dense_ready: bool,
    /// Stage S is that of an accepted step, not yet moved to stage 0.
    moved_on: bool,
    tableau: PhantomData<T>,
}

#[derive(Debug, Clone)]
enum Steps {
    Fixed(f64),
    Adaptive(StepControl),
}

impl<T: Embedded> Default for RungeKutta<T> {
    /// With steps chosen by the tolerances.
    fn default() -> Self {
        Self::with(Steps::Adaptive(StepControl::new(T::EXPONENT, T::BETA, T::SAFETY)))
    }
}

impl<T: Tableau> RungeKutta<T> {
    /// With steps of this length, whatever the tolerances.
    #[must_use]
    pub fn fixed(step: f64) -> Self {
        Self::with(Steps::Fixed(step))
    }

    const LAST: usize = T::COEFFICIENTS.rows.len() + 1;

    fn with(steps: Steps) -> Self {
        Self {
            steps,
            stages: Vec::new(),
            y_stage: Vec::new(),
            dense: Vec::new(),
            dense_ready: false,
            moved_on: false,
            tableau: PhantomData,
        }
    }

    /// Range of a stage in `stages`.
    fn range(&self, stage: usize) -> std::ops::Range<usize> {
        let n = self.y_stage.len();
        stage * n..(stage + 1) * n
    }

    /// Index of the stage that holds f at the state reached.
    fn current(&self) -> usize {
        if self.moved_on { Self::LAST } else { 0 }
    }

    /// The vectors of the interpolation (Hairer, Nørsett, Wanner I, eq. II.6.12 and subroutine DOP853).
    fn prepare_dense<P: Ode + ?Sized>(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
    ) -> Result<(), EvalError> {
        let (n, Step { t, h, y }) = (step.y.len(), step);
        let tableau = &T::COEFFICIENTS;
        for (i, (c, row)) in tableau.dense_nodes.iter().zip(tableau.dense_rows).enumerate() {
            let target = self.range(Self::LAST + 1 + i);
            combine(&mut self.y_stage, y, h, row, &self.stages);
            problem.rhs_for_interpolation(t + c * h, &self.y_stage, &mut self.stages[target])?;
        }
        let (f_old, f_new) = (&self.stages[self.range(0)], &self.stages[self.range(Self::LAST)]);
        let (hermite, rest) = self.dense.split_at_mut(3 * n);
        for i in 0..n {
            let chord = y_new[i] - y[i];
            let bend = h * f_old[i] - chord;
            hermite[i] = chord;
            hermite[n + i] = bend;
            hermite[2 * n + i] = chord - h * f_new[i] - bend;
        }
        for (row, term) in tableau.dense.iter().zip(rest.chunks_exact_mut(n.max(1))) {
            term.fill(0.0);
            add(term, h, row, &self.stages);
        }
        self.dense_ready = true;
        Ok(())
    }
}

impl<P: Ode + ?Sized, T: Tableau> Method<P> for RungeKutta<T> {
    fn order(&self) -> u32 {
        T::COEFFICIENTS.order
    }

    fn prepare(&mut self, problem: &P) -> Result<(), SettingsError> {
        let n = problem.dim();
        self.stages = vec![0.0; n * (Self::LAST + 1 + T::COEFFICIENTS.dense_rows.len())];
        self.y_stage = vec![0.0; n];
        self.dense = vec![0.0; n * (3 + T::COEFFICIENTS.dense.len())];
        Ok(())
    }

    fn restart(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        self.moved_on = false;
        let start = self.range(0);
        problem.rhs(t, y, &mut self.stages[start])
    }

    fn attempt(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError> {
        let Step { t, h, y } = step;
        let tableau = &T::COEFFICIENTS;
        let last = self.range(Self::LAST);
        if std::mem::take(&mut self.moved_on) {
            self.stages.copy_within(last.clone(), 0);
        }
        for (i, (c, row)) in tableau.nodes.iter().zip(tableau.rows).enumerate() {
            let stage = self.range(i + 1);
            combine(&mut self.y_stage, y, h, row, &self.stages);
            problem.rhs(t + c * h, &self.y_stage, &mut self.stages[stage])?;
        }
        combine(y_new, y, h, tableau.weights, &self.stages);
        error.fill(0.0);
        match tableau.error {
            Estimate::None => Ok(0.0),
            Estimate::WithNewDerivative(row) => {
                problem.rhs(t + h, y_new, &mut self.stages[last])?;
                add(error, h, row, &self.stages);
                Ok(weights.norm(y, y_new, error))
            }
            Estimate::Pair { fifth, third } => {
                let error_3 = &mut self.y_stage;
                error_3.fill(0.0);
                add(error, h, fifth, &self.stages);
                add(error_3, h, third, &self.stages);
                let [square_5, square_3] = weights.mean_squares(y, y_new, [error, error_3]);
                let both = square_5 + 0.01 * square_3;
                Ok(if both == 0.0 { 0.0 } else { square_5 / both.sqrt() })
            }
        }
    }

    fn close(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        projected: bool,
    ) -> Result<&[f64], EvalError> {
        let last = self.range(Self::LAST);
        if projected || !matches!(T::COEFFICIENTS.error, Estimate::WithNewDerivative(_)) {
            problem.rhs(step.t + step.h, y_new, &mut self.stages[last.clone()])?;
        }
        Ok(&self.stages[last])
    }

    fn accept(&mut self, _h: f64) {
        self.moved_on = true;
        self.dense_ready = false;
    }

    fn retreat(&mut self) {
        self.moved_on = false;
    }

    fn derivative(&self) -> &[f64] {
        &self.stages[self.range(self.current())]
    }

    fn next_step(&mut self, h: f64, error: f64) -> f64 {
        match &mut self.steps {
            Steps::Fixed(step) => *step,
            Steps::Adaptive(control) => control.next(h, error),
        }
    }

    fn interpolate(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        theta: f64,
        y: &mut [f64],
    ) -> Result<(), EvalError> {
        if !self.dense_ready {
            self.prepare_dense(problem, step, y_new)?;
        }
        // y₀ + θ (F₁ + (1 − θ) (F₂ + θ (F₃ + (1 − θ) (F₄ + ...))))
        let n = step.y.len();
        y.fill(0.0);
        for k in (0..self.dense.len() / n.max(1)).rev() {
            let factor = if k % 2 == 0 { theta } else { 1.0 - theta };
            for (y, term) in y.iter_mut().zip(&self.dense[k * n..]) {
                *y = factor * (*y + term);
            }
        }
        y.iter_mut().zip(step.y).for_each(|(y, start)| *y += start);
        Ok(())
    }

    fn interpolation_evaluations(&self) -> u32 {
        T::COEFFICIENTS.dense_rows.len() as u32
    }

    fn fixed_step(&self) -> Option<f64> {
        match self.steps {
            Steps::Fixed(step) => Some(step),
            Steps::Adaptive(_) => None,
        }
    }
}

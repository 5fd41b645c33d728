//! What a method of integration must provide to the driver.

use crate::{EvalError, Ode, SettingsError, Statistics, Weights};

/// A problem whose evaluations are counted; the only way in which methods reach it.
#[derive(Debug)]
pub struct Counted<'a, P: ?Sized> {
    problem: &'a mut P,
    statistics: &'a mut Statistics,
}

impl<'a, P: Ode + ?Sized> Counted<'a, P> {
    /// Counts the evaluations of `problem` in `statistics`.
    pub fn new(problem: &'a mut P, statistics: &'a mut Statistics) -> Self {
        Self { problem, statistics }
    }

    /// Evaluates and counts f(t, y).
    ///
    /// # Errors
    /// Those of the problem.
    #[inline]
    pub fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        self.statistics.evaluations += 1;
        self.problem.rhs(t, y, dy)
    }

    /// As [`rhs`](Counted::rhs), for evaluations that only interpolation needs.
    ///
    /// # Errors
    /// Those of the problem.
    pub fn rhs_for_interpolation(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        self.statistics.dense_evaluations += 1;
        self.rhs(t, y, dy)
    }

    /// As [`rhs`](Counted::rhs), for evaluations that only the differences of a Jacobian matrix need.
    ///
    /// # Errors
    /// Those of the problem.
    pub fn rhs_for_jacobian(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        self.statistics.jacobian_evaluations += 1;
        self.rhs(t, y, dy)
    }

    /// Asks the problem for df/dy, see [`Ode::jacobian`], and counts it as formed, by whomever.
    ///
    /// # Errors
    /// Those of the problem.
    pub fn jacobian(&mut self, t: f64, y: &[f64], matrix: &mut [f64]) -> Result<bool, EvalError> {
        self.statistics.jacobians += 1;
        matrix.fill(0.0);
        self.problem.jacobian(t, y, matrix)
    }

    /// Counts an attempt given up because its equations could not be solved.
    pub fn count_divergence(&mut self) {
        self.statistics.divergences += 1;
    }

    /// Counts matrices factorised.
    pub fn count_factorisations(&mut self, matrices: u64) {
        self.statistics.factorisations += matrices;
    }

    /// What has been counted.
    pub(crate) fn statistics(&self) -> &Statistics {
        self.statistics
    }

    /// The problem, to ask for its structure.
    pub(crate) fn structure(&self) -> &P {
        self.problem
    }

    /// The problem itself, for one evaluation that is not of [`Ode::rhs`]; it is counted.
    pub(crate) fn for_evaluation(&mut self) -> &mut P {
        self.statistics.evaluations += 1;
        self.problem
    }

    /// As [`for_evaluation`](Counted::for_evaluation), for differences.
    pub(crate) fn for_difference(&mut self) -> &mut P {
        self.statistics.jacobian_evaluations += 1;
        self.for_evaluation()
    }

    /// The problem itself, asked for a matrix, which is counted.
    pub(crate) fn for_matrix(&mut self) -> &mut P {
        self.statistics.jacobians += 1;
        self.problem
    }

    /// Evaluates and counts the root functions.
    pub(crate) fn root(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        self.statistics.root_evaluations += 1;
        self.problem.root(t, y, g)
    }

    /// Counts one corrector iteration.
    pub fn count_iteration(&mut self) {
        self.statistics.iterations += 1;
    }
}

/// Where a step begins and how long it is; negative `h` runs backward.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// Time at the beginning.
    pub t: f64,
    /// Length.
    pub h: f64,
    /// State at the beginning.
    pub y: &'a [f64],
}

/// A method of integration: makes one step and interpolates in it. The driver, [`Integration`](crate::Integration), does the rest.
///
/// Order of the calls: `prepare` once; `restart`; then for each step `attempt`, repeated with smaller `h` until its error is at
/// most 1; the driver projects the new state, calls `close` and, if the derivative is finite, `accept`; after that any number
/// of `interpolate`. Until `accept` the method must be able to attempt the same step again, and after it, once `retreat` has been
/// called: so a step is cut short at an event that interpolation has shown.
pub trait Method<P: ?Sized> {
    /// Order of the solution p: the error of a run is O(hᵖ).
    fn order(&self) -> u32;

    /// Allocates all memory and checks that method and problem fit together.
    ///
    /// # Errors
    /// [`SettingsError`] if they do not, or if a parameter of the method is out of range.
    fn prepare(&mut self, problem: &P) -> Result<(), SettingsError>;

    /// Begins at (t, y), forgetting all earlier steps.
    ///
    /// # Errors
    /// Those of the problem.
    fn restart(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError>;

    /// Tries a step: writes the new state and an estimate of its error (all zero if the method has none), and returns the norm of that error.
    ///
    /// # Errors
    /// Those of the problem.
    fn attempt(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError>;

    /// Completes the last attempt, whose error is small enough: returns f(t + h, y_new), or the derivative of what an implicit method
    /// takes for the solution if that is as accurate.
    ///
    /// `y_new` is the state of the attempt, `projected` tells whether it has been changed since.
    ///
    /// # Errors
    /// Those of the problem; the step is then rejected after all.
    fn close(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        projected: bool,
    ) -> Result<&[f64], EvalError>;

    /// Takes the closed attempt, of signed length `h`, as the step made.
    fn accept(&mut self, h: f64);

    /// Undoes the last `accept`, interpolations in between notwithstanding: the same step can be attempted again, with the length
    /// that the driver likes.
    fn retreat(&mut self);

    /// f at the state reached, as [`close`](Method::close) returned it, or exactly after [`restart`](Method::restart).
    fn derivative(&self) -> &[f64];

    /// Length of the next step, positive, after a step of length `h` > 0 had this norm of error (above 1: it was rejected).
    fn next_step(&mut self, h: f64, error: f64) -> f64;

    /// Writes the state at t + `theta` h of the step accepted last, which led to `y_new`.
    ///
    /// # Errors
    /// Those of the problem, for methods that need further evaluations.
    fn interpolate(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        theta: f64,
        y: &mut [f64],
    ) -> Result<(), EvalError>;

    /// Evaluations of f that the first interpolation in a step costs.
    fn interpolation_evaluations(&self) -> u32 {
        0
    }

    /// The step of a method of fixed step; its steps are accepted whatever their error.
    fn fixed_step(&self) -> Option<f64> {
        None
    }

    /// Whether earlier steps enter into the next one, so that a first step must be chosen anew after a restart.
    fn is_multistep(&self) -> bool {
        false
    }

    /// Whether the method solves [algebraic equations](Ode::algebraic); the driver refuses them otherwise.
    fn solves_algebraic(&self) -> bool {
        false
    }
}

/// A method chosen at run time.
impl<P: Ode + ?Sized> Method<P> for Box<dyn Method<P> + '_> {
    fn order(&self) -> u32 {
        (**self).order()
    }
    fn prepare(&mut self, problem: &P) -> Result<(), SettingsError> {
        (**self).prepare(problem)
    }
    fn restart(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        (**self).restart(problem, t, y)
    }
    fn attempt(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError> {
        (**self).attempt(problem, step, weights, y_new, error)
    }
    fn close(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        projected: bool,
    ) -> Result<&[f64], EvalError> {
        (**self).close(problem, step, y_new, projected)
    }
    fn accept(&mut self, h: f64) {
        (**self).accept(h);
    }
    fn retreat(&mut self) {
        (**self).retreat();
    }
    fn derivative(&self) -> &[f64] {
        (**self).derivative()
    }
    fn next_step(&mut self, h: f64, error: f64) -> f64 {
        (**self).next_step(h, error)
    }
    fn interpolate(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        theta: f64,
        y: &mut [f64],
    ) -> Result<(), EvalError> {
        (**self).interpolate(problem, step, y_new, theta, y)
    }
    fn interpolation_evaluations(&self) -> u32 {
        (**self).interpolation_evaluations()
    }
    fn fixed_step(&self) -> Option<f64> {
        (**self).fixed_step()
    }
    fn is_multistep(&self) -> bool {
        (**self).is_multistep()
    }
    fn solves_algebraic(&self) -> bool {
        (**self).solves_algebraic()
    }
}

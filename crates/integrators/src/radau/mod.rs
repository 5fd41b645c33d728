//! The Radau IIA method of order 5 for stiff problems.

mod coefficients;
mod control;
mod indices;
mod polynomial;
mod stages;
mod systems;

use crate::jacobian::differences;
use crate::newton::{Convergence, Verdict};
use crate::reduced::Layout;
use crate::{Counted, EvalError, Method, NotSettled, Ode, SettingsError, Step, Weights};
use control::{Prediction, effort};
use indices::Indices;
use polynomial::Polynomial;
use stages::Stages;
use systems::Systems;

/// The Radau IIA method of three stages and order 5, for stiff problems (Hairer, Wanner II, IV.8).
///
/// Implicit, L-stable. The equations of a step are solved by simplified Newton iterations, each of which costs 3 evaluations, one
/// real and one complex system of equations; df/dy and the factors serve for as many steps as they can. If the problem
/// [tells](Ode::second_order_pairs) that it begins with positions and their rates, these systems are as small as the number of rates.
/// The derivative at the end of a step is that of the collocation polynomial, so that no further evaluation is needed there.
///
/// [Algebraic equations](Ode::algebraic) are solved at every stage, so that the end of each step fulfils them. The solution is of
/// order 5 in components of [index](Ode::index) 1, of order 3 in algebraic ones of index 2, of order 3 and 2 in the rates and
/// multipliers of a problem of index 3 (Hairer, Wanner II, VII.4).
///
/// The error is estimated by a formula of order 3 while the solution is of order 5, so it is mostly far smaller than the
/// tolerance: near tolerance^1.25. (The subroutine RADAU5 of the book takes 0.1 tolerance^(2/3) for the tolerance it is given.)
/// Interpolation is by the collocation polynomial, at no cost; its error is of the order of the estimate, but larger where stiff
/// components follow slow ones in steps whose length nothing else limits. Newton's iteration does not see components whose
/// tolerance is infinite: this is meant for [quadratures](Ode::quadratures), which are integrated after it.
#[derive(Debug, Clone)]
pub struct Radau5 {
    /// Length of fixed steps.
    fixed: Option<f64>,
    /// df/dy is kept as long as Newton's changes shrink to this part; by default as long as it pays.
    reuse: Option<f64>,
    layout: Layout,
    stages: Stages,
    systems: Systems,
    indices: Indices,
    polynomial: Polynomial,
    jacobian: Vec<f64>,
    known: Known,
    /// Evaluations that df/dy has cost, iterations of the step it was found for, and the iterations above these of all steps since.
    evaluations: usize,
    usual: u32,
    excess: u32,
    /// What was known in the step accepted last, and whether its f was exact.
    before: (Known, bool),
    /// The polynomial is that of the very step that is attempted.
    again: bool,
    /// Newton's iteration converges so slowly that the next step shall have a new df/dy.
    outdated: bool,
    /// f at the start of the step and at its end; whether the former is f itself, not the derivative of a polynomial.
    f_old: Vec<f64>,
    f_is_exact: bool,
    f_new: Vec<f64>,
    y: Vec<f64>,
    /// What projection has added to the end of the step last closed.
    jump: Vec<f64>,
    prediction: Prediction,
    left: f64,
    effort: f64,
    /// Attempts made of this step.
    attempts: u32,
    /// By how much to shorten a step that Newton's iteration has not solved.
    shorten: Option<f64>,
}

/// What is known of df/dy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Known {
    Nothing,
    /// At the start of an earlier step.
    Earlier,
    /// At the start of this one.
    Here,
}

/// How Newton's iteration ended.
#[derive(Debug)]
enum Solution {
    Found(Convergence),
    /// A step shorter by this factor may succeed.
    Failed(f64, Convergence),
    /// f is not finite at this stage.
    NotFinite(usize),
}

/// Where changes shrink to this part or less (the limit of subroutine RADAU5), df/dy is as good as a new one.
const FAST: f64 = 0.001;

/// Where they shrink more slowly than this, divergence is near.
const SLOW: f64 = 0.1;

/// Iterations that a step with a new df/dy is taken to need at first.
const USUAL: u32 = 2;

/// Most iterations of an adaptive step (subroutine RADAU5), and of a fixed one, which cannot be shortened.
const MOST_ITERATIONS: u32 = 7;
const MOST_ITERATIONS_FIXED: u32 = 20;

impl Default for Radau5 {
    /// With steps chosen by the tolerances.
    fn default() -> Self {
        let (layout, stages) = (Layout::default(), Stages::new(Layout::default()));
        let (real, complex, nodes) = (
            stages.coefficients.real,
            stages.coefficients.complex,
            stages.coefficients.c,
        );
        Self {
            fixed: None,
            reuse: None,
            layout,
            stages,
            systems: Systems::new(layout, real, complex),
            indices: Indices::default(),
            polynomial: Polynomial::new(nodes, 0),
            jacobian: Vec::new(),
            known: Known::Nothing,
            evaluations: 0,
            usual: USUAL,
            excess: 0,
            before: (Known::Nothing, false),
            again: false,
            outdated: false,
            f_old: Vec::new(),
            f_is_exact: false,
            f_new: Vec::new(),
            y: Vec::new(),
            jump: Vec::new(),
            prediction: Prediction::default(),
            left: 1.0,
            effort: 1.0,
            attempts: 0,
            shorten: None,
        }
    }
}

impl Radau5 {
    /// With steps of this length, whatever the tolerances; Newton's iteration goes on to rounding.
    ///
    /// Where it does not converge the run ends with [`NotSettled`] as its cause.
    #[must_use]
    pub fn fixed(step: f64) -> Self {
        Self {
            fixed: Some(step),
            ..Self::default()
        }
    }

    /// Keeps df/dy from step to step as long as the changes in Newton's iteration shrink to this part or less, 0 ≤ part < 1; 0 finds
    /// it anew for each step. The book recommends 0.001 where a matrix costs little, up to 0.1 where it costs much.
    ///
    /// By default the method keeps it until the iterations which it has needed in excess of those with a new matrix have cost as
    /// many evaluations as that matrix; one that the problem gives counts for nothing.
    #[must_use]
    pub fn with_reuse(mut self, part: f64) -> Self {
        self.reuse = Some(part);
        self
    }

    /// df/dy as it is used, row after row.
    pub(crate) fn jacobian(&self) -> &[f64] {
        &self.jacobian
    }

    /// Finds df/dy at the start of the step.
    fn find_jacobian<P: Ode + ?Sized>(
        &mut self,
        problem: &mut Counted<'_, P>,
        Step { t, h, y }: Step<'_>,
        weights: &Weights,
    ) -> Result<(), EvalError> {
        self.known = Known::Nothing;
        self.systems.clear();
        self.evaluations = 0;
        if !problem.jacobian(t, y, &mut self.jacobian)? {
            self.evaluations = self.layout.active;
            if !self.f_is_exact && self.layout.active > 0 {
                problem.rhs_for_jacobian(t, y, &mut self.f_old)?;
                self.f_is_exact = true;
            }
            let [scratch, ..] = &mut self.stages.f;
            let scratch = [&mut self.y[..], scratch];
            let (active, matrix) = (self.layout.active, &mut self.jacobian);
            differences(problem, (t, h), (y, &self.f_old), weights, active, scratch, matrix)?;
        }
        self.known = Known::Here;
        Ok(())
    }

    /// Whether the next step shall have a new df/dy.
    fn is_outdated(&mut self, convergence: &Convergence) -> bool {
        let iterations = convergence.iterations();
        let new = self.known == Known::Here;
        // Rising by steps of one: a matrix found in a difficult place does not count for much.
        self.usual = iterations.min(self.usual + u32::from(new));
        self.excess = if new {
            0
        } else {
            self.excess + (iterations - self.usual)
        };
        match self.reuse {
            Some(part) => convergence.contraction() > part || part == 0.0,
            None => {
                let paid = 3 * self.excess as usize > self.evaluations;
                convergence.contraction() > if paid { FAST } else { SLOW }
            }
        }
    }

    /// Newton's iteration for one step.
    fn solve<P: Ode + ?Sized>(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
    ) -> Result<Solution, EvalError> {
        // As in subroutine RADAU5, which stops at ten times this rounding; with an old df/dy the changes are a rougher measure.
        let relative = weights.least_relative();
        let rounding = f64::EPSILON / relative;
        let mut convergence = match self.fixed {
            None => Convergence::new(
                MOST_ITERATIONS,
                rounding.max(relative.sqrt().min(0.03)),
                true,
                self.left,
            ),
            Some(_) => Convergence::new(MOST_ITERATIONS_FIXED, rounding, false, 1.0),
        };
        if self.indices.is_higher() {
            convergence = convergence.with_patience();
        }
        if !self.systems.fit(step.h) {
            problem.count_factorisations(2);
            if self.systems.factorise(&self.jacobian, step.h).is_err() {
                return Ok(Solution::Failed(0.5, convergence));
            }
        }
        let start = if self.again { 0.0 } else { 1.0 };
        self.stages.predict(step.h, &self.polynomial, start);
        loop {
            problem.count_iteration();
            if let Some(stage) = self.stages.evaluate(problem, step)? {
                return Ok(Solution::NotFinite(stage));
            }
            let measure = (weights, &mut self.indices);
            let change = self.stages.iterate(&mut self.systems, &self.jacobian, step, measure);
            match convergence.judge(change) {
                Verdict::GoOn => {}
                Verdict::Converged => return Ok(Solution::Found(convergence)),
                Verdict::Failed { factor } => return Ok(Solution::Failed(factor, convergence)),
            }
        }
    }
}

impl<P: Ode + ?Sized> Method<P> for Radau5 {
    fn order(&self) -> u32 {
        5
    }

    fn prepare(&mut self, problem: &P) -> Result<(), SettingsError> {
        let layout = Layout::of(problem)?;
        self.indices = Indices::new(problem)?;
        if self.reuse.is_some_and(|part| !(0.0..1.0).contains(&part)) {
            return Err(SettingsError::Method("needed: 0 <= part of reuse < 1"));
        }
        self.layout = layout;
        self.stages = Stages::new(layout);
        let coefficients = &self.stages.coefficients;
        self.systems = Systems::new(layout, coefficients.real, coefficients.complex);
        self.polynomial = Polynomial::new(coefficients.c, layout.dim);
        self.jacobian = vec![0.0; layout.dim * layout.dim];
        for vector in [&mut self.f_old, &mut self.f_new, &mut self.y, &mut self.jump] {
            *vector = vec![0.0; layout.dim];
        }
        Ok(())
    }

    fn restart(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        self.known = Known::Nothing;
        self.again = false;
        self.polynomial.clear();
        self.prediction = Prediction::default();
        (self.left, self.effort, self.attempts, self.shorten) = (1.0, 1.0, 0, None);
        (self.usual, self.excess) = (USUAL, 0);
        self.f_is_exact = true;
        problem.rhs(t, y, &mut self.f_old)
    }

    fn attempt(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError> {
        let ordinary = self.attempts == 0 && self.polynomial.step().is_some();
        self.attempts += 1;
        self.shorten = None;
        error.fill(0.0);
        let convergence = loop {
            if self.known == Known::Nothing {
                self.find_jacobian(problem, step, weights)?;
            }
            match self.solve(problem, step, weights)? {
                Solution::Found(convergence) => break convergence,
                Solution::NotFinite(stage) => {
                    // The driver refuses this and names the component.
                    y_new.copy_from_slice(&self.stages.f[stage]);
                    return Ok(f64::INFINITY);
                }
                // A fixed step: once more, with what is true here.
                Solution::Failed(..) if self.fixed.is_some() && self.known == Known::Earlier => {
                    self.known = Known::Nothing;
                }
                Solution::Failed(_, convergence) if self.fixed.is_some() => {
                    return Err(EvalError::Retry(Box::new(NotSettled {
                        iterations: convergence.iterations(),
                        change: convergence.change(),
                    })));
                }
                Solution::Failed(factor, _) => {
                    problem.count_divergence();
                    if self.known == Known::Earlier {
                        self.known = Known::Nothing;
                    }
                    self.shorten = Some(factor);
                    y_new.copy_from_slice(step.y);
                    error.copy_from_slice(self.stages.last_change());
                    return Ok(2.0);
                }
            }
        };
        self.left = convergence.left();
        self.effort = effort(convergence.iterations(), MOST_ITERATIONS);
        self.outdated = self.is_outdated(&convergence);
        self.stages.integrate_quadratures(&self.jacobian, step.h);
        for ((y_new, y), z) in y_new.iter_mut().zip(step.y).zip(&self.stages.z[2]) {
            *y_new = y + z;
        }
        if self.fixed.is_some() {
            return Ok(0.0);
        }
        let (systems, jacobian) = (&mut self.systems, &self.jacobian);
        self.stages.estimate(systems, jacobian, step.h, &self.f_old, error);
        let norm = weights.norm(step.y, y_new, self.indices.scale(step.h, [error])[0]);
        if norm < 1.0 || ordinary {
            return Ok(norm);
        }
        // In a transient the estimate may be far too large; once more through the filter it is not.
        for ((target, y), error) in self.y.iter_mut().zip(step.y).zip(&*error) {
            *target = y + error;
        }
        match problem.rhs(step.t, &self.y, &mut self.f_new) {
            Ok(()) if self.f_new.iter().all(|f| f.is_finite()) => {}
            Err(EvalError::Abort(source)) => return Err(EvalError::Abort(source)),
            _ => return Ok(norm),
        }
        self.stages.estimate(systems, jacobian, step.h, &self.f_new, error);
        Ok(weights.norm(step.y, y_new, self.indices.scale(step.h, [error])[0]))
    }

    fn close(
        &mut self,
        _problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        projected: bool,
    ) -> Result<&[f64], EvalError> {
        self.jump.fill(0.0);
        if projected {
            for (i, jump) in self.jump.iter_mut().enumerate() {
                *jump = y_new[i] - (step.y[i] + self.stages.z[2][i]);
            }
        }
        self.stages.rate_at_end(step.h, &mut self.f_new);
        Ok(&self.f_new)
    }

    fn accept(&mut self, h: f64) {
        std::mem::swap(&mut self.f_old, &mut self.f_new);
        self.before = (self.known, self.f_is_exact);
        self.f_is_exact = false;
        self.polynomial.set(h, &self.stages.z);
        (self.attempts, self.again) = (0, false);
        self.known = if self.outdated { Known::Nothing } else { Known::Earlier };
    }

    fn retreat(&mut self) {
        std::mem::swap(&mut self.f_old, &mut self.f_new);
        (self.known, self.f_is_exact) = self.before;
        (self.attempts, self.again) = (1, true);
    }

    fn derivative(&self) -> &[f64] {
        &self.f_old
    }

    fn next_step(&mut self, h: f64, error: f64) -> f64 {
        if let Some(step) = self.fixed {
            return step;
        }
        if let Some(factor) = self.shorten.take() {
            return factor * h;
        }
        if error > 1.0 {
            return self.prediction.after_rejected(h, error, self.effort);
        }
        self.prediction
            .after_accepted(h, error, self.effort, self.known == Known::Earlier)
    }

    fn interpolate(
        &mut self,
        _problem: &mut Counted<'_, P>,
        _step: Step<'_>,
        y_new: &[f64],
        theta: f64,
        y: &mut [f64],
    ) -> Result<(), EvalError> {
        y.copy_from_slice(y_new);
        self.polynomial.add_change(theta, y);
        // The polynomial ends where the step ended before projection, and begins where the step began.
        let before = (1.0 - theta) * (1.0 - theta) * (1.0 + 2.0 * theta);
        y.iter_mut().zip(&self.jump).for_each(|(y, jump)| *y -= before * jump);
        Ok(())
    }

    fn fixed_step(&self) -> Option<f64> {
        self.fixed
    }

    fn solves_algebraic(&self) -> bool {
        true
    }
}

//! Backward differentiation of variable order and step for stiff problems.

mod history;
mod matrix;
mod order;

use crate::newton::{Convergence, Verdict};
use crate::reduced::Layout;
use crate::{Counted, EvalError, Method, Ode, SettingsError, Step, Weights};
use history::{History, MOST};
use matrix::Matrix;
use order::{BETWEEN, COUNTED, Derivatives, Orders, decisive, gamma};

/// Backward differentiation formulas of order 1 to 5 with variable step, for stiff problems whose evaluations are dear.
///
/// A step costs one real system of equations and one evaluation for each iteration of Newton's method, mostly one or two. The
/// formulas have a fixed leading coefficient, so that the matrix of that iteration changes with order and step only (Brenan,
/// Campbell, Petzold 1996, 5.2). The past is kept as divided differences on the steps as they were, and its polynomial is also that
/// of interpolation: of the order of the step, continuous, at no cost.
///
/// Order 1 and 2 are A-stable. Those above are not stable for some vibrations that are hardly damped: what shows it is derivatives that
/// do not fall with their order, and then the order is lowered. This cannot always help: where tight tolerances meet such
/// vibrations the steps may come to follow them. [`Radau5`](crate::Radau5) is for those problems.
///
/// After a start, a stop or an event it begins with order 1 and short steps. Newton's iteration does not see components whose
/// tolerance is infinite: this is meant for [quadratures](Ode::quadratures), which are integrated after it.
#[derive(Debug, Clone)]
pub struct Bdf {
    max_order: usize,
    history: History,
    matrix: Matrix,
    orders: Orders,
    before: Orders,
    derivatives: Derivatives,
    /// f at the state reached, and at the end of the attempt.
    f: Vec<f64>,
    f_new: Vec<f64>,
    /// The prediction of the attempt, h times its slope, f there, and by how much it misses the new state.
    predicted: Vec<f64>,
    rate: Vec<f64>,
    f_predicted: Vec<f64>,
    miss: Vec<f64>,
    /// The new state as closed.
    y_new: Vec<f64>,
    change: Vec<f64>,
    scratch: [Vec<f64>; 3],
    outdated: bool,
    /// Error left per size of the last change of Newton's iteration, see [`Convergence`].
    left: f64,
    /// By how much to shorten a step that Newton's iteration has not solved.
    shorten: Option<f64>,
}

/// How Newton's iteration ended.
enum Solution {
    Found(Convergence),
    /// A step shorter by this factor may succeed.
    Failed(f64),
    /// f is not finite there; it is in `f_new`.
    NotFinite,
}

/// Most iterations of a step.
const MOST_ITERATIONS: u32 = 4;

/// Newton's iteration stops where its error is this part of the tolerance.
const GOAL: f64 = 0.05;

impl Default for Bdf {
    fn default() -> Self {
        let layout = Layout::default();
        Self {
            max_order: MOST,
            history: History::default(),
            matrix: Matrix::new(layout),
            orders: Orders::new(MOST),
            before: Orders::new(MOST),
            derivatives: Derivatives::default(),
            f: Vec::new(),
            f_new: Vec::new(),
            predicted: Vec::new(),
            rate: Vec::new(),
            f_predicted: Vec::new(),
            miss: Vec::new(),
            y_new: Vec::new(),
            change: Vec::new(),
            scratch: Default::default(),
            outdated: false,
            left: 1.0,
            shorten: None,
        }
    }
}

impl Bdf {
    /// With orders up to this one, 1 to 5 (the default).
    #[must_use]
    pub fn with_max_order(mut self, order: usize) -> Self {
        self.max_order = order;
        self
    }

    /// Evaluates f at the end of the attempt, where the prediction misses by `miss`; whether it is finite.
    fn evaluate<P: Ode + ?Sized>(&mut self, problem: &mut Counted<'_, P>, t: f64) -> Result<bool, EvalError> {
        let y = &mut self.scratch[0];
        for ((y, predicted), miss) in y.iter_mut().zip(&self.predicted).zip(&self.miss) {
            *y = predicted + miss;
        }
        problem.rhs(t, y, &mut self.f_new)?;
        Ok(self.f_new.iter().all(|f| f.is_finite()))
    }

    /// Newton's iteration for one step, with a new df/dy where the old one fails.
    fn solve<P: Ode + ?Sized>(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
        gamma: f64,
    ) -> Result<Solution, EvalError> {
        let t_new = step.t + step.h;
        self.miss.fill(0.0);
        if !self.evaluate(problem, t_new)? {
            return Ok(Solution::NotFinite);
        }
        let mut new = false;
        if self.matrix.usable {
            self.f_predicted.copy_from_slice(&self.f_new);
            match self.iterate(problem, step, weights, gamma)? {
                Solution::Found(convergence) => {
                    self.outdated = self.matrix.is_outdated(&convergence, new);
                    return Ok(Solution::Found(convergence));
                }
                _ => {
                    self.left = 1.0;
                    self.miss.fill(0.0);
                    self.f_new.copy_from_slice(&self.f_predicted);
                }
            }
        }
        new = true;
        let [first, second, _] = &mut self.scratch;
        let there = (&self.predicted[..], &self.f_new[..]);
        self.matrix
            .find(problem, (t_new, step.h), there, weights, [first, second])?;
        let solution = self.iterate(problem, step, weights, gamma)?;
        if let Solution::Found(convergence) = &solution {
            self.outdated = self.matrix.is_outdated(convergence, new);
        }
        Ok(solution)
    }

    /// Iterates with the df/dy at hand; f at the prediction is known.
    fn iterate<P: Ode + ?Sized>(
        &mut self,
        problem: &mut Counted<'_, P>,
        Step { t, h, y }: Step<'_>,
        weights: &Weights,
        gamma: f64,
    ) -> Result<Solution, EvalError> {
        let (c, active) = (h / gamma, self.matrix.layout.active);
        let rounding = f64::EPSILON / weights.least_relative();
        let mut convergence = Convergence::new(MOST_ITERATIONS, rounding.max(GOAL), true, self.left);
        if self.matrix.prepare(problem, c).is_err() {
            return Ok(Solution::Failed(0.5));
        }
        loop {
            problem.count_iteration();
            for i in 0..active {
                self.change[i] = (h * self.f_new[i] - self.rate[i]) / gamma - self.miss[i];
            }
            self.change[active..].fill(0.0);
            self.matrix.solve(c, &mut self.change);
            let change = weights.norm(y, &self.predicted, &self.change);
            self.miss.iter_mut().zip(&self.change).for_each(|(miss, x)| *miss += x);
            match convergence.judge(change) {
                Verdict::Converged => return Ok(Solution::Found(convergence)),
                Verdict::Failed { factor } => return Ok(Solution::Failed(factor)),
                Verdict::GoOn => {}
            }
            if !self.evaluate(problem, t + h)? {
                return Ok(Solution::NotFinite);
            }
        }
    }

    /// Integrates the quadratures by the formula. The last change came after f was evaluated; rows of df/dy make that good.
    fn integrate_quadratures(&mut self, h: f64, gamma: f64) {
        let Layout { dim, active, .. } = self.matrix.layout;
        for i in active..dim {
            let f = self.f_new[i] + self.matrix.row_times(i, &self.change);
            self.miss[i] = (h * f - self.rate[i]) / gamma;
        }
    }

    /// Norms of the derivatives that the attempt shows. What it misses is left in `change`, filtered: (1 − c J)⁻¹ takes out what
    /// stiff components show, after a change of the step say, though it is no error of theirs (Hairer, Wanner II, IV.8).
    fn measure(&mut self, y: &[f64], y_new: &[f64], weights: &Weights) {
        let k = self.orders.k;
        let [lower, lowest, higher] = &mut self.scratch;
        self.history.differences(k, &self.miss, [lower, lowest, higher]);
        self.change.copy_from_slice(&self.miss);
        let plain = weights.mean_squares(y, y_new, [&self.change, lower, lowest, higher]);
        for difference in [&mut self.change, &mut *lower, &mut *lowest, &mut *higher] {
            self.matrix.filter(difference);
        }
        let filtered = weights.mean_squares(y, y_new, [&self.change, lower, lowest, higher]);
        let scale = &self.history.coefficients.scale;
        let norm = |place: usize, k: usize| scale[k + 1] * decisive(k, filtered[place].sqrt(), plain[place].sqrt());
        self.derivatives = Derivatives {
            own: norm(0, k),
            lower: norm(1, k - 1),
            lowest: norm(2, k.saturating_sub(2)),
            higher: norm(3, k + 1),
        };
    }
}

impl<P: Ode + ?Sized> Method<P> for Bdf {
    fn order(&self) -> u32 {
        self.orders.k as u32
    }

    fn prepare(&mut self, problem: &P) -> Result<(), SettingsError> {
        let layout = Layout::of(problem)?;
        if !(1..=MOST).contains(&self.max_order) {
            return Err(SettingsError::Method("needed: 1 <= highest order <= 5"));
        }
        self.history = History::new(layout.dim);
        self.matrix = Matrix::new(layout);
        let [first, second, third] = &mut self.scratch;
        for vector in [
            &mut self.f,
            &mut self.f_new,
            &mut self.predicted,
            &mut self.rate,
            &mut self.f_predicted,
            &mut self.miss,
            &mut self.y_new,
            &mut self.change,
            first,
            second,
            third,
        ] {
            *vector = vec![0.0; layout.dim];
        }
        Ok(())
    }

    fn restart(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        self.orders = Orders::new(self.max_order);
        self.matrix.clear();
        self.history.start(y);
        (self.left, self.shorten) = (1.0, None);
        problem.rhs(t, y, &mut self.f)
    }

    fn attempt(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError> {
        self.orders.k = self.orders.next;
        let k = self.orders.k;
        let gamma = gamma(k);
        self.shorten = None;
        self.history.prepare(step.h, &self.f);
        self.history.predict(k, &mut self.predicted, &mut self.rate);
        match self.solve(problem, step, weights, gamma)? {
            Solution::Found(convergence) => self.left = convergence.left(),
            Solution::NotFinite => {
                // The driver refuses this and names the component.
                y_new.copy_from_slice(&self.f_new);
                return Ok(f64::INFINITY);
            }
            Solution::Failed(factor) => {
                problem.count_divergence();
                self.left = 1.0;
                self.shorten = Some(factor);
                y_new.copy_from_slice(step.y);
                error.copy_from_slice(&self.change);
                return Ok(2.0);
            }
        }
        self.integrate_quadratures(step.h, gamma);
        for ((y_new, predicted), miss) in y_new.iter_mut().zip(&self.predicted).zip(&self.miss) {
            *y_new = predicted + miss;
        }
        self.measure(step.y, y_new, weights);
        // What the formula leaves over on the steps as they were, but not less than on equal ones.
        let slope = &self.history.coefficients.slope;
        let part = COUNTED * (slope[k + 1] - gamma).abs().max(slope[k + 1] - slope[k]);
        for (error, miss) in error.iter_mut().zip(&self.change) {
            *error = part * miss;
        }
        let of_formula = weights.norm(step.y, y_new, error);
        let between = BETWEEN[k] * weights.norm(step.y, y_new, &self.miss);
        if between > of_formula {
            for (error, miss) in error.iter_mut().zip(&self.miss) {
                *error = BETWEEN[k] * miss;
            }
            return Ok(between);
        }
        Ok(of_formula)
    }

    fn close(
        &mut self,
        _problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        projected: bool,
    ) -> Result<&[f64], EvalError> {
        // The derivative that the formula takes for that of the solution: f but for what Newton's iteration has left.
        let gamma = gamma(self.orders.k);
        for ((f, rate), miss) in self.f_new.iter_mut().zip(&self.rate).zip(&self.miss) {
            *f = (rate + gamma * miss) / step.h;
        }
        self.y_new.copy_from_slice(y_new);
        if projected {
            // The past goes through the states as they are.
            for ((miss, y_new), predicted) in self.miss.iter_mut().zip(y_new).zip(&self.predicted) {
                *miss = y_new - predicted;
            }
        }
        Ok(&self.f_new)
    }

    fn accept(&mut self, h: f64) {
        self.before = self.orders;
        std::mem::swap(&mut self.f, &mut self.f_new);
        self.history.step(h, self.orders.k, &self.y_new, &self.miss);
        self.orders.after_accepted(h, &self.derivatives);
        self.matrix.usable = !self.outdated;
    }

    fn retreat(&mut self) {
        self.orders = self.before;
        std::mem::swap(&mut self.f, &mut self.f_new);
        self.history.back();
        self.matrix.usable = true;
    }

    fn derivative(&self) -> &[f64] {
        &self.f
    }

    fn next_step(&mut self, h: f64, error: f64) -> f64 {
        if let Some(factor) = self.shorten.take() {
            return factor * h;
        }
        if error > 1.0 {
            return h * self.orders.after_refused(&self.derivatives);
        }
        h * self.orders.factor()
    }

    fn interpolate(
        &mut self,
        _problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        theta: f64,
        y: &mut [f64],
    ) -> Result<(), EvalError> {
        self.history
            .interpolate(self.orders.k, (theta - 1.0) * step.h, y_new, y);
        Ok(())
    }

    fn is_multistep(&self) -> bool {
        true
    }
}

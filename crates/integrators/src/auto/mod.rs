//! The method that chooses between an explicit and an implicit one.

mod account;
mod radius;

use crate::reduced::Layout;
use crate::{Adams, Counted, EvalError, Method, Ode, Radau5, SettingsError, Step, Weights};
use account::{Account, Judgement};
use radius::Radius;

// The numbers here and in `account` say when a trial is worth its cost, not how accurate a step is. They are round numbers, chosen once and not
// tuned: with them the method needs at most 1.25 times the evaluations of the best one on the problems it was measured on.

/// Length of step times spectral radius that the stability of Adams' method allows at the orders that it takes where stiffness limits it.
const STABLE: f64 = 0.5;

/// Mean length of step times rate of change of f from which on stability may be what limits Adams' method.
const SUSPECT: f64 = 0.25;

/// Part that the newest step has in that mean.
const NEWEST: f64 = 0.05;

/// By how much smaller tolerances Adams' method is given where there are events. At loose tolerances it makes many that are none, where
/// a state rests against what releases them; Radau5 does not, whose errors are far below its tolerance.
const STRICTNESS: f64 = 10.0;

/// Evaluations that the account remembers, above two for each component.
const MEMORY: f64 = 50.0;

/// Evaluations that Adams' method needs to gather a history, and Radau5 beyond a matrix to lengthen its steps.
const START: f64 = 25.0;

/// [`Adams`] where the problem is not stiff, [`Radau5`] where it is: chosen by measurement while the run goes on.
///
/// With Adams the change of f from the predicted to the corrected state, over that of the state, shows how stiff the problem is at
/// least (Hairer, Wanner II, IV.2); where h times that comes near the bound of stability, Radau5 is tried. With Radau5 the spectral
/// radius of df/dy shows which steps stability would allow Adams; where these promise to cost less, Adams is tried. A method on trial
/// stays once it has needed fewer evaluations than the other would have, at the rate at which it needed them before.
///
/// Times are not measured, so that runs repeat bit for bit; linear algebra counts for nothing. At an event or a stop the method that
/// runs begins anew. A problem with [algebraic equations](Ode::algebraic) is left to Radau5.
#[derive(Debug, Clone)]
pub struct Auto {
    adams: Adams,
    radau: Radau5,
    layout: Layout,
    now: Family,
    /// The other method begins with the next attempt.
    due: bool,
    account: Account,
    /// h times the change of f, by the change of the state, mean over some steps.
    stiffness: f64,
    /// Evaluations at the end of the last step, and of the attempt.
    counted: u64,
    counted_new: u64,
    /// `account`, `stiffness` and `counted` before the last step.
    before: (Account, f64, u64),
    /// h times the change of f in the attempt.
    stiffness_new: f64,
    radius: Radius,
    /// df/dy at which the radius was found, by number, and that radius.
    known: u64,
    largest: f64,
    /// Norm of what the last step has moved off its tangent.
    bend: f64,
    scratch: Vec<f64>,
}

/// Which method runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Family {
    Explicit,
    Implicit,
}

impl Default for Auto {
    fn default() -> Self {
        Self {
            adams: Adams::default(),
            radau: Radau5::default(),
            layout: Layout::default(),
            now: Family::Explicit,
            due: false,
            account: Account::new(1.0),
            stiffness: 0.0,
            counted: 0,
            counted_new: 0,
            before: (Account::new(1.0), 0.0, 0),
            stiffness_new: 0.0,
            radius: Radius::default(),
            known: 0,
            largest: f64::INFINITY,
            bend: 1.0,
            scratch: Vec::new(),
        }
    }
}

impl Auto {
    /// The method that runs.
    fn method<P: Ode + ?Sized>(&self) -> &dyn Method<P> {
        match self.now {
            Family::Explicit => &self.adams,
            Family::Implicit => &self.radau,
        }
    }

    fn method_mut<P: Ode + ?Sized>(&mut self) -> &mut dyn Method<P> {
        match self.now {
            Family::Explicit => &mut self.adams,
            Family::Implicit => &mut self.radau,
        }
    }

    /// Begins at (t, y), with the other method if that is due.
    fn begin<P: Ode + ?Sized>(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        let before = self.now;
        if self.due {
            self.now = before.other();
        }
        if let Err(error) = self.method_mut().restart(problem, t, y) {
            self.now = before;
            return Err(error);
        }
        if self.due {
            (self.due, self.stiffness, self.largest) = (false, 0.0, f64::INFINITY);
        }
        Ok(())
    }

    /// Evaluations per time that the other method needs at least, as far as can be known before it is tried.
    fn least_rate_of_other(&self) -> f64 {
        match self.now {
            Family::Explicit if self.stiffness > SUSPECT => 0.0,
            Family::Implicit if self.layout.algebraic == 0 => 2.0 * self.largest / STABLE,
            _ => f64::INFINITY,
        }
    }

    /// Evaluations that the other method needs to get going.
    fn start_of_other(&self) -> f64 {
        match self.now {
            Family::Explicit => START + self.layout.active as f64,
            Family::Implicit => START,
        }
    }

    /// Decides who goes on after a step of this length.
    fn decide(&mut self, h: f64) {
        let spent = self.counted_new - self.counted;
        self.counted = self.counted_new;
        if self.now == Family::Explicit {
            self.stiffness += NEWEST * (self.stiffness_new.min(1.0) - self.stiffness);
        }
        if self.account.book(spent as f64, h.abs()) == Judgement::GoBack {
            self.account.go_back();
            self.due = true;
        } else if self.account.is_worth_trying(self.least_rate_of_other()) {
            self.account.try_other(self.start_of_other());
            self.due = true;
        }
    }
}

impl Family {
    fn other(self) -> Self {
        match self {
            Self::Explicit => Self::Implicit,
            Self::Implicit => Self::Explicit,
        }
    }
}

impl<P: Ode + ?Sized> Method<P> for Auto {
    fn order(&self) -> u32 {
        self.method::<P>().order()
    }

    fn prepare(&mut self, problem: &P) -> Result<(), SettingsError> {
        self.adams.prepare(problem)?;
        self.adams
            .set_strictness(if problem.roots() > 0 { STRICTNESS } else { 1.0 });
        self.radau.prepare(problem)?;
        self.layout = Layout::of(problem)?;
        self.radius = Radius::new(self.layout);
        self.account = Account::new(MEMORY + 2.0 * self.layout.active as f64);
        self.scratch = vec![0.0; self.layout.dim];
        if self.layout.algebraic > 0 {
            self.now = Family::Implicit;
        }
        Ok(())
    }

    fn restart(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        self.begin(problem, t, y)
    }

    fn attempt(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError> {
        if self.due {
            self.begin(problem, step.t, step.y)?;
        }
        let norm = self.method_mut().attempt(problem, step, weights, y_new, error)?;
        if self.now == Family::Implicit {
            if problem.statistics().jacobians != self.known {
                self.known = problem.statistics().jacobians;
                self.largest = self.radius.find(self.radau.jacobian());
            }
            let tangent = Method::<P>::derivative(&self.radau);
            for (((bend, new), old), rate) in self.scratch.iter_mut().zip(&*y_new).zip(step.y).zip(tangent) {
                *bend = new - old - step.h * rate;
            }
            self.bend = weights.norm(step.y, y_new, &self.scratch);
        }
        Ok(norm)
    }

    fn close(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        projected: bool,
    ) -> Result<&[f64], EvalError> {
        let predicted = &mut self.scratch;
        if self.now == Family::Explicit {
            predicted.copy_from_slice(self.adams.rate_at_end());
            self.adams.close(problem, step, y_new, projected)?;
            self.stiffness_new = step.h.abs() * self.adams.sensitivity(predicted, y_new);
            self.counted_new = problem.statistics().evaluations;
            return Ok(self.adams.rate_at_end());
        }
        self.counted_new = problem.statistics().evaluations;
        self.radau.close(problem, step, y_new, projected)
    }

    fn accept(&mut self, h: f64) {
        self.method_mut::<P>().accept(h);
        self.before = (self.account, self.stiffness, self.counted);
        self.decide(h);
    }

    fn retreat(&mut self) {
        self.method_mut::<P>().retreat();
        (self.account, self.stiffness, self.counted) = self.before;
        self.due = false;
    }

    fn derivative(&self) -> &[f64] {
        match self.now {
            Family::Explicit => Method::<P>::derivative(&self.adams),
            Family::Implicit => Method::<P>::derivative(&self.radau),
        }
    }

    fn next_step(&mut self, h: f64, error: f64) -> f64 {
        let next = self.method_mut::<P>().next_step(h, error);
        if self.due && self.now == Family::Implicit && error <= 1.0 {
            // Adams' method starts with order 1, whose error is what a step moves off its tangent.
            return next.min(h * (0.25 / self.bend).sqrt());
        }
        next
    }

    fn interpolate(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        theta: f64,
        y: &mut [f64],
    ) -> Result<(), EvalError> {
        self.method_mut().interpolate(problem, step, y_new, theta, y)
    }

    fn interpolation_evaluations(&self) -> u32 {
        self.method::<P>().interpolation_evaluations()
    }

    fn is_multistep(&self) -> bool {
        self.method::<P>().is_multistep()
    }

    fn solves_algebraic(&self) -> bool {
        true
    }
}

//! The driver: one loop for all methods.

mod events;

use crate::control::first_step;
use crate::event::{Events, Since};
use crate::lanes::{LANES, Lanes};
use crate::settings::check_step;
use crate::{Counted, EvalError, IntegrationError, Method, Ode, Settings, SettingsError, Statistics, Step, Weights};

/// What [`Integration::advance`] has reached. The state is at this time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Progress {
    /// An ordinary step.
    Step {
        /// Time reached.
        t: f64,
    },
    /// One of the [stops](Integration::with_stops).
    Stop {
        /// Time reached, exactly that of the stop.
        t: f64,
    },
    /// A [root function](Ode::root) met zero, and the problem has [changed](Ode::at_event) the state.
    Event {
        /// Time reached, that of the event.
        t: f64,
    },
    /// The end that was asked for.
    Done {
        /// Time reached, exactly that asked for.
        t: f64,
    },
}

/// A running integration of a problem by a method.
///
/// The steps never depend on where the state is [interpolated](Integration::interpolate), so output may be as dense as one likes.
///
/// # Events
/// If the problem has [root functions](Ode::root), each step is searched for the first place where one of them, having been
/// positive, becomes zero or negative. The step is then made again with the length that leads there, so that the state at the
/// event is as good as that of any step and on the invariants, not merely interpolated; what time is left, some 1e-7 of the step
/// at most, is passed along the tangent until the root is met to rounding. [`Ode::at_event`] changes the state, the method forgets
/// all earlier steps and chooses a new first step, not longer than the one before. Times of events never decrease, and they are
/// equal only for events that follow from each other at one time.
///
/// Values and slopes of a root function at both ends of a step show a change of sign and also a dip, a touch shorter than the
/// step. Missed is what the cubic polynomial through them does not show: two dips in one step, or one much narrower than it.
/// A function that touches zero without becoming negative fires
/// or not, as rounding has it. A longest step (`max_step`) helps where that matters.
#[derive(Debug)]
pub struct Integration<P, M> {
    problem: P,
    method: M,
    weights: Weights,
    first_step: Option<f64>,
    max_step: f64,
    max_steps: u64,
    max_events: u64,
    stops: Vec<f64>,
    statistics: Statistics,
    t: f64,
    y: Vec<f64>,
    /// Beginning of the last step; its end is (t, y).
    t_old: f64,
    y_old: Vec<f64>,
    /// Result and error of an attempt.
    y_new: Vec<f64>,
    error: Vec<f64>,
    /// Length wanted for the next step, before it is cut to reach a time exactly; none before the first.
    h: Option<f64>,
    direction: f64,
    restart_due: bool,
    events: Events,
}

/// What was found in an attempt that seemed to hold an event.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Found {
    /// At the state reached: the attempt has been undone.
    Here,
    /// At this time: the attempt has been made again and ends there.
    At(f64),
    /// None after all: the attempt has been made again and ends at this time.
    Nothing(f64),
}

/// Shortest step, of the time.
const LEAST_STEP: f64 = 8.0 * f64::EPSILON;

/// Why an attempt was thrown away.
enum Refusal {
    Inaccurate { error: f64 },
    NonFinite { component: usize },
    NonFiniteRoot { function: usize },
    Evaluation(EvalError),
}

impl From<EvalError> for Refusal {
    fn from(error: EvalError) -> Self {
        Self::Evaluation(error)
    }
}

impl<P: Ode, M: Method<P>> Integration<P, M> {
    /// Starts at (`t0`, `y0`). Nothing is evaluated before the first [`advance`](Integration::advance).
    ///
    /// `problem` may be a value or a `&mut` reference.
    ///
    /// # Errors
    /// [`IntegrationError::Settings`] if anything given makes no sense.
    pub fn new(problem: P, mut method: M, t0: f64, y0: &[f64], settings: Settings) -> Result<Self, IntegrationError> {
        let dim = problem.dim();
        let (relative, absolute) = settings.validate(dim)?;
        check_start(dim, t0, y0)?;
        if let Some(step) = method.fixed_step() {
            check_step("step of the method", step)?;
        }
        if problem.algebraic() > 0 && !method.solves_algebraic() {
            return Err(SettingsError::Method("it cannot solve algebraic equations; implicit methods can").into());
        }
        method.prepare(&problem)?;
        Ok(Self {
            events: Events::new(problem.roots(), dim),
            problem,
            first_step: method.fixed_step().or(settings.first_step),
            method,
            weights: Weights::new(&relative, &absolute),
            max_step: settings.max_step,
            max_steps: settings.max_steps,
            max_events: settings.max_events,
            stops: Vec::new(),
            statistics: Statistics::default(),
            t: t0,
            y: y0.to_vec(),
            t_old: t0,
            y_old: y0.to_vec(),
            y_new: vec![0.0; dim],
            error: vec![0.0; dim],
            h: None,
            direction: 1.0,
            restart_due: true,
        })
    }

    /// Adds times on which a step must end exactly: kinks or jumps of the right-hand side, which no step should cross.
    ///
    /// There the method forgets earlier steps, f is evaluated anew at the next [`advance`](Integration::advance) (so that a problem
    /// with a jump can be switched in between), and methods that need it choose a new first step. An event at the time of a stop
    /// is reported first, the stop by the next call.
    ///
    /// # Errors
    /// [`SettingsError::NotFinite`].
    pub fn with_stops(mut self, stops: &[f64]) -> Result<Self, IntegrationError> {
        if let Some(&value) = stops.iter().find(|stop| !stop.is_finite()) {
            return Err(SettingsError::NotFinite { name: "stop", value }.into());
        }
        self.stops.extend_from_slice(stops);
        self.stops.sort_unstable_by(f64::total_cmp);
        Ok(self)
    }

    /// Makes one accepted step toward `until`, which is reached exactly; forward or backward in time.
    ///
    /// `until` is where the integration is to end, not a grid of output: the last step is cut to reach it. An event ends the step
    /// earlier; an event at the time of `until` is reported first, the end by the next call.
    /// After an error the state is that of the last accepted step.
    ///
    /// # Errors
    /// [`IntegrationError`].
    pub fn advance(&mut self, until: f64) -> Result<Progress, IntegrationError> {
        if until.is_nan() {
            return Err(SettingsError::NotFinite {
                name: "until",
                value: until,
            }
            .into());
        }
        if until == self.t {
            return Ok(Progress::Done { t: self.t });
        }
        if std::mem::take(&mut self.events.stop_pending) {
            return Ok(Progress::Stop { t: self.t });
        }
        self.turn_toward(until);
        let goal = self.next_stop(until).unwrap_or(until);
        self.restart_if_due(goal)?;
        if self.fires_at_once(goal)? {
            return self.meet(Found::Here, goal, until);
        }
        let wanted = self.h.unwrap_or(f64::INFINITY);
        let mut refusal = None;
        loop {
            let (h, t_new) = self.cut(goal);
            self.count_attempt()?;
            let attempt = self.attempt(h, t_new);
            match attempt.and_then(|error| Ok((error, self.event_in(h, t_new)?))) {
                Ok((_, Some(found))) => return self.meet(found, goal, until),
                Ok((error, None)) => {
                    self.statistics.accepted += 1;
                    self.choose_next_step(h, error, refusal.is_some(), if t_new == goal { wanted } else { 0.0 });
                    return Ok(self.arrive(t_new, goal, until));
                }
                Err(refused) => {
                    self.statistics.rejected += 1;
                    self.shorten(h, &refused);
                    refusal = Some(self.check_refusal(h, refused)?);
                }
            }
        }
    }

    /// Time and state reached.
    pub fn state(&self) -> (f64, &[f64]) {
        (self.t, &self.y)
    }

    /// The beginning and the end of the last step, between which [`interpolate`](Integration::interpolate) works.
    pub fn last_step(&self) -> (f64, f64) {
        (self.t_old, self.t)
    }

    /// Writes the state at a time within the last step. If that led to an event, it is the state before the event changed it, up to
    /// the time of the event; [`state`](Integration::state) is the one after.
    ///
    /// Methods that need further evaluations for this make them once, at the first call in a step. The result is not
    /// projected; [`Ode::project`] does that for whoever needs it.
    ///
    /// # Errors
    /// [`IntegrationError::OutsideStep`]; those of the problem.
    ///
    /// # Panics
    /// If `y` is not as long as the state.
    pub fn interpolate(&mut self, t: f64, y: &mut [f64]) -> Result<(), IntegrationError> {
        let (from, to) = self.last_step();
        if !(from.min(to) <= t && t <= from.max(to)) {
            return Err(IntegrationError::OutsideStep { time: t, from, to });
        }
        let (reached, t_end, y_end) = match &self.events {
            events if events.at_event => (&events.y_before, events.t_end, &events.y_end),
            _ => (&self.y, to, &self.y),
        };
        if t == to {
            y.copy_from_slice(reached);
            return Ok(());
        }
        if t == from {
            y.copy_from_slice(&self.y_old);
            return Ok(());
        }
        let h = t_end - from;
        let step = Step {
            t: from,
            h,
            y: &self.y_old,
        };
        let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
        let done = self.method.interpolate(&mut problem, step, y_end, (t - from) / h, y);
        done.map_err(|error| fatal(t, error))?;
        match first_non_finite(y) {
            Some(component) => Err(IntegrationError::NonFinite {
                time: t,
                step: h,
                component,
            }),
            None => Ok(()),
        }
    }

    /// Continues from another state: all memory of earlier steps is dropped, the counters go on.
    ///
    /// # Errors
    /// [`IntegrationError::Settings`] if length or numbers make no sense.
    pub fn restart(&mut self, t: f64, y: &[f64]) -> Result<(), IntegrationError> {
        check_start(self.y.len(), t, y)?;
        (self.t, self.t_old) = (t, t);
        self.y.copy_from_slice(y);
        self.restart_due = true;
        self.events.start();
        Ok(())
    }

    /// Which [root functions](Ode::root) met zero, if the last step led to an event; all `false` otherwise.
    pub fn fired(&self) -> &[bool] {
        &self.events.fired
    }

    /// What the run has cost so far.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// The problem.
    pub fn problem(&self) -> &P {
        &self.problem
    }

    /// The problem, to change it between two steps; [`restart`](Integration::restart) if its right-hand side changes thereby.
    pub fn problem_mut(&mut self) -> &mut P {
        &mut self.problem
    }

    /// The method.
    pub fn method(&self) -> &M {
        &self.method
    }

    /// Sets the direction of time; a memory of steps in the other direction is of no use.
    fn turn_toward(&mut self, until: f64) {
        let direction = (until - self.t).signum();
        self.restart_due |= self.method.is_multistep() && direction != self.direction;
        self.direction = direction;
    }

    /// Evaluates f at the start and chooses a first step, which evaluates f on the way to `goal`.
    fn restart_if_due(&mut self, goal: f64) -> Result<(), IntegrationError> {
        if !self.restart_due {
            return Ok(());
        }
        let (t, y) = (self.t, &self.y[..]);
        self.t_old = t;
        let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
        self.method
            .restart(&mut problem, t, y)
            .map_err(|error| fatal(t, error))?;
        if let Some(component) = first_non_finite(self.method.derivative()) {
            return Err(IntegrationError::NonFinite {
                time: t,
                step: 0.0,
                component,
            });
        }
        let after_event = self.events.since == Since::Event;
        if self.h.is_none() || self.method.is_multistep() || after_event {
            let limit = (goal - t).abs().min(self.max_step);
            let scratch = [&mut self.y_new[..], &mut self.error[..]];
            let h = match self.first_step {
                Some(h) => h,
                None => first_step(
                    &mut problem,
                    (t, self.direction, limit),
                    (y, self.method.derivative()),
                    self.method.order(),
                    &self.weights,
                    scratch,
                )
                .map_err(|error| fatal(t, error))?,
            };
            let longest = self.h.filter(|_| after_event).unwrap_or(f64::INFINITY);
            self.h = Some(h.min(self.max_step).min(longest));
        }
        self.restart_due = false;
        self.events.restart();
        Ok(())
    }

    /// The next stop between here and `until`.
    fn next_stop(&self, until: f64) -> Option<f64> {
        let next = if self.direction > 0.0 {
            self.stops.get(self.stops.partition_point(|&stop| stop <= self.t))
        } else {
            self.stops[..self.stops.partition_point(|&stop| stop < self.t)].last()
        };
        next.copied()
            .filter(|stop| (until - stop) * self.direction > 0.0 || *stop == until)
    }

    fn is_stop(&self, t: f64) -> bool {
        self.stops.binary_search_by(|stop| stop.total_cmp(&t)).is_ok()
    }

    /// Signed length and end of the next attempt: the wanted step, cut or stretched by at most 1 % to end on `goal`; a fixed or longest
    /// step by 1e-9 only, so that rounding of t does not leave a splinter.
    fn cut(&self, goal: f64) -> (f64, f64) {
        let longest = self.method.fixed_step().unwrap_or(f64::INFINITY).min(self.max_step);
        // Never so short that t would not change: what makes steps so short is then met, and told, by a real attempt.
        let wanted = self
            .h
            .unwrap_or(f64::INFINITY)
            .max(LEAST_STEP * self.t.abs())
            .min(longest);
        if (goal - self.t).abs() <= (1.01 * wanted).min((1.0 + 1e-9) * longest) {
            (self.length_to(goal), goal)
        } else {
            let t_new = self.t + self.direction * wanted;
            (t_new - self.t, t_new)
        }
    }

    /// Signed length of a step to `t_new`, rounded so that t + h is not beyond, where f may be another.
    fn length_to(&self, t_new: f64) -> f64 {
        let left = t_new - self.t;
        if (self.t + left - t_new) * self.direction > 0.0 {
            left - self.direction * (left.abs() - left.abs().next_down())
        } else {
            left
        }
    }

    fn count_attempt(&self) -> Result<(), IntegrationError> {
        let Statistics {
            accepted,
            rejected,
            relocations,
            ..
        } = self.statistics;
        let steps = accepted + rejected + relocations;
        if steps >= self.max_steps {
            return Err(IntegrationError::TooManySteps { time: self.t, steps });
        }
        Ok(())
    }

    /// One attempt; on success the new state is in `y_new`, on the invariants, and the method has moved on.
    fn attempt(&mut self, h: f64, t_new: f64) -> Result<f64, Refusal> {
        if t_new == self.t {
            return Err(Refusal::Inaccurate { error: f64::INFINITY });
        }
        let step = Step {
            t: self.t,
            h,
            y: &self.y,
        };
        let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
        let error = self
            .method
            .attempt(&mut problem, step, &self.weights, &mut self.y_new, &mut self.error)?;
        if let Some(component) = first_non_finite(&self.y_new) {
            return Err(Refusal::NonFinite { component });
        }
        if !error.is_finite()
            && let Some(component) = first_non_finite(&self.error)
        {
            return Err(Refusal::NonFinite { component });
        }
        if self.method.fixed_step().is_none() && (error.is_nan() || error > 1.0) {
            return Err(Refusal::Inaccurate { error });
        }
        self.statistics.projections += 1;
        let projected = self.problem.project(t_new, &mut self.y_new)?;
        let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
        let f_new = self.method.close(&mut problem, step, &self.y_new, projected)?;
        if let Some(component) = first_non_finite(f_new) {
            return Err(Refusal::NonFinite { component });
        }
        self.method.accept(h);
        Ok(error)
    }

    /// The step after an accepted one: no growth after a refusal, no loss because this one was cut short of `wanted`.
    fn choose_next_step(&mut self, h: f64, error: f64, refused: bool, wanted: f64) {
        let h = h.abs();
        let mut next = self.method.next_step(h, error);
        if refused {
            next = next.min(h);
        } else if next >= h {
            next = next.max(wanted);
        }
        self.h = Some(next.min(self.max_step));
    }

    fn shorten(&mut self, h: f64, refused: &Refusal) {
        let h = h.abs();
        self.h = Some(match refused {
            Refusal::Inaccurate { error } if error.is_finite() => self.method.next_step(h, *error),
            _ => 0.25 * h,
        });
    }

    /// Passes a refusal on if a shorter step may help, else makes it an error.
    fn check_refusal(&mut self, h: f64, refused: Refusal) -> Result<Refusal, IntegrationError> {
        let (time, step) = (self.t, h);
        let next = self.h.unwrap_or(0.0);
        let stuck = self.method.fixed_step().is_some() || next <= LEAST_STEP * time.abs() || next < f64::MIN_POSITIVE;
        if let Refusal::Evaluation(EvalError::Retry(_)) = &refused {
            self.statistics.retries += 1;
        }
        let fixed = self.method.fixed_step().is_some();
        let error = match refused {
            Refusal::Evaluation(EvalError::Abort(source)) => IntegrationError::Problem { time, source },
            refused if !stuck => return Ok(refused),
            Refusal::Evaluation(EvalError::Retry(source)) if fixed => IntegrationError::Problem { time, source },
            Refusal::Evaluation(EvalError::Retry(source)) => IntegrationError::StepTooSmall {
                time,
                step,
                component: None,
                source: Some(source),
            },
            Refusal::NonFinite { component } => IntegrationError::NonFinite { time, step, component },
            Refusal::NonFiniteRoot { function } => IntegrationError::NonFiniteRoot { time, function },
            Refusal::Inaccurate { .. } => {
                let component = self.weights.worst(&self.y, &self.y_new, &self.error);
                IntegrationError::StepTooSmall {
                    time,
                    step,
                    component,
                    source: None,
                }
            }
        };
        self.t_old = self.t;
        self.restart_due = true;
        self.events.at_event = false;
        Err(error)
    }

    /// Makes the accepted attempt the state.
    fn arrive(&mut self, t_new: f64, goal: f64, until: f64) -> Progress {
        self.t_old = std::mem::replace(&mut self.t, t_new);
        std::mem::swap(&mut self.y_old, &mut self.y);
        std::mem::swap(&mut self.y, &mut self.y_new);
        self.events.step();
        let t = t_new;
        if t == goal {
            self.restart_due = self.is_stop(goal);
        }
        match t {
            t if t == until => Progress::Done { t },
            t if t == goal => Progress::Stop { t },
            t => Progress::Step { t },
        }
    }
}

fn check_start(dim: usize, t: f64, y: &[f64]) -> Result<(), SettingsError> {
    if y.len() != dim {
        return Err(SettingsError::Length {
            name: "start",
            expected: dim,
            found: y.len(),
        });
    }
    let mut numbers = std::iter::once(("start time", t)).chain(y.iter().map(|&value| ("start", value)));
    match numbers.find(|(_, value)| !value.is_finite()) {
        Some((name, value)) => Err(SettingsError::NotFinite { name, value }),
        None => Ok(()),
    }
}

/// An evaluation that cannot be repeated with a smaller step.
fn fatal(time: f64, error: EvalError) -> IntegrationError {
    match error {
        EvalError::Retry(source) | EvalError::Abort(source) => IntegrationError::Problem { time, source },
    }
}

fn first_non_finite(values: &[f64]) -> Option<usize> {
    // 0 · x is not a number where x is not finite; sums in blocks are many times faster than a search.
    let (blocks, rest) = values.as_chunks::<LANES>();
    let zeros = blocks.iter().fold(Lanes::ZERO, |sum, &block| sum + 0.0 * Lanes(block));
    if rest.iter().fold(zeros.sum(), |sum, value| sum + 0.0 * value) == 0.0 {
        return None;
    }
    values.iter().position(|value| !value.is_finite())
}

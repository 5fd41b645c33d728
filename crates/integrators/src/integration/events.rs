//! Events in the driver: search in a step, the step made again up to the event, and the change there.

use super::{Found, Integration, Progress, Refusal, fatal, first_non_finite};
use crate::event::{Functions, Since};
use crate::root::{PROBE, Sample, bump, earliest};
use crate::{Counted, EvalError, IntegrationError, Method, Ode, Step};

/// Most times that a step is made again before its end counts as the event: for functions that have no slope there.
const MOST_REDONE: usize = 6;

/// Part of a step that may be passed along the tangent: what is neglected is the square of it.
const TANGENT: f64 = 1e-7;

/// Most corrections along the tangent; the second one is of the size of rounding.
const MOST_TANGENTS: usize = 4;

/// Most events at one time.
const MOST_AT_ONCE: u64 = 100;

/// How the end of a step lies to the root it was aimed at.
enum Approach {
    /// There, after what was left has been passed; the time.
    Met(f64),
    /// The time, with sign, that is left to it.
    Missed(f64),
    /// No function falls toward zero.
    Unclear,
}

/// Spacing of times that can be told apart between two times.
fn resolution(from: f64, to: f64) -> f64 {
    4.0 * f64::EPSILON * from.abs().max(to.abs())
}

/// Length of time, with the sign of `h`, over which slopes are measured in a step of length `h` at `t`.
fn probe(t: f64, h: f64) -> f64 {
    (PROBE * h.abs()).max(16.0 * resolution(t, t)).min(h.abs()).copysign(h)
}

/// Values of all root functions at (t, y).
fn measure_values<P: Ode>(
    problem: &mut Counted<'_, P>,
    (t, y): (f64, &[f64]),
    values: &mut [f64],
) -> Result<(), Refusal> {
    problem.root(t, y, values)?;
    check_finite(values)
}

/// Their slopes by a `probe` along the tangent `f`, where the values are known; `scratch` is overwritten.
fn measure_slopes<P: Ode>(
    problem: &mut Counted<'_, P>,
    (t, y, f): (f64, &[f64], &[f64]),
    probe: f64,
    scratch: &mut [f64],
    Functions { values, slopes }: &mut Functions,
) -> Result<(), Refusal> {
    for ((there, y), f) in scratch.iter_mut().zip(y).zip(f) {
        *there = y + probe * f;
    }
    problem.root(t + probe, scratch, slopes)?;
    for (slope, value) in slopes.iter_mut().zip(values) {
        *slope = (*slope - *value) / probe;
    }
    check_finite(slopes)
}

fn check_finite(functions: &[f64]) -> Result<(), Refusal> {
    match first_non_finite(functions) {
        Some(function) => Err(Refusal::NonFiniteRoot { function }),
        None => Ok(()),
    }
}

impl<P: Ode, M: Method<P>> Integration<P, M> {
    /// The first event in the attempt just made, which is then undone or made again.
    #[inline]
    pub(super) fn event_in(&mut self, h: f64, t_new: f64) -> Result<Option<Found>, Refusal> {
        if self.events.none() {
            return Ok(None);
        }
        match self.search_or_retreat(h, t_new)? {
            Some(first) => self.land(first, h, t_new).map(Some),
            None => Ok(None),
        }
    }

    fn search_or_retreat(&mut self, h: f64, t_new: f64) -> Result<Option<(f64, usize)>, Refusal> {
        self.search(h, t_new).inspect_err(|_| self.method.retreat())
    }

    /// Where in the step the first function becomes negative after it has been positive, as interpolation has it, and which.
    fn search(&mut self, h: f64, t_new: f64) -> Result<Option<(f64, usize)>, Refusal> {
        self.measure_end(h, t_new)?;
        let least = resolution(self.t, t_new) / h.abs();
        let (mut first, mut end) = (None, 1.0);
        for k in 0..self.events.armed.len() {
            let sample = |at, functions: &Functions| Sample {
                at,
                value: functions.values[k],
                slope: h * functions.slopes[k],
            };
            let (mut start, last) = (sample(0.0, &self.events.reached), sample(end, &self.events.trial));
            let armed = self.events.armed[k];
            let mut g = |theta| self.root_within(h, theta, k);
            if !armed {
                match bump(start, last, &mut g)? {
                    Some(positive) => start = positive,
                    None => continue,
                }
            }
            let Some(theta) = earliest(start, last, least, &mut g)? else {
                continue;
            };
            (first, end) = (Some((theta, k)), theta);
            if theta <= least {
                break;
            }
            if k + 1 < self.events.armed.len() {
                self.measure_within(h, theta)?;
            }
        }
        Ok(first)
    }

    /// Makes the step again so that it ends where root `function` is met, near `theta`; marks the functions that fire.
    ///
    /// Interpolation may have been wrong by its error: then the shorter step is searched in turn, and taken as it is if it holds no
    /// event.
    fn land(&mut self, first: (f64, usize), h: f64, t_new: f64) -> Result<Found, Refusal> {
        let resolution = resolution(self.t, t_new);
        let (mut aim, mut function) = (self.t + first.0 * h, first.1);
        let (mut reached, mut step) = (t_new, h);
        // Ends before the root and beyond it.
        let (mut before, mut beyond) = (self.t, None);
        let mut met = false;
        for _ in 0..MOST_REDONE {
            if (aim - t_new) * self.direction > 0.0 {
                aim = t_new;
            }
            if (aim - self.t).abs() <= resolution {
                self.method.retreat();
                self.statistics.relocations += 1;
                self.events.mark(true, function, self.direction, resolution);
                return Ok(Found::Here);
            }
            if aim != reached {
                step = self.length_to(aim);
                self.redo(step, aim)?;
                reached = aim;
            }
            let approach = self.approach(step, reached, t_new, function);
            let rest = match approach.inspect_err(|_| self.method.retreat())? {
                Approach::Met(t) => {
                    (reached, met) = (t, true);
                    break;
                }
                Approach::Missed(rest) => rest,
                Approach::Unclear => match self.search_or_retreat(step, reached)? {
                    Some((theta, other)) => {
                        (aim, function) = (self.t + theta * step, other);
                        continue;
                    }
                    None if beyond.is_none() => return Ok(Found::Nothing(reached)),
                    None => f64::INFINITY * self.direction,
                },
            };
            if rest * self.direction < 0.0 {
                beyond = Some(reached);
            } else {
                before = reached;
            }
            // Not too far: the slope at the end of the step says little about the rest of it.
            aim = reached + rest.clamp(-0.9 * step.abs(), 0.5 * step.abs());
            if let Some(beyond) = beyond
                && !((before - aim) * self.direction < 0.0 && (aim - beyond) * self.direction < 0.0)
            {
                // The function jumps.
                if beyond != reached {
                    step = self.length_to(beyond);
                    self.redo(step, beyond)?;
                    self.measure_end(step, beyond).inspect_err(|_| self.method.retreat())?;
                    self.events.y_end.copy_from_slice(&self.y_new);
                    (reached, self.events.t_end) = (beyond, beyond);
                }
                break;
            }
        }
        if !met && !self.events.any_passed(function) {
            return Ok(Found::Nothing(reached));
        }
        self.events.mark(false, function, self.direction, resolution);
        self.prepare_interpolation(step)
            .inspect_err(|_| self.method.retreat())?;
        Ok(Found::At(reached))
    }

    /// Makes the step again with another length.
    fn redo(&mut self, step: f64, t: f64) -> Result<(), Refusal> {
        self.method.retreat();
        self.statistics.relocations += 1;
        self.attempt(step, t)?;
        Ok(())
    }

    /// Measures the root functions at the end of a step, at `t`, and goes on along the tangent to the first root, if it is close
    /// enough for that and not beyond `most`.
    fn approach(&mut self, step: f64, mut t: f64, most: f64, function: usize) -> Result<Approach, Refusal> {
        self.measure_end(step, t)?;
        self.events.y_end.copy_from_slice(&self.y_new);
        self.events.t_end = t;
        for tangents in 0..MOST_TANGENTS {
            let Some(mut rest) = self.events.time_left(function, self.direction) else {
                return Ok(if tangents == 0 {
                    Approach::Unclear
                } else {
                    Approach::Met(t)
                });
            };
            if rest.abs() > TANGENT * step.abs() {
                return Ok(if tangents == 0 {
                    Approach::Missed(rest)
                } else {
                    Approach::Met(t)
                });
            }
            if (t + rest - most) * self.direction > 0.0 {
                rest = most - t;
            }
            t += rest;
            for (y, f) in self.y_new.iter_mut().zip(self.method.derivative()) {
                *y += rest * f;
            }
            if rest.abs() <= resolution(t, t) {
                break;
            }
            let values = &mut self.events.trial.values;
            let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
            measure_values(&mut problem, (t, &self.y_new), values)?;
        }
        Ok(Approach::Met(t))
    }

    /// Makes the evaluations that interpolation needs as long as the problem is still what it was in the step.
    fn prepare_interpolation(&mut self, h: f64) -> Result<(), Refusal> {
        if self.method.interpolation_evaluations() == 0 {
            return Ok(());
        }
        let step = Step {
            t: self.t,
            h,
            y: &self.y,
        };
        let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
        let events = &mut self.events;
        Ok(self
            .method
            .interpolate(&mut problem, step, &events.y_end, 0.5, &mut events.y)?)
    }

    /// Values and slopes at the end of an attempt.
    fn measure_end(&mut self, h: f64, t_new: f64) -> Result<(), Refusal> {
        let events = &mut self.events;
        let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
        measure_values(&mut problem, (t_new, &self.y_new), &mut events.trial.values)?;
        let end = (t_new, &self.y_new[..], self.method.derivative());
        measure_slopes(&mut problem, end, -probe(t_new, h), &mut events.y, &mut events.trial)
    }

    /// Values at the state reached, and slopes there ahead; no slope where a function cannot be evaluated ahead.
    fn measure_ahead(&mut self) -> Result<(), IntegrationError> {
        let (time, events) = (self.t, &mut self.events);
        let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
        let values = &mut events.trial.values;
        problem
            .root(time, &self.y, values)
            .map_err(|error| fatal(time, error))?;
        if let Some(function) = first_non_finite(values) {
            return Err(IntegrationError::NonFiniteRoot { time, function });
        }
        let here = (time, &self.y[..], self.method.derivative());
        match measure_slopes(&mut problem, here, events.probe, &mut events.y, &mut events.trial) {
            Err(Refusal::Evaluation(EvalError::Abort(source))) => Err(IntegrationError::Problem { time, source }),
            Err(Refusal::Evaluation(EvalError::Retry(_))) => {
                events.trial.slopes.fill(0.0);
                Ok(())
            }
            _ => {
                let slopes = events.trial.slopes.iter_mut();
                slopes.filter(|slope| !slope.is_finite()).for_each(|slope| *slope = 0.0);
                Ok(())
            }
        }
    }

    /// Values and slopes within the attempt just made.
    fn measure_within(&mut self, h: f64, theta: f64) -> Result<(), Refusal> {
        let before = theta * (1.0 - PROBE);
        for (theta, first) in [(before, true), (theta, false)] {
            self.interpolate_trial(h, theta)?;
            let events = &mut self.events;
            let Functions { values, slopes } = &mut events.trial;
            let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
            problem.root(self.t + theta * h, &events.y, if first { slopes } else { values })?;
        }
        let Functions { values, slopes } = &mut self.events.trial;
        for (slope, value) in slopes.iter_mut().zip(&*values) {
            *slope = (value - *slope) / (PROBE * theta * h);
        }
        check_finite(values)?;
        check_finite(slopes)
    }

    /// One root function within the attempt just made.
    fn root_within(&mut self, h: f64, theta: f64, function: usize) -> Result<f64, Refusal> {
        self.interpolate_trial(h, theta)?;
        let events = &mut self.events;
        let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
        problem.root(self.t + theta * h, &events.y, &mut events.values)?;
        let value = events.values[function];
        if value.is_finite() {
            Ok(value)
        } else {
            Err(Refusal::NonFiniteRoot { function })
        }
    }

    /// The state within the attempt just made.
    fn interpolate_trial(&mut self, h: f64, theta: f64) -> Result<(), Refusal> {
        let step = Step {
            t: self.t,
            h,
            y: &self.y,
        };
        let mut problem = Counted::new(&mut self.problem, &mut self.statistics);
        Ok(self
            .method
            .interpolate(&mut problem, step, &self.y_new, theta, &mut self.events.y)?)
    }

    /// After a start, a stop or an event: arms the root functions; whether some of them fire before any further step.
    pub(super) fn fires_at_once(&mut self, goal: f64) -> Result<bool, IntegrationError> {
        if self.events.none() {
            return Ok(false);
        }
        let mut fires = false;
        if self.events.since != Since::Step {
            if self.events.since != Since::Event {
                let h = self.h.unwrap_or(f64::INFINITY).min((goal - self.t).abs());
                self.events.probe = probe(self.t, self.direction * h);
            }
            self.measure_ahead()?;
            let h = self.events.probe / PROBE;
            fires = self.events.compare(self.direction, resolution(self.t, self.t + h));
        } else {
            self.events.fired.fill(false);
        }
        self.events.at_event = false;
        Ok(fires)
    }

    /// Makes the event the state reached and lets the problem change it.
    pub(super) fn meet(&mut self, found: Found, goal: f64, until: f64) -> Result<Progress, IntegrationError> {
        if let Found::Nothing(t) = found {
            self.statistics.accepted += 1;
            return Ok(self.arrive(t, goal, until));
        }
        self.t_old = self.t;
        match found {
            Found::At(t) => {
                self.statistics.accepted += 1;
                self.t = t;
                std::mem::swap(&mut self.y_old, &mut self.y);
                std::mem::swap(&mut self.y, &mut self.y_new);
            }
            Found::Here | Found::Nothing(_) => {
                self.y_old.copy_from_slice(&self.y);
                self.events.y_end.copy_from_slice(&self.y);
                self.events.t_end = self.t;
            }
        }
        let t = self.t;
        self.restart_due = true;
        self.events.y_before.copy_from_slice(&self.y);
        self.events.at_event = true;
        self.limit_events()?;
        // What `compare` will see as the functions before the event.
        self.events.probe = probe(t, self.direction * self.h.unwrap_or(0.0).max((t - self.t_old).abs()));
        self.measure_ahead()?;
        std::mem::swap(&mut self.events.reached, &mut self.events.trial);
        let changed = self.problem.at_event(t, &mut self.y, &self.events.fired);
        let failure = match (changed, first_non_finite(&self.y)) {
            (Err(error), _) => Some(fatal(t, error)),
            (Ok(()), Some(component)) => Some(IntegrationError::NonFinite {
                time: t,
                step: 0.0,
                component,
            }),
            (Ok(()), None) => None,
        };
        if let Some(failure) = failure {
            self.y.copy_from_slice(&self.events.y_before);
            return Err(failure);
        }
        self.statistics.events += 1;
        self.events.since = Since::Event;
        self.events.stop_pending = t == goal && t != until && self.is_stop(goal);
        Ok(Progress::Event { t })
    }

    /// Refuses one event more than `max_events`, and events that accumulate.
    fn limit_events(&mut self) -> Result<(), IntegrationError> {
        let (time, events) = (self.t, self.statistics.events);
        if events >= self.max_events {
            return Err(IntegrationError::TooManyEvents { time, events });
        }
        let memory = &mut self.events;
        if events > 0 && (time - memory.last).abs() <= resolution(time, memory.last) {
            memory.repeats += 1;
        } else {
            memory.repeats = 0;
        }
        memory.last = time;
        if memory.repeats >= MOST_AT_ONCE {
            return Err(IntegrationError::EventsAccumulate {
                time,
                events: memory.repeats,
                function: memory.fired.iter().position(|&fired| fired).unwrap_or(0),
            });
        }
        Ok(())
    }
}

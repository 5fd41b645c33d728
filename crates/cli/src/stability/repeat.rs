//! Whether runs repeat each other to the last bit: once more, on several threads, and taken up from what was saved.
//!
//! Saved are time, state vector and the memory of loads, as text. Three questions are asked of it:
//! * two legs: does a run of two legs, a new integration for each, depend on whether the second leg has the same simulation or one
//!   made from the text? If not, nothing but state and memory carries over.
//! * taken up: does a run taken up at the end of one of its steps, with the length of the next, go on as the run did? It does where
//!   a method keeps nothing else from step to step.
//! * both are told with the largest difference of a coordinate or speed at the end where the answer is no.

use std::ops::ControlFlow;
use std::thread;

use linkdyn_mechanisms::integrators::Integration;
use linkdyn_mechanisms::{RunError, Seen, Simulation, run_watched};

use crate::report::measure::{Halt, Limit};
use crate::run::Prepared;
use crate::run::methods::{PUBLISHED_STEP, Plan, STEP};
use crate::scenes::Variant;

use super::plans::{is_fixed, methods, plan, tolerance};
use super::stiffening::Quantity;

/// Fixed step \[s\], and with clearance or springs: the program's own.
const STEPS: [f64; 2] = [STEP, PUBLISHED_STEP];
/// Fewest threads, however few the machine has.
const FEWEST: usize = 2;
/// Most threads: more tell nothing new.
const MOST: usize = 8;

/// One question put to one method.
pub struct Row {
    /// The method.
    pub method: &'static str,
    /// What was repeated.
    pub what: String,
    /// What came of it.
    pub outcome: Outcome,
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Every bit of every step is the same.
    Same,
    /// It is not; largest difference at the end \[rad, m, rad/s, m/s\].
    Differs(f64),
    /// There was no run to compare; why.
    Failed(String),
    /// The budget did not allow it.
    NotRun,
}

impl Outcome {
    /// In words.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Same => "same bits",
            Self::Differs(_) => "differs",
            Self::Failed(_) => "failed",
            Self::NotRun => "not run",
        }
    }
}

/// All that is kept of a run.
#[derive(Clone, Debug, PartialEq)]
struct Saved {
    t: f64,
    y: Vec<f64>,
    memory: Vec<f64>,
    /// Length of the next step, where it is known \[s\].
    next: Option<f64>,
}

impl Saved {
    /// The state written down and read again, as a file would have it; `None` if a number does not come back.
    fn through_text(&self) -> Option<Self> {
        let written = |x: &f64| format!("{x:e}").parse::<f64>().ok();
        let all = |list: &[f64]| list.iter().map(written).collect::<Option<Vec<f64>>>();
        Some(Self {
            t: written(&self.t)?,
            y: all(&self.y)?,
            memory: all(&self.memory)?,
            next: self.next,
        })
    }
}

/// Times and states at the ends of all steps, as bits, and the end.
#[derive(Clone, Debug, PartialEq)]
struct Path {
    steps: Vec<(f64, u64)>,
    end: Vec<f64>,
}

impl Path {
    /// Compares what comes after a time.
    fn compare(&self, other: &Self, after: f64) -> Outcome {
        let tail = |path: &Self| -> Vec<(u64, u64)> {
            let late = path.steps.iter().filter(|(t, _)| *t > after);
            late.map(|(t, digest)| (t.to_bits(), *digest)).collect()
        };
        match tail(self) == tail(other) {
            true => Outcome::Same,
            false => {
                let pairs = self.end.iter().zip(&other.end);
                Outcome::Differs(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
            }
        }
    }
}

/// All bits of a state in one number (FNV-1a, public domain).
fn digest(y: &[f64]) -> u64 {
    y.iter().fold(0xcbf2_9ce4_8422_2325, |hash, x| {
        (hash ^ x.to_bits()).wrapping_mul(0x0100_0000_01b3)
    })
}

/// A simulation at the start, or at what was saved.
fn simulation(prepared: &Prepared, plan: &Plan, saved: Option<&Saved>) -> Simulation {
    let mut simulation = Simulation::new(&prepared.mechanism);
    plan.set_up(&mut simulation);
    if let Some(saved) = saved {
        simulation.set_memory(&saved.memory);
    }
    simulation
}

/// A run with the states at the ends of all its steps, and the simulation as it was left.
struct Leg {
    path: Path,
    states: Vec<Saved>,
    simulation: Simulation,
}

/// Runs from a state.
fn leg(
    prepared: &Prepared,
    plan: &Plan,
    simulation: Simulation,
    (from, until): (&Saved, f64),
    limit: &Limit,
) -> Result<Leg, Halt> {
    let failed = |error: &dyn std::error::Error| Halt::Failed(error.to_string());
    let mut settings = plan.settings(&simulation);
    if plan.step.is_none() {
        settings.first_step = from.next;
    }
    let coordinates = simulation.layout().speeds.end;
    let stops = prepared.mechanism.system().stop_times();
    let integration = Integration::new(simulation, plan.method(), from.t, &from.y, settings).map_err(|e| failed(&e))?;
    let mut integration = integration.with_stops(&stops).map_err(|e| failed(&e))?;
    let (mut steps, mut states) = (Vec::new(), Vec::<Saved>::new());
    let mut path_end = Vec::new();
    let ended = run_watched(&mut integration, until, until, |what| {
        if let Seen::Step { t, y, simulation, .. } = what {
            steps.push((t, digest(y)));
            if let Some(last) = states.last_mut() {
                last.next = Some(t - last.t);
            }
            let memory = simulation.memory().to_vec();
            states.push(Saved {
                t,
                y: y.to_vec(),
                memory,
                next: None,
            });
            path_end.clear();
            path_end.extend_from_slice(&y[..coordinates]);
        }
        match limit.left() > 0.0 {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    });
    match ended {
        Ok(()) => Ok(Leg {
            path: Path { steps, end: path_end },
            states,
            simulation: integration.problem().clone(),
        }),
        Err(RunError::Stopped { .. }) => Err(Halt::OutOfTime),
        Err(error) => Err(failed(&error)),
    }
}

/// All questions to all methods; `heard` hears that one is answered.
pub fn rows(prepared: &Prepared, until: f64, limit: &Limit, heard: &mut dyn FnMut()) -> Vec<Row> {
    let threads = thread::available_parallelism()
        .map_or(FEWEST, usize::from)
        .clamp(FEWEST, MOST);
    let stiff = Quantity::STIFF
        .iter()
        .any(|q| q.is_in(&Variant::default(), &prepared.scene.linkage));
    let step = STEPS[usize::from(stiff)];
    let count = methods().count();
    let mut rows = Vec::new();
    for (i, method) in methods().enumerate() {
        let limit = limit.part(1.0 / (count - i) as f64);
        let setting = if is_fixed(method) {
            step.min(0.1 * until)
        } else {
            tolerance(prepared)
        };
        let plan = plan(method, setting);
        let questions = [
            ("once more".to_owned(), Question::Threads(1)),
            (format!("on {threads} threads at once"), Question::Threads(threads)),
            ("two legs, the second from saved text".to_owned(), Question::Legs),
            ("taken up from saved text after a step".to_owned(), Question::TakenUp),
        ];
        let first = Question::run(prepared, &plan, until, &limit);
        for (what, question) in questions {
            let outcome = match &first {
                Ok(leg) => question.ask(prepared, &plan, (leg, until), &limit),
                Err(Halt::OutOfTime) => Err(Halt::OutOfTime),
                Err(Halt::Failed(why)) => Err(Halt::Failed(why.clone())),
            };
            let outcome = outcome.unwrap_or_else(|halt| match halt {
                Halt::OutOfTime => Outcome::NotRun,
                Halt::Failed(why) => Outcome::Failed(why),
            });
            rows.push(Row { method, what, outcome });
            heard();
        }
    }
    rows
}

/// What is repeated.
#[derive(Clone, Copy, Debug)]
enum Question {
    /// The run, on this many threads at once.
    Threads(usize),
    /// The second of two legs.
    Legs,
    /// What comes after the middle step.
    TakenUp,
}

impl Question {
    /// The run from the start.
    fn run(prepared: &Prepared, plan: &Plan, until: f64, limit: &Limit) -> Result<Leg, Halt> {
        let simulation = simulation(prepared, plan, None);
        let start = Saved {
            t: 0.0,
            y: simulation.state_vector(&prepared.start),
            memory: simulation.memory().to_vec(),
            next: None,
        };
        leg(prepared, plan, simulation, (&start, until), limit)
    }

    fn ask(
        self,
        prepared: &Prepared,
        plan: &Plan,
        (first, until): (&Leg, f64),
        limit: &Limit,
    ) -> Result<Outcome, Halt> {
        let nothing = || Halt::Failed("the run has too few steps".to_owned());
        match self {
            Self::Threads(threads) => {
                let paths = thread::scope(|scope| {
                    let run = || Self::run(prepared, plan, until, limit).map(|leg| leg.path);
                    let running: Vec<_> = (0..threads).map(|_| scope.spawn(run)).collect();
                    let ended = running.into_iter().map(|thread| thread.join());
                    ended.collect::<Vec<_>>()
                });
                for path in paths {
                    let path = path.map_err(|_| Halt::Failed("a thread panicked".to_owned()))??;
                    let outcome = first.path.compare(&path, f64::NEG_INFINITY);
                    if outcome != Outcome::Same {
                        return Ok(outcome);
                    }
                }
                Ok(Outcome::Same)
            }
            Self::Legs => {
                let half = Self::run(prepared, plan, 0.5 * until, limit)?;
                let mut end = half.states.last().cloned().ok_or_else(nothing)?;
                end.next = None;
                let kept = leg(prepared, plan, half.simulation, (&end, until), limit)?;
                let end = end.through_text().ok_or_else(nothing)?;
                let read = leg(
                    prepared,
                    plan,
                    simulation(prepared, plan, Some(&end)),
                    (&end, until),
                    limit,
                )?;
                Ok(kept.path.compare(&read.path, end.t))
            }
            Self::TakenUp => {
                let middle = first
                    .states
                    .get(first.states.len() / 2)
                    .filter(|state| state.next.is_some());
                let saved = middle.and_then(Saved::through_text).ok_or_else(nothing)?;
                let taken_up = leg(
                    prepared,
                    plan,
                    simulation(prepared, plan, Some(&saved)),
                    (&saved, until),
                    limit,
                )?;
                Ok(first.path.compare(&taken_up.path, saved.t))
            }
        }
    }
}

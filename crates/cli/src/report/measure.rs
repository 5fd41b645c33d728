//! One run, measured: its path on a grid of times, and what it cost.

use std::ops::ControlFlow;
use std::time::Instant;

use linkdyn_mechanisms::integrators::{Integration, Method, Statistics};
use linkdyn_mechanisms::{Observation, RunError, Seen, Simulation, Worst, run_watched};

use crate::interrupt::Interrupt;
use crate::run::Prepared;
use crate::run::methods::Plan;

/// Coordinates, speeds and forces at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// Time \[s\].
    pub t: f64,
    /// Coordinates \[rad, m\].
    pub q: Vec<f64>,
    /// Their speeds \[rad/s, m/s\].
    pub v: Vec<f64>,
    /// Multipliers, reactions of all joints, and forces of contacts \[N, N m\].
    pub forces: Vec<f64>,
}

impl Point {
    fn new(o: &Observation) -> Self {
        let mut forces = o.multipliers.clone();
        for reaction in &o.reactions {
            forces.extend(reaction.force.iter().chain(reaction.torque.iter()));
        }
        for contact in &o.contacts {
            forces.push(contact.normal);
            forces.extend(contact.tangent);
        }
        Self {
            t: o.t,
            q: o.q.clone(),
            v: o.v.clone(),
            forces,
        }
    }
}

/// A run, as far as it came.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// The path at the output times.
    pub path: Vec<Point>,
    /// Costs of the integration.
    pub statistics: Statistics,
    /// Worst drift of the closures.
    pub worst: Worst,
    /// Largest change of the energy balance \[J\].
    pub energy: f64,
    /// Time on the clock \[s\].
    pub wall: f64,
    /// Why it did not come to its end, if it did not.
    pub halt: Option<Halt>,
}

impl Measured {
    /// The run, if it came to its end.
    ///
    /// # Errors
    /// Why it did not.
    pub fn whole(self) -> Result<Self, Halt> {
        match self.halt {
            None => Ok(self),
            Some(halt) => Err(halt),
        }
    }
}

/// Why a run did not come to its end.
#[derive(Clone, Debug, PartialEq)]
pub enum Halt {
    /// Time is over, or the user asked to stop.
    OutOfTime,
    /// The method or the mechanism cannot go on; what and when.
    Failed(String),
}

/// Until when runs may go on.
pub struct Limit {
    end: Option<Instant>,
    interrupt: Interrupt,
}

impl Limit {
    /// A limit `seconds` from now; a budget too long for the clock is none.
    pub fn new(seconds: f64, interrupt: Interrupt) -> Self {
        let end = std::time::Duration::try_from_secs_f64(seconds)
            .ok()
            .and_then(|budget| Instant::now().checked_add(budget));
        Self { end, interrupt }
    }

    /// A limit that comes after this share of the time that is left.
    pub fn part(&self, share: f64) -> Self {
        Self::new(share * self.left(), self.interrupt.clone())
    }

    /// Time that is left \[s\], zero if none is.
    pub fn left(&self) -> f64 {
        if self.interrupt.requested() {
            return 0.0;
        }
        match self.end {
            Some(end) => end.saturating_duration_since(Instant::now()).as_secs_f64(),
            None => f64::INFINITY,
        }
    }

    /// Whether the user asked to stop.
    pub fn interrupted(&self) -> bool {
        self.interrupt.requested()
    }
}

/// Runs a scene up to `until` with output every `every` \[s\]; `seen` hears of every step.
pub fn measure(
    prepared: &Prepared,
    plan: &Plan,
    (until, every): (f64, f64),
    limit: &Limit,
    mut seen: impl FnMut(),
) -> Measured {
    let mut run = Measured::default();
    let begun = begin(prepared, plan);
    let mut integration = match begun {
        Ok(integration) => integration,
        Err(why) => {
            run.halt = Some(Halt::Failed(why));
            return run;
        }
    };
    let mut balance = None;
    let begun = Instant::now();
    let ended = run_watched(&mut integration, until, every, |what| {
        match what {
            Seen::Row(o) => {
                run.path.push(Point::new(o));
                let now = o.energy_balance();
                run.energy = run.energy.max((now - *balance.get_or_insert(now)).abs());
            }
            Seen::Step { .. } => seen(),
            Seen::Contact { .. } => {}
        }
        if limit.left() > 0.0 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    run.wall = begun.elapsed().as_secs_f64();
    run.statistics = integration.statistics();
    run.worst = integration.problem().worst();
    run.halt = match ended {
        Ok(()) => None,
        Err(RunError::Stopped { .. }) => Some(Halt::OutOfTime),
        Err(error) => Some(Halt::Failed(error.to_string())),
    };
    run
}

type Running = Integration<Simulation, Box<dyn Method<Simulation>>>;

fn begin(prepared: &Prepared, plan: &Plan) -> Result<Running, String> {
    let mut simulation = Simulation::new(&prepared.mechanism);
    plan.set_up(&mut simulation);
    let y = simulation.state_vector(&prepared.start);
    let settings = plan.settings(&simulation);
    let integration = Integration::new(simulation, plan.method(), 0.0, &y, settings).map_err(|e| e.to_string())?;
    let stops = prepared.mechanism.system().stop_times();
    integration.with_stops(&stops).map_err(|e| e.to_string())
}

//! One run, measured: its path on a grid of times, and what it cost.

use std::ops::ControlFlow;
use std::time::Instant;

use linkdyn_mechanisms::integrators::{Integration, Statistics};
use linkdyn_mechanisms::{RunError, Seen, Simulation, Worst, run_watched};

use crate::interrupt::Interrupt;
use crate::run::Prepared;
use crate::run::methods::Plan;

/// Coordinates and speeds at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// Time \[s\].
    pub t: f64,
    /// Coordinates \[rad, m\].
    pub q: Vec<f64>,
    /// Their speeds \[rad/s, m/s\].
    pub v: Vec<f64>,
}

/// A run that came to its end.
#[derive(Clone, Debug)]
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
}

/// Why there is no measured run.
#[derive(Debug)]
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
///
/// # Errors
/// [`Halt`].
pub fn measure(
    prepared: &Prepared,
    plan: &Plan,
    (until, every): (f64, f64),
    limit: &Limit,
    mut seen: impl FnMut(),
) -> Result<Measured, Halt> {
    let failed = |error: &dyn std::error::Error| Halt::Failed(error.to_string());
    let mut simulation = Simulation::new(&prepared.mechanism);
    plan.set_up(&mut simulation);
    let y = simulation.state_vector(&prepared.start);
    let settings = plan.settings(&simulation);
    let integration = Integration::new(simulation, plan.method(), 0.0, &y, settings).map_err(|e| failed(&e))?;
    let stops = prepared.mechanism.system().stop_times();
    let mut integration = integration.with_stops(&stops).map_err(|e| failed(&e))?;
    let (mut path, mut balance, mut energy) = (Vec::new(), None, 0.0_f64);
    let begun = Instant::now();
    let ended = run_watched(&mut integration, until, every, |what| {
        match what {
            Seen::Row(o) => {
                let (q, v) = (o.q.clone(), o.v.clone());
                path.push(Point { t: o.t, q, v });
                let now = o.energy_balance();
                energy = energy.max((now - *balance.get_or_insert(now)).abs());
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
    let wall = begun.elapsed().as_secs_f64();
    match ended {
        Ok(()) => Ok(Measured {
            path,
            statistics: integration.statistics(),
            worst: integration.problem().worst(),
            energy,
            wall,
        }),
        Err(RunError::Stopped { .. }) => Err(Halt::OutOfTime),
        Err(error) => Err(failed(&error)),
    }
}

//! Long runs of the scene as a conservative machine: how far energy and loops drift.

use std::ops::ControlFlow;

use linkdyn_mechanisms::integrators::Integration;
use linkdyn_mechanisms::{RunError, Seen, Simulation, run_watched};

use crate::errors::CliError;
use crate::report::measure::Limit;
use crate::run::{Prepared, ready};
use crate::scenes::{self, Variant};

use super::plans::{is_fixed, methods, plan, tolerance};

/// Times at which the drift is told \[s\].
pub const TIMES: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];
/// Speed at which the crank starts \[rad/s\]: that at which both papers run it.
const SPEED: f64 = 9.0;
/// Step of methods of fixed step \[s\]: a million of them in the longest run.
const STEP: f64 = 1e-3;
/// Time between looks at the energy \[s\]: a fraction of a turn.
const EVERY: f64 = 0.05;

/// Drift of one method.
pub struct Row {
    /// The method.
    pub method: &'static str,
    /// Tolerance or step.
    pub setting: f64,
    /// Largest change of energy \[J\] and largest residual of the loops before a projection \[m, -\] up to each of [`TIMES`] reached.
    pub drift: Vec<(f64, f64, f64)>,
    /// Energy of motion at the start \[J\], to compare with.
    pub energy: f64,
    /// Steps taken.
    pub steps: u64,
    /// Time reached \[s\].
    pub reached: f64,
    /// `done`, `out of time`, or `failed` with the reason.
    pub outcome: String,
}

impl Row {
    /// Growth of the energy's drift over the last ten times longer run: its logarithm, 1 for growth in proportion to time, 0 for none.
    pub fn growth(&self) -> Option<f64> {
        match self.drift.as_slice() {
            [.., (_, before, _), (_, after, _)] if *before > 0.0 => Some((after / before).log10()),
            _ => None,
        }
    }
}

/// The scene without drives, resistances, friction, clearance and flexible links, its crank turning.
///
/// # Errors
/// Those of a scene that cannot be built or cannot start.
pub fn conservative(scene: &str) -> Result<Prepared, CliError> {
    let variant = Variant {
        friction: Some(false),
        ..Variant::default()
    };
    let mut scene = scenes::find(scene)?.scene(&variant)?;
    scene.linkage.clear_drives();
    scene.start.speeds = vec![(scene.crank.clone(), SPEED)];
    ready(scene)
}

/// All methods up to `until` at most, each with an even share of the time.
pub fn rows(prepared: &Prepared, until: f64, limit: &Limit, heard: &mut dyn FnMut()) -> Vec<Row> {
    let count = methods().count();
    let rows = methods().enumerate().map(|(i, method)| {
        let setting = if is_fixed(method) { STEP } else { tolerance(prepared) };
        row(
            prepared,
            (method, setting),
            until,
            &limit.part(1.0 / (count - i) as f64),
            heard,
        )
    });
    rows.collect()
}

fn row(
    prepared: &Prepared,
    (method, setting): (&'static str, f64),
    until: f64,
    limit: &Limit,
    heard: &mut dyn FnMut(),
) -> Row {
    let mut row = Row {
        method,
        setting,
        drift: Vec::new(),
        energy: 0.0,
        steps: 0,
        reached: 0.0,
        outcome: "not run".to_owned(),
    };
    if limit.left() <= 0.0 {
        return row;
    }
    let plan = plan(method, setting);
    let mut simulation = Simulation::new(&prepared.mechanism);
    plan.set_up(&mut simulation);
    let y = simulation.state_vector(&prepared.start);
    let settings = plan.settings(&simulation);
    let mut integration = match Integration::new(simulation, plan.method(), 0.0, &y, settings) {
        Ok(integration) => integration,
        Err(error) => {
            row.outcome = format!("failed: {error}");
            return row;
        }
    };
    let (mut first, mut largest, mut worst) = (None, 0.0_f64, 0.0_f64);
    let mut times = TIMES.into_iter().filter(|&time| time <= until).peekable();
    let ended = run_watched(&mut integration, until, EVERY, |what| {
        match what {
            Seen::Row(o) => {
                let balance = o.energy_balance();
                if first.is_none() {
                    row.energy = o.energy.kinetic;
                }
                largest = largest.max((balance - *first.get_or_insert(balance)).abs());
                // Rows lie on a grid of products, which rounding may put beside a decade.
                if let Some(time) = times.next_if(|&time| o.t >= time - 0.5 * EVERY) {
                    row.drift.push((time, largest, worst));
                }
                row.reached = o.t;
            }
            Seen::Step { simulation, .. } => {
                heard();
                worst = simulation.worst().position_drift;
            }
            Seen::Contact { .. } => {}
        }
        match limit.left() > 0.0 {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    });
    row.steps = integration.statistics().accepted;
    row.outcome = match ended {
        Ok(()) => "done".to_owned(),
        Err(RunError::Stopped { .. }) => "out of time".to_owned(),
        Err(error) => format!("failed: {error}"),
    };
    row
}

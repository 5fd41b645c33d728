//! One run of a simulation with output on a grid of times.

use crate::error::MotionError;
use crate::events::ContactEvent;
use crate::observation::Observation;
use crate::simulation::{OFF_THE_LOOP, Simulation};
use linkdyn_friction::BristleModel;
use linkdyn_integrators::{Integration, IntegrationError, Method, Progress};
use std::ops::ControlFlow;
use thiserror::Error;

/// Why a run ended early. What was observed before remains valid.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// The integration stopped.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
    /// The bristle of a clearance joint has run away: friction drives the sliding that it should resist.
    #[error(
        "at t = {time} s the bristle of contact `{contact}` has run away: sliding at {slip:e} m/s has a coefficient of friction of \
         {coefficient:e}, lasting sliding one of {steady:e}. The bristle model is passive up to {passive:e} m/s only; give it \
         a guard or less damping ({cause})"
    )]
    Bristle {
        /// Time \[s\].
        time: f64,
        /// Contact point.
        contact: String,
        /// Sliding speed \[m/s\].
        slip: f64,
        /// Coefficient of friction \[-\].
        coefficient: f64,
        /// Coefficient in lasting sliding \[-\].
        steady: f64,
        /// Largest sliding speed at which the model is passive \[m/s\].
        passive: f64,
        /// How the integration ended.
        cause: IntegrationError,
    },
    /// A state could not be observed.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// The grid of output times makes no sense.
    #[error(
        "output every {every} s until {until} s: both must be finite, the first positive, the second after the start, and \
         there may be at most {MOST_ROWS} rows"
    )]
    Grid {
        /// Spacing \[s\].
        every: f64,
        /// End \[s\].
        until: f64,
    },
    /// The start does not lie on the loops.
    #[error("the start leaves the loops open by {residual:e} (largest allowed: 1e-6); assemble it first")]
    OpenStart {
        /// Largest closure residual \[m, -\].
        residual: f64,
    },
    /// The observer asked for the end.
    #[error("stopped by request at t = {time} s")]
    Stopped {
        /// Time \[s\].
        time: f64,
    },
}

/// Most rows that a run may ask for.
pub const MOST_ROWS: u64 = 10_000_000;

/// What there is to see in a run.
#[derive(Debug)]
pub enum Seen<'a> {
    /// The state at an output time.
    Row(&'a Observation),
    /// A contact is made or lost.
    Contact {
        /// Time \[s\].
        t: f64,
        /// What happened.
        event: ContactEvent,
    },
    /// The end of a step.
    Step {
        /// Time \[s\].
        t: f64,
        /// State vector.
        y: &'a [f64],
        /// Its rates, before the contacts of this time were made or lost.
        rates: &'a [f64],
        /// For whatever one wants to know about it.
        simulation: &'a mut Simulation,
    },
}

/// Runs until `until`, observing at `t0`, `t0 + every`, ... and at the end. Observed states lie on the closures; observing does
/// not change the steps. `observer` gets each observation, and may break the run off.
///
/// # Errors
/// [`RunError`]; the state of `integration` is then that of the last accepted step.
pub fn run<M: Method<Simulation>>(
    integration: &mut Integration<Simulation, M>,
    until: f64,
    every: f64,
    mut observer: impl FnMut(&Observation) -> ControlFlow<()>,
) -> Result<(), RunError> {
    run_watched(integration, until, every, |seen| match seen {
        Seen::Row(observation) => observer(observation),
        _ => ControlFlow::Continue(()),
    })
}

/// As [`run`], for observers that want to see contacts and steps as well.
///
/// # Errors
/// [`RunError`]; the state of `integration` is then that of the last accepted step.
pub fn run_watched<M: Method<Simulation>>(
    integration: &mut Integration<Simulation, M>,
    until: f64,
    every: f64,
    mut observer: impl FnMut(Seen<'_>) -> ControlFlow<()>,
) -> Result<(), RunError> {
    let start = integration.state().0;
    let sound = every.is_finite() && every > 0.0 && until.is_finite() && until >= start;
    if !sound || (until - start) / every > MOST_ROWS as f64 {
        return Err(RunError::Grid { every, until });
    }
    let mut rows = Rows {
        observation: Observation::default(),
        y: integration.state().1.to_vec(),
        rates: vec![0.0; integration.state().1.len()],
        start,
        every,
        count: 1,
    };
    if integration.problem_mut().begin(start, &mut rows.y) {
        integration.restart(start, &rows.y)?;
    }
    rows.observe(integration.problem_mut(), start, &mut observer)?;
    let residual = rows.observation.violation.0;
    if residual.is_nan() || residual > OFF_THE_LOOP {
        return Err(RunError::OpenStart { residual });
    }
    for &event in integration.problem().happened() {
        stop_if(observer(Seen::Contact { t: start, event }), start)?;
    }
    let mut t = start;
    while t < until {
        let progress = match integration.advance(until) {
            Ok(progress) => progress,
            Err(cause) => {
                let (t, y) = integration.state();
                rows.y.copy_from_slice(y);
                return Err(explain(integration.problem_mut(), t, &rows.y, cause));
            }
        };
        t = integration.state().0;
        while rows.next() <= t && rows.next() < until - 1e-9 * every {
            if rows.next() == t {
                // Of two states at an event the later one, as at the end of a run.
                rows.y.copy_from_slice(integration.state().1);
            } else {
                integration.interpolate(rows.next(), &mut rows.y)?;
            }
            rows.observe(integration.problem_mut(), rows.next(), &mut observer)?;
            rows.count += 1;
        }
        rows.y.copy_from_slice(integration.state().1);
        rows.rates.copy_from_slice(integration.method().derivative());
        let switched = integration.problem_mut().switch_at_step(t, &mut rows.y);
        if switched {
            integration.restart(t, &rows.y)?;
        }
        if switched || matches!(progress, Progress::Event { .. }) {
            for &event in integration.problem().happened() {
                stop_if(observer(Seen::Contact { t, event }), t)?;
            }
        }
        let (y, rates) = (&rows.y[..], &rows.rates[..]);
        let simulation = integration.problem_mut();
        let step = Seen::Step {
            t,
            y,
            rates,
            simulation,
        };
        stop_if(observer(step), t)?;
    }
    if t > start {
        rows.observe(integration.problem_mut(), t, &mut observer)?;
    }
    Ok(())
}

/// Looks for a bristle behind the end of an integration.
fn explain(simulation: &mut Simulation, time: f64, y: &[f64], cause: IntegrationError) -> RunError {
    let mut points = Vec::new();
    simulation.contact_points(time, y, &mut points);
    let mechanism = simulation.mechanism();
    let models = mechanism.bristles();
    for ((point, model), contact) in points.iter().zip(models).zip(mechanism.contact_names()) {
        let Some(model) = model.filter(|_| point.normal > 0.0) else {
            continue;
        };
        let length = |[x, y, z]: [f64; 3]| f64::hypot(x, y).hypot(z);
        let slip = length(point.slip);
        let coefficient = length(point.tangent) / point.normal;
        let (steady, passive) = (model.steady_coefficient(slip), model.largest_passive_slip());
        if slip > passive && coefficient > RUNAWAY * steady {
            return RunError::Bristle {
                time,
                contact,
                slip,
                coefficient,
                steady,
                passive,
                cause,
            };
        }
    }
    cause.into()
}

/// A bristle is taken for the cause of an early end if its coefficient is that many times the one of lasting sliding.
const RUNAWAY: f64 = 10.0;

fn stop_if(flow: ControlFlow<()>, time: f64) -> Result<(), RunError> {
    match flow {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(RunError::Stopped { time }),
    }
}

/// Output on a grid.
struct Rows {
    observation: Observation,
    /// State at the next row or at the end of the step.
    y: Vec<f64>,
    rates: Vec<f64>,
    start: f64,
    every: f64,
    count: u64,
}

impl Rows {
    /// Time of the next row: a product, not a sum, so that it does not drift.
    fn next(&self) -> f64 {
        self.start + self.count as f64 * self.every
    }

    fn observe(
        &mut self,
        simulation: &mut Simulation,
        t: f64,
        observer: &mut impl FnMut(Seen<'_>) -> ControlFlow<()>,
    ) -> Result<(), RunError> {
        if t > self.start {
            simulation.put_on_closures(t, &mut self.y);
        }
        simulation.observe(t, &self.y, &mut self.observation)?;
        stop_if(observer(Seen::Row(&self.observation)), t)
    }
}

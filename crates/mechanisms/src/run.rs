//! One run of a simulation with output on a grid of times.

use crate::error::MotionError;
use crate::observation::Observation;
use crate::simulation::{OFF_THE_LOOP, Simulation};
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

/// Runs until `until`, observing at `t0`, `t0 + every`, ... and at the end. Observed states lie on the closures; observing does
/// not change the steps. `observer` gets each observation, and may break the run off.
///
/// # Errors
/// [`RunError`]; the state of `integration` is then that of the last accepted step.
pub fn run<M: Method<Simulation>>(
    integration: &mut Integration<Simulation, M>,
    until: f64,
    every: f64,
    observer: impl FnMut(&Observation) -> ControlFlow<()>,
) -> Result<(), RunError> {
    run_watched(integration, until, every, observer, |_| ControlFlow::Continue(()))
}

/// As [`run`]; after each step `watcher` gets the time reached, and may break the run off as well.
///
/// # Errors
/// [`RunError`]; the state of `integration` is then that of the last accepted step.
pub fn run_watched<M: Method<Simulation>>(
    integration: &mut Integration<Simulation, M>,
    until: f64,
    every: f64,
    mut observer: impl FnMut(&Observation) -> ControlFlow<()>,
    mut watcher: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<(), RunError> {
    let start = integration.state().0;
    let sound = every.is_finite() && every > 0.0 && until.is_finite() && until >= start;
    if !sound || (until - start) / every > MOST_ROWS as f64 {
        return Err(RunError::Grid { every, until });
    }
    let mut observation = Observation::default();
    let mut y = integration.state().1.to_vec();
    let mut observe = |simulation: &mut Simulation, t: f64, y: &[f64]| -> Result<f64, RunError> {
        simulation.observe(t, y, &mut observation)?;
        match observer(&observation) {
            ControlFlow::Continue(()) => Ok(observation.violation.0),
            ControlFlow::Break(()) => Err(RunError::Stopped { time: t }),
        }
    };
    let residual = observe(integration.problem_mut(), start, &y)?;
    if residual.is_nan() || residual > OFF_THE_LOOP {
        return Err(RunError::OpenStart { residual });
    }
    let mut count = 1_u64;
    // Grid times are products, not sums, so that they do not drift.
    let grid = |count: u64| start + count as f64 * every;
    while integration.state().0 < until {
        let progress = integration.advance(until)?;
        let (t, _) = integration.state();
        while grid(count) <= t && grid(count) < until - 1e-9 * every {
            integration.interpolate(grid(count), &mut y)?;
            let simulation = integration.problem_mut();
            simulation.put_on_closures(&mut y);
            observe(simulation, grid(count), &y)?;
            count += 1;
        }
        if let Progress::Done { t } = progress {
            y.copy_from_slice(integration.state().1);
            let simulation = integration.problem_mut();
            simulation.put_on_closures(&mut y);
            observe(simulation, t, &y)?;
        }
        if watcher(t).is_break() {
            return Err(RunError::Stopped { time: t });
        }
    }
    Ok(())
}

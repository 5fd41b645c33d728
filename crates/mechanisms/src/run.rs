//! One run of a simulation with output on a grid of times.

use crate::error::MotionError;
use crate::simulation::{Observation, Simulation};
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
        "output every {every} s until {until} s: both must be finite, the first positive and the second after the start"
    )]
    Grid {
        /// Spacing \[s\].
        every: f64,
        /// End \[s\].
        until: f64,
    },
    /// The observer asked for the end.
    #[error("stopped by request at t = {time} s")]
    Stopped {
        /// Time \[s\].
        time: f64,
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
    let sound = |x: f64| x.is_finite() && x > 0.0;
    let start = integration.state().0;
    if !(sound(every) && until.is_finite() && until >= start) {
        return Err(RunError::Grid { every, until });
    }
    let mut observation = Observation::default();
    let mut y = integration.state().1.to_vec();
    let mut watch = |simulation: &mut Simulation, t: f64, y: &mut [f64]| -> Result<(), RunError> {
        simulation.put_on_closures(y);
        simulation.observe(t, y, &mut observation)?;
        match observer(&observation) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(RunError::Stopped { time: t }),
        }
    };
    watch(integration.problem_mut(), start, &mut y)?;
    let mut count = 1_u64;
    // Grid times are products, not sums, so that they do not drift.
    let grid = |count: u64| start + count as f64 * every;
    while integration.state().0 < until {
        let progress = integration.advance(until)?;
        let (t, _) = integration.state();
        while grid(count) <= t && grid(count) < until - 1e-9 * every {
            integration.interpolate(grid(count), &mut y)?;
            watch(integration.problem_mut(), grid(count), &mut y)?;
            count += 1;
        }
        if let Progress::Done { t } = progress {
            y.copy_from_slice(integration.state().1);
            watch(integration.problem_mut(), t, &mut y)?;
        }
    }
    Ok(())
}

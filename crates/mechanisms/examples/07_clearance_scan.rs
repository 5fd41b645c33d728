//! The RSUP scene with clearances from 1e-6 to 2e-3 m: which runs reach their end, which end with a bristle that runs away. With its
//! published damping the bristle is passive up to 0.02 m/s only; capped, or started on the steady bristle with little damping, it is
//! passive at all speeds.
//!
//! Arguments: end of the run \[s\] (default 0.05) and number of clearances (default 3); `5 24` takes some minutes.

use linkdyn_mechanisms::catalogue::{ClearanceKind, Rsup, bristle, rsup};
use linkdyn_mechanisms::friction::{Bristle, ElastoPlastic, Guard, LuGre};
use linkdyn_mechanisms::integrators::{Integration, Radau5};
use linkdyn_mechanisms::{RunError, Seen, Simulation, Tally, run_watched};
use std::error::Error;
use std::ops::ControlFlow;

/// Tolerance in clearances.
const TOLERANCE: f64 = 1e-6;
/// Steps after which a run is given up.
const MOST_STEPS: u64 = 3_000_000;

fn outcome(clearance_size: f64, friction: Bristle, until: f64) -> Result<String, Box<dyn Error>> {
    let scene = rsup(&Rsup {
        clearance: Some(ClearanceKind::Planar),
        clearance_size,
        friction: Some(friction),
        ..Rsup::default()
    })?;
    let mechanism = scene.linkage.build()?;
    let (start, _) = mechanism.assemble(&scene.start)?;
    let simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&start);
    let tolerance = TOLERANCE * clearance_size;
    let mut settings = simulation.settings(tolerance, tolerance);
    settings.max_steps = MOST_STEPS;
    let integration = Integration::new(simulation, Radau5::default(), 0.0, &y, settings)?;
    let mut integration = integration.with_stops(&mechanism.system().stop_times())?;
    let mut tally = Tally::default();
    let end = run_watched(&mut integration, until, until, |mut seen: Seen<'_>| {
        tally.see(&mut seen);
        ControlFlow::Continue(())
    });
    let point = tally.points.first().copied().unwrap_or_default();
    let (t, evaluations) = (integration.state().0, integration.statistics().evaluations);
    Ok(match end {
        Ok(()) => format!("{} impacts, {evaluations} evaluations", point.impacts),
        Err(RunError::Bristle { slip, coefficient, .. }) => {
            format!("bristle runs away at {t:.4} s: friction {coefficient:.0e} at {slip:.0e} m/s")
        }
        Err(error) => format!("ends at {t:.4} s: {error}"),
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let until: f64 = arguments.next().map_or(Ok(0.05), |text| text.parse())?;
    let count: u32 = arguments.next().map_or(Ok(3), |text| text.parse())?;
    let capped = LuGre {
        guard: Guard::Cap,
        ..bristle()
    };
    let elasto_plastic = ElastoPlastic {
        lugre: capped,
        elastic_share: 0.7,
    };
    let models: [(&str, Bristle); 3] = [
        ("published", bristle().into()),
        ("capped", capped.into()),
        ("elasto-plastic, capped", elasto_plastic.into()),
    ];
    for k in 0..count {
        let share = f64::from(k) / f64::from(count.max(2) - 1);
        let clearance = 1e-6 * 2000_f64.powf(share);
        for (name, model) in &models {
            println!(
                "{:9.2} um  {name:23} {}",
                1e6 * clearance,
                outcome(clearance, model.clone(), until)?
            );
        }
    }
    Ok(())
}

//! Scenes of the catalogue, run by any method, with all that is observed.

use linkdyn_integrators::{Integration, Method, Statistics};
use linkdyn_mechanisms::catalogue::{ClearanceKind, Rsrrr, Rsup, rsrrr, rsup};
use linkdyn_mechanisms::{ContactEvent, Mechanism, Observation, RunError, Scene, Seen, Simulation, State, run_watched};
use std::ops::ControlFlow;

/// A scene, built and closed.
pub struct Ready {
    /// The scene.
    pub scene: Scene,
    /// Its mechanism.
    pub mechanism: Mechanism,
    /// Its start.
    pub start: State,
}

/// RSRRR with or without friction, its coefficients scaled.
///
/// # Panics
/// If the scene does not build or close.
pub fn ready_rsrrr(friction: bool, friction_scale: f64) -> Ready {
    prepare(rsrrr(&Rsrrr {
        friction,
        friction_scale,
    }))
}

/// A variant of RSUP.
///
/// # Panics
/// If there is none such, or if it does not build or close.
pub fn ready_rsup(variant: &Rsup) -> Ready {
    prepare(rsup(variant).expect("there is such a variant"))
}

/// The built-in scenes and their main variants, as the program is told them.
pub fn builtin() -> [(&'static str, Ready); 7] {
    let variant = |clearance, flexible| {
        ready_rsup(&Rsup {
            clearance,
            flexible,
            ..Rsup::default()
        })
    };
    let (planar, spatial) = (Some(ClearanceKind::Planar), Some(ClearanceKind::Spatial));
    [
        ("rsrrr", ready_rsrrr(false, 1.0)),
        ("rsrrr --friction", ready_rsrrr(true, 1.0)),
        ("rsup", variant(None, None)),
        ("rsup --clearance planar", variant(planar, None)),
        ("rsup --clearance spatial", variant(spatial, None)),
        ("rsup --flexible 4", variant(None, Some(4))),
        ("rsup --flexible 4 --clearance planar", variant(planar, Some(4))),
    ]
}

/// Builds a scene and closes its loops.
///
/// # Panics
/// If it does not build or close.
pub fn prepare(scene: Scene) -> Ready {
    let mechanism = scene.linkage.build().expect("the scene builds");
    let (start, _) = mechanism.assemble(&scene.start).expect("the scene closes");
    Ready {
        scene,
        mechanism,
        start,
    }
}

/// Place of a coordinate among those of a scene.
///
/// # Panics
/// If there is none of this name.
pub fn index(ready: &Ready, name: &str) -> usize {
    let at = ready.mechanism.coordinate_names().position(|there| there == name);
    at.expect("there is such a coordinate")
}

/// A finished run.
pub struct Finished {
    /// All rows.
    pub rows: Vec<Observation>,
    /// Contacts made and lost, with their times.
    pub contacts: Vec<(f64, ContactEvent)>,
    /// Costs.
    pub statistics: Statistics,
    /// The simulation as it was left.
    pub simulation: Simulation,
    /// Why it ended early, if it did.
    pub end: Result<(), RunError>,
}

/// Runs to `until` with rows each `every` seconds, relative and absolute tolerance the same.
///
/// # Panics
/// If the settings are refused.
pub fn simulate(ready: &Ready, method: impl Method<Simulation>, tolerance: f64, until: f64, every: f64) -> Finished {
    simulate_with(ready, method, (tolerance, tolerance), until, every)
}

/// As [`simulate`], with relative and absolute tolerance.
///
/// # Panics
/// If the settings are refused.
pub fn simulate_with(
    ready: &Ready,
    method: impl Method<Simulation>,
    (relative, absolute): (f64, f64),
    until: f64,
    every: f64,
) -> Finished {
    let simulation = Simulation::new(&ready.mechanism);
    let y = simulation.state_vector(&ready.start);
    let settings = simulation.settings(relative, absolute);
    let stops = ready.mechanism.system().stop_times();
    let integration = Integration::new(simulation, method, 0.0, &y, settings).expect("valid settings");
    let mut integration = integration.with_stops(&stops).expect("finite stops");
    let (mut rows, mut contacts) = (Vec::new(), Vec::new());
    let end = run_watched(&mut integration, until, every, |seen| {
        match seen {
            Seen::Row(o) => rows.push(o.clone()),
            Seen::Contact { t, event } => contacts.push((t, event)),
            Seen::Step { .. } => {}
        }
        ControlFlow::Continue(())
    });
    Finished {
        rows,
        contacts,
        statistics: integration.statistics(),
        simulation: integration.problem().clone(),
        end,
    }
}

/// Largest difference of two sequences of numbers; NaN if there is one among them.
///
/// # Panics
/// If one is longer than the other.
pub fn distance<'a>(a: impl IntoIterator<Item = &'a f64>, b: impl IntoIterator<Item = &'a f64>) -> f64 {
    let (mut a, mut b) = (a.into_iter(), b.into_iter());
    let mut worst = 0.0_f64;
    loop {
        match (a.next(), b.next()) {
            (Some(a), Some(b)) => {
                let difference = (a - b).abs();
                // Once not a number, always not a number.
                worst = if difference <= worst || worst.is_nan() {
                    worst
                } else {
                    difference
                };
            }
            (None, None) => return worst,
            _ => panic!("sequences of unequal length"),
        }
    }
}

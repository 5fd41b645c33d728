//! Start and run of a scene file.

use super::fault::Faults;
use super::format::{MethodItem, RunItem, SceneFile};
use super::names::Names;
use crate::run::MOST_ROWS;
use crate::scene::RunSettings;

/// Names of coordinates, and numbers.
pub(super) fn check(file: &SceneFile, names: &Names, faults: &mut Faults<'_>) {
    let start = &file.start;
    for name in start.positions.keys() {
        names.check(&["start", "positions", name], name, faults);
    }
    for (k, name) in start.held.iter().enumerate() {
        names.check(&["start", "held", &format!("[{k}]")], name, faults);
    }
    for name in start.speeds.keys() {
        names.check(&["start", "speeds", name], name, faults);
    }
    for (key, name) in [("crank", &file.run.crank), ("output", &file.run.output)] {
        if let Some(name) = name {
            names.check(&["run", key], name, faults);
        }
    }
    let positions = start.positions.iter().map(|(name, value)| ("positions", name, value.0));
    let speeds = start.speeds.iter().map(|(name, &value)| ("speeds", name, value));
    for (key, name, value) in positions.chain(speeds).filter(|(.., value)| !value.is_finite()) {
        faults.add(&["start", key, name], format!("{value} must be a finite number"));
    }
    run(&file.run, faults);
}

/// Numbers of a run.
fn run(run: &RunItem, faults: &mut Faults<'_>) {
    let numbers = [
        ("until", Some(run.until), " s"),
        ("every", run.every, " s"),
        ("rtol", run.rtol, ""),
        ("atol", run.atol, ""),
        ("step", run.step, " s"),
    ];
    for (key, value, unit) in numbers {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
            faults.add(&["run", key], format!("{value}{unit} must be a finite positive number"));
        }
    }
    if run
        .every
        .is_some_and(|every| every > 0.0 && run.until / every > MOST_ROWS as f64)
    {
        faults.add(
            &["run", "every"],
            format!("makes more than {MOST_ROWS} rows; give more time between two of them"),
        );
    }
    let fixed = matches!(run.method, Some(MethodItem::Rk4 | MethodItem::Newmark));
    for (key, there, fits) in [
        ("rtol", run.rtol.is_some(), !fixed),
        ("atol", run.atol.is_some(), !fixed),
        ("step", run.step.is_some(), fixed),
    ] {
        if there && !fits && !faults.lacks(&["run", "method"]) {
            let message =
                "does not go with the method: `rk4` and `newmark` have a `step`, the others `rtol` and `atol`";
            faults.add(&["run", key], message);
        }
    }
}

/// How the scene is integrated.
pub(super) fn settings(run: &RunItem) -> RunSettings {
    let name = |method| match method {
        MethodItem::Auto => "auto",
        MethodItem::Adams => "adams",
        MethodItem::Dop853 => "dop853",
        MethodItem::Dopri5 => "dopri5",
        MethodItem::Radau5 => "radau5",
        MethodItem::Bdf => "bdf",
        MethodItem::Rodas => "rodas",
        MethodItem::Rk4 => "rk4",
        MethodItem::Newmark => "newmark",
    };
    RunSettings {
        every: run.every,
        method: run.method.map(|method| name(method).to_owned()),
        rtol: run.rtol,
        atol: run.atol,
        step: run.step,
    }
}

/// Coordinates held while the loops are closed: those given, and the turns of beams that are held straight.
pub(super) fn held(given: &[String], straight: Vec<String>) -> Vec<String> {
    let new = straight.into_iter().filter(|name| !given.contains(name));
    given.iter().cloned().chain(new).collect()
}

//! Start and run of a scene file.

use super::fault::Faults;
use super::format::SceneFile;
use super::names::Names;

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
    let until = file.run.until;
    if !(until.is_finite() && until > 0.0) {
        faults.add(&["run", "until"], format!("{until} s must be a finite positive number"));
    }
}

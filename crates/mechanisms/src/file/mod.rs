//! Scene files: linkages written as text, in TOML. Needs the feature `file`.
//!
//! ```
//! use linkdyn_mechanisms::file;
//! let scene = file::scene(
//!     "pendulum",
//!     r#"
//!     format = 1
//!     [links.rod]
//!     cylinder = { density = 7850, diameter = 0.02, along = [0.5, 0, 0] }
//!     [joints.A]
//!     kind = "revolute"
//!     axis = [0, 1, 0]
//!     successor = { link = "rod" }
//!     "#,
//! )?;
//! assert!(scene.linkage.build().is_ok());
//! # Ok::<(), file::SceneFileError>(())
//! ```

mod fault;
mod format;
mod joints;
mod links;
mod quantity;

pub use fault::{Fault, SceneFileError};
pub use format::*;
pub use quantity::Quantity;

use crate::linkage::Linkage;
use crate::mechanism::Start;
use crate::scene::Scene;
use fault::{Faults, nearest, refused};

/// A commented scene file to begin with: a four-bar.
pub const TEMPLATE: &str = include_str!("../../scenes/four_bar.toml");

/// The JSON Schema of scene files, for editors.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(SceneFile).to_value()
}

/// The scene of a scene file's text, called `name`. Joints that the file leaves open are cut or carry links by
/// [`spanning_tree`](crate::spanning_tree); those with drives, springs, friction or named coordinates carry.
///
/// # Errors
/// A text that is no TOML, keys and kinds that there are not: the first one. Else all names and numbers that are wrong at once.
pub fn scene(name: &str, text: &str) -> Result<Scene, SceneFileError> {
    let file: SceneFile = toml::from_str(text).map_err(|error| refused(text, &error))?;
    let mut faults = Faults::new(text);
    if file.format != 1 {
        let message = format!("{} is no known format; write `format = 1`", file.format);
        faults.add(&["format"], message);
    }
    if !file.gravity.iter().all(|x| x.is_finite()) {
        faults.add(&["gravity"], "must be three finite numbers in m/s^2");
    }
    let mut linkage = Linkage::new(file.gravity);
    links::add(&file, &mut linkage, &mut faults);
    joints::add(&file, &mut linkage, &mut faults);
    check_start(&file, &linkage, &mut faults);
    if faults.found.is_empty()
        && let Err(error) = linkage.build()
    {
        faults.add(&["joints"], error.to_string());
    }
    if !faults.found.is_empty() {
        return Err(SceneFileError(faults.found));
    }
    let first = linkage.joints.iter().flat_map(|joint| joint.coordinates()).next();
    Ok(Scene {
        name: name.to_owned(),
        summary: file.summary,
        linkage,
        start: Start {
            positions: file
                .start
                .positions
                .into_iter()
                .map(|(name, Quantity(value))| (name, value))
                .collect(),
            held: file.start.held,
            speeds: file.start.speeds.into_iter().collect(),
        },
        until: file.run.until,
        reactions: file.run.reactions,
        crank: file.run.crank.or(first).unwrap_or_default(),
        output: file.run.output,
    })
}

/// Start and run: names of coordinates, and numbers.
fn check_start(file: &SceneFile, linkage: &Linkage, faults: &mut Faults<'_>) {
    let known: Vec<String> = linkage.joints.iter().flat_map(|joint| joint.coordinates()).collect();
    let mut check = |keys: &[&str], name: &str| {
        if !known.iter().any(|there| there == name) {
            let hint = match nearest(name, known.iter().map(String::as_str)) {
                Some(word) => format!("did you mean `{word}`?"),
                None => format!("there are {}", known.join(", ")),
            };
            faults.add(keys, format!("there is no coordinate `{name}`; {hint}"));
        }
    };
    for name in file.start.positions.keys() {
        check(&["start", "positions", name], name);
    }
    for name in &file.start.held {
        check(&["start", "held"], name);
    }
    for name in file.start.speeds.keys() {
        check(&["start", "speeds", name], name);
    }
    for (key, name) in [("crank", &file.run.crank), ("output", &file.run.output)] {
        if let Some(name) = name {
            check(&["run", key], name);
        }
    }
    let positions = file
        .start
        .positions
        .iter()
        .map(|(name, value)| ("positions", name, value.0));
    let speeds = file.start.speeds.iter().map(|(name, &value)| ("speeds", name, value));
    for (key, name, value) in positions.chain(speeds).filter(|(.., value)| !value.is_finite()) {
        faults.add(&["start", key, name], format!("{value} must be a finite number"));
    }
    let until = file.run.until;
    if !(until.is_finite() && until > 0.0) {
        faults.add(&["run", "until"], format!("{until} s must be a finite positive number"));
    }
}

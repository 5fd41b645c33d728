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

mod beam;
mod clearance;
mod contact;
mod examples;
mod fault;
mod format;
mod friction;
mod joints;
mod links;
mod loads;
mod names;
mod points;
mod prescribed;
mod quantity;
mod shape;
mod start;

pub use beam::{BeamItem, SectionItem};
pub use clearance::{BristleItem, ClearanceItem};
pub use contact::ContactItem;
pub use examples::EXAMPLES;
pub use fault::{Fault, SceneFileError};
pub use format::*;
pub use friction::FrictionItem;
pub use points::{AxesItem, LimitItem, PointLoadItem, StrutItem};
pub use prescribed::PrescribedItem;
pub use quantity::Quantity;

use crate::linkage::Linkage;
use crate::mechanism::Start;
use crate::scene::Scene;
use fault::Faults;
use links::Links;
use names::Names;
use serde::Deserialize;
use std::sync::LazyLock;
use toml::Spanned;
use toml::de::{DeTable, Deserializer};

/// A commented scene file to begin with: a four-bar.
pub const TEMPLATE: &str = include_str!("../../scenes/four_bar.toml");

/// The JSON Schema of scene files, for editors.
pub fn schema() -> serde_json::Value {
    SCHEMA.clone()
}

/// Made once, for each file that is read is held against it.
static SCHEMA: LazyLock<serde_json::Value> = LazyLock::new(|| {
    let mut schema = schemars::schema_for!(SceneFile).to_value();
    shape::describe(&mut schema);
    schema
});

/// The scene of a scene file's text, called `name`. Joints that the file leaves open are cut or carry links by
/// [`spanning_tree`](crate::spanning_tree); those with drives, springs, friction or named coordinates carry.
///
/// # Errors
/// All that is wrong at once, as far as one can be judged without the other. A text that is no TOML is not judged further, and whether
/// the equations of motion can be set up only where nothing else is wrong.
pub fn scene(name: &str, text: &str) -> Result<Scene, SceneFileError> {
    let mut faults = Faults::new(text);
    let (table, errors) = DeTable::parse_recoverable(text);
    for error in &errors {
        faults.at(error.span().map_or(0, |span| span.start), &[], error.message());
    }
    if !errors.is_empty() {
        return Err(faults.result());
    }
    let mut mended = table.into_inner();
    shape::mend(&SCHEMA, &mut mended, &mut faults);
    faults.look_up_in(mended.clone());
    let file = match SceneFile::deserialize(Deserializer::from(Spanned::new(0..0, mended))) {
        Ok(file) => file,
        Err(error) => {
            faults.at(error.span().map_or(0, |span| span.start), &[], error.message());
            return Err(faults.result());
        }
    };
    if file.format != 1 {
        let message = format!("{} is no known format; write `format = 1`", file.format);
        faults.add(&["format"], message);
    }
    if !file.gravity.iter().all(|x| x.is_finite()) {
        faults.add(&["gravity"], "must be three finite numbers in m/s^2");
    }
    let mut linkage = Linkage::new(file.gravity);
    let links = Links::add(&file, &mut linkage, &mut faults);
    let mut names = Names::of_beams(&file, &linkage, &mut faults);
    let cut = joints::add(&file, &links, &mut linkage, &mut faults);
    names.add_joints(&file, cut.as_deref(), &mut faults);
    joints::contact_names(&linkage, &mut faults);
    points::add(&file, &links, &mut linkage, &mut faults);
    start::check(&file, &names, &mut faults);
    if faults.none()
        && let Err(error) = linkage.build()
    {
        faults.add(&["joints"], error.to_string());
    }
    if !faults.none() {
        return Err(faults.result());
    }
    let settings = start::settings(&file.run);
    let positions = file.start.positions.into_iter();
    Ok(Scene {
        name: name.to_owned(),
        summary: file.summary,
        linkage,
        start: Start {
            positions: positions.map(|(name, Quantity(value))| (name, value)).collect(),
            held: start::held(&file.start.held, links.straight),
            speeds: file.start.speeds.into_iter().collect(),
        },
        until: file.run.until,
        reactions: file.run.reactions,
        crank: file.run.crank.or(names.first).unwrap_or_default(),
        output: file.run.output,
        settings,
    })
}

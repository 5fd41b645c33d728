//! `linkdyn check`, `linkdyn new` and `linkdyn schema`: what a scene file says, one to begin with, and what one may say.

use std::fs::OpenOptions;
use std::io::Write;

use linkdyn_mechanisms::{Observation, Simulation, file};

use crate::analyse::mobility_tables;
use crate::args::{CheckArgs, NewArgs};
use crate::errors::CliError;
use crate::output;
use crate::run::ready;
use crate::scenes::{self, Variant};
use crate::summary::Table;

/// `linkdyn check`. What the linkage is made of is drawn also where it cannot start.
///
/// # Errors
/// What is wrong with the file; loops that cannot be closed from its start; a start without accelerations.
pub fn check(args: &CheckArgs) -> Result<(), CliError> {
    let scene = scenes::find(&args.scene)?.scene(&Variant::default())?;
    output::print(&scene.linkage.outline())?;
    let prepared = ready(scene)?;
    let tables = mobility_tables(&prepared);
    let tables = tables.map_err(|error| CliError::failed("the freedoms cannot be counted").with_source(error))?;
    let tables: Vec<String> = tables.iter().map(Table::to_text).collect();
    output::print(&format!("\n{}", tables.join("\n")))?;
    let mut simulation = Simulation::new(&prepared.mechanism);
    let y = simulation.state_vector(&prepared.start);
    simulation
        .observe(0.0, &y, &mut Observation::default())
        .map_err(|error| {
            let message = format!("scene `{}` has no accelerations at its start", prepared.scene.name);
            CliError::usage(message).with_source(error)
        })
}

/// `linkdyn new`.
///
/// # Errors
/// A file that is there already, or cannot be written; an example that there is not.
pub fn new(args: &NewArgs) -> Result<(), CliError> {
    let text = match &args.from {
        Some(name) => scenes::example(name)?,
        None => file::TEMPLATE,
    };
    let path = args.file.display();
    let file = OpenOptions::new().write(true).create_new(true).open(&args.file);
    let written = file.and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| {
        CliError::usage(format!("cannot write `{path}`"))
            .with_source(error)
            .with_hint("give the name of a file that is not there yet, in a folder that is")
    })?;
    output::print(&format!(
        "wrote {path}; `linkdyn check {path}` tells what it is, `linkdyn run {path}` runs it\n"
    ))
}

/// `linkdyn schema`.
///
/// # Errors
/// Only those of standard output.
pub fn schema() -> Result<(), CliError> {
    output::print(&format!("{:#}\n", file::schema()))
}

//! `linkdyn check`, `linkdyn new` and `linkdyn schema`: what a scene file says, one to begin with, and what one may say.

use std::fs::OpenOptions;
use std::io::Write;

use linkdyn_mechanisms::{Mechanism, Start, State, file};

use crate::args::{CheckArgs, NewArgs};
use crate::errors::CliError;
use crate::output;
use crate::run::ready;
use crate::scenes::{self, Variant};

/// `linkdyn check`.
///
/// # Errors
/// All that is wrong with the file; loops that cannot be closed from its start.
pub fn check(args: &CheckArgs) -> Result<(), CliError> {
    let prepared = ready(scenes::find(&args.scene)?.scene(&Variant::default())?)?;
    let speeds = prepared.mechanism.system().tree().speeds();
    let (equations, rank) = loops(&prepared.mechanism, &prepared.start)?;
    let outline = prepared.scene.linkage.outline();
    output::print(&format!(
        "{outline}\nfreedoms of the tree        {speeds}\nequations of cut joints     {equations}\n  of them redundant         {}\n\
         degrees of freedom at start {}\n",
        equations - rank,
        speeds - rank
    ))
}

/// Number of equations of the ideal cut joints at a closed state, and the rank of their gradient.
fn loops(mechanism: &Mechanism, state: &State) -> Result<(usize, usize), CliError> {
    let names = mechanism.coordinate_names().map(str::to_owned);
    let start = Start {
        positions: names.zip(state.q.iter().copied()).collect(),
        ..Start::default()
    };
    let closed = mechanism.assemble(&start);
    let (_, closed) = closed.map_err(|error| CliError::failed("the loops do not stay closed").with_source(error))?;
    Ok((closed.equations, closed.rank))
}

/// `linkdyn new`.
///
/// # Errors
/// A file that is there already, or cannot be written.
pub fn new(args: &NewArgs) -> Result<(), CliError> {
    let path = args.file.display();
    let file = OpenOptions::new().write(true).create_new(true).open(&args.file);
    let written = file.and_then(|mut file| file.write_all(file::TEMPLATE.as_bytes()));
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

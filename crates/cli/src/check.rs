//! `linkdyn check` and `linkdyn schema`: what a scene file says, and what one may say.

use linkdyn_mechanisms::{Mechanism, Start, State, file};

use crate::args::CheckArgs;
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

/// `linkdyn schema`.
///
/// # Errors
/// Only those of standard output.
pub fn schema() -> Result<(), CliError> {
    output::print(&format!("{:#}\n", file::schema()))
}

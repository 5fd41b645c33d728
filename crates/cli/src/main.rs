//! The `linkdyn` program.

use std::process::ExitCode;

use clap::Parser;
use linkdyn_cli::args::{Arguments, Command};
use linkdyn_cli::errors::CliError;

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Run(_) => Err(CliError::failed("`run` is not available yet")),
        Command::Scenes(_) => Err(CliError::failed("`scenes` is not available yet")),
    };
    linkdyn_cli::errors::exit(outcome)
}

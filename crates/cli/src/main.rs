//! The `linkdyn` program.

use std::process::ExitCode;

use clap::Parser;
use linkdyn_cli::args::{Arguments, Command};

fn main() -> ExitCode {
    linkdyn_cli::errors::exit(match Arguments::parse().command {
        Command::Run(args) => linkdyn_cli::run::run(&args),
        Command::Report(args) => linkdyn_cli::report::report(&args),
        Command::Stability(args) => linkdyn_cli::stability::stability(&args),
        Command::Analyse(args) => linkdyn_cli::analyse::analyse(&args),
        Command::Check(args) => linkdyn_cli::check::check(&args),
        Command::Draw(args) => linkdyn_cli::draw::draw(&args),
        Command::New(args) => linkdyn_cli::check::new(&args),
        Command::Schema => linkdyn_cli::check::schema(),
        Command::Scenes(args) => linkdyn_cli::scenes::list(&args),
    })
}

//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

/// Dynamics of spatial linkages with imperfect joints.
#[derive(Debug, Parser)]
#[command(name = "linkdyn", version, about, max_term_width = 100, subcommand_required = true)]
#[command(after_help = "Example:\n  linkdyn run rsrrr --friction --out rsrrr-friction")]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Simulate a scene and write its results
    Run(RunArgs),
    /// List the built-in scenes
    Scenes(ScenesArgs),
}

/// Options of `linkdyn run`.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// Name of a built-in scene (see `linkdyn scenes`)
    pub scene: String,
    /// Folder for the results; an earlier run in it is replaced as a whole
    #[arg(short, long, value_name = "DIR")]
    pub out: PathBuf,
    /// Take friction in the joints into account
    #[arg(long)]
    pub friction: bool,
    /// Integration method
    #[arg(long, value_name = "NAME")]
    pub method: Option<String>,
    /// Relative tolerance
    #[arg(long, value_name = "NUMBER", value_parser = positive)]
    pub rtol: Option<f64>,
    /// Absolute tolerance
    #[arg(long, value_name = "NUMBER", value_parser = positive)]
    pub atol: Option<f64>,
    /// Fixed step, in seconds
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub step: Option<f64>,
    /// Simulated time at which to stop, in seconds
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub until: Option<f64>,
    /// Time between two rows of the results, in seconds
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub every: Option<f64>,
    /// Print the summary as JSON, and no progress
    #[arg(long)]
    pub json: bool,
    /// Print no progress
    #[arg(short, long)]
    pub quiet: bool,
}

/// Options of `linkdyn scenes`.
#[derive(Debug, Args)]
pub struct ScenesArgs {
    /// Print the list as JSON
    #[arg(long)]
    pub json: bool,
}

/// A number that is finite and greater than zero.
fn positive(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        Ok(x) => Err(format!("{x} is not a finite number greater than zero")),
        Err(_) => Err("not a number; write it like 0.001 or 1e-3".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    fn run(options: &[&str]) -> Result<RunArgs, clap::Error> {
        let words = ["linkdyn", "run"].iter().chain(options);
        match Arguments::try_parse_from(words)?.command {
            Command::Run(args) => Ok(args),
            Command::Scenes(_) => panic!("`run` was parsed as `scenes`"),
        }
    }

    #[test]
    fn definition_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn all_options_are_read() {
        let args = run(&[
            "rsrrr",
            "--friction",
            "--out",
            "x",
            "--method",
            "radau",
            "--rtol",
            "1e-8",
            "--atol",
            "1e-10",
            "--step",
            "0.001",
            "--until",
            "2",
            "--every",
            "0.01",
            "--json",
            "--quiet",
        ])
        .expect("valid options");
        assert_eq!(args.scene, "rsrrr");
        assert_eq!(args.out, PathBuf::from("x"));
        assert!(args.friction && args.json && args.quiet);
        assert_eq!(args.method.as_deref(), Some("radau"));
        assert_eq!(
            (args.rtol, args.atol, args.step),
            (Some(1e-8), Some(1e-10), Some(0.001))
        );
        assert_eq!((args.until, args.every), (Some(2.0), Some(0.01)));
    }

    #[test]
    fn wrong_usage_has_exit_code_2() {
        let wrong: [&[&str]; 9] = [
            &[],
            &["rsrrr"],
            &["rsrrr", "--out"],
            &["rsrrr", "--out", "x", "--frictoin"],
            &["rsrrr", "--out", "x", "--rtol", "0"],
            &["rsrrr", "--out", "x", "--rtol", "-1e-3"],
            &["rsrrr", "--out", "x", "--atol", "NaN"],
            &["rsrrr", "--out", "x", "--until", "inf"],
            &["rsrrr", "--out", "x", "--every", "often"],
        ];
        for options in wrong {
            let error = run(options).expect_err(&format!("accepted {options:?}"));
            assert_eq!(error.exit_code(), 2, "{options:?}");
        }
    }

    #[test]
    fn version_is_the_crates() {
        let error = Arguments::try_parse_from(["linkdyn", "--version"]).expect_err("prints and stops");
        assert_eq!(error.exit_code(), 0);
        assert_eq!(
            error.to_string().trim(),
            format!("linkdyn {}", env!("CARGO_PKG_VERSION"))
        );
    }
}

//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

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
    Run(Box<RunArgs>),
    /// Measure methods on a scene: error against evaluations and time
    Report(ReportArgs),
    /// Find where methods stop being stable on a scene, and what limits them
    Stability(StabilityArgs),
    /// Tell what can move in a scene, where it goes, where it rests, how it vibrates
    Analyse(AnalyseArgs),
    /// Say all that is wrong with a scene file, else draw its tree and count its freedoms
    Check(CheckArgs),
    /// Draw a scene at its start, as SVG or PNG: links in colours, joints by their symbols, the ground hatched
    Draw(DrawArgs),
    /// Write a commented scene file to begin with
    New(NewArgs),
    /// Print the JSON Schema of scene files, for editors
    Schema,
    /// List the built-in scenes
    Scenes(ScenesArgs),
}

/// Options of `linkdyn run`.
#[derive(Clone, Debug, Args)]
pub struct RunArgs {
    /// Name of a built-in scene (see `linkdyn scenes`), or a scene file
    pub scene: String,
    /// Folder for the results; an earlier run in it is replaced as a whole [default: below out/, named after scene and variant]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What to switch in the scene.
    #[command(flatten)]
    pub variant: VariantArgs,
    /// The second paper's own way (rsup): rk4 with a step of 5e-6 s, drift terms with alpha = 100 and beta = 50 in place of
    /// projection, contacts made and lost at the ends of steps
    #[arg(long)]
    pub as_published: bool,
    /// Find joint friction by this number of sweeps reactions - friction - accelerations from zero at each evaluation, instead of
    /// solving that loop (the paper's way)
    #[arg(long, value_name = "K", value_parser = count)]
    pub friction_sweeps: Option<usize>,
    /// Formulation of the equations of motion
    #[arg(long, value_enum, default_value_t = FormulationArg::Recursive)]
    pub formulation: FormulationArg,
    /// Begin where the scene rests under its loads at t = 0, flexible links sagged, with these coordinates where the scene starts (`A` or
    /// `A,B`, or `none`), and with the speeds of its start [default: not so; without names the scene's crank]
    #[arg(long, value_name = "HELD", num_args = 0..=1, default_missing_value = "", require_equals = true)]
    pub equilibrium: Option<String>,
    /// Integration method: auto (adams or radau5, as the run finds them cheaper), adams (variable order and step), dop853, dopri5,
    /// radau5, bdf and rodas (for stiff scenes); with fixed step rk4, newmark [default: the file's, else auto]
    #[arg(long, value_name = "NAME")]
    pub method: Option<String>,
    /// Relative tolerance of adaptive methods; with clearance the absolute one alone counts [default: 1e-12; radau5,
    /// bdf, rodas, and auto with a flexible link 1e-9; with clearance 1e-6 of it]
    #[arg(long, value_name = "NUMBER", value_parser = positive)]
    pub rtol: Option<f64>,
    /// Absolute tolerance of adaptive methods [default: that of --rtol]
    #[arg(long, value_name = "NUMBER", value_parser = positive)]
    pub atol: Option<f64>,
    /// Corrector iterations in each step of newmark [default: until they settle]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub iterations: Option<u32>,
    /// Fixed step of rk4 and newmark, in seconds [default: 1e-4, with --as-published 5e-6]
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub step: Option<f64>,
    /// Simulated time at which to stop, in seconds [default: the scene's]
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub until: Option<f64>,
    /// Time between two rows of the results, in seconds [default: the file's, else 1/500 of the run]
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub every: Option<f64>,
    /// Print the summary as JSON, and no progress
    #[arg(long)]
    pub json: bool,
    /// Print no progress
    #[arg(short, long)]
    pub quiet: bool,
}

/// Options that switch something in a scene.
#[derive(Clone, Debug, Args)]
pub struct VariantArgs {
    /// Take friction in the joints into account
    #[arg(long, overrides_with = "no_friction")]
    pub friction: bool,
    /// Leave friction out
    #[arg(long)]
    pub no_friction: bool,
    /// Factor on all coefficients of friction (rsrrr)
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    pub friction_scale: Option<f64>,
    /// Give joint R clearance, with contact and friction (rsup)
    #[arg(long, value_enum, value_name = "MODEL")]
    pub clearance: Option<ClearanceArg>,
    /// Radius of the hole less that of the pin, in metres (rsup) [default: 0.001]
    #[arg(long, value_name = "METRES", value_parser = positive)]
    pub clearance_size: Option<f64>,
    /// Bristle model of friction in the clearance joint (rsup) [default: lugre]
    #[arg(long, value_enum, value_name = "MODEL")]
    pub bristle: Option<BristleArg>,
    /// Make the coupler flexible, with N spring-damping elements and N + 1 rigid finite elements (rsup)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=500))]
    pub flexible: Option<u16>,
}

/// Options of `linkdyn report`.
#[derive(Debug, Args)]
pub struct ReportArgs {
    /// Name of a built-in scene (see `linkdyn scenes`), or a scene file
    #[arg(required_unless_present = "all")]
    pub scene: Option<String>,
    /// Report on all built-in scenes and their main variants, each with its share of the budget
    #[arg(
        long,
        conflicts_with_all = [
            "scene", "friction", "no_friction", "friction_scale", "clearance", "clearance_size", "bristle", "flexible",
        ]
    )]
    pub all: bool,
    /// Folder for the report; an earlier run or report in it is replaced as a whole [default: out/report-, and the name of scene
    /// and variant or `all`]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What to switch in the scene.
    #[command(flatten)]
    pub variant: VariantArgs,
    /// Simulated time at which to stop, in seconds [default: the scene's]
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub until: Option<f64>,
    /// Time on the clock that all runs together may take, in seconds; what does not fit is listed as not run [default: 120 for each
    /// scene]
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub budget: Option<f64>,
    /// Folder in which references are kept for the next report [default: LINKDYN_CACHE, else linkdyn in the user's folder for caches]
    #[arg(long, value_name = "DIR", conflicts_with = "no_cache")]
    pub cache: Option<PathBuf>,
    /// Compute the reference anew, and keep none
    #[arg(long)]
    pub no_cache: bool,
    /// Print the report as JSON, and no progress
    #[arg(long)]
    pub json: bool,
    /// Print no progress
    #[arg(short, long)]
    pub quiet: bool,
}

/// Options of `linkdyn stability`.
#[derive(Debug, Args)]
pub struct StabilityArgs {
    /// Name of a built-in scene (see `linkdyn scenes`), or a scene file
    pub scene: String,
    /// Folder for the tables; an earlier run in it is replaced as a whole [default: out/stability-, and the name of scene and
    /// variant]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What to switch in the scene.
    #[command(flatten)]
    pub variant: VariantArgs,
    /// Simulated time at which runs other than long ones stop, in seconds
    #[arg(long, value_name = "SECONDS", value_parser = positive, default_value_t = 0.2)]
    pub until: f64,
    /// Time on the clock that all runs together may take, in seconds; what does not fit is listed as not run
    #[arg(long, value_name = "SECONDS", value_parser = positive, default_value_t = 120.0)]
    pub budget: f64,
    /// Print the tables as JSON, and no progress
    #[arg(long)]
    pub json: bool,
    /// Print no progress
    #[arg(short, long)]
    pub quiet: bool,
}

/// Options of `linkdyn analyse`.
#[derive(Debug, Args)]
pub struct AnalyseArgs {
    /// Name of a built-in scene (see `linkdyn scenes`), or a scene file
    pub scene: String,
    /// What to find out
    #[arg(value_enum)]
    pub what: AnalysisArg,
    /// What to switch in the scene.
    #[command(flatten)]
    pub variant: VariantArgs,
    /// Coordinate to drive (positions, drives) [default: the scene's crank]
    #[arg(long, value_name = "NAME")]
    pub drive: Option<String>,
    /// Value to drive it to from the start, in radians or metres (positions, drives) [default: one turn]
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true)]
    pub to: Option<f64>,
    /// Equal parts of the way, one row more than these (positions, drives)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), default_value_t = 24)]
    pub parts: u16,
    /// Speed at which it is driven, in radians or metres per second (positions, drives)
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, default_value_t = 1.0)]
    pub speed: f64,
    /// Rate of that speed (positions, drives)
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, default_value_t = 0.0)]
    pub acceleration: f64,
    /// Coordinates that stay where the scene starts, `A` or `A,B` (equilibrium, modes, branches) [default: none; for branches those that
    /// the scene's start holds, else its crank]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub hold: Vec<String>,
    /// Guesses to search from (branches)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), default_value_t = 200)]
    pub guesses: u16,
    /// Time at which loads are taken, in seconds (equilibrium, modes, drives)
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, default_value_t = 0.0)]
    pub time: f64,
    /// Print the tables as JSON
    #[arg(long)]
    pub json: bool,
}

/// Analyses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AnalysisArg {
    /// Freedoms, and the redundant equations by name
    Mobility,
    /// All closed positions that a search finds
    Branches,
    /// Positions of all coordinates over a range of the driven one, their speeds and the rates of these
    Positions,
    /// Torque or force that drives it through a range, with the reactions of all joints
    Drives,
    /// Where it rests, and whether stably
    Equilibrium,
    /// Frequencies, damping and shapes about the equilibrium
    Modes,
}

/// Options of `linkdyn check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Name of a built-in scene (see `linkdyn scenes`), or a scene file
    pub scene: String,
}

/// Options of `linkdyn draw`.
#[derive(Debug, Args)]
pub struct DrawArgs {
    /// Name of a built-in scene (see `linkdyn scenes`), or a scene file
    pub scene: String,
    /// Picture to write, which ends in .svg or .png; one that is there is replaced
    #[arg(short, long, value_name = "PICTURE")]
    pub out: PathBuf,
    /// What to switch in the scene.
    #[command(flatten)]
    pub variant: VariantArgs,
}

/// Options of `linkdyn new`.
#[derive(Debug, Args)]
pub struct NewArgs {
    /// File to write, which must not be there yet
    pub file: PathBuf,
    /// Example to begin with (see `linkdyn scenes`) [default: four_bar]
    #[arg(long, value_name = "NAME")]
    pub from: Option<String>,
}

/// Options of `linkdyn scenes`.
#[derive(Debug, Args)]
pub struct ScenesArgs {
    /// Print the list as JSON
    #[arg(long)]
    pub json: bool,
}

/// Ways to the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FormulationArg {
    /// Recursive Newton-Euler and composite or articulated bodies
    Recursive,
    /// The papers' Lagrange equations with traces of 4 x 4 matrices, slow, for comparison
    Lagrange,
}

/// Models of a joint with clearance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ClearanceArg {
    /// The axes stay parallel
    Planar,
    /// The pin may tilt in its hole
    Spatial,
}

/// Bristle models of friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BristleArg {
    /// LuGre as published: passive at low speeds only
    Lugre,
    /// LuGre as published, started on the deflection of lasting sliding
    Steady,
    /// LuGre whose damping is capped, so that it is passive and friction never exceeds its static value
    Cap,
    /// LuGre whose damping decays with the sliding speed
    Decay,
    /// Elasto-plastic, with capped damping
    ElastoPlastic,
    /// Dahl: no damping of the bristle, no static peak
    Dahl,
}

impl BristleArg {
    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> String {
        self.to_possible_value()
            .map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

/// A whole number from 1 to 1000.
fn count(text: &str) -> Result<usize, String> {
    match text.trim().parse::<usize>() {
        Ok(k) if (1..=1000).contains(&k) => Ok(k),
        _ => Err("give a whole number from 1 to 1000".to_owned()),
    }
}

/// A factor on friction; beyond a thousand nothing moves at all.
fn factor(text: &str) -> Result<f64, String> {
    positive(text).and_then(|x| {
        if x <= 1e3 {
            Ok(x)
        } else {
            Err(format!("{x} is more than 1000"))
        }
    })
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
            Command::Run(args) => Ok(*args),
            _ => panic!("`run` was parsed as another command"),
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
        assert_eq!(args.out, Some(PathBuf::from("x")));
        assert!(args.variant.friction && args.json && args.quiet);
        assert_eq!(args.method.as_deref(), Some("radau"));
        assert_eq!(
            (args.rtol, args.atol, args.step),
            (Some(1e-8), Some(1e-10), Some(0.001))
        );
        assert_eq!((args.until, args.every), (Some(2.0), Some(0.01)));
    }

    #[test]
    fn wrong_usage_has_exit_code_2() {
        let wrong: [&[&str]; 10] = [
            &[],
            &["rsrrr", "--out"],
            &["rsrrr", "--friction-sweeps", "0"],
            &["rsrrr", "--formulation", "hamilton"],
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

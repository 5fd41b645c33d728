//! `linkdyn run`: simulate a scene, write its results, draw them, say what happened.

pub mod methods;
pub mod pictures;
pub mod record;
pub mod report;

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use linkdyn_mechanisms::dynamics::{Formulation, ReactionSolver};
use linkdyn_mechanisms::integrators::Integration;
use linkdyn_mechanisms::{MOST_ROWS, Mechanism, Observation, RunError, Scene, Simulation, State, run_watched};

use crate::args::{FormulationArg, RunArgs};
use crate::errors::CliError;
use crate::interrupt::Interrupt;
use crate::output;
use crate::progress::Progress;
use crate::results::RunFolder;
use crate::scenes::{self, Variant};

use methods::Plan;
use pictures::{Curve, Names};
use record::Record;
use report::Outcome;

/// Rows of the results where nothing else is asked for.
const ROWS: f64 = 500.0;

/// A scene ready to run.
struct Prepared {
    scene: Scene,
    mechanism: Mechanism,
    start: State,
}

/// `linkdyn run`.
///
/// # Errors
/// Wrong usage, a scene that cannot start, a run that ends early (its rows are written), a folder that cannot be written.
pub fn run(args: &RunArgs) -> Result<(), CliError> {
    let plan = Plan::new(args)?;
    let variant = Variant {
        friction: args.friction,
        friction_scale: args.friction_scale,
    };
    let prepared = prepare(args, &variant)?;
    let until = args.until.unwrap_or(prepared.scene.until);
    let grid = (until, args.every.unwrap_or(until / ROWS));
    if grid.0 / grid.1 > MOST_ROWS as f64 {
        let message = format!(
            "--every {} s until {} s makes more than {MOST_ROWS} rows",
            grid.1, grid.0
        );
        return Err(CliError::usage(message).with_hint("give a larger `--every`"));
    }
    let target = args
        .out
        .clone()
        .unwrap_or_else(|| default_folder(&prepared.scene, &variant));

    let mut folder = RunFolder::create(&target)?;
    let interrupt = Interrupt::install()?;
    let simulation = Simulation::new(&prepared.mechanism);
    let columns = simulation.columns(prepared.scene.reactions);
    let mut table = folder.table("states.csv", &columns)?;
    let mut progress = Progress::new(&prepared.scene.name, 0.0, until, args.quiet || args.json);
    let mut row = Vec::new();
    let mut write_error = None;
    let (record, mut outcome, ended) = simulate(
        &prepared,
        &plan,
        grid,
        |o| {
            o.write(prepared.scene.reactions, &mut row);
            if let Err(error) = table.row(&row) {
                write_error = Some(error);
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        },
        |t| {
            progress.set(t);
            flow(&interrupt)
        },
    )?;
    drop(progress);
    if let Some(error) = write_error {
        return Err(error.into());
    }
    outcome.rows = table.finish()?;
    write_stops(
        &mut folder,
        &prepared.mechanism,
        record.t.last().copied().unwrap_or(0.0),
    )?;
    let other = compare(args, &plan, grid, &variant, &record, &interrupt);
    draw(&prepared, &variant, &record, other.as_ref(), &mut folder)?;

    let summary = report::summary(&prepared.scene, &prepared.mechanism, &record, &outcome);
    let manifest = report::manifest(&prepared.scene, &plan, grid, &columns, &summary, &outcome);
    let placed = folder.commit(&manifest)?;
    if args.json {
        output::print(&format!("{manifest:#}\n"))?;
    } else {
        output::print(&format!("{}\nresults in {}\n", summary.to_text(), shown(&placed)))?;
    }
    match ended {
        Ok(()) => Ok(()),
        Err(RunError::Stopped { time }) => Err(CliError::interrupted(format!(
            "stopped at t = {time} s; the rows up to there are written"
        ))),
        Err(error) => Err(CliError::failed("the run ended early; the rows up to there are written").with_source(error)),
    }
}

/// Builds the scene with what the command line switched, and closes its loops.
fn prepare(args: &RunArgs, variant: &Variant) -> Result<Prepared, CliError> {
    let mut scene = scenes::find(&args.scene)?.scene(variant);
    if let Some(sweeps) = args.friction_sweeps {
        scene.linkage.reaction_solver = ReactionSolver::Sweeps { sweeps };
    }
    if args.formulation == FormulationArg::Lagrange {
        scene.linkage.formulation = Formulation::Lagrange;
    }
    let wrong = |what: &str| CliError::usage(format!("scene `{}` {what}", args.scene));
    let mechanism = scene
        .linkage
        .build()
        .map_err(|error| wrong("cannot be built").with_source(error))?;
    let (start, _) = mechanism
        .assemble(&scene.start)
        .map_err(|error| wrong("cannot start").with_source(error))?;
    Ok(Prepared {
        scene,
        mechanism,
        start,
    })
}

/// Runs a scene; `observe` sees each output and `watch` each step first. The inner result tells why the run ended early, if it did.
fn simulate(
    prepared: &Prepared,
    plan: &Plan,
    grid: (f64, f64),
    mut observe: impl FnMut(&Observation) -> ControlFlow<()>,
    watch: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<(Record, Outcome, Result<(), RunError>), CliError> {
    let mut simulation = Simulation::new(&prepared.mechanism);
    simulation.set_drift_tolerance(plan.drift_tolerance());
    let y = simulation.state_vector(&prepared.start);
    let settings = plan.settings(&simulation);
    let stops = prepared.mechanism.system().stop_times();
    let refused = |error| CliError::usage("the integration cannot begin").with_source(error);
    let integration = Integration::new(simulation, plan.method(), 0.0, &y, settings).map_err(refused)?;
    let mut integration = integration
        .with_stops(&stops)
        .map_err(|error| CliError::usage("the integration cannot begin").with_source(error))?;
    let mut record = Record::default();
    let begun = Instant::now();
    let ended = run_watched(
        &mut integration,
        grid.0,
        grid.1,
        |o| {
            record.push(o);
            observe(o)
        },
        watch,
    );
    let outcome = Outcome {
        statistics: integration.statistics(),
        counters: integration.problem().counters(),
        worst: integration.problem().worst(),
        wall: begun.elapsed(),
        rows: 0,
        failure: ended.as_ref().err().map(ToString::to_string),
    };
    Ok((record, outcome, ended))
}

/// Whether the user asked to stop.
fn flow(interrupt: &Interrupt) -> ControlFlow<()> {
    if interrupt.requested() {
        ControlFlow::Break(())
    } else {
        ControlFlow::Continue(())
    }
}

/// The other variant of the scene, friction on or off, as far as it runs over the time of `record`; it is there for
/// comparison only, and so none of its failures is one of the run.
fn compare(
    args: &RunArgs,
    plan: &Plan,
    grid: (f64, f64),
    variant: &Variant,
    record: &Record,
    interrupt: &Interrupt,
) -> Option<Record> {
    let friction = !variant.friction;
    let prepared = prepare(args, &Variant { friction, ..*variant }).ok()?;
    let reached = (*record.t.last()?, grid.1);
    let go_on = |_: &Observation| ControlFlow::Continue(());
    let (other, ..) = simulate(&prepared, plan, reached, go_on, |_| flow(interrupt)).ok()?;
    Some(other)
}

/// Draws the run together with the other variant of the scene.
fn draw(
    prepared: &Prepared,
    variant: &Variant,
    record: &Record,
    other: Option<&Record>,
    folder: &mut RunFolder,
) -> Result<(), CliError> {
    let names = Names {
        title: &prepared.scene.name.to_uppercase(),
        coordinates: prepared.mechanism.coordinate_names().collect(),
        joints: prepared.mechanism.joint_names().collect(),
    };
    let curve = |friction: bool, record| {
        let (label, style) = if friction {
            ("joint friction", 1)
        } else {
            ("ideal joints", 0)
        };
        Curve { label, style, record }
    };
    let mut curves = vec![curve(variant.friction, record)];
    curves.extend(other.map(|other| curve(!variant.friction, other)));
    curves.sort_by_key(|curve| curve.style);
    pictures::draw(folder, &names, &curves)
}

/// The times on which steps ended because a load has a kink there.
fn write_stops(folder: &mut RunFolder, mechanism: &Mechanism, end: f64) -> Result<(), CliError> {
    let mut events = folder.events("events.csv")?;
    for time in mechanism
        .system()
        .stop_times()
        .into_iter()
        .filter(|&t| t > 0.0 && t <= end)
    {
        events.event(time, "stop", "drive", None)?;
    }
    events.finish()?;
    Ok(())
}

fn default_folder(scene: &Scene, variant: &Variant) -> PathBuf {
    let name = if variant.friction {
        format!("{}-friction", scene.name)
    } else {
        scene.name.clone()
    };
    PathBuf::from("out").join(name)
}

/// A path as the user would write it: relative where it lies below the working directory.
fn shown(path: &std::path::Path) -> String {
    let here = std::env::current_dir().ok();
    let short = here.and_then(|here| path.strip_prefix(&here).ok());
    short.unwrap_or(path).display().to_string()
}

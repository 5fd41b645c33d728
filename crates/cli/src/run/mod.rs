//! `linkdyn run`: simulate a scene, write its results, draw them, say what happened.

pub mod methods;
pub mod pictures;
pub mod record;
pub mod report;

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use linkdyn_mechanisms::analysis::equilibrium::{Settings, settled};
use linkdyn_mechanisms::dynamics::{Formulation, ReactionSolver};
use linkdyn_mechanisms::integrators::Integration;
use linkdyn_mechanisms::{MOST_ROWS, Mechanism, RunError, Scene, Seen, Simulation, State, run_watched};

use crate::args::{BristleArg, ClearanceArg, FormulationArg, RunArgs};
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
pub(crate) struct Prepared {
    pub scene: Scene,
    pub mechanism: Mechanism,
    pub start: State,
}

/// `linkdyn run`.
///
/// # Errors
/// Wrong usage, a scene that cannot start, a run that ends early (its rows are written), a folder that cannot be written.
pub fn run(args: &RunArgs) -> Result<(), CliError> {
    let variant = Variant::new(&args.variant, args.as_published);
    let prepared = prepare_run(args, &variant)?;
    let plan = Plan::new(args, &prepared)?;
    let until = args.until.unwrap_or(prepared.scene.until);
    let every = args.every.or(prepared.scene.settings.every);
    let grid = (until, every.unwrap_or(until / ROWS));
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
        .unwrap_or_else(|| default_folder(&args.scene, &variant));

    let mut folder = RunFolder::create(&target)?;
    let interrupt = Interrupt::install()?;
    let simulation = Simulation::new(&prepared.mechanism);
    let columns = simulation.columns(prepared.scene.reactions);
    let mut table = folder.table("states.csv", &columns)?;
    let mut events = folder.events("events.csv")?;
    let mut stops = prepared.mechanism.system().stop_times();
    stops.retain(|&t| t > 0.0);
    let mut stops = stops.into_iter().peekable();
    let contact_names: Vec<String> = prepared.mechanism.contact_names().collect();
    let mut progress = Progress::new(&prepared.scene.name, 0.0, until, args.quiet || args.json);
    let mut row = Vec::new();
    let mut write_error = None;
    let (record, mut outcome, ended) = simulate(&prepared, &plan, grid, |seen| {
        let written = match seen {
            Seen::Row(o) => {
                o.write(prepared.scene.reactions, &mut row);
                table.row(&row)
            }
            Seen::Contact { t, event } => {
                let kind = if event.made { "contact_made" } else { "contact_lost" };
                let name = contact_names.get(event.point).map_or("", String::as_str);
                events.event(*t, kind, name, Some(event.speed))
            }
            Seen::Step { t, .. } => {
                progress.set(*t);
                match stops.next_if(|stop| stop <= t) {
                    Some(stop) => events.event(stop, "stop", "drive", None),
                    None => Ok(()),
                }
            }
        };
        if let Err(error) = written {
            write_error = Some(error);
            return ControlFlow::Break(());
        }
        flow(&interrupt)
    })?;
    drop(progress);
    if let Some(error) = write_error {
        return Err(error.into());
    }
    outcome.rows = table.finish()?;
    events.finish()?;
    let others = compare(args, &plan, grid, &variant, &record, &interrupt);
    draw(&prepared, &args.scene, &variant, &record, &others, &mut folder)?;

    outcome.lost = record.energy_lost();
    let summary = report::summary(&prepared.scene, &prepared.mechanism, &record, &outcome);
    let manifest = report::manifest(&prepared.scene, &plan, grid, &columns, &summary, &outcome);
    let placed = folder.commit(&manifest)?;
    if args.json {
        output::print(&format!("{manifest:#}\n"))?;
    } else {
        output::print(&format!("{}\nresults in {}\n", summary.to_text(), shown(&placed)))?;
    }
    match ended {
        Ok(()) => outcome.lost.map_or(Ok(()), |message| {
            let hint = "a singular position where branches meet, or steps too long; try other methods, tolerances or a fixed step";
            Err(CliError::failed(message).with_hint(hint))
        }),
        Err(RunError::Stopped { time }) => Err(CliError::interrupted(format!(
            "stopped at t = {time} s; the rows up to there are written"
        ))),
        Err(error) => Err(CliError::failed("the run ended early; the rows up to there are written").with_source(error)),
    }
}

/// Builds the scene with what the command line switched, and closes its loops. `sweeps` asks for the friction loop by that many sweeps
/// in place of solving it.
pub(crate) fn prepare(
    name: &str,
    variant: &Variant,
    sweeps: Option<usize>,
    formulation: FormulationArg,
) -> Result<Prepared, CliError> {
    let mut scene = scenes::find(name)?.scene(variant)?;
    if let Some(sweeps) = sweeps {
        scene.linkage.reaction_solver = ReactionSolver::Sweeps { sweeps };
    }
    if formulation == FormulationArg::Lagrange {
        scene.linkage.formulation = Formulation::Lagrange;
    }
    ready(scene)
}

/// The same for a run, from equilibrium where that is asked for.
fn prepare_run(args: &RunArgs, variant: &Variant) -> Result<Prepared, CliError> {
    let mut prepared = prepare(&args.scene, variant, args.friction_sweeps, args.formulation)?;
    let Some(held) = &args.equilibrium else {
        return Ok(prepared);
    };
    let settings = Settings {
        held: match held.as_str() {
            "" => vec![prepared.scene.crank.clone()],
            "none" => Vec::new(),
            names => names.split(',').map(|name| name.trim().to_owned()).collect(),
        },
        ..Settings::default()
    };
    let found = settled(&prepared.mechanism, &prepared.scene.start, &settings);
    prepared.start = found.map_err(|error| {
        CliError::failed(format!("scene `{}` has no equilibrium to start from", args.scene)).with_source(error)
    })?;
    // The manifest tells the scene as it is run.
    let names = prepared.mechanism.coordinate_names().map(str::to_owned);
    prepared.scene.start.positions = names.zip(prepared.start.q.iter().copied()).collect();
    Ok(prepared)
}

/// Builds a scene and closes its loops.
pub(crate) fn ready(scene: Scene) -> Result<Prepared, CliError> {
    let wrong = |what: &str| CliError::usage(format!("scene `{}` {what}", scene.name));
    let mechanism = scene
        .linkage
        .build()
        .map_err(|error| wrong("cannot be built").with_source(error))?;
    let (start, _) = mechanism.assemble(&scene.start).map_err(|error| {
        let cut = error.closure().and_then(|closure| mechanism.loop_names().nth(closure));
        let wrong = wrong("cannot start").with_source(error);
        match cut {
            Some(cut) => wrong.with_hint(format!("that closure is the cut joint `{cut}`")),
            None => wrong,
        }
    })?;
    Ok(Prepared {
        scene,
        mechanism,
        start,
    })
}

/// Runs a scene; `watch` sees all there is to see. The inner result tells why the run ended early, if it did.
fn simulate(
    prepared: &Prepared,
    plan: &Plan,
    grid: (f64, f64),
    mut watch: impl FnMut(&Seen<'_>) -> ControlFlow<()>,
) -> Result<(Record, Outcome, Result<(), RunError>), CliError> {
    let mut simulation = Simulation::new(&prepared.mechanism);
    plan.set_up(&mut simulation);
    let y = simulation.state_vector(&prepared.start);
    let settings = plan.settings(&simulation);
    let stops = prepared.mechanism.system().stop_times();
    let refused = |error| CliError::usage("the integration cannot begin").with_source(error);
    let integration = Integration::new(simulation, plan.method(), 0.0, &y, settings).map_err(refused)?;
    let mut integration = integration
        .with_stops(&stops)
        .map_err(|error| CliError::usage("the integration cannot begin").with_source(error))?;
    let mut record = Record::new(&prepared.mechanism);
    let begun = Instant::now();
    let ended = run_watched(&mut integration, grid.0, grid.1, |mut seen| {
        record.see(&mut seen, grid.1);
        watch(&seen)
    });
    let outcome = Outcome {
        statistics: integration.statistics(),
        counters: integration.problem().counters(),
        worst: integration.problem().worst(),
        wall: begun.elapsed(),
        rows: 0,
        failure: ended.as_ref().err().map(ToString::to_string),
        lost: None,
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

/// Other variants of the scene, as far as they run over the time of `record`; they are there for comparison only, and so none
/// of their failures is one of the run.
fn compare(
    args: &RunArgs,
    plan: &Plan,
    grid: (f64, f64),
    variant: &Variant,
    record: &Record,
    interrupt: &Interrupt,
) -> Vec<(Variant, Record)> {
    let (Ok(entry), Some(&reached)) = (scenes::find(&args.scene), record.t.last()) else {
        return Vec::new();
    };
    let others = entry.beside(variant).into_iter().filter_map(|other| {
        let prepared = prepare_run(args, &other).ok()?;
        let (record, ..) = simulate(&prepared, plan, (reached, grid.1), |_| flow(interrupt)).ok()?;
        Some((other, record))
    });
    others.collect()
}

/// Draws the run together with others.
fn draw(
    prepared: &Prepared,
    scene: &str,
    variant: &Variant,
    record: &Record,
    others: &[(Variant, Record)],
    folder: &mut RunFolder,
) -> Result<(), CliError> {
    let entry = scenes::find(scene)?;
    let names = Names {
        title: &prepared.scene.name.to_uppercase(),
        coordinates: prepared.mechanism.coordinate_names().collect(),
        joints: prepared.mechanism.joint_names().collect(),
        contacts: prepared.mechanism.contact_names().collect(),
        output: prepared.scene.output.as_deref(),
        reactions: prepared.scene.reactions,
        clearances: prepared.mechanism.clearances().collect(),
    };
    let all = others.iter().map(|(variant, record)| (variant, record));
    let all = all.chain([(variant, record)]);
    let mut curves: Vec<Curve<'_>> = all
        .map(|(variant, record)| Curve {
            label: entry.label(variant),
            style: 0,
            record,
        })
        .collect();
    // The same variant has the same style in every picture, whichever was run: the simplest comes first.
    curves.sort_by_key(|curve| curve.label.clone());
    curves.sort_by_key(|curve| (curve.record.contacts.len(), curve.label.len()));
    for (style, curve) in curves.iter_mut().enumerate() {
        curve.style = style;
    }
    pictures::draw(folder, &names, &curves)
}

/// Where results go if nothing is said.
pub(crate) fn default_folder(scene: &str, variant: &Variant) -> PathBuf {
    let mut name = scenes::stem(scene).to_owned();
    for (given, part) in [
        (variant.friction == Some(true), "friction".to_owned()),
        (variant.clearance == Some(ClearanceArg::Planar), "planar".to_owned()),
        (variant.clearance == Some(ClearanceArg::Spatial), "spatial".to_owned()),
        (
            variant.flexible.is_some(),
            format!("flexible{}", variant.flexible.unwrap_or_default()),
        ),
        (variant.friction == Some(false), "no-friction".to_owned()),
        (
            variant.friction_scale.is_some(),
            format!("scale{}", variant.friction_scale.unwrap_or_default()),
        ),
        (
            variant.clearance_size.is_some(),
            format!("size{}", variant.clearance_size.unwrap_or_default()),
        ),
        (
            variant.bristle.is_some(),
            variant.bristle.map(BristleArg::name).unwrap_or_default(),
        ),
        (variant.as_published, "as-published".to_owned()),
    ] {
        if given {
            name = format!("{name}-{part}");
        }
    }
    PathBuf::from("out").join(name)
}

/// A path as the user would write it: relative where it lies below the working directory.
pub(crate) fn shown(path: &std::path::Path) -> String {
    let here = std::env::current_dir().ok();
    let short = here.and_then(|here| path.strip_prefix(&here).ok());
    short.unwrap_or(path).display().to_string()
}

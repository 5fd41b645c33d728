//! `linkdyn report`: which method gives which error of a scene for which work, against a reference that two methods agree on.

mod bench;
mod cache;
mod candidates;
mod curve;
mod figures;
pub(crate) mod measure;
mod page;
mod pictures;
mod reference;
mod tables;

use std::path::PathBuf;

use serde_json::{Value, json};

use crate::args::{ClearanceArg, FormulationArg, ReportArgs};
use crate::errors::CliError;
use crate::interrupt::Interrupt;
use crate::machine::{Machine, Program};
use crate::output;
use crate::progress::Progress;
use crate::results::RunFolder;
use crate::run::methods::Plan;
use crate::run::{default_folder, prepare, shown};
use crate::scenes::{self, Variant};

use bench::{Bench, Certified, Origin};
use cache::Cache;
use candidates::{papers_way, references};
use figures::Row;
use measure::Limit;
use reference::Reference;

/// Output times of each run after the first; errors are the largest over them.
const ROWS: f64 = 200.0;
/// Time on the clock that a scene may take where none is given \[s\].
const BUDGET: f64 = 120.0;

/// All that is found about a scene.
struct Report {
    /// End of the runs that was asked for \[s\].
    until: f64,
    /// Time on the clock that was allowed \[s\].
    budget: f64,
    /// The two methods of the reference.
    plans: [Plan; 2],
    /// What they agree on.
    reference: Reference,
    /// Why that ends before the time asked for, if it does.
    early: Option<String>,
    /// Whether that was a failure.
    failed: bool,
    /// Where the reference is from.
    origin: Origin,
    /// Length to which disagreement is compared \[m, rad\].
    scale: f64,
    /// Smallest radial clearance \[m\], if there is any.
    clearance: Option<f64>,
    /// All rows, by method.
    rows: Vec<Row>,
}

/// A scene with what came of its report.
struct Section {
    /// Name of the scene.
    scene: String,
    /// What the variant is called.
    label: String,
    /// Beginning of the names of its pictures.
    prefix: String,
    /// The report, or why there is none.
    outcome: Result<Report, CliError>,
}

impl Section {
    /// Scene and variant.
    fn title(&self) -> String {
        format!("{}: {}", self.scene.to_uppercase(), self.label)
    }
}

/// The scenes of `--all` with their main variants.
fn all() -> Vec<(&'static str, Variant)> {
    let ideal = Variant::default();
    let friction = Some(true);
    let clearance = Some(ClearanceArg::Planar);
    let flexible = Some(4);
    vec![
        ("rsrrr", ideal),
        ("rsrrr", Variant { friction, ..ideal }),
        ("rsup", ideal),
        ("rsup", Variant { clearance, ..ideal }),
        ("rsup", Variant { flexible, ..ideal }),
        (
            "rsup",
            Variant {
                clearance,
                flexible,
                ..ideal
            },
        ),
    ]
}

/// `linkdyn report`.
///
/// # Errors
/// Wrong usage, a scene that cannot start, a reference that ends early (what was measured is written), that two methods do not
/// agree on, a folder that cannot be written.
pub fn report(args: &ReportArgs) -> Result<(), CliError> {
    let asked = match &args.scene {
        Some(scene) => vec![(scene.as_str(), Variant::new(&args.variant, false))],
        None => all(),
    };
    // What is wrong with the command line is told before anything is measured.
    for (scene, variant) in &asked {
        prepare(scene, variant, None, FormulationArg::Recursive)?;
    }
    let target = args.out.clone().unwrap_or_else(|| match asked[..] {
        [(scene, variant)] => {
            let folder = default_folder(scene, &variant);
            let name = folder.file_name().unwrap_or_default().to_string_lossy();
            folder.with_file_name(format!("report-{name}"))
        }
        _ => PathBuf::from("out").join("report-all"),
    });
    let folder = RunFolder::create(&target)?;
    let interrupt = Interrupt::install()?;
    let whole = Limit::new(args.budget.unwrap_or(BUDGET * asked.len() as f64), interrupt.clone());
    let mut sections = Vec::new();
    for (i, (scene, variant)) in asked.iter().enumerate() {
        let budget = whole.left() / (asked.len() - i) as f64;
        let outcome = if whole.interrupted() {
            Err(CliError::interrupted("stopped before its turn"))
        } else {
            examine(args, scene, variant, budget, interrupt.clone())
        };
        let name = default_folder(scene, variant);
        let name = name.file_name().unwrap_or_default().to_string_lossy();
        sections.push(Section {
            scene: (*scene).to_owned(),
            label: scenes::find(scene)?.label(variant),
            prefix: if asked.len() > 1 {
                format!("{name}-")
            } else {
                String::new()
            },
            outcome,
        });
    }
    if sections.iter().all(|section| section.outcome.is_err()) {
        // There is nothing to write.
        return sections.pop().map_or(Ok(()), |section| section.outcome.map(|_| ()));
    }
    write(&sections, folder, args.json)?;
    end(&sections, interrupt.requested())
}

/// Measures one scene within `budget` \[s\].
fn examine(
    args: &ReportArgs,
    scene: &str,
    variant: &Variant,
    budget: f64,
    interrupt: Interrupt,
) -> Result<Report, CliError> {
    let ready = prepare(scene, variant, None, FormulationArg::Recursive)?;
    let papers = papers_way(scene, variant);
    let papers_ready = prepare(scene, &papers.variant, papers.sweeps, FormulationArg::Recursive)?;
    let until = args.until.unwrap_or(ready.scene.until);
    let label = format!("report {scene}, {}", scenes::find(scene)?.label(variant));
    let mut bench = Bench {
        progress: Progress::new(&label, 0.0, budget, args.quiet || args.json),
        grid: (until, until / ROWS),
        budget,
        limit: Limit::new(budget, interrupt),
    };
    let plans = references(variant);
    let clearance = ready.mechanism.clearances().flatten().reduce(f64::min);
    let scale = clearance.unwrap_or(1.0).min(1.0);
    let folder = cache::folder(args.cache.as_deref()).filter(|_| !args.no_cache);
    let cache = folder.and_then(|folder| Cache::new(&folder, &ready, &plans, bench.grid));
    let certified = bench.reference(&ready, &plans, scale, cache.as_ref())?;
    let rows = bench.rows([&ready, &papers_ready], papers, variant, &certified);
    let Certified {
        reference,
        early,
        failed,
        origin,
        ..
    } = certified;
    Ok(Report {
        until,
        budget,
        plans,
        reference,
        early,
        failed,
        origin,
        scale,
        clearance,
        rows,
    })
}

/// Writes tables, pictures and the page, puts the folder in place and prints.
fn write(sections: &[Section], mut folder: RunFolder, json: bool) -> Result<(), CliError> {
    let whole = whole(sections);
    folder.write("report.json", format!("{whole:#}\n"))?;
    folder.write("report.csv", tables::csv(sections))?;
    let mut drawn = Vec::new();
    for section in sections {
        drawn.push(pictures::draw(section, &mut folder)?);
    }
    folder.write("report.html", page::page(sections, &drawn))?;
    let names: Vec<Value> = sections
        .iter()
        .map(|section| json!({ "scene": section.scene, "variant": section.label }))
        .collect();
    let placed = folder.commit(&json!({ "kind": "report", "scenes": names }))?;
    if json {
        return output::print(&format!("{whole:#}\n"));
    }
    let texts: Vec<String> = sections.iter().map(tables::text).collect();
    output::print(&format!("{}\nreport in {}\n", texts.join("\n\n"), shown(&placed)))
}

/// All sections as JSON: one as it is, several in a list.
fn whole(sections: &[Section]) -> Value {
    let mut entries: Vec<Value> = sections.iter().map(tables::json).collect();
    let mut whole = match entries.len() {
        1 => entries.remove(0),
        _ => json!({ "scenes": entries }),
    };
    whole["machine"] = json!(Machine::this());
    whole["program"] = json!(Program::this());
    whole
}

/// How the program ends when all is written.
fn end(sections: &[Section], interrupted: bool) -> Result<(), CliError> {
    if interrupted {
        return Err(CliError::interrupted(
            "stopped; what was measured up to then is written",
        ));
    }
    let why = |section: &Section| match &section.outcome {
        Err(error) => Some(format!("{}: {error}", section.title())),
        Ok(report) if report.failed => report.early.as_ref().map(|why| format!("{}: {why}", section.title())),
        Ok(_) => None,
    };
    let failures: Vec<String> = sections.iter().filter_map(why).collect();
    if failures.is_empty() {
        return Ok(());
    }
    let message = format!("{}; what was measured is written", failures.join("; "));
    Err(CliError::failed(message).with_hint("give an earlier `--until`"))
}

//! `linkdyn report`: which method gives which error of a scene for which work, against a reference that two methods agree on.

mod candidates;
mod figures;
pub(crate) mod measure;
mod pictures;
mod reference;
mod tables;

use crate::args::{FormulationArg, ReportArgs};
use crate::errors::CliError;
use crate::interrupt::Interrupt;
use crate::output;
use crate::progress::Progress;
use crate::results::RunFolder;
use crate::run::methods::Plan;
use crate::run::{Prepared, default_folder, prepare, shown};
use crate::scenes::{self, Variant};

use candidates::{Candidate, Experience, Papers, candidates, papers_way, references};
use figures::{Figures, Outcome, Row};
use measure::{Halt, Limit, Measured, measure};
use reference::Reference;

/// Output times of each run after the first; errors are the largest over them.
const ROWS: f64 = 200.0;
/// A row that takes more than this share of the budget is run once only.
const DEAR: f64 = 1.0 / 40.0;
/// Most timed repeats of a row, and the share of the budget after which no further one begins.
const REPEATS: usize = 9;
const REPEAT_TIME: f64 = 1.0 / 400.0;

/// All that is found about a scene.
struct Report {
    /// Name of the scene.
    scene: String,
    /// What the variant is called.
    label: String,
    /// End of the runs \[s\].
    until: f64,
    /// Time on the clock that was allowed \[s\].
    budget: f64,
    /// The two methods of the reference.
    plans: [Plan; 2],
    /// What they agree on.
    reference: Reference,
    /// Length to which disagreement is compared \[m, rad\].
    scale: f64,
    /// All rows, by method.
    rows: Vec<Row>,
}

/// `linkdyn report`.
///
/// # Errors
/// Wrong usage, a scene that cannot start, a reference that ends early, that two methods do not agree on or that takes longer than
/// the budget, a folder that cannot be written.
pub fn report(args: &ReportArgs) -> Result<(), CliError> {
    let variant = Variant::new(&args.variant, false);
    let ready = prepare(&args.scene, &variant, None, FormulationArg::Recursive)?;
    let papers = papers_way(&args.scene, &variant);
    let papers_ready = prepare(&args.scene, &papers.variant, papers.sweeps, FormulationArg::Recursive)?;
    let until = args.until.unwrap_or(ready.scene.until);
    let target = args.out.clone().unwrap_or_else(|| {
        let folder = default_folder(&args.scene, &variant);
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        folder.with_file_name(format!("report-{name}"))
    });
    let folder = RunFolder::create(&target)?;
    let limit = Limit::new(args.budget, Interrupt::install()?);
    let mut bench = Bench {
        progress: Progress::new("report", 0.0, args.budget, args.quiet || args.json),
        grid: (until, until / ROWS),
        budget: args.budget,
        limit,
    };
    let plans = references(&variant);
    let scale = ready.mechanism.clearances().fold(1.0, f64::min);
    let (reference, evaluation) = bench.reference(&ready, &plans, scale)?;
    let rows = bench.rows(&ready, &papers_ready, papers, &variant, (&reference, evaluation));
    let interrupted = bench.limit.interrupted();
    drop(bench);
    let report = Report {
        scene: args.scene.clone(),
        label: scenes::find(&args.scene)?.label(&variant),
        until,
        budget: args.budget,
        plans,
        reference,
        scale,
        rows,
    };
    write(&report, folder, args.json)?;
    match interrupted {
        true => Err(CliError::interrupted(
            "stopped; what was measured up to then is written",
        )),
        false => Ok(()),
    }
}

/// Writes tables and pictures, puts the folder in place and prints.
fn write(report: &Report, mut folder: RunFolder, json: bool) -> Result<(), CliError> {
    let whole = tables::json(report);
    folder.write("report.json", format!("{whole:#}\n"))?;
    folder.write("report.csv", tables::csv(report))?;
    pictures::draw(report, &mut folder)?;
    let manifest = serde_json::json!({ "kind": "report", "scene": report.scene, "variant": report.label });
    let placed = folder.commit(&manifest)?;
    match json {
        true => output::print(&format!("{whole:#}\n")),
        false => output::print(&format!("{}\nreport in {}\n", tables::text(report), shown(&placed))),
    }
}

/// Where runs are measured.
struct Bench {
    progress: Progress,
    limit: Limit,
    /// End of the runs and time between outputs \[s\].
    grid: (f64, f64),
    budget: f64,
}

impl Bench {
    /// A run that may take this share of the time that is left.
    fn measure(&mut self, ready: &Prepared, plan: &Plan, every: f64, share: f64) -> Result<Measured, Halt> {
        let (limit, progress, budget) = (&self.limit, &mut self.progress, self.budget);
        measure(ready, plan, (self.grid.0, every), &limit.part(share), || {
            progress.set(budget - limit.left());
        })
    }

    /// The reference, and the time that one evaluation takes \[s\].
    fn reference(&mut self, ready: &Prepared, plans: &[Plan; 2], scale: f64) -> Result<(Reference, f64), CliError> {
        let mut runs = Vec::new();
        for plan in plans {
            let run = self.measure(ready, plan, self.grid.1, 1.0).map_err(|halt| match halt {
                Halt::OutOfTime if self.limit.interrupted() => {
                    CliError::interrupted("stopped before there was a reference; nothing is written")
                }
                Halt::OutOfTime => {
                    let message = format!("the reference by {} takes longer than the budget", plan.method);
                    CliError::failed(message).with_hint("give a larger `--budget` or an earlier `--until`")
                }
                Halt::Failed(why) => {
                    let message = format!("the reference by {} ended early: {why}", plan.method);
                    CliError::failed(message).with_hint("give an earlier `--until`")
                }
            })?;
            runs.push(run);
        }
        let evaluations: u64 = runs.iter().map(|run| run.statistics.evaluations).sum();
        let seconds: f64 = runs.iter().map(|run| run.wall).sum();
        let second = runs.pop().map(|run| run.path).unwrap_or_default();
        let first = runs.pop().map(|run| run.path).unwrap_or_default();
        let reference = Reference::new(first, &second, scale).ok_or_else(|| {
            let message = format!("{} and {} do not agree on any time", plans[0].method, plans[1].method);
            CliError::failed(message).with_hint("give an earlier `--until`")
        })?;
        Ok((reference, seconds / evaluations.max(1) as f64))
    }

    /// All rows, as far as time allows.
    fn rows(
        &mut self,
        ready: &Prepared,
        papers_ready: &Prepared,
        papers: Papers,
        variant: &Variant,
        (reference, evaluation): (&Reference, f64),
    ) -> Vec<Row> {
        let mut waiting = candidates(variant);
        waiting.push(papers.candidate);
        let order = waiting.clone();
        let mut experience = Experience {
            until: self.grid.0,
            evaluation,
            runs: Vec::new(),
        };
        let mut rows = Vec::new();
        while let Some(next) = experience.next(&waiting) {
            let candidate = waiting.remove(next);
            let (predicted, left) = (experience.predict(&candidate), candidate.share() * self.limit.left());
            let ready = if candidate.papers { papers_ready } else { ready };
            let outcome = if predicted < left {
                self.row(ready, &candidate, reference, &mut experience)
            } else {
                Outcome::NotRun
            };
            rows.push(Row { candidate, outcome });
        }
        rows.sort_by_key(|row| order.iter().position(|candidate| *candidate == row.candidate));
        rows
    }

    /// One row: a run with output for the errors, and repeats without for the costs.
    fn row(
        &mut self,
        ready: &Prepared,
        candidate: &Candidate,
        reference: &Reference,
        experience: &mut Experience,
    ) -> Outcome {
        let plan = &candidate.plan;
        let share = candidate.share();
        let run = match self.measure(ready, plan, self.grid.1, share) {
            Ok(run) => run,
            Err(Halt::OutOfTime) => return Outcome::NotRun,
            Err(Halt::Failed(why)) => return Outcome::Failed(why),
        };
        let Some(errors) = reference.errors(&run.path) else {
            return Outcome::Failed("it has no row at the horizon".to_owned());
        };
        experience.runs.push((plan.method.clone(), run.wall));
        let mut figures = Figures::new(&run, errors);
        let mut spent = 0.0;
        while run.wall < DEAR * self.budget
            && figures.repeats < REPEATS
            && (figures.repeats == 0 || spent < REPEAT_TIME * self.budget)
        {
            let Ok(timed) = self.measure(ready, plan, self.grid.0, share) else {
                break;
            };
            spent += timed.wall;
            figures.repeat(&timed);
        }
        Outcome::Done(Box::new(figures))
    }
}

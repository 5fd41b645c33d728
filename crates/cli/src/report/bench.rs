//! Where the runs of a report are made: the reference first, then rows as far as time allows.

use crate::errors::CliError;
use crate::progress::Progress;
use crate::run::Prepared;
use crate::run::methods::Plan;
use crate::scenes::Variant;

use super::cache::{Cache, Found, Pair};
use super::candidates::{Candidate, Experience, Papers, Way, candidates};
use super::figures::{Figures, Outcome, Row};
use super::measure::{Halt, Limit, Measured, measure};
use super::reference::Reference;

/// A row that takes more than this share of the budget is run once only.
const DEAR: f64 = 1.0 / 40.0;
/// Most timed repeats of a row, and the share of the budget after which no further one begins.
const REPEATS: usize = 9;
const REPEAT_TIME: f64 = 1.0 / 400.0;
/// Share of the time left that each of the two integrations of a reference may take; what it does not reach by then is not reported.
const REFERENCE_SHARE: f64 = 0.4;

/// A scene's runs.
pub struct Bench {
    /// What is shown of them.
    pub progress: Progress,
    /// Until when they may go on.
    pub limit: Limit,
    /// End of the runs and time between outputs \[s\].
    pub grid: (f64, f64),
    /// All the time that the scene has \[s\].
    pub budget: f64,
}

/// Where a reference is from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Whether it was found on disk.
    pub cached: bool,
    /// What went wrong with the file, or why there is none.
    pub note: Option<String>,
}

/// A reference and what came with it.
pub struct Certified {
    /// The reference.
    pub reference: Reference,
    /// Time of one evaluation \[s\].
    pub evaluation: f64,
    /// Why it ends before the time asked for, if it does.
    pub early: Option<String>,
    /// Whether the mechanics or a method ended it, and not the budget.
    pub failed: bool,
    /// Where it is from.
    pub origin: Origin,
}

impl Bench {
    /// A run that may take this share of the time that is left.
    fn measure(&mut self, ready: &Prepared, plan: &Plan, every: f64, share: f64) -> Measured {
        let (limit, progress, budget) = (&self.limit, &mut self.progress, self.budget);
        measure(ready, plan, (self.grid.0, every), &limit.part(share), || {
            progress.set(budget - limit.left());
        })
    }

    /// The reference, from the cache where it has it.
    ///
    /// # Errors
    /// A stop by the user, and two methods that do not agree on any time, or that do not come to one.
    pub fn reference(
        &mut self,
        ready: &Prepared,
        plans: &[Plan; 2],
        scale: f64,
        cache: Option<&Cache>,
    ) -> Result<Certified, CliError> {
        let mut origin = Origin {
            cached: false,
            note: None,
        };
        let found = cache.map_or(Found::Nothing, Cache::read);
        let (pair, out_of_time) = match found {
            Found::Pair(pair) => {
                origin.cached = true;
                (*pair, None)
            }
            found => {
                if let (Found::Unusable(why), Some(cache)) = (found, cache) {
                    let name = cache.file().file_name().unwrap_or_default().to_string_lossy();
                    origin.note = Some(format!("{name} in the cache is not used: {why}"));
                }
                let computed = self.compute(ready, plans)?;
                if let (Some(cache), None) = (cache, &computed.1)
                    && let Err(error) = cache.write(&computed.0)
                {
                    origin.note = Some(format!("the reference cannot be kept in the cache: {error}"));
                }
                computed
            }
        };
        let Pair {
            paths: [first, second],
            evaluation,
            failure,
        } = pair;
        let early = failure.clone().or(out_of_time);
        let Some(reference) = Reference::new(first, &second, scale) else {
            let message = match &early {
                Some(why) => format!("there is no reference: {why}"),
                None => format!("{} and {} do not agree on any time", plans[0].method, plans[1].method),
            };
            return Err(CliError::failed(message).with_hint("give a larger `--budget` or an earlier `--until`"));
        };
        Ok(Certified {
            reference,
            evaluation,
            early,
            failed: failure.is_some(),
            origin,
        })
    }

    /// Both integrations, as far as they come, and whether time ended one of them.
    fn compute(&mut self, ready: &Prepared, plans: &[Plan; 2]) -> Result<(Pair, Option<String>), CliError> {
        let (mut failure, mut out_of_time) = (None, None);
        let runs = plans.each_ref().map(|plan| {
            let run = self.measure(ready, plan, self.grid.1, REFERENCE_SHARE);
            let reached = run.path.last().map_or(0.0, |point| point.t);
            match &run.halt {
                None => {}
                Some(Halt::OutOfTime) => {
                    let text = format!(
                        "{} comes to {reached:.4} s only within its part of the budget",
                        plan.method
                    );
                    out_of_time.get_or_insert(text);
                }
                Some(Halt::Failed(why)) => {
                    failure.get_or_insert(format!("{} ended early: {why}", plan.method));
                }
            }
            run
        });
        if self.limit.interrupted() {
            return Err(CliError::interrupted("stopped before there was a reference"));
        }
        let evaluations: u64 = runs.iter().map(|run| run.statistics.evaluations).sum();
        let seconds: f64 = runs.iter().map(|run| run.wall).sum();
        let pair = Pair {
            paths: runs.map(|run| run.path),
            evaluation: seconds / evaluations.max(1) as f64,
            failure,
        };
        Ok((pair, out_of_time))
    }

    /// All rows, as far as time allows; each runs up to the reference's horizon.
    pub fn rows(
        &mut self,
        [ready, papers_ready]: [&Prepared; 2],
        papers: Papers,
        variant: &Variant,
        certified: &Certified,
    ) -> Vec<Row> {
        self.grid.0 = certified.reference.horizon;
        let mut waiting = candidates(variant);
        waiting.extend(papers.candidates);
        let order = waiting.clone();
        let mut experience = Experience {
            until: self.grid.0,
            evaluation: certified.evaluation,
            runs: Vec::new(),
        };
        let mut rows = Vec::new();
        while let Some(next) = experience.next(&waiting) {
            let candidate = waiting.remove(next);
            let (predicted, left) = (experience.predict(&candidate), candidate.share() * self.limit.left());
            let ready = match candidate.way {
                Way::Own => ready,
                Way::Papers | Way::Published => papers_ready,
            };
            let outcome = if predicted < left {
                self.row(ready, &candidate, &certified.reference, &mut experience)
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
        let run = self.measure(ready, plan, self.grid.1, share);
        experience.runs.push((candidate.clone(), run.wall));
        match run.halt {
            None => {}
            Some(Halt::OutOfTime) => return Outcome::NotRun,
            Some(Halt::Failed(why)) => return Outcome::Failed(why),
        }
        let Some(errors) = reference.errors(&run.path) else {
            return Outcome::Failed("it has no row at the horizon".to_owned());
        };
        let mut figures = Figures::new(&run, errors);
        let mut spent = 0.0;
        while run.wall < DEAR * self.budget
            && figures.repeats < REPEATS
            && (figures.repeats == 0 || spent < REPEAT_TIME * self.budget)
        {
            let timed = self.measure(ready, plan, self.grid.0, share);
            if timed.halt.is_some() {
                break;
            }
            spent += timed.wall;
            figures.repeat(&timed);
        }
        Outcome::Done(Box::new(figures))
    }
}

//! Stiffening sweeps: what each method costs, or how short its steps must be, as a scene grows stiff.

use crate::report::measure::{Halt, Limit, Measured, Point, measure};
use crate::run::Prepared;
use crate::scenes::Variant;

use super::plans::{is_fixed, methods, plan, tolerance};
use super::stiffening::Quantity;

/// Largest error for which a fixed step counts as stable: this share of the largest change of a coordinate, and of a speed.
const LOOSE: f64 = 0.05;
/// Times at which errors are looked at.
const ROWS: f64 = 50.0;
/// The longest fixed step tried, as a share of the run.
const LONGEST: f64 = 1.0 / 8.0;
/// Halvings of the step until one is stable, and of the interval then between that and the last that was not.
const HALVINGS: usize = 30;
const BISECTIONS: usize = 3;
/// A run may take this many times its even share of the time left, but not more than the part of all that is left.
const GENEROSITY: f64 = 3.0;
const MOST: f64 = 0.25;

/// One method at one factor.
pub struct Row {
    /// What was changed.
    pub quantity: Quantity,
    /// By how much.
    pub factor: f64,
    /// The method.
    pub method: &'static str,
    /// What came of it.
    pub outcome: Outcome,
}

/// What came of a row.
#[derive(Debug)]
pub enum Outcome {
    /// The run came to its end.
    Done(Work),
    /// The method or the mechanism could not go on, or no step was short enough; what and when.
    Failed(String),
    /// The run was broken off, or the search before it had found a stable step.
    OutOfTime,
    /// The method was out of time at a smaller factor already, or the budget was used up.
    NotRun,
}

/// What a run cost.
#[derive(Clone, Debug)]
pub struct Work {
    /// Steps taken.
    pub steps: u64,
    /// Steps thrown away.
    pub rejected: u64,
    /// Evaluations.
    pub evaluations: u64,
    /// Time on the clock \[s\].
    pub wall: f64,
    /// Largest stable step of a method of fixed step \[s\].
    pub step: Option<f64>,
}

impl Work {
    fn new(run: &Measured, step: Option<f64>) -> Self {
        Self {
            steps: run.statistics.accepted,
            rejected: run.statistics.rejected,
            evaluations: run.statistics.evaluations,
            wall: run.wall,
            step,
        }
    }
}

impl Outcome {
    /// The word for it.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Done(_) => "done",
            Self::Failed(_) => "failed",
            Self::OutOfTime => "out of time",
            Self::NotRun => "not run",
        }
    }

    /// Its costs, if it came to its end.
    pub fn work(&self) -> Option<&Work> {
        match self {
            Self::Done(work) => Some(work),
            _ => None,
        }
    }
}

/// All sweeps that a variant of a scene has; `seen` hears of every step.
pub fn sweeps(
    (scene, variant, prepared): (&str, &Variant, &Prepared),
    until: f64,
    limit: &Limit,
    seen: &mut dyn FnMut(),
) -> Vec<Row> {
    let quantities = Quantity::ALL.into_iter();
    let present: Vec<Quantity> = quantities
        .filter(|q| q.is_in(variant, &prepared.scene.linkage))
        .collect();
    let count = methods().count();
    let mut waiting: usize = present.iter().map(|quantity| count * quantity.factors().len()).sum();
    let mut rows: Vec<Row> = Vec::new();
    for quantity in present {
        for &factor in quantity.factors() {
            let stiff = quantity.prepare(scene, variant, factor);
            let mut path: Option<Vec<Point>> = None;
            for method in methods() {
                let share = (GENEROSITY / waiting as f64).min(MOST);
                waiting -= 1;
                let same = |row: &&Row| row.quantity == quantity && row.method == method;
                let given_up = rows
                    .iter()
                    .rev()
                    .find(same)
                    .is_some_and(|row| matches!(row.outcome, Outcome::OutOfTime | Outcome::NotRun));
                let outcome = match &stiff {
                    Err(error) => Outcome::Failed(error.to_string()),
                    Ok(_) if given_up || limit.left() <= 0.0 => Outcome::NotRun,
                    Ok(stiff) if is_fixed(method) => {
                        largest_step(stiff, method, (until, path.as_deref()), &limit.part(share), seen)
                    }
                    Ok(stiff) => {
                        let plan = plan(method, tolerance(stiff));
                        match measure(stiff, &plan, (until, until / ROWS), &limit.part(share), &mut *seen).whole() {
                            Ok(run) => {
                                let work = Work::new(&run, None);
                                path.get_or_insert(run.path);
                                Outcome::Done(work)
                            }
                            Err(Halt::OutOfTime) => Outcome::OutOfTime,
                            Err(Halt::Failed(why)) => Outcome::Failed(why),
                        }
                    }
                };
                rows.push(Row {
                    quantity,
                    factor,
                    method,
                    outcome,
                });
            }
        }
    }
    rows
}

/// The largest step with which a method of fixed step stays near `path`, found by halving and bisection.
fn largest_step(
    prepared: &Prepared,
    method: &str,
    (until, path): (f64, Option<&[Point]>),
    limit: &Limit,
    seen: &mut dyn FnMut(),
) -> Outcome {
    let Some(path) = path else {
        return Outcome::Failed("no method with error control came to the end to compare with".to_owned());
    };
    let mut attempt = |step: f64| -> Result<Work, Halt> {
        let grid = (until, until / ROWS);
        let run = measure(prepared, &plan(method, step), grid, limit, &mut *seen).whole()?;
        let error = error(&run.path, path);
        // NaN does not pass.
        match error <= LOOSE {
            true => Ok(Work::new(&run, Some(step))),
            false => Err(Halt::Failed(format!(
                "at a step of {step:e} s it is off by {:.0} % of the motion",
                100.0 * error
            ))),
        }
    };
    let mut step = LONGEST * until;
    let mut why = String::new();
    for halving in 0..HALVINGS {
        match attempt(step) {
            Ok(mut best) => {
                let (mut good, mut bad) = (step, 2.0 * step);
                let bisections = if halving == 0 { 0 } else { BISECTIONS };
                for _ in 0..bisections {
                    let middle = (good * bad).sqrt();
                    match attempt(middle) {
                        Ok(work) => (good, best) = (middle, work),
                        Err(Halt::Failed(_)) => bad = middle,
                        Err(Halt::OutOfTime) => break,
                    }
                }
                return Outcome::Done(best);
            }
            Err(Halt::OutOfTime) => return Outcome::OutOfTime,
            Err(Halt::Failed(reason)) => why = reason,
        }
        step *= 0.5;
    }
    Outcome::Failed(why)
}

/// Largest error of a path, coordinates in units of their largest change, speeds in units of theirs; NaN if a number is none, infinite if
/// the path ends early.
fn error(path: &[Point], reference: &[Point]) -> f64 {
    if path.len() != reference.len() {
        return f64::INFINITY;
    }
    let share = |pick: fn(&Point) -> &[f64]| {
        let start = reference.first().map_or(&[][..], pick);
        let change = reference
            .iter()
            .map(|point| largest(pick(point), start))
            .fold(0.0, f64::max);
        let errors = path.iter().zip(reference).map(|(a, b)| largest(pick(a), pick(b)));
        errors.fold(0.0, most) / change.max(f64::MIN_POSITIVE)
    };
    most(share(|point| &point.q), share(|point| &point.v))
}

/// Largest difference of two lists; NaN if there is one.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, most)
}

/// The larger of two numbers; NaN if one is.
fn most(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(values: &[f64]) -> Vec<Point> {
        let point = |(i, &x): (usize, &f64)| Point {
            t: i as f64,
            q: vec![5.0, 5.0 + x],
            v: vec![x],
            forces: Vec::new(),
        };
        values.iter().enumerate().map(point).collect()
    }

    #[test]
    fn errors_are_shares_of_the_motion() {
        let reference = path(&[0.0, 1e-3, 2e-3]);
        assert!((error(&path(&[0.0, 1e-3, 2.1e-3]), &reference) - 0.05).abs() < 1e-9);
        assert_eq!(error(&reference, &reference), 0.0);
        assert!(error(&path(&[0.0, f64::NAN, 2e-3]), &reference).is_nan());
        assert_eq!(error(&path(&[0.0]), &reference), f64::INFINITY);
    }
}

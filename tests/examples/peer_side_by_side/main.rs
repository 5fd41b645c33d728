//! Our integrators beside those of crate `differential-equations` on problems of the test set for IVP solvers: digits against work,
//! then work at equal digits.
//!
//! `cargo run --release -p linkdyn-tests --example peer_side_by_side [FILE.csv]`; with a file the first table goes there as well.

mod solvers;

use linkdyn_tests::standard_odes::{HIRES, PLEIADES, ROBERTSON, Standard, VAN_DER_POL};
use solvers::{EXPLICIT, STIFF, Solver, Work};
use std::time::{Duration, Instant};

/// Relative tolerances, 1e-3 to 1e-11.
const EXPONENTS: std::ops::RangeInclusive<i32> = 3..=11;
/// Digits at which work is compared.
const DIGITS: [f64; 4] = [4.0, 6.0, 8.0, 10.0];
/// Repeats of a run for its least time, fewer where it takes long.
const REPEATS: u32 = 25;
const PATIENCE: Duration = Duration::from_millis(200);

/// One run.
struct Row {
    problem: &'static str,
    method: String,
    tolerance: f64,
    digits: f64,
    work: Work,
    ms: f64,
}

fn main() -> std::io::Result<()> {
    let table: [(Standard, &[Solver]); 4] = [
        (HIRES, &STIFF),
        (VAN_DER_POL, &STIFF),
        (ROBERTSON, &STIFF),
        (PLEIADES, &EXPLICIT),
    ];
    let mut csv = "problem,method,tolerance,digits,evaluations,jacobians,factorisations,steps,ms\n".to_owned();
    println!(
        "{:<12} {:<22} {:>9} {:>7} {:>11} {:>9} {:>14} {:>7} {:>9}",
        "problem", "method", "tolerance", "digits", "evaluations", "jacobians", "factorisations", "steps", "ms"
    );
    let mut rows = Vec::new();
    for (problem, solvers) in &table {
        for tolerance in EXPONENTS.map(|exponent| f64::powi(10.0, -exponent)) {
            let runs = side_by_side(problem, solvers, tolerance);
            for (solver, run) in solvers.iter().zip(runs) {
                match run {
                    Ok(row) => {
                        println!("{}", row.aligned());
                        csv += &(row.cells().join(",") + "\n");
                        rows.push(row);
                    }
                    Err(cause) => {
                        let cause: String = cause.chars().take(60).collect();
                        let name = label(solver);
                        println!("{:<12} {name:<22} {tolerance:>9.0e} failed: {cause}", problem.name);
                    }
                }
            }
        }
    }

    println!("\nevaluations and ms, interpolated at equal digits (-: not reached)\n");
    println!(
        "{:<12} {:<22} {}",
        "problem",
        "method",
        DIGITS.map(|d| format!("{d:>19}")).join("")
    );
    for (problem, solvers) in &table {
        for solver in *solvers {
            let name = label(solver);
            let runs: Vec<&Row> = rows
                .iter()
                .filter(|row| row.problem == problem.name && row.method == name)
                .collect();
            let cells = DIGITS.map(|digits| match at_digits(&runs, digits) {
                Some((evaluations, ms)) => format!("{evaluations:>10.0} {ms:>8.3}"),
                None => format!("{:>19}", "-"),
            });
            println!("{:<12} {name:<22} {}", problem.name, cells.join(""));
        }
    }
    match std::env::args().nth(1) {
        Some(file) => std::fs::write(file, csv),
        None => Ok(()),
    }
}

fn label(solver: &Solver) -> String {
    format!("{}{}", if solver.ours { "" } else { "peer " }, solver.name)
}

/// One run of each solver, with the least time of some repeats; they take turns, so that all meet the machine in the same moods.
fn side_by_side(problem: &Standard, solvers: &[Solver], tolerance: f64) -> Vec<Result<Row, String>> {
    let run = |solver: &Solver| {
        let begin = Instant::now();
        let work = (solver.solve)(problem, tolerance)?;
        Ok(Row {
            problem: problem.name,
            method: label(solver),
            tolerance,
            digits: problem.digits(&work.y),
            ms: 1e3 * begin.elapsed().as_secs_f64(),
            work,
        })
    };
    let mut rows: Vec<Result<Row, String>> = solvers.iter().map(run).collect();
    for repeat in 1..REPEATS {
        for (solver, row) in solvers.iter().zip(&mut rows) {
            let Ok(row) = row else { continue };
            if row.ms * f64::from(repeat) < 1e3 * PATIENCE.as_secs_f64() {
                let begin = Instant::now();
                let again = (solver.solve)(problem, tolerance);
                let ms = 1e3 * begin.elapsed().as_secs_f64();
                if again.is_ok() {
                    row.ms = row.ms.min(ms);
                }
            }
        }
    }
    rows
}

impl Row {
    fn cells(&self) -> [String; 9] {
        let work = &self.work;
        [
            self.problem.to_owned(),
            self.method.clone(),
            format!("{:.0e}", self.tolerance),
            format!("{:.2}", self.digits),
            work.evaluations.to_string(),
            work.jacobians.to_string(),
            work.factorisations.map_or("-".to_owned(), |n| n.to_string()),
            work.steps.to_string(),
            format!("{:.3}", self.ms),
        ]
    }

    fn aligned(&self) -> String {
        let [
            problem,
            method,
            tolerance,
            digits,
            evaluations,
            jacobians,
            factorisations,
            steps,
            ms,
        ] = self.cells();
        format!(
            "{problem:<12} {method:<22} {tolerance:>9} {digits:>7} {evaluations:>11} {jacobians:>9} {factorisations:>14} {steps:>7} {ms:>9}"
        )
    }
}

/// Evaluations and time at which runs from loose to tight first have so many digits, between the last run with fewer and the next;
/// logarithms are interpolated.
fn at_digits(runs: &[&Row], digits: f64) -> Option<(f64, f64)> {
    let pair = runs
        .windows(2)
        .find(|pair| pair[0].digits < digits && digits <= pair[1].digits)?;
    let share = (digits - pair[0].digits) / (pair[1].digits - pair[0].digits);
    let between = |figure: fn(&Row) -> f64| {
        let [a, b] = [figure(pair[0]).ln(), figure(pair[1]).ln()];
        (a + share * (b - a)).exp()
    };
    Some((between(|row| row.work.evaluations as f64), between(|row| row.ms)))
}

//! The study as tables: for the terminal, as JSON and as CSV.

use serde_json::{Value, json};

use crate::machine::{Machine, Program};
use crate::summary::{Cell, Table};

use super::bounds::Polynomial;
use super::plans::{is_fixed, methods};
use super::spectrum::REFERENCE;
use super::stiffening::Quantity;
use super::sweep::{self, Outcome};
use super::{Study, long_run, repeat};

/// Three digits, and nothing more is to be believed.
fn short(x: f64) -> Cell {
    Cell::text(if x == 0.0 { "0".to_owned() } else { format!("{x:.2e}") })
}

/// All tables with all their rows, as files have them: name of the file and table.
pub fn all(study: &Study) -> Vec<(&'static str, Table)> {
    vec![
        ("sweeps", sweeps(study)),
        ("bounds", bounds()),
        ("eigenvalues", eigenvalues(study)),
        ("limits", limits(study)),
        ("long-run", long_run(study)),
        ("repeat", repeat(study, true)),
    ]
}

/// The sweeps, a row for each run.
fn sweeps(study: &Study) -> Table {
    let mut table = Table::new(
        "sweeps",
        &[
            ("quantity", ""),
            ("factor", ""),
            ("method", ""),
            ("outcome", ""),
            ("largest stable step", "s"),
            ("steps", ""),
            ("rejected", ""),
            ("evaluations", ""),
            ("time", "s"),
            ("why", ""),
        ],
    );
    for row in &study.sweeps {
        let mut cells = vec![
            Cell::text(row.quantity.name()),
            Cell::number(row.factor),
            Cell::text(row.method),
            Cell::text(row.outcome.word()),
        ];
        match &row.outcome {
            Outcome::Done(work) => cells.extend([
                work.step.map_or(Cell::Empty, Cell::number),
                Cell::count(work.steps),
                Cell::count(work.rejected),
                Cell::count(work.evaluations),
                Cell::number(work.wall),
            ]),
            Outcome::Failed(why) => {
                cells.resize(9, Cell::Empty);
                cells.push(Cell::text(why));
            }
            _ => {}
        }
        table.row(cells);
    }
    table
}

/// One sweep as people read it: a row for each factor, a column for each method.
fn sweep(study: &Study, quantity: Quantity) -> Table {
    let names: Vec<&str> = methods().collect();
    let mut columns = vec![(
        if quantity == Quantity::Elements {
            "number"
        } else {
            "factor"
        },
        "",
    )];
    columns.extend(
        names
            .iter()
            .map(|&name| (name, if is_fixed(name) { "step s" } else { "steps" })),
    );
    let mut table = Table::new(quantity.name(), &columns);
    for &factor in quantity.factors() {
        let rows = study
            .sweeps
            .iter()
            .filter(|row| row.quantity == quantity && row.factor == factor);
        let cells = rows.map(|row| match row.outcome.work() {
            Some(work) => match work.step {
                Some(step) => Cell::text(format!("{step:.1e}")),
                None => Cell::count(work.steps),
            },
            None => Cell::text(row.outcome.word()),
        });
        table.row([Cell::text(format!("{factor:e}"))].into_iter().chain(cells));
    }
    table
}

/// Stability bounds of the explicit one-step methods.
fn bounds() -> Table {
    let mut table = Table::new(
        "bounds",
        &[
            ("method", ""),
            ("along the real axis", ""),
            ("along the imaginary axis", ""),
        ],
    );
    for method in methods() {
        if let Some(polynomial) = Polynomial::of(method) {
            let reach = |re, im| short(polynomial.largest_step(nalgebra::Complex::new(re, im)));
            table.row([Cell::text(method), reach(-1.0, 0.0), reach(0.0, 1.0)]);
        }
    }
    table
}

/// Eigenvalues along the run, and the largest stable steps of the explicit one-step methods.
fn eigenvalues(study: &Study) -> Table {
    let explicit: Vec<(&str, Polynomial)> = methods().filter_map(|m| Some((m, Polynomial::of(m)?))).collect();
    let accuracy = format!("step of {REFERENCE}");
    let stable: Vec<String> = explicit.iter().map(|(method, _)| format!("stable {method}")).collect();
    let mut columns = vec![
        ("t", "s"),
        ("contact force", "N"),
        ("largest modulus", "1/s"),
        ("most negative real", "1/s"),
        ("largest imaginary", "1/s"),
        ("largest real", "1/s"),
        (accuracy.as_str(), "s"),
    ];
    columns.extend(stable.iter().map(|name| (name.as_str(), "s")));
    let mut table = Table::new("eigenvalues", &columns);
    for spectrum in &study.spectra {
        let mut cells = vec![Cell::number(spectrum.t), short(spectrum.normal)];
        cells.extend(spectrum.extremes().map(short));
        cells.push(short(spectrum.step));
        cells.extend(explicit.iter().map(|(_, polynomial)| {
            let steps = spectrum
                .eigenvalues
                .iter()
                .map(|&lambda| polynomial.largest_step(lambda));
            short(steps.fold(f64::INFINITY, f64::min))
        }));
        table.row(cells);
    }
    table
}

/// How often stability and not accuracy limits the explicit one-step methods: at how many of the states their largest stable step is
/// shorter than the step that accuracy allows, and by how much at most.
fn limits(study: &Study) -> Table {
    let columns = [
        ("method", ""),
        ("limited", ""),
        ("of", ""),
        ("most times", ""),
        ("at", "s"),
    ];
    let mut table = Table::new("limits", &columns);
    for method in methods() {
        let Some(polynomial) = Polynomial::of(method) else {
            continue;
        };
        let ratios = study
            .spectra
            .iter()
            .map(|s| (s.step / s.largest_step(&polynomial), s.t));
        let limited: Vec<(f64, f64)> = ratios.filter(|(ratio, _)| *ratio > 1.0).collect();
        let most = limited.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        table.row([
            Cell::text(method),
            Cell::count(limited.len() as u64),
            Cell::count(study.spectra.len() as u64),
            most.map_or(Cell::Empty, |(ratio, _)| Cell::text(format!("{ratio:.1}"))),
            most.map_or(Cell::Empty, |(_, t)| Cell::number(*t)),
        ]);
    }
    table
}

fn long_run(study: &Study) -> Table {
    let names: Vec<String> = long_run::TIMES
        .iter()
        .map(|time| format!("energy to {time} s"))
        .collect();
    let mut columns = vec![
        ("method", ""),
        ("at", "-, s"),
        ("outcome", ""),
        ("reached", "s"),
        ("steps", ""),
    ];
    columns.extend(names.iter().map(|name| (name.as_str(), "J")));
    columns.extend([("growth", ""), ("loops", "m"), ("of energy", "J")]);
    let mut table = Table::new("long run", &columns);
    for row in &study.long_run {
        let mut cells = vec![
            Cell::text(row.method),
            Cell::text(format!("{:e}", row.setting)),
            Cell::text(row.outcome.as_str()),
            Cell::number(row.reached),
            Cell::count(row.steps),
        ];
        cells.extend(long_run::TIMES.iter().map(|&time| {
            let drift = row.drift.iter().find(|(t, ..)| *t == time);
            drift.map_or(Cell::Empty, |&(_, energy, _)| short(energy))
        }));
        cells.push(
            row.growth()
                .map_or(Cell::Empty, |growth| Cell::text(format!("{growth:.2}"))),
        );
        cells.push(row.drift.last().map_or(Cell::Empty, |&(_, _, loops)| short(loops)));
        cells.push(Cell::number(row.energy));
        table.row(cells);
    }
    table
}

/// Repeats; with reasons for failures, or without.
fn repeat(study: &Study, reasons: bool) -> Table {
    let columns = [
        ("method", ""),
        ("what", ""),
        ("outcome", ""),
        ("difference", "rad, m, rad/s, m/s"),
        ("why", ""),
    ];
    let mut table = Table::new("repeat", &columns[..if reasons { 5 } else { 4 }]);
    for row in &study.repeat {
        let (difference, why) = match &row.outcome {
            repeat::Outcome::Differs(most) => (short(*most), Cell::Empty),
            repeat::Outcome::Failed(why) => (Cell::Empty, Cell::text(why)),
            _ => (Cell::Empty, Cell::Empty),
        };
        table.row([
            Cell::text(row.method),
            Cell::text(row.what.as_str()),
            Cell::text(row.outcome.word()),
            difference,
            why,
        ]);
    }
    table
}

/// The study for a terminal.
pub fn text(study: &Study) -> String {
    let mut text = format!(
        "{}: {}, up to {} s\n",
        study.scene.to_uppercase(),
        study.label,
        study.until
    );
    for quantity in Quantity::ALL {
        if study.sweeps.iter().any(|row| row.quantity == quantity) {
            text += &format!("\n{}\n{}", quantity.name(), sweep(study, quantity).to_text());
        }
    }
    for (why, rows) in failures(&study.sweeps) {
        text += &format!("failed: {rows}: {why}\n");
    }
    text += &format!(
        "\nstability of explicit one-step methods: largest -hλ and |hλ|\n{}",
        bounds().to_text()
    );
    text += &format!(
        "\neigenvalues of the motion, and steps: of {REFERENCE} by accuracy, of explicit methods by stability\n{}",
        eigenvalues(study).to_text()
    );
    text += &format!(
        "\nstates at which stability limits a method and not accuracy, and how many times shorter its steps are there\n{}",
        limits(study).to_text()
    );
    if let Some(remark) = &study.remark {
        text += &format!("{remark}\n");
    }
    text += &format!(
        "\nwithout drive and losses, largest drift; growth is the exponent of time in the last decade\n{}",
        long_run(study).to_text()
    );
    text += &format!("\nthe same run again\n{}", repeat(study, false).to_text());
    let mut told = "";
    for row in &study.repeat {
        if let repeat::Outcome::Failed(why) = &row.outcome
            && told != row.method
        {
            text += &format!("failed: {}: {why}\n", row.method);
            told = row.method;
        }
    }
    text
}

/// Each reason with the rows that failed for it: reasons differ in times and numbers only, so the first of a method stands for all.
fn failures(rows: &[sweep::Row]) -> Vec<(String, String)> {
    let mut told: Vec<(String, String, Quantity, &str)> = Vec::new();
    for row in rows {
        let Outcome::Failed(why) = &row.outcome else { continue };
        let same = told
            .iter_mut()
            .find(|(_, _, q, method)| *q == row.quantity && *method == row.method);
        match same {
            Some((_, named, ..)) => *named += &format!(", {:e}", row.factor),
            None => {
                let named = format!("{} at {} {:e}", row.method, row.quantity.name(), row.factor);
                told.push((why.clone(), named, row.quantity, row.method));
            }
        }
    }
    told.into_iter().map(|(why, named, ..)| (why, named)).collect()
}

/// The study with all digits.
pub fn json(study: &Study) -> Value {
    let tables: serde_json::Map<String, Value> = all(study)
        .into_iter()
        .map(|(name, table)| (name.replace('-', "_"), table.to_json()))
        .collect();
    json!({
        "scene": study.scene,
        "variant": study.label,
        "until": study.until,
        "budget_s": study.budget,
        "tables": tables,
        "spectra": study.spectra.iter().map(|spectrum| json!({
            "t": spectrum.t,
            "eigenvalues": spectrum.eigenvalues.iter().map(|z| [z.re, z.im]).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "remark": study.remark,
        "machine": Machine::this(),
        "program": Program::this(),
    })
}

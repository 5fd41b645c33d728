//! The report as text for the terminal, as JSON and as CSV.

use serde_json::{Value, json};

use crate::summary::{Cell, Table};

use super::candidates::Way;
use super::curve::Curves;
use super::figures::{Figures, Outcome, Row, papers};
use super::reference::{Errors, Known};
use super::{Report, Section};

/// Errors at which costs are compared \[rad, m; with clearance: ten clearances\].
const LEVELS: [f64; 10] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];

/// Columns for each of the two costs: method, cost, its ratio to others, and what `auto` takes of it.
const COSTS: [[&str; 6]; 2] = [
    [
        "fewest evaluations",
        "evaluations",
        "of paper's step",
        "of paper's way",
        "of rk4",
        "auto over fewest",
    ],
    [
        "least time",
        "time",
        "time of paper's step",
        "time of paper's way",
        "time of rk4",
        "auto over least time",
    ],
];

/// What the row of the paper's way is called.
fn name(row: &Row) -> String {
    let method = &row.candidate.plan.method;
    match row.candidate.way {
        Way::Own => method.clone(),
        Way::Papers => format!("{method}, paper's way at another step"),
        Way::Published => format!("{method}, paper's way"),
    }
}

/// Two digits, and nothing more is to be believed.
fn short(x: f64) -> Cell {
    Cell::text(format!("{x:.1e}"))
}

/// A ratio as one writes it: 1/20, or 3.4.
fn ratio(x: f64) -> String {
    match 1.0 / x {
        inverse if inverse >= 1.5 && inverse.is_finite() => format!("1/{inverse:.*}", usize::from(inverse < 10.0)),
        _ => format!("{x:.*}", usize::from(x < 10.0)),
    }
}

/// How good the reference is, in words.
pub fn certificate(report: &Report) -> String {
    let (reference, [a, b]) = (&report.reference, &report.plans);
    let at = |x: Option<f64>| format!("{:e}", x.unwrap_or(0.0));
    let horizon = match (&report.early, reference.whole) {
        (None, true) => format!("over the whole run, to {} s", reference.horizon),
        (Some(why), true) => format!(
            "up to {:.4} s of the {} s; {why}; all runs end there",
            reference.horizon, report.until
        ),
        (_, false) => format!(
            "up to {:.4} s of the {} s; later they differ by more than {:e}; all runs end there",
            reference.horizon,
            report.until,
            1e-3 * report.scale,
        ),
    };
    let note = report.origin.note.as_ref().map(|note| format!("note: {note}\n"));
    let Errors {
        positions,
        speeds,
        forces,
    } = reference.accuracy;
    format!(
        "reference ({}): {} at {} and {} at {} agree {horizon},\nto {positions:.1e} rad or m in positions, {speeds:.1e} rad/s or m/s in \
         speeds and {forces:.1e} N or N m in joint forces; smaller errors are shown as bounds\n{}",
        if report.origin.cached { "cached" } else { "computed" },
        a.method,
        at(a.rtol),
        b.method,
        at(b.rtol),
        note.unwrap_or_default(),
    )
}

/// An error in clearances.
fn in_clearances(error: Known, clearance: f64) -> Known {
    match error {
        Known::Value(x) => Known::Value(x / clearance),
        Known::Below(x) => Known::Below(x / clearance),
    }
}

/// All rows.
pub fn rows(report: &Report) -> Table {
    let base = papers(&report.rows);
    let mut columns = vec![("method", ""), ("at", "-, s"), ("positions", "rad, m")];
    columns.extend(report.clearance.map(|_| ("positions", "clearances")));
    columns.extend([
        ("speeds", "rad/s, m/s"),
        ("forces", "N, N m"),
        ("evaluations", ""),
        ("of paper's evaluations", ""),
        ("time", "s"),
        ("longest", "s"),
        ("of paper's time", ""),
        ("steps", ""),
        ("rejected", ""),
        ("Jacobians", ""),
        ("factors", ""),
        ("events", ""),
        ("energy", "J"),
        ("closures", "m"),
    ]);
    let mut table = Table::new("rows", &columns);
    for row in &report.rows {
        let mut cells = vec![
            Cell::text(name(row)),
            Cell::text(format!("{:e}", row.candidate.setting())),
        ];
        match &row.outcome {
            Outcome::Done(f) => {
                let s = &f.statistics;
                let ratios = base.map(|base| f.ratios(base));
                let part = |x: Option<f64>| x.map_or(Cell::Empty, |x| Cell::text(ratio(x)));
                cells.push(Cell::text(f.positions.shown()));
                let relative = report.clearance.map(|clearance| in_clearances(f.positions, clearance));
                cells.extend(relative.map(|error| Cell::text(error.shown())));
                cells.extend([
                    Cell::text(f.speeds.shown()),
                    Cell::text(f.forces.shown()),
                    Cell::count(s.evaluations),
                    part(ratios.map(|r| r.0)),
                    Cell::text(format!("{:.2e}", f.wall.0)),
                    match f.repeats {
                        0 => Cell::text("once"),
                        _ => Cell::text(format!("{:.2e}", f.wall.1)),
                    },
                    part(ratios.map(|r| r.1)),
                    Cell::count(s.accepted),
                    Cell::count(s.rejected),
                    Cell::count(s.jacobians),
                    Cell::count(s.factorisations),
                    Cell::count(s.events),
                    short(f.energy),
                    short(f.closures),
                ]);
            }
            Outcome::Failed(_) => cells.push(Cell::text("failed")),
            Outcome::NotRun => cells.push(Cell::text("not run")),
        }
        table.row(cells);
    }
    table
}

/// What is to be said below the tables.
pub fn remarks(report: &Report) -> String {
    let mut remarks = String::new();
    for row in &report.rows {
        if let Outcome::Failed(why) = &row.outcome {
            remarks += &format!("{} at {:e} failed: {why}\n", name(row), row.candidate.setting());
        }
    }
    if report.rows.iter().any(|row| matches!(row.outcome, Outcome::NotRun)) {
        remarks += &format!(
            "not run: beyond the budget of {:.0} s, or a quarter of what was left of it\n",
            report.budget
        );
    }
    if let Some(paper) = papers(&report.rows) {
        let error = paper.positions.bound();
        let few = Curves::new(&report.rows, evaluations);
        let fast = Curves::new(&report.rows, time);
        if let (Some((few, n)), Some((fast, t))) = (few.best(error), fast.best(error)) {
            let relative = report.clearance.map(|clearance| {
                let error = in_clearances(paper.positions, clearance);
                format!(" ({} clearances)", error.shown())
            });
            remarks += &format!(
                "at the error of the paper's way, {}{}: {few} takes {} of its evaluations, {fast} {} of its time\n",
                paper.positions.shown(),
                relative.unwrap_or_default(),
                ratio(n / evaluations(paper)),
                ratio(t / time(paper)),
            );
        }
    }
    remarks
}

/// A section for a terminal.
pub fn text(section: &Section) -> String {
    let title = section.title();
    match &section.outcome {
        Err(error) => format!("{title}\n{}", error.report()),
        Ok(report) => format!(
            "{title}\n{}\n{}\n{}\n{}",
            certificate(report),
            rows(report).to_text(),
            best(report).to_text(),
            remarks(report),
        ),
    }
}

pub fn evaluations(figures: &Figures) -> f64 {
    figures.statistics.evaluations as f64
}

pub fn time(figures: &Figures) -> f64 {
    figures.wall.0
}

/// The method of least cost at each error that some row keeps, interpolated between rows, beside the paper's way and RK4 at the same
/// error, beside the paper's way at its own step where that is as accurate, and beside what `auto` takes where there is such a method.
pub fn best(report: &Report) -> Table {
    let unit = if report.clearance.is_some() {
        "clearances"
    } else {
        "rad, m"
    };
    let scale = report.clearance.unwrap_or(1.0);
    let levels = LEVELS.map(|level| {
        if report.clearance.is_some() {
            10.0 * level
        } else {
            level
        }
    });
    let costs = [
        (COSTS[0], "", evaluations as fn(&Figures) -> f64),
        (COSTS[1], "s", time),
    ]
    .map(|(names, unit, of)| (names, unit, of, Curves::new(&report.rows, of)));
    let auto = costs[0].3.methods.iter().any(|(name, _)| name == "auto");
    let mut columns = vec![("error", unit)];
    for ([method, cost, ratios @ .., factor], unit, ..) in &costs {
        columns.extend([(*method, ""), (*cost, *unit)]);
        columns.extend(ratios.iter().map(|ratio| (*ratio, "")));
        columns.extend(auto.then_some((*factor, "")));
    }
    let mut table = Table::new("best", &columns);
    for level in levels {
        let error = level * scale;
        let mut cells = vec![Cell::text(format!("{level:.0e}"))];
        for (_, unit, of, curves) in &costs {
            let Some((method, cost)) = curves.best(error) else {
                continue;
            };
            let part = |other: Option<f64>| other.map_or(Cell::Empty, |other| Cell::text(ratio(cost / other)));
            let step = papers(&report.rows).filter(|paper| paper.positions.bound() <= error);
            cells.push(Cell::text(method));
            cells.push(match *unit {
                "s" => Cell::text(format!("{cost:.2e}")),
                _ => Cell::count(cost.round() as u64),
            });
            cells.extend([
                part(step.map(of)),
                part(curves.papers.cost(error)),
                part(curves.cost("rk4", error)),
            ]);
            if auto {
                let factor = curves.cost("auto", error).map(|auto| format!("{:.2}", auto / cost));
                cells.push(factor.map_or(Cell::Empty, Cell::text));
            }
        }
        if cells.len() > 1 {
            table.row(cells);
        }
    }
    table
}

/// An error in JSON: its value, or a bound; never a number that the reference cannot tell.
fn known(error: Known) -> Value {
    match error {
        Known::Value(x) if x.is_finite() => json!({ "value": x }),
        Known::Value(_) => json!({ "value": "inf" }),
        Known::Below(x) => json!({ "below": x }),
    }
}

/// One row in JSON.
fn entry(report: &Report, row: &Row) -> Value {
    let base = papers(&report.rows);
    let mut entry = json!({
        "integration": row.candidate.plan,
        "papers_way": row.candidate.way != Way::Own,
        "papers_step": row.candidate.way == Way::Published,
        "outcome": row.outcome.word(),
    });
    if let Outcome::Failed(why) = &row.outcome {
        entry["failure"] = json!(why);
    }
    if let Some(f) = row.outcome.figures() {
        let s = &f.statistics;
        let ratios = base.map(|base| f.ratios(base));
        entry["errors"] = json!({
            "positions": known(f.positions),
            "speeds": known(f.speeds),
            "forces": known(f.forces),
        });
        if let Some(clearance) = report.clearance {
            entry["errors"]["positions_in_clearances"] = known(in_clearances(f.positions, clearance));
        }
        entry["wall_s"] = json!({ "least": f.wall.0, "longest": f.wall.1, "repeats": f.repeats });
        entry["work"] = json!({
            "evaluations": s.evaluations,
            "evaluations_for_jacobians": s.jacobian_evaluations,
            "jacobians": s.jacobians,
            "factorisations": s.factorisations,
            "steps_accepted": s.accepted,
            "steps_rejected": s.rejected,
            "events": s.events,
        });
        entry["drift"] = json!({ "energy_j": f.energy, "closures": f.closures });
        entry["ratio_to_papers_way"] = ratios.map_or(
            Value::Null,
            |(evaluations, time)| json!({ "evaluations": evaluations, "time": time }),
        );
    }
    entry
}

/// A section with all digits.
pub fn json(section: &Section) -> Value {
    let mut whole = json!({ "scene": section.scene, "variant": section.label });
    let report = match &section.outcome {
        Err(error) => {
            whole["failure"] = json!(error.to_string());
            return whole;
        }
        Ok(report) => report,
    };
    let reference = &report.reference;
    let curve = |pick: fn(&Errors) -> f64| -> Vec<f64> {
        reference.disagreement.iter().map(|(_, errors)| pick(errors)).collect()
    };
    let rows: Vec<Value> = report.rows.iter().map(|row| entry(report, row)).collect();
    let found = json!({
        "until": report.until,
        "budget_s": report.budget,
        "units": { "positions": "rad, m", "speeds": "rad/s, m/s", "forces": "N, N m", "closures": "m, -" },
        "clearance": report.clearance,
        "reference": {
            "integrations": report.plans,
            "cached": report.origin.cached,
            "note": report.origin.note,
            "horizon": reference.horizon,
            "whole_run": reference.whole && report.early.is_none(),
            "ended_early": report.early,
            "scale": report.scale,
            "accuracy": {
                "positions": reference.accuracy.positions,
                "speeds": reference.accuracy.speeds,
                "forces": reference.accuracy.forces,
            },
            "disagreement": {
                "t": reference.disagreement.iter().map(|(t, _)| *t).collect::<Vec<_>>(),
                "positions": curve(|errors| errors.positions),
                "speeds": curve(|errors| errors.speeds),
                "forces": curve(|errors| errors.forces),
            },
        },
        "rows": rows,
        "best": best(report).to_json(),
    });
    if let (Value::Object(whole), Value::Object(found)) = (&mut whole, found) {
        whole.extend(found);
    }
    whole
}

/// Columns of the CSV.
const CSV: [&str; 25] = [
    "scene",
    "variant",
    "method",
    "way",
    "setting",
    "outcome",
    "positions",
    "positions_is_bound",
    "speeds",
    "speeds_is_bound",
    "forces",
    "forces_is_bound",
    "evaluations",
    "evaluations_ratio",
    "wall_least_s",
    "wall_longest_s",
    "repeats",
    "wall_ratio",
    "steps_accepted",
    "steps_rejected",
    "jacobians",
    "factorisations",
    "events",
    "energy_drift_j",
    "closure_drift",
];

/// The rows as CSV: empty where there is no number; an error marked as a bound is smaller than the number given. A scene that failed
/// has one row that says so.
pub fn csv(sections: &[Section]) -> String {
    let mut text = CSV.join(",");
    text.push('\n');
    for section in sections {
        let name = [section.scene.clone(), section.label.replace(',', ";")];
        let mut line = |mut cells: Vec<String>| {
            cells.resize(CSV.len() - 2, String::new());
            text += &[&name[..], &cells[..]].concat().join(",");
            text.push('\n');
        };
        match &section.outcome {
            Err(_) => line(vec![String::new(), String::new(), String::new(), "failed".to_owned()]),
            Ok(report) => report.rows.iter().for_each(|row| line(csv_cells(report, row))),
        }
    }
    text
}

fn csv_cells(report: &Report, row: &Row) -> Vec<String> {
    let way = match row.candidate.way {
        Way::Own => "own",
        Way::Papers => "papers",
        Way::Published => "papers_step",
    };
    let mut cells = vec![
        row.candidate.plan.method.clone(),
        way.to_owned(),
        format!("{:e}", row.candidate.setting()),
        row.outcome.word().to_owned(),
    ];
    let Some(f) = row.outcome.figures() else { return cells };
    for error in [f.positions, f.speeds, f.forces] {
        cells.push(format!("{:e}", error.bound()));
        cells.push(matches!(error, Known::Below(_)).to_string());
    }
    let s = &f.statistics;
    let (evaluations, time) = match papers(&report.rows).map(|base| f.ratios(base)) {
        Some((evaluations, time)) => (format!("{evaluations:e}"), format!("{time:e}")),
        None => Default::default(),
    };
    cells.extend([s.evaluations.to_string(), evaluations]);
    cells.extend([
        format!("{:e}", f.wall.0),
        format!("{:e}", f.wall.1),
        f.repeats.to_string(),
        time,
    ]);
    let counts = [s.accepted, s.rejected, s.jacobians, s.factorisations, s.events];
    cells.extend(counts.map(|count| count.to_string()));
    cells.extend([f.energy, f.closures].map(|x| format!("{x:e}")));
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_read_like_ratios() {
        for (x, text) in [
            (0.05, "1/20"),
            (0.25, "1/4.0"),
            (1.0, "1.0"),
            (0.9, "0.9"),
            (34.2, "34"),
            (0.0, "0.0"),
        ] {
            assert_eq!(ratio(x), text);
        }
    }

    #[test]
    fn what_the_reference_cannot_tell_is_never_a_value() {
        assert_eq!(known(Known::Below(1e-9)), json!({ "below": 1e-9 }));
        assert_eq!(known(Known::Value(2e-9)), json!({ "value": 2e-9 }));
        assert_eq!(known(Known::Value(f64::INFINITY)), json!({ "value": "inf" }));
    }
}

//! The report as text for the terminal, as JSON and as CSV.

use serde_json::{Value, json};

use crate::machine::{Machine, Program};
use crate::summary::{Cell, Table};

use super::Report;
use super::figures::{Figures, Outcome, Row, cheapest, papers};
use super::reference::Known;

/// Errors for which the best method is told \[rad, m\].
const LEVELS: [f64; 10] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];

/// What the row of the paper's way is called.
fn name(row: &Row) -> String {
    let method = &row.candidate.plan.method;
    match row.candidate.papers {
        true => format!("{method}, paper's way"),
        false => method.clone(),
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
fn certificate(report: &Report) -> String {
    let (reference, [a, b]) = (&report.reference, &report.plans);
    let at = |x: Option<f64>| format!("{:e}", x.unwrap_or(0.0));
    let horizon = match reference.whole {
        true => format!("over the whole run, to {} s", reference.horizon),
        false => format!(
            "up to {:.4} s; later rows of the {} s do not count, there they differ by more than {:e}",
            reference.horizon,
            report.until,
            1e-3 * report.scale,
        ),
    };
    format!(
        "reference: {} at {} and {} at {} agree {horizon},\nto {:.1e} rad or m in positions and {:.1e} rad/s or m/s in speeds; \
         smaller errors are shown as bounds\n",
        a.method,
        at(a.rtol),
        b.method,
        at(b.rtol),
        reference.accuracy.positions,
        reference.accuracy.speeds,
    )
}

/// The report for a terminal.
pub fn text(report: &Report) -> String {
    let base = papers(&report.rows);
    let mut table = Table::new(
        "rows",
        &[
            ("method", ""),
            ("at", "-, s"),
            ("positions", "rad, m"),
            ("speeds", "rad/s, m/s"),
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
        ],
    );
    let mut remarks = String::new();
    for row in &report.rows {
        let at = Cell::text(format!("{:e}", row.candidate.setting()));
        match &row.outcome {
            Outcome::Done(f) => {
                let s = &f.statistics;
                let ratios = base.map(|base| f.ratios(base));
                let part = |x: Option<f64>| x.map_or(Cell::Empty, |x| Cell::text(ratio(x)));
                table.row([
                    Cell::text(name(row)),
                    at,
                    Cell::text(f.positions.shown()),
                    Cell::text(f.speeds.shown()),
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
            Outcome::Failed(why) => {
                table.row([Cell::text(name(row)), at, Cell::text("failed")]);
                remarks += &format!("{} at {:e} failed: {why}\n", name(row), row.candidate.setting());
            }
            Outcome::NotRun => {
                table.row([Cell::text(name(row)), at, Cell::text("not run")]);
            }
        }
    }
    if report.rows.iter().any(|row| matches!(row.outcome, Outcome::NotRun)) {
        remarks += &format!(
            "not run: beyond the budget of {} s, or a quarter of what was left of it\n",
            report.budget
        );
    }
    if let Some((paper, (row, f))) = base.and_then(|base| Some((base, equal_error(&report.rows, base)?))) {
        let (evaluations, time) = f.ratios(paper);
        remarks += &format!(
            "at the error of the paper's way, {}: {} at {:e} takes {} of its evaluations and {} of its time\n",
            paper.positions.shown(),
            name(row),
            row.candidate.setting(),
            ratio(evaluations),
            ratio(time),
        );
    }
    let title = format!("{}: {}", report.scene.to_uppercase(), report.label);
    format!(
        "{title}\n{}\n{}\n{}\n{remarks}",
        certificate(report),
        table.to_text(),
        best(report).to_text()
    )
}

/// The row of fewest evaluations that is as accurate as the paper's way.
fn equal_error<'a>(rows: &'a [Row], paper: &Figures) -> Option<(&'a Row, &'a Figures)> {
    cheapest(rows, paper.positions.bound(), evaluations)
}

fn evaluations(figures: &Figures) -> f64 {
    figures.statistics.evaluations as f64
}

/// The cheapest row for each error that some row keeps.
fn best(report: &Report) -> Table {
    let mut table = Table::new(
        "best",
        &[
            ("error below", "rad, m"),
            ("fewest evaluations", ""),
            ("evaluations", ""),
            ("least time", ""),
            ("time", "s"),
        ],
    );
    for level in LEVELS {
        let fewest = cheapest(&report.rows, level, evaluations);
        let fastest = cheapest(&report.rows, level, |f| f.wall.0);
        if let (Some((few, f)), Some((fast, g))) = (fewest, fastest) {
            let called = |row: &Row| Cell::text(format!("{} at {:e}", name(row), row.candidate.setting()));
            table.row([
                Cell::text(format!("{level:e}")),
                called(few),
                Cell::count(f.statistics.evaluations),
                called(fast),
                Cell::text(format!("{:.2e}", g.wall.0)),
            ]);
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

/// The report with all digits.
pub fn json(report: &Report) -> Value {
    let base = papers(&report.rows);
    let rows: Vec<Value> = report
        .rows
        .iter()
        .map(|row| {
            let mut entry = json!({
                "integration": row.candidate.plan,
                "papers_way": row.candidate.papers,
                "outcome": row.outcome.word(),
            });
            if let Outcome::Failed(why) = &row.outcome {
                entry["failure"] = json!(why);
            }
            if let Some(f) = row.outcome.figures() {
                let s = &f.statistics;
                let ratios = base.map(|base| f.ratios(base));
                entry["errors"] = json!({ "positions": known(f.positions), "speeds": known(f.speeds) });
                entry["wall_time_s"] = json!({ "least": f.wall.0, "longest": f.wall.1, "repeats": f.repeats });
                entry["counters"] = json!({
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
        })
        .collect();
    let reference = &report.reference;
    let curve = |pick: fn(&super::reference::Errors) -> f64| -> Vec<f64> {
        reference.disagreement.iter().map(|(_, errors)| pick(errors)).collect()
    };
    json!({
        "scene": report.scene,
        "variant": report.label,
        "until": report.until,
        "budget_s": report.budget,
        "units": { "positions": "rad, m", "speeds": "rad/s, m/s", "closures": "m, -" },
        "reference": {
            "integrations": report.plans,
            "horizon": reference.horizon,
            "whole_run": reference.whole,
            "scale": report.scale,
            "accuracy": { "positions": reference.accuracy.positions, "speeds": reference.accuracy.speeds },
            "disagreement": {
                "t": reference.disagreement.iter().map(|(t, _)| *t).collect::<Vec<_>>(),
                "positions": curve(|errors| errors.positions),
                "speeds": curve(|errors| errors.speeds),
            },
        },
        "rows": rows,
        "best": best(report).to_json(),
        "machine": Machine::this(),
        "program": Program::this(),
    })
}

/// The rows as CSV: empty where there is no number; an error marked as a bound is smaller than the number given.
pub fn csv(report: &Report) -> String {
    let base = papers(&report.rows);
    let mut text = "method,papers_way,setting,outcome,positions,positions_is_bound,speeds,speeds_is_bound,evaluations,\
                    evaluations_ratio,wall_least_s,wall_longest_s,repeats,wall_ratio,steps_accepted,steps_rejected,jacobians,\
                    factorisations,events,energy_drift_j,closure_drift\n"
        .to_owned();
    for row in &report.rows {
        let plan = &row.candidate.plan;
        let mut cells = vec![
            plan.method.clone(),
            row.candidate.papers.to_string(),
            format!("{:e}", row.candidate.setting()),
            row.outcome.word().to_owned(),
        ];
        match row.outcome.figures() {
            None => cells.resize(21, String::new()),
            Some(f) => {
                for error in [f.positions, f.speeds] {
                    cells.push(format!("{:e}", error.bound()));
                    cells.push(matches!(error, Known::Below(_)).to_string());
                }
                let s = &f.statistics;
                let (evaluations, time) = match base.map(|base| f.ratios(base)) {
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
            }
        }
        text += &cells.join(",");
        text.push('\n');
    }
    text
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

//! Work-precision pictures: error against evaluations and against time, and how far the references agree.

use crate::errors::CliError;
use crate::figure::{Axis, Figure, Mark, Panel, Series};
use crate::results::RunFolder;
use crate::run::pictures::save;

use super::Report;
use super::figures::{Figures, Row};
use super::reference::Known;

/// Errors beyond this \[rad, m\] are of runs that went elsewhere, and would only press the others together.
const LARGEST: f64 = 10.0;
/// Width of a picture and height of its panel, in pixels.
const SIZE: (u32, u32) = (900, 440);
/// Style of the line at the accuracy of the reference: grey.
const ACCURACY_STYLE: usize = 5;

/// Draws all pictures into the folder.
///
/// # Errors
/// Those of drawing and writing.
pub fn draw(report: &Report, folder: &mut RunFolder) -> Result<(), CliError> {
    let title = format!("{}: {}", report.scene.to_uppercase(), report.label);
    for (file, label, cost) in [
        ("evaluations", "evaluations", evaluations as fn(&Figures) -> f64),
        ("time", "time (s)", time),
    ] {
        let curves = curves(&report.rows, cost);
        if curves.is_empty() {
            continue;
        }
        let all = || curves.iter().flat_map(|(_, points)| points).map(|point| point.0);
        let (least, most) = (all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max));
        let accuracy = report.reference.accuracy.positions;
        let empty = Panel::new("", Axis::log(label), Axis::log("largest error of positions (rad, m)"));
        let mut panel = curves
            .into_iter()
            .enumerate()
            .fold(empty, |panel, (style, (name, points))| {
                panel.series(Series::new(name, style, Mark::LineAndDots, points))
            });
        if least < most {
            let line = vec![(least, accuracy), (most, accuracy)];
            panel = panel.series(Series::line("reference", ACCURACY_STYLE, line));
        }
        let figure = Figure::new(format!("{title}, error against {file}"));
        save(
            folder,
            &format!("error-{file}"),
            &figure.columns(1).size(SIZE.0, SIZE.1).panel(panel),
        )?;
    }
    let points = report.reference.disagreement.iter();
    let points: Vec<(f64, f64)> = points
        .map(|(t, errors)| (*t, errors.positions))
        .filter(|(_, error)| *error > 0.0 && error.is_finite())
        .collect();
    if points.is_empty() {
        return Ok(());
    }
    let label = "disagreement of the references (rad, m)";
    let panel = Panel::new("", Axis::linear("t (s)"), Axis::log(label)).series(Series::line("", 0, points));
    let figure = Figure::new(format!("{title}, reference"))
        .columns(1)
        .size(SIZE.0, SIZE.1);
    save(folder, "reference", &figure.panel(panel))
}

fn evaluations(figures: &Figures) -> f64 {
    figures.statistics.evaluations as f64
}

fn time(figures: &Figures) -> f64 {
    figures.wall.0
}

/// A curve for each method, cost and error, from the cheapest run on. Bounds are left out: they are not errors.
fn curves(rows: &[Row], cost: impl Fn(&Figures) -> f64) -> Vec<(String, Vec<(f64, f64)>)> {
    let mut curves: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
    for row in rows {
        let name = match row.candidate.papers {
            true => "paper's way".to_owned(),
            false => row.candidate.plan.method.clone(),
        };
        let Some(figures) = row.outcome.figures() else { continue };
        let point = match figures.positions {
            Known::Value(error) if error <= LARGEST && cost(figures) > 0.0 => (cost(figures), error),
            _ => continue,
        };
        match curves.iter_mut().find(|curve| curve.0 == name) {
            Some((_, points)) => points.push(point),
            None => curves.push((name, vec![point])),
        }
    }
    for (_, points) in &mut curves {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    curves
}

#[cfg(test)]
mod tests {
    use super::super::figures::tests::row;
    use super::*;

    #[test]
    fn bounds_and_runs_that_went_elsewhere_are_not_drawn() {
        let rows = [
            row("adams", false, Known::Value(1e-6), 50),
            row("adams", false, Known::Value(1e-3), 20),
            row("adams", false, Known::Below(1e-9), 90),
            row("rk4", false, Known::Value(1e3), 10),
            row("rk4", true, Known::Value(1e-4), 30),
        ];
        let curves = curves(&rows, evaluations);
        let expected = [
            ("adams".to_owned(), vec![(20.0, 1e-3), (50.0, 1e-6)]),
            ("paper's way".to_owned(), vec![(30.0, 1e-4)]),
        ];
        assert_eq!(curves, expected);
    }
}

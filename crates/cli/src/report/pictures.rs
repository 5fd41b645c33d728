//! Work-precision pictures: error against evaluations and against time, and how far the references agree.

use crate::errors::CliError;
use crate::figure::{Axis, Figure, Mark, Panel, Series};
use crate::results::RunFolder;
use crate::run::pictures::save;

use super::candidates::Way;
use super::figures::{Figures, Row};
use super::reference::{Errors, Known};
use super::tables::{evaluations, time};
use super::{Report, Section};

/// Errors beyond this, in any unit, are of runs that went elsewhere, and would only press the others together.
const LARGEST: f64 = 1e4;
/// Width of a picture and height of its panel, in pixels.
const SIZE: (u32, u32) = (1290, 400);
/// Style of the line at the accuracy of the reference: grey.
const ACCURACY_STYLE: usize = 5;

/// A kind of error: its label and where it is found in figures and in a reference.
type Kind = (&'static str, fn(&Figures) -> Known, fn(&Errors) -> f64);

const KINDS: [Kind; 3] = [
    ("positions (rad, m)", |f| f.positions, |e| e.positions),
    ("speeds (rad/s, m/s)", |f| f.speeds, |e| e.speeds),
    ("joint forces (N, N m)", |f| f.forces, |e| e.forces),
];

/// Draws all pictures of a section into the folder; gives them as SVG for its page.
///
/// # Errors
/// Those of drawing and writing.
pub fn draw(section: &Section, folder: &mut RunFolder) -> Result<Vec<String>, CliError> {
    let Ok(report) = &section.outcome else {
        return Ok(Vec::new());
    };
    let mut drawn = Vec::new();
    for (file, label, cost) in [
        ("evaluations", "evaluations", evaluations as fn(&Figures) -> f64),
        ("time", "time (s)", time),
    ] {
        let title = format!("{}, error against {file}", section.title());
        let panels = KINDS.iter().filter_map(|kind| precision(report, kind, label, cost));
        drawn.extend(figure(folder, section, &format!("error-{file}"), title, panels)?);
    }
    let title = format!("{}, disagreement of the references", section.title());
    let panels = KINDS.iter().filter_map(|kind| disagreement(report, kind));
    drawn.extend(figure(folder, section, "reference", title, panels)?);
    Ok(drawn)
}

/// A figure of the panels, if there are any.
fn figure(
    folder: &mut RunFolder,
    section: &Section,
    file: &str,
    title: String,
    panels: impl Iterator<Item = Panel>,
) -> Result<Option<String>, CliError> {
    let figure = Figure::new(title).columns(3).size(SIZE.0, SIZE.1);
    let (figure, count) = panels.fold((figure, 0), |(figure, count), panel| (figure.panel(panel), count + 1));
    if count == 0 {
        return Ok(None);
    }
    save(folder, &format!("{}{file}", section.prefix), &figure)?;
    Ok(Some(figure.to_svg()?))
}

/// One kind of error against one cost, a curve for each method.
fn precision(report: &Report, kind: &Kind, label: &str, cost: fn(&Figures) -> f64) -> Option<Panel> {
    let (name, error, accuracy) = kind;
    let curves = curves(&report.rows, *error, cost);
    let all = || curves.iter().flat_map(|(_, _, points)| points).map(|point| point.0);
    let (least, most) = (all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max));
    all().next()?;
    let mut panel = Panel::new("", Axis::log(label), Axis::log(format!("largest error of {name}")));
    for (name, style, points) in curves {
        panel = panel.series(Series::new(name, style, Mark::LineAndDots, points));
    }
    let accuracy = accuracy(&report.reference.accuracy);
    if least < most && accuracy.is_finite() {
        let line = vec![(least, accuracy), (most, accuracy)];
        panel = panel.series(Series::line("reference", ACCURACY_STYLE, line));
    }
    Some(panel)
}

/// What the references differ by over time, with the horizon and the accuracy up to it.
fn disagreement(report: &Report, (name, _, pick): &Kind) -> Option<Panel> {
    let reference = &report.reference;
    let points = reference.disagreement.iter().map(|(t, errors)| (*t, pick(errors)));
    let points: Vec<(f64, f64)> = points.filter(|(_, error)| *error > 0.0 && error.is_finite()).collect();
    let least = points.iter().map(|p| p.1).reduce(f64::min)?;
    let most = points.iter().map(|p| p.1).fold(0.0, f64::max);
    let accuracy = pick(&reference.accuracy);
    let mut panel = Panel::new("", Axis::linear("t (s)"), Axis::log(format!("difference of {name}")))
        .series(Series::line("difference", 0, points));
    if accuracy.is_finite() {
        let line = vec![(0.0, accuracy), (reference.horizon, accuracy)];
        panel = panel.series(Series::line("accuracy told", ACCURACY_STYLE, line));
    }
    if least < most {
        let line = vec![(reference.horizon, least), (reference.horizon, most)];
        panel = panel.series(Series::line("horizon", 1, line));
    }
    Some(panel)
}

/// A named curve and its style.
type Curve = (String, usize, Vec<(f64, f64)>);

/// A curve for each method, cost and error, from the cheapest run on. Bounds are left out: they are not errors. A method has the same
/// style in every panel.
fn curves(rows: &[Row], error: fn(&Figures) -> Known, cost: fn(&Figures) -> f64) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for row in rows {
        let name = match row.candidate.way {
            Way::Own => row.candidate.plan.method.as_str(),
            Way::Papers | Way::Published => "paper's way",
        };
        let at = match curves.iter().position(|curve| curve.0 == name) {
            Some(at) => at,
            None => {
                let style = curves.len() + usize::from(curves.len() >= ACCURACY_STYLE);
                curves.push((name.to_owned(), style, Vec::new()));
                curves.len() - 1
            }
        };
        let Some(figures) = row.outcome.figures() else { continue };
        match error(figures) {
            Known::Value(error) if error <= LARGEST && cost(figures) > 0.0 => curves[at].2.push((cost(figures), error)),
            _ => {}
        }
    }
    curves.retain(|curve| !curve.2.is_empty());
    for (_, _, points) in &mut curves {
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
            row("adams", Way::Own, Known::Value(1e-6), 50),
            row("adams", Way::Own, Known::Value(1e-3), 20),
            row("adams", Way::Own, Known::Below(1e-9), 90),
            row("dopri5", Way::Own, Known::Value(f64::INFINITY), 10),
            row("rk4", Way::Published, Known::Value(1e-4), 30),
        ];
        let curves = curves(&rows, |f| f.positions, evaluations);
        let expected = [
            ("adams".to_owned(), 0, vec![(20.0, 1e-3), (50.0, 1e-6)]),
            ("paper's way".to_owned(), 2, vec![(30.0, 1e-4)]),
        ];
        assert_eq!(curves, expected);
    }
}

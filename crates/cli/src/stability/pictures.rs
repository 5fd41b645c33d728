//! Pictures of the study: steps against factors, eigenvalues along the run, drift of energy over time.

use crate::errors::CliError;
use crate::figure::{Axis, Figure, Mark, Panel, Series};
use crate::results::RunFolder;
use crate::run::pictures::save;

use super::Study;
use super::bounds::Polynomial;
use super::plans::methods;
use super::spectrum::REFERENCE;
use super::stiffening::Quantity;

/// Width of a picture and height of its panel, in pixels.
const SIZE: (u32, u32) = (900, 440);

/// A curve with its name.
type Curve = (String, Vec<(f64, f64)>);

/// Draws all pictures for which there are points.
///
/// # Errors
/// Those of drawing and writing.
pub fn draw(study: &Study, folder: &mut RunFolder) -> Result<(), CliError> {
    let title = format!("{}: {}", study.scene.to_uppercase(), study.label);
    let mut picture = |file: &str, what: &str, (x, y): (Axis, Axis), curves: Vec<Curve>| {
        let panel = curves
            .into_iter()
            .enumerate()
            .filter(|(_, curve)| !curve.1.is_empty())
            .fold((Panel::new("", x, y), false), |(panel, _), (style, (name, points))| {
                (panel.series(Series::new(name, style, Mark::LineAndDots, points)), true)
            });
        match panel {
            (panel, true) => {
                let figure = Figure::new(format!("{title}, {what}")).columns(1).size(SIZE.0, SIZE.1);
                save(folder, file, &figure.panel(panel))
            }
            (_, false) => Ok(()),
        }
    };
    for quantity in Quantity::ALL {
        let what = quantity.name();
        let label = if quantity == Quantity::Elements {
            "elements"
        } else {
            "factor"
        };
        let axes = (Axis::log(label), Axis::log("steps"));
        picture(
            &format!("steps-{}", what.replace(' ', "-")),
            what,
            axes,
            steps(study, quantity),
        )?;
    }
    let axes = (Axis::linear("t (s)"), Axis::log("1/s"));
    picture("eigenvalues", "eigenvalues", axes, eigenvalues(study))?;
    let axes = (Axis::linear("t (s)"), Axis::log("step (s)"));
    picture(
        "stable-steps",
        "steps by accuracy and by stability",
        axes,
        stable_steps(study),
    )?;
    let axes = (Axis::log("t (s)"), Axis::log("largest change of energy (J)"));
    picture("long-run", "without drive and losses", axes, drift(study))
}

/// Steps of each method against the factor; for methods of fixed step with the largest that is stable.
fn steps(study: &Study, quantity: Quantity) -> Vec<Curve> {
    let curve = |method: &'static str| {
        let rows = study
            .sweeps
            .iter()
            .filter(|row| row.quantity == quantity && row.method == method);
        let points = rows.filter_map(|row| Some((row.factor, row.outcome.work()?.steps as f64)));
        (method.to_owned(), points.filter(|point| point.1 > 0.0).collect())
    };
    methods().map(curve).collect()
}

fn eigenvalues(study: &Study) -> Vec<Curve> {
    let names = [
        "largest modulus",
        "most negative real part",
        "largest imaginary part",
        "largest real part",
    ];
    let curve = |(i, name): (usize, &str)| {
        let points = study
            .spectra
            .iter()
            .map(|spectrum| (spectrum.t, spectrum.extremes()[i].abs()));
        (name.to_owned(), points.filter(|point| point.1 > 0.0).collect())
    };
    names.into_iter().enumerate().map(curve).collect()
}

fn stable_steps(study: &Study) -> Vec<Curve> {
    let accuracy = study
        .spectra
        .iter()
        .map(|spectrum| (spectrum.t, spectrum.step))
        .filter(|point| point.1 > 0.0);
    let mut curves = vec![(format!("accuracy ({REFERENCE})"), accuracy.collect())];
    for method in methods() {
        let Some(polynomial) = Polynomial::of(method) else {
            continue;
        };
        let points = study
            .spectra
            .iter()
            .map(|spectrum| (spectrum.t, spectrum.largest_step(&polynomial)));
        curves.push((method.to_owned(), points.filter(|point| point.1.is_finite()).collect()));
    }
    curves
}

fn drift(study: &Study) -> Vec<Curve> {
    let rows = study.long_run.iter().map(|row| {
        let points = row.drift.iter().map(|&(t, energy, _)| (t, energy));
        (
            row.method.to_owned(),
            points.filter(|point| point.1 > 0.0 && point.1.is_finite()).collect(),
        )
    });
    rows.collect()
}

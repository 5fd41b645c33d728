//! The pictures of a run, after those of the papers: coordinates and speeds (RSRRR, Fig. 11), joint forces and torques (Fig. 12), motion of
//! the output link (RSUP, Fig. 8), contact force (Fig. 9) and path of the journal in its bearing (Fig. 10), each with other variants of
//! the scene in the same panels.

use std::f64::consts::TAU;

use crate::errors::CliError;
use crate::figure::{Axis, Figure, Panel, Series};
use crate::results::RunFolder;

use super::record::{Record, StepCurve};

/// Points a pixel of the PNGs, for print.
const PNG_SCALE: f64 = 2.0;

/// Width of a picture of a path, and height of its panel, in pixels.
const PATH_WIDTH: u32 = 520;
const PATH_HEIGHT: u32 = 400;

/// A run as a curve: its name, its style and its record.
pub struct Curve<'a> {
    /// Name in the legend.
    pub label: String,
    /// Style; the same variant has the same style in every picture.
    pub style: usize,
    /// The run.
    pub record: &'a Record,
}

/// Names of what is drawn.
pub struct Names<'a> {
    /// Title of the pictures.
    pub title: &'a str,
    /// Coordinates.
    pub coordinates: Vec<&'a str>,
    /// Joints.
    pub joints: Vec<&'a str>,
    /// Contact points.
    pub contacts: Vec<String>,
    /// Radial clearance of each of them \[m\].
    pub clearances: Vec<Option<f64>>,
    /// The output coordinate.
    pub output: Option<&'a str>,
    /// Whether joint reactions were found.
    pub reactions: bool,
}

impl Names<'_> {
    /// Unit of a coordinate: slides are called z.
    fn unit(&self, coordinate: &str) -> &'static str {
        if coordinate.starts_with('z') || coordinate.ends_with(".z") {
            "m"
        } else {
            "rad"
        }
    }
}

/// Draws all pictures into the folder; returns their names without ending.
///
/// # Errors
/// Those of drawing and writing.
pub fn draw(folder: &mut RunFolder, names: &Names<'_>, curves: &[Curve<'_>]) -> Result<(), CliError> {
    // Elastic coordinates are many, small, and of little use to look at one by one.
    let elastic = |name: &str| name.rsplit('.').next().is_some_and(|end| end.parse::<u32>().is_ok());
    let coordinates = names.coordinates.iter().copied().filter(|name| !elastic(name));
    let motion = pairs(
        &format!("{}: coordinates and speeds", names.title),
        &coordinates.collect::<Vec<_>>(),
        |name, _| {
            let unit = names.unit(name);
            let q = panel(format!("{name} ({unit})"), curves, |record| record.of(name, &record.q));
            let v = panel(format!("{name}' ({unit}/s)"), curves, |record| {
                record.of(name, &record.v)
            });
            [q, v]
        },
    );
    save(folder, "coordinates", &motion)?;
    if let Some(name) = names.output {
        let figure = Figure::new(format!("{}: {name}", names.title)).columns(1);
        let figure = figure
            .panel(panel(format!("{name} (m)"), curves, |record| {
                record.of(name, &record.q)
            }))
            .panel(panel(format!("{name}' (m/s)"), curves, |record| {
                record.of(name, &record.v)
            }))
            .panel(steps(format!("{name}'' (m/s^2)"), curves, |record| {
                record.of(name, &record.accelerations)
            }));
        save(folder, "output", &figure)?;
    }
    for (k, (name, &clearance)) in names.contacts.iter().zip(&names.clearances).enumerate() {
        contact(folder, names, (k, name, clearance), curves)?;
    }
    if !names.reactions {
        return Ok(());
    }
    let loads = pairs(
        &format!("{}: joint forces and torques", names.title),
        &names.joints,
        |name, k| {
            let force = panel(format!("|f| {name} (N)"), curves, |record| record.force.get(k));
            let torque = panel(format!("|n| {name} (N m)"), curves, |record| record.torque.get(k));
            [force, torque]
        },
    );
    save(folder, "joint-loads", &loads)
}

/// Force of a contact point, and path of the journal in a clearance.
fn contact(
    folder: &mut RunFolder,
    names: &Names<'_>,
    (k, name, clearance): (usize, &str, Option<f64>),
    curves: &[Curve<'_>],
) -> Result<(), CliError> {
    let touching = || {
        curves
            .iter()
            .filter_map(|curve| Some((curve, curve.record.contacts.get(k)?)))
    };
    let title = format!("{}: contact {name}", names.title);
    let force = steps("normal force (N)".to_owned(), curves, |record| {
        record.contacts.get(k).map(|contact| &contact.normal)
    });
    save(
        folder,
        &format!("contact-force-{name}"),
        &Figure::new(title.clone()).columns(1).panel(force),
    )?;
    let Some(clearance) = clearance else {
        return Ok(());
    };
    let mut figure = Figure::new(format!("{title}, journal in bearing"))
        .columns(touching().count().max(1))
        .size(PATH_WIDTH * touching().count().max(1) as u32, PATH_HEIGHT);
    for (curve, contact) in touching() {
        let millimetres = |(x, y): (f64, f64)| (1e3 * x, 1e3 * y);
        let circle = (0..=180).map(|i| (TAU * f64::from(i) / 180.0).sin_cos());
        let circle = circle.map(|(s, c)| millimetres((clearance * c, clearance * s)));
        let panel = Panel::new(curve.label.clone(), Axis::linear("y (mm)"), Axis::linear("z (mm)")).equal_axes();
        let path = contact.journal.iter().copied().map(millimetres).collect();
        let panel = panel.series(Series::line("path", 0, path));
        figure = figure.panel(panel.series(Series::line("clearance", 1, circle.collect())));
    }
    save(folder, &format!("journal-path-{name}"), &figure)
}

fn pairs(title: &str, names: &[&str], row: impl Fn(&str, usize) -> [Panel; 2]) -> Figure {
    let rows = names.iter().enumerate().flat_map(|(k, name)| row(name, k));
    rows.fold(Figure::new(title).columns(2), Figure::panel)
}

/// A panel with curves by steps.
fn steps<'a>(label: String, curves: &[Curve<'a>], pick: impl Fn(&'a Record) -> Option<&'a StepCurve>) -> Panel {
    let empty = Panel::new("", Axis::linear("t (s)"), Axis::linear(label));
    curves.iter().fold(empty, |panel, curve| match pick(curve.record) {
        Some(steps) => panel.series(Series::line(curve.label.clone(), curve.style, steps.points.clone())),
        None => panel,
    })
}

fn panel<'a>(label: String, curves: &[Curve<'a>], pick: impl Fn(&'a Record) -> Option<&'a Vec<f64>>) -> Panel {
    let empty = Panel::new("", Axis::linear("t (s)"), Axis::linear(label));
    curves.iter().fold(empty, |panel, curve| match pick(curve.record) {
        Some(values) => {
            let points = curve.record.t.iter().copied().zip(values.iter().copied()).collect();
            panel.series(Series::line(curve.label.clone(), curve.style, points))
        }
        None => panel,
    })
}

pub(crate) fn save(folder: &mut RunFolder, name: &str, figure: &Figure) -> Result<(), CliError> {
    let svg = figure.to_svg()?;
    folder.write(&format!("{name}.png"), crate::figure::svg_to_png(&svg, PNG_SCALE)?)?;
    folder.write(&format!("{name}.svg"), svg)?;
    Ok(())
}

//! The pictures of a run, after Figs. 11 and 12 of the RSRRR paper: coordinates and speeds, joint forces and torques, with the
//! other variant of the scene (friction on or off) in the same panels.

use crate::errors::CliError;
use crate::figure::{Axis, Figure, Panel, Series};
use crate::results::RunFolder;

use super::record::Record;

/// Points a pixel of the PNGs, for print.
const PNG_SCALE: f64 = 2.0;

/// A run as a curve: its name, its style and its record.
pub struct Curve<'a> {
    /// Name in the legend.
    pub label: &'a str,
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
}

/// Draws all pictures into the folder; returns their names without ending.
///
/// # Errors
/// Those of drawing and writing.
pub fn draw(folder: &mut RunFolder, names: &Names<'_>, curves: &[Curve<'_>]) -> Result<(), CliError> {
    let motion = pairs(
        &format!("{}: coordinates and speeds", names.title),
        &names.coordinates,
        |name, k| {
            let q = panel(format!("{name} (rad)"), curves, |record| record.q.get(k));
            let v = panel(format!("{name}' (rad/s)"), curves, |record| record.v.get(k));
            [q, v]
        },
    );
    save(folder, "coordinates", &motion)?;
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

fn pairs(title: &str, names: &[&str], row: impl Fn(&str, usize) -> [Panel; 2]) -> Figure {
    let rows = names.iter().enumerate().flat_map(|(k, name)| row(name, k));
    rows.fold(Figure::new(title).columns(2), Figure::panel)
}

fn panel<'a>(label: String, curves: &[Curve<'a>], pick: impl Fn(&'a Record) -> Option<&'a Vec<f64>>) -> Panel {
    let empty = Panel::new("", Axis::linear("t (s)"), Axis::linear(label));
    curves.iter().fold(empty, |panel, curve| match pick(curve.record) {
        Some(values) => {
            let points = curve.record.t.iter().copied().zip(values.iter().copied()).collect();
            panel.series(Series::line(curve.label, curve.style, points))
        }
        None => panel,
    })
}

fn save(folder: &mut RunFolder, name: &str, figure: &Figure) -> Result<(), CliError> {
    let svg = figure.to_svg()?;
    folder.write(&format!("{name}.png"), crate::figure::svg_to_png(&svg, PNG_SCALE)?)?;
    folder.write(&format!("{name}.svg"), svg)?;
    Ok(())
}

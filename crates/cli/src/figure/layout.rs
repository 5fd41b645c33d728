//! Where everything on a figure goes.

use super::ticks::Ticks;
use super::{Axis, Figure, FigureError, Mark, Panel, Scale};

/// Canvas units per pixel: curves are written as whole numbers of tenths of a pixel.
pub(super) const K: f64 = 10.0;

/// Size of the letters for labels.
pub(super) const LABEL: f64 = 11.5;
/// Size of the letters for numbers.
pub(super) const NUMBER: f64 = 10.5;

/// A box on the page, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

/// A panel with everything that is needed to draw it. Ranges are in the axis' coordinate (logarithms on a logarithmic axis).
pub(super) struct Layout<'f> {
    pub panel: &'f Panel,
    pub plot: Area,
    pub x: (f64, f64),
    pub y: (f64, f64),
    pub x_ticks: Ticks,
    pub y_ticks: Ticks,
    pub numbers_below: bool,
    pub y_label_at: f64,
}

impl Layout<'_> {
    /// Left, right, top and bottom of the plot on the canvas.
    pub fn edges(&self) -> (f64, f64, f64, f64) {
        let Area {
            left,
            top,
            width,
            height,
        } = self.plot;
        (left * K, (left + width) * K, top * K, (top + height) * K)
    }

    pub fn canvas_x(&self, x: f64) -> f64 {
        let (left, right, _, _) = self.edges();
        left + (right - left) * ((x - self.x.0) / (self.x.1 - self.x.0))
    }

    pub fn canvas_y(&self, y: f64) -> f64 {
        let (_, _, top, bottom) = self.edges();
        bottom - (bottom - top) * ((y - self.y.0) / (self.y.1 - self.y.0))
    }

    /// Where an upright line is drawn on the page, in pixels.
    pub fn page_x(&self, x: f64) -> f64 {
        self.canvas_x(x) / K
    }

    /// Where a level line is drawn on the page, in pixels.
    pub fn page_y(&self, y: f64) -> f64 {
        self.canvas_y(y) / K
    }

    pub fn canvas(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (
            self.canvas_x(place(&self.panel.x, x)),
            self.canvas_y(place(&self.panel.y, y)),
        )
    }

    pub fn contains(&self, (x, y): (f64, f64)) -> bool {
        let (left, right, top, bottom) = self.edges();
        (left - 0.5..=right + 0.5).contains(&x) && (top - 0.5..=bottom + 0.5).contains(&y)
    }
}

/// Refuses a panel whose points cannot be drawn.
pub(super) fn check(panel: &Panel) -> Result<(), FigureError> {
    if panel.series.iter().all(|s| s.points.is_empty()) {
        return Err(FigureError::NoPoint { panel: panel.name() });
    }
    for series in &panel.series {
        for (index, &(x, y)) in series.points.iter().enumerate() {
            let names = || (panel.name(), series.label.clone());
            if !(x.is_finite() && y.is_finite()) {
                let (panel, series) = names();
                return Err(FigureError::NotFinite {
                    panel,
                    series,
                    index,
                    x,
                    y,
                });
            }
            for (axis, value) in [(&panel.x, x), (&panel.y, y)] {
                if axis.scale == Scale::Log && value <= 0.0 {
                    let (panel, series) = names();
                    return Err(FigureError::NotPositive {
                        panel,
                        series,
                        index,
                        value,
                    });
                }
            }
        }
    }
    Ok(())
}

/// Where a value lies in the coordinate of its axis.
fn place(axis: &Axis, value: f64) -> f64 {
    match axis.scale {
        Scale::Linear => value,
        Scale::Log => value.log10(),
    }
}

/// The range that one axis needs for the points of several panels.
fn range(
    panels: &[&Panel],
    axis: fn(&Panel) -> &Axis,
    value: fn(&(f64, f64)) -> f64,
    pad: f64,
) -> Result<(f64, f64), FigureError> {
    let axis = axis(panels[0]);
    let refuse = |low, high| FigureError::Range {
        panel: panels[0].name(),
        low,
        high,
    };
    if let Some((low, high)) = axis.range {
        let (a, b) = (place(axis, low), place(axis, high));
        return if a.is_finite() && b.is_finite() && a < b && (b - a).is_finite() {
            Ok((a, b))
        } else {
            Err(refuse(low, high))
        };
    }
    let points = panels.iter().flat_map(|p| &p.series).flat_map(|s| &s.points);
    let (low, high) = points
        .map(|p| place(axis, value(p)))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
    let size = low.abs().max(high.abs());
    let (low, high) = match axis.scale {
        // What differs only by round-off is drawn as constant.
        Scale::Linear if high - low <= 1e-12 * size => {
            let half = if size == 0.0 { 1.0 } else { 0.1 * size };
            (low - half, high + half)
        }
        Scale::Log if high - low < 1e-3 => (low - 0.5, high + 0.5),
        _ => (low - pad * (high - low), high + pad * (high - low)),
    };
    if (high - low).is_finite() && high > low {
        Ok((low, high))
    } else {
        Err(refuse(low, high))
    }
}

/// Places the panels below `top`; gives the height of the page too.
pub(super) fn layout(figure: &Figure, top: f64) -> Result<(Vec<Layout<'_>>, f64), FigureError> {
    let columns = figure.columns.min(figure.panels.len());
    let rows = figure.panels.len().div_ceil(columns);
    let at = |row: usize, column: usize| figure.panels.get(row * columns + column);

    // Panels of one column with the same abscissae share their range, and the numbers below the lowest one.
    let mut groups = vec![0; figure.panels.len()];
    for column in 0..columns {
        for row in 0..rows {
            if let Some(panel) = at(row, column) {
                let above = row.checked_sub(1).and_then(|r| at(r, column));
                let joins = above.is_some_and(|a| a.x == panel.x && !a.equal && !panel.equal);
                let index = row * columns + column;
                groups[index] = if joins { groups[index - columns] } else { index };
            }
        }
    }

    let cell = (f64::from(figure.width) - 14.0) / columns as f64;
    let most_y = (figure.panel_height / 26).clamp(2, 9) as usize;
    let mut axes = Vec::new();
    for (index, panel) in figure.panels.iter().enumerate() {
        let group: Vec<&Panel> = figure
            .panels
            .iter()
            .zip(&groups)
            .filter(|(_, g)| **g == groups[index])
            .map(|(p, _)| p)
            .collect();
        let dots = group.iter().flat_map(|p| &p.series).any(|s| s.mark != Mark::Line);
        let pad = if dots || panel.equal || panel.x.scale == Scale::Log {
            0.04
        } else {
            0.0
        };
        let x = range(&group, |p| &p.x, |p| p.0, pad)?;
        let y = range(&[panel], |p| &p.y, |p| p.1, 0.06)?;
        axes.push((x, y));
    }

    // The room for the numbers left of a column is that of its longest one.
    let room: Vec<f64> = (0..columns)
        .map(|column| {
            let longest = (column..figure.panels.len())
                .step_by(columns)
                .flat_map(|i| {
                    let ticks = Ticks::new(figure.panels[i].y.scale, axes[i].1.0, axes[i].1.1, most_y);
                    ticks
                        .bold
                        .iter()
                        .map(|y| text_width(&ticks.label(*y), NUMBER))
                        .collect::<Vec<_>>()
                })
                .fold(0.0, f64::max);
            longest + 34.0
        })
        .collect();

    let mut layouts = Vec::new();
    let mut y = top;
    for row in 0..rows {
        let panels: Vec<usize> = (0..columns)
            .map(|c| row * columns + c)
            .filter(|i| *i < figure.panels.len())
            .collect();
        let shows = |i: usize| groups.get(i + columns).is_none_or(|g| *g != groups[i]);
        y += if panels.iter().any(|i| !figure.panels[*i].title.is_empty()) {
            22.0
        } else {
            6.0
        };
        for &i in &panels {
            let column = i % columns;
            let panel = &figure.panels[i];
            let left = 4.0 + column as f64 * cell;
            let plot = Area {
                left: (left + room[column]).round(),
                top: y.round(),
                width: (cell - room[column] - 12.0).floor(),
                height: f64::from(figure.panel_height),
            };
            if plot.width < 40.0 {
                return Err(FigureError::Size {
                    width: f64::from(figure.width),
                    height: f64::from(figure.panel_height),
                });
            }
            let ((mut x_range, mut y_range), most_x) = (axes[i], (plot.width / 62.0).clamp(2.0, 12.0) as usize);
            if panel.equal {
                let unit = ((x_range.1 - x_range.0) / plot.width).max((y_range.1 - y_range.0) / plot.height);
                x_range = widened(x_range, unit * plot.width);
                y_range = widened(y_range, unit * plot.height);
            }
            layouts.push(Layout {
                panel,
                plot,
                x: x_range,
                y: y_range,
                x_ticks: Ticks::new(panel.x.scale, x_range.0, x_range.1, most_x),
                y_ticks: Ticks::new(panel.y.scale, y_range.0, y_range.1, most_y),
                numbers_below: shows(i),
                y_label_at: left + 9.0,
            });
        }
        y += f64::from(figure.panel_height) + if panels.iter().any(|i| shows(*i)) { 40.0 } else { 8.0 };
    }
    Ok((layouts, (y + 2.0).ceil()))
}

fn widened((low, high): (f64, f64), span: f64) -> (f64, f64) {
    let more = 0.5 * (span - (high - low)).max(0.0);
    (low - more, high + more)
}

/// Width in pixels that a text takes at most, nearly.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    let narrow = |c: char| ".,·il()¹²³⁻".contains(c) || matches!(c, ' ' | '⁰'..='⁹' | '₀'..='₉');
    let combining = |c: char| ('\u{300}'..='\u{36f}').contains(&c);
    text.chars()
        .filter(|c| !combining(*c))
        .map(|c| if narrow(c) { 0.42 } else { 0.64 } * size)
        .sum()
}

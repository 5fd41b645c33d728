//! A figure as SVG.

use std::collections::HashSet;
use std::fmt::Write;

use svg::Document;
use svg::node::element::{Circle, Group, Path, Polyline, Rectangle, Text, Title};

use super::raster::FONT;
use super::simplify::{Pixel, simplify};
use super::ticks::Ticks;
use super::{Axis, Figure, FigureError, Legend, Mark, Panel, Scale, Series};

/// Canvas units per pixel: curves are written as whole numbers of tenths of a pixel.
const K: f64 = 10.0;
/// Bytes that a file may have for its curves and the axes of its panels, and what each panel's axes take of them.
const CURVE_BYTES: usize = 280_000;
const PANEL_BYTES: usize = 5_000;
/// Largest width or height in pixels.
const MOST_PIXELS: f64 = 20_000.0;

const INK: &str = "#262626";
const FRAME: &str = "#808080";
const GRID: &str = "#e4e4e4";
const FINE_GRID: &str = "#f1f1f1";
const ZERO: &str = "#b8b8b8";

/// Size of the letters for the title, for labels and for numbers.
const TITLE: f64 = 15.0;
const LABEL: f64 = 11.5;
const NUMBER: f64 = 10.5;

/// Colour and dash pattern (in canvas units) of the styles; told apart by colour-blind readers and in grey print.
const STYLES: [(&str, &str); 6] = [
    ("#1b5ea8", ""),
    ("#d1451b", "65 30"),
    ("#1d845b", "100 25 20 25"),
    ("#7d3c98", "20 20"),
    ("#b07d00", "130 40"),
    ("#4a4a4a", "40 20 15 20 15 20"),
];

/// A box on the page, in pixels.
#[derive(Clone, Copy, Debug)]
struct Area {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

/// A panel with everything that is needed to draw it. Ranges are in the axis' coordinate (logarithms on a logarithmic axis).
struct Layout<'f> {
    panel: &'f Panel,
    plot: Area,
    x: (f64, f64),
    y: (f64, f64),
    x_ticks: Ticks,
    y_ticks: Ticks,
    numbers_below: bool,
    y_label_at: f64,
}

/// What a series has become on the canvas.
struct Strokes {
    style: usize,
    lines: Vec<Vec<Pixel>>,
    dots: Vec<Pixel>,
}

pub(super) fn svg(figure: &Figure) -> Result<String, FigureError> {
    if figure.panels.is_empty() {
        return Err(FigureError::NoPanel {
            figure: figure.title.clone(),
        });
    }
    for panel in &figure.panels {
        check(panel)?;
    }
    let legend = legend_entries(figure);
    let title_height = if figure.title.is_empty() { 10.0 } else { 34.0 };
    let legend_height = if legend.is_empty() { 0.0 } else { 24.0 };
    let (layouts, height) = layout(figure, title_height + legend_height)?;
    let width = f64::from(figure.width);
    if !(width >= 100.0 && figure.panel_height >= 20 && width <= MOST_PIXELS && height <= MOST_PIXELS) {
        return Err(FigureError::Size { width, height });
    }
    let strokes = strokes(&layouts);
    let left = layouts[0].plot.left;
    let mut page = Document::new()
        .set("width", width)
        .set("height", height)
        .set("viewBox", (0, 0, width, height))
        .set("role", "img")
        .set("font-family", format!("{FONT}, Verdana, Helvetica, sans-serif"))
        .set("fill", INK)
        .add(Title::new(clean(&figure.title)))
        .add(
            Rectangle::new()
                .set("width", width)
                .set("height", height)
                .set("fill", "#ffffff"),
        )
        .add(text(&figure.title, TITLE, (left, 19.0), "start"))
        .add(legend_row(&legend, (left, title_height + 6.0)));
    for (layout, strokes) in layouts.iter().zip(&strokes) {
        page = page.add(axes(layout)).add(curves(strokes));
        if figure.legend == Legend::Panels && layout.panel.series.len() > 1 {
            page = page.add(panel_legend(layout, strokes));
        }
    }
    Ok(page.to_string())
}

fn check(panel: &Panel) -> Result<(), FigureError> {
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

fn layout(figure: &Figure, top: f64) -> Result<(Vec<Layout<'_>>, f64), FigureError> {
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

/// All series on the canvas, with as many points as the size of the file allows.
fn strokes(layouts: &[Layout<'_>]) -> Vec<Vec<Strokes>> {
    let budget = CURVE_BYTES.saturating_sub(layouts.len() * PANEL_BYTES).max(20_000);
    let mut tolerance = 0.8;
    loop {
        let strokes: Vec<Vec<Strokes>> = layouts
            .iter()
            .map(|layout| {
                layout
                    .panel
                    .series
                    .iter()
                    .map(|series| stroke(layout, series, tolerance))
                    .collect()
            })
            .collect();
        let bytes: usize = strokes
            .iter()
            .flatten()
            .map(|s| s.dots.len() * 40 + s.lines.iter().map(|l| 90 + 11 * l.len()).sum::<usize>())
            .sum();
        // The tolerance is bounded by the size of the canvas, where two points are all that remains.
        if bytes <= budget || tolerance > 1e5 {
            return strokes;
        }
        tolerance *= 1.7;
    }
}

fn stroke(layout: &Layout<'_>, series: &Series, tolerance: f64) -> Strokes {
    let points: Vec<(f64, f64)> = series.points.iter().map(|p| layout.canvas(*p)).collect();
    let line = matches!(series.mark, Mark::Line | Mark::LineAndDots);
    let lines = if line { layout.clipped(&points) } else { Vec::new() };
    let lines = lines
        .iter()
        .map(|l| simplify(l, (4.0 * tolerance) as i32, tolerance))
        .collect();
    let mut dots: Vec<Pixel> = Vec::new();
    if matches!(series.mark, Mark::Dots | Mark::LineAndDots) {
        // Of the dots that cover each other one is drawn.
        let cell = (4.0 * tolerance).max(1.0);
        let mut seen = HashSet::new();
        let shown = points
            .iter()
            .filter(|p| layout.contains(**p))
            .map(|p| (p.0.round() as i32, p.1.round() as i32));
        dots.extend(shown.filter(|p| seen.insert(((f64::from(p.0) / cell) as i64, (f64::from(p.1) / cell) as i64))));
    }
    Strokes {
        style: series.style,
        lines,
        dots,
    }
}

impl Layout<'_> {
    /// Left, right, top and bottom of the plot on the canvas.
    fn edges(&self) -> (f64, f64, f64, f64) {
        let Area {
            left,
            top,
            width,
            height,
        } = self.plot;
        (left * K, (left + width) * K, top * K, (top + height) * K)
    }

    fn canvas_x(&self, x: f64) -> f64 {
        let (left, right, _, _) = self.edges();
        left + (right - left) * ((x - self.x.0) / (self.x.1 - self.x.0))
    }

    fn canvas_y(&self, y: f64) -> f64 {
        let (_, _, top, bottom) = self.edges();
        bottom - (bottom - top) * ((y - self.y.0) / (self.y.1 - self.y.0))
    }

    /// Where an upright line is drawn on the page, in pixels.
    fn page_x(&self, x: f64) -> f64 {
        self.canvas_x(x) / K
    }

    /// Where a level line is drawn on the page, in pixels.
    fn page_y(&self, y: f64) -> f64 {
        self.canvas_y(y) / K
    }

    fn canvas(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (
            self.canvas_x(place(&self.panel.x, x)),
            self.canvas_y(place(&self.panel.y, y)),
        )
    }

    fn contains(&self, (x, y): (f64, f64)) -> bool {
        let (left, right, top, bottom) = self.edges();
        (left - 0.5..=right + 0.5).contains(&x) && (top - 0.5..=bottom + 0.5).contains(&y)
    }

    /// The parts of a polyline that lie in the plot (Liang and Barsky).
    fn clipped(&self, points: &[(f64, f64)]) -> Vec<Vec<Pixel>> {
        let (left, right, top, bottom) = self.edges();
        let mut parts: Vec<Vec<Pixel>> = Vec::new();
        let mut joined = false;
        for pair in points.windows(2) {
            let ((x, y), (dx, dy)) = (pair[0], (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1));
            let (mut from, mut to) = (0.0_f64, 1.0_f64);
            for (d, room) in [(-dx, x - left), (dx, right - x), (-dy, y - top), (dy, bottom - y)] {
                // A hair of room, so that round-off does not cut a curve that runs along the edge.
                let room = room + 0.5;
                if d == 0.0 {
                    if room < 0.0 {
                        to = -1.0;
                    }
                } else if d < 0.0 {
                    from = from.max(room / d);
                } else {
                    to = to.min(room / d);
                }
            }
            if from > to {
                joined = false;
                continue;
            }
            let at = |s: f64| ((x + s * dx).round() as i32, (y + s * dy).round() as i32);
            match parts.last_mut() {
                Some(part) if joined && from == 0.0 => part.push(at(to)),
                _ => parts.push(vec![at(from), at(to)]),
            }
            joined = to == 1.0;
        }
        if let [only] = points
            && self.contains(*only)
        {
            // A single point is a line of a pixel's length, so that it can be seen.
            let (x, y) = (only.0.round() as i32, only.1.round() as i32);
            parts.push(vec![(x - 5, y), (x + 5, y)]);
        }
        parts
    }
}

fn axes(layout: &Layout<'_>) -> Group {
    let Area {
        left,
        top,
        width,
        height,
    } = layout.plot;
    let (right, bottom) = (left + width, top + height);
    let upright = |ticks: &[f64]| {
        lines(
            ticks
                .iter()
                .map(|x| ((layout.page_x(*x), top), (layout.page_x(*x), bottom))),
        )
    };
    let level = |ticks: &[f64]| {
        lines(
            ticks
                .iter()
                .map(|y| ((left, layout.page_y(*y)), (right, layout.page_y(*y)))),
        )
    };
    let mut group = Group::new();
    for (x, y, colour) in [
        (&layout.x_ticks.light, &layout.y_ticks.light, FINE_GRID),
        (&layout.x_ticks.bold, &layout.y_ticks.bold, GRID),
    ] {
        let drawn = upright(x) + &level(y);
        if !drawn.is_empty() {
            group = group.add(Path::new().set("d", drawn).set("stroke", colour));
        }
    }
    if layout.panel.y.scale == Scale::Linear && layout.y.0 < 0.0 && layout.y.1 > 0.0 {
        group = group.add(Path::new().set("d", level(&[0.0])).set("stroke", ZERO));
    }
    let frame = format!("M{left} {top}H{right}V{bottom}H{left}Z");
    let below = layout
        .x_ticks
        .bold
        .iter()
        .map(|x| ((layout.page_x(*x), bottom), (layout.page_x(*x), bottom - 4.0)));
    let beside = layout
        .y_ticks
        .bold
        .iter()
        .map(|y| ((left, layout.page_y(*y)), (left + 4.0, layout.page_y(*y))));
    let marks = frame + &lines(below) + &lines(beside);
    group = group.add(Path::new().set("d", marks).set("stroke", FRAME).set("fill", "none"));

    for &y in &layout.y_ticks.bold {
        group = group.add(text(
            &layout.y_ticks.label(y),
            NUMBER,
            (left - 6.0, layout.page_y(y)),
            "end",
        ));
    }
    if layout.numbers_below {
        for &x in &layout.x_ticks.bold {
            let at = (layout.page_x(x), bottom + 11.0);
            group = group.add(text(&layout.x_ticks.label(x), NUMBER, at, "middle"));
        }
        group = group.add(text(
            &layout.panel.x.label,
            LABEL,
            (left + 0.5 * width, bottom + 28.0),
            "middle",
        ));
    }
    // A label that is longer than its axis is written smaller.
    let label = &layout.panel.y.label;
    let size = (LABEL * (height + 6.0) / text_width(label, LABEL).max(1.0)).clamp(7.0, LABEL);
    let at = (layout.y_label_at, top + 0.5 * height);
    let turn = format!("rotate(-90 {} {})", tenths(at.0), tenths(at.1));
    group
        .add(text(label, size, at, "middle").set("transform", turn))
        .add(text(
            &layout.panel.title,
            LABEL,
            (left + 0.5 * width, top - 9.0),
            "middle",
        ))
}

/// Path data of separate lines, in pixels.
fn lines(ends: impl Iterator<Item = ((f64, f64), (f64, f64))>) -> String {
    let mut data = String::new();
    for ((x, y), (to_x, to_y)) in ends {
        // Writing to a string cannot fail.
        let _ = write!(data, "M{} {}L{} {}", tenths(x), tenths(y), tenths(to_x), tenths(to_y));
    }
    data
}

fn curves(strokes: &[Strokes]) -> Group {
    let mut group = Group::new().set("transform", "scale(0.1)");
    for Strokes { style, lines, dots } in strokes {
        let (colour, dashes) = STYLES[style % STYLES.len()];
        let mut series = Group::new();
        if !lines.is_empty() {
            let mut drawn = Group::new()
                .set("fill", "none")
                .set("stroke", colour)
                .set("stroke-width", 14)
                .set("stroke-linejoin", "round");
            if !dashes.is_empty() {
                drawn = drawn.set("stroke-dasharray", dashes);
            }
            for line in lines {
                let points: Vec<String> = line.iter().map(|(x, y)| format!("{x},{y}")).collect();
                drawn = drawn.add(Polyline::new().set("points", points.join(" ")));
            }
            series = series.add(drawn);
        }
        if !dots.is_empty() {
            let mut drawn = Group::new().set("fill", colour);
            for (x, y) in dots {
                drawn = drawn.add(Circle::new().set("cx", *x).set("cy", *y).set("r", 28));
            }
            series = series.add(drawn);
        }
        group = group.add(series);
    }
    group
}

/// Names and styles for the legend of the figure, each once.
fn legend_entries(figure: &Figure) -> Vec<&Series> {
    let mut entries: Vec<&Series> = Vec::new();
    if figure.legend == Legend::Figure {
        for series in figure
            .panels
            .iter()
            .flat_map(|p| &p.series)
            .filter(|s| !s.label.is_empty())
        {
            if !entries
                .iter()
                .any(|e| e.label == series.label && e.style == series.style)
            {
                entries.push(series);
            }
        }
    }
    entries
}

fn legend_row(entries: &[&Series], (mut x, y): (f64, f64)) -> Group {
    let mut group = Group::new();
    for series in entries {
        group = group.add(legend_entry(series, (x, y)));
        x += 40.0 + text_width(&series.label, LABEL) + 22.0;
    }
    group
}

fn legend_entry(series: &Series, (x, y): (f64, f64)) -> Group {
    let at = |x: f64| ((x * K).round() as i32, (y * K).round() as i32);
    let lines = if series.mark == Mark::Dots {
        Vec::new()
    } else {
        vec![vec![at(x), at(x + 32.0)]]
    };
    let dots = if series.mark == Mark::Line {
        Vec::new()
    } else {
        vec![at(x + 16.0)]
    };
    Group::new()
        .add(curves(&[Strokes {
            style: series.style,
            lines,
            dots,
        }]))
        .add(text(&series.label, LABEL, (x + 40.0, y), "start"))
}

fn panel_legend(layout: &Layout<'_>, strokes: &[Strokes]) -> Group {
    let series: Vec<&Series> = layout.panel.series.iter().filter(|s| !s.label.is_empty()).collect();
    let longest = series.iter().map(|s| text_width(&s.label, LABEL)).fold(0.0, f64::max);
    let (width, height) = ((longest + 54.0).round(), 16.0 * series.len() as f64 + 8.0);
    let plot = layout.plot;
    let (left, right) = (plot.left + 6.0, plot.left + plot.width - width - 6.0);
    let (top, bottom) = (plot.top + 6.0, plot.top + plot.height - height - 6.0);
    // The corner that hides least.
    let hidden = |(x, y): (f64, f64)| {
        let within = |p: &Pixel| {
            (x * K..(x + width) * K).contains(&f64::from(p.0)) && (y * K..(y + height) * K).contains(&f64::from(p.1))
        };
        strokes
            .iter()
            .flat_map(|s| s.lines.iter().flatten().chain(&s.dots))
            .filter(|p| within(p))
            .count()
    };
    let corners = [(right, top), (left, top), (right, bottom), (left, bottom)];
    let corner = corners.into_iter().min_by_key(|c| hidden(*c)).unwrap_or((right, top));
    let ground = Rectangle::new()
        .set("x", corner.0)
        .set("y", corner.1)
        .set("width", width)
        .set("height", height)
        .set("fill", "#ffffff")
        .set("fill-opacity", 0.88);
    let mut group = Group::new().add(ground);
    for (i, series) in series.into_iter().enumerate() {
        group = group.add(legend_entry(
            series,
            (corner.0 + 6.0, corner.1 + 12.0 + 16.0 * i as f64),
        ));
    }
    group
}

/// Text with its middle line at `at`.
fn text(content: &str, size: f64, (x, y): (f64, f64), anchor: &str) -> Text {
    // Half the height of a capital letter, which every reader places alike, other than `dominant-baseline`.
    let baseline = y + 0.36 * size;
    Text::new(clean(content))
        .set("x", tenths(x))
        .set("y", tenths(baseline))
        .set("font-size", tenths(size))
        .set("text-anchor", anchor)
}

/// Text without control characters, for which XML has no place.
fn clean(text: &str) -> String {
    text.chars()
        .map(|c| {
            if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') {
                ' '
            } else {
                c
            }
        })
        .collect()
}

/// Width in pixels that a text takes at most, nearly.
fn text_width(text: &str, size: f64) -> f64 {
    let narrow = |c: char| ".,·il()¹²³⁻".contains(c) || matches!(c, ' ' | '⁰'..='⁹' | '₀'..='₉');
    let combining = |c: char| ('\u{300}'..='\u{36f}').contains(&c);
    text.chars()
        .filter(|c| !combining(*c))
        .map(|c| if narrow(c) { 0.42 } else { 0.64 } * size)
        .sum()
}

/// The number with at most one decimal.
fn tenths(pixels: f64) -> f64 {
    (pixels * K).round() / K
}

//! A figure as SVG.

use std::fmt::Write;

use svg::Document;
use svg::node::element::{Circle, Group, Path, Polyline, Rectangle, Text, Title};

use super::layout::{Area, K, LABEL, Layout, NUMBER, check, layout, text_width};
use super::raster::FONT;
use super::simplify::Pixel;
use super::strokes::{Strokes, strokes};
use super::{Figure, FigureError, Legend, Mark, Scale, Series};

/// Largest width or height in pixels.
const MOST_PIXELS: f64 = 20_000.0;
/// Size of the letters for the title.
const TITLE: f64 = 15.0;

const INK: &str = "#262626";
const FRAME: &str = "#808080";
const GRID: &str = "#e4e4e4";
const FINE_GRID: &str = "#f1f1f1";
const ZERO: &str = "#b8b8b8";

/// Colour and dash pattern (in canvas units) of the styles; told apart by colour-blind readers and in grey print.
const STYLES: [(&str, &str); 10] = [
    ("#1b5ea8", ""),
    ("#d1451b", "65 30"),
    ("#1d845b", "100 25 20 25"),
    ("#7d3c98", "20 20"),
    ("#b07d00", "130 40"),
    ("#4a4a4a", "40 20 15 20 15 20"),
    ("#c2378d", "200 30"),
    ("#0f8f9f", "10 25"),
    ("#6b4a1e", "60 60"),
    ("#5b7f00", "100 20 20 20 20 20"),
];

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
    let drawn: Vec<(f64, f64)> = strokes.iter().flat_map(samples).collect();
    let hidden = |(x, y): (f64, f64)| {
        let within = |p: &&(f64, f64)| (x..x + width).contains(&p.0) && (y..y + height).contains(&p.1);
        drawn.iter().filter(within).count()
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

/// Points on the page along a series, at most five pixels from each other on a line.
fn samples(strokes: &Strokes) -> Vec<(f64, f64)> {
    let page = |p: Pixel| (f64::from(p.0) / K, f64::from(p.1) / K);
    let mut points: Vec<(f64, f64)> = strokes.dots.iter().map(|p| page(*p)).collect();
    for ends in strokes.lines.iter().flat_map(|line| line.windows(2)) {
        let (a, b) = (page(ends[0]), page(ends[1]));
        let parts = ((b.0 - a.0).hypot(b.1 - a.1) / 5.0).ceil().max(1.0) as u32;
        points.extend((0..parts).map(|i| f64::from(i) / f64::from(parts)).map(|s| {
            let at = |a: f64, b: f64| a + s * (b - a);
            (at(a.0, b.0), at(a.1, b.1))
        }));
    }
    points
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
pub(crate) fn clean(text: &str) -> String {
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

/// The number with at most one decimal.
fn tenths(pixels: f64) -> f64 {
    (pixels * K).round() / K
}

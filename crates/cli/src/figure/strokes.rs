//! Points become lines and dots on the canvas, with no more of them than can be seen.

use std::collections::HashSet;

use super::layout::Layout;
use super::simplify::{Pixel, simplify};
use super::{Mark, Series};

/// Bytes that a file may have for its curves and the axes of its panels, and what each panel's axes take of them.
const CURVE_BYTES: usize = 280_000;
const PANEL_BYTES: usize = 5_000;

/// What a series has become on the canvas.
pub(super) struct Strokes {
    pub style: usize,
    pub lines: Vec<Vec<Pixel>>,
    pub dots: Vec<Pixel>,
}

/// All series on the canvas, with as many points as the size of the file allows.
pub(super) fn strokes(layouts: &[Layout<'_>]) -> Vec<Vec<Strokes>> {
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
    let lines = lines.iter().map(|l| simplify(l, tolerance as i32, tolerance)).collect();
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

//! Names beside what they name, where there is place for them.

use svg::node::element::Text;

use super::page::{SIZE, Spot, length};
use crate::figure::{clean, text_width};

/// Size of the letters.
const LETTERS: f64 = 11.0;
/// Distance from the edge of the picture.
const EDGE: f64 = 3.0;

/// What names must not cover.
#[derive(Default)]
pub(super) struct Taken {
    /// Lines.
    pub(super) lines: Vec<[Spot; 2]>,
    /// Centres and radii of symbols.
    pub(super) discs: Vec<([f64; 2], f64)>,
    boxes: Vec<Area>,
}

/// A rectangle by its middle and half its width and height.
#[derive(Clone, Copy)]
struct Area {
    middle: [f64; 2],
    half: [f64; 2],
}

impl Area {
    fn is_on_the_page(&self) -> bool {
        (0..2).all(|k| self.middle[k] - self.half[k] >= EDGE && self.middle[k] + self.half[k] <= SIZE[k] - EDGE)
    }

    /// The nearest place in it.
    fn nearest(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let within = |value: f64, k: usize| value.clamp(self.middle[k] - self.half[k], self.middle[k] + self.half[k]);
        [within(x, 0), within(y, 1)]
    }

    fn meets(&self, other: &Self) -> bool {
        (0..2).all(|k| (self.middle[k] - other.middle[k]).abs() < self.half[k] + other.half[k])
    }
}

impl Taken {
    /// How much would be covered, in pixels of lines nearly; none if it is another name or beyond the page.
    fn cost(&self, area: &Area) -> Option<f64> {
        if !area.is_on_the_page() || self.boxes.iter().any(|other| area.meets(other)) {
            return None;
        }
        let mut cost = 0.0;
        for (centre, radius) in &self.discs {
            cost += (radius - length(area.nearest(*centre), *centre)).max(0.0) * 2.0;
        }
        for line in &self.lines {
            // Half of a line's width is its own.
            let steps = (length([line[0][0], line[0][1]], [line[1][0], line[1][1]]) / 2.0)
                .ceil()
                .max(1.0) as u32;
            let places = (0..=steps).map(|k| {
                let share = f64::from(k) / f64::from(steps);
                [0, 1].map(|k| line[0][k] + share * (line[1][k] - line[0][k]))
            });
            cost += 2.0 * places.filter(|at| length(area.nearest(*at), *at) < 3.0).count() as f64;
        }
        Some(cost)
    }

    /// The first of the areas that cover least; what covers more than `most` is no place.
    fn best(&self, areas: impl Iterator<Item = Area>, most: f64) -> Option<Area> {
        let rated = areas.filter_map(|area| Some((self.cost(&area)?, area)));
        let best = rated.reduce(|best, next| if next.0 < best.0 { next } else { best });
        best.filter(|(cost, _)| *cost <= most).map(|(_, area)| area)
    }

    /// Takes an area of half this width and height in the corner of the page where it covers least; its middle.
    pub(super) fn corner(&mut self, half: [f64; 2]) -> [f64; 2] {
        // A little within the page, whatever is rounded.
        let low = half.map(|half| EDGE + 1.0 + half);
        let high = [0, 1].map(|k| SIZE[k] - low[k]);
        let corners = [[low[0], high[1]], high, low, [high[0], low[1]]];
        let areas = corners.map(|middle| Area { middle, half });
        let area = self.best(areas.into_iter(), f64::INFINITY).unwrap_or(areas[0]);
        self.boxes.push(area);
        area.middle
    }

    /// A name around a symbol of the radius.
    pub(super) fn around(&mut self, name: &str, at: [f64; 2], radius: f64, colour: &str) -> Option<Text> {
        let half = half_size(name);
        let side = |way: f64| if way == 0.0 { 0.0 } else { way.signum() };
        let ways: [[f64; 2]; 8] = [
            [0.0, -1.0],
            [1.0, -0.7],
            [-1.0, -0.7],
            [1.0, 0.7],
            [-1.0, 0.7],
            [1.0, 0.0],
            [-1.0, 0.0],
            [0.0, 1.0],
        ];
        // Not beyond the edge of the page, if that is what keeps a long name from its place.
        let within = |x: f64, k: usize| {
            let low = EDGE + 1.0 + half[k];
            x.max(low).min(SIZE[k] - low)
        };
        let areas = [4.0, 9.0, 16.0].into_iter().flat_map(|gap| {
            ways.map(|way| Area {
                middle: [0, 1].map(|k| within(at[k] + way[k] * (radius + gap) + side(way[k]) * half[k], k)),
                half,
            })
        });
        let area = self.best(areas, 16.0)?;
        Some(self.write(name, area, colour))
    }

    /// A name along a line.
    pub(super) fn along(&mut self, name: &str, line: [Spot; 2], colour: &str) -> Option<Text> {
        let half = half_size(name);
        let way = [line[1][0] - line[0][0], line[1][1] - line[0][1]];
        let size = f64::hypot(way[0], way[1]);
        if size < 20.0 {
            return None;
        }
        let across = [-way[1] / size, way[0] / size];
        // As far aside as keeps the letters off the line.
        let gap = half[0] * across[0].abs() + half[1] * across[1].abs() + 5.0;
        let areas = [0.5, 0.4, 0.6, 0.3, 0.7].into_iter().flat_map(|share| {
            [1.0, -1.0].map(|side| Area {
                middle: [0, 1].map(|k| line[0][k] + share * way[k] + side * gap * across[k]),
                half,
            })
        });
        let area = self.best(areas, 2.0)?;
        Some(self.write(name, area, colour))
    }

    fn write(&mut self, name: &str, area: Area, colour: &str) -> Text {
        self.boxes.push(area);
        letters(name, area.middle, colour)
    }
}

fn half_size(name: &str) -> [f64; 2] {
    [0.5 * text_width(name, LETTERS) + 1.0, 0.5 * LETTERS]
}

/// Letters about a middle, on paper of their own.
pub(super) fn letters(text: &str, [x, y]: [f64; 2], colour: &str) -> Text {
    Text::new(clean(text))
        .set("x", format!("{x:.1}"))
        // Half the height of a capital letter.
        .set("y", format!("{:.1}", y + 0.36 * LETTERS))
        .set("font-size", LETTERS)
        .set("text-anchor", "middle")
        .set("fill", colour)
        .set("stroke", "#ffffff")
        .set("stroke-width", 3)
        .set("stroke-linejoin", "round")
        .set("paint-order", "stroke")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_avoid_lines_symbols_each_other_and_the_edge() {
        let mut taken = Taken::default();
        let at = [200.0, 100.0];
        taken.lines.push([[200.0, 100.0, 0.0], [200.0, 20.0, 0.0]]);
        taken.discs.push(([212.0, 92.0], 8.0));
        assert!(taken.around("name", at, 8.0, "#000000").is_some());
        // Neither above, where the line is, nor to the right, where the symbol is.
        assert!(taken.boxes[0].middle[0] < 190.0, "{:?}", taken.boxes[0].middle);
        assert!(taken.around("name", at, 8.0, "#000000").is_some());
        assert_eq!(taken.boxes.len(), 2);
        assert!(!taken.boxes[0].meets(&taken.boxes[1]));
        // All around is taken.
        let mut full = Taken::default();
        full.boxes.push(Area {
            middle: at,
            half: [200.0, 90.0],
        });
        assert!(full.around("name", at, 8.0, "#000000").is_none());
        assert!(full.around("name", [416.0, 296.0], 8.0, "#000000").is_some(), "inward");
    }
}

//! How links, joints, springs and the ground are drawn. Places are in pixels of the page, downward positive; directions are shorter than
//! one on the page where they point to the eye, their third number, or away.

use linkdyn_mechanisms::kinematics::Joint;
use nalgebra::Vector3;
use std::fmt::Write;
use svg::node::element::{Circle, Group, Path};

use super::page::Spot;

type Point = [f64; 2];

pub(super) const INK: &str = "#262626";
const PAPER: &str = "#ffffff";
/// Half the size of a joint's symbol.
pub(super) const RADIUS: f64 = 6.0;
/// Half the length of a barrel, and of the block of a slide.
const BARREL: f64 = 9.0;
const BLOCK: [f64; 2] = [14.0, 8.0];
/// Radius of a mass at an end of a link.
pub(super) const MASS: f64 = 13.0;
/// Width of a link's line.
const BAR: f64 = 5.0;

fn d(points: &[Point], closed: bool) -> String {
    let mut text = String::new();
    for (k, [x, y]) in points.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = write!(text, "{}{x:.1} {y:.1}", if k == 0 { 'M' } else { 'L' });
    }
    if closed {
        text.push('Z');
    }
    text
}

pub(super) fn line(points: &[Point], colour: &str, width: f64) -> Path {
    Path::new()
        .set("d", d(points, false))
        .set("fill", "none")
        .set("stroke", colour)
        .set("stroke-width", width)
        .set("stroke-linecap", "round")
        .set("stroke-linejoin", "round")
}

fn plate(points: &[Point], fill: &str, stroke: &str, width: f64) -> Path {
    Path::new()
        .set("d", d(points, true))
        .set("fill", fill)
        .set("stroke", stroke)
        .set("stroke-width", width)
        .set("stroke-linejoin", "round")
}

fn disc([x, y]: Point, radius: f64, fill: &str) -> Circle {
    Circle::new()
        .set("cx", format!("{x:.1}"))
        .set("cy", format!("{y:.1}"))
        .set("r", radius)
        .set("fill", fill)
        .set("stroke", INK)
        .set("stroke-width", 1.5)
}

/// A bracket with hatching below a point of the ground.
pub(super) fn ground([x, y]: Point) -> Group {
    let foot = y + 18.0;
    let bracket = plate(&[[x, y], [x - 11.0, foot], [x + 11.0, foot]], "#eeeeee", INK, 1.0);
    hatched(Group::new().add(bracket), [x, foot], [1.0, 0.0], 15.0)
}

/// A line through `middle`, hatched on the side of the ground.
fn hatched(group: Group, middle: Point, along: Point, half: f64) -> Group {
    let at = |k: f64| [middle[0] + k * along[0], middle[1] + k * along[1]];
    let mut group = group.add(line(&[at(-half), at(half)], INK, 1.5));
    let mut from = -half + 3.0;
    while from <= half {
        group = group.add(line(&[at(from), aside(at(from - 5.0), along, 5.0)], INK, 1.0));
        from += 6.0;
    }
    group
}

/// The bed on the ground of what slides at a place, beyond the block on both sides, and its edge; none where it points to the eye.
pub(super) fn bed(at: Point, axis: Spot) -> Option<(Group, [Spot; 2])> {
    let size = f64::hypot(axis[0], axis[1]);
    if size < 0.1 {
        return None;
    }
    let along = [axis[0] / size, axis[1] / size];
    let middle = aside(at, along, BLOCK[1] + 2.0);
    let half = 2.4 * BLOCK[0] * size.max(0.5);
    let ends = [-half, half].map(|k| [middle[0] + k * along[0], middle[1] + k * along[1]]);
    let edge = ends.map(|end| aside(end, along, 3.0)).map(|[x, y]| [x, y, 0.0]);
    Some((hatched(Group::new(), middle, along, half), edge))
}

/// A place moved off a line to the side of the ground: below, or to the right of an upright one.
fn aside([x, y]: Point, along: Point, way: f64) -> Point {
    let side = if along[0] < 0.0 { -way } else { way };
    [x - side * along[1], y + side * along[0]]
}

/// What the ground holds, so that it is seen as one; its edges.
pub(super) fn base(feet: &[Spot]) -> (Path, Vec<[Spot; 2]>) {
    let hull = hull(feet);
    let seen: Vec<Point> = hull.iter().map(|p| [p[0], p[1]]).collect();
    let shape = line(&seen, "#a8a8a8", 1.2)
        .set("d", d(&seen, seen.len() > 2))
        .set("fill", if seen.len() > 2 { "#f4f4f4" } else { "none" })
        .set("stroke-dasharray", "5 4");
    (shape, edges(&hull))
}

/// A line, or a plate round all corners; its edges.
pub(super) fn link(corners: &[Spot], colour: &str) -> (Group, Vec<[Spot; 2]>) {
    let hull = hull(corners);
    let seen: Vec<Point> = hull.iter().map(|p| [p[0], p[1]]).collect();
    let shape = match hull.len() {
        0..=2 => line(&seen, colour, BAR),
        _ => plate(&seen, colour, colour, BAR).set("fill-opacity", 0.25),
    };
    (Group::new().add(shape), edges(&hull))
}

fn edges(hull: &[Spot]) -> Vec<[Spot; 2]> {
    let mut edges: Vec<[Spot; 2]> = hull.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    if let ([first, .., last], true) = (hull, hull.len() > 2) {
        edges.push([*last, *first]);
    }
    edges
}

/// A piece of a link's edge that passes over something else.
pub(super) fn bridge(at: Point, edge: [Spot; 2], colour: &str) -> Group {
    let way = [edge[1][0] - edge[0][0], edge[1][1] - edge[0][1]];
    let size = f64::hypot(way[0], way[1]);
    let piece = |half: f64| [-half, half].map(|k| [0, 1].map(|i| at[i] + k * way[i] / size));
    let gap = line(&piece(8.0), PAPER, BAR + 5.0).set("stroke-linecap", "butt");
    Group::new().add(gap).add(line(&piece(9.0), colour, BAR))
}

/// The convex hull on the page, by Andrew's monotone chain.
fn hull(points: &[Spot]) -> Vec<Spot> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    // A tenth of a pixel is what the picture tells apart.
    sorted.dedup_by(|a, b| f64::hypot(a[0] - b[0], a[1] - b[1]) < 0.1);
    if sorted.len() < 3 {
        return sorted;
    }
    let chain = |points: &mut dyn Iterator<Item = Spot>| {
        let mut chain: Vec<Spot> = Vec::new();
        for c in points {
            while let [.., a, b] = chain[..]
                && (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 1.0
            {
                chain.pop();
            }
            chain.push(c);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut sorted.iter().copied());
    hull.extend(chain(&mut sorted.iter().rev().copied()));
    hull
}

/// The mass at an end of a link.
pub(super) fn mass(at: Point, colour: &str) -> Circle {
    disc(at, MASS, colour).set("stroke", colour)
}

/// A zigzag between two points.
pub(super) fn spring([from, to]: [Point; 2]) -> Path {
    let way = [to[0] - from[0], to[1] - from[1]];
    let length = f64::hypot(way[0], way[1]);
    let across = if length > 0.0 {
        [-way[1] / length, way[0] / length]
    } else {
        [0.0; 2]
    };
    // Straight ends, and between them whole teeth of some ten pixels.
    let quarters = 4 * (0.6 * length / 10.0).clamp(2.0, 20.0) as usize;
    let mut points = vec![from];
    for (k, side) in [0.0, 8.0, 0.0, -8.0].into_iter().cycle().take(quarters + 1).enumerate() {
        let share = 0.2 + 0.6 * k as f64 / quarters as f64;
        points.push([0, 1].map(|i| from[i] + share * way[i] + side * across[i]));
    }
    points.push(to);
    line(&points, INK, 1.3)
}

/// An ellipse of half axes `small` along `along` and `large` across.
fn ellipse(middle: Point, along: Point, small: f64, large: f64) -> Path {
    let across = [-along[1], along[0]];
    let end = |side: f64| [0, 1].map(|i| middle[i] + side * large * across[i]);
    let ([x, y], [u, v]) = (end(-1.0), end(1.0));
    let turn = along[1].atan2(along[0]).to_degrees();
    let arc = format!("A{small:.1} {large:.1} {turn:.1} 1 1");
    Path::new()
        .set("d", format!("M{x:.1} {y:.1}{arc} {u:.1} {v:.1}{arc} {x:.1} {y:.1}Z"))
        .set("fill", PAPER)
        .set("stroke", INK)
        .set("stroke-width", 1.5)
}

/// A barrel about an axis, its end towards the eye open; a disc where the axis points to the eye.
fn barrel(at: Point, axis: Spot) -> Group {
    let size = f64::hypot(axis[0], axis[1]);
    let pin = |middle: Point| disc(middle, 1.5, INK).set("stroke", "none");
    if size < 0.05 {
        return Group::new().add(disc(at, RADIUS, PAPER)).add(pin(at));
    }
    // The end that is nearer to the eye.
    let side = if axis[2] < 0.0 { -1.0 } else { 1.0 };
    let along = [axis[0] / size, axis[1] / size].map(|x| side * x);
    let across = [-along[1], along[0]];
    let small = RADIUS * (1.0 - size * size).max(0.0).sqrt();
    let point = |a: f64, b: f64| [0, 1].map(|i| at[i] + a * along[i] + b * across[i]);
    let half = BARREL * size;
    let sides = [
        point(half, -RADIUS),
        point(-half, -RADIUS),
        point(-half, RADIUS),
        point(half, RADIUS),
    ];
    let back = ellipse(point(-half, 0.0), along, small, RADIUS);
    let front = point(half, 0.0);
    Group::new()
        .add(back)
        .add(plate(&sides, PAPER, "none", 0.0))
        .add(line(&sides[..2], INK, 1.5))
        .add(line(&sides[2..], INK, 1.5))
        .add(ellipse(front, along, small, RADIUS))
        .add(pin(front))
}

/// A block that slides along an axis, in the colour of what slides.
fn block(at: Point, axis: Spot, colour: &str) -> Group {
    let size = f64::hypot(axis[0], axis[1]);
    let along = if size > 1e-3 {
        [axis[0] / size, axis[1] / size]
    } else {
        [1.0, 0.0]
    };
    let half = BLOCK[0] * size.max(0.5);
    let across = [-along[1], along[0]];
    let corner = |a: f64, b: f64| [0, 1].map(|i| at[i] + a * along[i] + b * across[i]);
    let corners = [
        corner(-half, -BLOCK[1]),
        corner(half, -BLOCK[1]),
        corner(half, BLOCK[1]),
        corner(-half, BLOCK[1]),
    ];
    Group::new()
        .add(plate(&corners, PAPER, colour, 2.0))
        .add(plate(&corners, colour, "none", 0.0).set("fill-opacity", 0.25))
}

/// The symbol of a joint at a place; `along` turns an axis of its frame into a direction on the page, `colour` is that of its successor.
pub(super) fn joint(joint: &Joint, at: Point, along: impl Fn(Vector3<f64>) -> Spot, colour: &str) -> Group {
    let pin = |axis: Vector3<f64>| {
        let axis = along(axis);
        let ends = [-12.0, 12.0].map(|k| [at[0] + k * axis[0], at[1] + k * axis[1]]);
        let group = Group::new().add(line(&ends, INK, 3.0));
        ends.into_iter()
            .fold(group, |group, end| group.add(disc(end, 2.5, INK)))
    };
    let group = Group::new();
    match joint {
        Joint::Revolute { axis } => group.add(barrel(at, along(**axis))),
        Joint::Universal { first, second } => group
            .add(disc(at, RADIUS + 2.0, PAPER))
            .add(pin(**first))
            .add(pin(**second)),
        Joint::Prismatic { axis } => group.add(block(at, along(**axis), colour)),
        Joint::Cylindrical { axis } => group.add(block(at, along(**axis), colour)).add(disc(at, 3.0, PAPER)),
        Joint::Screw { axis, .. } => {
            let axis = along(**axis);
            let thread = [-5.0, 0.0, 5.0].map(|k| [0, 1].map(|i| at[i] + k * axis[i]));
            let leaning = |[x, y]: Point| line(&[[x - 3.0, y + 5.0], [x + 3.0, y - 5.0]], INK, 1.3);
            let group = group.add(block(at, axis, colour));
            thread.into_iter().fold(group, |group, at| group.add(leaning(at)))
        }
        Joint::Spherical | Joint::SphericalZyx => {
            let light = disc([at[0] - 2.0, at[1] - 2.0], 1.6, PAPER).set("stroke", "none");
            group.add(disc(at, RADIUS, INK)).add(light)
        }
        Joint::Planar { .. } | Joint::Fixed | Joint::Free => {
            let fill = if matches!(joint, Joint::Fixed) { INK } else { PAPER };
            let corner = |a: f64, b: f64| [at[0] + a * RADIUS, at[1] + b * RADIUS];
            let square = [
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ];
            group.add(plate(&square, fill, INK, 1.5))
        }
    }
}

/// The gap of a joint with clearance, as a ring about its symbol.
pub(super) fn gap(at: Point) -> Circle {
    disc(at, RADIUS + 9.0, "none")
        .set("stroke", "#c2378d")
        .set("stroke-dasharray", "4 3")
}

/// An arrow from a place.
pub(super) fn arrow(from: Point, way: Point) -> Group {
    let size = f64::hypot(way[0], way[1]);
    let tip = [from[0] + way[0], from[1] + way[1]];
    let group = Group::new().add(line(&[from, tip], INK, 1.2));
    if size < 6.0 {
        return group;
    }
    let along = [way[0] / size, way[1] / size];
    let barb = |side: f64| {
        [
            tip[0] - 5.0 * along[0] - side * along[1],
            tip[1] - 5.0 * along[1] + side * along[0],
        ]
    };
    group.add(plate(&[tip, barb(2.5), barb(-2.5)], INK, INK, 0.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hulls_leave_out_what_lies_inside_or_on_a_line() {
        let square = [[0.0, 0.0, 1.0], [40.0, 0.0, 2.0], [40.0, 40.0, 3.0], [0.0, 40.0, 4.0]];
        let with = |more: &[Spot]| hull(&[&square[..], more].concat());
        assert_eq!(with(&[]).len(), 4);
        assert_eq!(with(&[[20.0, 20.0, 0.0], [20.0, 0.0, 0.0], [40.0, 40.0, 0.0]]).len(), 4);
        assert_eq!(with(&[[20.0, -20.0, 0.0]]).len(), 5);
        assert_eq!(
            hull(&[[0.0, 0.0, 0.0], [20.0, 20.0, 2.0], [10.0, 10.0, 1.0]]),
            [[0.0, 0.0, 0.0], [20.0, 20.0, 2.0]]
        );
        assert!(hull(&[]).is_empty());
    }

    #[test]
    fn plates_have_as_many_edges_as_corners_and_bars_one() {
        let corners = [[0.0, 0.0, 1.0], [40.0, 0.0, 2.0], [40.0, 40.0, 3.0]];
        assert_eq!(link(&corners, INK).1.len(), 3);
        assert_eq!(link(&corners[..2], INK).1, [[corners[0], corners[1]]]);
        assert!(link(&corners[..1], INK).1.is_empty());
    }
}

//! How links, joints, springs and the ground are drawn. Points are in pixels of the page, downward positive.

use linkdyn_mechanisms::kinematics::Joint;
use nalgebra::Vector3;
use std::fmt::Write;
use svg::node::element::{Circle, Group, Path};

type Point = [f64; 2];

const INK: &str = "#262626";
const PAPER: &str = "#ffffff";
/// Half the size of a joint's symbol.
const RADIUS: f64 = 6.0;

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

fn line(points: &[Point], colour: &str, width: f64) -> Path {
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
    let foot = y + 16.0;
    let mut group = Group::new()
        .add(plate(
            &[[x, y], [x - 11.0, foot], [x + 11.0, foot]],
            "#eeeeee",
            INK,
            1.0,
        ))
        .add(line(&[[x - 15.0, foot], [x + 15.0, foot]], INK, 1.5));
    for k in 0..5 {
        let from = x - 12.0 + 6.0 * f64::from(k);
        group = group.add(line(&[[from, foot], [from - 5.0, foot + 5.0]], INK, 1.0));
    }
    group
}

/// A line, or a plate round all corners.
pub(super) fn link(corners: &[Point], colour: &str) -> Group {
    let hull = hull(corners);
    Group::new().add(match hull.len() {
        0..=2 => line(&hull, colour, 5.0),
        _ => plate(&hull, colour, colour, 5.0).set("fill-opacity", 0.25),
    })
}

/// The convex hull, by Andrew's monotone chain.
fn hull(points: &[Point]) -> Vec<Point> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    // A tenth of a pixel is what the picture tells apart.
    sorted.dedup_by(|a, b| f64::hypot(a[0] - b[0], a[1] - b[1]) < 0.1);
    if sorted.len() < 3 {
        return sorted;
    }
    let chain = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
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

/// The mass at the free end of a link.
pub(super) fn mass(at: Point, colour: &str) -> Circle {
    disc(at, 8.0, colour).set("stroke", colour)
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
    // Straight ends, and between them three teeth to either side.
    let mut points = vec![from];
    for (k, side) in [0.0, 6.0, 0.0, -6.0].into_iter().cycle().take(13).enumerate() {
        let share = 0.2 + 0.05 * k as f64;
        points.push([0, 1].map(|i| from[i] + share * way[i] + side * across[i]));
    }
    points.push(to);
    line(&points, INK, 1.5)
}

/// The symbol of a joint whose sides lie at `places`; `along` turns an axis of its frame into a direction on the page.
pub(super) fn joint(joint: &Joint, places: [Point; 2], along: impl Fn(Vector3<f64>) -> Point) -> Group {
    let [on_predecessor, at] = places;
    // Far from both ends the symbols of other joints do not hide that of a slide.
    let slide = [0, 1].map(|i| 0.5 * (on_predecessor[i] + at[i]));
    let ends = |axis: Point, half: f64| [-half, half].map(|k| [at[0] + k * axis[0], at[1] + k * axis[1]]);
    let pin = |axis: Vector3<f64>| line(&ends(along(axis), 13.0), INK, 2.0);
    let group = Group::new();
    match joint {
        Joint::Revolute { axis } => group.add(pin(**axis)).add(disc(at, RADIUS, PAPER)),
        Joint::Universal { first, second } => {
            let round = group.add(disc(at, RADIUS + 2.0, PAPER));
            round.add(pin(**first)).add(pin(**second))
        }
        Joint::Prismatic { axis } | Joint::Cylindrical { axis } | Joint::Screw { axis, .. } => {
            let seen = along(**axis);
            let rail = line(&[on_predecessor, at], INK, 1.0).set("stroke-dasharray", "4 3");
            let length = f64::hypot(seen[0], seen[1]);
            let across = if length > 1e-3 {
                [-seen[1] / length, seen[0] / length]
            } else {
                [1.0, 0.0]
            };
            let corner = |a: f64, b: f64| [0, 1].map(|i| slide[i] + a * seen[i] + b * across[i]);
            let group = group
                .add(rail)
                .add(line(&[corner(-26.0, 0.0), corner(26.0, 0.0)], INK, 1.0));
            let block = [
                corner(-12.0, -6.0),
                corner(12.0, -6.0),
                corner(12.0, 6.0),
                corner(-12.0, 6.0),
            ];
            let group = group.add(plate(&block, PAPER, INK, 1.5));
            match joint {
                Joint::Cylindrical { .. } => group.add(disc(slide, 3.0, PAPER)),
                Joint::Screw { .. } => group.add(line(&[corner(-6.0, 6.0), corner(6.0, -6.0)], INK, 1.5)),
                _ => group,
            }
        }
        Joint::Spherical | Joint::SphericalZyx => group.add(disc(at, RADIUS, INK)),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hulls_leave_out_what_lies_inside_or_on_a_line() {
        let square = [[0.0, 0.0], [40.0, 0.0], [40.0, 40.0], [0.0, 40.0]];
        let with = |more: &[Point]| hull(&[&square[..], more].concat());
        assert_eq!(with(&[]).len(), 4);
        assert_eq!(with(&[[20.0, 20.0], [20.0, 0.0], [40.0, 40.0]]).len(), 4);
        assert_eq!(with(&[[20.0, -20.0]]).len(), 5);
        assert_eq!(
            hull(&[[0.0, 0.0], [20.0, 20.0], [10.0, 10.0]]),
            [[0.0, 0.0], [20.0, 20.0]]
        );
        assert!(hull(&[]).is_empty());
    }
}

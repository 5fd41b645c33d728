//! From points in space to the page: where it is looked at from, how large, and how deep.

use linkdyn_mechanisms::Skeleton;
use nalgebra::Vector3;

use super::shape::{axis, corners, is_drawn, points};
use super::view::View;

/// Width and height of a picture, and the margin in it that symbols and names need.
pub(super) const SIZE: [f64; 2] = [420.0, 300.0];
const MARGIN: f64 = 44.0;

/// A place on the page, downward positive, and how near to the eye it is; all in pixels.
pub(super) type Spot = [f64; 3];

/// From points of the ground's axes to the page.
pub(super) struct Page {
    pub(super) view: View,
    scale: f64,
    shift: [f64; 2],
}

impl Page {
    /// The page that everything drawn of a linkage fills.
    pub(super) fn new(view: View, skeleton: &Skeleton) -> Self {
        let seen: Vec<[f64; 2]> = points(skeleton).map(|p| view.see(p)).collect();
        let range = |k: usize| {
            let range = seen.iter().map(|p| p[k]);
            range.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            })
        };
        let (x, y) = (range(0), range(1));
        let fit = |(low, high): (f64, f64), size: f64| (size - 2.0 * MARGIN) / (high - low);
        let scale = fit(x, SIZE[0]).min(fit(y, SIZE[1]));
        // One point, or none.
        let scale = if scale.is_finite() { scale } else { 1.0 };
        let middle = |(low, high): (f64, f64)| if low <= high { 0.5 * (low + high) } else { 0.0 };
        Self {
            view,
            scale,
            shift: [0.5 * SIZE[0] - scale * middle(x), 0.5 * SIZE[1] + scale * middle(y)],
        }
    }

    /// The page of a linkage from where it is seen best.
    pub(super) fn best(skeleton: &Skeleton, gravity: Vector3<f64>) -> Self {
        if let Some(view) = View::planar(skeleton, gravity) {
            return Self::new(view, skeleton);
        }
        let pages = View::around(gravity).map(|view| Self::new(view, skeleton));
        // Of views that are alike the first: a pixel more must be gained by a step aside.
        let rated = pages
            .enumerate()
            .map(|(k, page)| (page.crowding(skeleton) + 1e-3 * k as f64, page));
        let best = rated.reduce(|best, next| if next.0 < best.0 { next } else { best });
        best.map_or_else(|| Self::new(View::front(), skeleton), |(_, page)| page)
    }

    /// How much is hidden: joints close to other joints and to links that do not end there, ways of slides.
    fn crowding(&self, skeleton: &Skeleton) -> f64 {
        let mut joints: Vec<Vector3<f64>> = Vec::new();
        for joint in skeleton.joints.iter().filter(|j| is_drawn(j)) {
            for frame in &joint.frames {
                if joints.iter().all(|p| (p - frame.origin).norm() * self.scale > 1.0) {
                    joints.push(frame.origin);
                }
            }
        }
        // Two symbols' radii apart is as good as anywhere.
        let near = |distance: f64| (-distance / 12.0).exp();
        let mut crowding = 0.0;
        for (k, one) in joints.iter().enumerate() {
            for two in &joints[..k] {
                crowding += near(length(self.place(*one), self.place(*two)));
            }
        }
        // Slides whose way points to the eye are hidden as well.
        for joint in skeleton.joints.iter().filter(|j| is_drawn(j)) {
            if let Some(way) = axis(&joint.joint) {
                let [x, y, _] = self.direction(joint.frames[0].rotation * way);
                crowding += 0.5 * (1.0 - f64::hypot(x, y));
            }
        }
        for link in 0..skeleton.links.len() {
            let corners = corners(skeleton, link);
            let [Some(first), Some(last)] = [corners.first(), corners.last()] else {
                continue;
            };
            let ends = [self.spot(*first), self.spot(*last)];
            for joint in &joints {
                let elsewhere = corners.iter().all(|p| (p - joint).norm() * self.scale > 1.0);
                if elsewhere && corners.len() < 4 {
                    crowding += near(beside(self.place(*joint), ends));
                }
            }
        }
        crowding
    }

    /// A point on the page.
    pub(super) fn place(&self, point: Vector3<f64>) -> [f64; 2] {
        let [x, y] = self.view.see(point);
        [self.shift[0] + self.scale * x, self.shift[1] - self.scale * y]
    }

    /// A point on the page with its depth.
    pub(super) fn spot(&self, point: Vector3<f64>) -> Spot {
        let [x, y] = self.place(point);
        [x, y, self.scale * self.view.depth(point)]
    }

    /// A direction, shorter than one on the page where it points to the eye or away.
    pub(super) fn direction(&self, direction: Vector3<f64>) -> Spot {
        let [x, y] = self.view.see(direction);
        [x, -y, self.view.depth(direction)]
    }
}

/// Distance on the page.
pub(super) fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
    f64::hypot(a[0] - b[0], a[1] - b[1])
}

/// Distance of a place from a line between two others.
pub(super) fn beside(at: [f64; 2], [from, to]: [Spot; 2]) -> f64 {
    let way = [to[0] - from[0], to[1] - from[1]];
    let square = way[0] * way[0] + way[1] * way[1];
    let share = ((at[0] - from[0]) * way[0] + (at[1] - from[1]) * way[1]) / square;
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    length(at, [0, 1].map(|k| from[k] + share * way[k]))
}

/// Where two lines cross on the page, away from their ends, and which of them is nearer to the eye there: the first?
pub(super) fn crossing(one: [Spot; 2], two: [Spot; 2]) -> Option<([f64; 2], bool)> {
    let way = |line: [Spot; 2]| [0, 1, 2].map(|k| line[1][k] - line[0][k]);
    let (a, b) = (way(one), way(two));
    let across = a[0] * b[1] - a[1] * b[0];
    let gap = [0, 1].map(|k| two[0][k] - one[0][k]);
    let s = (gap[0] * b[1] - gap[1] * b[0]) / across;
    let t = (gap[0] * a[1] - gap[1] * a[0]) / across;
    // Less than a tenth of a right angle is no crossing that could be told apart.
    let steep = across.abs() > 0.15 * f64::hypot(a[0], a[1]) * f64::hypot(b[0], b[1]);
    let within = |share: f64, way: [f64; 3]| {
        let ends = 6.0 / f64::hypot(way[0], way[1]);
        share > ends && share < 1.0 - ends
    };
    let depth = one[0][2] + s * a[2] - two[0][2] - t * b[2];
    let crosses = steep && within(s, a) && within(t, b) && depth.abs() > 1.0;
    crosses.then(|| ([0, 1].map(|k| one[0][k] + s * a[k]), depth > 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearer_of_two_crossing_lines_is_found() {
        let level = [[0.0, 50.0, 10.0], [100.0, 50.0, 10.0]];
        let upright = |depth: f64| [[50.0, 0.0, depth], [50.0, 100.0, depth]];
        assert_eq!(crossing(level, upright(20.0)), Some(([50.0, 50.0], false)));
        assert_eq!(crossing(level, upright(0.0)), Some(([50.0, 50.0], true)));
        // In one plane, beside each other, end to end, along each other.
        assert_eq!(crossing(level, upright(10.0)), None);
        assert_eq!(crossing(level, [[50.0, 60.0, 0.0], [50.0, 100.0, 0.0]]), None);
        assert_eq!(crossing(level, [[100.0, 0.0, 0.0], [100.0, 100.0, 0.0]]), None);
        assert_eq!(crossing(level, [[0.0, 49.0, 0.0], [100.0, 51.0, 0.0]]), None);
        assert_eq!(crossing(level, [[50.0, 50.0, 0.0]; 2]), None);
    }

    #[test]
    fn distances_from_lines_end_at_their_ends() {
        let level = [[0.0, 0.0, 1.0], [10.0, 0.0, 2.0]];
        assert_eq!(beside([5.0, 3.0], level), 3.0);
        assert_eq!(beside([13.0, 4.0], level), 5.0);
        assert_eq!(beside([3.0, 4.0], [[0.0; 3]; 2]), 5.0);
    }
}

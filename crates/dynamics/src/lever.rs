//! What loads feel of wrenches and of multipliers, four loads at a time.

use crate::lanes::{Four, Lanes, Vectors, cross, dot, plus, splat};
use crate::system::OnNode;
use linkdyn_kinematics::{Closure, Ends, NodePosition, Positions, Row};
use std::array::from_fn;

/// What four loads feel of their reactions: force and torque in axes of the joint's successor; or, where all loads have
/// [`crate::Supports`], two components each of those across the axis and one of that along it.
pub(crate) type Felt = [Four; 6];

/// What is known of up to four loads before the run. The last load fills up the four, without weight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FourLoads {
    pub nodes: [usize; 4],
    /// Of supports: two weights each of those across the axis, two of that along it.
    weights: [Four; 6],
}

impl FourLoads {
    pub fn new(loads: &[OnNode]) -> Self {
        let weights = |on: &OnNode| on.load.supports().unwrap_or_default().weights();
        Self {
            nodes: from_fn(|l| loads[l.min(loads.len() - 1)].node),
            weights: from_fn(|k| each(loads, |on| weights(on)[k])),
        }
    }
}

/// Which side of a closure four loads are on: ones and zeros.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sides {
    predecessor: Four,
    successor: Four,
}

impl Sides {
    pub fn new(loads: &[OnNode], closure: &Closure) -> Self {
        let on = |side: f64| each(loads, |on| f64::from(u8::from(closure.side(on.node) == side)));
        Self {
            predecessor: on(1.0),
            successor: on(-1.0),
        }
    }
}

/// A number for each of up to four loads, filled up with zeros.
fn each(loads: &[OnNode], f: impl Fn(&OnNode) -> f64) -> Four {
    Lanes(from_fn(|l| loads.get(l).map_or(0.0, &f)))
}

/// `sum += felt * factor`.
#[inline(always)]
pub(crate) fn add(sum: &mut Felt, felt: &Felt, factor: f64) {
    *sum = from_fn(|i| sum[i] + felt[i] * factor);
}

/// Four loads at their places.
pub(crate) struct Places {
    axes: [Vectors<4>; 3],
    origin: Vectors<4>,
    /// Weights if all loads have supports.
    weights: Option<[Four; 6]>,
}

impl Places {
    #[inline(always)]
    pub fn new(loads: &FourLoads, positions: &[NodePosition], has_supports: bool) -> Self {
        let here = loads.nodes.map(|node| &positions[node]);
        Self {
            axes: from_fn(|k| from_fn(|i| Lanes(from_fn(|l| here[l].rotation[(i, k)])))),
            origin: from_fn(|i| Lanes(from_fn(|l| here[l].origin[i]))),
            weights: has_supports.then_some(loads.weights),
        }
    }

    /// A vector in the loads' own axes.
    #[inline(always)]
    pub fn local(&self, v: &Vectors<4>) -> Vectors<4> {
        self.axes.each_ref().map(|axis| dot(axis, v))
    }

    /// What is felt of wrenches in the loads' own axes.
    #[inline(always)]
    pub fn feel(&self, [fx, fy, fz]: Vectors<4>, [nx, ny, nz]: Vectors<4>) -> Felt {
        match self.weights {
            None => [fx, fy, fz, nx, ny, nz],
            Some([a1, b1, a2, b2, c, d]) => [
                a1 * fx - b1 * ny,
                a1 * fy + b1 * nx,
                a2 * fx - b2 * ny,
                a2 * fy + b2 * nx,
                c * fz + d * nz,
                Four::ZERO,
            ],
        }
    }
}

/// What is felt of the multipliers of a row of a closure.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Lever {
    /// A force: its three multipliers are components in global axes. Where loads have supports, all that the three do not share
    /// is taken out of `feel(force, arm x force)`.
    Force([Four; 9]),
    /// One unit multiplier.
    Unit(Felt),
}

impl Lever {
    pub const NONE: Self = Self::Unit([Four::ZERO; 6]);

    /// Of one row of a closure.
    #[inline(always)]
    pub fn new(
        row: &Row,
        closure: &Closure,
        positions: &Positions,
        ends: &Ends,
        sides: &Sides,
        places: &Places,
    ) -> Self {
        // A reaction holds up against what closures exert on its own side.
        let sign = sides.successor - sides.predecessor;
        if let Row::Coincident = row {
            let end = |i: usize| sides.predecessor * ends.one()[i] + sides.successor * ends.two()[i];
            let arm = places.local(&from_fn(|i| end(i) - places.origin[i]));
            Self::force(places, &arm, sign)
        } else {
            let unit = closure.unit_wrench(row, positions);
            let (force, two) = (splat(&unit.force), splat(&ends.two()));
            let arm = from_fn(|i| two[i] - places.origin[i]);
            let torque = plus(&splat(&unit.torque), &cross(&arm, &force));
            let [force, torque] = [force, torque].map(|x| places.local(&x).map(|x| x * sign));
            Self::Unit(places.feel(force, torque))
        }
    }

    /// Force on an arm in the loads' own axes, with a sign.
    #[inline(always)]
    fn force(places: &Places, arm: &Vectors<4>, sign: Four) -> Self {
        let [x, y, z] = arm.map(|x| x * sign);
        Self::Force(match places.weights {
            None => [sign, x, y, z, sign, sign, sign, sign, sign],
            Some([a1, b1, a2, b2, c, d]) => {
                let (a, b) = (a1 * sign - b1 * z, a2 * sign - b2 * z);
                [a, b1 * x, b1 * y, b, b2 * x, b2 * y, c * sign, d * x, d * y]
            }
        })
    }

    /// Adds what is felt of multipliers to `felt`; `lambda` tells them.
    #[inline(always)]
    pub fn add_to(&self, felt: &mut Felt, places: &Places, lambda: impl Fn(usize) -> f64) {
        match self {
            Self::Unit(unit) => add(felt, unit, lambda(0)),
            Self::Force([a, ax, ay, b, bx, by, c, cx, cy]) => {
                let force: Vectors<4> = from_fn(|i| Lanes([lambda(i); 4]));
                let [x, y, z] = places.local(&force);
                if places.weights.is_some() {
                    felt[0] += *a * x + *ax * z;
                    felt[1] += *a * y + *ay * z;
                    felt[2] += *b * x + *bx * z;
                    felt[3] += *b * y + *by * z;
                    felt[4] += *c * z + *cx * y - *cy * x;
                } else {
                    let torque = cross(&[*ax, *ay, *b], &[x, y, z]);
                    let wrench = [*a * x, *a * y, *a * z, torque[0], torque[1], torque[2]];
                    *felt = from_fn(|i| felt[i] + wrench[i]);
                }
            }
        }
    }
}

//! What loads feel of wrenches and of multipliers, four loads at a time.

use crate::lanes::{Four, Lanes, Vectors, cross, dot, plus, splat};
use crate::system::OnNode;
use linkdyn_kinematics::{Closure, NodePosition, Positions, Row};
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

    /// What is felt of each unit multiplier of a closure.
    #[inline(always)]
    pub fn feel_multipliers(&self, closure: &Closure, sides: &Sides, positions: &Positions, units: &mut [Felt]) {
        let ends = closure.ends(positions);
        // A reaction holds up against what closures exert on its own side.
        let sign = sides.successor - sides.predecessor;
        let mut k = 0;
        for row in closure.rows() {
            if let Row::Coincident = row {
                let end = |i: usize| sides.predecessor * ends.one()[i] + sides.successor * ends.two()[i];
                let arm = self.local(&from_fn(|i| end(i) - self.origin[i]));
                for (i, unit) in units[k..k + 3].iter_mut().enumerate() {
                    let force = self.axes.map(|axis| axis[i] * sign);
                    *unit = self.feel(force, cross(&arm, &force));
                }
            } else {
                let unit = closure.unit_wrench(row, positions);
                let (force, two) = (splat(&unit.force), splat(&ends.two()));
                let arm = from_fn(|i| two[i] - self.origin[i]);
                let torque = plus(&splat(&unit.torque), &cross(&arm, &force));
                let [force, torque] = [force, torque].map(|x| self.local(&x).map(|x| x * sign));
                units[k] = self.feel(force, torque);
            }
            k += row.equations();
        }
    }
}

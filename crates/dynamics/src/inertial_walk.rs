//! Wrenches that answer to accelerations, for several accelerations at once.

use crate::lanes::{Lanes, Vectors, cross, plus, splat, times};
use crate::symmetric::SpatialInertia;
use linkdyn_kinematics::{Freedom, Node, NodePosition, Wrench};
use nalgebra::Vector3;
use std::array::from_fn;

/// An angular and a linear part in lanes: acceleration, or torque and force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spatial<const N: usize> {
    pub angular: Vectors<N>,
    pub linear: Vectors<N>,
}

impl<const N: usize> Spatial<N> {
    pub const ZERO: Self = Self {
        angular: [Lanes::ZERO; 3],
        linear: [Lanes::ZERO; 3],
    };

    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Self {
            angular: plus(&self.angular, &other.angular),
            linear: plus(&self.linear, &other.linear),
        }
    }
}

/// Wrenches that pass through all nodes when inertia answers to `rates` of the speeds, several at once; in the first lane on top
/// of the nodes' `own` ones if there are such. Neighbours hand their numbers on directly.
#[inline]
pub(crate) fn inertial_walk<const N: usize>(
    nodes: &[Node],
    positions: &[NodePosition],
    inertias: &[SpatialInertia],
    rates: &[Lanes<N>],
    own: Option<&[Wrench]>,
    accelerations: &mut [Spatial<N>],
    wrenches: &mut [Spatial<N>],
) {
    let (positions, inertias) = (&positions[..nodes.len()], &inertias[..nodes.len()]);
    let (accelerations, wrenches) = (&mut accelerations[..nodes.len()], &mut wrenches[..nodes.len()]);
    let mut a = Spatial::ZERO;
    for (i, node) in nodes.iter().enumerate().skip(1) {
        let (here, inertia) = (&positions[i], &inertias[i]);
        if node.parent != i - 1 {
            a = accelerations[node.parent];
        }
        a.linear = plus(&a.linear, &cross(&a.angular, &splat(&here.arm)));
        match node.freedom {
            Freedom::None => {}
            Freedom::Angular => a.angular = plus(&a.angular, &times(&splat(&here.axis), rates[node.speed])),
            Freedom::Linear => a.linear = plus(&a.linear, &times(&splat(&here.axis), rates[node.speed])),
            Freedom::Screw { pitch } => {
                let step = times(&splat(&here.axis), rates[node.speed]);
                a.angular = plus(&a.angular, &step);
                a.linear = plus(&a.linear, &times(&step, Lanes([pitch; N])));
            }
        }
        accelerations[i] = a;
        let (mass, moment) = (Lanes([inertia.mass; N]), splat(&inertia.moment));
        let mut wrench = Spatial {
            angular: plus(&inertia.second.times_lanes(&a.angular), &cross(&moment, &a.linear)),
            linear: plus(&times(&a.linear, mass), &cross(&a.angular, &moment)),
        };
        if let Some(own) = own {
            wrench = wrench.plus(&Spatial {
                angular: first_of(&own[i].torque),
                linear: first_of(&own[i].force),
            });
        }
        wrenches[i] = wrench;
    }
    let mut handed = Spatial::ZERO;
    for (i, node) in nodes.iter().enumerate().skip(1).rev() {
        let total = wrenches[i].plus(&handed);
        wrenches[i] = total;
        handed.angular = plus(&total.angular, &cross(&splat(&positions[i].arm), &total.linear));
        handed.linear = total.linear;
        if node.parent != i - 1 {
            wrenches[node.parent] = wrenches[node.parent].plus(&handed);
            handed = Spatial::ZERO;
        }
    }
}

/// A vector in the first lane, zero in the others.
#[inline(always)]
fn first_of<const N: usize>(v: &Vector3<f64>) -> Vectors<N> {
    from_fn(|i| Lanes(from_fn(|l| if l == 0 { v[i] } else { 0.0 })))
}

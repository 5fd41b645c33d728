//! Positions, velocities and accelerations of all nodes of a tree, outward from the ground.
//!
//! Everything is in **global axes**, each node's quantities at the node's own origin: nothing is rotated on the way out or
//! in, and far-away links lose no digits. The three phases are three types, so that nothing can ask for velocities before
//! positions are there.

use crate::joint::Motion;
use crate::joint::quaternion_rotation;
use crate::tree::{Freedom, LinkId, Node, Tree};
use crate::{Pose, Twist};
use nalgebra::{Matrix3, Vector3};

/// Where a node is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodePosition {
    /// Axes of the node in global axes (columns).
    pub rotation: Matrix3<f64>,
    /// Origin in the global frame \[m\].
    pub origin: Vector3<f64>,
    /// From the origin of the node before to this one, global axes \[m\].
    pub arm: Vector3<f64>,
    /// Axis of the node's freedom, global axes, unit length (zero without a freedom).
    pub axis: Vector3<f64>,
}

/// Positions of all nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Positions(pub(crate) Vec<NodePosition>);

/// Velocities of all nodes: angular, and linear at the node's origin, global axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Velocities(pub(crate) Vec<Twist>);

/// Accelerations of all nodes: angular, and linear at the node's origin, global axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Accelerations(pub(crate) Vec<Twist>);

impl Positions {
    /// Storage for `tree`, all at the origin.
    pub fn new(tree: &Tree) -> Self {
        let start = NodePosition {
            rotation: Matrix3::identity(),
            origin: Vector3::zeros(),
            arm: Vector3::zeros(),
            axis: Vector3::zeros(),
        };
        Self(vec![start; tree.nodes().len()])
    }

    /// One entry a node, the ground first.
    #[inline]
    pub fn nodes(&self) -> &[NodePosition] {
        &self.0
    }

    /// Pose of a link in the global frame.
    pub fn pose(&self, link: LinkId) -> Pose {
        let node = &self.0[link.node()];
        Pose {
            rotation: node.rotation,
            origin: node.origin,
        }
    }
}

impl Velocities {
    /// Storage for `tree`, all at rest.
    pub fn new(tree: &Tree) -> Self {
        Self(vec![Twist::zero(); tree.nodes().len()])
    }

    /// One entry a node, the ground first.
    #[inline]
    pub fn nodes(&self) -> &[Twist] {
        &self.0
    }
}

impl Accelerations {
    /// Storage for `tree`, all zero.
    pub fn new(tree: &Tree) -> Self {
        Self(vec![Twist::zero(); tree.nodes().len()])
    }

    /// One entry a node, the ground first.
    #[inline]
    pub fn nodes(&self) -> &[Twist] {
        &self.0
    }
}

impl Tree {
    /// Positions for coordinates `q`.
    pub fn positions(&self, q: &[f64], positions: &mut Positions) {
        for (i, node) in self.nodes().iter().enumerate().skip(1) {
            place(node, i, q, &mut positions.0);
        }
    }

    /// Velocities for speeds `v`.
    pub fn velocities(&self, positions: &Positions, v: &[f64], velocities: &mut Velocities) {
        for (i, node) in self.nodes().iter().enumerate().skip(1) {
            velocities.0[i] = velocity(node, &positions.0[i], &velocities.0[node.parent], v);
        }
    }

    /// Accelerations for speeds `v` and their rates `rates` on a base that itself accelerates by `base` \[m/s^2\]
    /// (minus gravity, where the apparent weight is wanted).
    pub fn accelerations(
        &self,
        positions: &Positions,
        velocities: &Velocities,
        v: &[f64],
        rates: &[f64],
        base: &Vector3<f64>,
        accelerations: &mut Accelerations,
    ) {
        accelerations.0[0].linear = *base;
        for (i, node) in self.nodes().iter().enumerate().skip(1) {
            let here = &positions.0[i];
            let mut a = self.bias_acceleration(i, positions, velocities, accelerations, v);
            node.advance(&here.axis, |speed| rates[speed], &mut a);
            accelerations.0[i] = a;
        }
    }

    /// The three phases in one walk outward, with the **bias** accelerations: those for vanishing rates of the speeds.
    #[inline]
    pub fn sweep(
        &self,
        q: &[f64],
        v: &[f64],
        base: &Vector3<f64>,
        positions: &mut Positions,
        velocities: &mut Velocities,
        biases: &mut Accelerations,
    ) {
        biases.0[0].linear = *base;
        for (i, node) in self.nodes().iter().enumerate().skip(1) {
            place(node, i, q, &mut positions.0);
            velocities.0[i] = velocity(node, &positions.0[i], &velocities.0[node.parent], v);
            biases.0[i] = self.bias_acceleration(i, positions, velocities, biases, v);
        }
    }

    /// Acceleration of node `i` for a vanishing rate of its own speed, from that of the node before.
    #[inline]
    fn bias_acceleration(
        &self,
        i: usize,
        positions: &Positions,
        velocities: &Velocities,
        accelerations: &Accelerations,
        v: &[f64],
    ) -> Twist {
        let (node, here) = (&self.nodes()[i], &positions.0[i]);
        let before = &accelerations.0[node.parent];
        // On the ground nothing turns but what a ball joint turns itself.
        if node.parent == 0 && !node.is_ball() {
            return *before;
        }
        let w = &velocities.0[node.parent].angular;
        let mut angular = before.angular;
        let mut linear = before.linear + before.angular.cross(&here.arm) + w.cross(&w.cross(&here.arm));
        match node.freedom {
            Freedom::None => {}
            Freedom::Angular => {
                // The axis turns with whatever carries it: the node before, or for a ball joint its successor.
                let carrier = match node.motion {
                    Motion::Ball(_) => self.ball_angular(i, &here.rotation, w, v, 0),
                    Motion::BallNext(k) => self.ball_angular(i, &here.rotation, w, v, k),
                    _ => *w,
                };
                angular += carrier.cross(&here.axis) * v[node.speed];
            }
            Freedom::Linear => linear += w.cross(&here.axis) * (2.0 * v[node.speed]),
            Freedom::Screw { pitch } => {
                let carried = Twist { angular, linear };
                return screw_bias(carried, &w.cross(&here.axis), pitch, v[node.speed]);
            }
        }
        Twist { angular, linear }
    }

    /// Angular velocity behind all three freedoms of a ball joint, seen from its k-th node.
    fn ball_angular(
        &self,
        i: usize,
        rotation: &Matrix3<f64>,
        before: &Vector3<f64>,
        v: &[f64],
        k: usize,
    ) -> Vector3<f64> {
        let first = self.nodes()[i].speed - k;
        (k..3).fold(*before, |w, axis| w + rotation.column(axis) * v[first + axis])
    }
}

/// Adds what a screw does whose axis turns at the rate `axis_rate`. Screws are rare: out of the way of the others.
#[cold]
#[inline(never)]
fn screw_bias(mut carried: Twist, axis_rate: &Vector3<f64>, pitch: f64, speed: f64) -> Twist {
    let turning = axis_rate * speed;
    carried.angular += turning;
    carried.linear += turning * (2.0 * pitch);
    carried
}

/// Places node `i` on the node before.
#[inline]
fn place(node: &Node, i: usize, q: &[f64], positions: &mut [NodePosition]) {
    let (before, rest) = positions.split_at_mut(i);
    let here = &mut rest[0];
    let before = &before[node.parent];
    let r = &before.rotation;
    match &node.motion {
        // On the ground there is nothing to multiply with.
        Motion::Turn(turn) if node.parent == 0 => {
            here.rotation = turn.rotation(q[node.coordinate]);
            here.arm = turn.origin;
            here.axis = turn.axis;
        }
        Motion::Turn(turn) => {
            here.rotation = r * turn.rotation(q[node.coordinate]);
            here.arm = r * turn.origin;
            here.axis = r * turn.axis;
        }
        Motion::Slide(slide) => {
            here.axis = r * slide.axis;
            here.rotation = r * slide.rotation;
            here.arm = r * slide.origin + here.axis * q[node.coordinate];
        }
        Motion::Screw(turn, pitch) => {
            here.rotation = r * turn.rotation(q[node.coordinate]);
            here.axis = r * turn.axis;
            here.arm = r * turn.origin + here.axis * (pitch * q[node.coordinate]);
        }
        Motion::Ball(offset) => {
            let turned = quaternion_rotation(&q[node.coordinate..node.coordinate + 4]);
            here.rotation = r * (offset.rotation * turned);
            here.arm = r * offset.origin;
            here.axis = here.rotation.column(0).into_owned();
        }
        Motion::BallNext(k) => {
            here.rotation = *r;
            here.arm = Vector3::zeros();
            here.axis = r.column(*k).into_owned();
        }
        Motion::Still(pose) => {
            here.rotation = r * pose.rotation;
            here.arm = r * pose.origin;
            here.axis = Vector3::zeros();
        }
    }
    here.origin = before.origin + here.arm;
}

#[inline]
fn velocity(node: &Node, here: &NodePosition, before: &Twist, v: &[f64]) -> Twist {
    let mut twist = Twist {
        angular: before.angular,
        linear: before.linear + before.angular.cross(&here.arm),
    };
    node.advance(&here.axis, |speed| v[speed], &mut twist);
    twist
}

//! Trees of links: topology and the numbering of coordinates and speeds.

use crate::joint::{Joint, Motion, Slide, Step, Turn};
use crate::{Pose, Twist, Wrench, joint};
use nalgebra::Vector3;
use thiserror::Error;

/// A link of a [`Tree`]; [`LinkId::GROUND`] is the base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinkId(pub(crate) usize);

impl LinkId {
    /// The base, whose frame is the global frame.
    pub const GROUND: LinkId = LinkId(0);

    /// Index of the link's node in [`Tree::nodes`] and in the slices of the motion types.
    pub fn node(self) -> usize {
        self.0
    }
}

/// The way a node moves against the node before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Freedom {
    /// Not at all.
    None,
    /// It turns about the node's axis.
    Angular,
    /// It slides along the node's axis.
    Linear,
    /// It turns about the node's axis and slides along it in proportion.
    Screw {
        /// Slide for a turn by one radian \[m/rad\].
        pitch: f64,
    },
}

/// A frame of the tree: a link, or a step between the freedoms of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Index of the node before; always smaller than the node's own.
    pub parent: usize,
    /// Kind of the node's one freedom.
    pub freedom: Freedom,
    /// Index of the node's speed; meaningless without a freedom.
    pub speed: usize,
    pub(crate) coordinate: usize,
    pub(crate) motion: Motion,
}

/// Screws are rare: out of the way of the others.
#[cold]
#[inline(never)]
fn advance_screw(mut twist: Twist, axis: &Vector3<f64>, rate: f64, pitch: f64) -> Twist {
    let step = axis * rate;
    twist.angular += step;
    twist.linear += step * pitch;
    twist
}

impl Node {
    /// Motion of the node for a unit speed of its freedom, at its origin; `axis` is the node's.
    #[inline]
    pub fn unit_twist(&self, axis: &Vector3<f64>) -> Twist {
        let (mut angular, mut linear) = (Vector3::zeros(), Vector3::zeros());
        match self.freedom {
            Freedom::None => {}
            Freedom::Angular => angular = *axis,
            Freedom::Linear => linear = *axis,
            Freedom::Screw { pitch } => (angular, linear) = (*axis, axis * pitch),
        }
        Twist { angular, linear }
    }

    /// Adds what the node's own freedom does at the `rate` of its speed to the motion of its origin; `axis` is the node's. The rate
    /// may be one of velocity or of acceleration, and is not asked for without a freedom.
    #[inline]
    pub fn advance(&self, axis: &Vector3<f64>, rate: impl FnOnce(usize) -> f64, twist: &mut Twist) {
        match self.freedom {
            Freedom::None => {}
            Freedom::Angular => twist.angular += axis * rate(self.speed),
            Freedom::Linear => twist.linear += axis * rate(self.speed),
            // By value: what a call may change by reference has to live in memory, for all joints.
            Freedom::Screw { pitch } => *twist = advance_screw(*twist, axis, rate(self.speed), pitch),
        }
    }

    /// Part of a wrench at the node's origin that works on its freedom \[N m, N\]; `axis` is the node's.
    #[inline]
    pub fn along(&self, axis: &Vector3<f64>, wrench: &Wrench) -> f64 {
        match self.freedom {
            Freedom::Linear => axis.dot(&wrench.force),
            Freedom::Screw { pitch } => axis.dot(&(wrench.torque + wrench.force * pitch)),
            Freedom::Angular | Freedom::None => axis.dot(&wrench.torque),
        }
    }

    /// Whether the node is one of the three freedoms of a ball joint.
    #[inline]
    pub(crate) fn is_ball(&self) -> bool {
        matches!(self.motion, Motion::Ball(_) | Motion::BallNext(_))
    }
}

/// Links hung on one another by joints: any number of branches, each link on an earlier one.
///
/// Coordinates `q` and speeds `v` are numbered in the order in which the links were attached.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    nodes: Vec<Node>,
    joints: Vec<(LinkId, Joint)>,
    /// First coordinate and speed of each joint.
    firsts: Vec<(usize, usize)>,
    coordinates: usize,
    speeds: usize,
}

/// Why a link could not be attached.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TreeError {
    /// The parent does not belong to this tree.
    #[error("parent link {parent} does not exist: this tree has nodes 0 (ground) to {last}")]
    UnknownParent {
        /// Node asked for.
        parent: usize,
        /// Last node there is.
        last: usize,
    },
    /// The placement is not a rigid pose.
    #[error("placement is not a rigid pose: its rotation is off by {defect:e}, allowed are 1e-9 and finite numbers")]
    NotRigid {
        /// See [`Pose::defect`].
        defect: f64,
    },
    /// A joint axis is not a unit vector, a pitch not finite, the two axes of a universal joint are parallel, or those of a planar joint not at
    /// right angles.
    #[error(
        "axes of joint {joint:?} must be finite unit vectors, those of a universal joint not parallel, those of a planar joint at right angles and pitches finite"
    )]
    BadAxis {
        /// The joint.
        joint: Joint,
    },
}

impl Default for Tree {
    fn default() -> Self {
        Self::new()
    }
}

impl Tree {
    /// Only the ground.
    pub fn new() -> Self {
        let ground = Node {
            parent: 0,
            freedom: Freedom::None,
            speed: usize::MAX,
            coordinate: usize::MAX,
            motion: Motion::Still(Pose::identity()),
        };
        Self {
            nodes: vec![ground],
            joints: Vec::new(),
            firsts: Vec::new(),
            coordinates: 0,
            speeds: 0,
        }
    }

    /// Hangs a new link on `parent`: its frame is `placement` (the joint's frame on the parent) times the joint's motion.
    ///
    /// # Errors
    /// [`TreeError`] when the parent is not of this tree, the placement not rigid or an axis not of unit length.
    pub fn attach(&mut self, parent: LinkId, placement: Pose, joint: Joint) -> Result<LinkId, TreeError> {
        let last = self.nodes.len() - 1;
        if parent.0 > last {
            return Err(TreeError::UnknownParent { parent: parent.0, last });
        }
        let defect = placement.defect();
        if defect.is_nan() || defect > 1e-9 {
            return Err(TreeError::NotRigid { defect });
        }
        joint.validate()?;
        self.firsts.push((self.coordinates, self.speeds));
        let mut before = parent.0;
        let mut offset = placement;
        for step in joint.steps() {
            before = self.push(before, offset, step);
            offset = Pose::identity();
        }
        if joint.speeds() == 0 {
            self.nodes.push(Node {
                parent: before,
                freedom: Freedom::None,
                speed: usize::MAX,
                coordinate: usize::MAX,
                motion: Motion::Still(placement),
            });
            before = self.nodes.len() - 1;
        }
        let link = LinkId(before);
        self.joints.push((link, joint));
        Ok(link)
    }

    fn push(&mut self, parent: usize, offset: Pose, step: Step) -> usize {
        let (freedom, motion, new_coordinates) = match step {
            Step::Turn(axis) => (Freedom::Angular, Motion::Turn(Turn::new(&offset, &axis)), 1),
            Step::Slide(axis) => {
                let slide = Slide {
                    rotation: offset.rotation,
                    axis: offset.rotation * *axis,
                    origin: offset.origin,
                };
                (Freedom::Linear, Motion::Slide(slide), 1)
            }
            Step::Screw(axis, pitch) => {
                let turn = Turn::new(&offset, &axis);
                (Freedom::Screw { pitch }, Motion::Screw(turn, pitch), 1)
            }
            Step::Ball(0) => (Freedom::Angular, Motion::Ball(offset), 4),
            Step::Ball(k) => (Freedom::Angular, Motion::BallNext(k), 0),
        };
        self.nodes.push(Node {
            parent,
            freedom,
            speed: self.speeds,
            coordinate: self.coordinates,
            motion,
        });
        self.coordinates += new_coordinates;
        self.speeds += 1;
        self.nodes.len() - 1
    }

    /// All nodes, the ground first; parents come before their successors.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The links in the order in which they were attached, each with the joint that carries it.
    pub fn joints(&self) -> &[(LinkId, Joint)] {
        &self.joints
    }

    /// Number of coordinates `q`.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Number of speeds `v`.
    pub fn speeds(&self) -> usize {
        self.speeds
    }

    /// The joint that carries `link`; `None` for the ground.
    pub fn joint_of(&self, link: LinkId) -> Option<Joint> {
        self.place(link).map(|place| self.joints[place].1)
    }

    /// Range of the coordinates of the joint that carries `link`.
    pub fn coordinate_range(&self, link: LinkId) -> std::ops::Range<usize> {
        let place = self.place(link);
        place.map_or(self.coordinates..self.coordinates, |place| {
            let first = self.firsts[place].0;
            first..first + self.joints[place].1.coordinates()
        })
    }

    /// Range of the speeds of the joint that carries `link`.
    pub fn speed_range(&self, link: LinkId) -> std::ops::Range<usize> {
        let place = self.place(link);
        place.map_or(self.speeds..self.speeds, |place| {
            let first = self.firsts[place].1;
            first..first + self.joints[place].1.speeds()
        })
    }

    /// Place of a link among the joints, whose links have ascending numbers.
    fn place(&self, link: LinkId) -> Option<usize> {
        self.joints.binary_search_by_key(&link.0, |(link, _)| link.0).ok()
    }

    /// The nodes that carry a freedom on the way from the ground to `link`, the last first.
    pub fn path(&self, link: LinkId) -> impl Iterator<Item = usize> + '_ {
        let up = |&node: &usize| Some(self.nodes[node].parent);
        std::iter::successors(Some(link.0), up)
            .take_while(|&node| node != 0)
            .filter(|&node| self.nodes[node].freedom != Freedom::None)
    }

    /// Coordinates with every turn and slide at zero and every quaternion at (1, 0, 0, 0).
    pub fn neutral(&self) -> Vec<f64> {
        let mut q = vec![0.0; self.coordinates];
        for node in &self.nodes {
            if let Motion::Ball(_) = node.motion {
                q[node.coordinate] = 1.0;
            }
        }
        q
    }

    /// Rates of the coordinates: `q' = v`, and quaternion rates for ball joints.
    #[inline]
    pub fn coordinate_rates(&self, q: &[f64], v: &[f64], rates: &mut [f64]) {
        if self.coordinates == self.speeds {
            rates.copy_from_slice(v);
            return;
        }
        for node in &self.nodes {
            let (c, s) = (node.coordinate, node.speed);
            match node.motion {
                Motion::Ball(_) => joint::quaternion_rate(&q[c..c + 4], &v[s..s + 3], &mut rates[c..c + 4]),
                Motion::Turn(_) | Motion::Slide(_) | Motion::Screw(..) => rates[c] = v[s],
                Motion::BallNext(_) | Motion::Still(_) => {}
            }
        }
    }

    /// Coordinates after a displacement `step` (one number a speed): sums, and a finite turn for ball joints.
    pub fn displace(&self, q: &mut [f64], step: &[f64]) {
        for node in &self.nodes {
            let (c, s) = (node.coordinate, node.speed);
            match node.motion {
                Motion::Ball(_) => {
                    let old = [q[c], q[c + 1], q[c + 2], q[c + 3]];
                    joint::quaternion_turn(&old, &step[s..s + 3], &mut q[c..c + 4]);
                }
                Motion::Turn(_) | Motion::Slide(_) | Motion::Screw(..) => q[c] += step[s],
                Motion::BallNext(_) | Motion::Still(_) => {}
            }
        }
    }

    /// Brings quaternions back to unit length, but for rounding; returns the largest defect of `|q|^2` found.
    pub fn normalise(&self, q: &mut [f64]) -> f64 {
        let mut worst: f64 = 0.0;
        if self.coordinates == self.speeds {
            return worst;
        }
        for node in &self.nodes {
            if let Motion::Ball(_) = node.motion {
                let q = &mut q[node.coordinate..node.coordinate + 4];
                let square = q.iter().map(|x| x * x).sum::<f64>();
                let defect = (square - 1.0).abs();
                worst = worst.max(defect);
                // Rounding stays: a state that has been normalised is not changed again.
                if defect.is_nan() || defect > 8.0 * f64::EPSILON {
                    q.iter_mut().for_each(|x| *x /= square.sqrt());
                }
            }
        }
        worst
    }
}

//! Closures: the equations of cut joints that turn a tree into a mechanism with loops.
//!
//! A cut joint keeps some relative motions of two frames from happening. Every lower pair is a list of four kinds of
//! [`Row`]s, each of which is the same thing seen three ways: a residual `phi(q)`, a gradient of it, and a wrench on the
//! predecessor (the opposite on the successor). Multipliers are the sizes of those wrenches: the generalised force of the
//! closure is `+G^T lambda` with `G = d phi'/dv`.

use crate::joint::Joint;
use crate::motion::{Accelerations, Positions, Velocities};
use crate::tree::{Freedom, LinkId, Tree};
use crate::turned::{Turned, spin};
use crate::{Pose, Twist, Wrench};
use nalgebra::{Unit, Vector3};
use std::f64::consts::TAU;

/// A frame fixed on a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attachment {
    /// The link.
    pub link: LinkId,
    /// Pose of the frame in the link's frame.
    pub pose: Pose,
}

/// An elementary closure equation between a frame on the predecessor and one on the successor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
pub enum Row {
    /// Three equations: the origins coincide, `phi = r_pre - r_suc` in global axes \[m\]. Multipliers: force on the
    /// predecessor in global axes \[N\].
    Coincident,
    /// One equation: no offset of the origins along `axis` (a unit vector of the predecessor frame),
    /// `phi = axis . (r_pre - r_suc)` \[m\]. Multiplier: force on the predecessor along `axis` \[N\].
    Along {
        /// Direction in the predecessor frame.
        axis: Vector3<f64>,
    },
    /// One equation: the angle between two axes stays, `phi = on_predecessor . on_successor - cosine` \[-\]. Multiplier:
    /// torque on the predecessor along `on_predecessor x on_successor` \[N m\].
    Angle {
        /// Unit vector of the predecessor frame.
        on_predecessor: Vector3<f64>,
        /// Unit vector of the successor frame.
        on_successor: Vector3<f64>,
        /// Cosine of the angle \[-\].
        cosine: f64,
    },
    /// One equation: along `axis` the successor is displaced in proportion to its turn about it,
    /// `phi = axis . (r_pre - r_suc) + pitch * turn` \[m\], with whole turns such that `phi` is smallest. `axis` is a unit vector of both
    /// frames, which other equations keep parallel. Multiplier: force on the predecessor along `axis` with a torque of
    /// `-pitch` times that \[N\].
    Screw {
        /// Direction in both frames.
        axis: Vector3<f64>,
        /// Slide for a turn by one radian \[m/rad\].
        pitch: f64,
    },
}

impl Row {
    /// Whether all axes are finite unit vectors, and all other numbers finite.
    pub fn is_sound(&self) -> bool {
        let unit = |axis: &Vector3<f64>| (axis.norm() - 1.0).abs() < 1e-9;
        match self {
            Row::Coincident => true,
            Row::Along { axis } => unit(axis),
            Row::Screw { axis, pitch } => unit(axis) && pitch.is_finite(),
            Row::Angle {
                on_predecessor,
                on_successor,
                cosine,
            } => unit(on_predecessor) && unit(on_successor) && cosine.is_finite(),
        }
    }

    /// Number of equations.
    pub fn equations(&self) -> usize {
        match self {
            Row::Coincident => 3,
            Row::Along { .. } | Row::Angle { .. } | Row::Screw { .. } => 1,
        }
    }
}

/// A cut joint: its equations and the freedoms that move it.
#[derive(Clone, Debug, PartialEq)]
pub struct Closure {
    predecessor: Attachment,
    successor: Attachment,
    rows: Vec<Row>,
    /// Whether the rows are those of a kind of joint, not of one's own.
    of_a_joint: bool,
    equations: usize,
    /// Freedoms that move the predecessor only.
    on_predecessor: Vec<Mover>,
    /// Freedoms that move the successor only.
    on_successor: Vec<Mover>,
}

/// A freedom that moves one side.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mover {
    node: usize,
    speed: usize,
    freedom: Freedom,
}

/// Where the two frames of a closure are, and where they are seen from the nodes that carry them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ends {
    one: Vector3<f64>,
    two: Vector3<f64>,
    arm_one: Vector3<f64>,
    arm_two: Vector3<f64>,
}

impl Ends {
    /// Origin of the predecessor's frame \[m\].
    #[inline]
    pub fn one(&self) -> Vector3<f64> {
        self.one
    }

    /// Origin of the successor's frame \[m\].
    #[inline]
    pub fn two(&self) -> Vector3<f64> {
        self.two
    }
}

impl Closure {
    /// Cuts `joint` between two frames. The joint's axes are those of the predecessor frame, as for
    /// [`Tree::attach`]; at zero joint coordinates both frames coincide.
    ///
    /// # Panics
    /// If a link is not of this tree.
    pub fn new(tree: &Tree, predecessor: Attachment, successor: Attachment, joint: &Joint) -> Self {
        Self {
            of_a_joint: true,
            ..Self::with_rows(tree, predecessor, successor, rows_of(joint))
        }
    }

    /// Closure from equations of one's own choice.
    ///
    /// # Panics
    /// If a link is not of this tree.
    pub fn with_rows(tree: &Tree, predecessor: Attachment, successor: Attachment, rows: Vec<Row>) -> Self {
        let movers = |link: LinkId, other: LinkId| -> Vec<Mover> {
            // Freedoms below both sides carry the whole loop along and drop out. Ways to the ground descend.
            let below: Vec<usize> = tree.path(other).collect();
            let alone = tree
                .path(link)
                .filter(|node| below.binary_search_by(|below| node.cmp(below)).is_err());
            let mover = |node| Mover {
                node,
                speed: tree.nodes()[node].speed,
                freedom: tree.nodes()[node].freedom,
            };
            alone.map(mover).collect()
        };
        Self {
            on_predecessor: movers(predecessor.link, successor.link),
            on_successor: movers(successor.link, predecessor.link),
            equations: rows.iter().map(Row::equations).sum(),
            of_a_joint: false,
            predecessor,
            successor,
            rows,
        }
    }

    /// Number of equations.
    pub fn equations(&self) -> usize {
        self.equations
    }

    /// The equations.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Whether they are those of a kind of joint.
    pub(crate) fn is_of_a_joint(&self) -> bool {
        self.of_a_joint
    }

    /// The frame on the predecessor.
    pub fn predecessor(&self) -> &Attachment {
        &self.predecessor
    }

    /// The frame on the successor.
    pub fn successor(&self) -> &Attachment {
        &self.successor
    }

    /// Nodes whose freedoms move the closure.
    pub fn path(&self) -> impl Iterator<Item = usize> + '_ {
        self.on_predecessor
            .iter()
            .chain(&self.on_successor)
            .map(|mover| mover.node)
    }

    /// Names of the multipliers, one an equation.
    pub fn component_names(&self) -> Vec<String> {
        let mut names = Vec::new();
        let (mut forces, mut torques) = (0, 0);
        for row in &self.rows {
            match row {
                Row::Coincident => names.extend(["fx", "fy", "fz"].map(String::from)),
                Row::Along { .. } | Row::Screw { .. } => {
                    forces += 1;
                    names.push(format!("f{forces}"));
                }
                Row::Angle { .. } => {
                    torques += 1;
                    names.push(format!("n{torques}"));
                }
            }
        }
        names
    }

    /// Where the two frames are.
    #[inline]
    pub fn ends(&self, positions: &Positions) -> Ends {
        let (p, s) = (&self.predecessor, &self.successor);
        let (one, two) = (&positions.0[p.link.node()], &positions.0[s.link.node()]);
        let (arm_one, arm_two) = (one.rotation * p.pose.origin, two.rotation * s.pose.origin);
        Ends {
            one: one.origin + arm_one,
            two: two.origin + arm_two,
            arm_one,
            arm_two,
        }
    }

    #[inline]
    fn direction(&self, attachment: &Attachment, positions: &Positions, local: &Vector3<f64>) -> Vector3<f64> {
        positions.0[attachment.link.node()].rotation * (attachment.pose.rotation * local)
    }

    /// How far the successor is turned about `axis`, a unit vector of both frames. Screws are rare: out of the way of the others.
    #[cold]
    #[inline(never)]
    fn turned(&self, axis: &Vector3<f64>, positions: &Positions) -> Turned {
        let (e1, e2) = plane_of(&Unit::new_unchecked(*axis));
        let across = |side| [e1, e2].map(|e| self.direction(side, positions, &e));
        Turned {
            one: across(&self.predecessor),
            two: across(&self.successor),
        }
    }

    /// Residual `phi`, one number an equation \[m or -\].
    pub fn residual(&self, positions: &Positions, phi: &mut [f64]) {
        let (p, s) = (&self.predecessor, &self.successor);
        let ends = self.ends(positions);
        let gap = ends.one - ends.two;
        let mut k = 0;
        for row in &self.rows {
            match row {
                Row::Coincident => phi[k..k + 3].copy_from_slice(gap.as_slice()),
                Row::Along { axis } => phi[k] = self.direction(p, positions, axis).dot(&gap),
                Row::Angle {
                    on_predecessor,
                    on_successor,
                    cosine,
                } => {
                    let a = self.direction(p, positions, on_predecessor);
                    phi[k] = a.dot(&self.direction(s, positions, on_successor)) - cosine;
                }
                Row::Screw { axis, pitch } => {
                    let along = self.direction(p, positions, axis).dot(&gap);
                    let phi_of_no_turn = along + pitch * self.turned(axis, positions).angle();
                    let period = TAU * pitch.abs();
                    let turns = if period > 0.0 {
                        (phi_of_no_turn / period).round()
                    } else {
                        0.0
                    };
                    phi[k] = phi_of_no_turn - turns * period;
                }
            }
            k += row.equations();
        }
    }

    /// Rate `phi' = G v` \[m/s or 1/s\].
    pub fn rate(&self, positions: &Positions, velocities: &Velocities, rate: &mut [f64]) {
        let (p, s) = (&self.predecessor, &self.successor);
        let ends = self.ends(positions);
        let (v_one, v_two) = (&velocities.0[p.link.node()], &velocities.0[s.link.node()]);
        let gap = ends.one - ends.two;
        let gap_rate = gap_rate(v_one, v_two, &ends);
        let mut k = 0;
        for row in &self.rows {
            match row {
                Row::Coincident => rate[k..k + 3].copy_from_slice(gap_rate.as_slice()),
                Row::Along { axis } => {
                    let u = self.direction(p, positions, axis);
                    rate[k] = u.dot(&gap_rate) + v_one.angular.cross(&u).dot(&gap);
                }
                Row::Angle {
                    on_predecessor,
                    on_successor,
                    ..
                } => {
                    let a = self.direction(p, positions, on_predecessor);
                    let b = self.direction(s, positions, on_successor);
                    rate[k] = (v_one.angular - v_two.angular).dot(&a.cross(&b));
                }
                Row::Screw { axis, pitch } => {
                    let u = self.direction(p, positions, axis);
                    let turn = self.turned(axis, positions).rate(&v_one.angular, &v_two.angular);
                    rate[k] = u.dot(&gap_rate) + v_one.angular.cross(&u).dot(&gap) + pitch * turn;
                }
            }
            k += row.equations();
        }
    }

    /// Gradient `G`: `put` is told speed, equation and entry for the speeds on the closure's path; all others are zero.
    #[inline]
    pub fn gradient(&self, positions: &Positions, put: impl FnMut(usize, usize, f64)) {
        self.gradient_at(&self.ends(positions), positions, put);
    }

    #[inline]
    fn gradient_at(&self, ends: &Ends, positions: &Positions, mut put: impl FnMut(usize, usize, f64)) {
        let mut k = 0;
        for row in &self.rows {
            if let Row::Coincident = row {
                let mut put_column = |mover: &Mover, column: Vector3<f64>| {
                    (0..3).for_each(|l| put(mover.speed, k + l, column[l]));
                };
                for mover in &self.on_predecessor {
                    let here = &positions.0[mover.node];
                    let column = match mover.freedom {
                        Freedom::Linear => here.axis,
                        Freedom::Screw { pitch } => here.axis.cross(&(ends.one - here.origin)) + here.axis * pitch,
                        Freedom::Angular | Freedom::None => here.axis.cross(&(ends.one - here.origin)),
                    };
                    put_column(mover, column);
                }
                for mover in &self.on_successor {
                    let here = &positions.0[mover.node];
                    let column = match mover.freedom {
                        Freedom::Linear => -here.axis,
                        Freedom::Screw { pitch } => (ends.two - here.origin).cross(&here.axis) - here.axis * pitch,
                        Freedom::Angular | Freedom::None => (ends.two - here.origin).cross(&here.axis),
                    };
                    put_column(mover, column);
                }
            } else {
                let unit = self.unit_wrench(row, positions);
                let share = |mover: &Mover| {
                    let here = &positions.0[mover.node];
                    let torque = || here.axis.dot(&unit.shifted(&(ends.two - here.origin)).torque);
                    match mover.freedom {
                        Freedom::Linear => here.axis.dot(&unit.force),
                        Freedom::Screw { pitch } => torque() + here.axis.dot(&unit.force) * pitch,
                        Freedom::Angular | Freedom::None => torque(),
                    }
                };
                for mover in &self.on_predecessor {
                    put(mover.speed, k, share(mover));
                }
                for mover in &self.on_successor {
                    put(mover.speed, k, -share(mover));
                }
            }
            k += row.equations();
        }
    }

    /// Which frame the freedom of `node` moves: 1 for the predecessor's, -1 for the successor's, 0 for none or both.
    pub fn side(&self, node: usize) -> f64 {
        let moves = |movers: &[Mover]| movers.iter().any(|mover| mover.node == node);
        f64::from(i8::from(moves(&self.on_predecessor)) - i8::from(moves(&self.on_successor)))
    }

    /// The wrench on the predecessor that a unit multiplier of a one-equation row stands for, at the successor's point.
    #[inline]
    pub fn unit_wrench(&self, row: &Row, positions: &Positions) -> Wrench {
        let mut unit = Wrench::zero();
        match row {
            Row::Coincident => {}
            Row::Along { axis } => unit.force = self.direction(&self.predecessor, positions, axis),
            Row::Angle {
                on_predecessor,
                on_successor,
                ..
            } => {
                let a = self.direction(&self.predecessor, positions, on_predecessor);
                unit.torque = a.cross(&self.direction(&self.successor, positions, on_successor));
            }
            Row::Screw { axis, pitch } => {
                unit.force = self.direction(&self.predecessor, positions, axis);
                unit.torque = self.turned(axis, positions).gradient() * *pitch;
            }
        }
        unit
    }

    /// Bias `gamma`: the second rate of `phi` for vanishing rates of the speeds, so that `phi'' = G v' + gamma`.
    /// `biases` are those of [`Tree::sweep`]; a common base acceleration cancels.
    pub fn bias(&self, positions: &Positions, velocities: &Velocities, biases: &Accelerations, gamma: &mut [f64]) {
        self.bias_at(&self.ends(positions), positions, velocities, biases, gamma);
    }

    /// [`Closure::gradient`] and [`Closure::bias`] in one.
    #[inline]
    pub fn gradient_and_bias(
        &self,
        positions: &Positions,
        velocities: &Velocities,
        biases: &Accelerations,
        put: impl FnMut(usize, usize, f64),
        gamma: &mut [f64],
    ) {
        let ends = self.ends(positions);
        self.gradient_at(&ends, positions, put);
        self.bias_at(&ends, positions, velocities, biases, gamma);
    }

    #[inline]
    fn bias_at(
        &self,
        ends: &Ends,
        positions: &Positions,
        velocities: &Velocities,
        biases: &Accelerations,
        gamma: &mut [f64],
    ) {
        let (p, s) = (&self.predecessor, &self.successor);
        let (v_one, v_two) = (&velocities.0[p.link.node()], &velocities.0[s.link.node()]);
        let (a_one, a_two) = (&biases.0[p.link.node()], &biases.0[s.link.node()]);
        let gap_second = a_one.linear + spin(&v_one.angular, &a_one.angular, &ends.arm_one)
            - a_two.linear
            - spin(&v_two.angular, &a_two.angular, &ends.arm_two);
        let along = |axis: &Vector3<f64>| {
            let u = self.direction(p, positions, axis);
            u.dot(&gap_second)
                + 2.0 * v_one.angular.cross(&u).dot(&gap_rate(v_one, v_two, ends))
                + spin(&v_one.angular, &a_one.angular, &u).dot(&(ends.one - ends.two))
        };
        let mut k = 0;
        for row in &self.rows {
            match row {
                Row::Coincident => gamma[k..k + 3].copy_from_slice(gap_second.as_slice()),
                Row::Along { axis } => gamma[k] = along(axis),
                Row::Screw { axis, pitch } => {
                    let w = [&v_one.angular, &v_two.angular];
                    let turn = self.turned(axis, positions);
                    gamma[k] = along(axis) + pitch * turn.bias(w, [&a_one.angular, &a_two.angular]);
                }
                Row::Angle {
                    on_predecessor,
                    on_successor,
                    ..
                } => {
                    let a = self.direction(p, positions, on_predecessor);
                    let b = self.direction(s, positions, on_successor);
                    gamma[k] = spin(&v_one.angular, &a_one.angular, &a).dot(&b)
                        + 2.0 * v_one.angular.cross(&a).dot(&v_two.angular.cross(&b))
                        + a.dot(&spin(&v_two.angular, &a_two.angular, &b));
                }
            }
            k += row.equations();
        }
    }

    /// The wrenches that multipliers exert on the predecessor and on the successor, each at its node's origin.
    #[inline]
    pub fn wrenches(&self, positions: &Positions, multipliers: &[f64]) -> (Wrench, Wrench) {
        let p = &self.predecessor;
        let ends = self.ends(positions);
        let (mut on_one, mut on_two) = (Wrench::zero(), Wrench::zero());
        let mut k = 0;
        for row in &self.rows {
            if let Row::Coincident = row {
                let force = Vector3::new(multipliers[k], multipliers[k + 1], multipliers[k + 2]);
                on_one.force += force;
                on_one.torque += ends.arm_one.cross(&force);
                on_two.force -= force;
                on_two.torque -= ends.arm_two.cross(&force);
            } else {
                let unit = self.unit_wrench(row, positions);
                let size = multipliers[k];
                let load = Wrench {
                    torque: unit.torque * size,
                    force: unit.force * size,
                };
                on_one += load.shifted(&(ends.two - positions.0[p.link.node()].origin));
                on_two -= load.shifted(&ends.arm_two);
            }
            k += row.equations();
        }
        (on_one, on_two)
    }
}

#[inline]
fn gap_rate(v_one: &Twist, v_two: &Twist, ends: &Ends) -> Vector3<f64> {
    v_one.linear + v_one.angular.cross(&ends.arm_one) - v_two.linear - v_two.angular.cross(&ends.arm_two)
}

/// The equations of a cut joint: as many as the joint takes freedoms away.
fn rows_of(joint: &Joint) -> Vec<Row> {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let orthogonal = |on_predecessor, on_successor| Row::Angle {
        on_predecessor,
        on_successor,
        cosine: 0.0,
    };
    let parallel = |axis: &Unit<Vector3<f64>>| {
        let (e1, e2) = plane_of(axis);
        [orthogonal(e1, **axis), orthogonal(e2, **axis)]
    };
    let across = |axis: &Unit<Vector3<f64>>| {
        let (e1, e2) = plane_of(axis);
        [Row::Along { axis: e1 }, Row::Along { axis: e2 }]
    };
    let no_turn = [orthogonal(x, y), orthogonal(y, z), orthogonal(z, x)];
    let mut rows = Vec::new();
    match joint {
        Joint::Fixed => {
            rows.push(Row::Coincident);
            rows.extend(no_turn);
        }
        Joint::Revolute { axis } => {
            rows.push(Row::Coincident);
            rows.extend(parallel(axis));
        }
        Joint::Prismatic { axis } => {
            rows.extend(across(axis));
            rows.extend(no_turn);
        }
        Joint::Cylindrical { axis } => {
            rows.extend(across(axis));
            rows.extend(parallel(axis));
        }
        Joint::Universal { first, second } => {
            rows.push(Row::Coincident);
            rows.push(Row::Angle {
                on_predecessor: **first,
                on_successor: **second,
                cosine: first.dot(second),
            });
        }
        Joint::SphericalZyx | Joint::Spherical => rows.push(Row::Coincident),
        Joint::Planar { normal, .. } => {
            rows.push(Row::Along { axis: **normal });
            rows.extend(parallel(normal));
        }
        Joint::Screw { axis, pitch } => {
            rows.extend(across(axis));
            rows.extend(parallel(axis));
            let (axis, pitch) = (**axis, *pitch);
            rows.push(Row::Screw { axis, pitch });
        }
        Joint::Free => {}
    }
    rows
}

/// Two unit vectors that make a right-handed frame with `axis`.
fn plane_of(axis: &Unit<Vector3<f64>>) -> (Vector3<f64>, Vector3<f64>) {
    let away = if axis.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let e1 = axis.cross(&away).normalize();
    (e1, axis.cross(&e1))
}

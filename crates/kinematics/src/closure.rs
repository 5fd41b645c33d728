//! Closures: the equations of cut joints that turn a tree into a mechanism with loops.
//!
//! A cut joint keeps some relative motions of two frames from happening. Every lower pair is a list of three kinds of
//! [`Row`]s, each of which is the same thing seen three ways: a residual `phi(q)`, a gradient of it, and a wrench on the
//! predecessor (the opposite on the successor). Multipliers are the sizes of those wrenches: the generalised force of the
//! closure is `+G^T lambda` with `G = d phi'/dv`.

use crate::joint::Joint;
use crate::motion::{Accelerations, Positions, Velocities};
use crate::tree::{Freedom, LinkId, Tree};
use crate::{Pose, Wrench};
use nalgebra::{Unit, Vector3};

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
}

impl Row {
    fn count(&self) -> usize {
        match self {
            Row::Coincident => 3,
            Row::Along { .. } | Row::Angle { .. } => 1,
        }
    }
}

/// A cut joint: its equations and the freedoms that move it.
#[derive(Clone, Debug, PartialEq)]
pub struct Closure {
    predecessor: Attachment,
    successor: Attachment,
    rows: Vec<Row>,
    equations: usize,
    /// Nodes whose freedom moves one side only: (node, +1 for the predecessor or -1 for the successor).
    path: Vec<(usize, f64)>,
}

/// A side of the closure in motion.
struct Side {
    point: Vector3<f64>,
    arm: Vector3<f64>,
}

impl Closure {
    /// Cuts `joint` between two frames. The joint's axes are those of the predecessor frame, as for
    /// [`Tree::attach`]; at zero joint coordinates both frames coincide.
    ///
    /// # Panics
    /// If a link is not of this tree.
    pub fn new(tree: &Tree, predecessor: Attachment, successor: Attachment, joint: &Joint) -> Self {
        Self::with_rows(tree, predecessor, successor, rows_of(joint))
    }

    /// Closure from equations of one's own choice.
    ///
    /// # Panics
    /// If a link is not of this tree.
    pub fn with_rows(tree: &Tree, predecessor: Attachment, successor: Attachment, rows: Vec<Row>) -> Self {
        let one: Vec<usize> = tree.path(predecessor.link).collect();
        let two: Vec<usize> = tree.path(successor.link).collect();
        let mut path: Vec<(usize, f64)> = Vec::new();
        // Freedoms below both sides carry the whole loop along and drop out.
        path.extend(one.iter().filter(|n| !two.contains(n)).map(|&n| (n, 1.0)));
        path.extend(two.iter().filter(|n| !one.contains(n)).map(|&n| (n, -1.0)));
        path.sort_by_key(|&(node, _)| node);
        let equations = rows.iter().map(Row::count).sum();
        Self {
            predecessor,
            successor,
            rows,
            equations,
            path,
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

    /// The frame on the predecessor.
    pub fn predecessor(&self) -> &Attachment {
        &self.predecessor
    }

    /// The frame on the successor.
    pub fn successor(&self) -> &Attachment {
        &self.successor
    }

    /// Nodes whose freedoms move the closure, in ascending order.
    pub fn path(&self) -> impl Iterator<Item = usize> + '_ {
        self.path.iter().map(|&(node, _)| node)
    }

    /// Names of the multipliers, one an equation.
    pub fn component_names(&self) -> Vec<String> {
        let mut names = Vec::new();
        let (mut forces, mut torques) = (0, 0);
        for row in &self.rows {
            match row {
                Row::Coincident => names.extend(["fx", "fy", "fz"].map(String::from)),
                Row::Along { .. } => {
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

    #[inline]
    fn side(&self, attachment: &Attachment, positions: &Positions) -> Side {
        let node = &positions.0[attachment.link.node()];
        let arm = node.rotation * attachment.pose.origin;
        Side {
            point: node.origin + arm,
            arm,
        }
    }

    #[inline]
    fn direction(&self, attachment: &Attachment, positions: &Positions, local: &Vector3<f64>) -> Vector3<f64> {
        positions.0[attachment.link.node()].rotation * (attachment.pose.rotation * local)
    }

    /// Residual `phi`, one number an equation \[m or -\].
    pub fn residual(&self, positions: &Positions, phi: &mut [f64]) {
        let (p, s) = (&self.predecessor, &self.successor);
        let gap = self.side(p, positions).point - self.side(s, positions).point;
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
            }
            k += row.count();
        }
    }

    /// Rate `phi' = G v` \[m/s or 1/s\].
    pub fn rate(&self, positions: &Positions, velocities: &Velocities, rate: &mut [f64]) {
        let (p, s) = (&self.predecessor, &self.successor);
        let (one, two) = (self.side(p, positions), self.side(s, positions));
        let (v_one, v_two) = (&velocities.0[p.link.node()], &velocities.0[s.link.node()]);
        let gap = one.point - two.point;
        let gap_rate = v_one.linear + v_one.angular.cross(&one.arm) - v_two.linear - v_two.angular.cross(&two.arm);
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
            }
            k += row.count();
        }
    }

    /// Gradient: `G^T`, written as `gradient[speed * stride + first + equation]` for the speeds on the closure's path; other
    /// entries are not touched (they are zero).
    #[inline]
    pub fn gradient(&self, tree: &Tree, positions: &Positions, gradient: &mut [f64], stride: usize, first: usize) {
        let (p, s) = (&self.predecessor, &self.successor);
        let one = self.side(p, positions).point;
        let two = self.side(s, positions).point;
        let mut k = first;
        for row in &self.rows {
            if let Row::Coincident = row {
                for &(i, sign) in &self.path {
                    let (node, here) = (&tree.nodes()[i], &positions.0[i]);
                    let column = match node.freedom {
                        Freedom::Linear => here.axis * sign,
                        _ => {
                            let point = if sign > 0.0 { one } else { two };
                            here.axis.cross(&(point - here.origin)) * sign
                        }
                    };
                    let at = node.speed * stride + k;
                    gradient[at..at + 3].copy_from_slice(column.as_slice());
                }
            } else {
                let unit = self.unit_wrench(row, positions);
                for &(i, sign) in &self.path {
                    let (node, here) = (&tree.nodes()[i], &positions.0[i]);
                    gradient[node.speed * stride + k] = sign
                        * match node.freedom {
                            Freedom::Linear => here.axis.dot(&unit.force),
                            _ => here.axis.dot(&unit.shifted(&(two - here.origin)).torque),
                        };
                }
            }
            k += row.count();
        }
    }

    /// The wrench on the predecessor that a unit multiplier of a one-equation row stands for, at the successor's point.
    fn unit_wrench(&self, row: &Row, positions: &Positions) -> Wrench {
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
        }
        unit
    }

    /// Bias `gamma`: the second rate of `phi` for vanishing rates of the speeds, so that `phi'' = G v' + gamma`.
    /// `biases` are those of [`Tree::sweep`]; a common base acceleration cancels.
    #[inline]
    pub fn bias(&self, positions: &Positions, velocities: &Velocities, biases: &Accelerations, gamma: &mut [f64]) {
        let (p, s) = (&self.predecessor, &self.successor);
        let (one, two) = (self.side(p, positions), self.side(s, positions));
        let (v_one, v_two) = (&velocities.0[p.link.node()], &velocities.0[s.link.node()]);
        let (a_one, a_two) = (&biases.0[p.link.node()], &biases.0[s.link.node()]);
        let spin = |w: &Vector3<f64>, a: &Vector3<f64>, r: &Vector3<f64>| a.cross(r) + w.cross(&w.cross(r));
        let gap_second = a_one.linear + spin(&v_one.angular, &a_one.angular, &one.arm)
            - a_two.linear
            - spin(&v_two.angular, &a_two.angular, &two.arm);
        let mut k = 0;
        for row in &self.rows {
            match row {
                Row::Coincident => gamma[k..k + 3].copy_from_slice(gap_second.as_slice()),
                Row::Along { axis } => {
                    let u = self.direction(p, positions, axis);
                    let gap = one.point - two.point;
                    let gap_rate =
                        v_one.linear + v_one.angular.cross(&one.arm) - v_two.linear - v_two.angular.cross(&two.arm);
                    gamma[k] = u.dot(&gap_second)
                        + 2.0 * v_one.angular.cross(&u).dot(&gap_rate)
                        + spin(&v_one.angular, &a_one.angular, &u).dot(&gap);
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
            k += row.count();
        }
    }

    /// The wrenches that multipliers exert on the predecessor and on the successor, each at its node's origin.
    #[inline]
    pub fn wrenches(&self, positions: &Positions, multipliers: &[f64]) -> (Wrench, Wrench) {
        let (p, s) = (&self.predecessor, &self.successor);
        let (one, two) = (self.side(p, positions), self.side(s, positions));
        let (mut on_one, mut on_two) = (Wrench::zero(), Wrench::zero());
        let mut k = 0;
        for row in &self.rows {
            if let Row::Coincident = row {
                let force = Vector3::new(multipliers[k], multipliers[k + 1], multipliers[k + 2]);
                on_one.force += force;
                on_one.torque += one.arm.cross(&force);
                on_two.force -= force;
                on_two.torque -= two.arm.cross(&force);
            } else {
                let unit = self.unit_wrench(row, positions);
                let size = multipliers[k];
                let load = Wrench {
                    torque: unit.torque * size,
                    force: unit.force * size,
                };
                on_one += load.shifted(&(two.point - positions.0[p.link.node()].origin));
                on_two -= load.shifted(&two.arm);
            }
            k += row.count();
        }
        (on_one, on_two)
    }
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
    }
    rows
}

/// Two unit vectors that make a right-handed frame with `axis`.
fn plane_of(axis: &Unit<Vector3<f64>>) -> (Vector3<f64>, Vector3<f64>) {
    let away = if axis.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let e1 = axis.cross(&away).normalize();
    (e1, axis.cross(&e1))
}

//! Articulated-body recursion \[Featherstone 2008, ch. 7\]: the inverse of the mass matrix of a tree as a product of one
//! inward and one outward walk, at a cost linear in the number of links.

use crate::columns::Columns;
use crate::composite::{ROUNDING, along};
use crate::evaluate::inertial_wrench;
use crate::symmetric::{SpatialInertia, Symmetric};
use linkdyn_kinematics::{Freedom, Node, NodePosition, Tree, Twist, Wrench};
use nalgebra::{Matrix3, Vector3};

/// Articulated inertia about a node's origin, global axes: `torque = I alpha + H a`, `force = H^T alpha + M a`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArticulatedInertia {
    angular: Symmetric,
    coupling: Matrix3<f64>,
    linear: Symmetric,
}

impl ArticulatedInertia {
    #[inline]
    pub fn rigid(body: &SpatialInertia) -> Self {
        Self {
            angular: body.second,
            coupling: body.moment.cross_matrix(),
            linear: Symmetric::axial(body.mass, 0.0, &Vector3::zeros()),
        }
    }

    /// Takes out the freedom that answers to `u` with pivot `1/inverse`.
    #[inline]
    fn release(&mut self, u: &Wrench, inverse: f64) {
        self.angular.subtract_square(inverse, &u.torque);
        self.linear.subtract_square(inverse, &u.force);
        self.coupling -= u.torque * (u.force * inverse).transpose();
    }

    /// Adds what a multiplier holds fast that acts by `w` and of which `inverse` is the inverse pivot.
    #[inline]
    pub fn hold(&mut self, w: &Wrench, inverse: f64) {
        self.release(w, -inverse);
    }

    /// Adds the same inertia seen from a point that lies `arm` before the origin to `target`. As a call it costs chains a tenth.
    #[inline(always)]
    fn add_shifted_to(&self, arm: &Vector3<f64>, target: &mut Self) {
        let m = &self.linear;
        let columns = [
            Vector3::new(m.xx, m.xy, m.xz),
            Vector3::new(m.xy, m.yy, m.yz),
            Vector3::new(m.xz, m.yz, m.zz),
        ];
        let coupling = self.coupling + Matrix3::from_columns(&columns.map(|c| arm.cross(&c)));
        // I - H [r] + [r] H'^T, of which only the upper triangle is needed. Row k of H [r] is h_k x r.
        let (h, g) = (&self.coupling, &coupling);
        let row = |k: usize| Vector3::new(h[(k, 0)], h[(k, 1)], h[(k, 2)]).cross(arm);
        let column = |k: usize| arm.cross(&Vector3::new(g[(k, 0)], g[(k, 1)], g[(k, 2)]));
        let (r0, r1, r2) = (row(0), row(1), row(2));
        let (c0, c1, c2) = (column(0), column(1), column(2));
        let i = &self.angular;
        target.angular.add(&Symmetric {
            xx: i.xx - r0.x + c0.x,
            yy: i.yy - r1.y + c1.y,
            zz: i.zz - r2.z + c2.z,
            xy: i.xy - r0.y + c1.x,
            xz: i.xz - r0.z + c2.x,
            yz: i.yz - r1.z + c2.y,
        });
        target.linear.add(m);
        target.coupling += coupling;
    }
}

/// What one freedom leaves behind: its wrench `U = IA S` and `1/(S U)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pivot {
    pub u: Wrench,
    pub inverse: f64,
}

impl Pivot {
    /// That of a node without a freedom.
    const NONE: Self = Self {
        u: Wrench {
            torque: Vector3::new(0.0, 0.0, 0.0),
            force: Vector3::new(0.0, 0.0, 0.0),
        },
        inverse: 0.0,
    };
}

/// What multipliers that are eliminated on the way do to the walks; without such, nothing.
pub(crate) trait Passengers {
    /// All that hangs on `node` has come in, its own freedom is still to be released.
    fn gathered(&mut self, _node: usize, _inertia: &mut ArticulatedInertia, _wrench: &mut Wrench) {}
    /// The freedom of `node` has been released, with the share (force by pivot) that it takes of the column.
    fn released(&mut self, _index: usize, _node: &Node, _here: &NodePosition, _pivot: &Pivot, _share: f64) {}
    /// As `gathered`, with known factors.
    fn gathered_column(&mut self, _node: usize, _wrench: &mut Wrench) {}
    /// As `released`, with known factors.
    fn released_column(&mut self, _node: usize, _share: f64) {}
    /// Adds what the multipliers do to the rate of the freedom of `node`; the walk outward has passed all nodes before.
    fn add_to_rate(&self, _node: usize, _inverse: f64, _rate: &mut f64) {}
    /// The acceleration of `node` is known.
    fn arrived(&mut self, _node: usize, _acceleration: &Twist) {}
}

impl Passengers for () {}

/// Factors of the articulated-body recursion.
#[derive(Clone, Debug)]
pub(crate) struct Articulated {
    inertias: Vec<ArticulatedInertia>,
    pivots: Vec<Pivot>,
    /// Largest mass and moment of inertia that took part in a node's inertia, times [`ROUNDING`]: pivots up to here are
    /// rounding, the freedom moves no mass.
    floors: Vec<(f64, f64)>,
    inverse_diagonal: Vec<f64>,
    wrenches: Vec<Wrench>,
    twists: Vec<Twist>,
}

impl Articulated {
    pub fn new(tree: &Tree) -> Self {
        let nodes = tree.nodes().len();
        Self {
            inertias: vec![ArticulatedInertia::rigid(&SpatialInertia::ZERO); nodes],
            pivots: vec![Pivot::NONE; nodes],
            floors: vec![(0.0, 0.0); nodes],
            inverse_diagonal: vec![0.0; tree.speeds()],
            wrenches: vec![Wrench::zero(); nodes],
            twists: vec![Twist::zero(); nodes],
        }
    }

    /// Factors the mass matrix and takes the first column of `columns` (the generalised forces, less the links' own bias
    /// `wrenches`) inward on the same walk. On failure tells the speed and its pivot.
    #[inline]
    pub fn factor(
        &mut self,
        nodes: &[Node],
        positions: &[NodePosition],
        bodies: &[SpatialInertia],
        wrenches: &[Wrench],
        columns: &mut Columns,
        passengers: &mut impl Passengers,
    ) -> Result<(), (usize, f64)> {
        for (articulated, body) in self.inertias.iter_mut().zip(bodies) {
            *articulated = ArticulatedInertia::rigid(body);
        }
        self.wrenches.copy_from_slice(wrenches);
        self.floors.fill((0.0, 0.0));
        for i in (1..nodes.len()).rev() {
            let (node, here) = (&nodes[i], &positions[i]);
            let mut inertia = self.inertias[i];
            let mut wrench = self.wrenches[i];
            passengers.gathered(i, &mut inertia, &mut wrench);
            let floors = (
                self.floors[i].0.max(ROUNDING * inertia.linear.trace()),
                self.floors[i].1.max(ROUNDING * inertia.angular.trace()),
            );
            if node.freedom != Freedom::None {
                let u = match node.freedom {
                    Freedom::Linear => Wrench {
                        torque: inertia.coupling * here.axis,
                        force: inertia.linear.times(&here.axis),
                    },
                    Freedom::Screw { pitch } => Wrench {
                        torque: inertia.angular.times(&here.axis) + inertia.coupling * here.axis * pitch,
                        force: inertia.coupling.tr_mul(&here.axis) + inertia.linear.times(&here.axis) * pitch,
                    },
                    Freedom::Angular | Freedom::None => Wrench {
                        torque: inertia.angular.times(&here.axis),
                        force: inertia.coupling.tr_mul(&here.axis),
                    },
                };
                let pivot = along(node, here, &u);
                let floor = match node.freedom {
                    Freedom::Linear => floors.0,
                    Freedom::Screw { pitch } => floors.1 + floors.0 * pitch * pitch,
                    Freedom::Angular | Freedom::None => floors.1,
                };
                if pivot.is_nan() || pivot <= floor {
                    return Err((node.speed, pivot));
                }
                let inverse = 1.0 / pivot;
                self.pivots[i] = Pivot { u, inverse };
                self.inverse_diagonal[node.speed] = inverse;
                let force = columns.at_mut(node.speed, 0);
                *force -= along(node, here, &wrench);
                if node.parent != 0 {
                    inertia.release(&u, inverse);
                    let share = *force * inverse;
                    wrench.torque += u.torque * share;
                    wrench.force += u.force * share;
                }
                passengers.released(i, node, here, &self.pivots[i], *force * inverse);
            } else {
                passengers.released(i, node, here, &Pivot::NONE, 0.0);
            }
            if node.parent != 0 {
                self.wrenches[node.parent] += wrench.shifted(&here.arm);
                inertia.add_shifted_to(&here.arm, &mut self.inertias[node.parent]);
                let target = &mut self.floors[node.parent];
                *target = (target.0.max(floors.0), target.1.max(floors.1));
            }
        }
        Ok(())
    }

    pub fn inverse_diagonal(&self) -> &[f64] {
        &self.inverse_diagonal
    }

    /// Takes a column of generalised forces inward.
    pub fn inward(
        &mut self,
        nodes: &[Node],
        positions: &[NodePosition],
        columns: &mut Columns,
        column: usize,
        passengers: &mut impl Passengers,
    ) {
        self.wrenches.fill(Wrench::zero());
        for i in (1..nodes.len()).rev() {
            let (node, here) = (&nodes[i], &positions[i]);
            let mut wrench = self.wrenches[i];
            passengers.gathered_column(i, &mut wrench);
            if node.freedom != Freedom::None {
                let force = columns.at_mut(node.speed, column);
                *force -= along(node, here, &wrench);
                let pivot = &self.pivots[i];
                let share = *force * pivot.inverse;
                wrench.torque += pivot.u.torque * share;
                wrench.force += pivot.u.force * share;
                passengers.released_column(i, share);
            }
            if node.parent != 0 {
                self.wrenches[node.parent] += wrench.shifted(&here.arm);
            }
        }
    }

    /// Takes off a column of generalised forces those that the `bodies` and the links' own `wrenches` (none if empty) ask for while
    /// the speeds change at `rates`.
    pub fn subtract_inertial(
        &mut self,
        nodes: &[Node],
        positions: &[NodePosition],
        (bodies, wrenches): (&[SpatialInertia], &[Wrench]),
        rates: &[f64],
        columns: &mut Columns,
        column: usize,
    ) {
        self.wrenches.fill(Wrench::zero());
        self.wrenches[..wrenches.len()].copy_from_slice(wrenches);
        for i in 1..nodes.len() {
            let (node, here) = (&nodes[i], &positions[i]);
            let mut twist = carried(&self.twists[node.parent], here);
            node.advance(&here.axis, |speed| rates[speed], &mut twist);
            self.wrenches[i] += inertial_wrench(&bodies[i], &twist);
            self.twists[i] = twist;
        }
        for i in (1..nodes.len()).rev() {
            let (node, here) = (&nodes[i], &positions[i]);
            let wrench = self.wrenches[i];
            if node.freedom != Freedom::None {
                *columns.at_mut(node.speed, column) -= along(node, here, &wrench);
            }
            self.wrenches[node.parent] += wrench.shifted(&here.arm);
        }
    }

    /// Takes a column, already divided by the pivots, outward to rates of the speeds.
    #[inline]
    pub fn outward(
        &mut self,
        nodes: &[Node],
        positions: &[NodePosition],
        columns: &mut Columns,
        column: usize,
        passengers: &mut impl Passengers,
    ) {
        for i in 1..nodes.len() {
            let (node, here) = (&nodes[i], &positions[i]);
            let mut twist = carried(&self.twists[node.parent], here);
            if node.freedom != Freedom::None {
                let pivot = &self.pivots[i];
                let rate = columns.at_mut(node.speed, column);
                passengers.add_to_rate(i, pivot.inverse, rate);
                if node.parent != 0 {
                    *rate -= pivot.u.power(&twist) * pivot.inverse;
                }
                node.advance(&here.axis, |_| *rate, &mut twist);
            }
            self.twists[i] = twist;
            passengers.arrived(i, &twist);
        }
    }
}

/// Acceleration of a node's origin as if fixed on the node before.
#[inline]
fn carried(before: &Twist, here: &NodePosition) -> Twist {
    Twist {
        angular: before.angular,
        linear: before.linear + before.angular.cross(&here.arm),
    }
}

//! Composite-body recursion \[Featherstone 2008, ch. 6\]: the mass matrix of a tree, factored as `M = L^T D L` without fill-in
//! \[Featherstone 2008, ch. 6.5\]. Cheapest for short branches; the cost grows with the square of their depth.

use crate::columns::{Columns, sized, subtract};
use crate::symmetric::SpatialInertia;
use linkdyn_kinematics::{Freedom, Node, NodePosition, Tree, Wrench};

/// No speed: the end of a path to the ground.
const NONE: usize = usize::MAX;

/// Share of a mass or moment of inertia that counts as rounding of it.
pub(crate) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Mass matrix and its factors.
#[derive(Clone, Debug)]
pub(crate) struct Composite {
    speeds: usize,
    /// Nearest speed below each speed on the way to the ground, or [`NONE`].
    below: Vec<usize>,
    /// All pairs of a speed and one below it, the highest first.
    pairs: Vec<(usize, usize)>,
    /// Row-major lower triangle: the mass matrix, then `L` (unit diagonal not stored).
    matrix: Vec<f64>,
    /// Pivots up to here are rounding: the freedom moves no mass.
    floor: Vec<f64>,
    inverse_diagonal: Vec<f64>,
    /// Composite inertias, a node each.
    inertias: Vec<SpatialInertia>,
}

impl Composite {
    pub fn new(tree: &Tree) -> Self {
        let n = tree.speeds();
        let mut below = vec![NONE; n];
        for node in tree.nodes().iter().filter(|node| node.freedom != Freedom::None) {
            let mut parent = node.parent;
            while parent != 0 && tree.nodes()[parent].freedom == Freedom::None {
                parent = tree.nodes()[parent].parent;
            }
            if parent != 0 {
                below[node.speed] = tree.nodes()[parent].speed;
            }
        }
        let ways = |i: usize| {
            std::iter::successors(below.get(i), |&&j| below.get(j))
                .copied()
                .take_while(|&j| j != NONE)
        };
        Self {
            speeds: n,
            pairs: (0..n).rev().flat_map(|i| ways(i).map(move |j| (i, j))).collect(),
            below,
            matrix: vec![0.0; n * n],
            floor: vec![0.0; n],
            inverse_diagonal: vec![0.0; n],
            inertias: vec![SpatialInertia::ZERO; tree.nodes().len()],
        }
    }

    /// Fills the mass matrix from the links' own inertias, and takes the bias `wrenches`, accumulated on the way, off the
    /// first column of `columns` (the generalised forces).
    #[inline]
    pub fn assemble(
        &mut self,
        nodes: &[Node],
        positions: &[NodePosition],
        bodies: &[SpatialInertia],
        wrenches: &mut [Wrench],
        columns: &mut Columns,
    ) {
        let n = self.speeds;
        self.inertias.copy_from_slice(bodies);
        for i in (1..nodes.len()).rev() {
            let (node, here) = (&nodes[i], &positions[i]);
            let (inertia, wrench) = (self.inertias[i], wrenches[i]);
            if node.freedom != Freedom::None {
                *columns.at_mut(node.speed, 0) -= along(node, here, &wrench);
                let mut force = match node.freedom {
                    Freedom::Linear => Wrench {
                        torque: inertia.moment.cross(&here.axis),
                        force: here.axis * inertia.mass,
                    },
                    Freedom::Screw { pitch } => Wrench {
                        torque: inertia.second.times(&here.axis) + inertia.moment.cross(&here.axis) * pitch,
                        force: here.axis.cross(&inertia.moment) + here.axis * (inertia.mass * pitch),
                    },
                    Freedom::Angular | Freedom::None => Wrench {
                        torque: inertia.second.times(&here.axis),
                        force: here.axis.cross(&inertia.moment),
                    },
                };
                self.floor[node.speed] = ROUNDING
                    * match node.freedom {
                        Freedom::Linear => inertia.mass,
                        Freedom::Screw { pitch } => inertia.second.trace() + inertia.mass * pitch * pitch,
                        Freedom::Angular | Freedom::None => inertia.second.trace(),
                    };
                let row = &mut self.matrix[node.speed * n..(node.speed + 1) * n];
                row[node.speed] = along(node, here, &force);
                let (mut k, mut arm) = (node.parent, &here.arm);
                while k != 0 {
                    force = force.shifted(arm);
                    if nodes[k].freedom != Freedom::None {
                        row[nodes[k].speed] = along(&nodes[k], &positions[k], &force);
                    }
                    (k, arm) = (nodes[k].parent, &positions[k].arm);
                }
            }
            if node.parent != 0 {
                wrenches[node.parent] += wrench.shifted(&here.arm);
                self.inertias[node.parent].add(&inertia.shifted(&here.arm));
            }
        }
    }

    /// The lower triangle of the mass matrix, row-major; to be filled by another formulation or read before factoring.
    pub fn matrix_mut(&mut self) -> &mut [f64] {
        &mut self.matrix
    }

    /// Factors the matrix in place. On failure tells the speed and its pivot.
    #[inline]
    pub fn factor(&mut self) -> Result<(), (usize, f64)> {
        let n = self.speeds;
        for k in (0..n).rev() {
            let (above, rest) = self.matrix.split_at_mut(k * n);
            let row = &mut rest[..n];
            let pivot = row[k];
            if pivot.is_nan() || pivot <= self.floor[k] {
                return Err((k, pivot));
            }
            let inverse = 1.0 / pivot;
            self.inverse_diagonal[k] = inverse;
            let mut i = self.below[k];
            while i != NONE {
                let a = row[i] * inverse;
                let target = &mut above[i * n..i * n + n];
                let mut j = i;
                while j != NONE {
                    target[j] -= a * row[j];
                    j = self.below[j];
                }
                row[i] = a;
                i = self.below[i];
            }
        }
        Ok(())
    }

    pub fn inverse_diagonal(&self) -> &[f64] {
        &self.inverse_diagonal
    }

    /// `L^-T` on all columns.
    #[inline]
    pub fn inward(&self, columns: &mut Columns) {
        let (n, width) = (self.speeds, columns.width());
        let fours = columns.fours_mut();
        sized!(width, [1, 2], |width| {
            for &(i, j) in &self.pairs {
                subtract(fours, width, j, self.matrix[i * n + j], i);
            }
        });
    }

    /// `L^-1` on all columns.
    #[inline]
    pub fn outward(&self, columns: &mut Columns) {
        let (n, width) = (self.speeds, columns.width());
        let fours = columns.fours_mut();
        sized!(width, [1, 2], |width| {
            for &(i, j) in self.pairs.iter().rev() {
                subtract(fours, width, i, self.matrix[i * n + j], j);
            }
        });
    }
}

/// The part of a wrench that works on a node's freedom.
#[inline]
pub(crate) fn along(node: &Node, here: &NodePosition, wrench: &Wrench) -> f64 {
    node.along(&here.axis, wrench)
}

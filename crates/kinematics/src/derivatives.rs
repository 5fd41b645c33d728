//! Homogeneous transforms of all nodes with their first and second derivatives `T_i`, `T_ij` (4 x 4), as the papers'
//! Lagrange equations need them.
//!
//! With `X_k` the transform of node `k` against the node before and `s_k` its constant generator (a 4 x 4 twist), moving
//! freedom `i` puts `s_i` behind `X_i`: `T_i = X_1 .. X_i s_i .. X_p`. For ball joints the derivatives are along the
//! speeds, `T_ij` being the derivative of `T_i` along speed `j`, so that `T'' = sum T_i v'_i + sum T_ij v_i v_j` always.

use crate::joint::{Motion, quaternion_rotation};
use crate::tree::{Freedom, LinkId, Tree};
use nalgebra::{Matrix4, Vector3};

/// Transforms of a tree at one position, ready to be differentiated.
#[derive(Clone, Debug)]
pub struct Transforms<'a> {
    tree: &'a Tree,
    local: Vec<Matrix4<f64>>,
    generators: Vec<Matrix4<f64>>,
}

impl Tree {
    /// Transforms for coordinates `q`.
    pub fn transforms(&self, q: &[f64]) -> Transforms<'_> {
        let mut local = Vec::with_capacity(self.nodes().len());
        let mut generators = Vec::with_capacity(self.nodes().len());
        for node in self.nodes() {
            let (x, axis) = match &node.motion {
                Motion::Turn(turn) => {
                    let rotation = turn.rotation(q[node.coordinate]);
                    (homogeneous(rotation, turn.origin), rotation.transpose() * turn.axis)
                }
                Motion::Slide(slide) => {
                    let origin = slide.origin + slide.axis * q[node.coordinate];
                    (
                        homogeneous(slide.rotation, origin),
                        slide.rotation.transpose() * slide.axis,
                    )
                }
                Motion::Screw(turn, pitch) => {
                    let origin = turn.origin + turn.axis * (pitch * q[node.coordinate]);
                    let rotation = turn.rotation(q[node.coordinate]);
                    (homogeneous(rotation, origin), rotation.transpose() * turn.axis)
                }
                Motion::Ball(offset) => {
                    let turned = quaternion_rotation(&q[node.coordinate..node.coordinate + 4]);
                    (homogeneous(offset.rotation * turned, offset.origin), Vector3::x())
                }
                Motion::BallNext(k) => (Matrix4::identity(), Vector3::ith(*k, 1.0)),
                Motion::Still(pose) => (pose.to_homogeneous(), Vector3::zeros()),
            };
            local.push(x);
            generators.push(match node.freedom {
                Freedom::None => Matrix4::zeros(),
                Freedom::Angular => generator(&axis, 1.0, 0.0),
                Freedom::Linear => generator(&axis, 0.0, 1.0),
                Freedom::Screw { pitch } => generator(&axis, 1.0, pitch),
            });
        }
        Transforms {
            tree: self,
            local,
            generators,
        }
    }
}

impl Transforms<'_> {
    /// The speeds that move a link, the last first.
    pub fn speeds_of(&self, link: LinkId) -> Vec<usize> {
        self.tree.path(link).map(|node| self.tree.nodes()[node].speed).collect()
    }

    /// `T` of a link.
    pub fn transform(&self, link: LinkId) -> Matrix4<f64> {
        self.chain(link, |_, x| x)
    }

    /// `T_i`: derivative of the link's transform along speed `i`; zero when `i` does not move the link.
    pub fn first(&self, link: LinkId, i: usize) -> Matrix4<f64> {
        let Some(node) = self.node_on_path(link, i) else {
            return Matrix4::zeros();
        };
        self.chain(link, |k, x| if k == node { x * self.generators[k] } else { x })
    }

    /// `T_ij`: derivative of `T_i` along speed `j`; zero when one of them does not move the link.
    pub fn second(&self, link: LinkId, i: usize, j: usize) -> Matrix4<f64> {
        let (Some(a), Some(b)) = (self.node_on_path(link, i), self.node_on_path(link, j)) else {
            return Matrix4::zeros();
        };
        if let (Some(first), Some(other)) = (self.ball_of(a), self.ball_of(b))
            && first == other
        {
            // The generators of a ball joint are fixed behind its rotation: moving j puts s_j before s_i.
            let both = self.generators[b] * self.generators[a];
            return self.chain(link, |k, x| if k == first { x * both } else { x });
        }
        self.chain(link, |k, x| {
            let mut x = x;
            if k == a {
                x *= self.generators[k];
            }
            if k == b {
                x *= self.generators[k];
            }
            x
        })
    }

    /// Product of the (changed) local transforms from the ground to the link.
    fn chain(&self, link: LinkId, change: impl Fn(usize, Matrix4<f64>) -> Matrix4<f64>) -> Matrix4<f64> {
        let mut product = Matrix4::identity();
        let mut k = link.node();
        while k != 0 {
            product = change(k, self.local[k]) * product;
            k = self.tree.nodes()[k].parent;
        }
        product
    }

    fn node_on_path(&self, link: LinkId, speed: usize) -> Option<usize> {
        self.tree.path(link).find(|&k| self.tree.nodes()[k].speed == speed)
    }

    /// First node of the ball joint that `node` belongs to.
    fn ball_of(&self, node: usize) -> Option<usize> {
        match self.tree.nodes()[node].motion {
            Motion::Ball(_) => Some(node),
            Motion::BallNext(k) => Some(node - k),
            _ => None,
        }
    }
}

fn homogeneous(rotation: nalgebra::Matrix3<f64>, origin: Vector3<f64>) -> Matrix4<f64> {
    crate::Pose { rotation, origin }.to_homogeneous()
}

/// Derivative of a transform behind it: so much turn about an axis with so much slide along it.
fn generator(axis: &Vector3<f64>, turn: f64, slide: f64) -> Matrix4<f64> {
    let mut s = Matrix4::zeros();
    s.fixed_view_mut::<3, 3>(0, 0).copy_from(&(axis.cross_matrix() * turn));
    s.fixed_view_mut::<3, 1>(0, 3).copy_from(&(axis * slide));
    s
}

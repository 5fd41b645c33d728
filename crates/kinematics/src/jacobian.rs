//! Jacobians of points and frames: velocities as linear functions of the speeds.

use crate::motion::Positions;
use crate::tree::{LinkId, Tree};
use nalgebra::{DMatrix, Vector3};

impl Tree {
    /// `d(velocity of a point of link)/dv`, 3 x nv, global axes; `point` in the link's frame \[m\].
    pub fn point_jacobian(&self, positions: &Positions, link: LinkId, point: &Vector3<f64>) -> DMatrix<f64> {
        self.frame_jacobian(positions, link, point).rows(3, 3).into_owned()
    }

    /// `d(angular velocity; velocity of a point of link)/dv`, 6 x nv, global axes; `point` in the link's frame \[m\].
    pub fn frame_jacobian(&self, positions: &Positions, link: LinkId, point: &Vector3<f64>) -> DMatrix<f64> {
        let p = positions.pose(link).point(point);
        let mut jacobian = DMatrix::zeros(6, self.speeds());
        for i in self.path(link) {
            let (node, here) = (&self.nodes()[i], &positions.nodes()[i]);
            let unit = node.unit_twist(&here.axis);
            let linear = unit.linear + unit.angular.cross(&(p - here.origin));
            jacobian.fixed_view_mut::<3, 1>(0, node.speed).copy_from(&unit.angular);
            jacobian.fixed_view_mut::<3, 1>(3, node.speed).copy_from(&linear);
        }
        jacobian
    }
}

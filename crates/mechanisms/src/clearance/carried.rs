//! What clearance makes of a joint of the tree: slides before it, and tilts behind its turn.

use super::ClearanceModel;
use crate::linkage::JointItem;
use linkdyn_kinematics::Joint;
use nalgebra::{Unit, Vector3};

impl JointItem {
    /// Slides of the journal in its bearing, which stand in the tree before the joint: all directions but the axis of a revolute joint.
    pub(crate) fn slides(&self) -> impl Iterator<Item = Joint> + use<> {
        let directions: [Unit<Vector3<f64>>; 3] = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
        directions
            .into_iter()
            .take(self.offset_names().len())
            .map(|axis| Joint::Prismatic { axis })
    }

    /// Whether the axis of the joint may tilt.
    pub(crate) fn tilts(&self) -> bool {
        matches!(self.model(), Some(ClearanceModel::Spatial { .. }))
    }

    /// The model of its clearance, if the joint may have one.
    fn model(&self) -> Option<ClearanceModel> {
        let model = self.clearance.as_ref().map(|clearance| clearance.model);
        model.filter(|model| model.fits(&self.joint))
    }

    fn offset_names(&self) -> &'static [&'static str] {
        match self.model() {
            None => &[],
            Some(ClearanceModel::Planar | ClearanceModel::Spatial { .. }) => &["x", "y"],
            Some(ClearanceModel::Spherical) => &["x", "y", "z"],
        }
    }

    /// Names of the coordinates of the joint itself where none are given.
    pub(crate) fn own_names(&self) -> &'static [&'static str] {
        match (&self.joint, &self.clearance) {
            (Joint::Spherical, Some(_)) => &["qw", "qx", "qy", "qz"],
            (joint, _) => joint.coordinate_names(),
        }
    }

    /// The joint's own names between those of its slides and of its tilts.
    pub(crate) fn with_offsets(&self, own: Vec<String>) -> Vec<String> {
        let local = |name: &&str| format!("{}.{name}", self.name);
        let mut names: Vec<String> = self.offset_names().iter().map(local).collect();
        names.extend(own);
        if self.tilts() {
            names.extend(["theta", "phi"].iter().map(local));
        }
        names
    }
}

//! What clearance makes of a joint of the tree: slides before it, and tilts behind its turn.

use super::ClearanceModel;
use crate::linkage::{JointItem, qualified};
use linkdyn_kinematics::Joint;
use nalgebra::{Unit, Vector3};

impl JointItem {
    /// Slides of the journal in its bearing, which stand in the tree before the joint: all directions but the axis of a revolute joint.
    pub(crate) fn slides(&self) -> impl Iterator<Item = Joint> + use<> {
        let directions: [Unit<Vector3<f64>>; 3] = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
        directions
            .into_iter()
            .take(offset_names(self.model()).len())
            .map(|axis| Joint::Prismatic { axis })
    }

    /// Whether the axis of the joint may tilt.
    pub(crate) fn tilts(&self) -> bool {
        tilts(self.model())
    }

    /// The model of its clearance, if the joint may have one.
    pub(crate) fn model(&self) -> Option<ClearanceModel> {
        let model = self.clearance.as_ref().map(|clearance| clearance.model);
        model.filter(|model| model.fits(&self.joint))
    }
}

fn tilts(model: Option<ClearanceModel>) -> bool {
    matches!(model, Some(ClearanceModel::Spatial { .. }))
}

fn offset_names(model: Option<ClearanceModel>) -> &'static [&'static str] {
    match model {
        None => &[],
        Some(ClearanceModel::Planar | ClearanceModel::Spatial { .. }) => &["x", "y"],
        Some(ClearanceModel::Spherical) => &["x", "y", "z"],
    }
}

/// Names of all coordinates or speeds of a joint of the tree with such a clearance: its `own`, those of its coordinates unless given,
/// between those of its slides and of its tilts.
pub(crate) fn names(joint: &str, kind: &Joint, model: Option<ClearanceModel>, own: Option<&[String]>) -> Vec<String> {
    let local = |names: &'static [&'static str]| names.iter().map(move |name| format!("{joint}.{name}"));
    let own = own.map_or_else(
        || match (kind, model) {
            (Joint::Spherical, Some(_)) => qualified(joint, &["qw", "qx", "qy", "qz"]),
            _ => qualified(joint, kind.coordinate_names()),
        },
        <[String]>::to_vec,
    );
    let tilts: &[&str] = if tilts(model) { &["theta", "phi"] } else { &[] };
    local(offset_names(model)).chain(own).chain(local(tilts)).collect()
}

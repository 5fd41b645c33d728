//! Bristles of a touch: their states, and the friction that they make.
//!
//! In a plane the bristle's deflection is a number along the tangent, at an edge two along tangent and axis, which the bearing's axis
//! carries along. On a ball no two tangents can be chosen that are continuous everywhere. There the deflection is a vector in the
//! socket's axes, at right angles to the normal and carried along with it: three states, and friction that no choice of tangents
//! changes, since models of bristles know no direction but those of slip and deflection.

use super::load::Pair;
use super::{Clearance, ClearanceModel};
use linkdyn_contact::Touch;
use linkdyn_friction::{Bristle, BristleModel};
use nalgebra::{Matrix3, Vector3};

/// Friction at a touch.
pub(super) struct Rubbing {
    /// Coefficients along tangent and axis of the touch.
    pub coefficients: [f64; 2],
    /// Rates of the states \[m/s\].
    pub rates: [f64; 3],
}

impl Clearance {
    /// In how many directions there is friction, which is the number of states at each point.
    pub(super) fn directions(&self) -> usize {
        match (&self.friction, self.model) {
            (None, _) => 0,
            (Some(_), ClearanceModel::Planar) => 1,
            (Some(_), ClearanceModel::Spatial { .. }) => 2,
            (Some(_), ClearanceModel::Spherical) => 3,
        }
    }

    /// Coefficients and rates at a touch for the states `z`; `axes` are those of the bearing, asked for where they count.
    #[inline]
    pub(super) fn rubbing(&self, touch: &Touch, pair: &Pair, axes: impl Fn() -> Matrix3<f64>, z: &[f64]) -> Rubbing {
        let (mut coefficients, mut rates) = ([0.0; 2], [0.0; 3]);
        match (&self.friction, z) {
            (Some(model), &[z]) => {
                let at = model.at(touch.slip, z);
                coefficients[0] = at.coefficient.value;
                rates[0] = at.rate.value;
            }
            (Some(model), &[z1, z2]) => {
                let at = model.at_planar([touch.slip, touch.axial_slip], [z1, z2]);
                coefficients = at.coefficient;
                rates[..2].copy_from_slice(&at.rate);
            }
            (Some(model), &[x, y, z]) => {
                let axes = axes();
                let lean = axes * Vector3::new(x, y, z);
                let parts = [lean.dot(&touch.tangent), lean.dot(&touch.axis)];
                let at = model.at_planar([touch.slip, touch.axial_slip], parts);
                let turning = touch.normal_rate(&pair.bearing, &pair.journal).dot(&lean);
                coefficients = at.coefficient;
                rates = axes
                    .tr_mul(&(on_tangents(touch, at.rate) - touch.normal * turning))
                    .into();
            }
            _ => {}
        }
        Rubbing { coefficients, rates }
    }

    /// A vector of the tangent plane by the directions in which it is observed, from its parts along tangent and axis.
    pub(super) fn in_directions(&self, touch: &Touch, axes: &Matrix3<f64>, parts: [f64; 2]) -> [f64; 3] {
        match self.model {
            ClearanceModel::Planar | ClearanceModel::Spatial { .. } => [parts[0], parts[1], 0.0],
            ClearanceModel::Spherical => axes.tr_mul(&on_tangents(touch, parts)).into(),
        }
    }

    /// States of a bristle where a contact is made.
    pub(super) fn begin_rubbing(&self, model: &Bristle, touch: &Touch, axes: &Matrix3<f64>, z: &mut [f64]) {
        let (start, model) = (self.bristle_start, model.model());
        if let [z] = z {
            *z = start.deflection(model, touch.slip);
            return;
        }
        let parts = start.planar_deflection(model, [touch.slip, touch.axial_slip]);
        let count = z.len();
        z.copy_from_slice(&self.in_directions(touch, axes, parts)[..count]);
    }
}

fn on_tangents(touch: &Touch, parts: [f64; 2]) -> Vector3<f64> {
    touch.tangent * parts[0] + touch.axis * parts[1]
}

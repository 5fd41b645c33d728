//! One place of contact, and forces there.

use super::{Centre, Fit};
use nalgebra::Vector3;

/// The place where a journal touches its bearing, or would touch it first.
///
/// Signs (Augustynek and Urbaś): e points from the journal's centre to that of the bearing, n = e/|e|, so that the
/// contact lies at -n from both centres and a normal force f_n ≥ 0 moves the **bearing along -n**, the journal
/// along +n. t = axis × n; slips are velocities of the **bearing's surface against the journal's**.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Depth δ = |e| - clearance \[m\]; negative while there is a gap.
    pub depth: f64,
    /// Rate of the depth \[m/s\].
    pub rate: f64,
    /// n, unit.
    pub normal: Vector3<f64>,
    /// t = axis × n, unit.
    pub tangent: Vector3<f64>,
    /// Axis of the plane in which e lies, unit.
    pub axis: Vector3<f64>,
    /// Slip along t of the two material points, the one of the bearing's surface and the one of the journal's \[m/s\].
    pub slip: f64,
    /// Their slip along the axis \[m/s\].
    pub axial_slip: f64,
    /// The point of the bearing's surface \[m\].
    pub bearing_point: Vector3<f64>,
    /// The point of the journal's surface \[m\], δ n before the other one.
    pub journal_point: Vector3<f64>,
}

/// What a plane normal to `axis` shows: the centres there, and the rate of their distance.
pub(super) struct Section {
    pub axis: Vector3<f64>,
    pub bearing_centre: Vector3<f64>,
    pub journal_centre: Vector3<f64>,
    pub normal: Vector3<f64>,
    pub distance: f64,
    pub rate: f64,
}

impl Touch {
    pub(super) fn new(fit: &Fit, section: Section, bearing: &Centre, journal: &Centre) -> Self {
        let (n, axis) = (section.normal, section.axis);
        let t = axis.cross(&n);
        let bearing_point = section.bearing_centre - n * fit.bearing_radius();
        let journal_point = section.journal_centre - n * fit.journal_radius();
        let v = bearing.velocity_at(&bearing_point) - journal.velocity_at(&journal_point);
        Self {
            depth: section.distance - fit.clearance(),
            rate: section.rate,
            normal: n,
            tangent: t,
            axis,
            slip: v.dot(&t),
            axial_slip: v.dot(&axis),
            bearing_point,
            journal_point,
        }
    }

    /// Whether the surfaces meet, δ ≥ 0.
    #[inline]
    pub fn is_contact(&self) -> bool {
        self.depth >= 0.0
    }

    /// Force of a normal force f_n \[N\] and of friction \[N\] along t and along the axis. Friction has the sign of
    /// the slip that it opposes: give µ f_n with the coefficient of a law for `slip` and `axial_slip`.
    #[inline]
    pub fn force(&self, normal: f64, friction: [f64; 2], at: ForcePoint) -> ContactForce {
        let force = -(self.normal * normal + self.tangent * friction[0] + self.axis * friction[1]);
        let (bearing_point, journal_point) = match at {
            ForcePoint::OwnSurface => (self.bearing_point, self.journal_point),
            ForcePoint::Common => {
                let middle = 0.5 * (self.bearing_point + self.journal_point);
                (middle, middle)
            }
        };
        ContactForce {
            on_bearing: force,
            bearing_point,
            journal_point,
        }
    }
}

/// Where on the two bodies the contact force acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ForcePoint {
    /// On each body at its own surface (Augustynek and Urbaś). The points differ by the depth, which leaves a couple
    /// δ f_t: angular momentum is not kept.
    OwnSurface,
    /// On both at the point half-way between the surfaces: action equals reaction on one line. The bodies' material
    /// points there slip by δ (ω_b + ω_j)·axis/2 less than the surfaces.
    #[default]
    Common,
}

/// A force on the bearing and its opposite on the journal, with their points of application.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// Force on the bearing's body \[N\]; the journal's body gets its opposite.
    pub on_bearing: Vector3<f64>,
    /// Where it acts on the bearing's body \[m\].
    pub bearing_point: Vector3<f64>,
    /// Where its opposite acts on the journal's body \[m\].
    pub journal_point: Vector3<f64>,
}

impl ContactForce {
    /// Torque \[N m\] about a point \[m\] of what acts on the bearing's body.
    #[inline]
    pub fn torque_on_bearing(&self, about: &Vector3<f64>) -> Vector3<f64> {
        (self.bearing_point - about).cross(&self.on_bearing)
    }

    /// Torque \[N m\] about a point \[m\] of what acts on the journal's body.
    #[inline]
    pub fn torque_on_journal(&self, about: &Vector3<f64>) -> Vector3<f64> {
        self.on_bearing.cross(&(self.journal_point - about))
    }

    /// Power \[W\] that the contact does on both bodies together: the negative rate of stored energy and losses.
    #[inline]
    pub fn power(&self, bearing: &Centre, journal: &Centre) -> f64 {
        let v = bearing.velocity_at(&self.bearing_point) - journal.velocity_at(&self.journal_point);
        self.on_bearing.dot(&v)
    }
}

use super::touch::Section;
use super::{Centre, Touch};
use crate::{Expected, ParameterError};
use nalgebra::Vector3;

/// Radii of a bearing (hole) and the smaller journal (pin) in it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Radii", into = "Radii"))]
pub struct Fit {
    bearing_radius: f64,
    journal_radius: f64,
}

impl Fit {
    /// A fit of two radii \[m\].
    ///
    /// # Errors
    /// Radii that are not positive, a journal that is not smaller than the bearing.
    pub fn new(bearing_radius: f64, journal_radius: f64) -> Result<Self, ParameterError> {
        Expected::Positive.check("bearing_radius", bearing_radius)?;
        Expected::Below {
            bound: bearing_radius,
            of: "bearing_radius",
        }
        .check("journal_radius", journal_radius)?;
        Ok(Self {
            bearing_radius,
            journal_radius,
        })
    }

    /// R_b \[m\].
    #[inline]
    pub fn bearing_radius(&self) -> f64 {
        self.bearing_radius
    }

    /// R_j \[m\].
    #[inline]
    pub fn journal_radius(&self) -> f64 {
        self.journal_radius
    }

    /// Radial clearance c = R_b - R_j > 0 \[m\].
    #[inline]
    pub fn clearance(&self) -> f64 {
        self.bearing_radius - self.journal_radius
    }

    /// Gap c - |e| \[m\] of the planar joint: positive while the journal is free, minus the depth in contact.
    /// Continuous everywhere, smooth but for a ridge where the centres coincide.
    #[inline]
    pub fn gap(&self, bearing: &Centre, journal: &Centre) -> f64 {
        self.clearance() - offset(bearing, journal).norm()
    }

    /// Rate of the gap \[m/s\]; where the centres coincide the one a moment later.
    #[inline]
    pub fn gap_rate(&self, bearing: &Centre, journal: &Centre) -> f64 {
        let e = offset(bearing, journal);
        let rate = offset_rate(bearing, journal);
        let d = e.norm();
        if d > 0.0 {
            -rate.dot(&(e / d))
        } else {
            -in_plane(&rate, &journal.axis).norm()
        }
    }

    /// The planar joint: e is the part of `bearing.point - journal.point` normal to the **journal's** axis.
    ///
    /// `None` where the centres are closer than half the clearance: there is no contact then, and soon no direction.
    /// Otherwise the place where the surfaces touch or come closest; a law gives no force for its negative depth.
    /// While the axes stay parallel and the points side by side, the rate is ė·n and the slip
    /// ė·t - R_b ω_b·x + R_j ω_j·x (Augustynek and Urbaś); the rate is exact without that, too.
    pub fn planar(&self, bearing: &Centre, journal: &Centre) -> Option<Touch> {
        let e = offset(bearing, journal);
        let distance = e.norm();
        if distance < 0.5 * self.clearance() {
            return None;
        }
        let normal = e / distance;
        let section = Section {
            axis: journal.axis,
            bearing_centre: bearing.point,
            journal_centre: journal.point,
            normal,
            distance,
            rate: offset_rate(bearing, journal).dot(&normal),
        };
        Some(Touch::new(self, section, bearing, journal))
    }
}

/// v without its part along the unit vector.
fn in_plane(v: &Vector3<f64>, axis: &Vector3<f64>) -> Vector3<f64> {
    v - axis * v.dot(axis)
}

/// e \[m\].
fn offset(bearing: &Centre, journal: &Centre) -> Vector3<f64> {
    in_plane(&(bearing.point - journal.point), &journal.axis)
}

/// Rate of e \[m/s\], up to a part along the axis.
fn offset_rate(bearing: &Centre, journal: &Centre) -> Vector3<f64> {
    let along = (bearing.point - journal.point).dot(&journal.axis);
    bearing.velocity - journal.velocity - journal.axis_rate() * along
}

/// The serialised form, checked when it is read.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Radii {
    bearing_radius: f64,
    journal_radius: f64,
}

#[cfg(feature = "serde")]
impl TryFrom<Radii> for Fit {
    type Error = ParameterError;

    fn try_from(given: Radii) -> Result<Self, ParameterError> {
        Self::new(given.bearing_radius, given.journal_radius)
    }
}

#[cfg(feature = "serde")]
impl From<Fit> for Radii {
    fn from(fit: Fit) -> Self {
        Self {
            bearing_radius: fit.bearing_radius,
            journal_radius: fit.journal_radius,
        }
    }
}

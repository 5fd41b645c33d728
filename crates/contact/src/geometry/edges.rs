//! The spatial joint: a journal that may tilt touches the two edges of its bearing.

use super::touch::Section;
use super::{Centre, Fit, Touch};
use nalgebra::Vector3;

/// The axes enclose an angle at which edges of a bearing say nothing about contact any more.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the journal's axis is inclined against the bearing's by {angle} rad; a clearance joint admits at most pi/3")]
pub struct Skewed {
    /// Angle between the two lines \[rad\].
    pub angle: f64,
}

/// How a journal lies in the two edges of its bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pattern {
    /// No contact.
    Free,
    /// Contact at one edge.
    Point,
    /// Contact at both edges on the same side: along a line.
    Line,
    /// Contact at both edges on opposite sides: the journal is wedged across.
    Opposite,
}

impl Pattern {
    /// Of the two touches of [`Fit::edges`].
    pub fn of(touches: &[Option<Touch>; 2]) -> Self {
        let [first, second] = touches.map(|touch| touch.filter(Touch::is_contact));
        match (first, second) {
            (None, None) => Self::Free,
            (Some(a), Some(b)) if a.normal.dot(&b.normal) > 0.0 => Self::Line,
            (Some(_), Some(_)) => Self::Opposite,
            _ => Self::Point,
        }
    }
}

/// One edge: the centres in its plane, e between them, the plane's axis.
struct Edge {
    bearing_centre: Vector3<f64>,
    journal_centre: Vector3<f64>,
    e: Vector3<f64>,
    e_rate: Vector3<f64>,
    axis: Vector3<f64>,
}

impl Edge {
    /// The two edges at +L/2 and -L/2 along the bearing's axis (Flores, Ambrósio, Claro, Lankarani 2006).
    fn both(length: f64, bearing: &Centre, journal: &Centre) -> Result<[Self; 2], Skewed> {
        let cos = bearing.axis.dot(&journal.axis);
        if cos.is_nan() || cos.abs() < 0.5 {
            return Err(Skewed {
                angle: cos.abs().acos(),
            });
        }
        let (a, da) = (bearing.axis, bearing.axis_rate());
        let (u, du) = (journal.axis, journal.axis_rate());
        Ok([0.5 * length, -0.5 * length].map(|along| {
            let (p, dp) = (bearing.point + a * along, bearing.velocity + da * along);
            // q = r_j + s u with a·(q - p) = 0.
            let s = a.dot(&(p - journal.point)) / cos;
            let q = journal.point + u * s;
            let carried = journal.velocity + du * s;
            let ds = (da.dot(&(p - q)) + a.dot(&(dp - carried))) / cos;
            Self {
                bearing_centre: p,
                journal_centre: q,
                e: p - q,
                e_rate: dp - carried - u * ds,
                axis: a,
            }
        }))
    }

    fn gap_rate(&self) -> f64 {
        let d = self.e.norm();
        if d > 0.0 {
            -self.e_rate.dot(&(self.e / d))
        } else {
            -self.e_rate.norm()
        }
    }

    fn touch(&self, fit: &Fit, bearing: &Centre, journal: &Centre) -> Option<Touch> {
        let distance = self.e.norm();
        if distance < 0.5 * fit.clearance() {
            return None;
        }
        let normal = self.e / distance;
        let section = Section {
            axis: self.axis,
            bearing_centre: self.bearing_centre,
            journal_centre: self.journal_centre,
            normal,
            distance,
            rate: self.e_rate.dot(&normal),
        };
        Some(Touch::new(fit, section, bearing, journal))
    }
}

impl Fit {
    /// Gaps c - |e| \[m\] at the two edges of a bearing of some length \[m\], at `+length/2` and `-length/2` along its
    /// axis from its point. The journal's axis is met with the edge planes, which are normal to the **bearing's** axis.
    ///
    /// The section of an inclined journal is taken for a circle; it is an ellipse, longer by about R_j tilt²/2.
    ///
    /// # Errors
    /// Axes that enclose more than 60 degrees.
    pub fn edge_gaps(&self, length: f64, bearing: &Centre, journal: &Centre) -> Result<[f64; 2], Skewed> {
        Ok(Edge::both(length, bearing, journal)?.map(|edge| self.clearance() - edge.e.norm()))
    }

    /// Rates of these gaps \[m/s\]; where the centres coincide the ones a moment later.
    ///
    /// # Errors
    /// As [`edge_gaps`](Self::edge_gaps).
    pub fn edge_gap_rates(&self, length: f64, bearing: &Centre, journal: &Centre) -> Result<[f64; 2], Skewed> {
        Ok(Edge::both(length, bearing, journal)?.map(|edge| edge.gap_rate()))
    }

    /// The spatial joint: two contacts independent of each other, each as in [`planar`](Self::planar) but with the
    /// bearing's axis. Together they make the four cases of [`Pattern`]. With half the stiffness each, contact along a
    /// line is as stiff as the planar joint.
    ///
    /// The normals are normal to the bearing's axis. Against a tilted journal they are not quite those of its surface,
    /// so that the power of the normal force is -f_n δ' only up to f_n times tilt times the axial speed: take
    /// [`ContactForce::power`](crate::ContactForce::power) for balances.
    ///
    /// # Errors
    /// As [`edge_gaps`](Self::edge_gaps).
    pub fn edges(&self, length: f64, bearing: &Centre, journal: &Centre) -> Result<[Option<Touch>; 2], Skewed> {
        Ok(Edge::both(length, bearing, journal)?.map(|edge| edge.touch(self, bearing, journal)))
    }
}

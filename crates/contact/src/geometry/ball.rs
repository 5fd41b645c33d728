//! The spherical joint: a ball in a socket that is a little larger.

use super::touch::Section;
use super::{Centre, Fit, Touch};
use nalgebra::Vector3;

impl Fit {
    /// Gap c - |e| \[m\] of a ball (the journal) in a socket (the bearing), `e = socket.point - ball.point`; the axes say nothing.
    /// Continuous everywhere, smooth but for a ridge where the centres coincide.
    #[inline]
    pub fn ball_gap(&self, socket: &Centre, ball: &Centre) -> f64 {
        self.clearance() - (socket.point - ball.point).norm()
    }

    /// Rate of the gap \[m/s\]; where the centres coincide the one a moment later.
    #[inline]
    pub fn ball_gap_rate(&self, socket: &Centre, ball: &Centre) -> f64 {
        let (e, rate) = (socket.point - ball.point, socket.velocity - ball.velocity);
        let d = e.norm();
        if d > 0.0 { -rate.dot(&(e / d)) } else { -rate.norm() }
    }

    /// The spherical joint (Flores and Lankarani 2010): one contact, its normal along e.
    ///
    /// `None` where the centres are closer than half the clearance, as for [`planar`](Self::planar). The power of the normal force
    /// is -f_n δ' exactly. Nothing distinguishes a direction in the tangent plane of a ball: [`Touch::tangent`] and [`Touch::axis`]
    /// are two that follow from n alone and jump somewhere. What is made of them must not depend on the choice: take vectors, such
    /// as `tangent * slip + axis * axial_slip`, and bristles with [`Touch::normal_rate`].
    pub fn ball(&self, socket: &Centre, ball: &Centre) -> Option<Touch> {
        let e = socket.point - ball.point;
        let distance = e.norm();
        if distance < 0.5 * self.clearance() {
            return None;
        }
        let normal = e / distance;
        let section = Section {
            axis: across(&normal),
            bearing_centre: socket.point,
            journal_centre: ball.point,
            normal,
            distance,
            rate: (socket.velocity - ball.velocity).dot(&normal),
        };
        Some(Touch::new(self, section, socket, ball))
    }
}

impl Touch {
    /// Rate of the normal of a [ball in its socket](Fit::ball), as seen from the socket \[1/s\]: `ṅ - ω_b × n` in the common frame,
    /// with `ṅ = (ė - n (n·ė))/|e|`.
    ///
    /// A vector z in the tangent plane that is carried along with it, without a turn about the normal, has the rate `-n (ṅ·z)` in
    /// the socket: its length and its right angle to n stay. A bristle of a ball is such a vector, with the rate of its model besides.
    #[inline]
    pub fn normal_rate(&self, socket: &Centre, ball: &Centre) -> Vector3<f64> {
        let (e, rate) = (socket.point - ball.point, socket.velocity - ball.velocity);
        let n = self.normal;
        (rate - n * n.dot(&rate)) / e.norm() - socket.spin.cross(&n)
    }
}

/// A unit vector at right angles to the unit vector n: its product with the axis from which it is farthest.
fn across(n: &Vector3<f64>) -> Vector3<f64> {
    let mut away = Vector3::zeros();
    away[n.iamin()] = 1.0;
    n.cross(&away).normalize()
}

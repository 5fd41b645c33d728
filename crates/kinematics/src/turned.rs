//! The angle by which one frame is turned about an axis against another, with gradient and rates.

use nalgebra::Vector3;
use std::ops::{Add, Sub};

/// Two axes across the axis of the turn, at right angles, of each frame, in global axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned {
    pub one: [Vector3<f64>; 2],
    pub two: [Vector3<f64>; 2],
}

impl Turned {
    /// Sine and cosine, both with the same positive factor, out of products of the axes; or what a linear function of the products
    /// makes of them.
    #[inline]
    fn sine_and_cosine<T: Add<Output = T> + Sub<Output = T>>(
        &self,
        product: impl Fn(&Vector3<f64>, &Vector3<f64>) -> T,
    ) -> (T, T) {
        let ([a1, a2], [b1, b2]) = (&self.one, &self.two);
        (product(a2, b1) - product(a1, b2), product(a1, b1) + product(a2, b2))
    }

    /// Angle of the second frame against the first, from -pi to pi.
    #[inline(never)]
    pub fn angle(&self) -> f64 {
        let (s, c) = self.sine_and_cosine(Vector3::dot);
        s.atan2(c)
    }

    /// The vector `t` in `angle' = t . (w_one - w_two)`; zero where the axes are opposite and there is no angle.
    #[inline(never)]
    pub fn gradient(&self) -> Vector3<f64> {
        let (s, c) = self.sine_and_cosine(Vector3::dot);
        let (ds, dc) = self.sine_and_cosine(Vector3::cross);
        (ds * c - dc * s) * reciprocal(s * s + c * c)
    }

    /// Rate for the angular velocities of both frames.
    #[inline(never)]
    pub fn rate(&self, w_one: &Vector3<f64>, w_two: &Vector3<f64>) -> f64 {
        self.gradient().dot(&(w_one - w_two))
    }

    /// Second rate for angular velocities `w` and accelerations `a` of both frames.
    #[inline(never)]
    pub fn bias(&self, [w_one, w_two]: [&Vector3<f64>; 2], [a_one, a_two]: [&Vector3<f64>; 2]) -> f64 {
        let (s, c) = self.sine_and_cosine(Vector3::dot);
        let between = w_one - w_two;
        let (s1, c1) = self.sine_and_cosine(|a, b| a.cross(b).dot(&between));
        let (s2, c2) = self.sine_and_cosine(|a, b| {
            spin(w_one, a_one, a).dot(b) + 2.0 * w_one.cross(a).dot(&w_two.cross(b)) + a.dot(&spin(w_two, a_two, b))
        });
        let one_over = reciprocal(s * s + c * c);
        let rate = (c * s1 - s * c1) * one_over;
        (c * s2 - s * c2 - 2.0 * rate * (c * c1 + s * s1)) * one_over
    }
}

/// Second rate of a vector `r` fixed in a frame with angular velocity `w` and acceleration `a`.
#[inline]
pub(crate) fn spin(w: &Vector3<f64>, a: &Vector3<f64>, r: &Vector3<f64>) -> Vector3<f64> {
    a.cross(r) + w.cross(&w.cross(r))
}

fn reciprocal(square: f64) -> f64 {
    if square > 0.0 { 1.0 / square } else { 0.0 }
}

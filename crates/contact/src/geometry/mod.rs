//! Journal and bearing, ball and socket: where they touch and how they move against each other. Pure functions in any common frame.

mod ball;
mod edges;
mod fit;
mod touch;

pub use edges::{Pattern, Skewed};
pub use fit::Fit;
pub use touch::{ContactForce, ForcePoint, Touch};

use nalgebra::Vector3;

/// Place and motion of a bearing or a journal, all vectors in one common frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Centre {
    /// A point of the body on the axis: the middle of the bearing, any point of the journal's axis \[m\].
    pub point: Vector3<f64>,
    /// Velocity of that point \[m/s\].
    pub velocity: Vector3<f64>,
    /// Angular velocity of the body \[rad/s\].
    pub spin: Vector3<f64>,
    /// Direction of the axis, fixed in the body, of unit length.
    pub axis: Vector3<f64>,
}

impl Centre {
    /// Velocity \[m/s\] of the body's material point that is now at `point` \[m\].
    #[inline]
    pub fn velocity_at(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.velocity + self.spin.cross(&(point - self.point))
    }

    /// Rate of the axis \[1/s\].
    #[inline]
    fn axis_rate(&self) -> Vector3<f64> {
        self.spin.cross(&self.axis)
    }
}

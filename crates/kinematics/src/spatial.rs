//! Motions and forces of rigid links: an angular and a linear part at a stated point, in global axes.

use nalgebra::Vector3;

/// Angular and linear velocity (or acceleration) of a link at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Angular part \[rad/s or rad/s^2\].
    pub angular: Vector3<f64>,
    /// Linear part at the point \[m/s or m/s^2\].
    pub linear: Vector3<f64>,
}

impl Twist {
    /// No motion.
    pub fn zero() -> Self {
        Self {
            angular: Vector3::zeros(),
            linear: Vector3::zeros(),
        }
    }
}

/// Torque and force on a link at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Torque about the point \[N m\].
    pub torque: Vector3<f64>,
    /// Force \[N\].
    pub force: Vector3<f64>,
}

impl Wrench {
    /// No load.
    pub fn zero() -> Self {
        Self {
            torque: Vector3::zeros(),
            force: Vector3::zeros(),
        }
    }

    /// The same load seen from a point that lies `arm` before this one: torque + arm x force.
    #[inline]
    pub fn shifted(&self, arm: &Vector3<f64>) -> Self {
        Self {
            torque: self.torque + arm.cross(&self.force),
            force: self.force,
        }
    }

    /// Power of the load on a link that moves with `twist` at the same point \[W\].
    #[inline]
    pub fn power(&self, twist: &Twist) -> f64 {
        self.torque.dot(&twist.angular) + self.force.dot(&twist.linear)
    }
}

impl std::ops::AddAssign for Wrench {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        self.torque += other.torque;
        self.force += other.force;
    }
}

impl std::ops::SubAssign for Wrench {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        self.torque -= other.torque;
        self.force -= other.force;
    }
}

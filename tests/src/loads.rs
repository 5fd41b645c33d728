//! Loads of the simplest kinds.

use linkdyn_dynamics::{Capacity, Load, Loads, Motion, Reaction, ReactionLoad, Supports};
use linkdyn_kinematics::{LinkId, Wrench};
use nalgebra::Vector3;

/// Constant generalised forces and constant wrenches.
#[derive(Clone, Debug)]
pub struct Applied {
    /// One a speed \[N m, N\].
    pub drives: Vec<f64>,
    /// Wrenches on links at their origins, global axes.
    pub wrenches: Vec<(LinkId, Wrench)>,
}

impl Load for Applied {
    fn apply(&self, _motion: &Motion<'_>, loads: &mut Loads<'_>) {
        for (speed, force) in self.drives.iter().enumerate() {
            loads.add(speed, *force);
        }
        for (link, wrench) in &self.wrenches {
            loads.add_wrench(*link, *wrench);
        }
    }
}

/// A linear spring on one coordinate that is also its speed's integral.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// Coordinate.
    pub coordinate: usize,
    /// Its speed.
    pub speed: usize,
    /// Stiffness \[N m/rad, N/m\].
    pub stiffness: f64,
}

impl Load for Spring {
    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>) {
        loads.add(self.speed, -self.stiffness * motion.q[self.coordinate]);
    }

    fn is_conservative(&self) -> bool {
        true
    }

    fn potential_energy(&self, motion: &Motion<'_>) -> f64 {
        0.5 * self.stiffness * motion.q[self.coordinate].powi(2)
    }
}

/// A smooth load on a joint that grows with the joint's reaction: gain `scale tanh(speed)`, capacity
/// `sqrt(floor^2 + |force|^2 + |torque|^2/arm^2)`.
#[derive(Clone, Copy, Debug)]
pub struct Rough {
    /// Factor of the gain \[m or -\].
    pub scale: f64,
    /// Smallest capacity \[N\].
    pub floor: f64,
    /// Length that turns torque to force \[m\].
    pub arm: f64,
}

impl ReactionLoad for Rough {
    fn gain(&self, speed: f64) -> f64 {
        self.scale * speed.tanh()
    }

    fn capacity(&self, reaction: &Reaction) -> Capacity {
        let weight = 1.0 / (self.arm * self.arm);
        let square = self.floor * self.floor + reaction.force.norm_squared() + weight * reaction.torque.norm_squared();
        let value = square.sqrt();
        Capacity {
            value,
            gradient: Wrench {
                torque: reaction.torque * (weight / value),
                force: reaction.force / value,
            },
        }
    }
}

/// A load on a slide along z that follows the force along the slide, at any speed: size `|constant - slope * force|` or, without
/// the fold, `constant - slope * force`.
#[derive(Clone, Copy, Debug)]
pub struct AlongSlide {
    /// Size without force \[N\].
    pub constant: f64,
    /// Change of the size with the force along the slide, other loads on the slide included \[-\].
    pub slope: f64,
    /// Whether the size folds to stay positive.
    pub folded: bool,
}

impl ReactionLoad for AlongSlide {
    fn gain(&self, _speed: f64) -> f64 {
        1.0
    }

    fn capacity(&self, reaction: &Reaction) -> Capacity {
        let value = self.constant - self.slope * reaction.force.z;
        let sign = if self.folded { value.signum() } else { 1.0 };
        Capacity {
            value: sign * value,
            gradient: Wrench {
                torque: Vector3::zeros(),
                force: Vector3::new(0.0, 0.0, -sign * self.slope),
            },
        }
    }
}

/// A load on three supports: gain `scale tanh(speed)`, capacity as [`Supports`] says.
#[derive(Clone, Copy, Debug)]
pub struct OnSupports {
    /// Factor of the gain \[-\].
    pub scale: f64,
    /// The supports.
    pub supports: Supports,
    /// Whether the load tells its supports.
    pub told: bool,
}

impl ReactionLoad for OnSupports {
    fn gain(&self, speed: f64) -> f64 {
        self.scale * speed.tanh()
    }

    fn capacity(&self, reaction: &Reaction) -> Capacity {
        let (f, n) = (&reaction.force, &reaction.torque);
        let mut sum = Capacity {
            value: 0.0,
            gradient: Wrench::zero(),
        };
        for [a, b] in self.supports.across {
            let felt = Vector3::new(a * f.x - b * n.y, a * f.y + b * n.x, 0.0);
            let along = felt.try_normalize(0.0).unwrap_or_default();
            sum.value += felt.norm();
            sum.gradient.force += along * a;
            sum.gradient.torque += Vector3::new(along.y, -along.x, 0.0) * b;
        }
        let [c, d] = self.supports.along;
        let felt = c * f.z + d * n.z;
        let sign = if felt == 0.0 { 0.0 } else { felt.signum() };
        sum.value += felt.abs();
        sum.gradient.force.z += c * sign;
        sum.gradient.torque.z += d * sign;
        sum
    }

    fn supports(&self) -> Option<Supports> {
        self.told.then_some(self.supports)
    }
}

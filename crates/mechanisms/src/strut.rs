//! Springs with dampers between two points.

use crate::linkage::Mount;
use linkdyn_dynamics::{Load, Loads, Motion};
use linkdyn_kinematics::{Attachment, Wrench};
use nalgebra::Vector3;

/// A spring with a damper between the origins of two frames on links or the ground. With the distance l of the two points it pulls
/// them together by `stiffness (l - free_length) + damping l'`.
///
/// Where the two points meet it has no direction: such states are refused, unless the free length is zero, when the force of the
/// spring vanishes there and the damper opposes the relative velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Strut {
    /// One end.
    pub from: Mount,
    /// The other end.
    pub to: Mount,
    /// Distance of the ends at which the spring is relaxed \[m\].
    pub free_length: f64,
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Damping \[N s/m\].
    pub damping: f64,
}

impl Strut {
    /// First parameter that is out of range: its name, value and what would be right.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
        let parameters = [
            ("free_length", self.free_length),
            ("stiffness", self.stiffness),
            ("damping", self.damping),
        ];
        let mut parameters = parameters.into_iter();
        let wrong = parameters.find(|(_, value)| !(value.is_finite() && *value >= 0.0));
        wrong.map(|(name, value)| (name, value, "a finite number that is not negative"))
    }
}

/// Share of the free length below which the direction between the ends is a matter of rounding.
const NO_DIRECTION: f64 = 1e-12;

/// A strut in place on the tree.
#[derive(Clone, Debug)]
pub(crate) struct PlacedStrut {
    pub name: String,
    pub ends: [Attachment; 2],
    pub strut: Strut,
}

impl PlacedStrut {
    /// The way from one end to the other, its rate, and the arms of the ends about the origins of their nodes.
    fn span(&self, motion: &Motion<'_>) -> (Vector3<f64>, Vector3<f64>, [Vector3<f64>; 2]) {
        let [one, two] = self.ends.map(|at| motion.origin(&at));
        (two.point - one.point, two.velocity - one.velocity, [one.arm, two.arm])
    }
}

impl Load for PlacedStrut {
    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>) {
        let Strut {
            free_length,
            stiffness,
            damping,
            ..
        } = self.strut;
        let (way, velocity, arms) = self.span(motion);
        let length = way.norm();
        let on_first = if length > NO_DIRECTION * free_length {
            let direction = way / length;
            let rate = direction.dot(&velocity);
            let elastic = stiffness * (length - free_length);
            loads.stores(elastic * rate);
            direction * (elastic + damping * rate)
        } else if free_length == 0.0 {
            velocity * damping
        } else {
            return loads.refuse(format!(
                "the ends of strut `{}` meet, so that it has no direction; only struts with a free length of zero can do so",
                self.name
            ));
        };
        let [one, two] = self.ends;
        for (end, arm, force) in [(one, arms[0], on_first), (two, arms[1], -on_first)] {
            let torque = arm.cross(&force);
            loads.add_wrench(end.link, Wrench { torque, force });
        }
    }

    fn potential_energy(&self, motion: &Motion<'_>) -> f64 {
        let (way, ..) = self.span(motion);
        0.5 * self.strut.stiffness * (way.norm() - self.strut.free_length).powi(2)
    }
}

//! Friction in a joint: a characteristic over the joint speed times the capacity of a bearing.

use linkdyn_dynamics::{Capacity, Reaction, ReactionLoad, Supports};
use linkdyn_friction::{Bearing, BearingModel, Characteristic, Friction};
use linkdyn_kinematics::Wrench;
use nalgebra::Vector3;

/// A bearing with a friction characteristic. The bearing's z axis is the joint's axis.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub(crate) struct JointFriction {
    pub characteristic: Friction,
    pub bearing: Bearing,
}

impl ReactionLoad for JointFriction {
    #[inline]
    fn gain(&self, speed: f64) -> f64 {
        self.characteristic.at(speed).value
    }

    #[inline]
    fn capacity(&self, reaction: &Reaction) -> Capacity {
        let capacity = self.bearing.capacity(reaction.force.into(), reaction.torque.into());
        Capacity {
            value: capacity.value,
            gradient: Wrench {
                force: Vector3::from(capacity.d_force),
                torque: Vector3::from(capacity.d_torque),
            },
        }
    }

    fn supports(&self) -> Option<Supports> {
        let linkdyn_friction::Supports { across, along } = self.bearing.supports()?;
        Some(Supports { across, along })
    }
}

//! Forces on points of links, and moments on links.

use crate::drive::Drive;
use crate::linkage::Mount;
use linkdyn_dynamics::{Load, Loads, Motion, Moving};
use linkdyn_kinematics::{Attachment, Wrench};
use nalgebra::Vector3;

/// A force on a point of a link, or a moment on a link, along a direction. Its size is the sum of drives that see the time and the
/// speed of the point along the direction \[m/s\], or the angular velocity about it \[rad/s\]; the coordinate that they see is zero. So
/// a resistance along the direction is the drag of the point.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PointLoad {
    /// The link and, as origin of this frame, the point.
    pub at: Mount,
    /// Direction of any length but zero, in axes of `axes`.
    pub direction: [f64; 3],
    /// What the direction is fixed in.
    pub axes: Axes,
    /// Size \[N, N m\], positive along the direction; drives add up.
    pub drives: Vec<Drive>,
}

/// What a direction is fixed in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Axes {
    /// The ground.
    #[default]
    Ground,
    /// The frame on the link, with which the direction turns.
    Mount,
}

/// Whether a load is a force or a moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub(crate) enum Acts {
    Force,
    Moment,
}

/// A point load in place on the tree.
#[derive(Clone, Debug)]
pub(crate) struct PlacedLoad {
    at: Attachment,
    direction: Vector3<f64>,
    axes: Axes,
    acts: Acts,
    drives: Vec<Drive>,
}

impl PointLoad {
    /// First parameter that is out of range: its name, value and what would be right.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
        let length = Vector3::from(self.direction).norm();
        if !(length.is_finite() && length > 0.0) {
            return Some(("length of the direction", length, "finite and greater than zero"));
        }
        self.drives.iter().find_map(Drive::fault)
    }

    pub(crate) fn placed(&self, at: Attachment, acts: Acts) -> PlacedLoad {
        PlacedLoad {
            at,
            direction: Vector3::from(self.direction).normalize(),
            axes: self.axes,
            acts,
            drives: self.drives.clone(),
        }
    }
}

impl Load for PlacedLoad {
    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>) {
        let Moving { arm, velocity, .. } = motion.origin(&self.at);
        let node = self.at.link.node();
        let direction = match self.axes {
            Axes::Ground => self.direction,
            Axes::Mount => motion.positions.nodes()[node].rotation * (self.at.pose.rotation * self.direction),
        };
        let velocity = match self.acts {
            Acts::Force => velocity,
            Acts::Moment => motion.velocities.nodes()[node].angular,
        };
        let speed = direction.dot(&velocity);
        let size: f64 = self.drives.iter().map(|drive| drive.torque(motion.t, 0.0, speed)).sum();
        let load = direction * size;
        let wrench = match self.acts {
            Acts::Force => Wrench {
                torque: arm.cross(&load),
                force: load,
            },
            Acts::Moment => Wrench {
                torque: load,
                force: Vector3::zeros(),
            },
        };
        loads.add_wrench(self.at.link, wrench);
    }

    fn stop_times(&self) -> Vec<f64> {
        self.drives.iter().flat_map(Drive::stop_times).collect()
    }
}

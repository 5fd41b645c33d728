#![doc = include_str!("../README.md")]

pub mod catalogue;
mod drive;
mod error;
mod joint_friction;
mod linkage;
mod mechanism;
mod observation;
mod run;
mod scene;
mod simulation;

pub use drive::{Drive, DriveFunction};
pub use error::{BuildError, MotionError, StartError};
pub use linkage::{JointHandle, LinkHandle, Linkage, Mount};
pub use mechanism::{Mechanism, Start, State};
pub use observation::Observation;
pub use run::{MOST_ROWS, RunError, run, run_watched};
pub use scene::Scene;
pub use simulation::{Layout, OffTheLoop, SPEED_SCALE, Simulation, Worst};

pub use linkdyn_dynamics as dynamics;
pub use linkdyn_friction as friction;
pub use linkdyn_integrators as integrators;
pub use linkdyn_kinematics as kinematics;

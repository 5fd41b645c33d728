#![doc = include_str!("../README.md")]

pub mod analysis;
mod build;
pub mod catalogue;
mod change;
mod check;
mod clearance;
mod drive;
mod error;
mod events;
#[cfg(feature = "file")]
pub mod file;
mod flexible;
mod forms;
mod joint_friction;
mod linkage;
mod mechanism;
mod observation;
mod outline;
mod run;
mod scene;
mod simulation;
mod spanning;
mod spline;
mod spring;
mod tally;

pub use clearance::{Clearance, ClearanceError, ClearanceModel, ContactIntegrals, ContactPoint, Side};
pub use drive::{Drive, DriveFunction};
pub use error::{BuildError, MotionError, StartError};
pub use events::{ContactEvent, Switching};
pub use flexible::{Along, FlexibleLink};
pub use forms::{ConstrainedMechanism, FormError};
pub use linkage::{AnyJoint, CutHandle, JointHandle, LinkHandle, Linkage, Mount};
pub use mechanism::{Mechanism, Start, State};
pub use observation::Observation;
pub use run::{MOST_ROWS, RunError, Seen, run, run_watched};
pub use scene::Scene;
pub use simulation::{CONTACT_SPEED_SCALE, Layout, OffTheLoop, SPEED_SCALE, Simulation, Worst};
pub use spanning::{Edge, Role, spanning_tree};
pub use spline::Spline;
pub use spring::Spring;
pub use tally::{PointTally, Tally};

pub use linkdyn_contact as contact;
pub use linkdyn_dynamics as dynamics;
pub use linkdyn_friction as friction;
pub use linkdyn_integrators as integrators;
pub use linkdyn_kinematics as kinematics;
pub use linkdyn_rfem as rfem;

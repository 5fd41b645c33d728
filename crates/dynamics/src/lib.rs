#![doc = include_str!("../README.md")]

mod articulated;
mod columns;
mod composite;
mod constraint;
mod energy;
mod error;
mod evaluate;
mod guide;
mod inertia;
mod inertial_walk;
mod influence;
mod internals;
pub mod lagrange;
mod lanes;
mod lever;
mod linear;
mod load;
mod local_loops;
mod project;
mod reaction;
mod reaction_loop;
mod response;
mod supports;
mod symmetric;
mod system;
mod terms;
mod workspace;

pub use energy::Energy;
pub use error::{DynamicsError, SystemError};
pub use guide::{Guide, Guided};
pub use inertia::{InertiaError, RigidInertia};
pub use load::{
    Capacity, Instant, InternalState, Internals, Load, Loads, Motion, Moving, Reaction, ReactionLoad, Supports,
};
pub use project::Drift;
pub use system::{Baumgarte, Description, Formulation, Place, ReactionSolver, System};
pub use terms::MotionTerms;
pub use workspace::{Counters, Workspace};

#![doc = include_str!("../README.md")]

mod geometry;
pub mod impact;
mod law;
mod parameter;
mod stiffness;

pub use geometry::{Centre, ContactForce, Fit, ForcePoint, Pattern, Skewed, Touch};
pub use law::{ContactLaw, Damping, KelvinVoigt, NormalForce, NormalLaw, NormalModel, RestitutionLaw};
pub use parameter::{Expected, ParameterError};
pub use stiffness::{Material, ball_in_socket, ball_on_plane, balls};

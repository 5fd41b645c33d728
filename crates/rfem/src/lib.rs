#![doc = include_str!("../README.md")]

mod division;
mod material;
pub mod modes;
mod parameter;
mod section;

pub use division::{Beam, Coefficient, Division, MAX_COUNT, Rfe, Sde, Shear, divide, divide_with};
pub use material::Material;
pub use parameter::{BeamError, Expected};
pub use section::Section;

//! Tests of the public behaviour, one module per subject. Names say which mistake they guard against.

mod ball;
mod edges;
mod extremes;
mod fixtures;
mod flight;
mod free_impact;
mod kelvin_voigt;
mod law;
mod momentum;
mod planar;
mod refusals;
mod restitution;
#[cfg(feature = "serde")]
mod serialised;
mod stiffness;

//! Tests of the public behaviour, one module per subject. Names say which mistake they guard against.

mod bearing;
mod characteristic;
mod choice;
mod elasto_plastic;
mod extremes;
mod fixtures;
mod lugre;
mod passive_slip;
mod planar;
mod refusals;
#[cfg(feature = "serde")]
mod serialised;

//! Tests of the public behaviour, one module per subject. Names say which mistake they guard against.

mod benchmark_17_beam_modes;
mod benchmark_18_elastica;
mod bodies;
mod buckling;
mod continuum;
mod fixtures;
mod planar;
mod refusals;
mod sections;
#[cfg(feature = "serde")]
mod serialised;
mod statics;
mod torsion;

//! Analyses of a built mechanism: what can move, where it goes, what drives it, where it rests, how it vibrates.
//!
//! Each is a function of a [`Mechanism`](crate::Mechanism) and a state, in SI units and radians, and changes neither. All but
//! [`mobility`](mod@mobility) and [`branches`](mod@branches) stand on the same split of the speeds into **independent** ones `z'`, as
//! many as there are freedoms, and dependent ones: `v = T z'` with `G T = 0`.

mod balance;
pub mod branches;
mod elimination;
pub mod equilibrium;
mod error;
pub mod inverse_dynamics;
pub mod linearise;
pub mod mobility;
mod modes;
pub mod positions;

pub use branches::branches;
pub use equilibrium::equilibrium;
pub use error::AnalysisError;
pub use inverse_dynamics::inverse_dynamics;
pub use linearise::linearise;
pub use mobility::mobility;
pub use modes::{Mode, eigenvalues};
pub use positions::positions;

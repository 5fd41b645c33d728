//! Published mechanisms, each made with the public builder alone.

mod rsrrr;
mod rsup;

pub use rsrrr::{Rsrrr, rsrrr};
pub use rsup::{ClearanceKind, Rsup, RsupError, bristle, rsup};

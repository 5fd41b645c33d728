//! Published mechanisms, each made with the public builder alone.

mod rsrrr;

pub use rsrrr::{Rsrrr, rsrrr};

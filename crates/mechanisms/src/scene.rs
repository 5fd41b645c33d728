//! Scenes: a linkage with its start and its run, ready to be simulated.

use crate::linkage::Linkage;
use crate::mechanism::Start;

/// A linkage with all that a run needs.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Scene {
    /// Name, as the program knows it.
    pub name: String,
    /// One line for listings.
    pub summary: String,
    /// The linkage.
    pub linkage: Linkage,
    /// Where it starts.
    pub start: Start,
    /// End of the run \[s\]; it begins at 0.
    pub until: f64,
    /// Whether results list joint reactions.
    pub reactions: bool,
    /// Coordinate whose speed stands for the run: the crank.
    pub crank: String,
    /// Coordinate whose motion is the result, if one is.
    pub output: Option<String>,
}

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
    /// How it is integrated unless its user says otherwise.
    pub settings: RunSettings,
}

/// How a scene is integrated, as far as it says so itself.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RunSettings {
    /// Time between two rows of the results \[s\].
    pub every: Option<f64>,
    /// Name of the integration method.
    pub method: Option<String>,
    /// Relative tolerance.
    pub rtol: Option<f64>,
    /// Absolute tolerance.
    pub atol: Option<f64>,
    /// Fixed step \[s\].
    pub step: Option<f64>,
}

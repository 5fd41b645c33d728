//! Why an analysis has no answer.

use crate::error::{MotionError, StartError};
use linkdyn_kinematics::assembly::AssemblyError;
use thiserror::Error;

/// Why an analysis of a mechanism has no answer.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AnalysisError {
    /// A name is unknown, or the loops cannot be closed.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The forces have no meaning at a state.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// A slice has the wrong length.
    #[error("{what} has {found} entries, the mechanism needs {expected}")]
    Length {
        /// What was given.
        what: &'static str,
        /// Entries given.
        found: usize,
        /// Entries needed.
        expected: usize,
    },
    /// A number is out of range.
    #[error("{what} = {value} must be {expected}")]
    Number {
        /// What was given.
        what: String,
        /// Its value.
        value: f64,
        /// What would be right.
        expected: &'static str,
    },
    /// The coordinates given do not close the loops.
    #[error(
        "the loops are open by {residual:e} at the coordinates given, more than {allowed:e}; assemble the mechanism first"
    )]
    Open {
        /// Largest closure residual \[m, -\].
        residual: f64,
        /// What is allowed \[m, -\].
        allowed: f64,
    },
    /// A coordinate is one of several that make up a quaternion.
    #[error("`{coordinate}` belongs to a ball joint with a quaternion, its rate is no speed; name another coordinate")]
    Quaternion {
        /// The coordinate.
        coordinate: String,
    },
    /// More freedoms than driven coordinates.
    #[error("with {driven} given, {free} can still move; drive as many coordinates as there are freedoms")]
    Undetermined {
        /// Driven coordinates.
        driven: String,
        /// Speeds that would have to be given too.
        free: String,
    },
    /// The loops do not leave the driven coordinates their own motion.
    #[error(
        "the loops tie the driven coordinates {driven} to each other (only {freedoms} freedoms, or a dead centre); drive fewer or others"
    )]
    Overdetermined {
        /// Driven coordinates.
        driven: String,
        /// Freedoms that the loops leave at this position.
        freedoms: usize,
    },
    /// Contacts or other loads with states of their own.
    #[error("{what}; this analysis needs loads that depend on time, position and velocity alone")]
    Internals {
        /// Which load, as far as it has a name.
        what: String,
    },
    /// Friction and reactions found no common solution.
    #[error("friction and reactions did not settle: relative residual {residual:e} after {iterations} iterations")]
    FrictionNotSettled {
        /// Relative residual reached.
        residual: f64,
        /// Iterations made.
        iterations: usize,
    },
    /// No equilibrium was found.
    #[error(
        "no equilibrium found after {iterations} iterations: a force of {force:e} N or N m is left on `{coordinate}` at {value}; \
         start nearer, or check that one exists"
    )]
    NoEquilibrium {
        /// Iterations made.
        iterations: usize,
        /// Largest force left \[N m, N\].
        force: f64,
        /// Where it is left.
        coordinate: String,
        /// Value of that coordinate there.
        value: f64,
    },
    /// Nothing can move.
    #[error("the mechanism has no freedom at this position; there is nothing to analyse")]
    NoFreedom,
    /// The eigenvalue solver did not converge, or a derivative is not finite.
    #[error("no eigenvalues: {0}")]
    Eigenvalues(&'static str),
}

impl From<AssemblyError> for AnalysisError {
    fn from(error: AssemblyError) -> Self {
        Self::Start(error.into())
    }
}

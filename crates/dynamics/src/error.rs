//! What can go wrong while the equations of motion are set up or solved.

use crate::inertia::InertiaError;
use thiserror::Error;

/// Why a [`crate::System`] was refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SystemError {
    /// There is nothing to move.
    #[error("the system has no freedom: attach at least one link by a joint that moves")]
    NoFreedom,
    /// One inertia a link is needed.
    #[error("{found} inertias were given for {expected} links")]
    Inertias {
        /// Inertias given.
        found: usize,
        /// Links of the tree, the ground apart.
        expected: usize,
    },
    /// A link's inertia is impossible.
    #[error("link {link}: {source}")]
    Inertia {
        /// Index of the link in the order of attachment.
        link: usize,
        /// What is wrong.
        source: InertiaError,
    },
    /// Gravity is not finite.
    #[error("gravity {0:?} m/s^2 must be finite")]
    Gravity([f64; 3]),
    /// A Baumgarte coefficient is negative or not finite.
    #[error("Baumgarte coefficients alpha = {alpha}, beta = {beta} 1/s must be finite and not negative")]
    Baumgarte {
        /// Velocity coefficient.
        alpha: f64,
        /// Position coefficient.
        beta: f64,
    },
    /// A reaction load stands on a link that is not carried by exactly one freedom.
    #[error(
        "link {link} carries a load that depends on its joint's reaction, but its joint has {freedoms} freedoms instead of one"
    )]
    ReactionLoad {
        /// Index of the link in the order of attachment.
        link: usize,
        /// Freedoms of its joint.
        freedoms: usize,
    },
    /// A prescribed motion is that of a coordinate which there is not.
    #[error(
        "coordinate {coordinate} with speed {speed} is prescribed, but there are {coordinates} and {speeds} of them"
    )]
    Guided {
        /// Index of the coordinate.
        coordinate: usize,
        /// Index of the speed.
        speed: usize,
        /// Number of coordinates.
        coordinates: usize,
        /// Number of speeds.
        speeds: usize,
    },
}

/// Why accelerations do not exist at a state.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DynamicsError {
    /// The mass matrix is singular: a freedom moves no mass.
    #[error(
        "t = {time} s: speed {speed} moves no mass (pivot {pivot:e} of the mass matrix); give its link mass or fix the joint"
    )]
    SingularMass {
        /// Time \[s\].
        time: f64,
        /// Speed of the freedom.
        speed: usize,
        /// Pivot found \[kg m^2 or kg\].
        pivot: f64,
    },
    /// The state, a load or a result is not a finite number.
    #[error("t = {time} s: acceleration of speed {speed} is {value}; a coordinate, speed or load is not finite")]
    NotFinite {
        /// Time \[s\].
        time: f64,
        /// Speed.
        speed: usize,
        /// Its rate.
        value: f64,
    },
    /// The loop reaction - load - acceleration has no solution on the branch that starts at vanishing load: the mechanism jams.
    #[error(
        "t = {time} s: the mechanism jams at speed {speed}: with reaction-dependent loads at {share} of their size the \
         loop measure det(1 - d load/d load) falls to zero, and beyond there is no equilibrium of loads and reactions"
    )]
    Jammed {
        /// Time \[s\].
        time: f64,
        /// Speed of the joint whose load grows fastest there.
        speed: usize,
        /// Share of the full load at which the measure passes zero (below 1).
        share: f64,
        /// Smallest measure that was still positive.
        measure: f64,
    },
    /// A solution exists, but the loop measure is negative there: it is not the only one, nor the one that grows out of
    /// vanishing load.
    #[error(
        "t = {time} s: loads and reactions have several equilibria (loop measure {measure} at speed {speed}); the motion is not unique"
    )]
    NotUnique {
        /// Time \[s\].
        time: f64,
        /// Speed of the joint whose load grows fastest there.
        speed: usize,
        /// Loop measure at the solution.
        measure: f64,
    },
    /// The loop did not settle for numerical reasons.
    #[error(
        "t = {time} s: loads that depend on reactions did not settle: relative residual {residual:e} after {iterations} \
         iterations, weakest at speed {speed}"
    )]
    NotSettled {
        /// Time \[s\].
        time: f64,
        /// Speed of the joint whose load grows fastest there.
        speed: usize,
        /// Relative residual reached.
        residual: f64,
        /// Iterations made.
        iterations: usize,
    },
    /// A load has no meaning at this state.
    #[error("t = {time} s: {reason}")]
    Refused {
        /// Time \[s\].
        time: f64,
        /// What the load says.
        reason: String,
    },
}

impl DynamicsError {
    /// Index of the speed that the error speaks of, if it is about one.
    pub fn speed(&self) -> Option<usize> {
        match self {
            Self::SingularMass { speed, .. }
            | Self::NotFinite { speed, .. }
            | Self::Jammed { speed, .. }
            | Self::NotUnique { speed, .. }
            | Self::NotSettled { speed, .. } => Some(*speed),
            Self::Refused { .. } => None,
        }
    }
}

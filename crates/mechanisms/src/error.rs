//! What can be wrong with a linkage.

use crate::clearance::ClearanceError;
use crate::limit::LimitError;
use linkdyn_dynamics::{DynamicsError, SystemError};
use linkdyn_friction::ParameterError;
use linkdyn_kinematics::TreeError;
use linkdyn_kinematics::assembly::AssemblyError;
use thiserror::Error;

/// Why a linkage could not be built.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// Two items have the same name.
    #[error("the name `{name}` is used twice; give each link, joint and coordinate a name of its own")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// A handle belongs to another linkage.
    #[error("{what} of `{name}` does not belong to this linkage")]
    Foreign {
        /// Kind of the handle.
        what: &'static str,
        /// Item that uses it.
        name: String,
    },
    /// A joint has the same link on both sides.
    #[error("joint `{joint}` connects link `{link}` to itself")]
    SelfJoint {
        /// The joint.
        joint: String,
        /// The link.
        link: String,
    },
    /// A link is carried by two joints of the tree.
    #[error("link `{link}` is carried by both joint `{first}` and joint `{second}`; make one of them a cut joint")]
    CarriedTwice {
        /// The link.
        link: String,
        /// One joint.
        first: String,
        /// The other joint.
        second: String,
    },
    /// A link has no way to the ground.
    #[error("link `{link}` is not connected to the ground by joints that lead from predecessor to successor")]
    Disconnected {
        /// The link.
        link: String,
    },
    /// A joint cannot be attached.
    #[error("joint `{joint}`: {source}")]
    Joint {
        /// The joint.
        joint: String,
        /// What is wrong.
        source: TreeError,
    },
    /// A mounting frame is not a rigid pose.
    #[error("the mount of joint `{joint}` on its {side} is not a rigid pose: its rotation is off by {defect:e}")]
    Mount {
        /// The joint.
        joint: String,
        /// Predecessor or successor.
        side: &'static str,
        /// See [`linkdyn_kinematics::Pose::defect`].
        defect: f64,
    },
    /// A load that wants one coordinate stands on a joint with another number.
    #[error("{what} needs a joint with one coordinate, joint `{joint}` has {coordinates}")]
    NotOneCoordinate {
        /// Drive or friction.
        what: &'static str,
        /// The joint.
        joint: String,
        /// Its number of coordinates.
        coordinates: usize,
    },
    /// The number of names does not fit the joint.
    #[error("joint `{joint}` has {expected} coordinates, {found} names were given")]
    CoordinateNames {
        /// The joint.
        joint: String,
        /// Coordinates.
        expected: usize,
        /// Names.
        found: usize,
    },
    /// An equation of a cut joint of one's own has an axis that is none.
    #[error("cut joint `{joint}`: equation {row} must have finite numbers and unit vectors as axes")]
    Row {
        /// The cut joint.
        joint: String,
        /// Index of the equation.
        row: usize,
    },
    /// The model of a clearance is for joints of another kind.
    #[error(
        "joint `{joint}` is {kind}, its clearance {model}: planar and spatial clearance are for revolute joints, spherical clearance \
         is for spherical ones"
    )]
    ClearanceKind {
        /// The joint.
        joint: String,
        /// Its kind.
        kind: &'static str,
        /// The model of its clearance.
        model: &'static str,
    },
    /// A joint with clearance has friction of a bearing.
    #[error(
        "joint `{joint}` has clearance, and friction of a bearing, which needs the reaction of an ideal joint; give the clearance a \
         bristle instead"
    )]
    FrictionWithClearance {
        /// The joint.
        joint: String,
    },
    /// A parameter of a clearance is out of range.
    #[error("clearance of joint `{joint}`: {source}")]
    Clearance {
        /// The joint.
        joint: String,
        /// What is wrong.
        source: ClearanceError,
    },
    /// Springs do not fit the joint.
    #[error(
        "joint `{joint}` has {coordinates} coordinates and {speeds} speeds, {found} springs were given; springs need a joint whose \
             speeds are the rates of its coordinates, and there must be one for each"
    )]
    Springs {
        /// The joint.
        joint: String,
        /// Coordinates.
        coordinates: usize,
        /// Speeds.
        speeds: usize,
        /// Springs.
        found: usize,
    },
    /// A parameter is out of range.
    #[error("joint `{joint}`: {parameter} = {value} must be {expected}")]
    Parameter {
        /// The joint.
        joint: String,
        /// The parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// What would be right.
        expected: &'static str,
    },
    /// A friction parameter is out of range.
    #[error("friction of joint `{joint}`: {source}")]
    Friction {
        /// The joint.
        joint: String,
        /// What is wrong.
        source: ParameterError,
    },
    /// A limit makes no sense.
    #[error("limit of joint `{joint}`: {source}")]
    Limit {
        /// The joint.
        joint: String,
        /// What is wrong.
        source: LimitError,
    },
    /// A parameter of a force, a moment or a strut is out of range.
    #[error("{what} `{name}`: {parameter} = {value} must be {expected}")]
    Load {
        /// Force, moment or strut.
        what: &'static str,
        /// Its name.
        name: String,
        /// The parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// What would be right.
        expected: &'static str,
    },
    /// A strut has both ends on the same link.
    #[error("strut `{strut}` has both ends on link `{link}`, where it does nothing; give them different links")]
    SelfStrut {
        /// The strut.
        strut: String,
        /// The link.
        link: String,
    },
    /// An inertia is impossible.
    #[error("link `{link}`: {source}")]
    Inertia {
        /// The link.
        link: String,
        /// What is wrong.
        source: linkdyn_dynamics::InertiaError,
    },
    /// The equations of motion cannot be set up.
    #[error(transparent)]
    System(#[from] SystemError),
}

/// Why a start could not be made consistent.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum StartError {
    /// A name is not that of a coordinate.
    #[error("there is no coordinate `{name}`; there are {known}")]
    UnknownCoordinate {
        /// The name.
        name: String,
        /// The names there are.
        known: String,
    },
    /// A coordinate with prescribed motion is told to start elsewhere.
    #[error(
        "`{coordinate}` starts with {what} {given}, but its prescribed motion has {prescribed} at t = 0; leave it out of the start"
    )]
    Prescribed {
        /// The coordinate.
        coordinate: String,
        /// Position or speed.
        what: &'static str,
        /// As given \[rad, m, rad/s, m/s\].
        given: f64,
        /// As prescribed.
        prescribed: f64,
    },
    /// A cut joint closes the wrong way round: its equations ask for right angles, which an axis that points backwards makes too.
    #[error(
        "from this guess cut joint `{joint}` closes the wrong way round, with an axis that points backwards; guess coordinates nearer to \
         the position meant, or turn one of its mounts"
    )]
    Reversed {
        /// The cut joint.
        joint: String,
    },
    /// The loops cannot be closed.
    #[error("start: {0}")]
    Assembly(#[from] AssemblyError),
}

impl StartError {
    /// Which cut joint cannot be closed, as an index into [`Mechanism::loop_names`](crate::Mechanism::loop_names), if it is one.
    pub fn closure(&self) -> Option<usize> {
        match self {
            Self::Assembly(AssemblyError::NotClosed { closure, .. } | AssemblyError::Velocities { closure, .. }) => {
                Some(*closure)
            }
            _ => None,
        }
    }
}

/// Why a mechanism has no accelerations at a state, with the name of the coordinate that the cause speaks of.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}{cause}", .coordinate.as_ref().map_or(String::new(), |name| format!("`{name}`: ")))]
pub struct MotionError {
    /// The coordinate, if the cause speaks of one.
    pub coordinate: Option<String>,
    /// What went wrong.
    pub cause: DynamicsError,
}

//! Clearance in a joint: a journal that touches its bearing, or a ball its socket, as a load with states of its own.

mod bristles;
pub(crate) mod carried;
mod load;

use linkdyn_contact::{ContactLaw, Fit, ForcePoint, NormalModel, ParameterError as ContactError};
use linkdyn_friction::{Bristle, BristleModel, BristleStart, ParameterError as FrictionError};
use linkdyn_kinematics::Joint;
use thiserror::Error;

pub(crate) use load::ClearanceJoint;

/// Clearance of a revolute or spherical joint, in place of what holds journal and bearing together.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Clearance {
    /// Radii of hole and pin, or of socket and ball.
    pub fit: Fit,
    /// Which side of the joint has the hole.
    pub bearing: Side,
    /// What the two may do besides.
    pub model: ClearanceModel,
    /// Normal force over penetration and its rate. For the spatial model this is the law of the whole joint; each edge of the
    /// bearing gets half of it.
    pub law: ContactLaw,
    /// Friction over sliding speed; none if absent.
    pub friction: Option<Bristle>,
    /// How deflected the bristle is when a contact is made.
    pub bristle_start: BristleStart,
    /// Where the forces act.
    pub force_point: ForcePoint,
}

/// A side of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "file", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Side {
    /// The predecessor.
    Predecessor,
    /// The successor.
    Successor,
}

/// How a journal may move in its bearing. The first two are for revolute joints, the third for spherical ones.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
pub enum ClearanceModel {
    /// The axes stay parallel and nothing moves along them: three equations are kept, and one contact in the plane.
    Planar,
    /// Only motion along the axis is prevented, by one equation; contact at the two edges of the bearing.
    Spatial {
        /// Length of the bearing \[m\].
        length: f64,
    },
    /// A ball in a socket: nothing is held, and one contact in space. Turning about the line of contact costs nothing.
    Spherical,
}

impl ClearanceModel {
    /// Whether a joint may have this clearance.
    pub(crate) fn fits(self, joint: &Joint) -> bool {
        match self {
            Self::Planar | Self::Spatial { .. } => matches!(joint, Joint::Revolute { .. }),
            Self::Spherical => matches!(joint, Joint::Spherical | Joint::SphericalZyx),
        }
    }

    /// Its name, for messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Planar => "planar",
            Self::Spatial { .. } => "spatial",
            Self::Spherical => "spherical",
        }
    }

    /// Number of contact points.
    pub(crate) fn points(self) -> usize {
        match self {
            Self::Planar | Self::Spherical => 1,
            Self::Spatial { .. } => 2,
        }
    }

    /// Their names: that of the joint, or with 1 and 2 behind it.
    pub(crate) fn point_names(self, joint: &str) -> impl Iterator<Item = String> + use<> {
        let (joint, points) = (joint.to_owned(), self.points());
        (1..=points).map(move |point| {
            if points == 1 {
                joint.clone()
            } else {
                format!("{joint}{point}")
            }
        })
    }
}

/// What is wrong with a clearance.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ClearanceError {
    /// A parameter of the contact law.
    #[error("contact law: {0}")]
    Law(#[from] ContactError),
    /// A parameter of the bristle.
    #[error("bristle: {0}")]
    Bristle(#[from] FrictionError),
    /// The bearing has no length.
    #[error("length of the bearing is {0} m, but must be finite and greater than zero")]
    Length(f64),
}

impl Clearance {
    pub(crate) fn validate(&self) -> Result<(), ClearanceError> {
        self.law.validate()?;
        if let Some(bristle) = &self.friction {
            bristle.validate()?;
        }
        match self.model {
            ClearanceModel::Spatial { length } if !(length.is_finite() && length > 0.0) => {
                Err(ClearanceError::Length(length))
            }
            _ => Ok(()),
        }
    }
}

/// One contact point at an instant. At the [limit](crate::Limit) of a turn rad stand for m and N m for N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactPoint {
    /// Penetration \[m\]; negative while apart.
    pub depth: f64,
    /// Its rate \[m/s\].
    pub rate: f64,
    /// Normal force \[N\].
    pub normal: f64,
    /// Friction on the bearing, against the directions of [`slip`](Self::slip) \[N\].
    pub tangent: [f64; 3],
    /// Bristle deflections in the same directions \[m\].
    pub bristle: [f64; 3],
    /// Speed of penetration at the beginning of the contact \[m/s\]; zero while apart.
    pub impact_speed: f64,
    /// Sliding velocity of the bearing's surface: along the tangent, along the axis, and zero; for a ball along the three axes of the
    /// socket's frame \[m/s\].
    pub slip: [f64; 3],
    /// Centre of the journal against that of the bearing, along two axes of the bearing's frame normal to the joint's axis and along
    /// that axis: y, z and x for a joint along x, x, y and z for one along z; for a ball along x, y and z of the socket's frame \[m\].
    pub journal: [f64; 3],
    /// In how many directions there is friction: none, along the tangent, along the axis too, or the three of a ball.
    pub directions: usize,
}

impl ContactPoint {
    /// Columns in result files for so many directions of friction.
    pub(crate) fn columns(directions: usize) -> &'static [&'static str] {
        const EDGE: [&str; 8] = [
            "depth",
            "rate",
            "normal",
            "tangent",
            "bristle",
            "impact_speed",
            "tangent_axial",
            "bristle_axial",
        ];
        const BALL: [&str; 10] = [
            "depth",
            "rate",
            "normal",
            "tangent_x",
            "bristle_x",
            "impact_speed",
            "tangent_y",
            "bristle_y",
            "tangent_z",
            "bristle_z",
        ];
        match directions {
            0 | 1 => &EDGE[..6],
            2 => &EDGE,
            _ => &BALL,
        }
    }

    /// Writes the numbers of these columns.
    pub(crate) fn write(&self, row: &mut Vec<f64>) {
        let (tangent, bristle) = (&self.tangent, &self.bristle);
        row.extend([
            self.depth,
            self.rate,
            self.normal,
            tangent[0],
            bristle[0],
            self.impact_speed,
        ]);
        for k in 1..self.directions {
            row.extend([tangent[k], bristle[k]]);
        }
    }
}

/// Integrals of one contact point over time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactIntegrals {
    /// Energy lost in the normal direction \[J\].
    pub damping_loss: f64,
    /// Energy lost in friction \[J\].
    pub friction_loss: f64,
    /// Normal force over time \[N s\].
    pub impulse: f64,
    /// Square of the normal force over time \[N^2 s\].
    pub square: f64,
}

impl ContactIntegrals {
    pub(crate) const COUNT: usize = 4;

    /// From the integrals of a load, from those of this point on.
    pub(crate) fn read(values: &[f64]) -> Self {
        let [damping_loss, friction_loss, impulse, square] =
            [0, 1, 2, 3].map(|k| values.get(k).copied().unwrap_or(0.0));
        Self {
            damping_loss,
            friction_loss,
            impulse,
            square,
        }
    }

    /// Writes them to the first of `values`.
    pub(crate) fn write(&self, values: &mut [f64]) {
        let all = [self.damping_loss, self.friction_loss, self.impulse, self.square];
        values[..Self::COUNT].copy_from_slice(&all);
    }
}

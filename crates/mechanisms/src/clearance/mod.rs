//! Clearance in a cut revolute joint: a journal that touches its bearing, as a load with states of its own.

mod load;

use linkdyn_contact::{ContactLaw, Fit, ForcePoint, NormalModel, ParameterError as ContactError};
use linkdyn_friction::{Bristle, BristleModel, BristleStart, ParameterError as FrictionError};
use thiserror::Error;

pub(crate) use load::ClearanceJoint;

/// Clearance of a cut revolute joint, in place of the equations that hold journal and bearing together.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Clearance {
    /// Radii of hole and pin.
    pub fit: Fit,
    /// Which side of the cut has the hole.
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

/// A side of a cut joint.
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

/// How a journal may move in its bearing.
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
}

impl ClearanceModel {
    /// Number of contact points.
    pub(crate) fn points(self) -> usize {
        match self {
            Self::Planar => 1,
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
    /// Friction on the bearing against the tangent, and against the axis \[N\].
    pub tangent: [f64; 2],
    /// Bristle deflections along tangent and axis \[m\].
    pub bristle: [f64; 2],
    /// Speed of penetration at the beginning of the contact \[m/s\]; zero while apart.
    pub impact_speed: f64,
    /// Sliding speed of the bearing's surface along tangent and axis \[m/s\].
    pub slip: [f64; 2],
    /// Centre of the journal against that of the bearing, along two axes of the bearing's frame normal to the joint's axis: y and z
    /// for a joint along x, x and y for one along z \[m\].
    pub journal: [f64; 2],
    /// Whether friction along the axis is there too.
    pub axial: bool,
}

impl ContactPoint {
    /// Writes the numbers of the columns of its load.
    pub(crate) fn write(&self, row: &mut Vec<f64>) {
        let [tangent, axial] = self.tangent;
        let [bristle, axial_bristle] = self.bristle;
        row.extend([self.depth, self.rate, self.normal, tangent, bristle, self.impact_speed]);
        if self.axial {
            row.extend([axial, axial_bristle]);
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

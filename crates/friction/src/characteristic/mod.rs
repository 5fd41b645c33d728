//! Kinetic friction characteristics: normalised coefficients as functions of the slip speed alone.

mod cubic;
mod exponential;
mod hyperbolic_tangent;
mod piecewise_linear;
mod stribeck;
mod sum;
mod viscous;

pub use cubic::Cubic;
pub use exponential::Exponential;
pub use hyperbolic_tangent::HyperbolicTangent;
pub use piecewise_linear::PiecewiseLinear;
pub use stribeck::Stribeck;
pub use sum::Sum;
pub use viscous::Viscous;

use crate::ParameterError;
use std::fmt::Debug;
use std::sync::Arc;

/// A characteristic at one slip speed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Value {
    /// χ \[-\], with the sign of the slip.
    pub value: f64,
    /// dχ/dv \[s/m\], or \[s/rad\] where the slip is a joint speed.
    pub slope: f64,
}

/// A normalised, odd function χ(v) of the slip speed that stands for the sign of the slip.
///
/// The coefficient of friction of a surface is µ(v) = µ₀ χ(v), friction acts against the slip with
/// µ times the normal force. Slip may be measured in m/s or in rad/s, as long as the reference
/// speeds of the characteristic are measured in the same unit. A NaN slip gives NaN.
pub trait Characteristic: Debug + Send + Sync {
    /// χ and its slope at a slip speed.
    fn at(&self, slip: f64) -> Value;

    /// Refuses parameters for which [`at`](Self::at) has no meaning.
    fn validate(&self) -> Result<(), ParameterError> {
        Ok(())
    }
}

/// Any characteristic, for choices made at run time.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Friction {
    /// Exponential rise to one.
    Exponential(Exponential),
    /// Straight through zero, then constant.
    PiecewiseLinear(PiecewiseLinear),
    /// Hyperbolic tangent.
    HyperbolicTangent(HyperbolicTangent),
    /// One cubic arc between the two constant branches.
    Cubic(Cubic),
    /// Static peak above the kinetic level.
    Stribeck(Stribeck),
    /// Proportional to the slip.
    Viscous(Viscous),
    /// Two characteristics added, such as a dry one and a viscous share.
    Sum(Box<Sum<Friction, Friction>>),
    /// The caller's own. It has no serialised form.
    #[cfg_attr(feature = "serde", serde(skip))]
    Custom(Arc<dyn Characteristic>),
}

impl Friction {
    /// The characteristic behind the choice.
    #[inline]
    pub fn model(&self) -> &dyn Characteristic {
        match self {
            Self::Exponential(law) => law,
            Self::PiecewiseLinear(law) => law,
            Self::HyperbolicTangent(law) => law,
            Self::Cubic(law) => law,
            Self::Stribeck(law) => law,
            Self::Viscous(law) => law,
            Self::Sum(law) => law.as_ref(),
            Self::Custom(law) => law.as_ref(),
        }
    }
}

impl Characteristic for Friction {
    #[inline]
    fn at(&self, slip: f64) -> Value {
        self.model().at(slip)
    }

    fn validate(&self) -> Result<(), ParameterError> {
        self.model().validate()
    }
}

macro_rules! friction_from {
    ($($law:ident),*) => {$(
        impl From<$law> for Friction {
            fn from(law: $law) -> Self {
                Self::$law(law)
            }
        }
    )*};
}

friction_from!(
    Exponential,
    PiecewiseLinear,
    HyperbolicTangent,
    Cubic,
    Stribeck,
    Viscous
);

impl<A: Into<Friction>, B: Into<Friction>> From<Sum<A, B>> for Friction {
    fn from(sum: Sum<A, B>) -> Self {
        Self::Sum(Box::new(Sum {
            first: sum.first.into(),
            second: sum.second.into(),
        }))
    }
}

impl From<Arc<dyn Characteristic>> for Friction {
    fn from(law: Arc<dyn Characteristic>) -> Self {
        Self::Custom(law)
    }
}

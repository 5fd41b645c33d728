//! Laws for the normal force of a contact.

mod kelvin_voigt;
mod normal;
mod restitution;

pub use kelvin_voigt::KelvinVoigt;
pub use normal::{Damping, NormalLaw};
pub use restitution::RestitutionLaw;

use crate::ParameterError;
use std::fmt::Debug;
use std::sync::Arc;

/// Normal force of a contact with its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NormalForce {
    /// The force f_n ≥ 0 \[N\], pushing the bodies apart.
    pub value: f64,
    /// What the same depth gives at rest \[N\]. `(value - elastic)` times the rate is the power lost.
    pub elastic: f64,
    /// Derivative of the force by the depth \[N/m\].
    pub d_depth: f64,
    /// Derivative of the force by the rate of the depth \[N s/m\].
    pub d_rate: f64,
    /// Whether the law would have pulled, so that the force was set to zero.
    pub clamped: bool,
}

impl NormalForce {
    /// The law's answer (force, derivatives) with the force kept from pulling, and everything finite.
    #[inline]
    pub(crate) fn kept_from_pulling(value: f64, elastic: f64, d_depth: f64, d_rate: f64) -> Self {
        let elastic = finite(elastic);
        if value < 0.0 {
            return Self {
                elastic,
                clamped: true,
                ..Self::default()
            };
        }
        Self {
            value: finite(value),
            elastic,
            d_depth: finite(d_depth),
            d_rate: finite(d_rate),
            clamped: false,
        }
    }

    /// The same contact with a share of the stiffness, such as 1/2 for each of the two edges of a bearing.
    #[inline]
    pub fn scaled(self, share: f64) -> Self {
        Self {
            value: share * self.value,
            elastic: share * self.elastic,
            d_depth: share * self.d_depth,
            d_rate: share * self.d_rate,
            clamped: self.clamped,
        }
    }
}

/// The largest number instead of infinity; NaN stays.
#[inline]
fn finite(x: f64) -> f64 {
    x.clamp(-f64::MAX, f64::MAX)
}

/// A law for the normal force f_n(δ, δ', v₀).
///
/// A law holds parameters only. The impact speed v₀ of the present contact belongs to the caller, who takes it where
/// the contact begins and keeps it until the bodies separate.
pub trait NormalModel: Debug + Send + Sync {
    /// Force and derivatives at a depth \[m\], its rate \[m/s\], for the speed \[m/s\] with which this contact began.
    /// Zero for depths up to zero, never negative, finite for finite arguments; NaN for NaN.
    fn at(&self, depth: f64, rate: f64, impact_speed: f64) -> NormalForce;

    /// Energy \[J\] that the contact gives back when it is released slowly; zero for depths up to zero.
    fn stored_energy(&self, depth: f64) -> f64;

    /// Restitution \[-\] of a free impact of a (reduced) mass \[kg\] at a speed \[m/s\].
    fn delivered_restitution(&self, mass: f64, impact_speed: f64) -> f64;

    /// Greatest depth \[m\] of a free impact of a (reduced) mass \[kg\] at a speed \[m/s\].
    fn greatest_depth(&self, mass: f64, impact_speed: f64) -> f64;

    /// Energy \[J\] lost in a free impact, m v₀² (1 - ε²)/2.
    fn energy_loss(&self, mass: f64, impact_speed: f64) -> f64 {
        let eps = self.delivered_restitution(mass, impact_speed);
        0.5 * mass * impact_speed * impact_speed * (1.0 - eps) * (1.0 + eps)
    }

    /// Refuses parameters for which [`at`](Self::at) has no meaning.
    ///
    /// # Errors
    /// The first parameter that is out of its range.
    fn validate(&self) -> Result<(), ParameterError> {
        Ok(())
    }
}

/// Any law, for choices made at run time.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ContactLaw {
    /// K δⁿ (1 + ξ δ'/v₀) and its relatives.
    Family(NormalLaw),
    /// A linear spring and damper.
    KelvinVoigt(KelvinVoigt),
    /// The caller's own. It has no serialised form.
    #[cfg_attr(feature = "serde", serde(skip))]
    Custom(Arc<dyn NormalModel>),
}

impl ContactLaw {
    /// The law behind the choice.
    #[inline]
    pub fn model(&self) -> &dyn NormalModel {
        match self {
            Self::Family(law) => law,
            Self::KelvinVoigt(law) => law,
            Self::Custom(law) => law.as_ref(),
        }
    }
}

impl NormalModel for ContactLaw {
    #[inline]
    fn at(&self, depth: f64, rate: f64, impact_speed: f64) -> NormalForce {
        match self {
            Self::Family(law) => law.at(depth, rate, impact_speed),
            other => other.model().at(depth, rate, impact_speed),
        }
    }

    fn stored_energy(&self, depth: f64) -> f64 {
        self.model().stored_energy(depth)
    }

    fn delivered_restitution(&self, mass: f64, impact_speed: f64) -> f64 {
        self.model().delivered_restitution(mass, impact_speed)
    }

    fn greatest_depth(&self, mass: f64, impact_speed: f64) -> f64 {
        self.model().greatest_depth(mass, impact_speed)
    }

    fn energy_loss(&self, mass: f64, impact_speed: f64) -> f64 {
        self.model().energy_loss(mass, impact_speed)
    }

    fn validate(&self) -> Result<(), ParameterError> {
        self.model().validate()
    }
}

impl From<NormalLaw> for ContactLaw {
    fn from(law: NormalLaw) -> Self {
        Self::Family(law)
    }
}

impl From<KelvinVoigt> for ContactLaw {
    fn from(law: KelvinVoigt) -> Self {
        Self::KelvinVoigt(law)
    }
}

impl From<Arc<dyn NormalModel>> for ContactLaw {
    fn from(law: Arc<dyn NormalModel>) -> Self {
        Self::Custom(law)
    }
}

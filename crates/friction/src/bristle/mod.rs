//! Bristle models: friction with one internal state, the deflection of a bristle.

mod elasto_plastic;
mod lugre;

pub use elasto_plastic::ElastoPlastic;
pub use lugre::{Guard, LuGre};

use crate::ParameterError;
use std::fmt::Debug;
use std::sync::Arc;

/// A quantity with its derivatives by slip speed and bristle deflection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Partials {
    /// The quantity.
    pub value: f64,
    /// Its derivative by the slip speed, per m/s.
    pub d_slip: f64,
    /// Its derivative by the bristle deflection, per m.
    pub d_bristle: f64,
}

/// A bristle model at one slip speed and deflection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BristlePoint {
    /// Coefficient of friction µ \[-\]; friction is µ times the normal force, against the slip.
    pub coefficient: Partials,
    /// Rate of the bristle ż \[m/s\].
    pub rate: Partials,
}

/// A friction coefficient µ(v, z) whose bristle deflection z \[m\] follows ż(v, z).
///
/// A model holds parameters only; the deflection belongs to the caller's state. µ is normalised by
/// the normal force, which therefore may vanish.
pub trait BristleModel: Debug + Send + Sync {
    /// Coefficient and bristle rate with their derivatives, at a slip speed \[m/s\] and a
    /// deflection \[m\].
    fn at(&self, slip: f64, bristle: f64) -> BristlePoint;

    /// Deflection \[m\] that a lasting slip \[m/s\] ends in; zero at rest.
    fn steady_bristle(&self, slip: f64) -> f64;

    /// Largest deflection \[m\], never exceeded by a bristle that starts within it.
    fn bristle_limit(&self) -> f64;

    /// Whether friction is sure to take at least the power that the bristle stores, for every
    /// deflection, at this slip speed \[m/s\]. Where not, friction may drive the motion.
    fn is_passive_at(&self, slip: f64) -> bool;

    /// Coefficient of friction \[-\] that a lasting slip \[m/s\] ends in; zero at rest.
    fn steady_coefficient(&self, slip: f64) -> f64 {
        let z = self.steady_bristle(slip);
        self.at(slip, z).coefficient.value
    }

    /// Refuses parameters for which [`at`](Self::at) has no meaning.
    fn validate(&self) -> Result<(), ParameterError> {
        Ok(())
    }
}

/// Any bristle model, for choices made at run time.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Bristle {
    /// LuGre, with or without a guard.
    #[cfg_attr(feature = "serde", serde(rename = "lugre"))]
    LuGre(LuGre),
    /// Elasto-plastic: LuGre without drift under loads that do not break away.
    ElastoPlastic(ElastoPlastic),
    /// The caller's own. It has no serialised form.
    #[cfg_attr(feature = "serde", serde(skip))]
    Custom(Arc<dyn BristleModel>),
}

impl Bristle {
    /// The model behind the choice.
    #[inline]
    pub fn model(&self) -> &dyn BristleModel {
        match self {
            Self::LuGre(model) => model,
            Self::ElastoPlastic(model) => model,
            Self::Custom(model) => model.as_ref(),
        }
    }
}

impl BristleModel for Bristle {
    #[inline]
    fn at(&self, slip: f64, bristle: f64) -> BristlePoint {
        self.model().at(slip, bristle)
    }

    fn steady_bristle(&self, slip: f64) -> f64 {
        self.model().steady_bristle(slip)
    }

    fn bristle_limit(&self) -> f64 {
        self.model().bristle_limit()
    }

    fn is_passive_at(&self, slip: f64) -> bool {
        self.model().is_passive_at(slip)
    }

    fn steady_coefficient(&self, slip: f64) -> f64 {
        self.model().steady_coefficient(slip)
    }

    fn validate(&self) -> Result<(), ParameterError> {
        self.model().validate()
    }
}

impl From<LuGre> for Bristle {
    fn from(model: LuGre) -> Self {
        Self::LuGre(model)
    }
}

impl From<ElastoPlastic> for Bristle {
    fn from(model: ElastoPlastic) -> Self {
        Self::ElastoPlastic(model)
    }
}

impl From<Arc<dyn BristleModel>> for Bristle {
    fn from(model: Arc<dyn BristleModel>) -> Self {
        Self::Custom(model)
    }
}

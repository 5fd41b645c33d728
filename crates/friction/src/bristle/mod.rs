//! Bristle models: friction with one internal state, the deflection of a bristle.

mod elasto_plastic;
mod lugre;
mod planar;

pub use elasto_plastic::ElastoPlastic;
pub use lugre::{Guard, LuGre};
pub use planar::{BristleStart, PlanarBristlePoint};

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

    /// Coefficient and bristle rate for a slip \[m/s\] and a deflection \[m\] in the plane of contact, by components
    /// along two directions that are carried along with the contact. On a line the same as [`at`](Self::at).
    ///
    /// By default the one-dimensional model at the slip's speed, with what the deflection across the slip changes
    /// added across.
    fn at_planar(&self, slip: [f64; 2], bristle: [f64; 2]) -> PlanarBristlePoint {
        planar::superposed(self, slip, bristle)
    }

    /// The slip speed \[m/s\] up to which the model is passive; infinite where it is at all speeds.
    ///
    /// By default found by trying [`is_passive_at`](Self::is_passive_at) from 1e-12 to 1e12 m/s in steps of a
    /// hundredth, then by bisection to rounding. For diagnoses, not for inner loops.
    fn largest_passive_slip(&self) -> f64 {
        let mut passive = 0.0;
        let mut speed = 1e-12;
        while self.is_passive_at(speed) {
            passive = speed;
            speed *= 1.01;
            if speed > 1e12 {
                return f64::INFINITY;
            }
        }
        if passive == 0.0 {
            return 0.0;
        }
        loop {
            let middle = 0.5 * (passive + speed);
            if !(passive < middle && middle < speed) {
                return passive;
            }
            if self.is_passive_at(middle) {
                passive = middle;
            } else {
                speed = middle;
            }
        }
    }

    /// Refuses parameters for which [`at`](Self::at) has no meaning.
    fn validate(&self) -> Result<(), ParameterError> {
        Ok(())
    }
}

/// Any bristle model, for choices made at run time.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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

    #[inline]
    fn at_planar(&self, slip: [f64; 2], bristle: [f64; 2]) -> PlanarBristlePoint {
        self.model().at_planar(slip, bristle)
    }

    fn largest_passive_slip(&self) -> f64 {
        self.model().largest_passive_slip()
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

use super::{NormalForce, NormalModel, RestitutionLaw, finite};
use crate::{Expected, ParameterError, impact};

/// How a [`NormalLaw`] loses energy.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
pub enum Damping {
    /// Not at all: Hertz's law, ξ = 0.
    Hertz,
    /// ξ by a wanted restitution.
    Restitution {
        /// The formula.
        law: RestitutionLaw,
        /// Wanted restitution 0 ≤ ε ≤ 1 \[-\]; zero is refused by some laws.
        restitution: f64,
    },
    /// F = K δⁿ (1 + 3/2 α δ'), the material form of Hunt and Crossley 1975: no memory of the impact speed, and
    /// ε ≈ 1 - α v₀ at low speed. The choice for long or grazing contacts.
    Material {
        /// α ≥ 0 \[s/m\].
        constant: f64,
    },
}

/// Normal force F = K δⁿ (1 + ξ δ'/v₀), where v₀ is the speed at which the contact began.
///
/// * The force never pulls: it is zero where the bracket is negative. In a free impact that never happens, because
///   1 - ξ ε > 0; it needs another force that tears the bodies apart faster than v₀/ξ.
/// * v₀ has a floor, [`least_impact_speed`](Self::least_impact_speed), so that the damping of a contact that begins at
///   rest or by grazing stays finite. Below it an impact is damped less than at the floor, towards ε = 1. The default,
///   1e-6 m/s, only keeps the division harmless: a contact that begins so slowly and is then driven at 0.1 m/s meets a
///   damping of 1e5 ξ times its elastic force. Where that matters take 1e-3 to 1e-2 of the typical impact speed, or
///   [`Damping::Material`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Parameters", into = "Parameters"))]
pub struct NormalLaw {
    stiffness: f64,
    exponent: f64,
    damping: Damping,
    least_impact_speed: f64,
    /// ξ, or 3/2 α of the material form.
    factor: f64,
}

impl NormalLaw {
    /// Floor \[m/s\] of the impact speed unless another is given.
    pub const LEAST_IMPACT_SPEED: f64 = 1e-6;

    /// A law with stiffness K > 0 \[N/mⁿ\], exponent n ≥ 1 \[-\] and damping.
    ///
    /// # Errors
    /// The first parameter that is out of its range.
    pub fn new(stiffness: f64, exponent: f64, damping: Damping) -> Result<Self, ParameterError> {
        Expected::Positive.check("stiffness", stiffness)?;
        Expected::AtLeast(1.0).check("exponent", exponent)?;
        let factor = match damping {
            Damping::Hertz => 0.0,
            Damping::Restitution { law, restitution } => law.damping_factor(restitution)?,
            Damping::Material { constant } => {
                Expected::NotNegative.check("constant", constant)?;
                finite(1.5 * constant)
            }
        };
        Ok(Self {
            stiffness,
            exponent,
            damping,
            least_impact_speed: Self::LEAST_IMPACT_SPEED,
            factor,
        })
    }

    /// The same law with another floor > 0 \[m/s\] of the impact speed.
    ///
    /// # Errors
    /// A floor that is not positive.
    pub fn with_least_impact_speed(self, speed: f64) -> Result<Self, ParameterError> {
        Expected::Positive.check("least_impact_speed", speed)?;
        Ok(Self {
            least_impact_speed: speed,
            ..self
        })
    }

    /// K \[N/mⁿ\].
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// n \[-\].
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// The damping as it was asked for.
    pub fn damping(&self) -> Damping {
        self.damping
    }

    /// Floor \[m/s\] of the impact speed.
    pub fn least_impact_speed(&self) -> f64 {
        self.least_impact_speed
    }

    /// ξ \[-\] of an impact at this speed \[m/s\]: the law's number for speeds above the floor, in proportion to the
    /// speed below it and for [`Damping::Material`].
    pub fn damping_factor(&self, impact_speed: f64) -> f64 {
        match self.damping {
            Damping::Material { .. } => finite(self.factor * impact_speed),
            _ if impact_speed < self.least_impact_speed => self.factor * (impact_speed / self.least_impact_speed),
            _ => self.factor,
        }
    }

    /// Restitution \[-\] that a free impact at this speed \[m/s\] really has, by [`impact::restitution`]; whatever the
    /// mass, and above the floor whatever the speed.
    pub fn delivered_restitution(&self, impact_speed: f64) -> f64 {
        impact::restitution(self.damping_factor(impact_speed))
    }

    /// ξ/v₀ \[s/m\].
    #[inline]
    fn per_rate(&self, impact_speed: f64) -> f64 {
        match self.damping {
            Damping::Material { .. } => self.factor,
            // In this order NaN is not taken for slow.
            _ if impact_speed < self.least_impact_speed => finite(self.factor / self.least_impact_speed),
            _ => finite(self.factor / impact_speed),
        }
    }

    /// δ^(n-1).
    #[inline]
    fn power(&self, depth: f64) -> f64 {
        if self.exponent == 1.5 {
            depth.sqrt()
        } else if self.exponent == 1.0 {
            1.0
        } else {
            depth.powf(self.exponent - 1.0)
        }
    }
}

impl NormalModel for NormalLaw {
    #[inline]
    fn at(&self, depth: f64, rate: f64, impact_speed: f64) -> NormalForce {
        if depth <= 0.0 {
            return NormalForce::default();
        }
        let chord = finite(self.stiffness * self.power(depth));
        let elastic = finite(chord * depth);
        let per_rate = self.per_rate(impact_speed);
        let bracket = finite(1.0 + per_rate * rate);
        let d_depth = self.exponent * chord * bracket;
        NormalForce::kept_from_pulling(elastic * bracket, elastic, d_depth, elastic * per_rate)
    }

    /// K δ^(n+1)/(n+1).
    fn stored_energy(&self, depth: f64) -> f64 {
        if depth <= 0.0 {
            return 0.0;
        }
        finite(self.stiffness * self.power(depth) * depth / (self.exponent + 1.0) * depth)
    }

    /// Does not depend on the mass.
    fn delivered_restitution(&self, _mass: f64, impact_speed: f64) -> f64 {
        self.delivered_restitution(impact_speed)
    }

    /// `((n + 1) m v₀² L(ξ)/(ξ² K))^(1/(n+1))`, see [`impact`].
    fn greatest_depth(&self, mass: f64, impact_speed: f64) -> f64 {
        let share = impact::depth_factor(self.damping_factor(impact_speed));
        let n1 = self.exponent + 1.0;
        (n1 * share * mass * impact_speed * impact_speed / self.stiffness).powf(1.0 / n1)
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Self::new(self.stiffness, self.exponent, self.damping).map(|_| ())
    }
}

/// The serialised form, checked when it is read.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    stiffness: f64,
    exponent: f64,
    damping: Damping,
    #[serde(default = "default_floor")]
    least_impact_speed: f64,
}

#[cfg(feature = "serde")]
fn default_floor() -> f64 {
    NormalLaw::LEAST_IMPACT_SPEED
}

#[cfg(feature = "serde")]
impl TryFrom<Parameters> for NormalLaw {
    type Error = ParameterError;

    fn try_from(given: Parameters) -> Result<Self, ParameterError> {
        Self::new(given.stiffness, given.exponent, given.damping)?.with_least_impact_speed(given.least_impact_speed)
    }
}

#[cfg(feature = "serde")]
impl From<NormalLaw> for Parameters {
    fn from(law: NormalLaw) -> Self {
        Self {
            stiffness: law.stiffness,
            exponent: law.exponent,
            damping: law.damping,
            least_impact_speed: law.least_impact_speed,
        }
    }
}

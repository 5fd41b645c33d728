use super::{NormalForce, NormalModel, finite};
use crate::{Expected, ParameterError};

/// Linear spring and damper, F = K δ + D δ', kept from pulling.
///
/// The force jumps by D v₀ at first touch, and the bodies part where F = 0, before the depth is zero. Relations of a
/// free impact of the mass m (Schwager and Pöschel 2007), with ζ = D/(2 √(K m)), ω₀ = √(K/m) and
/// y = ζ arccos(ζ)/√(1 - ζ²), or ζ arcosh(ζ)/√(ζ² - 1) for ζ > 1, or 1 for ζ = 1:
///
/// ```text
/// ε = exp(-2y),   δ_max = v₀/ω₀ exp(-y)
/// ```
///
/// The contact lasts twice as long as the way to the greatest depth.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct KelvinVoigt {
    /// K > 0 \[N/m\].
    pub stiffness: f64,
    /// D ≥ 0 \[N s/m\].
    pub damping: f64,
}

impl KelvinVoigt {
    /// y for a mass \[kg\].
    fn decay(&self, mass: f64) -> f64 {
        let zeta = 0.5 * self.damping / (self.stiffness.sqrt() * mass.sqrt());
        let off = ((1.0 - zeta) * (1.0 + zeta)).abs().sqrt();
        if off == 0.0 {
            1.0
        } else if zeta < 1.0 {
            zeta * off.atan2(zeta) / off
        } else {
            // ζ/√(ζ²-1) tends to one; their quotient would be ∞/∞ for the largest ζ.
            off.asinh() / (off / zeta).min(1.0)
        }
    }
}

impl NormalModel for KelvinVoigt {
    #[inline]
    fn at(&self, depth: f64, rate: f64, _impact_speed: f64) -> NormalForce {
        if depth <= 0.0 {
            return NormalForce::default();
        }
        let elastic = finite(self.stiffness * depth);
        let value = elastic + finite(self.damping * rate);
        NormalForce::kept_from_pulling(value, elastic, self.stiffness, self.damping)
    }

    /// K δ²/2.
    fn stored_energy(&self, depth: f64) -> f64 {
        if depth <= 0.0 {
            return 0.0;
        }
        finite(0.5 * self.stiffness * depth * depth)
    }

    /// Does not depend on the speed.
    fn delivered_restitution(&self, mass: f64, _impact_speed: f64) -> f64 {
        (-2.0 * self.decay(mass)).exp()
    }

    fn greatest_depth(&self, mass: f64, impact_speed: f64) -> f64 {
        impact_speed * (mass.sqrt() / self.stiffness.sqrt()) * (-self.decay(mass)).exp()
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Expected::Positive.check("stiffness", self.stiffness)?;
        Expected::NotNegative.check("damping", self.damping)
    }
}

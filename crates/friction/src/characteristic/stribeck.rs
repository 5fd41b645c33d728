use super::{Characteristic, Value};
use crate::{Expected, ParameterError};

/// Coulomb friction with a static peak (Stribeck effect), sign regularised.
///
/// ```text
/// µ_k χ(v) = tanh(v/v_r) (µ_k + (µ_s - µ_k) exp(-|v/v_s|^p))
///     χ(v) = tanh(v/v_r) (1 + (ρ - 1) exp(-|v/v_s|^p)),  ρ = µ_s/µ_k
/// ```
///
/// The coefficient it multiplies is the kinetic one, and |χ| ≤ ρ. The curve of the literature jumps
/// at v = 0; tanh makes a function of it, continuous with its slope for every p > 0. It comes close
/// to ρ only where v_r is small against v_s: with v_r = v_s/10 and p = 2 the peak is at
/// about 1 + 0.9 (ρ - 1). It does not hold a load at rest: for that take a bristle model.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Stribeck {
    /// Ratio ρ = µ_s/µ_k ≥ 1 \[-\] of the static to the kinetic coefficient.
    pub static_ratio: f64,
    /// Speed v_s > 0 \[m/s or rad/s\] over which the static share fades.
    pub stribeck_speed: f64,
    /// Exponent p > 0 \[-\]: 2 (Gauss) and 1 (Tustin) are usual.
    pub exponent: f64,
    /// Speed v_r > 0 \[m/s or rad/s\] of the regularised sign tanh(v/v_r).
    pub reference_speed: f64,
}

impl Characteristic for Stribeck {
    #[inline]
    fn at(&self, slip: f64) -> Value {
        let v_r = self.reference_speed;
        let s = (slip / v_r).tanh();
        let u = (slip / self.stribeck_speed).abs();
        let w = if self.exponent == 2.0 {
            u * u
        } else {
            u.powf(self.exponent)
        };
        let share = (self.static_ratio - 1.0) * (-w).exp();
        let level = 1.0 + share;
        // s · d(share)/dv, written with s/v, which stays bounded, as w/v does not for p < 1.
        let fading = if share == 0.0 || slip == 0.0 {
            0.0
        } else {
            -self.exponent * (w * share) * (s / slip)
        };
        Value {
            value: s * level,
            slope: (1.0 - s) * (1.0 + s) / v_r * level + fading,
        }
    }

    fn validate(&self) -> Result<(), ParameterError> {
        let kinetic = Expected::AtLeast {
            bound: 1.0,
            of: "the kinetic level",
        };
        kinetic.check("static_ratio", self.static_ratio)?;
        Expected::Positive.check("stribeck_speed", self.stribeck_speed)?;
        Expected::Positive.check("exponent", self.exponent)?;
        Expected::Positive.check("reference_speed", self.reference_speed)
    }
}

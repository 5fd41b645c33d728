use super::{Characteristic, Value};
use crate::{Expected, ParameterError};

/// Hyperbolic tangent.
///
/// ```text
/// χ(v) = tanh(v/v_r)        Rooney and Deravi 1982
/// ```
///
/// Smooth to every order. χ(v_r) = 0.762, χ = 0.95 at 1.832 v_r. A sticking load creeps with
/// v = v_r artanh(T/(µ₀ N)).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct HyperbolicTangent {
    /// Speed v_r > 0 \[m/s or rad/s\]; the slope at zero is 1/v_r.
    pub reference_speed: f64,
}

impl Characteristic for HyperbolicTangent {
    #[inline]
    fn at(&self, slip: f64) -> Value {
        let chi = (slip / self.reference_speed).tanh();
        Value {
            value: chi,
            slope: (1.0 - chi) * (1.0 + chi) / self.reference_speed,
        }
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Expected::Positive.check("reference_speed", self.reference_speed)
    }
}

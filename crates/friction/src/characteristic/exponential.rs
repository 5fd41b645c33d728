use super::{Characteristic, Value};
use crate::{Expected, ParameterError};

/// Exponential rise to one.
///
/// ```text
/// χ(v) = sgn(v) (1 - exp(-k |v|/v_k))        Harlecki and Urbaś, eq. (7); Threlfall 1978
/// ```
///
/// The printed second branch of eq. (7) has +k in the exponent, which grows without bound for v < 0;
/// here both directions decay. χ is continuous with its slope, which is k/v_k at zero; the second
/// derivative jumps there. |χ| < 1, and χ(v_k) = 0.95 for k = 3.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Exponential {
    /// Speed v_k > 0 \[m/s or rad/s\] by which χ has grown to 1 - exp(-k).
    pub reference_speed: f64,
    /// Exponent k > 0 \[-\] at the reference speed; 3 in the paper.
    pub steepness: f64,
}

impl Characteristic for Exponential {
    #[inline]
    fn at(&self, slip: f64) -> Value {
        let k = self.steepness / self.reference_speed;
        let m = (-k * slip.abs()).exp_m1();
        Value {
            value: (-m).copysign(slip),
            slope: k * (1.0 + m),
        }
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Expected::Positive.check("reference_speed", self.reference_speed)?;
        Expected::Positive.check("steepness", self.steepness)
    }
}

use super::{Characteristic, Value};
use crate::{Expected, ParameterError};

/// Three straight segments.
///
/// ```text
/// χ(v) = v/v_r for |v| < v_r, else sgn(v)        Bernard 1980
/// ```
///
/// χ is continuous; its slope jumps from 1/v_r to 0 at |v| = v_r, where the outer value is returned.
/// A sticking load creeps with v = v_r T/(µ₀ N).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PiecewiseLinear {
    /// Speed v_r > 0 \[m/s or rad/s\] from which χ is constant.
    pub reference_speed: f64,
}

impl Characteristic for PiecewiseLinear {
    #[inline]
    fn at(&self, slip: f64) -> Value {
        let x = slip / self.reference_speed;
        Value {
            value: x.clamp(-1.0, 1.0),
            slope: if x.abs() >= 1.0 {
                0.0
            } else {
                1.0 / self.reference_speed
            },
        }
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Expected::Positive.check("reference_speed", self.reference_speed)
    }
}

use super::{Characteristic, Value};
use crate::{Expected, ParameterError};

/// One cubic arc between the two constant branches.
///
/// ```text
/// χ(v) = (3 x - x³)/2, x = v/v_r, for |x| < 1, else sgn(v)
/// ```
///
/// This is the cubic step of multibody programs, laid from -1 at -v_r to +1 at +v_r. χ is
/// continuous with its slope; the second derivative jumps at |v| = v_r.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Cubic {
    /// Speed v_r > 0 \[m/s or rad/s\] from which χ is constant; the slope at zero is 3/(2 v_r).
    pub reference_speed: f64,
}

impl Characteristic for Cubic {
    #[inline]
    fn at(&self, slip: f64) -> Value {
        let x = (slip / self.reference_speed).clamp(-1.0, 1.0);
        Value {
            value: 0.5 * x * (3.0 - x * x),
            slope: 1.5 * (1.0 - x * x) / self.reference_speed,
        }
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Expected::Positive.check("reference_speed", self.reference_speed)
    }
}

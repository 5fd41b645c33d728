use super::{Characteristic, Value};
use crate::{Expected, ParameterError};

/// A share proportional to the slip: χ(v) = c v.
///
/// It scales with the load, like every characteristic here. A drag that acts without any load is a
/// damper in the joint, not a characteristic. The only one without a bound; use it in a [`Sum`](crate::Sum).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Viscous {
    /// Growth c ≥ 0 per unit of slip \[s/m or s/rad\].
    pub per_speed: f64,
}

impl Characteristic for Viscous {
    #[inline]
    fn at(&self, slip: f64) -> Value {
        Value {
            value: self.per_speed * slip,
            slope: self.per_speed,
        }
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Expected::NotNegative.check("per_speed", self.per_speed)
    }
}

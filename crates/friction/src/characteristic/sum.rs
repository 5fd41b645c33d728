use super::{Characteristic, Value};
use crate::ParameterError;

/// Two characteristics added: χ(v) = χ₁(v) + χ₂(v).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Sum<A, B> {
    /// χ₁, usually the dry share.
    pub first: A,
    /// χ₂, usually the viscous share.
    pub second: B,
}

impl<A: Characteristic, B: Characteristic> Characteristic for Sum<A, B> {
    #[inline]
    fn at(&self, slip: f64) -> Value {
        let (a, b) = (self.first.at(slip), self.second.at(slip));
        Value {
            value: a.value + b.value,
            slope: a.slope + b.slope,
        }
    }

    fn validate(&self) -> Result<(), ParameterError> {
        self.first.validate()?;
        self.second.validate()
    }
}

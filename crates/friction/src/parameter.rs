//! Refusal of parameters that no formula of this crate can work with.

use std::fmt;

/// A parameter outside its range: which one, what it is, and what it should be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{field} is {value}, but must be {expected}")]
pub struct ParameterError {
    /// Path of the field inside the refused struct, such as `surface_a.diameter`.
    pub field: &'static str,
    /// Its value, in the unit of the field.
    pub value: f64,
    /// What would have been accepted.
    pub expected: Expected,
}

/// The range a parameter has to lie in. NaN and infinities lie in none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expected {
    /// Greater than zero, and not subnormal, so that its reciprocal is finite.
    Positive,
    /// Zero or greater.
    NotNegative,
    /// Not below another quantity.
    AtLeast {
        /// The smallest accepted value, in the unit of the field.
        bound: f64,
        /// What the bound is.
        of: &'static str,
    },
    /// From zero up to, but not including, one.
    ProperFraction,
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Positive => write!(f, "finite and greater than zero"),
            Self::NotNegative => write!(f, "finite and not negative"),
            Self::AtLeast { bound, of } => write!(f, "finite and at least {bound} ({of})"),
            Self::ProperFraction => write!(f, "at least zero and below one"),
        }
    }
}

impl Expected {
    fn admits(&self, value: f64) -> bool {
        value.is_finite()
            && match *self {
                Self::Positive => value >= f64::MIN_POSITIVE,
                Self::NotNegative => value >= 0.0,
                Self::AtLeast { bound, .. } => value >= bound,
                Self::ProperFraction => (0.0..1.0).contains(&value),
            }
    }

    /// `Ok` where the value lies in the range, else the error that says so.
    pub(crate) fn check(self, field: &'static str, value: f64) -> Result<(), ParameterError> {
        if self.admits(value) {
            Ok(())
        } else {
            Err(ParameterError {
                field,
                value,
                expected: self,
            })
        }
    }
}

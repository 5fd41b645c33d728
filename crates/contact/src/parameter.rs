//! Refusal of parameters that no formula of this crate can work with.

use std::fmt;

/// A parameter outside its range: which one, what it is, and what it should be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{field} is {value}, but must be {expected}")]
pub struct ParameterError {
    /// Name of the field or argument, such as `stiffness`.
    pub field: &'static str,
    /// Its value, in SI units.
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
    /// Not below a number.
    AtLeast(f64),
    /// From zero to one.
    Fraction,
    /// Greater than zero, at most one.
    PositiveFraction,
    /// Greater than -1, at most 1/2.
    PoissonRatio,
    /// Positive and below another quantity.
    Below {
        /// The smallest number that is too large, in the unit of the field.
        bound: f64,
        /// What the bound is.
        of: &'static str,
    },
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Positive => write!(f, "finite and greater than zero"),
            Self::NotNegative => write!(f, "finite and not negative"),
            Self::AtLeast(bound) => write!(f, "finite and at least {bound}"),
            Self::Fraction => write!(f, "from zero to one"),
            Self::PositiveFraction => write!(f, "greater than zero and at most one"),
            Self::PoissonRatio => write!(f, "greater than -1 and at most 0.5"),
            Self::Below { bound, of } => write!(f, "greater than zero and below {bound} ({of})"),
        }
    }
}

impl Expected {
    fn admits(&self, value: f64) -> bool {
        value.is_finite()
            && match *self {
                Self::Positive => value >= f64::MIN_POSITIVE,
                Self::NotNegative => value >= 0.0,
                Self::AtLeast(bound) => value >= bound,
                Self::Fraction => (0.0..=1.0).contains(&value),
                Self::PositiveFraction => (f64::MIN_POSITIVE..=1.0).contains(&value),
                Self::PoissonRatio => value > -1.0 && value <= 0.5,
                Self::Below { bound, .. } => (f64::MIN_POSITIVE..bound).contains(&value),
            }
    }

    /// `Ok` where the value lies in the range, else the error that says so.
    pub(crate) fn check(self, field: &'static str, value: f64) -> Result<(), ParameterError> {
        if self.admits(value) {
            Ok(())
        } else {
            Err(self.refusal(field, value))
        }
    }

    pub(crate) fn refusal(self, field: &'static str, value: f64) -> ParameterError {
        ParameterError {
            field,
            value,
            expected: self,
        }
    }
}

//! Refusal of numbers that no beam can be made of.

use std::fmt;

/// A number outside its range: which one, what it is, and what it should be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{item} is {value}, but must be {expected}")]
pub struct BeamError {
    /// Name of the argument or field, such as `section.bending[0]`, or of a result that its arguments drove out of range.
    pub item: &'static str,
    /// Its value, in its SI unit; counts as the nearest `f64`.
    pub value: f64,
    /// What would have been accepted.
    pub expected: Expected,
}

/// The range a number has to lie in. NaN and infinities lie in none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expected {
    /// Greater than zero, and not subnormal, so that its reciprocal is finite.
    Positive,
    /// Zero or greater.
    NotNegative,
    /// Below another quantity, and not negative.
    Below {
        /// What it has to stay below, in the unit of the item.
        bound: f64,
        /// What the bound is.
        of: &'static str,
    },
    /// A ratio of Poisson for which both moduli are positive and the volume does not shrink under tension.
    PoissonRatio,
    /// A count.
    Count {
        /// Smallest accepted.
        from: usize,
        /// Largest accepted.
        to: usize,
    },
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Positive => write!(f, "finite and greater than zero"),
            Self::NotNegative => write!(f, "finite and not negative"),
            Self::Below { bound, of } => write!(f, "not negative and below {bound} ({of})"),
            Self::PoissonRatio => write!(f, "above -1 and at most 0.5"),
            Self::Count { from, to } => write!(f, "from {from} to {to}"),
        }
    }
}

impl Expected {
    fn admits(&self, value: f64) -> bool {
        value.is_finite()
            && match *self {
                Self::Positive => value >= f64::MIN_POSITIVE,
                Self::NotNegative => value >= 0.0,
                Self::Below { bound, .. } => value >= 0.0 && value < bound,
                Self::PoissonRatio => value > -1.0 && value <= 0.5,
                Self::Count { from, to } => value >= from as f64 && value <= to as f64,
            }
    }

    /// The value where it lies in the range, else the error that says so.
    pub(crate) fn check(self, item: &'static str, value: f64) -> Result<f64, BeamError> {
        if self.admits(value) {
            Ok(value)
        } else {
            let expected = self;
            Err(BeamError { item, value, expected })
        }
    }
}

//! Errors of differential-algebraic problems, measured by the index of their components.

use crate::{Ode, SettingsError};

/// The indices of all components, and room for scaled errors; nothing at all where every index is 1.
#[derive(Debug, Clone, Default)]
pub(crate) struct Indices {
    /// Index less one.
    excess: Vec<i32>,
    scaled: [Vec<f64>; 3],
}

/// Largest index that the theory of the method covers.
const LARGEST: u32 = 3;

impl Indices {
    /// Those of a problem.
    pub(crate) fn new<P: Ode + ?Sized>(problem: &P) -> Result<Self, SettingsError> {
        let dim = problem.dim();
        if (0..dim).any(|i| !(1..=LARGEST).contains(&problem.index(i))) {
            return Err(SettingsError::Method("needed: 1 <= index of a component <= 3"));
        }
        if (0..dim).all(|i| problem.index(i) == 1) {
            return Ok(Self::default());
        }
        Ok(Self {
            excess: (0..dim).map(|i| problem.index(i) as i32 - 1).collect(),
            scaled: std::array::from_fn(|_| vec![0.0; dim]),
        })
    }

    /// Whether there is a component of an index above 1.
    pub(crate) fn is_higher(&self) -> bool {
        !self.excess.is_empty()
    }

    /// Errors of components of index k, multiplied by |h|ᵏ⁻¹ (Hairer, Wanner II, VII.8 and subroutine RADAU5).
    pub(crate) fn scale<'a, const K: usize>(&'a mut self, h: f64, errors: [&'a [f64]; K]) -> [&'a [f64]; K] {
        if self.excess.is_empty() {
            return errors;
        }
        for (target, error) in self.scaled.iter_mut().zip(errors) {
            for ((target, error), &excess) in target.iter_mut().zip(error).zip(&self.excess) {
                *target = error * h.abs().powi(excess);
            }
        }
        std::array::from_fn(|k| &self.scaled[k][..])
    }
}

//! The norm in which errors are measured.

use crate::lanes::{LANES, Lanes};

/// Tolerances of all components, and the norm that belongs to them.
#[derive(Debug, Clone)]
pub struct Weights {
    inverse_dim: f64,
    least_relative: f64,
    scales: Vec<Scale>,
}

/// Tolerances of one block of components.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    relative: Lanes,
    absolute: Lanes,
}

impl Scale {
    /// 1 / sᵢ for a step between two states.
    #[inline(always)]
    pub(crate) fn inverse(&self, y0: Lanes, y1: Lanes) -> Lanes {
        // Unlike `f64::max` this lets a y₁ through that is not a number.
        let size = y0.zip(y1, |y0, y1| if y0.abs() > y1.abs() { y0.abs() } else { y1.abs() });
        (self.absolute + self.relative * size).map(|scale| 1.0 / scale)
    }
}

impl Weights {
    /// Tolerances of each component, of equal length.
    pub(crate) fn new(relative: &[f64], absolute: &[f64]) -> Self {
        let blocks = relative.chunks(LANES).zip(absolute.chunks(LANES));
        let scale = |(relative, absolute)| Scale {
            relative: Lanes::load(relative),
            absolute: Lanes::load_or(absolute, 1.0),
        };
        let controlled = relative
            .iter()
            .zip(absolute)
            .filter(|(_, absolute)| absolute.is_finite());
        Self {
            inverse_dim: 1.0 / relative.len().max(1) as f64,
            least_relative: controlled.map(|(&relative, _)| relative).fold(1.0, f64::min),
            scales: blocks.map(scale).collect(),
        }
    }

    /// √(Σ (eᵢ / sᵢ)² / n) with sᵢ = absoluteᵢ + relativeᵢ max(|y₀ᵢ|, |y₁ᵢ|) (Hairer, Nørsett, Wanner I, eq. II.4.10-11).
    ///
    /// Not a number if an error or the new state is not.
    #[inline]
    #[must_use]
    pub fn norm(&self, y0: &[f64], y1: &[f64], error: &[f64]) -> f64 {
        self.mean_squares(y0, y1, [error])[0].sqrt()
    }

    /// The mean squares of several errors at once.
    #[inline]
    pub(crate) fn mean_squares<const K: usize>(&self, y0: &[f64], y1: &[f64], errors: [&[f64]; K]) -> [f64; K] {
        let mut sums = [Lanes::ZERO; K];
        let mut errors = errors.map(|error| error.chunks(LANES));
        for ((scale, y0), y1) in self.scales.iter().zip(y0.chunks(LANES)).zip(y1.chunks(LANES)) {
            let weight = scale.inverse(Lanes::load(y0), Lanes::load(y1));
            for (sum, error) in sums.iter_mut().zip(&mut errors) {
                *sum += (weight * Lanes::load(error.next().unwrap_or_default())).squared();
            }
        }
        sums.map(|sum| self.mean(sum))
    }

    /// The smallest relative tolerance of all components that are controlled; 1 if none is.
    pub(crate) fn least_relative(&self) -> f64 {
        self.least_relative
    }

    /// The tolerance of one component at the value `y`; infinite if it is not controlled.
    pub(crate) fn of(&self, component: usize, y: f64) -> f64 {
        let Scale { relative, absolute } = self.scales[component / LANES];
        absolute.0[component % LANES] + relative.0[component % LANES] * y.abs()
    }

    /// The scales of the blocks, for methods that do all their work in one pass.
    #[inline]
    pub(crate) fn scales(&self) -> &[Scale] {
        &self.scales
    }

    /// Mean over all components of what was summed over blocks.
    #[inline]
    pub(crate) fn mean(&self, sum: Lanes) -> f64 {
        sum.sum() * self.inverse_dim
    }

    /// The component whose error is largest against its tolerance.
    pub(crate) fn worst(&self, y0: &[f64], y1: &[f64], error: &[f64]) -> Option<usize> {
        let scaled = |i: usize| (error[i] / self.of(i, y0[i].abs().max(y1[i].abs()))).abs();
        (0..error.len()).max_by(|&i, &j| scaled(i).total_cmp(&scaled(j)))
    }
}

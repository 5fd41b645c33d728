//! The norm in which errors are measured.

/// Tolerances of all components, and the norm that belongs to them.
#[derive(Debug, Clone)]
pub struct Weights {
    relative: Vec<f64>,
    absolute: Vec<f64>,
}

impl Weights {
    /// Tolerances of each component, of equal length.
    pub(crate) fn new(relative: Vec<f64>, absolute: Vec<f64>) -> Self {
        Self { relative, absolute }
    }

    /// √(Σ (eᵢ / sᵢ)² / n) with sᵢ = absoluteᵢ + relativeᵢ max(|y₀ᵢ|, |y₁ᵢ|) (Hairer, Nørsett, Wanner I, eq. II.4.10-11).
    ///
    /// Not a number if an error or a state is not.
    #[inline]
    #[must_use]
    pub fn norm(&self, y0: &[f64], y1: &[f64], error: &[f64]) -> f64 {
        self.mean_squares(y0, y1, [error])[0].sqrt()
    }

    /// The mean squares of several errors at once.
    #[inline]
    pub(crate) fn mean_squares<const K: usize>(&self, y0: &[f64], y1: &[f64], errors: [&[f64]; K]) -> [f64; K] {
        let n = y0.len();
        let (y1, relative, absolute) = (&y1[..n], &self.relative[..n], &self.absolute[..n]);
        let errors = errors.map(|error| &error[..n]);
        let mut sums = [0.0; K];
        for i in 0..n {
            let weight = 1.0 / (absolute[i] + relative[i] * y0[i].abs().max(y1[i].abs()));
            for (sum, error) in sums.iter_mut().zip(errors) {
                *sum += (error[i] * weight) * (error[i] * weight);
            }
        }
        sums.map(|sum| sum / n.max(1) as f64)
    }

    /// The component whose error is largest against its tolerance.
    pub(crate) fn worst(&self, y0: &[f64], y1: &[f64], error: &[f64]) -> Option<usize> {
        let scaled = |i: usize| (error[i] / (self.absolute[i] + self.relative[i] * y0[i].abs().max(y1[i].abs()))).abs();
        (0..error.len()).max_by(|&i, &j| scaled(i).total_cmp(&scaled(j)))
    }
}

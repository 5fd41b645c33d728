//! The spectral radius of a matrix.

use crate::reduced::Layout;

/// Iterations, of which the second half is averaged: an even number, and enough for some ten percent where two moduli are apart by a half
/// (1.5⁻⁸ is 4 %). A matrix costs as many evaluations as it has columns, far more than these products.
const ITERATIONS: usize = 16;

/// Finds spectral radii by power iteration.
#[derive(Debug, Clone, Default)]
pub(super) struct Radius {
    layout: Layout,
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Radius {
    pub(super) fn new(layout: Layout) -> Self {
        Self {
            layout,
            // Any direction that is not special.
            x: (0..layout.active).map(|i| 1.0 + 0.1 * (i as f64).sin()).collect(),
            y: vec![0.0; layout.active],
        }
    }

    /// The largest modulus among the eigenvalues of df/dy, to some ten percent; the last direction is the first of the next search.
    ///
    /// The growth of the vector is averaged, geometrically, over several iterations: with a complex pair, or with rates and positions of
    /// very different size, it differs from one to the next.
    pub(super) fn find(&mut self, jacobian: &[f64]) -> f64 {
        let Layout { dim, pairs, active, .. } = self.layout;
        let mut logarithm = 0.0;
        for iteration in 0..ITERATIONS {
            self.y[..pairs].copy_from_slice(&self.x[pairs..2 * pairs]);
            for (y, row) in self.y[pairs..]
                .iter_mut()
                .zip(jacobian[pairs * dim..].chunks_exact(dim.max(1)))
            {
                *y = row[..active].iter().zip(&self.x).map(|(entry, x)| entry * x).sum();
            }
            let norm = self.y.iter().map(|y| y * y).sum::<f64>().sqrt();
            if !(norm > 0.0 && norm.is_finite()) {
                // Nothing grows at all (or nothing can be said): not stiff.
                *self = Self::new(self.layout);
                return 0.0;
            }
            self.y.iter_mut().for_each(|y| *y /= norm);
            std::mem::swap(&mut self.x, &mut self.y);
            if iteration >= ITERATIONS / 2 {
                logarithm += norm.ln();
            }
        }
        (logarithm / (ITERATIONS / 2) as f64).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn radius(layout: Layout, matrix: &[f64]) -> f64 {
        Radius::new(layout).find(matrix)
    }

    fn layout(dim: usize, pairs: usize, active: usize) -> Layout {
        Layout {
            dim,
            pairs,
            active,
            algebraic: 0,
        }
    }

    #[test]
    fn real_complex_and_none() {
        let found = radius(layout(2, 0, 2), &[-100.0, 1.0, 0.0, -1.0]);
        assert!((found / 100.0 - 1.0).abs() < 1e-6, "{found}");
        let found = radius(layout(2, 0, 2), &[-3.0, 40.0, -40.0, -3.0]);
        assert!((found / 3.0_f64.hypot(40.0) - 1.0).abs() < 1e-12, "{found}");
        assert_eq!(radius(layout(2, 0, 2), &[0.0, 0.0, 0.0, 0.0]), 0.0);
        assert_eq!(radius(layout(0, 0, 0), &[]), 0.0);
        assert_eq!(radius(layout(1, 0, 1), &[f64::NAN]), 0.0);
    }

    /// Rates and positions of a vibration differ by its frequency; the quadrature at the end has no column.
    #[test]
    fn vibration_with_quadrature() {
        let matrix = [[0.0, 1.0, 0.0], [-1e8, -20.0, 0.0], [5.0, 7.0, 0.0]].concat();
        let found = radius(layout(3, 1, 2), &matrix);
        assert!((found / 1e4 - 1.0).abs() < 0.15, "{found}");
    }
}

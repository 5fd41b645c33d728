//! Gauss-Jordan elimination with complete pivoting: which rows of a closure gradient count, and which speeds follow from the others.

use nalgebra::DMatrix;

/// Pivots below this share of the first one count as zero, as singular values do in
/// [`assembly`](linkdyn_kinematics::assembly::SingularValues).
pub(super) const RANK_TOLERANCE: f64 = 1e-9;

/// A matrix reduced so that each pivot's column holds a one in the pivot's row and zeros in all others.
#[derive(Clone, Debug)]
pub(super) struct Elimination {
    /// Row and column of each pivot, in the order of elimination.
    pub pivots: Vec<(usize, usize)>,
    /// The reduced matrix.
    pub reduced: DMatrix<f64>,
    /// Last pivot over the first; 1 without pivots.
    pub weakest: f64,
    /// Largest entry over the first pivot that was left where a pivot was allowed but counts as zero.
    pub rest: f64,
    /// First pivot.
    pub scale: f64,
}

impl Elimination {
    /// Eliminates with pivots in the rows and columns that `allowed` says, where `matrix` may have more columns than these.
    pub fn new(matrix: DMatrix<f64>, allowed: impl Fn(usize, usize) -> bool) -> Self {
        let mut a = matrix;
        let (m, n) = a.shape();
        let (mut row_free, mut column_free) = (vec![true; m], vec![true; n]);
        let mut pivots = Vec::new();
        let (mut scale, mut weakest) = (0.0, 1.0);
        let rest = loop {
            let mut best = (0, 0, 0.0);
            for j in (0..n).filter(|&j| column_free[j]) {
                for i in (0..m).filter(|&i| row_free[i] && allowed(i, j)) {
                    if a[(i, j)].abs() > best.2 {
                        best = (i, j, a[(i, j)].abs());
                    }
                }
            }
            let (p, c, size) = best;
            if pivots.is_empty() {
                scale = size;
            }
            if size.is_nan() || size <= RANK_TOLERANCE * scale {
                break if scale > 0.0 { size / scale } else { 0.0 };
            }
            weakest = size / scale;
            pivots.push((p, c));
            (row_free[p], column_free[c]) = (false, false);
            let pivot = a[(p, c)];
            a.row_mut(p).unscale_mut(pivot);
            for i in (0..m).filter(|&i| i != p) {
                let factor = a[(i, c)];
                if factor != 0.0 {
                    for j in 0..n {
                        let change = factor * a[(p, j)];
                        a[(i, j)] -= change;
                    }
                    a[(i, c)] = 0.0;
                }
            }
        };
        Self {
            pivots,
            reduced: a,
            weakest,
            rest,
            scale,
        }
    }

    /// Number of pivots.
    pub fn rank(&self) -> usize {
        self.pivots.len()
    }

    /// Of the first `n` columns those without a pivot, ascending.
    pub fn free(&self, n: usize) -> Vec<usize> {
        let pivot = |j: &usize| self.pivots.iter().any(|(_, c)| c == j);
        (0..n).filter(|j| !pivot(j)).collect()
    }

    /// Vectors `x` with `A x = 0` on the pivots' rows, one for each free column, which is 1 there (n x free).
    pub fn kernel(&self, n: usize, free: &[usize]) -> DMatrix<f64> {
        let mut kernel = DMatrix::zeros(n, free.len());
        for (k, &j) in free.iter().enumerate() {
            kernel[(j, k)] = 1.0;
            for &(p, c) in &self.pivots {
                kernel[(c, k)] = -self.reduced[(p, j)];
            }
        }
        kernel
    }
}

//! Multipliers of the closures.
//!
//! With `M = L^T D L` and `W = L^-T G^T` the multipliers solve `S lambda = -(gamma + W^T D^-1 b)`, `S = W^T D^-1 W`, where
//! `b` are the generalised forces taken inward. Redundant equations make `S` singular; then the multipliers of smallest norm
//! are taken, and the accelerations are the same whichever equation one would drop.

use crate::linear::{cholesky, cholesky_solve};

/// A pivot of `S` below this share of its diagonal counts as zero: the equation is redundant. `S` holds squares, so this
/// is a share of 1e-6 in the closure gradient.
const REDUNDANT: f64 = 1e-12;

/// Factors of `S`, and the multipliers.
#[derive(Clone, Debug)]
pub(crate) struct Multipliers {
    m: usize,
    /// `S`, row-major lower triangle; then its factors `L D L^T`.
    schur: Vec<f64>,
    inverse: Vec<f64>,
    pub gamma: Vec<f64>,
    pub lambda: Vec<f64>,
    rank: usize,
    /// For a singular `S = F F^T`: F (m x rank, row-major with stride m), and the Cholesky factor of `F^T F`.
    factor: Vec<f64>,
    gram: Vec<f64>,
    order: Vec<usize>,
    scratch: Vec<f64>,
}

impl Multipliers {
    pub fn new(m: usize) -> Self {
        Self {
            m,
            schur: vec![0.0; m * m],
            inverse: vec![0.0; m],
            gamma: vec![0.0; m],
            lambda: vec![0.0; m],
            rank: m,
            factor: vec![0.0; m * m],
            gram: vec![0.0; m * m],
            order: vec![0; m],
            scratch: vec![0.0; m],
        }
    }

    pub fn multipliers(&self) -> &[f64] {
        &self.lambda
    }

    pub fn redundant(&self) -> usize {
        self.m - self.rank
    }

    /// Sets up and factors `S` from the closure columns 1..=m.
    #[inline]
    pub fn factor(&mut self, columns: &[f64], stride: usize, inverse_diagonal: &[f64]) {
        self.assemble(columns, stride, inverse_diagonal);
        let m = self.m;
        self.rank = m;
        for j in 0..m {
            let diagonal = self.schur[j * m + j];
            let mut pivot = diagonal;
            for k in 0..j {
                // Row j still holds L_jk D_k.
                let scaled = self.schur[j * m + k];
                let l = scaled * self.inverse[k];
                pivot -= l * scaled;
                self.schur[j * m + k] = l;
            }
            if pivot.is_nan() || pivot <= REDUNDANT * diagonal {
                return self.factor_singular(columns, stride, inverse_diagonal);
            }
            self.inverse[j] = 1.0 / pivot;
            let (head, tail) = self.schur.split_at_mut((j + 1) * m);
            let row_j = &head[j * m..j * m + j];
            for row in tail.chunks_exact_mut(m) {
                let sum: f64 = row[..j].iter().zip(row_j).map(|(x, l)| x * l).sum();
                row[j] -= sum;
            }
        }
    }

    #[inline]
    fn assemble(&mut self, columns: &[f64], stride: usize, inverse_diagonal: &[f64]) {
        let m = self.m;
        self.schur.fill(0.0);
        for (row, inverse) in columns.chunks_exact(stride).zip(inverse_diagonal) {
            let w = &row[1..=m];
            for (i, target) in self.schur.chunks_exact_mut(m).enumerate() {
                let scaled = w[i] * inverse;
                for (x, y) in target[..=i].iter_mut().zip(w) {
                    *x += scaled * y;
                }
            }
        }
    }

    /// Cholesky with pivoting up to the rank: `S = F F^T`.
    #[cold]
    fn factor_singular(&mut self, columns: &[f64], stride: usize, inverse_diagonal: &[f64]) {
        self.assemble(columns, stride, inverse_diagonal);
        let m = self.m;
        let largest = (0..m).map(|i| self.schur[i * m + i]).fold(0.0, f64::max);
        self.order.iter_mut().enumerate().for_each(|(i, o)| *o = i);
        self.factor.fill(0.0);
        self.rank = 0;
        while self.rank < m {
            let r = self.rank;
            let rest =
                |s: &Self, i: usize| s.schur[i * m + i] - s.factor[i * m..i * m + r].iter().map(|x| x * x).sum::<f64>();
            let (place, pivot) = (r..m)
                .map(|p| (p, rest(self, self.order[p])))
                .fold((r, f64::MIN), |a, b| if b.1 > a.1 { b } else { a });
            if pivot <= REDUNDANT * largest {
                break;
            }
            self.order.swap(r, place);
            let p = self.order[r];
            let root = pivot.sqrt();
            for k in r..m {
                let i = self.order[k];
                let entry = self.schur[i.max(p) * m + i.min(p)];
                let sum: f64 = (0..r).map(|c| self.factor[i * m + c] * self.factor[p * m + c]).sum();
                self.factor[i * m + r] = (entry - sum) / root;
            }
            self.rank += 1;
        }
        let r = self.rank;
        for a in 0..r {
            for b in 0..=a {
                self.gram[a * r + b] = (0..m).map(|i| self.factor[i * m + a] * self.factor[i * m + b]).sum();
            }
        }
        cholesky(&mut self.gram, r);
    }

    /// Solves `S x = b` in place; the shortest least-squares solution when `S` is singular.
    #[inline]
    pub fn solve(&mut self, b: &mut [f64]) {
        let m = self.m;
        if self.rank < m {
            return self.solve_singular(b);
        }
        for i in 0..m {
            let (done, rest) = b.split_at_mut(i);
            let sum: f64 = self.schur[i * m..i * m + i]
                .iter()
                .zip(&*done)
                .map(|(l, x)| l * x)
                .sum();
            rest[0] -= sum;
        }
        for i in (0..m).rev() {
            let below = b[i + 1..].iter().enumerate();
            let sum: f64 = below.map(|(k, x)| self.schur[(i + 1 + k) * m + i] * x).sum();
            b[i] = b[i] * self.inverse[i] - sum;
        }
    }

    #[cold]
    fn solve_singular(&mut self, b: &mut [f64]) {
        let (m, r) = (self.m, self.rank);
        for a in 0..r {
            self.scratch[a] = (0..m).map(|i| self.factor[i * m + a] * b[i]).sum();
        }
        cholesky_solve(&self.gram, r, &mut self.scratch);
        cholesky_solve(&self.gram, r, &mut self.scratch);
        for (x, row) in b.iter_mut().zip(self.factor.chunks_exact(m)) {
            *x = row[..r].iter().zip(&self.scratch).map(|(f, y)| f * y).sum();
        }
    }

    /// Replaces `lambda` by `S^-1 lambda`.
    pub fn solve_lambda(&mut self) {
        let mut lambda = std::mem::take(&mut self.lambda);
        self.solve(&mut lambda);
        self.lambda = lambda;
    }

    /// Multipliers for the generalised forces in column 0 and the closure bias; kept in `lambda`.
    #[inline]
    pub fn solve_forces(&mut self, columns: &[f64], stride: usize, inverse_diagonal: &[f64]) {
        let mut lambda = std::mem::take(&mut self.lambda);
        lambda.copy_from_slice(&self.gamma);
        self.solve_column(columns, stride, inverse_diagonal, 0, &mut lambda);
        self.lambda = lambda;
    }

    /// Multipliers for the generalised forces in a column, on top of the closure bias given in `lambda`.
    #[inline]
    pub fn solve_column(
        &mut self,
        columns: &[f64],
        stride: usize,
        inverse_diagonal: &[f64],
        column: usize,
        lambda: &mut [f64],
    ) {
        let m = self.m;
        for (row, inverse) in columns.chunks_exact(stride).zip(inverse_diagonal) {
            let b = row[column] * inverse;
            for (x, w) in lambda.iter_mut().zip(&row[1..=m]) {
                *x += w * b;
            }
        }
        lambda.iter_mut().for_each(|x| *x = -*x);
        self.solve(lambda);
    }
}

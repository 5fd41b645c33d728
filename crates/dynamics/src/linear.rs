//! Small dense linear algebra on slices, without allocation.

/// LU factors of a square matrix with row exchanges.
#[derive(Clone, Debug)]
pub(crate) struct Lu {
    n: usize,
    /// Row-major; the matrix on entry, its factors after [`Lu::factor`].
    pub matrix: Vec<f64>,
    rows: Vec<usize>,
    scratch: Vec<f64>,
}

impl Lu {
    pub fn new(n: usize) -> Self {
        Self {
            n,
            matrix: vec![0.0; n * n],
            rows: vec![0; n],
            scratch: vec![0.0; n],
        }
    }

    /// Factors the matrix in place; returns its determinant (0 when it is singular, and then nothing can be solved).
    pub fn factor(&mut self) -> f64 {
        let n = self.n;
        let mut determinant = 1.0;
        for (i, row) in self.rows.iter_mut().enumerate() {
            *row = i;
        }
        for k in 0..n {
            let largest = (k..n).fold(k, |best, i| {
                let larger = self.matrix[i * n + k].abs() > self.matrix[best * n + k].abs();
                if larger { i } else { best }
            });
            if largest != k {
                let (head, tail) = self.matrix.split_at_mut(largest * n);
                head[k * n..k * n + n].swap_with_slice(&mut tail[..n]);
                self.rows.swap(k, largest);
                determinant = -determinant;
            }
            let pivot = self.matrix[k * n + k];
            determinant *= pivot;
            if pivot == 0.0 || !pivot.is_finite() {
                return if pivot == 0.0 { 0.0 } else { f64::NAN };
            }
            let inverse = 1.0 / pivot;
            let (head, tail) = self.matrix.split_at_mut((k + 1) * n);
            let source = &head[k * n..];
            for row in tail.chunks_exact_mut(n) {
                let factor = row[k] * inverse;
                row[k] = factor;
                for (x, y) in row[k + 1..].iter_mut().zip(&source[k + 1..n]) {
                    *x -= factor * y;
                }
            }
        }
        determinant
    }

    /// Solves for one right-hand side, in place.
    pub fn solve(&mut self, b: &mut [f64]) {
        let n = self.n;
        for (x, &row) in self.scratch.iter_mut().zip(&self.rows) {
            *x = b[row];
        }
        for i in 0..n {
            let row = &self.matrix[i * n..i * n + n];
            let (done, rest) = self.scratch.split_at_mut(i);
            rest[0] -= done.iter().zip(row).map(|(x, l)| x * l).sum::<f64>();
        }
        for i in (0..n).rev() {
            let row = &self.matrix[i * n..i * n + n];
            let (head, done) = self.scratch.split_at_mut(i + 1);
            let sum: f64 = done.iter().zip(&row[i + 1..]).map(|(x, u)| x * u).sum();
            head[i] = (head[i] - sum) / row[i];
        }
        b.copy_from_slice(&self.scratch);
    }
}

/// Solves `L L^T x = b` in place, `L` the row-major lower factor left by [`cholesky`].
pub(crate) fn cholesky_solve(l: &[f64], n: usize, b: &mut [f64]) {
    for i in 0..n {
        let sum: f64 = (0..i).map(|k| l[i * n + k] * b[k]).sum();
        b[i] = (b[i] - sum) / l[i * n + i];
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| l[k * n + i] * b[k]).sum();
        b[i] = (b[i] - sum) / l[i * n + i];
    }
}

/// Cholesky factor of a positive definite matrix, in its row-major lower triangle.
pub(crate) fn cholesky(a: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| a[i * n + k] * a[j * n + k]).sum();
            let rest = a[i * n + j] - sum;
            a[i * n + j] = if i == j { rest.sqrt() } else { rest / a[j * n + j] };
        }
    }
}

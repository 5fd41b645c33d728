//! Least squares with matrices of any rank, by one-sided Jacobi turns \[Hestenes 1958\]: slow and exact.
//!
//! (The bidiagonal singular value decomposition of nalgebra 0.35 loses digits without notice on matrices with zero columns.)

use nalgebra::{DMatrix, DVector};

/// Singular values below this share of the largest count as zero.
const RANK_TOLERANCE: f64 = 1e-9;
/// Cosine of the angle at which two columns count as orthogonal.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Rounds of turns; some ten are needed.
const ROUNDS: usize = 60;

/// Singular values and vectors of a matrix.
#[derive(Clone, Debug)]
pub struct SingularValues {
    /// `u_k s_k` of the matrix, or of its transpose where that is the taller one.
    scaled: DMatrix<f64>,
    /// `v_k`.
    vectors: DMatrix<f64>,
    transposed: bool,
    values: Vec<f64>,
}

impl SingularValues {
    /// Decomposes `matrix`; one that is not finite counts as zero.
    pub fn new(matrix: &DMatrix<f64>) -> Self {
        let transposed = matrix.ncols() > matrix.nrows();
        let mut scaled = if transposed { matrix.transpose() } else { matrix.clone() };
        if !scaled.iter().all(|x| x.is_finite()) {
            scaled.fill(0.0);
        }
        let n = scaled.ncols();
        let mut vectors = DMatrix::identity(n, n);
        // Smaller products of columns are rounding of the whole matrix.
        let rounding = (f64::EPSILON * scaled.norm()).powi(2);
        for _ in 0..ROUNDS {
            let mut turned = false;
            for p in 0..n {
                for q in p + 1..n {
                    turned |= make_orthogonal(&mut scaled, &mut vectors, p, q, rounding);
                }
            }
            if !turned {
                break;
            }
        }
        let values = scaled.column_iter().map(|column| column.norm()).collect();
        Self {
            scaled,
            vectors,
            transposed,
            values,
        }
    }

    /// Number of singular values that are not zero by the tolerance; 0 for matrices that are not finite.
    pub fn rank(&self) -> usize {
        self.nonzero().count()
    }

    /// Smallest singular value over the largest, and the unit vector `x` for which `|A x|` is so small; `None` where `A` has more
    /// columns than rows, or none.
    pub fn weakest(&self) -> Option<(f64, DVector<f64>)> {
        if self.transposed {
            return None;
        }
        let largest = self.values.iter().fold(0.0, |s, &x| f64::max(s, x));
        let k = (0..self.values.len()).min_by(|&i, &j| self.values[i].total_cmp(&self.values[j]))?;
        let share = if largest > 0.0 { self.values[k] / largest } else { 0.0 };
        Some((share, self.vectors.column(k).into_owned()))
    }

    /// Shortest least-squares solution of `A x = b`.
    pub fn solve(&self, b: &DVector<f64>) -> DVector<f64> {
        let (left, right) = if self.transposed {
            (&self.vectors, &self.scaled)
        } else {
            (&self.scaled, &self.vectors)
        };
        let mut x = DVector::zeros(right.nrows());
        for k in self.nonzero() {
            let share = left.column(k).dot(b) / (self.values[k] * self.values[k]);
            x.axpy(share, &right.column(k), 1.0);
        }
        x
    }

    fn nonzero(&self) -> impl Iterator<Item = usize> + '_ {
        let largest = self.values.iter().fold(0.0, |s, &x| f64::max(s, x));
        (0..self.values.len()).filter(move |&k| self.values[k] > RANK_TOLERANCE * largest)
    }
}

/// Turns columns `p` and `q` in their plane until they are orthogonal; tells whether they were not.
fn make_orthogonal(a: &mut DMatrix<f64>, v: &mut DMatrix<f64>, p: usize, q: usize, rounding: f64) -> bool {
    let (alpha, beta) = (a.column(p).norm_squared(), a.column(q).norm_squared());
    let gamma = a.column(p).dot(&a.column(q));
    if gamma.abs() <= (ROUNDING * (alpha * beta).sqrt()).max(rounding) {
        return false;
    }
    let zeta = (beta - alpha) / (2.0 * gamma);
    let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = cosine * tangent;
    for m in [a, v] {
        for i in 0..m.nrows() {
            let (x, y) = (m[(i, p)], m[(i, q)]);
            m[(i, p)] = cosine * x - sine * y;
            m[(i, q)] = sine * x + cosine * y;
        }
    }
    true
}

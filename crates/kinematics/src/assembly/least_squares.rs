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
        for together in neighbours(&scaled) {
            for _ in 0..ROUNDS {
                let mut turned = false;
                for (k, &p) in together.columns.iter().enumerate() {
                    for &q in &together.columns[k + 1..] {
                        let (a, v) = (&mut scaled, &mut vectors);
                        turned |= make_orthogonal((a, &together.rows), (v, &together.columns), p, q, rounding);
                    }
                }
                if !turned {
                    break;
                }
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

/// Columns with entries in some rows, in which no other column has any.
#[derive(Clone, Debug, Default)]
struct Neighbours {
    rows: Vec<usize>,
    columns: Vec<usize>,
}

/// Splits a matrix into what has no row and no column in common: closures of loops without a joint in common need not be looked at
/// together, and the work grows with the cube of the size.
fn neighbours(a: &DMatrix<f64>) -> Vec<Neighbours> {
    // Row by row, the groups of all columns with an entry there become that of the first.
    let mut group: Vec<usize> = (0..a.ncols()).collect();
    let mut members: Vec<Vec<usize>> = group.iter().map(|&k| vec![k]).collect();
    let mut home = vec![None; a.nrows()];
    for (column, entries) in a.column_iter().enumerate() {
        for row in (0..a.nrows()).filter(|&row| entries[row] != 0.0) {
            let Some(one) = home[row] else {
                home[row] = Some(column);
                continue;
            };
            let (mut to, mut from) = (group[one], group[column]);
            if to != from {
                if members[to].len() < members[from].len() {
                    (to, from) = (from, to);
                }
                let moved = std::mem::take(&mut members[from]);
                moved.iter().for_each(|&k| group[k] = to);
                members[to].extend(moved);
            }
        }
    }
    let mut found: Vec<Neighbours> = vec![Neighbours::default(); a.ncols()];
    (0..a.ncols()).for_each(|column| found[group[column]].columns.push(column));
    let rows = home.iter().enumerate();
    rows.for_each(|(row, column)| {
        if let Some(column) = *column {
            found[group[column]].rows.push(row);
        }
    });
    found.retain(|neighbours| neighbours.columns.len() > 1);
    found
}

/// Turns columns `p` and `q` of `a` in their plane until they are orthogonal, and those of `v` with them; tells whether they were not.
/// Each matrix comes with the rows in which there is anything.
fn make_orthogonal(
    (a, rows): (&mut DMatrix<f64>, &[usize]),
    (v, others): (&mut DMatrix<f64>, &[usize]),
    p: usize,
    q: usize,
    rounding: f64,
) -> bool {
    let product = |p: usize, q: usize| rows.iter().map(|&i| a[(i, p)] * a[(i, q)]).sum::<f64>();
    let (alpha, beta, gamma) = (product(p, p), product(q, q), product(p, q));
    if gamma.abs() <= (ROUNDING * (alpha * beta).sqrt()).max(rounding) {
        return false;
    }
    let zeta = (beta - alpha) / (2.0 * gamma);
    let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = cosine * tangent;
    for (m, rows) in [(a, rows), (v, others)] {
        for &i in rows {
            let (x, y) = (m[(i, p)], m[(i, q)]);
            m[(i, p)] = cosine * x - sine * y;
            m[(i, q)] = sine * x + cosine * y;
        }
    }
    true
}

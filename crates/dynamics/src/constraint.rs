//! Multipliers of the closures.
//!
//! With `M = L^T D L` and `W = L^-T G^T` the multipliers solve `S lambda = -(gamma + W^T D^-1 b)`, `S = W^T D^-1 W`, where
//! `b` are the generalised forces taken inward. Redundant equations make `S` singular; then the multipliers of smallest norm
//! are taken, and the accelerations are the same whichever equation one would drop.
//!
//! Loops run over the number of equations `m`, which the small cases hand down as a constant: the compiler then unrolls
//! what is one plain text.

use crate::columns::Columns;
use crate::linear::{cholesky, cholesky_solve};

/// A pivot of `S` below this share of the largest diagonal counts as zero: the equation is redundant. `S` holds squares, so
/// this is a share of 1e-6 in the closure gradient.
const REDUNDANT: f64 = 1e-12;
/// Without pivoting, rounding of 1e-16 grows by the pivots before: two of this share of their diagonals leave 1e-6. A smaller
/// pivot is looked at again with pivoting, which keeps rounding near 1e-16.
const DOUBTFUL: f64 = 1e-5;
/// A diagonal of `S` below this share of `trace(D^-1)` stands for levers of 1e-12 m: rounding of an equation that nothing moves.
const NOTHING: f64 = 1e-24;

/// Calls `$f($m, ..)` with `$m` a constant where it is small.
macro_rules! sized {
    ($m:expr, $f:expr) => {
        match $m {
            1 => $f(1),
            2 => $f(2),
            3 => $f(3),
            4 => $f(4),
            5 => $f(5),
            6 => $f(6),
            m => $f(m),
        }
    };
}

/// Factors of `S`, and the multipliers.
#[derive(Clone, Debug)]
pub(crate) struct Multipliers {
    m: usize,
    /// Factors `L D L^T` of `S`, row-major lower triangle.
    schur: Vec<f64>,
    inverse: Vec<f64>,
    pub gamma: Vec<f64>,
    pub lambda: Vec<f64>,
    rank: usize,
    /// Whether the factors are those with pivoting.
    pivoted: bool,
    singular: Singular,
}

/// `S = F F^T` with F of as many columns as `S` has rank.
#[derive(Clone, Debug)]
struct Singular {
    /// F, m x rank, row-major with stride m.
    factor: Vec<f64>,
    /// Cholesky factor of `F^T F`, rank x rank.
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
            pivoted: false,
            singular: Singular {
                factor: vec![0.0; m * m],
                gram: vec![0.0; m * m],
                order: vec![0; m],
                scratch: vec![0.0; m],
            },
        }
    }

    pub fn multipliers(&self) -> &[f64] {
        &self.lambda
    }

    pub fn redundant(&self) -> usize {
        self.m - self.rank
    }

    /// Sets up and factors `S` from right-hand sides taken inward, of which columns 1..=m are `W`.
    #[inline]
    pub fn factor(&mut self, inward: &Columns, inverse_diagonal: &[f64]) {
        sized!(self.m, |m| self.factor_sized(m, inward, inverse_diagonal));
    }

    #[inline(always)]
    fn factor_sized(&mut self, m: usize, inward: &Columns, inverse_diagonal: &[f64]) {
        self.assemble(m, inward, inverse_diagonal);
        (self.rank, self.pivoted) = (m, false);
        let floor = NOTHING * inverse_diagonal.iter().sum::<f64>();
        for j in 0..m {
            let (head, tail) = self.schur.split_at_mut(j * m);
            let row = &mut tail[..=j];
            // Row j holds L_jk D_k until its pivot is known.
            for k in 0..j {
                for i in 0..k {
                    row[k] -= head[k * m + i] * row[i];
                }
            }
            let diagonal = row[j];
            let mut pivot = diagonal;
            for k in 0..j {
                let l = row[k] * self.inverse[k];
                pivot -= l * row[k];
                row[k] = l;
            }
            if pivot.is_nan() || pivot <= DOUBTFUL * diagonal || diagonal <= floor {
                return self.factor_singular(inward, inverse_diagonal);
            }
            self.inverse[j] = 1.0 / pivot;
        }
    }

    /// Lower triangle of `S`.
    #[inline(always)]
    fn assemble(&mut self, m: usize, inward: &Columns, inverse_diagonal: &[f64]) {
        self.schur.fill(0.0);
        for (row, inverse) in inward.rows().zip(inverse_diagonal) {
            let w = &row[1..=m];
            for i in 0..m {
                let scaled = w[i] * inverse;
                for j in 0..=i {
                    self.schur[i * m + j] += scaled * w[j];
                }
            }
        }
    }

    /// Cholesky with pivoting up to the rank.
    #[cold]
    fn factor_singular(&mut self, inward: &Columns, inverse_diagonal: &[f64]) {
        let m = self.m;
        self.assemble(m, inward, inverse_diagonal);
        let s = &mut self.singular;
        let entry = |i: usize, j: usize| self.schur[i.max(j) * m + i.min(j)];
        let floor = NOTHING * inverse_diagonal.iter().sum::<f64>();
        let largest = (0..m).map(|i| entry(i, i)).fold(0.0, f64::max);
        s.order.iter_mut().enumerate().for_each(|(i, o)| *o = i);
        s.factor.fill(0.0);
        let mut r = 0;
        while r < m {
            let rest = |i: usize| entry(i, i) - s.factor[i * m..i * m + r].iter().map(|x| x * x).sum::<f64>();
            let candidates = (r..m).map(|place| (place, rest(s.order[place])));
            let (place, pivot) = candidates.fold((r, f64::MIN), |a, b| if b.1 > a.1 { b } else { a });
            if pivot <= (REDUNDANT * largest).max(floor) {
                break;
            }
            s.order.swap(r, place);
            let p = s.order[r];
            let root = pivot.sqrt();
            for &i in &s.order[r..] {
                let done: f64 = (0..r).map(|c| s.factor[i * m + c] * s.factor[p * m + c]).sum();
                s.factor[i * m + r] = (entry(i, p) - done) / root;
            }
            r += 1;
        }
        for a in 0..r {
            for b in 0..=a {
                s.gram[a * r + b] = (0..m).map(|i| s.factor[i * m + a] * s.factor[i * m + b]).sum();
            }
        }
        cholesky(&mut s.gram, r);
        (self.rank, self.pivoted) = (r, true);
    }

    /// Replaces `lambda` by `S^-1 lambda`; the shortest least-squares solution when `S` is singular.
    #[inline]
    pub fn solve(&mut self) {
        sized!(self.m, |m| self.solve_sized(m));
    }

    #[inline(always)]
    fn solve_sized(&mut self, m: usize) {
        if self.pivoted {
            return self.solve_singular();
        }
        let (l, b) = (&self.schur[..m * m], &mut self.lambda[..m]);
        for i in 0..m {
            for k in 0..i {
                b[i] -= l[i * m + k] * b[k];
            }
        }
        for i in (0..m).rev() {
            b[i] *= self.inverse[i];
            for k in i + 1..m {
                b[i] -= l[k * m + i] * b[k];
            }
        }
    }

    #[cold]
    fn solve_singular(&mut self) {
        let (m, r) = (self.m, self.rank);
        let (s, b) = (&mut self.singular, &mut self.lambda);
        for a in 0..r {
            s.scratch[a] = (0..m).map(|i| s.factor[i * m + a] * b[i]).sum();
        }
        cholesky_solve(&s.gram, r, &mut s.scratch);
        cholesky_solve(&s.gram, r, &mut s.scratch);
        for (x, row) in b.iter_mut().zip(s.factor.chunks_exact(m)) {
            *x = row[..r].iter().zip(&s.scratch).map(|(f, y)| f * y).sum();
        }
    }

    /// Multipliers and pivot-divided rates for one right-hand side: `lambda = -S^-1 (bias + W^T D^-1 b)` and
    /// `D^-1 (b + W lambda)`, the latter into the same column of `solutions`. The closure bias counts `with_bias`.
    #[inline]
    pub fn solve_column(
        &mut self,
        column: usize,
        with_bias: bool,
        inward: &Columns,
        inverse_diagonal: &[f64],
        solutions: &mut Columns,
    ) {
        sized!(self.m, |m| self.solve_column_sized(
            m,
            column,
            with_bias,
            inward,
            inverse_diagonal,
            solutions
        ));
    }

    #[inline(always)]
    fn solve_column_sized(
        &mut self,
        m: usize,
        column: usize,
        with_bias: bool,
        inward: &Columns,
        inverse_diagonal: &[f64],
        solutions: &mut Columns,
    ) {
        if with_bias {
            self.lambda.copy_from_slice(&self.gamma);
        } else {
            self.lambda.fill(0.0);
        }
        for (row, inverse) in inward.rows().zip(inverse_diagonal) {
            let b = row[column] * inverse;
            let w = &row[1..=m];
            for k in 0..m {
                self.lambda[k] += w[k] * b;
            }
        }
        self.lambda.iter_mut().for_each(|x| *x = -*x);
        self.solve_sized(m);
        let stride = solutions.stride();
        let targets = solutions.flat_mut().chunks_exact_mut(stride);
        for ((target, row), inverse) in targets.zip(inward.rows()).zip(inverse_diagonal) {
            let mut sum = row[column];
            let w = &row[1..=m];
            for k in 0..m {
                sum += w[k] * self.lambda[k];
            }
            target[column] = sum * inverse;
        }
    }
}

//! Multipliers of the closures.
//!
//! With `M = L^T D L` and `W = L^-T G^T` the multipliers solve `S lambda = -(gamma + W^T D^-1 b)`, `S = W^T D^-1 W`, where
//! `b` are the generalised forces taken inward. Redundant equations make `S` singular; then the multipliers of smallest norm
//! are taken, and the accelerations are the same whichever equation one would drop.

use crate::columns::{Columns, sized, subtract};
use crate::lanes::{Four, at};
use crate::linear::{cholesky, cholesky_solve};

/// A pivot of `S` below this share of the largest diagonal counts as zero: the equation is redundant. `S` holds squares, so
/// this is a share of 1e-6 in the closure gradient.
pub(crate) const REDUNDANT: f64 = 1e-12;
/// Without pivoting, rounding of 1e-16 grows by the pivots before: two of this share of their diagonals leave 1e-6. A smaller
/// pivot is looked at again with pivoting, which keeps rounding near 1e-16.
const DOUBTFUL: f64 = 1e-5;
/// A diagonal of `S` below this share of `trace(D^-1)` stands for levers of 1e-12 m: rounding of an equation that nothing moves.
pub(crate) const NOTHING: f64 = 1e-24;

/// Factors of `S`, and the multipliers.
#[derive(Clone, Debug)]
pub(crate) struct Multipliers {
    m: usize,
    /// `W^T D^-1` times the columns taken inward, a row each equation: `S` in columns 1..=m, beside it what it has to be
    /// solved for. Gauss elimination turns all of it at once into upper triangle and reduced right-hand sides.
    tableau: Columns,
    /// Diagonal of `S`.
    diagonal: Vec<f64>,
    /// Inverse pivots.
    inverse: Vec<f64>,
    /// Multipliers for each column (those of columns 1..=m mean nothing).
    all: Columns,
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
    /// For `m` equations and so many columns in all.
    pub fn new(m: usize, columns: usize) -> Self {
        Self {
            tableau: Columns::new(m, columns),
            diagonal: vec![0.0; m],
            inverse: vec![0.0; m],
            singular: Singular {
                factor: vec![0.0; m * m],
                gram: vec![0.0; m * m],
                order: vec![0; m],
                scratch: vec![0.0; m],
            },
            ..Self::found_elsewhere(m, columns)
        }
    }

    /// As [`Multipliers::new`], for multipliers that are found in another way: nothing to factor with.
    pub fn found_elsewhere(m: usize, columns: usize) -> Self {
        Self {
            m,
            tableau: Columns::new(0, columns),
            diagonal: Vec::new(),
            all: Columns::new(m, columns),
            inverse: Vec::new(),
            gamma: vec![0.0; m],
            lambda: vec![0.0; m],
            rank: m,
            pivoted: false,
            singular: Singular {
                factor: Vec::new(),
                gram: Vec::new(),
                order: Vec::new(),
                scratch: Vec::new(),
            },
        }
    }

    /// Takes over the multipliers for one column, of equations of which `rank` are independent.
    pub fn take(&mut self, multipliers: &[f64], column: usize, rank: usize) {
        for (k, lambda) in multipliers.iter().enumerate() {
            *self.all.at_mut(k, column) = *lambda;
        }
        if column == 0 {
            self.lambda.copy_from_slice(multipliers);
        }
        self.rank = rank;
    }

    pub fn multipliers(&self) -> &[f64] {
        &self.lambda
    }

    pub fn redundant(&self) -> usize {
        self.m - self.rank
    }

    /// Multipliers for all columns, a row each equation; see [`Multipliers::solve_all`].
    pub fn all(&self) -> &Columns {
        &self.all
    }

    /// Adds the multipliers for forces in the columns from `first` on, which is a multiple of four.
    #[inline]
    pub fn add_loads(&mut self, first: usize, forces: &[f64]) {
        let rows = self.all.fours().chunks_exact(self.all.width());
        for (lambda, row) in self.lambda.iter_mut().zip(rows) {
            for (four, forces) in row[first / 4..].iter().zip(forces.chunks(4)) {
                *lambda += four.0.iter().zip(forces).map(|(unit, force)| unit * force).sum::<f64>();
            }
        }
    }

    /// Sets up and factors `S` from columns taken inward, of which 1..=m are `W`. The closure bias counts in column 0.
    #[inline]
    pub fn factor(&mut self, inward: &Columns, inverse_diagonal: &[f64]) {
        sized!(self.m, [1, 2, 3, 4, 5, 6], |m| {
            sized!(inward.width(), [1, 2], |width| self.factor_sized(
                m,
                width,
                inward,
                inverse_diagonal
            ))
        });
    }

    #[inline(always)]
    fn factor_sized(&mut self, m: usize, width: usize, inward: &Columns, inverse_diagonal: &[f64]) {
        self.assemble(m, width, inward, inverse_diagonal);
        (self.rank, self.pivoted) = (m, false);
        let floor = NOTHING * inverse_diagonal.iter().sum::<f64>();
        let tableau = &mut self.tableau.fours_mut()[..m * width];
        let (inverse, diagonal) = (&mut self.inverse[..m], &self.diagonal[..m]);
        for i in 0..m {
            let pivot = at(&tableau[i * width..], 1 + i);
            if pivot.is_nan() || pivot <= DOUBTFUL * diagonal[i] || diagonal[i] <= floor {
                return self.factor_singular(inward, inverse_diagonal);
            }
            inverse[i] = 1.0 / pivot;
            for k in i + 1..m {
                let factor = at(&tableau[i * width..], 1 + k) * inverse[i];
                subtract(tableau, width, k, factor, i);
            }
        }
    }

    /// The tableau before elimination.
    #[inline(always)]
    fn assemble(&mut self, m: usize, width: usize, inward: &Columns, inverse_diagonal: &[f64]) {
        let tableau = &mut self.tableau.fours_mut()[..m * width];
        let (diagonal, gamma) = (&mut self.diagonal[..m], &self.gamma[..m]);
        for k in 0..m {
            for c in 0..width {
                let mut sum = Four::ZERO;
                for (row, inverse) in inward.fours().chunks_exact(width).zip(inverse_diagonal) {
                    sum += row[c] * (at(row, 1 + k) * inverse);
                }
                tableau[k * width + c] = sum;
            }
            tableau[k * width].0[0] += gamma[k];
            diagonal[k] = at(&tableau[k * width..], 1 + k);
        }
    }

    /// Cholesky with pivoting up to the rank.
    #[cold]
    fn factor_singular(&mut self, inward: &Columns, inverse_diagonal: &[f64]) {
        let m = self.m;
        self.assemble(m, inward.width(), inward, inverse_diagonal);
        let s = &mut self.singular;
        let entry = |i: usize, j: usize| self.tableau.at(i.max(j), 1 + i.min(j));
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
    pub fn solve(&mut self) {
        let m = self.m;
        if self.pivoted {
            return self.solve_singular();
        }
        let (u, b) = (&self.tableau, &mut self.lambda);
        for i in 0..m {
            let share = b[i] * self.inverse[i];
            for k in i + 1..m {
                b[k] -= u.at(i, 1 + k) * share;
            }
        }
        for i in (0..m).rev() {
            for k in i + 1..m {
                b[i] -= u.at(i, 1 + k) * b[k];
            }
            b[i] *= self.inverse[i];
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

    /// Multipliers and pivot-divided rates for all columns: `lambda = -S^-1 (bias + W^T D^-1 b)` and `D^-1 (b + W lambda)`,
    /// the latter into `solutions`. What becomes of `W` itself means nothing.
    #[inline]
    pub fn solve_all(&mut self, inward: &Columns, inverse_diagonal: &[f64], solutions: &mut Columns) {
        sized!(self.m, [0, 1, 2, 3, 4, 5, 6], |m| {
            sized!(inward.width(), [1, 2], |width| self.solve_all_sized(
                m,
                width,
                inward,
                inverse_diagonal,
                solutions
            ))
        });
    }

    #[inline(always)]
    fn solve_all_sized(
        &mut self,
        m: usize,
        width: usize,
        inward: &Columns,
        inverse_diagonal: &[f64],
        solutions: &mut Columns,
    ) {
        if self.pivoted {
            self.solve_all_singular();
        } else {
            let (u, inverse) = (&self.tableau.fours()[..m * width], &self.inverse[..m]);
            let (all, lambda) = (&mut self.all.fours_mut()[..m * width], &mut self.lambda[..m]);
            for i in (0..m).rev() {
                for c in 0..width {
                    let mut sum = u[i * width + c];
                    for k in i + 1..m {
                        sum += all[k * width + c] * at(&u[i * width..], 1 + k);
                    }
                    all[i * width + c] = sum * -inverse[i];
                }
                lambda[i] = all[i * width].0[0];
            }
        }
        let all = &self.all.fours()[..m * width];
        let rows = inward.fours().chunks_exact(width).zip(inverse_diagonal);
        for (target, (row, inverse)) in solutions.fours_mut().chunks_exact_mut(width).zip(rows) {
            for c in 0..width {
                let mut sum = row[c];
                for k in 0..m {
                    sum += all[k * width + c] * at(row, 1 + k);
                }
                target[c] = sum * *inverse;
            }
        }
    }

    #[cold]
    fn solve_all_singular(&mut self) {
        for c in (0..4 * self.tableau.width()).rev() {
            for k in 0..self.m {
                self.lambda[k] = -self.tableau.at(k, c);
            }
            self.solve_singular();
            for k in 0..self.m {
                *self.all.at_mut(k, c) = self.lambda[k];
            }
        }
    }
}

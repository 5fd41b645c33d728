//! Small dense systems of equations, real and complex, in place.

use std::ops::{Mul, Sub};

use num_complex::Complex64;

/// The numbers a matrix may consist of.
pub(crate) trait Field: Copy + Sub<Output = Self> + Mul<Output = Self> {
    /// A measure of size for the choice of pivots.
    fn size(self) -> f64;
    /// 1 / self.
    fn inverse(self) -> Self;
}

impl Field for f64 {
    fn size(self) -> f64 {
        self.abs()
    }
    fn inverse(self) -> Self {
        1.0 / self
    }
}

impl Field for Complex64 {
    fn size(self) -> f64 {
        self.l1_norm()
    }
    fn inverse(self) -> Self {
        self.inv()
    }
}

/// The matrix has no inverse, or its numbers are not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Singular;

/// Gaussian elimination with exchange of rows: the square matrix `a`, row after row, becomes its factors L (unit diagonal,
/// not stored) and U (inverse of its diagonal stored); row k was exchanged for row `pivots[k]`.
pub(crate) fn factorise<T: Field>(a: &mut [T], pivots: &mut [usize]) -> Result<(), Singular> {
    let n = pivots.len();
    for k in 0..n {
        let (mut pivot, mut largest) = (k, a[k * n + k].size());
        for i in k + 1..n {
            let size = a[i * n + k].size();
            if size > largest {
                (pivot, largest) = (i, size);
            }
        }
        if !(largest > 0.0 && largest.is_finite()) {
            return Err(Singular);
        }
        pivots[k] = pivot;
        let (upper, lower) = a.split_at_mut((k + 1) * n);
        let row = &mut upper[k * n..];
        if pivot > k {
            row.swap_with_slice(&mut lower[(pivot - k - 1) * n..][..n]);
        }
        let inverse = row[k].inverse();
        row[k] = inverse;
        for below in lower.chunks_exact_mut(n) {
            let factor = below[k] * inverse;
            below[k] = factor;
            for (target, &source) in below[k + 1..].iter_mut().zip(&row[k + 1..]) {
                *target = *target - factor * source;
            }
        }
    }
    Ok(())
}

/// Solves with the factors made by [`factorise`]; `x` is the right-hand side and becomes the solution.
pub(crate) fn solve<T: Field>(a: &[T], pivots: &[usize], x: &mut [T]) {
    let n = pivots.len();
    for (k, &pivot) in pivots.iter().enumerate() {
        x.swap(k, pivot);
    }
    for (i, row) in a.chunks_exact(n.max(1)).enumerate() {
        let mut sum = x[i];
        for (&a, &x) in row[..i].iter().zip(&x[..i]) {
            sum = sum - a * x;
        }
        x[i] = sum;
    }
    for (i, row) in a.chunks_exact(n.max(1)).enumerate().rev() {
        let mut sum = x[i];
        for (&a, &x) in row[i + 1..].iter().zip(&x[i + 1..]) {
            sum = sum - a * x;
        }
        x[i] = sum * row[i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]
        #[test]
        fn what_is_solved_multiplies_back(
            n in 1_usize..9,
            entries in proptest::collection::vec(-1.0..1.0, 2 * 81),
            x in proptest::collection::vec(-1.0..1.0, 2 * 9),
        ) {
            // A diagonal that dominates, in rows put into another order, so that every system has a solution and needs pivots.
            let entry = |i: usize, j: usize| {
                let dominant = if (i + 1) % n == j { 3.0 * n as f64 } else { 0.0 };
                Complex64::new(entries[9 * i + j] + dominant, entries[81 + 9 * i + j])
            };
            let complex: Vec<_> = (0..n * n).map(|ij| entry(ij / n, ij % n)).collect();
            let solution: Vec<_> = (0..n).map(|i| Complex64::new(x[i], x[9 + i])).collect();
            let mut found: Vec<_> = (0..n).map(|i| (0..n).map(|j| complex[i * n + j] * solution[j]).sum()).collect();
            let (mut factors, mut pivots) = (complex.clone(), vec![0; n]);
            factorise(&mut factors, &mut pivots).unwrap();
            solve(&factors, &pivots, &mut found);
            for (found, expected) in found.iter().zip(&solution) {
                prop_assert!((found - expected).l1_norm() < 1e-13);
            }
            let mut found: Vec<f64> = (0..n).map(|i| (0..n).map(|j| complex[i * n + j].re * x[j]).sum()).collect();
            let mut factors: Vec<_> = complex.iter().map(|a| a.re).collect();
            factorise(&mut factors, &mut pivots).unwrap();
            solve(&factors, &pivots, &mut found);
            for (found, expected) in found.iter().zip(&x) {
                prop_assert!((found - expected).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn singular_matrices_are_refused() {
        for mut a in [
            [0.0; 4],
            [1.0, 2.0, 2.0, 4.0],
            [1.0, 0.0, f64::NAN, 1.0],
            [1.0, f64::INFINITY, 1.0, 1.0],
        ] {
            let mut pivots = [0; 2];
            assert_eq!(factorise(&mut a, &mut pivots), Err(Singular), "{a:?}");
        }
        assert_eq!(factorise::<f64>(&mut [], &mut []), Ok(()));
        solve::<f64>(&[], &[], &mut []);
    }
}

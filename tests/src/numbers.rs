//! Small numerical tools: scales, differences, derivatives by differences.

use linkdyn_dynamics::lagrange::LagrangeEquations;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Largest magnitude; NaN where there is one.
pub fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    let larger = |s: f64, x: &f64| if x.is_nan() { f64::NAN } else { s.max(x.abs()) };
    values.into_iter().fold(0.0, larger)
}

/// Largest difference of two lists, relative to the largest entry of either (or to 1e-300 when all are zero).
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let gaps: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&gaps) / largest(a).max(largest(b)).max(1e-300)
}

/// `f'(0)` by the five-point formula. With a spacing of 1e-3 its truncation is `f'''''/30 * 1e-12` and its rounding about
/// `1e-13 |f|`.
pub fn derivative(f: impl Fn(f64) -> DVector<f64>) -> DVector<f64> {
    let h = 1e-3;
    ((f(-2.0 * h) - f(2.0 * h)) + (f(h) - f(-h)) * 8.0) / (12.0 * h)
}

/// The singular values of `G M^-1/2`, which tell how many closure equations are independent and how well.
#[derive(Clone, Debug)]
pub struct Condition {
    /// Ratio of the largest to the smallest eigenvalue of the mass matrix.
    pub mass: f64,
    /// Number of independent equations.
    pub rank: usize,
    /// Ratio of the largest to the smallest singular value that counts.
    pub closure: f64,
}

/// Condition of the equations; `None` where it cannot be said how many closures are independent, because a singular value
/// lies between 1e-7 and 1e-4 of the largest.
pub fn condition(equations: &LagrangeEquations) -> Option<Condition> {
    let masses = equations.mass.symmetric_eigenvalues();
    let mass = masses.max() / masses.min();
    if masses.min() <= 0.0 {
        return None;
    }
    if equations.gradient.is_empty() {
        let (rank, closure) = (0, 1.0);
        return Some(Condition { mass, rank, closure });
    }
    let l = equations.mass.clone().cholesky()?.l();
    let w = l.solve_lower_triangular(&equations.gradient.transpose())?;
    // Eigenvalues of the square are good to 1e-8 in the singular values. Closures that move nothing have none but rounding.
    let values = (w.tr_mul(&w)).symmetric_eigenvalues().map(|x| x.max(0.0).sqrt());
    let most = values.max().max(1e-2);
    let sure = values.iter().filter(|&&s| s > 1e-4 * most);
    let (rank, least) = sure.fold((0, most), |(n, least), s| (n + 1, least.min(*s)));
    let doubtful = values.iter().any(|&s| s > 1e-7 * most && s <= 1e-4 * most);
    (!doubtful).then_some(Condition {
        mass,
        rank,
        closure: most / least,
    })
}

impl Condition {
    /// Condition of the whole elimination: that of the mass matrix times that of the multipliers' matrix.
    pub fn product(&self) -> f64 {
        self.mass * self.closure * self.closure
    }
}

/// Distance of two angles \[rad\], at most half a turn.
pub fn apart(a: f64, b: f64) -> f64 {
    let turn = (a - b).rem_euclid(2.0 * PI);
    turn.min(2.0 * PI - turn)
}

/// The matrix of the magnitudes.
pub fn magnitudes(m: &DMatrix<f64>) -> DMatrix<f64> {
    m.map(f64::abs)
}

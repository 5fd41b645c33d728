//! Eigenvalues, and the shapes that belong to them.

use super::error::AnalysisError;
use nalgebra::linalg::{Schur, balancing::balance_parlett_reinsch};
use nalgebra::{Complex, DMatrix, DVector, SymmetricEigen};
use std::f64::consts::PI;

/// Iterations of the eigenvalue solver.
const ITERATIONS: usize = 100_000;
/// Inverse iterations; the first already brings a vector to about the accuracy of its eigenvalue.
const INVERSE_ITERATIONS: usize = 3;
/// Relative shift off an eigenvalue, so that its matrix can be factored; also the distance at which two eigenvalues count as one.
const SHIFT: f64 = 1e-7;

/// An eigenvalue with the motion that belongs to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// The eigenvalue \[1/s\]: motion goes like the real part of `shape exp(eigenvalue t)`.
    pub eigenvalue: Complex<f64>,
    /// Displacement of each joint, one number a speed \[rad, m\]; the largest is 1.
    pub shape: Vec<Complex<f64>>,
}

impl Mode {
    /// Frequency without damping \[Hz\]: the size of the eigenvalue over 2 pi.
    pub fn frequency(&self) -> f64 {
        self.eigenvalue.norm() / (2.0 * PI)
    }

    /// Frequency at which it swings \[Hz\]; zero where it creeps or runs away.
    pub fn damped_frequency(&self) -> f64 {
        self.eigenvalue.im / (2.0 * PI)
    }

    /// Damping ratio \[-\]: minus the real part over the size, 1 for a motion that creeps back, -1 for one that runs away; none where the
    /// eigenvalue is zero.
    pub fn damping_ratio(&self) -> Option<f64> {
        let size = self.eigenvalue.norm();
        (size > 0.0).then(|| -self.eigenvalue.re / size)
    }
}

/// Eigenvalues of a real matrix, balanced first.
///
/// # Errors
/// [`AnalysisError::Eigenvalues`] where an entry is not finite or the solver does not converge.
pub fn eigenvalues(mut matrix: DMatrix<f64>) -> Result<Vec<Complex<f64>>, AnalysisError> {
    if matrix.iter().any(|x| !x.is_finite()) {
        return Err(AnalysisError::Eigenvalues("a derivative is not finite"));
    }
    balance_parlett_reinsch(&mut matrix);
    let schur = Schur::try_new(matrix, f64::EPSILON, ITERATIONS);
    let schur = schur.ok_or(AnalysisError::Eigenvalues("they do not converge"))?;
    Ok(schur.complex_eigenvalues().iter().copied().collect())
}

/// Modes of `M z'' + K z = 0` with symmetric matrices.
pub(super) fn undamped_modes(
    mass: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
    tangent: &DMatrix<f64>,
) -> Result<Vec<Mode>, AnalysisError> {
    let massless = || AnalysisError::Eigenvalues("a freedom moves no mass");
    let symmetric = |a: DMatrix<f64>| (&a + a.transpose()) * 0.5;
    let lower = symmetric(mass.clone()).cholesky().ok_or_else(massless)?.l();
    let inverse = lower.try_inverse().ok_or_else(massless)?;
    let eigen = SymmetricEigen::new(symmetric(&inverse * symmetric(stiffness.clone()) * inverse.transpose()));
    let shapes = tangent * inverse.transpose() * eigen.eigenvectors;
    let mut modes = Vec::new();
    for (k, square) in eigen.eigenvalues.iter().enumerate() {
        let shape = shapes.column(k).map(|x| Complex::new(x, 0.0));
        let root = square.abs().sqrt();
        let values = match *square > 0.0 {
            true => vec![Complex::new(0.0, root)],
            false => vec![Complex::new(root, 0.0), Complex::new(-root, 0.0)],
        };
        modes.extend(values.into_iter().map(|eigenvalue| mode(eigenvalue, &shape)));
    }
    Ok(sorted(modes))
}

/// Modes of `x' = A x`, `x = (z, z')`; vectors by inverse iteration.
pub(super) fn general_modes(a: &DMatrix<f64>, tangent: &DMatrix<f64>) -> Result<Vec<Mode>, AnalysisError> {
    let n = a.nrows() / 2;
    let complex = a.map(|x| Complex::new(x, 0.0));
    let tangent = tangent.map(|x| Complex::new(x, 0.0));
    let mut found: Vec<(Complex<f64>, DVector<Complex<f64>>)> = Vec::new();
    let all = eigenvalues(a.clone())?;
    let largest = all.iter().fold(f64::MIN_POSITIVE, |s, z| f64::max(s, z.norm()));
    for eigenvalue in all.into_iter().filter(|z| z.im >= 0.0) {
        let distance = SHIFT * eigenvalue.norm().max(SHIFT * largest);
        let shifted = &complex - DMatrix::identity(2 * n, 2 * n) * (eigenvalue + distance);
        let factors = shifted.lu();
        // Vectors of the same eigenvalue are kept out, so that a double one gets two.
        let same: Vec<DVector<Complex<f64>>> = found
            .iter()
            .filter(|(other, _)| (other - eigenvalue).norm() <= 10.0 * distance)
            .map(|(_, vector)| vector.clone())
            .collect();
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let mut vector = DVector::from_fn(2 * n, |i, _| Complex::new(0.5 + (golden * (i + 1) as f64).fract(), 0.0));
        for _ in 0..INVERSE_ITERATIONS {
            let solved = factors.solve(&vector);
            vector = solved.ok_or(AnalysisError::Eigenvalues("a shape does not converge"))?;
            for other in &same {
                let share = other.dotc(&vector);
                vector.axpy(-share, other, Complex::new(1.0, 0.0));
            }
            let length = vector.norm();
            if !(length.is_finite() && length > 0.0) {
                return Err(AnalysisError::Eigenvalues("a shape does not converge"));
            }
            vector.unscale_mut(length);
        }
        found.push((eigenvalue, vector));
    }
    let modes = found.into_iter().map(|(eigenvalue, vector)| {
        let shape = &tangent * vector.rows(0, n);
        mode(eigenvalue, &shape)
    });
    Ok(sorted(modes.collect()))
}

/// A mode whose largest displacement is 1.
fn mode(eigenvalue: Complex<f64>, shape: &DVector<Complex<f64>>) -> Mode {
    let largest = shape
        .iter()
        .fold(Complex::new(0.0, 0.0), |a, b| if b.norm() > a.norm() { *b } else { a });
    let scale = if largest.norm() > 0.0 {
        largest
    } else {
        Complex::new(1.0, 0.0)
    };
    Mode {
        eigenvalue,
        shape: shape.iter().map(|x| x / scale).collect(),
    }
}

fn sorted(mut modes: Vec<Mode>) -> Vec<Mode> {
    modes.sort_by(|a, b| a.eigenvalue.norm().total_cmp(&b.eigenvalue.norm()));
    modes
}

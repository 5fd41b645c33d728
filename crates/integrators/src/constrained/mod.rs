//! Problems of second order with constraints, and the forms in which methods can take them.

mod equations;

pub use equations::{Equations, Form, SingularConstraints};

use crate::EvalError;

/// A problem of second order with constraints:
///
/// q' = v, M(t, q) v' = f(t, q, v) − G(t, q)ᵀ λ, g(t, q) = 0, G = ∂g/∂q,
///
/// with as many rates v as positions q, M symmetric, and G of full rank; M need only be positive definite where G v = 0 for the
/// forms `Explicit` and for consistent starts, everywhere for the others. [`Equations`] makes an [`Ode`](crate::Ode) of it.
///
/// `&mut self` lets a problem own its scratch memory; nothing that it stores may influence a later evaluation.
pub trait Constrained {
    /// The number n of positions, which is that of the rates.
    fn positions(&self) -> usize;

    /// The number m of constraints, which is that of the multipliers.
    fn constraints(&self) -> usize;

    /// Writes all terms of the equations at (t, q, v); all hold zeros before.
    ///
    /// # Errors
    /// As for [`Ode::rhs`](crate::Ode::rhs).
    fn evaluate(&mut self, t: f64, q: &[f64], v: &[f64], terms: &mut Terms) -> Result<(), EvalError>;

    /// Adds the tangent matrices K = ∂(M a − f + Gᵀ λ)/∂q and C = −∂f/∂v to `stiffness` and `damping` (n x n, row after row, zeros
    /// before) and returns true; false if they are to be found by differences. By default they are.
    ///
    /// Steps of [`GeneralisedAlpha`](crate::GeneralisedAlpha) need more iterations where they are wrong, the result does not change.
    ///
    /// # Errors
    /// As for [`Ode::rhs`](crate::Ode::rhs).
    fn tangents(&mut self, _at: &Place<'_>, _stiffness: &mut [f64], _damping: &mut [f64]) -> Result<bool, EvalError> {
        Ok(false)
    }
}

/// The terms of a constrained problem at one time and state.
#[derive(Debug, Clone, PartialEq)]
pub struct Terms {
    /// M (n x n), row after row.
    pub matrix: Vec<f64>,
    /// f (n).
    pub force: Vec<f64>,
    /// g (m).
    pub constraint: Vec<f64>,
    /// G (m x n), row after row.
    pub gradient: Vec<f64>,
    /// ∂g/∂t (m), so that g' = G v + ∂g/∂t.
    pub time_rate: Vec<f64>,
    /// What remains of g'' where v' = 0 (m): g'' = G v' + bias.
    pub bias: Vec<f64>,
}

impl Terms {
    /// Zeros for n positions and m constraints.
    #[must_use]
    pub fn new(positions: usize, constraints: usize) -> Self {
        let (n, m) = (positions, constraints);
        Self {
            matrix: vec![0.0; n * n],
            force: vec![0.0; n],
            constraint: vec![0.0; m],
            gradient: vec![0.0; m * n],
            time_rate: vec![0.0; m],
            bias: vec![0.0; m],
        }
    }

    fn clear(&mut self) {
        let vectors = [
            &mut self.matrix,
            &mut self.force,
            &mut self.constraint,
            &mut self.gradient,
            &mut self.time_rate,
            &mut self.bias,
        ];
        vectors.into_iter().for_each(|vector| vector.fill(0.0));
    }

    /// Writes M a − f + Gᵀ λ.
    pub(crate) fn residual(&self, a: &[f64], lambda: &[f64], residual: &mut [f64]) {
        let n = residual.len();
        for (i, (r, f)) in residual.iter_mut().zip(&self.force).enumerate() {
            let row = &self.matrix[i * n..][..n];
            *r = row.iter().zip(a).map(|(m, a)| m * a).sum::<f64>() - f;
        }
        for (row, lambda) in self.gradient.chunks_exact(n.max(1)).zip(lambda) {
            residual.iter_mut().zip(row).for_each(|(r, g)| *r += g * lambda);
        }
    }
}

/// Where tangent matrices are asked for.
#[derive(Debug, Clone, Copy)]
pub struct Place<'a> {
    /// Time.
    pub t: f64,
    /// Positions.
    pub q: &'a [f64],
    /// Rates.
    pub v: &'a [f64],
    /// Rates of the rates.
    pub a: &'a [f64],
    /// Multipliers.
    pub lambda: &'a [f64],
}

impl<P: Constrained + ?Sized> Constrained for &mut P {
    fn positions(&self) -> usize {
        (**self).positions()
    }
    fn constraints(&self) -> usize {
        (**self).constraints()
    }
    fn evaluate(&mut self, t: f64, q: &[f64], v: &[f64], terms: &mut Terms) -> Result<(), EvalError> {
        (**self).evaluate(t, q, v, terms)
    }
    fn tangents(&mut self, at: &Place<'_>, stiffness: &mut [f64], damping: &mut [f64]) -> Result<bool, EvalError> {
        (**self).tangents(at, stiffness, damping)
    }
}

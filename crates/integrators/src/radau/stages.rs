//! The stages of a step and one Newton iteration on them.

use super::coefficients::Coefficients;
use super::indices::Indices;
use super::polynomial::Polynomial;
use super::systems::Systems;
use crate::reduced::Layout;
use crate::{Counted, EvalError, Ode, Step, Weights};

/// Changes from the start of a step to its stages, and what the iteration needs (Hairer, Wanner II, IV.8).
#[derive(Debug, Clone)]
pub(crate) struct Stages {
    pub coefficients: Coefficients,
    layout: Layout,
    /// zᵢ, the changes from the start of the step.
    pub z: [Vec<f64>; 3],
    /// fᵢ = f(t + cᵢ h, y + zᵢ).
    pub f: [Vec<f64>; 3],
    /// w = T⁻¹ z.
    w: [Vec<f64>; 3],
    /// Right-hand sides of an iteration, then changes of w, then changes of z.
    change: [Vec<f64>; 3],
    y: Vec<f64>,
}

impl Stages {
    pub(crate) fn new(layout: Layout) -> Self {
        let vectors = || std::array::from_fn(|_| vec![0.0; layout.dim]);
        Self {
            coefficients: Coefficients::new(),
            layout,
            z: vectors(),
            f: vectors(),
            w: vectors(),
            change: vectors(),
            y: vec![0.0; layout.dim],
        }
    }

    /// Starts from a polynomial, whose place `start` is the start of this step, or from no change at all.
    pub(crate) fn predict(&mut self, h: f64, before: &Polynomial, start: f64) {
        for (z, c) in self.z.iter_mut().zip(self.coefficients.c) {
            z.fill(0.0);
            if let Some(h_before) = before.step() {
                before.add_change_between(start, start + c * h / h_before, z);
            }
            z[self.layout.active..].fill(0.0);
        }
        transform(&self.coefficients.t_inverse, &self.z, &mut self.w);
    }

    /// Evaluates f at the stages; returns the index of the first at which it is not finite.
    pub(crate) fn evaluate<P: Ode + ?Sized>(
        &mut self,
        problem: &mut Counted<'_, P>,
        Step { t, h, y }: Step<'_>,
    ) -> Result<Option<usize>, EvalError> {
        for (i, c) in self.coefficients.c.into_iter().enumerate() {
            for ((target, y), z) in self.y.iter_mut().zip(y).zip(&self.z[i]) {
                *target = y + z;
            }
            problem.rhs(t + c * h, &self.y, &mut self.f[i])?;
            if !self.f[i].iter().all(|f| f.is_finite()) {
                return Ok(Some(i));
            }
        }
        Ok(None)
    }

    /// Makes one simplified Newton iteration with the values of f found last; returns the norm of the change.
    pub(crate) fn iterate(
        &mut self,
        systems: &mut Systems,
        jacobian: &[f64],
        Step { h, y, .. }: Step<'_>,
        (weights, indices): (&Weights, &mut Indices),
    ) -> f64 {
        let Coefficients {
            t,
            t_inverse,
            real,
            complex,
            ..
        } = &self.coefficients;
        transform(t_inverse, &self.f, &mut self.change);
        let (active, differential) = (self.layout.active, self.layout.differential());
        for i in 0..differential {
            let [w1, w2, w3] = [self.w[0][i], self.w[1][i], self.w[2][i]];
            self.change[0][i] = h * self.change[0][i] - real * w1;
            self.change[1][i] = h * self.change[1][i] - complex.re * w2 + complex.im * w3;
            self.change[2][i] = h * self.change[2][i] - complex.im * w2 - complex.re * w3;
        }
        for change in &mut self.change {
            change[differential..active].iter_mut().for_each(|f| *f *= h);
            change[active..].fill(0.0);
        }
        let [first, second, third] = &mut self.change;
        systems.solve_real(jacobian, first);
        systems.solve_complex(jacobian, (second, third));
        let squares = weights.mean_squares(y, y, indices.scale(h, [first, second, third]));
        for (w, change) in self.w.iter_mut().zip(&self.change) {
            w.iter_mut().zip(change).for_each(|(w, change)| *w += change);
        }
        transform(t, &self.w, &mut self.z);
        (squares.iter().sum::<f64>() / 3.0).sqrt()
    }

    /// Integrates the quadratures by the formula of the method, after the last iteration.
    ///
    /// The iteration has moved the stages since f was evaluated; this is made good with the rows of df/dy, so that the
    /// quadratures are as accurate as what they depend on.
    pub(crate) fn integrate_quadratures(&mut self, jacobian: &[f64], h: f64) {
        let Layout { dim, active, .. } = self.layout;
        if active == dim {
            return;
        }
        let Coefficients { a, t, .. } = &self.coefficients;
        for i in active..dim {
            let row = &jacobian[i * dim..][..active];
            let moved = self
                .change
                .each_ref()
                .map(|w| -> f64 { row.iter().zip(w).map(|(j, w)| j * w).sum() });
            let rates: [f64; 3] =
                std::array::from_fn(|k| self.f[k][i] + (0..3).map(|l| t[k][l] * moved[l]).sum::<f64>());
            for (z, a) in self.z.iter_mut().zip(a) {
                z[i] = h * (a[0] * rates[0] + a[1] * rates[1] + a[2] * rates[2]);
            }
        }
    }

    /// Writes the estimated error, with `f` in place of f(t, y): (γ − h J) error = h f + Σ eᵢ zᵢ. In algebraic rows γ is missing
    /// and the right-hand side zero: the estimate is a state near y that keeps to the equations, linearised.
    pub(crate) fn estimate(&self, systems: &mut Systems, jacobian: &[f64], h: f64, f: &[f64], error: &mut [f64]) {
        let Layout { dim, active, .. } = self.layout;
        let Coefficients { e, real, .. } = &self.coefficients;
        for (i, error) in error.iter_mut().enumerate() {
            *error = h * f[i] + (e[0] * self.z[0][i] + e[1] * self.z[1][i] + e[2] * self.z[2][i]);
        }
        error[self.layout.differential()..active].fill(0.0);
        systems.solve_real(jacobian, error);
        let (controlled, quadratures) = error.split_at_mut(active);
        for (i, error) in quadratures.iter_mut().enumerate() {
            let row = &jacobian[(active + i) * dim..][..active];
            let sum: f64 = row.iter().zip(&*controlled).map(|(j, x)| j * x).sum();
            *error = (*error + h * sum) / real;
        }
    }

    /// Writes the derivative of the collocation polynomial at the end of the step. There it is f, but for what Newton's iteration has
    /// left: of f itself a stiff problem would make something large.
    pub(crate) fn rate_at_end(&self, h: f64, f: &mut [f64]) {
        let r = &self.coefficients.rate;
        for (i, f) in f.iter_mut().enumerate() {
            *f = (r[0] * self.z[0][i] + r[1] * self.z[1][i] + r[2] * self.z[2][i]) / h;
        }
    }

    /// The last change of w that belongs to the end of the step.
    pub(crate) fn last_change(&self) -> &[f64] {
        &self.change[2]
    }
}

/// target = M source, component by component.
fn transform(m: &[[f64; 3]; 3], source: &[Vec<f64>; 3], target: &mut [Vec<f64>; 3]) {
    let [x, y, z] = source;
    for (row, target) in m.iter().zip(target) {
        for (((target, x), y), z) in target.iter_mut().zip(x).zip(y).zip(z) {
            *target = row[0] * x + row[1] * y + row[2] * z;
        }
    }
}

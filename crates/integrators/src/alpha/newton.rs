//! The equations of a step, scaled so that their conditioning does not depend on its length.

use super::coefficients::Coefficients;
use crate::constrained::{Constrained, Equations, Place};
use crate::linear::{Singular, factorise, solve};
use crate::{Counted, EvalError};

/// Part of a component by which it is varied: the square root of ε, which balances rounding and curvature.
const PART: f64 = 1.4901161193847656e-8;

/// State and residual of a step that is sought, and the factors of
///
/// \[ c M/s + h² T/s, Gᵀ; G, 0 \] (Δq, h² Δλ/s) = −(h² r/s, g), r = M v' − f + Gᵀ λ,
///
/// with c = (1 − α_m) / (β (1 − α_f)) and T = ∂r/∂q + γ/(βh) ∂r/∂v. Equations of motion and multipliers are scaled by h² and by s, the
/// largest diagonal of M (Bottasso, Dopico, Trainelli 2008).
#[derive(Debug, Clone, Default)]
pub(crate) struct Newton {
    n: usize,
    m: usize,
    /// (q, v) and what else a state has.
    pub y: Vec<f64>,
    pub rate: Vec<f64>,
    pub lambda: Vec<f64>,
    scale: f64,
    residual: Vec<f64>,
    varied: Vec<f64>,
    /// h² T / s, for the step `h` and scale that it was found with.
    tangent: Vec<f64>,
    damping: Vec<f64>,
    factors: Vec<f64>,
    pivots: Vec<usize>,
    /// The step for which factors exist.
    h: Option<f64>,
    x: Vec<f64>,
}

/// The steps may differ by this part of their length and still use the same factors: t + h is rounded.
const SAME_STEP: f64 = 1e-4;

impl Newton {
    pub(crate) fn new(n: usize, m: usize) -> Self {
        Self {
            n,
            m,
            y: vec![0.0; 2 * n + m],
            rate: vec![0.0; n],
            lambda: vec![0.0; m],
            scale: 1.0,
            residual: vec![0.0; n],
            varied: vec![0.0; n],
            tangent: vec![0.0; n * n],
            damping: vec![0.0; n * n],
            factors: vec![0.0; (n + m) * (n + m)],
            pivots: vec![0; n + m],
            h: None,
            x: vec![0.0; n + m],
        }
    }

    /// Whether there are factors for a step of this length.
    pub(crate) fn fit(&self, h: f64) -> bool {
        self.h.is_some_and(|own| (h - own).abs() <= SAME_STEP * own.abs())
    }

    /// Finds tangents and factors at the state as it stands.
    pub(crate) fn refresh<P: Constrained>(
        &mut self,
        problem: &mut Counted<'_, Equations<P>>,
        (t, h): (f64, f64),
        coefficients: &Coefficients,
    ) -> Result<Result<(), Singular>, EvalError> {
        let (n, m) = (self.n, self.m);
        self.h = None;
        let to_rates = coefficients.gamma / (coefficients.beta * h);
        let (q, v) = self.y.split_at(n);
        let at = Place {
            t,
            q,
            v: &v[..n],
            a: &self.rate,
            lambda: &self.lambda,
        };
        self.tangent.fill(0.0);
        self.damping.fill(0.0);
        let given = problem
            .for_matrix()
            .problem_mut()
            .tangents(&at, &mut self.tangent, &mut self.damping)?;
        let terms = problem.for_evaluation().evaluate(t, &self.y)?;
        terms.residual(&self.rate, &self.lambda, &mut self.residual);
        self.scale = (0..n).map(|i| terms.matrix[i * n + i]).fold(0.0, f64::max);
        if !(self.scale > 0.0 && self.scale.is_finite()) {
            return Ok(Err(Singular));
        }
        let (size, inverse) = (n + m, 1.0 / self.scale);
        self.factors.fill(0.0);
        for i in 0..n {
            for j in 0..n {
                self.factors[i * size + j] =
                    coefficients.share() / coefficients.beta * inverse * terms.matrix[i * n + j];
            }
        }
        for (k, row) in terms.gradient.chunks_exact(n.max(1)).enumerate() {
            for (j, g) in row.iter().enumerate() {
                self.factors[(n + k) * size + j] = *g;
                self.factors[j * size + n + k] = *g;
            }
        }
        if given {
            let pairs = self.tangent.iter_mut().zip(&self.damping);
            pairs.for_each(|(k, c)| *k += to_rates * c);
        } else {
            self.differences(problem, t, to_rates)?;
        }
        for i in 0..n {
            for j in 0..n {
                self.factors[i * size + j] += h * h * inverse * self.tangent[i * n + j];
            }
        }
        if factorise(&mut self.factors, &mut self.pivots).is_err() {
            return Ok(Err(Singular));
        }
        self.h = Some(h);
        Ok(Ok(()))
    }

    /// T by differences: a position is varied together with the rate that follows it.
    fn differences<P: Constrained>(
        &mut self,
        problem: &mut Counted<'_, Equations<P>>,
        t: f64,
        to_rates: f64,
    ) -> Result<(), EvalError> {
        let n = self.n;
        for j in 0..n {
            let (q, v) = (self.y[j], self.y[n + j]);
            // Neither of the two may be lost in rounding, nor vary by more than a small part of itself or of 1.
            let increment = PART
                * q.abs()
                    .max(1.0)
                    .min(v.abs().max(1.0) / to_rates.abs())
                    .max(1e-3 * q.abs());
            self.y[j] = q + increment;
            self.y[n + j] = v + increment * to_rates;
            let terms = problem.for_difference().evaluate(t, &self.y);
            let done = terms.map(|terms| terms.residual(&self.rate, &self.lambda, &mut self.varied));
            let inverse = 1.0 / (self.y[j] - q);
            (self.y[j], self.y[n + j]) = (q, v);
            done?;
            for i in 0..n {
                self.tangent[i * n + j] = (self.varied[i] - self.residual[i]) * inverse;
            }
        }
        Ok(())
    }

    /// One iteration for a step of length `h`: the changes of (q, v, λ) into `change`, those of v and λ multiplied by h and h².
    pub(crate) fn iterate<P: Constrained>(
        &mut self,
        problem: &mut Counted<'_, Equations<P>>,
        (t, h): (f64, f64),
        coefficients: &Coefficients,
        change: &mut [f64],
    ) -> Result<(), EvalError> {
        let (n, squared) = (self.n, h * h);
        let terms = problem.for_evaluation().evaluate(t, &self.y)?;
        terms.residual(&self.rate, &self.lambda, &mut self.residual);
        let (dynamic, constraints) = self.x.split_at_mut(n);
        for (x, r) in dynamic.iter_mut().zip(&self.residual) {
            *x = -squared / self.scale * r;
        }
        constraints.iter_mut().zip(&terms.constraint).for_each(|(x, g)| *x = -g);
        solve(&self.factors, &self.pivots, &mut self.x);
        let Coefficients { beta, gamma, .. } = *coefficients;
        for j in 0..n {
            let x = self.x[j];
            self.y[j] += x;
            self.y[n + j] += gamma / (beta * h) * x;
            self.rate[j] += coefficients.share() / (beta * squared) * x;
            (change[j], change[n + j]) = (x, gamma / beta * x);
        }
        for ((lambda, x), change) in self.lambda.iter_mut().zip(&self.x[n..]).zip(&mut change[2 * n..]) {
            *lambda += self.scale / squared * x;
            *change = self.scale * x;
        }
        Ok(())
    }
}

//! The forms of a constrained problem as an initial value problem: multipliers eliminated, or as unknowns at index 1, 2 or 3.

use super::{Constrained, Terms};
use crate::linear::{factorise, solve};
use crate::{EvalError, Ode, SecondOrder};

/// How the constraints are stated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Form {
    /// y = (q, v): the multipliers that keep g'' = 0 are eliminated at each evaluation. No algebraic equations, so that every
    /// method can take it; g and g' drift unless [projected](Equations::with_projection).
    Explicit,
    /// y = (q, v, λ), 0 = g''. Drifts as `Explicit` does.
    Index1,
    /// y = (q, v, λ), 0 = g'. Here g drifts.
    Index2,
    /// y = (q, v, λ, μ), 0 = g', 0 = g, with M q' = M v − Gᵀ μ; μ is zero but for errors of the method (Gear, Leimkuhler, Gupta 1985).
    Stabilised,
    /// y = (q, v, λ), 0 = g.
    #[default]
    Index3,
}

/// A [constrained problem](Constrained) in one of its [forms](Form), as an [`Ode`] with algebraic equations.
#[derive(Debug, Clone)]
pub struct Equations<P> {
    problem: P,
    form: Form,
    projected: bool,
    terms: Terms,
    /// Factors of M.
    factors: Vec<f64>,
    pivots: Vec<usize>,
    saddle: Saddle,
    /// Scratch: rates, and corrections of the positions' rates.
    rates: [Vec<f64>; 2],
}

/// The constraints cannot be kept: gradients depend on each other, or M moves nothing.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("at t = {time} the matrix of the equations is singular; are there constraints that depend on each other?")]
pub struct SingularConstraints {
    /// Time of the evaluation.
    pub time: f64,
}

/// A state that projection could not put back.
#[derive(Debug, thiserror::Error)]
#[error("the step leaves the constraints by {0:e}, too far to be put back; a shorter step may help")]
struct FarAway(f64);

/// Most corrections of positions in one projection; after an accepted step one or two are enough.
const CORRECTIONS: usize = 6;
/// Residuals below this, relative to positions larger than 1, are rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Residuals above this are no rounding.
const FAR: f64 = 1e-6;

/// The system [M Gᵀ; G 0] (x, y) = (r, s).
#[derive(Debug, Clone)]
struct Saddle {
    factors: Vec<f64>,
    pivots: Vec<usize>,
    x: Vec<f64>,
}

impl Saddle {
    fn factorise(&mut self, terms: &Terms, time: f64) -> Result<(), EvalError> {
        let (n, size) = (terms.force.len(), self.pivots.len());
        self.factors.fill(0.0);
        for i in 0..n {
            self.factors[i * size..][..n].copy_from_slice(&terms.matrix[i * n..][..n]);
        }
        for (k, row) in terms.gradient.chunks_exact(n.max(1)).enumerate() {
            self.factors[(n + k) * size..][..n].copy_from_slice(row);
            for (i, g) in row.iter().enumerate() {
                self.factors[i * size + n + k] = *g;
            }
        }
        factorise(&mut self.factors, &mut self.pivots).map_err(|_| singular(time))
    }

    /// Solves for what stands in `x`, in place.
    fn solve(&mut self) {
        solve(&self.factors, &self.pivots, &mut self.x);
    }
}

fn singular(time: f64) -> EvalError {
    EvalError::Retry(Box::new(SingularConstraints { time }))
}

impl<P: Constrained> Equations<P> {
    /// The problem in this form.
    pub fn new(problem: P, form: Form) -> Self {
        let (n, m) = (problem.positions(), problem.constraints());
        Self {
            problem,
            form,
            projected: false,
            terms: Terms::new(n, m),
            factors: vec![0.0; n * n],
            pivots: vec![0; n],
            saddle: Saddle {
                factors: vec![0.0; (n + m) * (n + m)],
                pivots: vec![0; n + m],
                x: vec![0.0; n + m],
            },
            rates: [vec![0.0; n], vec![0.0; n]],
        }
    }

    /// Puts positions and rates back onto g = 0 and g' = 0 after each step, along the shortest way in the metric of M, and replaces the
    /// multipliers by those that keep g'' = 0 there: all are then as accurate as positions and rates. (Those of the method itself are
    /// of order 1 only where rates are projected.)
    #[must_use]
    pub fn with_projection(mut self) -> Self {
        self.projected = true;
        self
    }

    /// The form.
    pub fn form(&self) -> Form {
        self.form
    }

    /// The problem.
    pub fn problem(&self) -> &P {
        &self.problem
    }

    /// The problem, to change it between two steps.
    pub fn problem_mut(&mut self) -> &mut P {
        &mut self.problem
    }

    /// The multipliers λ of a state; none in the form `Explicit`, where [`multipliers_at`](Equations::multipliers_at) finds them.
    pub fn multipliers<'a>(&self, y: &'a [f64]) -> &'a [f64] {
        let (n, m) = self.counts();
        match self.form {
            Form::Explicit => &[],
            _ => &y[2 * n..2 * n + m],
        }
    }

    /// The multipliers with which positions and rates of the state `y` keep g'' = 0, whatever those in it.
    ///
    /// # Errors
    /// Those of the problem; [`SingularConstraints`].
    pub fn multipliers_at(&mut self, t: f64, y: &[f64]) -> Result<&[f64], EvalError> {
        let n = self.counts().0;
        self.accelerate(t, y)?;
        Ok(&self.saddle.x[n..])
    }

    /// Largest |g| and |g'| at a state.
    ///
    /// # Errors
    /// Those of the problem.
    pub fn violation(&mut self, t: f64, y: &[f64]) -> Result<(f64, f64), EvalError> {
        self.evaluate(t, y)?;
        let n = self.counts().0;
        let rate = constraint_rates(&self.terms, &y[n..2 * n]).map(f64::abs);
        Ok((largest(&self.terms.constraint), rate.fold(0.0, f64::max)))
    }

    /// A consistent start: positions and rates near these that fulfil g = 0 and g' = 0, and their multipliers.
    ///
    /// # Errors
    /// Those of the problem; [`EvalError::Retry`] if the constraints cannot be met from there or depend on each other.
    ///
    /// # Panics
    /// If `q` or `v` is not as long as the problem says.
    pub fn start(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<Vec<f64>, EvalError> {
        let n = self.counts().0;
        assert!(q.len() == n && v.len() == n, "a start has {n} positions and {n} rates");
        let mut y = vec![0.0; self.dim()];
        y[..n].copy_from_slice(q);
        y[n..2 * n].copy_from_slice(v);
        self.put_on_constraints(t, &mut y)?;
        if self.form != Form::Explicit {
            self.set_multipliers(t, &mut y)?;
        }
        Ok(y)
    }

    fn set_multipliers(&mut self, t: f64, y: &mut [f64]) -> Result<(), EvalError> {
        let (n, m) = self.counts();
        self.accelerate(t, y)?;
        y[2 * n..2 * n + m].copy_from_slice(&self.saddle.x[n..]);
        Ok(())
    }

    /// n and m.
    pub(crate) fn counts(&self) -> (usize, usize) {
        (self.problem.positions(), self.problem.constraints())
    }

    /// All terms at positions and rates of `y`.
    pub(crate) fn evaluate(&mut self, t: f64, y: &[f64]) -> Result<&Terms, EvalError> {
        let n = self.problem.positions();
        self.terms.clear();
        self.problem.evaluate(t, &y[..n], &y[n..2 * n], &mut self.terms)?;
        Ok(&self.terms)
    }

    /// The rates of v that keep g'' = 0 at positions and rates of `y`, and behind them their multipliers.
    pub(crate) fn accelerate(&mut self, t: f64, y: &[f64]) -> Result<&[f64], EvalError> {
        let n = self.counts().0;
        self.evaluate(t, y)?;
        self.saddle.factorise(&self.terms, t)?;
        let (accelerations, multipliers) = self.saddle.x.split_at_mut(n);
        accelerations.copy_from_slice(&self.terms.force);
        multipliers
            .iter_mut()
            .zip(&self.terms.bias)
            .for_each(|(x, bias)| *x = -bias);
        self.saddle.solve();
        Ok(&self.saddle.x)
    }

    /// Puts positions and rates back; tells whether anything was changed.
    fn put_on_constraints(&mut self, t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
        let n = self.counts().0;
        let (mut corrections, mut before) = (0, f64::INFINITY);
        loop {
            self.evaluate(t, y)?;
            let residual = largest(&self.terms.constraint);
            let rounding = ROUNDING * largest(&y[..n]).max(1.0);
            // Newton's method squares residuals: what is not even halved is rounding.
            let settled = residual <= rounding || (residual <= FAR && residual > 0.5 * before);
            if settled {
                break;
            }
            if corrections == CORRECTIONS || residual.is_nan() {
                return Err(EvalError::Retry(Box::new(FarAway(residual))));
            }
            self.saddle.factorise(&self.terms, t)?;
            self.saddle.x[..n].fill(0.0);
            let targets = self.saddle.x[n..].iter_mut().zip(&self.terms.constraint);
            targets.for_each(|(x, g)| *x = -g);
            self.saddle.solve();
            y.iter_mut().zip(&self.saddle.x[..n]).for_each(|(q, x)| *q += x);
            (corrections, before) = (corrections + 1, residual);
        }
        let rates = constraint_rates(&self.terms, &y[n..2 * n]);
        self.saddle.x[n..]
            .iter_mut()
            .zip(rates)
            .for_each(|(x, rate)| *x = -rate);
        if largest(&self.saddle.x[n..]) <= ROUNDING * largest(&y[n..2 * n]).max(1.0) {
            return Ok(corrections > 0);
        }
        self.saddle.x[..n].fill(0.0);
        self.saddle.factorise(&self.terms, t)?;
        self.saddle.solve();
        y[n..2 * n]
            .iter_mut()
            .zip(&self.saddle.x[..n])
            .for_each(|(v, x)| *v += x);
        Ok(true)
    }
}

/// g' = G v + ∂g/∂t, one after the other.
fn constraint_rates<'a>(terms: &'a Terms, v: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let rows = terms.gradient.chunks_exact(v.len().max(1));
    rows.zip(&terms.time_rate)
        .map(move |(row, rate)| row.iter().zip(v).map(|(g, v)| g * v).sum::<f64>() + rate)
}

/// Largest size; not a number if one is not.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| {
        if largest.is_nan() || value.abs() <= largest {
            largest
        } else {
            value.abs()
        }
    })
}

impl<P: Constrained> Ode for Equations<P> {
    fn dim(&self) -> usize {
        2 * self.problem.positions() + self.algebraic()
    }

    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        let (n, m) = self.counts();
        let v = &y[n..2 * n];
        dy[..n].copy_from_slice(v);
        if self.form == Form::Explicit {
            dy[n..].copy_from_slice(&self.accelerate(t, y)?[..n]);
            return Ok(());
        }
        self.evaluate(t, y)?;
        let terms = &self.terms;
        self.factors.copy_from_slice(&terms.matrix);
        factorise(&mut self.factors, &mut self.pivots).map_err(|_| singular(t))?;
        let [rates, corrections] = &mut self.rates;
        rates.copy_from_slice(&terms.force);
        let gradient = || terms.gradient.chunks_exact(n.max(1));
        for (row, lambda) in gradient().zip(&y[2 * n..]) {
            rates.iter_mut().zip(row).for_each(|(f, g)| *f -= lambda * g);
        }
        solve(&self.factors, &self.pivots, rates);
        dy[n..2 * n].copy_from_slice(rates);
        let (positions, rest) = dy.split_at_mut(2 * n);
        match self.form {
            Form::Explicit => {}
            Form::Index1 => {
                for ((dy, row), bias) in rest.iter_mut().zip(gradient()).zip(&terms.bias) {
                    *dy = row.iter().zip(&*rates).map(|(g, a)| g * a).sum::<f64>() + bias;
                }
            }
            Form::Index2 => rest
                .iter_mut()
                .zip(constraint_rates(terms, v))
                .for_each(|(dy, rate)| *dy = rate),
            Form::Stabilised => {
                corrections.fill(0.0);
                for (row, mu) in gradient().zip(&y[2 * n + m..]) {
                    corrections.iter_mut().zip(row).for_each(|(c, g)| *c -= mu * g);
                }
                solve(&self.factors, &self.pivots, corrections);
                positions.iter_mut().zip(&*corrections).for_each(|(dy, c)| *dy += c);
                let (first, second) = rest.split_at_mut(m);
                first
                    .iter_mut()
                    .zip(constraint_rates(terms, v))
                    .for_each(|(dy, rate)| *dy = rate);
                second.copy_from_slice(&terms.constraint);
            }
            Form::Index3 => rest.copy_from_slice(&terms.constraint),
        }
        Ok(())
    }

    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
        if !self.projected {
            return Ok(false);
        }
        let changed = self.put_on_constraints(t, y)?;
        if self.form == Form::Explicit {
            return Ok(changed);
        }
        self.set_multipliers(t, y)?;
        Ok(true)
    }

    fn second_order_pairs(&self) -> usize {
        self.pairs()
    }

    fn algebraic(&self) -> usize {
        let m = self.problem.constraints();
        match self.form {
            Form::Explicit => 0,
            Form::Stabilised => 2 * m,
            _ => m,
        }
    }

    fn index(&self, component: usize) -> u32 {
        let n = self.problem.positions();
        match self.form {
            Form::Explicit | Form::Index1 => 1,
            Form::Index2 | Form::Stabilised => 1 + u32::from(component >= 2 * n),
            Form::Index3 => 1 + u32::from(component >= n) + u32::from(component >= 2 * n),
        }
    }
}

impl<P: Constrained> SecondOrder for Equations<P> {
    fn pairs(&self) -> usize {
        match self.form {
            Form::Stabilised => 0,
            _ => self.problem.positions(),
        }
    }
}

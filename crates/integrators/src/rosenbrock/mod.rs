//! A linearly implicit method: no iteration, a new matrix in each step.

mod tableau;

use crate::control::StepControl;
use crate::jacobian::{NotFinite, differences};
use crate::reduced::{Layout, Reduced};
use crate::{Counted, EvalError, Method, Ode, SettingsError, Step, Weights};
use tableau::{A, C, D, GAMMA, H, STAGES, TIMES};

/// Part of a step over which ∂f/∂t is found by a difference. Its error, PART/2 times the second derivative, hardly enters the result (its weight there is
/// zero where df/dy is), and rounding of f enters as ε/PART, far below the error of a step.
const PART: f64 = 2e-5;

/// Safety of the step (Hairer, Wanner II, IV.7), and weight of the error before, that of DOPRI5 (Hairer, Wanner II, IV.2).
const SAFETY: f64 = 0.9;
const MEMORY: f64 = 0.04;

/// By how much a step is shortened whose matrix is singular, as with Radau5.
const SHORTEN: f64 = 0.5;

/// RODAS5P, the stiffly accurate Rosenbrock method of order 5 with 8 stages and an embedded result of order 4.
///
/// L-stable and linearly implicit: each stage solves one system of equations with the same matrix, none is iterated. A step costs 8
/// evaluations and one for ∂f/∂t, and df/dy, which must be that of its start. So it suits problems with few components, or that give
/// df/dy themselves, at moderate tolerances; [`Radau5`](crate::Radau5) keeps its matrix for many steps. It solves
/// [algebraic equations](Ode::algebraic) of index 1. Interpolation is of order 4, at no cost.
///
/// Coefficients of (Steinebach 2023), transformed as in (Hairer, Wanner II, IV.7): (1/γ − h J) kᵢ = h f(t + cᵢ h, y + Σ aᵢⱼ kⱼ) + Σ Cᵢⱼ kⱼ + dᵢ h² ∂f/∂t.
#[derive(Debug, Clone)]
pub struct Rodas {
    layout: Layout,
    system: Reduced<f64>,
    /// Step for which factors exist.
    factorised: Option<f64>,
    jacobian: Vec<f64>,
    /// ∂f/∂t at the start of the step.
    rate_of_f: Vec<f64>,
    /// df/dy and ∂f/∂t are those of this step.
    known: bool,
    /// kᵢ.
    k: [Vec<f64>; STAGES],
    f_old: Vec<f64>,
    f_new: Vec<f64>,
    y: Vec<f64>,
    f: Vec<f64>,
    control: StepControl,
    shorten: bool,
}

impl Default for Rodas {
    fn default() -> Self {
        Self {
            layout: Layout::default(),
            system: Reduced::new(1.0 / GAMMA, 0),
            factorised: None,
            jacobian: Vec::new(),
            rate_of_f: Vec::new(),
            known: false,
            k: std::array::from_fn(|_| Vec::new()),
            f_old: Vec::new(),
            f_new: Vec::new(),
            y: Vec::new(),
            f: Vec::new(),
            control: StepControl::new(5, MEMORY, SAFETY),
            shorten: false,
        }
    }
}

impl Rodas {
    /// Finds df/dy and ∂f/∂t at the start of the step.
    fn find_derivatives<P: Ode + ?Sized>(
        &mut self,
        problem: &mut Counted<'_, P>,
        Step { t, h, y }: Step<'_>,
        weights: &Weights,
    ) -> Result<(), EvalError> {
        self.factorised = None;
        if !problem.jacobian(t, y, &mut self.jacobian)? {
            let scratch = [&mut self.y[..], &mut self.f[..]];
            let matrix = &mut self.jacobian;
            differences(
                problem,
                (t, h),
                (y, &self.f_old),
                weights,
                self.layout.active,
                scratch,
                matrix,
            )?;
        }
        let later = t + PART * h;
        self.rate_of_f.fill(0.0);
        if later != t {
            problem.rhs_for_jacobian(later, y, &mut self.rate_of_f)?;
            let inverse = 1.0 / (later - t);
            for (rate, f) in self.rate_of_f.iter_mut().zip(&self.f_old) {
                *rate = (*rate - f) * inverse;
            }
            if !self.rate_of_f.iter().all(|rate| rate.is_finite()) {
                return Err(EvalError::Retry(Box::new(NotFinite)));
            }
        }
        self.known = true;
        Ok(())
    }

    /// Solves for kᵢ, where f at the stage is known.
    fn solve(&mut self, i: usize, h: f64) {
        let Layout { dim, active, .. } = self.layout;
        let differential = self.layout.differential();
        let (before, rest) = self.k.split_at_mut(i);
        let k = &mut rest[0];
        let f = if i == 0 { &self.f_old } else { &self.f };
        for ((k, f), rate) in k.iter_mut().zip(f).zip(&self.rate_of_f) {
            *k = h * (f + D[i] * h * rate);
        }
        for (j, earlier) in before.iter().enumerate() {
            let c = C[i - 1][j];
            // Algebraic equations have no k on their left side.
            let parts = [0..differential, active..dim];
            for part in parts {
                for (k, earlier) in k[part.clone()].iter_mut().zip(&earlier[part]) {
                    *k += c * earlier;
                }
            }
        }
        self.system.solve(
            self.layout,
            (&self.jacobian, h),
            k,
            |k, i| k[i],
            |k, i, value| k[i] = value,
        );
        let (controlled, quadratures) = k.split_at_mut(active);
        for (i, k) in quadratures.iter_mut().enumerate() {
            let row = &self.jacobian[(active + i) * dim..][..active];
            let sum: f64 = row.iter().zip(&*controlled).map(|(entry, k)| entry * k).sum();
            *k = (*k + h * sum) * GAMMA;
        }
    }

    /// Writes the state at stage i, where the states before are known.
    fn move_to_stage(&mut self, i: usize, y: &[f64]) {
        if i > 5 {
            self.y.iter_mut().zip(&self.k[i - 1]).for_each(|(state, k)| *state += k);
            return;
        }
        self.y.copy_from_slice(y);
        for (a, k) in A[i - 1].iter().zip(&self.k[..i]) {
            self.y.iter_mut().zip(k).for_each(|(state, k)| *state += a * k);
        }
    }
}

impl<P: Ode + ?Sized> Method<P> for Rodas {
    fn order(&self) -> u32 {
        5
    }

    fn prepare(&mut self, problem: &P) -> Result<(), SettingsError> {
        let layout = Layout::of(problem)?;
        if (layout.differential()..layout.active).any(|i| problem.index(i) > 1) {
            return Err(SettingsError::Method(
                "Rodas solves algebraic equations of index 1 only; Radau5 those of index 2 and 3",
            ));
        }
        self.layout = layout;
        self.system = Reduced::new(1.0 / GAMMA, layout.active - layout.pairs);
        self.jacobian = vec![0.0; layout.dim * layout.dim];
        let k = self.k.iter_mut();
        for vector in k.chain([
            &mut self.rate_of_f,
            &mut self.f_old,
            &mut self.f_new,
            &mut self.y,
            &mut self.f,
        ]) {
            *vector = vec![0.0; layout.dim];
        }
        Ok(())
    }

    fn restart(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        (self.known, self.shorten) = (false, false);
        self.control = StepControl::new(5, MEMORY, SAFETY);
        problem.rhs(t, y, &mut self.f_old)
    }

    fn attempt(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError> {
        let Step { t, h, y } = step;
        if !self.known {
            self.find_derivatives(problem, step, weights)?;
        }
        if self.factorised != Some(h) {
            problem.count_factorisations(1);
            self.factorised = None;
            if self.system.factorise(self.layout, &self.jacobian, h).is_err() {
                problem.count_divergence();
                self.shorten = true;
                y_new.copy_from_slice(y);
                error.fill(0.0);
                return Ok(2.0);
            }
            self.factorised = Some(h);
        }
        self.solve(0, h);
        for i in 1..STAGES {
            self.move_to_stage(i, y);
            problem.rhs(t + TIMES[i] * h, &self.y, &mut self.f)?;
            if !self.f.iter().all(|f| f.is_finite()) {
                // The driver refuses this and names the component.
                y_new.copy_from_slice(&self.f);
                return Ok(f64::INFINITY);
            }
            self.solve(i, h);
        }
        let last = &self.k[STAGES - 1];
        for ((new, state), k) in y_new.iter_mut().zip(&self.y).zip(last) {
            *new = state + k;
        }
        error.copy_from_slice(last);
        Ok(weights.norm(y, y_new, error))
    }

    fn close(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        _projected: bool,
    ) -> Result<&[f64], EvalError> {
        problem.rhs(step.t + step.h, y_new, &mut self.f_new)?;
        Ok(&self.f_new)
    }

    fn accept(&mut self, _h: f64) {
        std::mem::swap(&mut self.f_old, &mut self.f_new);
        self.known = false;
    }

    fn retreat(&mut self) {
        std::mem::swap(&mut self.f_old, &mut self.f_new);
        self.known = true;
    }

    fn derivative(&self) -> &[f64] {
        &self.f_old
    }

    fn next_step(&mut self, h: f64, error: f64) -> f64 {
        if std::mem::take(&mut self.shorten) {
            return SHORTEN * h;
        }
        self.control.next(h, error)
    }

    fn interpolate(
        &mut self,
        _problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        theta: f64,
        y: &mut [f64],
    ) -> Result<(), EvalError> {
        let parts: [f64; STAGES] =
            std::array::from_fn(|j| theta * (1.0 - theta) * (H[0][j] + theta * (H[1][j] + theta * H[2][j])));
        for ((y, old), new) in y.iter_mut().zip(step.y).zip(y_new) {
            *y = old + theta * (new - old);
        }
        for (part, k) in parts.iter().zip(&self.k) {
            y.iter_mut().zip(k).for_each(|(y, k)| *y += part * k);
        }
        Ok(())
    }

    fn solves_algebraic(&self) -> bool {
        true
    }
}

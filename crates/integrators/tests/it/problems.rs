//! Problems with known solutions, and a wrapper that counts.

use crate::standard_odes::{PLEIADES, PLEIADES_END, PLEIADES_START};
use linkdyn_integrators::{
    EvalError, Integration, IntegrationError, Method, Ode, Progress, SecondOrder, Settings, Statistics,
};

/// x'' + 2 D x' + x = 0 with D = 0.1, and the integral of x.
pub struct Damped;

impl Damped {
    pub const START: [f64; 3] = [1.0, 0.0, 0.0];

    pub fn exact(t: f64) -> [f64; 3] {
        let (d, w) = (0.1, f64::sqrt(0.99));
        let (decay, c, s) = ((-d * t).exp(), (w * t).cos(), (w * t).sin());
        let (x, v) = (decay * (c + d / w * s), -decay * s / w);
        // x = -(v' + 2 D v), integrated from 0.
        [x, v, -v - 2.0 * d * (x - 1.0)]
    }
}

impl Ode for Damped {
    fn dim(&self) -> usize {
        3
    }
    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        dy.copy_from_slice(&[y[1], -y[0] - 0.2 * y[1], y[0]]);
        Ok(())
    }
}

impl SecondOrder for Damped {
    fn pairs(&self) -> usize {
        1
    }
}

/// x'' = 2 x³ − (1 + k²) x, solved by sn(t, k); here k = 1: x = tanh t. And z' = 1 − z² beside it.
pub struct Kink;

impl Kink {
    pub const START: [f64; 3] = [0.0, 1.0, 0.0];

    pub fn exact(t: f64) -> [f64; 3] {
        [t.tanh(), 1.0 / (t.cosh() * t.cosh()), t.tanh()]
    }
}

impl Ode for Kink {
    fn dim(&self) -> usize {
        3
    }
    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        dy.copy_from_slice(&[y[1], 2.0 * y[0].powi(3) - 2.0 * y[0], 1.0 - y[2] * y[2]]);
        Ok(())
    }
}

impl SecondOrder for Kink {
    fn pairs(&self) -> usize {
        1
    }
}

/// x'' = 6 x² with x = 1 / (1 + t)², and z' = −2 t z², z = 1 / (1 + t²): with time in the right-hand side.
pub struct Rational;

impl Rational {
    pub const START: [f64; 3] = [1.0, -2.0, 1.0];

    pub fn exact(t: f64) -> [f64; 3] {
        [(1.0 + t).powi(-2), -2.0 * (1.0 + t).powi(-3), 1.0 / (1.0 + t * t)]
    }
}

impl Ode for Rational {
    fn dim(&self) -> usize {
        3
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        dy.copy_from_slice(&[y[1], 6.0 * y[0] * y[0], -2.0 * t * y[2] * y[2]]);
        Ok(())
    }
}

impl SecondOrder for Rational {
    fn pairs(&self) -> usize {
        1
    }
}

/// Seven stars in a plane (Hairer, Nørsett, Wanner I, II.10).
pub struct Pleiades;

impl Pleiades {
    pub const START: [f64; 28] = PLEIADES_START;
    /// At t = 3, from the test set for IVP solvers.
    pub const END: [f64; 28] = PLEIADES_END;
}

impl Ode for Pleiades {
    fn dim(&self) -> usize {
        28
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        (PLEIADES.rhs)(t, y, dy);
        Ok(())
    }
}

impl SecondOrder for Pleiades {
    fn pairs(&self) -> usize {
        0
    }
}

/// Any right-hand side given as a function of t and y.
pub struct Function<F>(pub usize, pub F);

impl<F: FnMut(f64, &[f64], &mut [f64]) -> Result<(), EvalError>> Ode for Function<F> {
    fn dim(&self) -> usize {
        self.0
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        (self.1)(t, y, dy)
    }
}

impl<F> SecondOrder for Function<F>
where
    Self: Ode,
{
    fn pairs(&self) -> usize {
        0
    }
}

/// Counts what really is called.
#[derive(Default)]
pub struct Counting<P> {
    pub problem: P,
    pub evaluations: u64,
    pub projections: u64,
    pub root_evaluations: u64,
    pub events: u64,
    /// Root functions, none or two: the first component above `level`, and below it.
    pub roots: usize,
    pub level: f64,
    /// Whether `project` claims to have changed the state.
    pub claim: bool,
}

impl<P> Counting<P> {
    pub fn new(problem: P) -> Self {
        Self {
            problem,
            evaluations: 0,
            projections: 0,
            root_evaluations: 0,
            events: 0,
            roots: 0,
            level: 0.0,
            claim: false,
        }
    }
}

impl<P: Ode> Ode for Counting<P> {
    fn dim(&self) -> usize {
        self.problem.dim()
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        self.evaluations += 1;
        self.problem.rhs(t, y, dy)
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
        self.projections += 1;
        self.problem.project(t, y)?;
        Ok(self.claim)
    }
    fn roots(&self) -> usize {
        self.roots
    }
    fn root(&mut self, _t: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        self.root_evaluations += 1;
        (g[0], g[1]) = (y[0] - self.level, self.level - y[0]);
        Ok(())
    }
    fn at_event(&mut self, _t: f64, _y: &mut [f64], _fired: &[bool]) -> Result<(), EvalError> {
        self.events += 1;
        Ok(())
    }
}

impl<P: SecondOrder> SecondOrder for Counting<P> {
    fn pairs(&self) -> usize {
        self.problem.pairs()
    }
}

/// Runs to the end.
pub fn finish<P: Ode, M: Method<P>>(run: &mut Integration<P, M>, end: f64) -> Vec<f64> {
    while !matches!(run.advance(end).expect("the run succeeds"), Progress::Done { .. }) {}
    run.state().1.to_vec()
}

/// State at `end` with these settings.
pub fn solve<'a>(
    problem: impl SecondOrder + 'a,
    method: impl Method<Any<'a>> + 'a,
    y0: &[f64],
    end: f64,
    settings: Settings,
) -> (Vec<f64>, Statistics) {
    let mut run = begin(problem, method, 0.0, y0, settings).expect("good settings");
    let y = finish(&mut run, end);
    (y, run.statistics())
}

/// Any problem behind a pointer: methods are then compiled once, not once for each problem.
pub type Any<'a> = Box<dyn SecondOrder + 'a>;

/// A run of any problem by any method.
pub type Run<'a> = Integration<Any<'a>, Box<dyn Method<Any<'a>> + 'a>>;

/// Begins a run.
pub fn begin<'a>(
    problem: impl SecondOrder + 'a,
    method: impl Method<Any<'a>> + 'a,
    t0: f64,
    y0: &[f64],
    settings: Settings,
) -> Result<Run<'a>, IntegrationError> {
    Integration::new(Box::new(problem), Box::new(method), t0, y0, settings)
}

/// A method behind a pointer: the driver is then compiled once for a problem, not once for each method too.
pub fn boxed<'a, P: ?Sized>(method: impl Method<P> + 'a) -> Box<dyn Method<P> + 'a> {
    Box::new(method)
}

/// Largest difference.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

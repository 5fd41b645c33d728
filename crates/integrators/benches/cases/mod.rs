//! Right-hand sides of 9 components that cost next to nothing, so that what a run takes is the work of driver and method.

use std::hint::black_box;

use linkdyn_integrators::{EvalError, Integration, Method, Ode, Progress, Settings};

/// Linear oscillations of one frequency: steps and order soon stay the same.
pub struct Rotation;

impl Ode for Rotation {
    fn dim(&self) -> usize {
        9
    }
    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        for i in 0..4 {
            (dy[i], dy[4 + i]) = (y[4 + i], -y[i]);
        }
        dy[8] = y[0];
        Ok(())
    }
}

/// Four oscillators with stiffening springs: steps and order change all the time, as in a mechanism.
pub struct Duffing;

impl Ode for Duffing {
    fn dim(&self) -> usize {
        9
    }
    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        for i in 0..4 {
            (dy[i], dy[4 + i]) = (y[4 + i], -y[i] - y[i] * y[i] * y[i]);
        }
        dy[8] = y[0];
        Ok(())
    }
    fn quadratures(&self) -> usize {
        1
    }
    fn second_order_pairs(&self) -> usize {
        4
    }
}

/// Runs to t = 200 and returns the number of evaluations.
pub fn run<P: Ode, M: Method<P>>(problem: P, method: M) -> u64 {
    let y0 = [1.0, 0.5, 0.2, 0.1, 0.0, 0.3, 0.7, 0.9, 0.0];
    let settings = Settings::tolerances(1e-8, 1e-8);
    let mut run = Integration::new(problem, method, 0.0, &y0, settings).expect("good settings");
    while !matches!(run.advance(200.0).expect("smooth problem"), Progress::Done { .. }) {}
    black_box(run.state().1[8]);
    run.statistics().evaluations
}

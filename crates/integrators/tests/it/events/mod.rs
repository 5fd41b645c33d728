//! Located events: where they are, what they cost, and what happens when they crowd.

mod accuracy;
mod crowds;
mod failures;
mod searching;
mod state;

use linkdyn_integrators::{
    Adams, Auto, Bdf, Corrector, Dop853, DormandPrince5, EvalError, Integration, IntegrationError, Method, Newmark,
    Ode, Progress, Radau5, Rk4, Rodas, SecondOrder, Settings,
};

use crate::problems::{Any, Run, begin};

type Answer = Result<(), EvalError>;

/// A problem stated by three functions: right-hand side, root functions, and what events do to the state and to a number kept beside
/// it (a mode, a count), which the other two see.
#[derive(Clone)]
pub struct Switched<F, G, C> {
    pub dim: usize,
    pub roots: usize,
    pub pairs: usize,
    pub mode: f64,
    pub rhs: F,
    pub root: G,
    pub change: C,
}

impl<F, G, C> Ode for Switched<F, G, C>
where
    F: FnMut(f64, f64, &[f64], &mut [f64]),
    G: FnMut(f64, f64, &[f64], &mut [f64]) -> Answer,
    C: FnMut(&mut f64, f64, &mut [f64], &[bool]) -> Answer,
{
    fn dim(&self) -> usize {
        self.dim
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Answer {
        (self.rhs)(self.mode, t, y, dy);
        Ok(())
    }
    fn roots(&self) -> usize {
        self.roots
    }
    fn root(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Answer {
        (self.root)(self.mode, t, y, g)
    }
    fn at_event(&mut self, t: f64, y: &mut [f64], fired: &[bool]) -> Answer {
        (self.change)(&mut self.mode, t, y, fired)
    }
}

impl<F, G, C> SecondOrder for Switched<F, G, C>
where
    Self: Ode,
{
    fn pairs(&self) -> usize {
        self.pairs
    }
}

/// `Switched` as a problem for all methods.
pub trait Problem: SecondOrder {}
impl<P: SecondOrder> Problem for P {}

/// A ball above a floor: y'' = −1, and at the floor v becomes −e v.
pub fn ball(restitution: f64) -> impl Problem + Clone {
    Switched {
        dim: 2,
        roots: 1,
        pairs: 1,
        mode: restitution,
        rhs: |_, _, y: &[f64], dy: &mut [f64]| (dy[0], dy[1]) = (y[1], -1.0),
        root: |_, _, y: &[f64], g: &mut [f64]| {
            g[0] = y[0];
            Ok(())
        },
        change: |e: &mut f64, _, y: &mut [f64], fired: &[bool]| {
            assert_eq!(fired, [true]);
            y[1] *= -*e;
            Ok(())
        },
    }
}

/// y' = 1 that only counts what is fired, for root functions of any kind.
pub fn clock<G>(roots: usize, mut root: G) -> impl Problem
where
    G: FnMut(f64, &mut [f64]),
{
    Switched {
        dim: 1,
        roots,
        pairs: 0,
        mode: 0.0,
        rhs: |_, _, _: &[f64], dy: &mut [f64]| dy[0] = 1.0,
        root: move |_, t, _: &[f64], g: &mut [f64]| {
            root(t, g);
            Ok(())
        },
        change: |_: &mut f64, _, _: &mut [f64], _: &[bool]| Ok(()),
    }
}

/// All events on the way to `end`: times and what fired.
pub fn events<P: Ode, M: Method<P>>(run: &mut Integration<P, M>, end: f64) -> Vec<(f64, Vec<bool>)> {
    let (found, error) = events_until_failure(run, end);
    assert!(error.is_none(), "{error:?}");
    found
}

pub fn times<P: Ode, M: Method<P>>(run: &mut Integration<P, M>, end: f64) -> Vec<f64> {
    events(run, end).into_iter().map(|(t, _)| t).collect()
}

pub fn events_until_failure<P: Ode, M: Method<P>>(
    run: &mut Integration<P, M>,
    end: f64,
) -> (Vec<(f64, Vec<bool>)>, Option<IntegrationError>) {
    let mut found = Vec::new();
    for _ in 0..1_000_000 {
        match run.advance(end) {
            Ok(Progress::Event { t }) => {
                assert_eq!(run.state().0, t);
                assert!(run.fired().contains(&true));
                found.push((t, run.fired().to_vec()));
            }
            Ok(Progress::Done { .. }) => return (found, None),
            Ok(_) => assert!(!run.fired().contains(&true)),
            Err(error) => return (found, Some(error)),
        }
    }
    panic!("no end");
}

pub fn start<'a>(
    problem: impl SecondOrder + 'a,
    method: impl Method<Any<'a>> + 'a,
    t0: f64,
    y0: &[f64],
    tolerance: f64,
) -> Run<'a> {
    let settings = Settings::tolerances(tolerance, tolerance);
    begin(problem, method, t0, y0, settings).expect("good settings")
}

/// Times differ by less.
pub fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?}, not {expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance, "{found}, not {expected}");
    }
}

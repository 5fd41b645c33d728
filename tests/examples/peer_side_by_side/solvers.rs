//! Solvers of two libraries behind one signature: ours, and those of crate `differential-equations`.

use differential_equations::methods::{
    BackwardDifferentiationFormula, DiagonallyImplicitRungeKutta, ExplicitRungeKutta, ImplicitRungeKutta,
};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod, solve_ode};
use differential_equations::prelude::{Interpolation, Matrix};
use differential_equations::solout::DefaultSolout;
use linkdyn_integrators::{Adams, Auto, Bdf, Dop853, Integration, Method, Progress, Radau5, Rodas, Settings};
use linkdyn_tests::standard_odes::Standard;
use std::cell::Cell;

/// What a run found and what it took.
#[derive(Clone, Debug)]
pub struct Work {
    /// State at the end.
    pub y: Vec<f64>,
    /// Calls of the right-hand side, those for Jacobians by differences included.
    pub evaluations: u64,
    /// Jacobians.
    pub jacobians: u64,
    /// Factorisations; `None` where the library does not tell them. For Radau methods ours counts matrices, the peer pairs.
    pub factorisations: Option<u64>,
    /// Steps, rejected ones included.
    pub steps: u64,
}

/// A method of one of the libraries.
pub struct Solver {
    /// Method.
    pub name: &'static str,
    /// Whether it is ours.
    pub ours: bool,
    /// Solves a problem at a relative tolerance.
    pub solve: fn(&Standard, f64) -> Result<Work, String>,
}

const fn ours(name: &'static str, solve: fn(&Standard, f64) -> Result<Work, String>) -> Solver {
    Solver {
        name,
        ours: true,
        solve,
    }
}

const fn peer(name: &'static str, solve: fn(&Standard, f64) -> Result<Work, String>) -> Solver {
    Solver {
        name,
        ours: false,
        solve,
    }
}

/// Solves with a method of the peer, whose states are arrays of fixed length. (Tolerances are arrays as well: a single number
/// would let its Radau method transform the tolerances wrongly.)
macro_rules! by_peer {
    ($problem:expr, $relative:expr, $method:expr) => {
        by_peer!($problem, $relative, $method, Differences::Peer)
    };
    ($problem:expr, $relative:expr, $method:expr, $differences:expr) => {{
        let (problem, relative): (&Standard, f64) = ($problem, $relative);
        macro_rules! of_length {
            ($n:literal) => {{
                let absolute = [problem.ratio * relative; $n];
                let method = $method.rtol([relative; $n]).atol(absolute).max_steps(MOST_STEPS);
                solve_by_peer::<$n, _>(
                    problem,
                    method.h0(first_step(problem).unwrap_or(0.0)),
                    $differences,
                )
            }};
        }
        match problem.start.len() {
            2 => of_length!(2),
            3 => of_length!(3),
            8 => of_length!(8),
            28 => of_length!(28),
            n => Err(format!("no arrays of {n} components here")),
        }
    }};
}

/// Methods for stiff problems. Where Newton's tolerance of the peer's radau5 is zero it goes by that of the steps, as in the original; its
/// default does not. Names with an asterisk have df/dy by [`Differences::Original`].
pub const STIFF: [Solver; 10] = [
    ours("Radau5", |p, tol| solve(p, Radau5::default(), tol)),
    peer("radau5", |p, tol| {
        by_peer!(p, tol, ImplicitRungeKutta::radau5().newton_tol(0.0))
    }),
    peer("radau5*", |p, tol| {
        by_peer!(
            p,
            tol,
            ImplicitRungeKutta::radau5().newton_tol(0.0),
            Differences::Original
        )
    }),
    ours("Bdf", |p, tol| solve(p, Bdf::default(), tol)),
    ours("Rodas", |p, tol| solve(p, Rodas::default(), tol)),
    ours("Auto", |p, tol| solve(p, Auto::default(), tol)),
    peer("bdf", |p, tol| {
        by_peer!(p, tol, BackwardDifferentiationFormula::adaptive())
    }),
    peer("bdf*", |p, tol| {
        by_peer!(
            p,
            tol,
            BackwardDifferentiationFormula::adaptive(),
            Differences::Original
        )
    }),
    peer("kvaerno745*", |p, tol| {
        by_peer!(
            p,
            tol,
            DiagonallyImplicitRungeKutta::kvaerno745(),
            Differences::Original
        )
    }),
    peer("gauss_legendre_6*", |p, tol| {
        by_peer!(p, tol, ImplicitRungeKutta::gauss_legendre_6(), Differences::Original)
    }),
];

/// Methods for the others.
pub const EXPLICIT: [Solver; 4] = [
    ours("Dop853", |p, tol| solve(p, Dop853::default(), tol)),
    peer("dop853", |p, tol| by_peer!(p, tol, ExplicitRungeKutta::dop853())),
    ours("Adams", |p, tol| solve(p, Adams::default(), tol)),
    peer("rkv988e", |p, tol| by_peer!(p, tol, ExplicitRungeKutta::rkv988e())),
];

/// Steps after which a run of the peer is given up.
const MOST_STEPS: usize = 200_000;

/// All start stiff problems alike; with the others the methods choose.
fn first_step(problem: &Standard) -> Option<f64> {
    (problem.start.len() < 28).then_some(1e-6)
}

fn solve(problem: &Standard, method: impl Method<Standard>, relative: f64) -> Result<Work, String> {
    let settings = Settings {
        first_step: first_step(problem),
        ..Settings::tolerances(relative, problem.ratio * relative)
    };
    let run = Integration::new(*problem, method, 0.0, problem.start, settings);
    let mut run = run.map_err(|error| error.to_string())?;
    while !matches!(
        run.advance(problem.end).map_err(|error| error.to_string())?,
        Progress::Done { .. }
    ) {}
    let s = run.statistics();
    Ok(Work {
        y: run.state().1.to_vec(),
        evaluations: s.evaluations,
        jacobians: s.jacobians,
        factorisations: Some(s.factorisations),
        steps: s.accepted + s.rejected,
    })
}

/// By which steps df/dy is found for the peer.
#[derive(Clone, Copy)]
enum Differences {
    /// Its own: √ε, or that share of larger components. Too long where components are tiny.
    Peer,
    /// Those of subroutine RADAU5 (Hairer, Wanner II, IV.8): √(ε max(1e-5, |yⱼ|)).
    Original,
}

/// Counts what really is called.
struct Counted<'a> {
    problem: &'a Standard,
    differences: Differences,
    calls: Cell<u64>,
}

impl<const N: usize> ODE<f64, [f64; N]> for Counted<'_> {
    fn diff(&self, t: f64, y: &[f64; N], dydt: &mut [f64; N]) {
        self.calls.set(self.calls.get() + 1);
        (self.problem.rhs)(t, y, dydt);
    }

    fn jacobian(&self, t: f64, y: &[f64; N], matrix: &mut Matrix<f64>) {
        let (mut near, mut here, mut there) = (*y, [0.0; N], [0.0; N]);
        self.diff(t, y, &mut here);
        for j in 0..N {
            let step = match self.differences {
                Differences::Peer => f64::EPSILON.sqrt() * y[j].abs().max(1.0),
                Differences::Original => (f64::EPSILON * y[j].abs().max(1e-5)).sqrt(),
            };
            near[j] = y[j] + step;
            self.diff(t, &near, &mut there);
            for i in 0..N {
                matrix[(i, j)] = (there[i] - here[i]) / step;
            }
            near[j] = y[j];
        }
    }
}

fn solve_by_peer<const N: usize, M>(problem: &Standard, mut method: M, differences: Differences) -> Result<Work, String>
where
    M: OrdinaryNumericalMethod<f64, [f64; N]> + Interpolation<f64, [f64; N]>,
{
    let y0: [f64; N] = problem.start.try_into().map_err(|_| "a start of another length")?;
    let counted = Counted {
        problem,
        differences,
        calls: Cell::new(0),
    };
    let solved = solve_ode(&mut method, &counted, 0.0, problem.end, &y0, &mut DefaultSolout::new());
    let solved = solved.map_err(|error| format!("{error:?}"))?;
    Ok(Work {
        y: solved.y.last().ok_or("no state")?.to_vec(),
        evaluations: counted.calls.get(),
        jacobians: solved.evals.jacobian as u64,
        factorisations: Some(solved.evals.decompositions as u64).filter(|&n| n > 0),
        steps: solved.steps.total() as u64,
    })
}

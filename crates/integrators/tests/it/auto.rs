//! The choice between Adams and Radau5.

use linkdyn_integrators::{Adams, Auto, EvalError, Method, Ode, Radau5, SecondOrder, Settings, Statistics};

use crate::benchmark_05_standard_odes::digits;
use crate::problems::{Any, Damped, Function, Kink, Pleiades, Rational, solve};
use crate::standard_odes::{HIRES, ROBERTSON, VAN_DER_POL};

fn work<'a>(
    problem: impl SecondOrder + 'a,
    method: impl Method<Any<'a>> + 'a,
    y0: &[f64],
    end: f64,
    tolerance: f64,
) -> Statistics {
    solve(problem, method, y0, end, Settings::tolerances(tolerance, tolerance)).1
}

#[test]
fn smooth_problems_stay_with_adams() {
    fn check<P: SecondOrder + 'static>(problem: fn() -> P, y0: &[f64], end: f64) {
        for tolerance in [1e-5, 1e-7, 1e-9, 1e-11] {
            let auto = work(problem(), Auto::default(), y0, end, tolerance);
            let adams = work(problem(), Adams::default(), y0, end, tolerance);
            // One trial at most.
            assert!(auto.jacobians <= 1, "{tolerance:e}: {auto:?}");
            let most = adams.evaluations + 80 * auto.jacobians;
            assert!(auto.evaluations <= most, "{tolerance:e}: {auto:?}, {adams:?}");
            assert!(
                auto.jacobians == 1 || auto == adams,
                "{tolerance:e}: {auto:?}, {adams:?}"
            );
        }
    }
    check(|| Damped, &Damped::START, 50.0);
    check(|| Kink, &Kink::START, 1.5);
    check(|| Pleiades, &Pleiades::START, 3.0);
    check(|| Rational, &Rational::START, 5.0);
}

/// A beginning with Adams costs little.
#[test]
fn stiff_problems_go_to_radau() {
    for problem in [&HIRES, &ROBERTSON, &VAN_DER_POL] {
        for power in [4, 6, 8] {
            let relative = f64::powi(10.0, -power);
            let (found, auto) = digits(problem, Auto::default(), relative);
            let (_, radau) = digits(problem, Radau5::default(), relative);
            assert!(found > f64::from(power) - 1.0, "{relative:e}: {found} digits");
            let most = radau.evaluations + radau.evaluations / 5;
            assert!(auto.evaluations < most, "{relative:e}: {auto:?}, {radau:?}");
        }
    }
}

/// x' = −k(t) (x − sin t) + cos t, in turn stiff and not, over 100 s each: cheaper than Radau5, at tight tolerances far cheaper, and in reach of no explicit method.
#[test]
fn both_are_used_where_stiffness_comes_and_goes() {
    let problem = || {
        Function(1, |t: f64, y: &[f64], dy: &mut [f64]| {
            let k = if (t / 100.0) % 2.0 < 1.0 { 1e4 } else { 1.0 };
            dy[0] = -k * (y[0] - t.sin()) + t.cos();
            Ok(())
        })
    };
    for (tolerance, part) in [(1e-6, 0.7), (1e-8, 0.5), (1e-10, 0.4)] {
        let auto = work(problem(), Auto::default(), &[0.0], 1000.0, tolerance);
        let radau = work(problem(), Radau5::default(), &[0.0], 1000.0, tolerance);
        assert!(
            (auto.evaluations as f64) < part * radau.evaluations as f64,
            "{tolerance:e}: {auto:?}, {radau:?}"
        );
    }
}

/// y' = −z, 0 = z − y.
struct Algebraic;

impl Ode for Algebraic {
    fn dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        (dy[0], dy[1]) = (-y[1], y[1] - y[0]);
        Ok(())
    }
    fn algebraic(&self) -> usize {
        1
    }
}

impl SecondOrder for Algebraic {
    fn pairs(&self) -> usize {
        0
    }
}

#[test]
fn algebraic_equations_are_left_to_radau() {
    let auto = work(Algebraic, Auto::default(), &[1.0, 1.0], 3.0, 1e-8);
    assert_eq!(auto, work(Algebraic, Radau5::default(), &[1.0, 1.0], 3.0, 1e-8));
}

/// What these runs are made of, exactly: a change that makes other choices shows.
#[test]
fn counters() {
    let counters = |s: Statistics| [s.evaluations, s.accepted, s.rejected, s.jacobians];
    let found = [
        counters(digits(&HIRES, Auto::default(), 1e-6).1),
        counters(digits(&VAN_DER_POL, Auto::default(), 1e-6).1),
        counters(work(Damped, Auto::default(), &Damped::START, 50.0, 1e-7)),
        counters(work(Pleiades, Auto::default(), &Pleiades::START, 3.0, 1e-7)),
    ];
    let expected = [
        [1729, 407, 89, 26],
        [3011, 466, 49, 84],
        [448, 201, 8, 1],
        [888, 421, 44, 0],
    ];
    assert_eq!(found, expected);
}

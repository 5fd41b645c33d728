//! What a tolerance buys.

use linkdyn_integrators::{Adams, Dop853, DormandPrince5, Method, SecondOrder, Settings};

use crate::methods::{adaptive, nth};
use crate::problems::{Any, Damped, Function, Kink, Pleiades, begin, distance, finish, solve};

/// Two digits more of tolerance must buy at least one digit of accuracy, down to rounding.
fn responds<P: SecondOrder + 'static, M: Method<Any<'static>> + 'static>(
    problem: impl Fn() -> P,
    method: impl Fn() -> M,
    y0: &[f64],
    (end, exact): (f64, &[f64]),
    amplification: f64,
) {
    let mut last = f64::INFINITY;
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
        let (y, _) = solve(problem(), method(), y0, end, Settings::tolerances(tolerance, tolerance));
        let error = distance(&y, exact);
        assert!(
            error < 0.1 * last || error < 1e-12 * amplification,
            "{tolerance:e}: {error:e} after {last:e}"
        );
        assert!(error < 100.0 * amplification * tolerance, "{tolerance:e}: {error:e}");
        last = error;
    }
}

#[test]
fn error_follows_tolerance() {
    for k in 0..adaptive::<Damped>().len() {
        responds(|| Damped, || nth(k), &Damped::START, (20.0, &Damped::exact(20.0)), 1.0);
        responds(|| Kink, || nth(k), &Kink::START, (1.5, &Kink::exact(1.5)), 10.0);
    }
}

#[test]
fn pleiades() {
    fn error<M: Method<Any<'static>> + 'static>(method: M, tolerance: f64) -> f64 {
        let settings = Settings::tolerances(tolerance, tolerance);
        distance(
            &solve(Pleiades, method, &Pleiades::START, 3.0, settings).0,
            &Pleiades::END,
        )
    }
    for (name, error, bound) in [
        ("Dop853", error(Dop853::default(), 1e-12), 1e-9),
        ("DormandPrince5", error(DormandPrince5::default(), 1e-10), 1e-6),
        ("Adams", error(Adams::default(), 1e-12), 1e-7),
    ] {
        assert!(error < bound, "{name}: {error:e}");
    }
}

/// The work of the runs, so that a change that costs work shows.
#[test]
fn work() {
    fn work<M: Method<Any<'static>> + 'static>(method: M) -> u64 {
        solve(
            Pleiades,
            method,
            &Pleiades::START,
            3.0,
            Settings::tolerances(1e-10, 1e-10),
        )
        .1
        .evaluations
    }
    assert!(work(Dop853::default()) < 3100);
    assert!(work(Adams::default()) < 1600);
}

#[test]
fn each_component_has_its_own_tolerance() {
    let settings = Settings::tolerances(vec![1e-10, 1e-10, 1e-3], vec![1e-12, 1e-12, f64::INFINITY]);
    let (y, free) = solve(Damped, Dop853::default(), &Damped::START, 20.0, settings);
    assert!(distance(&y[..2], &Damped::exact(20.0)[..2]) < 1e-8);
    // A component that is hard to integrate but not controlled costs no step.
    let rough = |_: f64, y: &[f64], dy: &mut [f64]| {
        dy.copy_from_slice(&[y[1], -y[0] - 0.2 * y[1], (1e3 * y[0]).sin()]);
        Ok(())
    };
    let tolerances = |third: f64| Settings::tolerances(1e-10, vec![1e-12, 1e-12, third]);
    let (_, rough_free) = solve(
        Function(3, rough),
        Dop853::default(),
        &Damped::START,
        20.0,
        tolerances(f64::INFINITY),
    );
    let (_, rough_held) = solve(
        Function(3, rough),
        Dop853::default(),
        &Damped::START,
        20.0,
        tolerances(1e-12),
    );
    assert!(rough_free.evaluations <= free.evaluations * 11 / 10);
    assert!(rough_held.evaluations > 4 * rough_free.evaluations);
}

#[test]
fn backward_and_back() {
    fn there_and_back<M: Method<Any<'static>> + 'static>(method: M) {
        let settings = Settings::tolerances(1e-11, 1e-12);
        let mut run = begin(Damped, method, 0.0, &Damped::START, settings).expect("good settings");
        assert!(distance(&finish(&mut run, 5.0), &Damped::exact(5.0)) < 1e-9);
        assert!(distance(&finish(&mut run, -2.0), &Damped::exact(-2.0)) < 1e-9);
        let (from, to) = run.last_step();
        assert!(from > to);
        let mut y = [0.0; 3];
        run.interpolate(0.5 * (from + to), &mut y).expect("inside");
        assert!(distance(&y, &Damped::exact(0.5 * (from + to))) < 1e-9);
    }
    for (_, method) in adaptive() {
        there_and_back(method);
    }
}

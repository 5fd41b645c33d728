//! The Rosenbrock method: order, stiff problems, algebraic equations, work.

use linkdyn_integrators::{Equations, Form, Integration, IntegrationError, Rodas, Settings, SettingsError, Statistics};

use crate::benchmark_04_pendulum_index3::{Pendulum, exact};
use crate::benchmark_05_standard_odes::digits;
use crate::problems::{Damped, Function, distance, solve};
use crate::radau::prothero_robinson;
use crate::standard_odes::{HIRES, ROBERTSON, Standard, VAN_DER_POL};

/// Half the step, a 32nd of the error, on a problem whose right-hand side depends on time too.
#[test]
fn order() {
    let run = |h: f64| {
        let forced = Function(2, |t: f64, y: &[f64], dy: &mut [f64]| {
            (dy[0], dy[1]) = (y[1], -y[0] * y[0] * y[0] + (2.0 * t).cos());
            Ok(())
        });
        let settings = Settings {
            first_step: Some(h),
            max_step: h,
            ..Settings::tolerances(0.1, 0.1)
        };
        solve(forced, Rodas::default(), &[1.0, 0.0], 5.0, settings).0
    };
    let best = run(0.002);
    for h in [0.05, 0.025] {
        let order = (distance(&run(h), &best) / distance(&run(0.5 * h), &best)).log2();
        assert!((4.6..5.4).contains(&order), "{h}: {order}");
    }
}

/// Between the steps the error is no larger than at their ends, or of order 4.
#[test]
fn interpolation() {
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let settings = Settings::tolerances(tolerance, tolerance);
        let mut run = Integration::new(Damped, Rodas::default(), 0.0, &Damped::START, settings).expect("good settings");
        let (mut y, mut worst) = ([0.0; 3], 0.0_f64);
        while run.state().0 < 10.0 {
            run.advance(10.0).expect("smooth");
            let (from, to) = run.last_step();
            for theta in [0.2, 0.5, 0.8] {
                let t = from + theta * (to - from);
                run.interpolate(t, &mut y).expect("inside the step");
                worst = worst.max(distance(&y, &Damped::exact(t)));
            }
        }
        assert!(worst < 10.0 * tolerance, "{tolerance:e}: {worst:e}");
    }
}

#[test]
fn steps_follow_the_slow_solution() {
    for (tolerance, most) in [(1e-3, 60), (1e-5, 110), (1e-7, 250)] {
        let settings = Settings::tolerances(tolerance, tolerance);
        let (y, found) = solve(Function(1, prothero_robinson), Rodas::default(), &[1.5], 10.0, settings);
        let error = (y[0] - 10.0_f64.cos()).abs();
        assert!(error < tolerance, "{tolerance:e}: {error:e}");
        assert!(found.accepted < most, "{tolerance:e}: {found:?}");
    }
}

/// Benchmark 05-standard-odes: at each relative tolerance at least so many digits, at most so many evaluations.
#[test]
fn standard_problems() {
    let check = |problem: &Standard, expected: [(f64, f64, u64); 4]| {
        for (relative, least, most) in expected {
            let (digits, found) = digits(problem, Rodas::default(), relative);
            assert!(digits >= least, "{relative:e}: {digits} digits");
            assert!(found.evaluations <= most, "{relative:e}: {found:?}");
        }
    };
    let hires = [
        (1e-4, 3.4, 840),
        (1e-6, 4.8, 2050),
        (1e-8, 7.3, 6600),
        (1e-10, 10.4, 23_000),
    ];
    check(&HIRES, hires);
    let van_der_pol = [
        (1e-4, 3.7, 2300),
        (1e-6, 5.5, 4700),
        (1e-8, 7.6, 11_000),
        (1e-10, 10.2, 31_500),
    ];
    check(&VAN_DER_POL, van_der_pol);
    let robertson = [
        (1e-4, 4.4, 1720),
        (1e-6, 5.5, 3550),
        (1e-8, 7.1, 8800),
        (1e-10, 8.9, 29_500),
    ];
    check(&ROBERTSON, robertson);
}

/// Benchmark 04-pendulum-index3 with multipliers of index 1: positions, rates and multiplier.
#[test]
fn index_1() {
    for (tolerance, bounds) in [(1e-6, 1e-4), (1e-8, 1e-6), (1e-10, 1e-8)] {
        let mut equations = Equations::new(Pendulum, Form::Index1);
        let y0 = equations.start(0.0, &[-1.0, 0.0], &[0.0, 0.0]).expect("consistent");
        let (y, _) = solve(
            equations,
            Rodas::default(),
            &y0,
            2.0,
            Settings::tolerances(tolerance, tolerance),
        );
        let expected = exact(2.0);
        for (found, expected) in y.iter().zip(expected) {
            assert!((found - expected).abs() < bounds, "{tolerance:e}: {y:?}, {expected:?}");
        }
    }
}

#[test]
fn higher_index_is_refused() {
    for form in [Form::Index2, Form::Stabilised, Form::Index3] {
        let mut equations = Equations::new(Pendulum, form);
        let y0 = equations.start(0.0, &[-1.0, 0.0], &[0.0, 0.0]).expect("consistent");
        let refused = Integration::new(equations, Rodas::default(), 0.0, &y0, Settings::default());
        let error = refused.err().expect("refused");
        assert!(
            matches!(error, IntegrationError::Settings(SettingsError::Method(_))),
            "{error}"
        );
        assert!(error.to_string().contains("index 1 only"), "{error}");
    }
}

/// What the work consists of: 8 evaluations an accepted step, one at its end being the first of the next, 7 for a rejected one, one for
/// ∂f/∂t and one a component for df/dy.
#[test]
fn work() {
    let counters = |s: Statistics| {
        [
            s.evaluations,
            s.jacobian_evaluations,
            s.jacobians,
            s.factorisations,
            s.accepted,
            s.rejected,
        ]
    };
    let settings = Settings {
        first_step: Some(1e-3),
        ..Settings::tolerances(1e-6, 1e-6)
    };
    let found = solve(Damped, Rodas::default(), &Damped::START, 10.0, settings).1;
    assert_eq!(found.jacobian_evaluations, 4 * found.accepted);
    assert_eq!(found.evaluations, 1 + (8 + 4) * found.accepted + 7 * found.rejected);
    assert_eq!(found.factorisations, found.accepted + found.rejected);
    assert_eq!(counters(found), [361, 120, 30, 30, 30, 0]);
    let found = digits(&HIRES, Rodas::default(), 1e-6).1;
    assert_eq!(counters(found), [2027, 1017, 113, 128, 113, 15]);
}

/// Where f is not finite just where ∂f/∂t is to be found, a shorter step is tried.
#[test]
fn a_rate_of_f_that_is_not_finite_is_found_nearer() {
    let hole = |t: f64, _: &[f64], dy: &mut [f64]| {
        dy[0] = if (1e-5..2e-5).contains(&t) { f64::NAN } else { t };
        Ok(())
    };
    let settings = Settings {
        first_step: Some(0.75),
        ..Settings::tolerances(1e-8, 1e-8)
    };
    let (y, found) = solve(Function(1, hole), Rodas::default(), &[0.0], 1.0, settings);
    assert!((y[0] - 0.5).abs() < 1e-9, "{y:?}");
    assert_eq!(found.retries, 1);
}

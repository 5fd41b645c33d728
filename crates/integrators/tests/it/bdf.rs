//! Backward differentiation: its orders, stability, linear algebra and failures.

use linkdyn_integrators::{
    Bdf, EvalError, Integration, IntegrationError, Method, Ode, Progress, SecondOrder, Settings, SettingsError,
    Statistics,
};

use crate::problems::{Counting, Damped, Function, Kink, Pleiades, distance, finish, solve};
use crate::radau::{Chain, Given, Told, prothero_robinson, relative_distance};

/// Largest error in and between the steps, and the steps made.
fn run<P: Ode>(
    problem: P,
    method: Bdf,
    y0: &[f64],
    end: f64,
    settings: Settings,
    exact: impl Fn(f64) -> Vec<f64>,
) -> (f64, Statistics) {
    let mut run = Integration::new(problem, method, 0.0, y0, settings).expect("good settings");
    let (mut y, mut worst) = (y0.to_vec(), 0.0_f64);
    loop {
        let progress = run.advance(end).expect("the run succeeds");
        let (from, to) = run.last_step();
        worst = worst.max(distance(run.state().1, &exact(to)));
        for theta in [0.1, 0.5, 0.9] {
            let t = from + theta * (to - from);
            run.interpolate(t, &mut y).expect("inside the step");
            worst = worst.max(distance(&y, &exact(t)));
        }
        if matches!(progress, Progress::Done { .. }) {
            return (worst, run.statistics());
        }
    }
}

/// With a highest order k, ten times as many steps buy k digits, also between the steps.
#[test]
fn orders() {
    for (k, tolerances) in [
        (1, [1e-4, 1e-6]),
        (2, [1e-6, 1e-9]),
        (3, [1e-6, 1e-10]),
        (4, [1e-7, 1e-11]),
        (5, [1e-7, 1e-11]),
    ] {
        let [rough, fine] = tolerances.map(|tolerance| {
            let settings = Settings::tolerances(tolerance, tolerance);
            let exact = |t| Damped::exact(t).to_vec();
            run(
                Damped,
                Bdf::default().with_max_order(k),
                &Damped::START,
                10.0,
                settings,
                exact,
            )
        });
        let steps = (fine.1.accepted as f64 / rough.1.accepted as f64).ln();
        let order = (rough.0 / fine.0).ln() / steps;
        assert!((order - k as f64).abs() < 0.35, "order {order}, expected {k}");
    }
}

#[test]
fn highest_orders_that_do_not_exist() {
    for order in [0, 6, usize::MAX] {
        let method = Bdf::default().with_max_order(order);
        let refused = Integration::new(Damped, method, 0.0, &Damped::START, Settings::default());
        let error = refused.err().expect("refused");
        assert!(
            matches!(error, IntegrationError::Settings(SettingsError::Method(_))),
            "{error}"
        );
        assert!(error.to_string().contains("order"));
    }
    let told = Told {
        problem: Kink,
        pairs: 2,
        quadratures: 0,
    };
    assert!(Integration::new(told, Bdf::default(), 0.0, &Kink::START, Settings::default()).is_err());
}

/// Stiff decay to a slow solution: steps follow the slow solution, errors the tolerance.
#[test]
fn steps_follow_the_slow_solution() {
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9] {
        let settings = Settings::tolerances(tolerance, tolerance);
        let problem = Function(1, prothero_robinson);
        let (worst, statistics) = run(problem, Bdf::default(), &[1.5], 10.0, settings, |t| {
            vec![t.cos() + 0.5 * (-1e6 * t).exp()]
        });
        assert!(worst < 10.0 * tolerance, "{tolerance:e}: {worst:e}");
        assert!(statistics.accepted < 600, "{tolerance:e}: {statistics:?}");
    }
}

/// x'' = −ω² (x − sin t) − 2 d (x' − cos t) − sin t, ω = 1000: a vibration that is hardly damped about the solution sin t.
fn vibration(d: f64) -> impl SecondOrder {
    Function(2, move |t: f64, y: &[f64], dy: &mut [f64]| {
        let (x, v) = (y[0] - t.sin(), y[1] - t.cos());
        (dy[0], dy[1]) = (y[1], -1e6 * x - 2.0 * d * v - t.sin());
        Ok(())
    })
}

/// The order falls where the formulas are not stable, and the steps do not follow the vibration: that would take 20 000 of them.
#[test]
fn stiff_vibrations_are_passed_over() {
    for (tolerance, most) in [(1e-4, 300), (1e-5, 500), (1e-6, 800)] {
        let settings = Settings::tolerances(tolerance, tolerance);
        let (y, statistics) = solve(vibration(0.5), Bdf::default(), &[0.0, 1.0], 20.0, settings);
        let error = distance(&y, &[20.0_f64.sin(), 20.0_f64.cos()]);
        assert!(error < 3.0 * tolerance, "{tolerance:e}: {error:e}");
        assert!(statistics.accepted < most, "{tolerance:e}: {statistics:?}");
    }
}

fn chain(pairs: usize, quadratures: usize, settings: &Settings, method: Bdf) -> (Vec<f64>, Statistics) {
    let problem = Told {
        problem: Chain,
        pairs,
        quadratures,
    };
    solve(problem, method, &Chain::START, 1.0, settings.clone())
}

/// Elimination of the positions, and quadratures apart from Newton's iteration, change the work only.
#[test]
fn structure_changes_nothing_but_the_work() {
    let settings = Settings::tolerances(1e-8, 1e-8);
    let (exact, _) = chain(0, 0, &Settings::tolerances(1e-12, 1e-12), Bdf::default());
    let (plain, all) = chain(0, 0, &settings, Bdf::default());
    assert!(relative_distance(&plain, &exact) < 1e-6);
    for (pairs, quadratures) in [(3, 0), (3, 2), (3, 1), (0, 2)] {
        let (y, told) = chain(pairs, quadratures, &settings, Bdf::default());
        let distance = relative_distance(&y, &exact);
        assert!(distance < 1e-6, "{pairs} {quadratures}: {distance:e}");
        assert_eq!(told.jacobian_evaluations, (9 - quadratures as u64) * told.jacobians);
        assert!(
            told.accepted.abs_diff(all.accepted) <= all.accepted / 10,
            "{told:?} {all:?}"
        );
    }
}

/// Quadratures are as accurate as what they integrate, also if nothing controls them; and if there is nothing else.
#[test]
fn quadratures() {
    let told = Told {
        problem: Damped,
        pairs: 1,
        quadratures: 1,
    };
    let settings = Settings::tolerances(1e-9, vec![1e-9, 1e-9, f64::INFINITY]);
    let (y, _) = solve(told, Bdf::default(), &Damped::START, 20.0, settings);
    let error = distance(&y, &Damped::exact(20.0));
    assert!(error < 1e-7, "{error:e}");
    let area = Told {
        problem: Function(2, |t: f64, _: &[f64], dy: &mut [f64]| {
            (dy[0], dy[1]) = (t.cos(), 3.0 * t * t);
            Ok(())
        }),
        pairs: 0,
        quadratures: 2,
    };
    let (y, statistics) = solve(area, Bdf::default(), &[0.0, 0.0], 2.0, Settings::tolerances(1e-8, 1e-8));
    assert!(distance(&y, &[2.0_f64.sin(), 8.0]) < 1e-6);
    assert_eq!(statistics.jacobian_evaluations, 0);
    let nothing = Function(0, |_: f64, _: &[f64], _: &mut [f64]| Ok(()));
    let (y, _) = solve(nothing, Bdf::default(), &[], 1.0, Settings::default());
    assert!(y.is_empty());
}

#[test]
fn a_given_jacobian() {
    let settings = Settings::tolerances(1e-9, 1e-9);
    let (y, given) = solve(Given(1.0), Bdf::default(), &Kink::START, 1.5, settings.clone());
    let (_, differences) = solve(Kink, Bdf::default(), &Kink::START, 1.5, settings.clone());
    assert_eq!(given.jacobian_evaluations, 0);
    assert_eq!(differences.jacobian_evaluations, 3 * differences.jacobians);
    assert!(distance(&y, &Kink::exact(1.5)) < 1e-7);
    // A wrong one costs work, not digits.
    let (y, wrong) = solve(Given(-3.0), Bdf::default(), &Kink::START, 1.5, settings);
    assert!(distance(&y, &Kink::exact(1.5)) < 1e-7);
    assert!(wrong.iterations > given.iterations, "{wrong:?} {given:?}");
}

#[test]
fn counters() {
    let mut problem = Counting::new(Pleiades);
    problem.claim = true;
    let settings = Settings::tolerances(1e-6, 1e-6);
    let mut run = Integration::new(&mut problem, Bdf::default(), 0.0, &Pleiades::START, settings).expect("good");
    finish(&mut run, 3.0);
    let s = run.statistics();
    assert_eq!(
        (s.evaluations, s.projections),
        (problem.evaluations, problem.projections)
    );
    assert_eq!(s.jacobian_evaluations, 28 * s.jacobians);
    assert_eq!(s.dense_evaluations, 0);
    // The start and the choice of its step; one for each iteration, where f at the prediction serves two of them if the first df/dy
    // fails.
    let rest = s.evaluations - s.jacobian_evaluations - 2;
    assert!(
        rest <= s.iterations && s.iterations - rest <= s.jacobians + s.rejected,
        "{s:?}"
    );
    assert!(s.factorisations >= s.jacobians && s.divergences <= s.rejected);
    assert!(s.iterations < 2 * (s.accepted + s.rejected), "{s:?}");
}

/// A kink in the state, where the problem becomes stiff, and a jump in time: steps are shortened, and the run goes on.
#[test]
fn kinks_shorten_the_step() {
    let switch = Function(1, |_: f64, y: &[f64], dy: &mut [f64]| {
        dy[0] = if y[0] < 0.5 { 1.0 } else { 1.0 - 1e5 * (y[0] - 0.5) };
        Ok(())
    });
    let settings = Settings {
        first_step: Some(0.4),
        ..Settings::tolerances(1e-6, 1e-9)
    };
    let (y, statistics) = solve(switch, Bdf::default(), &[0.0], 1.0, settings);
    assert!((y[0] - 0.50001).abs() < 1e-6, "{}", y[0]);
    assert!(statistics.rejected > 0 && statistics.retries == 0, "{statistics:?}");
    assert!(statistics.accepted < 150, "{statistics:?}");
    let turn = Function(1, |t: f64, y: &[f64], dy: &mut [f64]| {
        dy[0] = -y[0] + if t < 1.0 { 0.0 } else { 1.0 };
        Ok(())
    });
    let (y, statistics) = solve(turn, Bdf::default(), &[1.0], 2.0, Settings::tolerances(1e-7, 1e-7));
    let exact = 1.0 - (1.0 - f64::exp(-1.0)) * f64::exp(-1.0);
    assert!((y[0] - exact).abs() < 2e-6, "{:e}", y[0] - exact);
    assert!(statistics.accepted < 250, "{statistics:?}");
}

#[test]
fn a_jacobian_that_is_not_finite() {
    let infinite = Function(1, |t: f64, y: &[f64], dy: &mut [f64]| {
        // Finite along the solution from 1 only.
        dy[0] = if y[0] == 1.0 + t { 1.0 } else { f64::NAN };
        Ok(())
    });
    let mut run = Integration::new(infinite, Bdf::default(), 0.0, &[1.0], Settings::default()).expect("good");
    run.advance(1.0).expect_err("no matrix");
    assert_eq!(run.statistics().accepted, 0);
    struct Bad;
    impl Ode for Bad {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
            dy[0] = -y[0];
            Ok(())
        }
        fn jacobian(&mut self, _t: f64, _y: &[f64], matrix: &mut [f64]) -> Result<bool, EvalError> {
            matrix[0] = f64::NAN;
            Ok(true)
        }
    }
    let mut run = Integration::new(Bad, Bdf::default(), 0.0, &[1.0], Settings::default()).expect("good");
    let error = run.advance(1.0).expect_err("no factors");
    assert!(matches!(error, IntegrationError::StepTooSmall { .. }), "{error}");
}

/// The polynomial of a step meets both of its ends, projected states included.
#[test]
fn interpolation_meets_both_ends() {
    struct Circle;
    impl Ode for Circle {
        fn dim(&self) -> usize {
            2
        }
        fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
            (dy[0], dy[1]) = (-y[1], y[0]);
            Ok(())
        }
        fn project(&mut self, _t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
            let length = y[0].hypot(y[1]);
            y.iter_mut().for_each(|y| *y /= length);
            Ok(true)
        }
    }
    let settings = Settings::tolerances(1e-4, 1e-4);
    let mut run = Integration::new(Circle, Bdf::default(), 0.0, &[1.0, 0.0], settings).expect("good settings");
    let (mut before, mut y) = (vec![1.0, 0.0], [0.0; 2]);
    while !matches!(run.advance(20.0).expect("smooth"), Progress::Done { .. }) {
        let (from, to) = run.last_step();
        // The next number but one: the driver knows the ends themselves.
        run.interpolate(from + 1e-12 * (to - from), &mut y).expect("inside");
        assert!(distance(&y, &before) < 1e-11, "{:e}", distance(&y, &before));
        before = run.state().1.to_vec();
        run.interpolate(to - 1e-12 * (to - from), &mut y).expect("inside");
        assert!(distance(&y, &before) < 1e-11);
    }
}

/// After a stop the order is 1 again and nothing of the past is left.
#[test]
fn stops_begin_anew() {
    fn order<M: Method<Damped>>(method: &M) -> u32 {
        method.order()
    }
    let settings = Settings::tolerances(1e-8, 1e-8);
    let run = Integration::new(Damped, Bdf::default(), 0.0, &Damped::START, settings).expect("good settings");
    let mut run = run.with_stops(&[5.0]).expect("finite");
    while !matches!(run.advance(10.0).expect("smooth"), Progress::Stop { .. }) {}
    assert!(order(run.method()) > 3);
    run.advance(10.0).expect("smooth");
    assert_eq!(order(run.method()), 1);
    let error = distance(&finish(&mut run, 10.0), &Damped::exact(10.0));
    assert!(error < 1e-6, "{error:e}");
}

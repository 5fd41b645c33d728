//! Stops, projection, and going on from another state.

use linkdyn_integrators::{
    Adams, Auto, Bdf, Corrector, Dop853, DormandPrince5, EvalError, Integration, Method, Newmark, Ode, Progress,
    Radau5, Rk4, Rodas, SecondOrder, Settings,
};

use crate::methods::adaptive;
use crate::problems::{Damped, Function, boxed, distance, finish};

/// y' = min(t, 1): y(3) = 2.5, and z' = z.
struct Ramp;

impl Ode for Ramp {
    fn dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        (dy[0], dy[1]) = (t.min(1.0), y[1]);
        Ok(())
    }
}

impl SecondOrder for Ramp {
    fn pairs(&self) -> usize {
        0
    }
}

#[test]
fn stops_are_hit_exactly() {
    fn check<M: Method<Ramp>>(method: M, tolerance: f64) {
        let run =
            Integration::new(Ramp, boxed(method), 0.0, &[0.0, 1.0], Settings::tolerances(1e-9, 1e-9)).expect("good");
        let stops = [2.0 / 3.0, 1.0, -4.0, 0.1 + 0.2, 3.0, 7.0];
        let mut run = run.with_stops(&stops).expect("finite");
        let mut seen = Vec::new();
        loop {
            match run.advance(3.0).expect("smooth between stops") {
                Progress::Step { .. } | Progress::Event { .. } => {}
                Progress::Stop { t } => seen.push(t),
                Progress::Done { t } => {
                    seen.push(t);
                    break;
                }
            }
            assert!(seen.len() < 5);
        }
        assert_eq!(seen, [0.1 + 0.2, 2.0 / 3.0, 1.0, 3.0]);
        assert!(distance(run.state().1, &[2.5, 3.0_f64.exp()]) < tolerance);
        // And backward.
        let mut seen = Vec::new();
        while let Progress::Step { .. } | Progress::Stop { .. } = {
            let progress = run.advance(0.5).expect("smooth between stops");
            if let Progress::Stop { t } = progress {
                seen.push(t);
            }
            progress
        } {}
        assert_eq!(seen, [1.0, 2.0 / 3.0]);
        assert!(distance(run.state().1, &[0.125, 0.5_f64.exp()]) < tolerance);
    }
    check(Rk4::new(0.01), 1e-6);
    check(Newmark::new(0.001, Corrector::Times(3)), 1e-4);
    for (_, method) in adaptive() {
        check(method, 1e-6);
    }
    check(Radau5::fixed(0.05), 1e-6);
}

/// z' = z, evaluated only between these bounds.
struct Watched {
    bounds: [f64; 2],
}

impl Ode for Watched {
    fn dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        let [from, to] = self.bounds;
        assert!(from <= t && t <= to, "f was asked for at {t}, outside {from} to {to}");
        dy[0] = y[0];
        Ok(())
    }
}

impl SecondOrder for Watched {
    fn pairs(&self) -> usize {
        0
    }
}

/// Stops at the start and at the end, before and beyond them, twice the same, and so close that no number lies between. None is
/// missed, and f is never asked for beyond the next one, not even for the choice of the first step.
#[test]
fn stops_of_all_kinds() {
    fn check<M: Method<Watched>>(method: impl Fn() -> M, tolerance: f64, dear: u64) {
        let (a, b, c) = (1.0_f64.next_up(), 1.5, 1.5_f64.next_up());
        let inner = [a, b, c, c.next_up(), 1.5 + 1e-13, 2.0];
        for backward in [false, true] {
            let (start, end) = if backward { (2.25, 1.0) } else { (1.0, 2.25) };
            let mut expected = inner.to_vec();
            if backward {
                expected.reverse();
            }
            expected.push(end);
            let watched = Watched { bounds: [0.0, 0.0] };
            let settings = Settings::tolerances(1e-9, 1e-9);
            let run = Integration::new(watched, boxed(method()), start, &[1.0], settings).expect("good settings");
            let run = run.with_stops(&[2.25, -4.0, 2.0, 7.0, 1.0]).expect("finite");
            let mut run = run.with_stops(&inner).expect("finite");
            let mut seen = Vec::new();
            while seen.len() < expected.len() {
                let (from, to) = (seen.last().copied().unwrap_or(start), expected[seen.len()]);
                run.problem_mut().bounds = [f64::min(from, to), f64::max(from, to)];
                match run.advance(end).expect("smooth") {
                    Progress::Step { .. } | Progress::Event { .. } => {}
                    Progress::Stop { t } => {
                        assert!(t != end);
                        seen.push(t);
                    }
                    Progress::Done { t } => {
                        seen.push(t);
                        break;
                    }
                }
            }
            assert_eq!(seen, expected);
            let (t, y) = run.state();
            assert_eq!(t, end);
            assert!((y[0] - f64::exp(end - start)).abs() < tolerance);
            let evaluations = run.statistics().evaluations;
            assert!(evaluations < dear, "{evaluations}");
        }
    }
    check(|| Rk4::new(0.01), 1e-8, 800);
    check(|| Newmark::new(0.001, Corrector::Times(3)), 1e-5, 6000);
    check(DormandPrince5::default, 1e-8, 800);
    check(Dop853::default, 1e-8, 800);
    check(Adams::default, 1e-8, 800);
    check(Radau5::default, 1e-8, 2000);
    check(Bdf::default, 1e-7, 2000);
    check(Auto::default, 1e-8, 2000);
    check(Rodas::default, 1e-8, 2000);
}

/// t + h may round to beyond the stop; f must not be asked for there.
#[test]
fn no_evaluation_beyond_the_stop_by_rounding() {
    for i in 0..500 {
        let (start, stop) = (-1.0 + 0.0071 * f64::from(i), 0.1 + 0.013 * f64::from(i));
        for (from, to) in [(start, stop), (stop, start)] {
            let bounds = [start.min(stop), start.max(stop)];
            let settings = Settings::default();
            let mut run = Integration::new(Watched { bounds }, Adams::default(), from, &[1.0], settings).expect("good");
            finish(&mut run, to);
            let mut run = Integration::new(Watched { bounds }, Rk4::new(3.0), from, &[1.0], Settings::default());
            finish(run.as_mut().expect("good"), to);
        }
    }
}

#[test]
fn the_longest_step_is_not_stretched() {
    let settings = Settings {
        max_step: 0.1,
        ..Settings::default()
    };
    let mut run = Integration::new(Damped, Dop853::default(), 0.0, &Damped::START, settings).expect("good settings");
    loop {
        let progress = run.advance(2.0 + 0.1005).expect("smooth");
        let (from, to) = run.last_step();
        assert!(to - from <= 0.1 * (1.0 + 1e-8));
        if matches!(progress, Progress::Done { .. }) {
            break;
        }
    }
    // Nor does rounding leave a splinter at the end.
    let settings = Settings {
        max_step: 0.1,
        first_step: Some(0.1),
        ..Settings::default()
    };
    let mut run = Integration::new(Damped, Dop853::default(), 0.0, &Damped::START, settings).expect("good settings");
    finish(&mut run, 1.0);
    assert_eq!(run.statistics().accepted, 10);
}

#[test]
fn a_stop_at_a_kink_saves_work() {
    let kinked = || {
        Function(1, |t: f64, _: &[f64], dy: &mut [f64]| {
            dy[0] = (t - 1.0).abs() + t.sin();
            Ok(())
        })
    };
    let work = |stops: &[f64]| {
        let settings = Settings::tolerances(1e-9, 1e-9);
        let run = Integration::new(kinked(), Dop853::default(), 0.0, &[0.0], settings).expect("good settings");
        let mut run = run.with_stops(stops).expect("finite");
        finish(&mut run, 2.0);
        run.statistics().evaluations
    };
    assert!(2 * work(&[1.0]) < work(&[]));
}

/// The problem is switched at the stop; the step before must not see it, the step after must.
#[test]
fn a_problem_switched_at_a_stop() {
    struct Switched(f64);
    impl Ode for Switched {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, _: f64, _: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
            dy[0] = self.0;
            Ok(())
        }
    }
    fn check<M: Method<Switched>>(method: M) {
        let run =
            Integration::new(Switched(1.0), boxed(method), 0.0, &[0.0], Settings::default()).expect("good settings");
        let mut run = run.with_stops(&[1.0]).expect("finite");
        loop {
            match run.advance(2.0).expect("constant") {
                Progress::Stop { .. } => run.problem_mut().0 = -3.0,
                Progress::Step { .. } | Progress::Event { .. } => {}
                Progress::Done { .. } => break,
            }
        }
        assert!((run.state().1[0] + 2.0).abs() < 1e-12, "{:?}", run.state());
    }
    check(Rk4::new(0.3));
    for (_, method) in adaptive() {
        check(method);
    }
}

/// A point on the unit circle whose right-hand side drifts off it.
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

#[test]
fn projection_keeps_the_invariant_at_every_step() {
    fn check<M: Method<Circle>>(method: M) {
        let settings = Settings::tolerances(1e-7, 1e-7);
        let mut run = Integration::new(Circle, boxed(method), 0.0, &[1.0, 0.0], settings).expect("good settings");
        while !matches!(run.advance(50.0).expect("smooth"), Progress::Done { .. }) {
            let y = run.state().1;
            assert!((y[0].hypot(y[1]) - 1.0).abs() < 1e-15);
        }
        assert!(distance(run.state().1, &[50.0_f64.cos(), 50.0_f64.sin()]) < 2e-5);
        let (from, to) = run.last_step();
        let (t, mut y) = (0.5 * (from + to), [0.0; 2]);
        run.interpolate(t, &mut y).expect("inside");
        assert!(run.problem_mut().project(t, &mut y).expect("never fails"));
        assert!((y[0].hypot(y[1]) - 1.0).abs() < 1e-15);
    }
    check(Rk4::new(0.02));
    for (_, method) in adaptive() {
        check(method);
    }
}

#[test]
fn restart_from_another_state() {
    let settings = Settings::tolerances(1e-10, 1e-10);
    let mut run = Integration::new(Damped, Adams::default(), 0.0, &Damped::START, settings).expect("good settings");
    finish(&mut run, 3.0);
    run.restart(0.0, &Damped::START).expect("good state");
    assert_eq!(run.last_step(), (0.0, 0.0));
    assert!(distance(&finish(&mut run, 2.0), &Damped::exact(2.0)) < 1e-8);
    assert!(run.restart(0.0, &[1.0]).is_err());
    assert!(run.restart(f64::NAN, &Damped::START).is_err());
    assert!(run.restart(0.0, &[1.0, f64::INFINITY, 0.0]).is_err());
}

#[test]
fn problems_and_methods_as_trait_objects() {
    let mut damped = Damped;
    let problem: &mut dyn Ode = &mut damped;
    let mut run = Integration::new(problem, Dop853::default(), 0.0, &Damped::START, Settings::default()).expect("good");
    finish(&mut run, 1.0);
    let boxed: Box<dyn Ode> = Box::new(Damped);
    let mut run = Integration::new(boxed, Adams::default(), 0.0, &Damped::START, Settings::default()).expect("good");
    finish(&mut run, 1.0);
    for (_, method) in adaptive() {
        let mut run = Integration::new(Damped, method, 0.0, &Damped::START, Settings::default()).expect("good");
        assert!(distance(&finish(&mut run, 1.0), &Damped::exact(1.0)) < 1e-4);
    }
}

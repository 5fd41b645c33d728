//! The state at an event, on both sides of it, and what does not depend on who looks.

use super::*;
use crate::problems::Any;
use crate::problems::{Counting, finish};

#[test]
fn before_and_after() {
    fn check<M: Method<Any<'static>> + 'static, B: Problem + 'static>(ball: B, method: M) {
        let mut run = start(ball, method, 0.0, &[0.5, 0.0], 1e-9);
        while !matches!(run.advance(1.5).expect("smooth"), Progress::Event { .. }) {}
        let (t, y) = run.state();
        assert!((y[1] - 0.5).abs() < 1e-13, "after the event: {y:?}");
        let mut before = [0.0; 2];
        run.interpolate(t, &mut before).expect("the end of the step");
        assert!((before[1] + 1.0).abs() < 1e-13 && before[0].abs() < 1e-15, "{before:?}");
        let (from, to) = run.last_step();
        assert_eq!(to, t);
        for part in [0.0, 0.3, 0.9, 1.0 - 1e-12] {
            let t = from + part * (to - from);
            run.interpolate(t, &mut before).expect("inside");
            assert!((before[0] - 0.5 * (1.0 - t * t)).abs() < 1e-14 && (before[1] + t).abs() < 1e-14);
        }
        assert!(run.interpolate(to + 1e-9, &mut before).is_err());
        run.advance(1.5).expect("smooth");
        assert_eq!(run.fired(), [false]);
        let (from, to) = run.last_step();
        assert_eq!(from, t);
        for part in [0.0, 0.3, 1.0] {
            let s = part * (to - from);
            run.interpolate(from + s, &mut before).expect("inside");
            assert!((before[0] - 0.5 * s * (1.0 - s)).abs() < 1e-13 && (before[1] - 0.5 + s).abs() < 1e-13);
        }
    }
    check(ball(0.5), Rk4::new(0.03));
    check(ball(0.5), Newmark::new(0.03, Corrector::Times(2)));
    check(ball(0.5), DormandPrince5::default());
    check(ball(0.5), Dop853::default());
    check(ball(0.5), Adams::default());
    check(ball(0.5), Radau5::default());
}

/// The right-hand side is another after the event; what is interpolated before it must not notice.
#[test]
fn interpolation_when_the_problem_has_changed() {
    let leap = || Switched {
        dim: 2,
        roots: 1,
        pairs: 0,
        mode: 1.0,
        rhs: |mode: f64, _, y: &[f64], dy: &mut [f64]| (dy[0], dy[1]) = (mode * y[1], -mode * y[0]),
        root: |mode: f64, _, y: &[f64], g: &mut [f64]| {
            g[0] = if mode == 1.0 { y[0] - 0.2 } else { 1.0 };
            Ok(())
        },
        change: |mode: &mut f64, _, _: &mut [f64], _: &[bool]| {
            *mode = 1e3;
            Ok(())
        },
    };
    fn check<P: Problem + 'static, M: Method<Any<'static>> + 'static>(leap: P, method: M, tolerance: f64) {
        let mut run = start(leap, method, 0.0, &[1.0, 0.0], 1e-10);
        while !matches!(run.advance(2.0).expect("smooth"), Progress::Event { .. }) {}
        let (from, to) = run.last_step();
        assert!((to - 0.2_f64.acos()).abs() < tolerance);
        let mut y = [0.0; 2];
        for i in 0..=10 {
            let t = from + (to - from) * f64::from(i) / 10.0;
            run.interpolate(t, &mut y).expect("inside");
            assert!((y[0] - t.cos()).abs() < tolerance && (y[1] + t.sin()).abs() < tolerance);
        }
    }
    check(leap(), Rk4::new(0.01), 1e-9);
    check(leap(), DormandPrince5::default(), 1e-8);
    check(leap(), Dop853::default(), 1e-8);
    check(leap(), Adams::default(), 1e-8);
    check(leap(), Radau5::default(), 1e-8);
    check(leap(), Bdf::default(), 1e-8);
}

/// Steps and events are the same to the last bit whatever is interpolated.
#[test]
fn output_changes_nothing() {
    fn path<P: Problem + 'static, M: Method<Any<'static>> + 'static>(
        problem: P,
        method: M,
        outputs: usize,
    ) -> Vec<(u64, u64, u64)> {
        let mut run = start(problem, method, 0.0, &[0.5, 0.0], 1e-7);
        let (mut path, mut y) = (Vec::new(), [0.0; 2]);
        loop {
            let progress = run.advance(2.9).expect("no accumulation yet");
            let (from, to) = run.last_step();
            for i in 0..outputs {
                let t = from + (to - from) * i as f64 / outputs as f64;
                run.interpolate(t, &mut y).expect("inside");
            }
            let (t, y) = run.state();
            path.push((t.to_bits(), y[0].to_bits(), y[1].to_bits()));
            if matches!(progress, Progress::Done { .. }) {
                return path;
            }
        }
    }
    fn check<M: Method<Any<'static>> + 'static, B: Problem + Clone + 'static>(ball: B, method: impl Fn() -> M) {
        let bare = path(ball.clone(), method(), 0);
        for outputs in [1, 2, 7] {
            assert!(path(ball.clone(), method(), outputs) == bare);
        }
    }
    check(ball(0.5), || Rk4::new(0.01));
    check(ball(0.5), DormandPrince5::default);
    check(ball(0.5), Dop853::default);
    check(ball(0.5), Adams::default);
    check(ball(0.5), Radau5::default);
    check(ball(0.5), Bdf::default);
}

/// Root functions that never fire leave the steps as they are, to the last bit.
#[test]
fn steps_without_events_are_the_same() {
    fn check<M: for<'a> Method<&'a mut Counting<crate::problems::Pleiades>>>(method: impl Fn() -> M) {
        let ends = [0, 2].map(|roots| {
            let mut problem = Counting::new(crate::problems::Pleiades);
            (problem.roots, problem.level) = (roots, -100.0);
            let y0 = crate::problems::Pleiades::START;
            let mut run = Integration::new(&mut problem, method(), 0.0, &y0, Settings::default()).expect("good");
            finish(&mut run, 3.0)
        });
        assert_eq!(ends[0], ends[1]);
    }
    check(DormandPrince5::default);
    check(Dop853::default);
    check(Adams::default);
    check(Radau5::default);
    check(Bdf::default);
    // Not `Auto`, which is stricter where there may be events.
    check(Rodas::default);
}

/// All calls are counted, and every attempt is accounted for.
#[test]
fn counters() {
    fn check<M: for<'a> Method<&'a mut Counting<crate::problems::Damped>>>(method: M, dense_per_event: u64) {
        let mut problem = Counting::new(crate::problems::Damped);
        problem.roots = 2;
        let y0 = crate::problems::Damped::START;
        let mut run = Integration::new(&mut problem, method, 0.0, &y0, Settings::default()).expect("good");
        let (mut steps, mut found) = (0, 0);
        loop {
            match run.advance(20.0).expect("smooth") {
                Progress::Done { .. } => break,
                Progress::Event { .. } => found += 1,
                _ => {}
            }
            steps += 1;
        }
        let statistics = run.statistics();
        assert_eq!(statistics.accepted, steps + 1);
        assert_eq!((statistics.events, problem.events), (found, found));
        assert_eq!(found, 6);
        assert_eq!(statistics.evaluations, problem.evaluations);
        assert_eq!(statistics.root_evaluations, problem.root_evaluations);
        assert_eq!(statistics.projections, problem.projections);
        assert!((found..=3 * found).contains(&statistics.relocations), "{statistics:?}");
        assert!(statistics.dense_evaluations >= dense_per_event * found);
        let beyond = statistics.root_evaluations - 2 * (statistics.accepted + statistics.relocations);
        assert!(beyond <= 25 * found, "{statistics:?}");
    }
    check(Rk4::new(0.01), 0);
    check(DormandPrince5::default(), 0);
    check(Dop853::default(), 3);
    check(Adams::default(), 0);
    check(Radau5::default(), 0);
    check(Bdf::default(), 0);
    check(Auto::default(), 0);
    check(Rodas::default(), 0);
}

/// The state is on the invariants when it is changed.
#[test]
fn the_state_at_an_event_is_projected() {
    struct Circle;
    impl Ode for Circle {
        fn dim(&self) -> usize {
            2
        }
        fn rhs(&mut self, _: f64, y: &[f64], dy: &mut [f64]) -> Answer {
            (dy[0], dy[1]) = (-y[1], y[0]);
            Ok(())
        }
        fn project(&mut self, _: f64, y: &mut [f64]) -> Result<bool, EvalError> {
            let length = y[0].hypot(y[1]);
            y.iter_mut().for_each(|y| *y /= length);
            Ok(true)
        }
        fn roots(&self) -> usize {
            1
        }
        fn root(&mut self, _: f64, y: &[f64], g: &mut [f64]) -> Answer {
            g[0] = y[0];
            Ok(())
        }
        fn at_event(&mut self, _: f64, y: &mut [f64], _: &[bool]) -> Answer {
            assert!((y[0].hypot(y[1]) - 1.0).abs() < 1e-14);
            Ok(())
        }
    }

    impl SecondOrder for Circle {
        fn pairs(&self) -> usize {
            0
        }
    }
    fn check<M: Method<Any<'static>> + 'static>(method: M, tolerance: f64) {
        let found = times(&mut start(Circle, method, 0.0, &[1.0, 0.0], 1e-8), 20.0);
        let expected = [0.5, 2.5, 4.5].map(|turns| turns * std::f64::consts::PI);
        assert_close(&found, &expected, tolerance);
    }
    check(Rk4::new(0.05), 1e-5);
    check(DormandPrince5::default(), 1e-5);
    check(Dop853::default(), 1e-5);
    check(Adams::default(), 1e-5);
    check(Radau5::default(), 1e-5);
    check(Bdf::default(), 1e-5);
    check(Auto::default(), 1e-5);
    check(Rodas::default(), 1e-5);
}

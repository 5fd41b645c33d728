//! Output must not change the run.

use linkdyn_integrators::{
    Adams, Corrector, Dop853, Integration, IntegrationError, Method, Newmark, Progress, Rk4, SecondOrder, Settings,
};

use crate::methods::{adaptive, nth};
use crate::problems::{Any, Counting, Damped, Kink, Pleiades, begin, boxed, distance, finish};

/// All steps of a run there and back again, with stops; `outputs` places of output in each step.
fn path(
    problem: impl SecondOrder + 'static,
    method: impl Method<Any<'static>> + 'static,
    y0: &[f64],
    outputs: usize,
) -> Vec<(f64, Vec<u64>)> {
    let run = begin(problem, method, 0.0, y0, Settings::tolerances(1e-7, 1e-7)).expect("good settings");
    let mut run = run.with_stops(&[0.3, 0.7, 0.7_f64.next_up()]).expect("finite");
    let (mut path, mut y) = (Vec::new(), vec![0.0; y0.len()]);
    for end in [1.5, -0.5] {
        loop {
            let progress = run.advance(end).expect("smooth");
            let (from, to) = run.last_step();
            for i in 0..outputs {
                run.interpolate(from + (to - from) * i as f64 / outputs as f64, &mut y)
                    .expect("inside");
            }
            let (t, y) = run.state();
            path.push((t, y.iter().map(|y| y.to_bits()).collect()));
            if matches!(progress, Progress::Done { .. }) {
                break;
            }
        }
    }
    path
}

#[test]
fn the_path_is_the_same_to_the_last_bit() {
    fn check<P: SecondOrder + 'static, M: Method<Any<'static>> + 'static>(
        problem: fn() -> P,
        method: impl Fn() -> M,
        y0: &[f64],
    ) {
        let bare = path(problem(), method(), y0, 0);
        for outputs in [1, 2, 7] {
            assert!(path(problem(), method(), y0, outputs) == bare);
        }
    }
    check(|| Kink, || Rk4::new(0.01), &Kink::START);
    check(|| Kink, || Newmark::new(0.01, Corrector::Times(3)), &Kink::START);
    for k in 0..adaptive::<Kink>().len() {
        check(|| Kink, || nth(k), &Kink::START);
        // With refused steps.
        check(|| Pleiades, || nth(k), &Pleiades::START);
    }
}

#[test]
fn interpolation_is_continuous_from_step_to_step() {
    fn check<M: Method<Counting<Pleiades>>>(method: M) {
        let mut problem = Counting::new(Pleiades);
        problem.claim = true;
        let settings = Settings::tolerances(1e-6, 1e-6);
        let mut run = Integration::new(problem, boxed(method), 0.0, &Pleiades::START, settings).expect("good settings");
        let (mut near_end, mut near_start) = ([0.0; 28], [0.0; 28]);
        for _ in 0..15 {
            run.advance(3.0).expect("smooth");
            let (from, to) = run.last_step();
            let (_, end) = run.state();
            let end = end.to_vec();
            run.interpolate(to - 1e-9 * (to - from), &mut near_end).expect("inside");
            assert!(distance(&near_end, &end) < 1e-8);
            run.advance(3.0).expect("smooth");
            let (from, to) = run.last_step();
            run.interpolate(from + 1e-9 * (to - from), &mut near_start)
                .expect("inside");
            let gap = distance(&near_start, &end);
            assert!(gap < 1e-8, "{gap:e} at {from}, step {:e}", to - from);
        }
    }
    for (_, method) in adaptive() {
        check(method);
    }
}

#[test]
fn outside_the_step_is_an_error() {
    let mut run = Integration::new(Damped, Dop853::default(), 0.0, &Damped::START, Settings::default()).expect("good");
    let mut y = [0.0; 3];
    run.interpolate(0.0, &mut y).expect("the start is known");
    assert_eq!(y, Damped::START);
    assert!(matches!(
        run.interpolate(0.1, &mut y),
        Err(IntegrationError::OutsideStep { .. })
    ));
    finish(&mut run, 1.0);
    let (from, to) = run.last_step();
    for t in [from - 1e-3, to + 1e-3, f64::NAN] {
        assert!(matches!(
            run.interpolate(t, &mut y),
            Err(IntegrationError::OutsideStep { .. })
        ));
    }
}

#[test]
fn zero_length_run() {
    let mut run = Integration::new(Damped, Dop853::default(), 2.0, &Damped::START, Settings::default()).expect("good");
    assert_eq!(run.advance(2.0).expect("nothing to do"), Progress::Done { t: 2.0 });
    assert_eq!(run.state(), (2.0, &Damped::START[..]));
    assert_eq!(run.statistics().evaluations, 0);
}

/// The pieces of a run that is interrupted are as good as the whole.
#[test]
fn interrupted_runs() {
    let settings = Settings::tolerances(1e-10, 1e-10);
    let mut run = Integration::new(Damped, Adams::default(), 0.0, &Damped::START, settings).expect("good settings");
    for i in 1..=40 {
        let end = 0.25 * f64::from(i);
        assert!(distance(&finish(&mut run, end), &Damped::exact(end)) < 1e-8);
    }
}

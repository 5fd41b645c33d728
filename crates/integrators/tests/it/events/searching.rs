//! What is found within one step.

use super::*;
use crate::problems::Any;

/// One step of length 1, which polynomials of the fourth degree follow exactly.
fn one_step<P: Problem + 'static>(problem: P) -> (Vec<(f64, Vec<bool>)>, u64) {
    let mut run = start(problem, DormandPrince5::fixed(10.0), 0.0, &[0.0], 1e-6);
    let found = events(&mut run, 1.0);
    (found, run.statistics().accepted)
}

#[test]
fn two_at_one_time() {
    let (found, steps) = one_step(clock(3, |t, g| {
        (g[0], g[1], g[2]) = (0.3 - t, 0.6 * t - 0.1, 0.09 - t * t);
    }));
    assert_eq!(found, [(0.3, vec![true, false, true])]);
    assert_eq!(steps, 2);
}

#[test]
fn two_in_one_step() {
    let (found, steps) = one_step(clock(3, |t, g| (g[0], g[1], g[2]) = (0.75 - t, 0.25 - t, t - 2.0)));
    assert_eq!(
        found,
        [(0.25, vec![false, true, false]), (0.75, vec![true, false, false])]
    );
    assert_eq!(steps, 3);
    // So close that only rounding tells them apart.
    let (found, _) = one_step(clock(2, |t, g| (g[0], g[1]) = (0.5 + 1e-14 - t, 0.5 - t)));
    assert_eq!(found, [(0.5, vec![false, true]), (0.5 + 1e-14, vec![true, false])]);
}

/// Positive at both ends of the step and negative in between, by much and by little.
#[test]
fn a_dip_within_a_step() {
    for depth in [0.1, 1e-3, 1e-9, 1e-13] {
        let (found, _) = one_step(clock(1, move |t, g| g[0] = (t - 0.4) * (t - 0.4) - depth));
        let found: Vec<f64> = found.into_iter().map(|(t, _)| t).collect();
        assert_close(&found, &[0.4 - f64::sqrt(depth)], 1e-15 / f64::sqrt(depth));
    }
    // None.
    for height in [0.2, 1e-3, 1e-9, 1e-13] {
        let (found, steps) = one_step(clock(1, move |t, g| g[0] = (t - 0.4) * (t - 0.4) + height));
        assert!(found.is_empty() && steps == 1);
    }
    // Hidden before a change of sign at the end.
    let (found, _) = one_step(clock(1, |t, g| g[0] = (0.2 - t) * (0.4 - t) * (0.8 - t)));
    let found: Vec<f64> = found.into_iter().map(|(t, _)| t).collect();
    assert_close(&found, &[0.2, 0.8], 1e-15);
}

/// How much of a narrow dip is seen depends on its width against the step: tails that reach the ends give it away.
#[test]
fn a_dip_too_narrow_is_missed() {
    let narrow = |width: f64| {
        clock(1, move |t: f64, g: &mut [f64]| {
            g[0] = 0.5 - (-((t - 0.5) / width).powi(2)).exp()
        })
    };
    assert_eq!(one_step(narrow(0.3)).0.len(), 1);
    assert_eq!(one_step(narrow(0.05)).0.len(), 0);
    let settings = Settings {
        max_step: 0.1,
        ..Settings::default()
    };
    let mut run = Integration::new(narrow(0.05), Dop853::default(), 0.0, &[0.0], settings).expect("good settings");
    assert_eq!(events(&mut run, 1.0).len(), 1);
}

/// At the start nothing has been positive yet, so nothing fires; at a stop and at the end it is found, once.
#[test]
fn at_the_start_at_a_stop_and_at_the_end() {
    fn check<M: Method<Any<'static>> + 'static, C: Problem + 'static>(clock: C, method: M) {
        let run = start(clock, method, 0.0, &[0.0], 1e-6);
        let mut run = run.with_stops(&[0.5, 0.75]).expect("finite");
        let mut seen = Vec::new();
        for end in [1.0, 2.0] {
            loop {
                let progress = run.advance(end).expect("smooth");
                match progress {
                    Progress::Step { .. } => {}
                    Progress::Done { .. } => break,
                    _ => seen.push((progress, run.fired().to_vec())),
                }
            }
        }
        let fired = |k: usize| (0..4).map(|j| j == k).collect::<Vec<_>>();
        let none = || vec![false; 4];
        let expected = [
            (Progress::Event { t: 0.5 }, fired(1)),
            (Progress::Stop { t: 0.5 }, none()),
            (Progress::Stop { t: 0.75 }, none()),
            (Progress::Event { t: 1.0 }, fired(2)),
        ];
        let times: Vec<_> = seen.iter().map(|(progress, _)| *progress).collect();
        assert_eq!(times, expected.each_ref().map(|(progress, _)| *progress));
        for ((progress, fired), (_, expected)) in seen.iter().zip(&expected) {
            assert!(
                fired == expected || matches!(progress, Progress::Stop { .. }),
                "{progress:?}: {fired:?}"
            );
        }
    }
    let roots = |t: f64, g: &mut [f64]| (g[0], g[1], g[2], g[3]) = (-t, 0.5 - t, 1.0 - t, t);
    check(clock(4, roots), Rk4::new(0.1));
    check(clock(4, roots), Rk4::new(10.0));
    check(clock(4, roots), DormandPrince5::default());
    check(clock(4, roots), Dop853::default());
    check(clock(4, roots), Adams::default());
    check(clock(4, roots), Radau5::default());
    check(clock(4, roots), Bdf::default());
}

/// In both directions a function that falls fires, one that rises does not.
#[test]
fn backward_in_time() {
    fn check<M: Method<Any<'static>> + 'static, C: Problem + 'static>(clock: C, method: M) {
        let mut run = start(clock, method, 0.0, &[0.0], 1e-6);
        assert_eq!(events(&mut run, 1.0), [(0.5, vec![true, false])]);
        assert_eq!(events(&mut run, 0.0), [(0.25, vec![false, true])]);
        assert_eq!(events(&mut run, 1.0), [(0.5, vec![true, false])]);
    }
    let roots = |t: f64, g: &mut [f64]| (g[0], g[1]) = (0.5 - t, t - 0.25);
    check(clock(2, roots), Rk4::new(0.07));
    check(clock(2, roots), Dop853::default());
    check(clock(2, roots), Adams::default());
    check(clock(2, roots), Radau5::default());
    check(clock(2, roots), Bdf::default());
}

/// A jump of a root function is found as well as a root.
#[test]
fn a_function_that_jumps() {
    fn check<M: Method<Any<'static>> + 'static, C: Problem + 'static>(clock: C, method: M) {
        let mut run = start(clock, method, 0.0, &[0.0], 1e-6);
        let found = times(&mut run, 10.0);
        assert_close(&found, &[1.0 / 3.0], 1e-13);
    }
    let roots = |t: f64, g: &mut [f64]| g[0] = if t < 1.0 / 3.0 { 1.0 } else { -1.0 };
    check(clock(1, roots), Rk4::new(0.1));
    check(clock(1, roots), Dop853::default());
    check(clock(1, roots), Adams::default());
    check(clock(1, roots), Radau5::default());
    check(clock(1, roots), Bdf::default());
}

/// One that never is positive never fires, one that is zero throughout neither.
#[test]
fn functions_that_rest() {
    let (found, steps) = one_step(clock(4, |t, g| (g[0], g[1], g[2], g[3]) = (0.0, -1.0, 1.0, -t * t)));
    assert!(found.is_empty() && steps == 1);
}

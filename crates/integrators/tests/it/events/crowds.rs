//! Events that follow from each other at one time, and events that accumulate.

use super::*;
use crate::problems::Any;

/// Three balls in a row, all of them touching the next: the first hits, and the blow goes through at one time.
#[test]
fn a_blow_goes_through_a_row() {
    let row = || Switched {
        dim: 6,
        roots: 3,
        pairs: 3,
        mode: 0.0,
        rhs: |_, _, y: &[f64], dy: &mut [f64]| {
            dy[..3].copy_from_slice(&y[3..]);
            dy[3..].fill(0.0);
        },
        // Gap before the first, and the rates at which the touching ones part.
        root: |_, _, y: &[f64], g: &mut [f64]| {
            g.copy_from_slice(&[
                if y[3] > y[4] { y[1] - y[0] } else { 1.0 },
                1.0 + y[5] - y[4],
                1.0 - y[5],
            ]);
            Ok(())
        },
        change: |_: &mut f64, _, y: &mut [f64], fired: &[bool]| {
            match fired {
                [true, ..] => y.swap(3, 4),
                [_, true, _] => y.swap(4, 5),
                _ => {}
            }
            Ok(())
        },
    };
    fn check<P: Problem + 'static, M: Method<Any<'static>> + 'static>(row: P, method: M) {
        let mut run = start(row, method, 0.0, &[0.0, 1.0, 1.0, 2.0, 0.0, 0.0], 1e-6);
        let found = events(&mut run, 1.0);
        let expected = [[true, false, false], [false, true, false], [false, false, true]];
        assert!(found.iter().all(|(t, _)| (t - 0.5).abs() < 1e-15), "{found:?}");
        assert!(found.iter().map(|(_, fired)| fired).eq(&expected), "{found:?}");
        let y = run.state().1;
        assert!((y[2] - 2.0).abs() < 1e-14 && y[3..] == [0.0, 0.0, 2.0], "{y:?}");
    }
    check(row(), Rk4::new(0.1));
    check(row(), DormandPrince5::default());
    check(row(), Dop853::default());
    check(row(), Adams::default());
    check(row(), Radau5::default());
    check(row(), Bdf::default());
}

/// A gap with a mode: closed while x ≤ 0. The force of the closed gap depends on `mode`, so a change that is overlooked is seen.
fn gap(push: f64) -> impl Problem {
    Switched {
        dim: 2,
        roots: 1,
        pairs: 1,
        mode: 1.0,
        rhs: move |mode: f64, _, y: &[f64], dy: &mut [f64]| {
            let spring = if mode < 0.0 { -100.0 * y[0].min(0.0) } else { 0.0 };
            (dy[0], dy[1]) = (y[1], -push + spring);
        },
        root: |mode: f64, _, y: &[f64], g: &mut [f64]| {
            g[0] = mode * y[0];
            Ok(())
        },
        change: |mode: &mut f64, _, _: &mut [f64], _: &[bool]| {
            *mode = -*mode;
            Ok(())
        },
    }
}

/// Mode and sign of the gap agree after each step, for gaps that close fast and slowly, and for such as hardly touch.
#[test]
fn a_gap_that_closes_and_opens() {
    fn check<P: Problem + 'static, M: Method<Any<'static>> + 'static>(gap: P, method: M, y0: [f64; 2]) -> usize {
        let mut run = start(gap, method, 0.0, &y0, 1e-10);
        let (mut closed, mut count, mut last) = (false, 0, 0.0);
        loop {
            let progress = run.advance(3.0).expect("runs to the end");
            let (t, y) = run.state();
            if let Progress::Event { .. } = progress {
                closed = !closed;
                count += 1;
                assert!(t >= last && y[0].abs() < 1e-13, "{count}: {t} {y:?}");
                last = t;
            } else {
                assert!(
                    if closed { y[0] <= 1e-15 } else { y[0] >= -1e-15 },
                    "{t} {y:?} closed: {closed}"
                );
            }
            if matches!(progress, Progress::Done { .. }) {
                return count;
            }
        }
    }
    // Where errors are small against the bounce, all count the same; else the gap may stay closed.
    for (start, certain) in [
        ([0.1, 0.0], true),
        ([1.0, -1.0], true),
        ([1e-3, -1e-9], false),
        ([1e-6, 0.0], false),
        ([1e-12, 0.0], false),
    ] {
        let counts = [
            check(gap(1.0), Rk4::new(0.01), start),
            check(gap(1.0), DormandPrince5::default(), start),
            check(gap(1.0), Dop853::default(), start),
            check(gap(1.0), Adams::default(), start),
            check(gap(1.0), Radau5::default(), start),
            check(gap(1.0), Bdf::default(), start),
        ];
        let same = counts.iter().all(|count| *count == counts[0]);
        assert!(counts[0] > 0 && (same || !certain), "{start:?}: {counts:?}");
    }
}

/// y'' = 1 with a lowest point just below, at and just above zero: the gap closes and opens, or does not, but no mode is left wrong.
#[test]
fn a_gap_that_is_grazed() {
    let grazing = || Switched {
        dim: 2,
        roots: 1,
        pairs: 1,
        mode: 1.0,
        rhs: |_, _, y: &[f64], dy: &mut [f64]| (dy[0], dy[1]) = (y[1], 1.0),
        root: |mode: f64, _, y: &[f64], g: &mut [f64]| {
            g[0] = mode * y[0];
            Ok(())
        },
        change: |mode: &mut f64, _, _: &mut [f64], _: &[bool]| {
            *mode = -*mode;
            Ok(())
        },
    };
    fn check<P: Problem + 'static, M: Method<Any<'static>> + 'static>(grazing: P, method: M, depth: f64) {
        let mut run = start(grazing, method, 0.0, &[0.5 - depth, -1.0], 1e-10);
        let found = times(&mut run, 3.0);
        assert!(
            found.len().is_multiple_of(2) && found.is_sorted(),
            "{depth:e}: {found:?}"
        );
        if depth.abs() > 1e-14 {
            assert_eq!(found.len(), if depth > 0.0 { 2 } else { 0 }, "{depth:e}: {found:?}");
        }
        for t in found {
            assert!((t - 1.0).abs() < 1e-7 + 2.0 * depth.abs().sqrt(), "{depth:e}: {t}");
        }
    }
    for size in [1e-17, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-10, 1e-6] {
        for depth in [size, -size, 0.0, 3.0 * size] {
            check(grazing(), Rk4::new(0.3), depth);
            check(grazing(), Rk4::new(0.25), depth);
            check(grazing(), DormandPrince5::default(), depth);
            check(grazing(), Dop853::default(), depth);
            check(grazing(), Adams::default(), depth);
            check(grazing(), Radau5::default(), depth);
        }
    }
}

/// A ball that stays on the floor is not let through: without a mode for lying there, the run ends with a diagnosis.
#[test]
fn a_ball_that_does_not_bounce() {
    fn check<M: Method<Any<'static>> + 'static, B: Problem + 'static>(ball: B, method: M) {
        let mut run = start(ball, method, 0.0, &[0.5, 0.0], 1e-9);
        let (found, error) = events_until_failure(&mut run, 10.0);
        assert!((found[0].0 - 1.0).abs() < 1e-14);
        assert!(
            matches!(error, Some(IntegrationError::EventsAccumulate { .. })),
            "{error:?}"
        );
        assert!((run.state().0 - 1.0).abs() < 1e-14);
    }
    check(ball(0.0), Rk4::new(0.01));
    check(ball(0.0), DormandPrince5::default());
    check(ball(0.0), Dop853::default());
    check(ball(0.0), Adams::default());
    check(ball(0.0), Radau5::default());
}

/// Nor is one that `at_event` leaves below the floor.
#[test]
fn a_function_left_negative_fires_again() {
    let pit = Switched {
        dim: 1,
        roots: 1,
        pairs: 0,
        mode: 0.0,
        rhs: |_, _, _: &[f64], dy: &mut [f64]| dy[0] = -1.0,
        root: |_, _, y: &[f64], g: &mut [f64]| {
            g[0] = y[0];
            Ok(())
        },
        change: |count: &mut f64, _, y: &mut [f64], _: &[bool]| {
            *count += 1.0;
            y[0] = *count - 3.0;
            Ok(())
        },
    };
    let mut run = start(pit, Dop853::default(), 0.0, &[0.25], 1e-9);
    let found = times(&mut run, 1.0);
    // To −2, and to −1: there it was negative before.
    assert_close(&found, &[0.25; 2], 1e-15);
    assert!((run.state().1[0] + 1.75).abs() < 1e-14);
}

#[test]
fn a_limit_on_events() {
    let settings = Settings {
        max_events: 5,
        ..Settings::default()
    };
    let mut run = Integration::new(ball(0.9), DormandPrince5::default(), 0.0, &[0.5, 0.0], settings).expect("good");
    let (found, error) = events_until_failure(&mut run, 10.0);
    assert_eq!(found.len(), 5);
    match error {
        Some(IntegrationError::TooManyEvents { time, events: 5 }) => assert_eq!(time, run.state().0),
        other => panic!("{other:?}"),
    }
    assert!(matches!(run.advance(10.0), Err(IntegrationError::TooManyEvents { .. })));
    // The state is that before the event.
    assert!(run.state().1[1] < 0.0 && run.statistics().events == 5);
}

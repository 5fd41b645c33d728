//! Where and when.

use super::*;
use crate::problems::Any;
use proptest::prelude::*;

/// Parabolas are exact for all methods, so times of impact are so too.
#[test]
fn a_bouncing_ball() {
    fn check<M: Method<Any<'static>> + 'static, B: Problem + 'static>(ball: B, method: M) {
        let e: f64 = 0.5;
        let mut run = start(ball, method, 0.0, &[0.5, 0.0], 1e-9);
        let (found, error) = events_until_failure(&mut run, 10.0);
        for (n, pair) in found.windows(2).enumerate() {
            assert!(pair[1].0 > pair[0].0 || n > 40, "times increase");
        }
        assert!(found.is_sorted_by_key(|event| event.0));
        for (n, (t, _)) in found.iter().enumerate() {
            let exact = 1.0 + 2.0 * (e - e.powi(n as i32 + 1)) / (1.0 - e);
            assert!((t - exact).abs() < 5e-14, "{n}: {t}, not {exact}");
        }
        match error {
            Some(IntegrationError::EventsAccumulate { time, function: 0, .. }) => {
                assert!((time - 3.0).abs() < 5e-14);
                assert_eq!(run.state().0, time);
            }
            other => panic!("{other:?}"),
        }
        // Nor does it help to go on.
        assert!(matches!(
            run.advance(10.0),
            Err(IntegrationError::EventsAccumulate { .. })
        ));
    }
    check(ball(0.5), Rk4::new(0.01));
    check(ball(0.5), Newmark::new(0.01, Corrector::Times(2)));
    check(ball(0.5), DormandPrince5::fixed(0.03));
    check(ball(0.5), DormandPrince5::default());
    check(ball(0.5), Dop853::default());
    check(ball(0.5), Adams::default());
    check(ball(0.5), Radau5::default());
}

/// x'' = −sin x between walls: reflected at x = −½, and the rate is halved where x = 0 is passed upward. Both the time of the last
/// event and the state some time after it.
fn reflected() -> impl Problem {
    Switched {
        dim: 2,
        roots: 2,
        pairs: 1,
        mode: 0.0,
        rhs: |_, _, y: &[f64], dy: &mut [f64]| (dy[0], dy[1]) = (y[1], -y[0].sin()),
        root: |_, _, y: &[f64], g: &mut [f64]| {
            (g[0], g[1]) = (y[0] + 0.5, -y[0]);
            Ok(())
        },
        change: |_: &mut f64, _, y: &mut [f64], fired: &[bool]| {
            y[1] *= if fired[0] { -0.9 } else { 0.95 };
            Ok(())
        },
    }
}

fn after_reflections<P: Problem + 'static, M: Method<Any<'static>> + 'static>(
    problem: P,
    method: M,
    tolerance: f64,
) -> [f64; 3] {
    let mut run = start(problem, method, 0.0, &[1.0, 0.0], tolerance);
    let times = times(&mut run, 10.0);
    assert_eq!(times.len(), 4);
    let y = run.state().1;
    [times[3], y[0], y[1]]
}

/// The orders of the methods survive events.
#[test]
fn orders() {
    let exact = after_reflections(reflected(), Dop853::default(), 1e-14);
    // Another method agrees.
    let again = after_reflections(reflected(), Adams::default(), 1e-13);
    assert!(
        exact.iter().zip(again).all(|(a, b)| (a - b).abs() < 2e-12),
        "{exact:?} {again:?}"
    );
    fn check<P: Problem + 'static, M: Method<Any<'static>> + 'static>(
        exact: [f64; 3],
        problem: fn() -> P,
        method: impl Fn(f64) -> M,
        order: f64,
        h: f64,
    ) {
        let errors = [0, 1, 2, 3].map(|halvings| {
            let found = after_reflections(problem(), method(h * 0.5_f64.powi(halvings)), 1e-6);
            found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        });
        let found = (errors[0] / errors[3]).log2() / 3.0;
        assert!((found - order).abs() < 0.3, "order {found}, not {order}: {errors:?}");
    }
    check(exact, reflected, Rk4::new, 4.0, 0.2);
    check(exact, reflected, |h| Newmark::new(h, Corrector::Times(4)), 2.0, 0.05);
    check(exact, reflected, DormandPrince5::fixed, 5.0, 0.4);
    check(exact, reflected, Dop853::fixed, 8.0, 1.0);
}

/// At tight tolerances nothing but the error of the method remains.
#[test]
fn tolerances() {
    let exact = after_reflections(reflected(), Dop853::default(), 1e-14);
    fn check<P: Problem + 'static, M: Method<Any<'static>> + 'static>(exact: [f64; 3], problem: P, method: M) {
        let found = after_reflections(problem, method, 1e-11);
        assert!(exact.iter().zip(found).all(|(a, b)| (a - b).abs() < 3e-10), "{found:?}");
    }
    check(exact, reflected(), DormandPrince5::default());
    check(exact, reflected(), Dop853::default());
    check(exact, reflected(), Adams::default());
    check(exact, reflected(), Radau5::default());
    check(exact, reflected(), Bdf::default());
}

/// A pendulum let go at 2 rad: quarter of the period is π / 2 / agm(1, cos 1).
#[test]
fn a_pendulum_through_its_lowest_point() {
    let (mut a, mut b) = (1.0_f64, 1.0_f64.cos());
    for _ in 0..10 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let quarter = std::f64::consts::FRAC_PI_2 / a;
    let pendulum = || Switched {
        dim: 2,
        roots: 2,
        pairs: 1,
        mode: 0.0,
        rhs: |_, _, y: &[f64], dy: &mut [f64]| (dy[0], dy[1]) = (y[1], -y[0].sin()),
        root: |_, _, y: &[f64], g: &mut [f64]| {
            (g[0], g[1]) = (y[0], -y[0]);
            Ok(())
        },
        change: |_: &mut f64, _, _: &mut [f64], _: &[bool]| Ok(()),
    };
    fn check<P: Problem + 'static, M: Method<Any<'static>> + 'static>(
        pendulum: P,
        method: M,
        quarter: f64,
        tolerance: f64,
    ) {
        let mut run = start(pendulum, method, 0.0, &[2.0, 0.0], 1e-13);
        let found = events(&mut run, 20.0);
        assert_eq!(found.len(), (20.0 / quarter / 2.0 + 0.5) as usize);
        for (n, (t, fired)) in found.iter().enumerate() {
            let exact = (2 * n + 1) as f64 * quarter;
            assert!((t - exact).abs() < tolerance, "{n}: {:e}", t - exact);
            assert_eq!(fired, &[n % 2 == 0, n % 2 == 1]);
        }
    }
    check(pendulum(), Dop853::default(), quarter, 1e-12);
    check(pendulum(), DormandPrince5::default(), quarter, 1e-11);
    check(pendulum(), Adams::default(), quarter, 1e-11);
    check(pendulum(), Radau5::default(), quarter, 1e-11);
    check(pendulum(), Bdf::default(), quarter, 2e-10);
    check(pendulum(), Rk4::new(0.001), quarter, 1e-11);
}

/// A right-hand side in pieces is integrated without any error: y' = ±1, turned round at 0 and 1.
#[test]
fn a_zigzag_is_exact() {
    fn check<M: Method<Any<'static>> + 'static, Z: Problem + 'static>(zigzag: Z, method: M) {
        let mut run = start(zigzag, method, 0.0, &[0.25], 1e-6);
        let found = times(&mut run, 100.5);
        let expected: Vec<f64> = (0..100).map(|n| 0.75 + n as f64).collect();
        assert_close(&found, &expected, 1e-12);
        assert!((run.state().1[0] - 0.75).abs() < 1e-12);
    }
    let zigzag = || Switched {
        dim: 1,
        roots: 1,
        pairs: 0,
        mode: 1.0,
        rhs: |mode, _, _: &[f64], dy: &mut [f64]| dy[0] = mode,
        root: |mode, _, y: &[f64], g: &mut [f64]| {
            g[0] = if mode > 0.0 { 1.0 - y[0] } else { y[0] };
            Ok(())
        },
        change: |mode: &mut f64, _, _: &mut [f64], _: &[bool]| {
            *mode = -*mode;
            Ok(())
        },
    };
    check(zigzag(), Rk4::new(0.3));
    check(zigzag(), Newmark::new(0.3, Corrector::Times(1)));
    check(zigzag(), DormandPrince5::default());
    check(zigzag(), Dop853::default());
    check(zigzag(), Adams::default());
    check(zigzag(), Radau5::default());
    check(zigzag(), Bdf::default());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Levels that an oscillation falls and rises through: each time is known, and each is found once, in either direction of time.
    #[test]
    fn levels_of_an_oscillation(
        levels in proptest::collection::vec(-0.95..0.95_f64, 1..4),
        phase in -3.0..3.0_f64,
        backward: bool,
        which in 0..6_usize,
    ) {
        let direction = if backward { -1.0 } else { 1.0 };
        let (roots, tau) = (2 * levels.len(), std::f64::consts::TAU);
        let end = 12.0;
        // y = cos(s + phase) with s = direction t falls through c at s + phase = acos c, rises through it at −acos c.
        let mut expected = Vec::new();
        for (k, level) in levels.iter().enumerate() {
            for (k, angle) in [(2 * k, level.acos()), (2 * k + 1, -level.acos())] {
                let first = (angle - phase).rem_euclid(tau);
                expected.extend((0..3).map(|n| (first + tau * f64::from(n), k)).filter(|(s, _)| *s < end));
            }
        }
        expected.sort_by(|a, b| a.0.total_cmp(&b.0));
        let all = levels.clone();
        let problem = Switched {
            dim: 2, roots, pairs: 0, mode: 0.0,
            rhs: |_, _, y: &[f64], dy: &mut [f64]| (dy[0], dy[1]) = (-y[1], y[0]),
            root: move |_, _, y: &[f64], g: &mut [f64]| {
                for (k, level) in all.iter().enumerate() {
                    (g[2 * k], g[2 * k + 1]) = (y[0] - level, level - y[0]);
                }
                Ok(())
            },
            change: |_: &mut f64, _, _: &mut [f64], _: &[bool]| Ok(()),
        };
        let y0 = [phase.cos(), direction * phase.sin()];
        fn run<P: Problem + 'static, M: Method<Any<'static>> + 'static>(problem: P, method: M, y0: &[f64], end: f64) -> Vec<(f64, Vec<bool>)> {
            events(&mut start(problem, method, 0.0, y0, 1e-11), end)
        }
        let end = direction * end;
        let found = match which {
            0 => run(problem, DormandPrince5::default(), &y0, end),
            1 => run(problem, Dop853::default(), &y0, end),
            2 => run(problem, Adams::default(), &y0, end),
            3 => run(problem, Radau5::default(), &y0, end),
            4 => run(problem, Bdf::default(), &y0, end),
            _ => run(problem, Rk4::new(0.01), &y0, end),
        };
        let pairs: Vec<(f64, usize)> = found.iter()
            .flat_map(|(t, fired)| (0..roots).filter(|&k| fired[k]).map(move |k| (direction * t, k)))
            .collect();
        prop_assert_eq!(pairs.len(), expected.len());
        prop_assert!(found.windows(2).all(|pair| direction * (pair[1].0 - pair[0].0) > 0.0));
        for ((t, k), (s, j)) in pairs.iter().zip(&expected) {
            prop_assert!((t - s).abs() < 3e-8, "{} {}", t, s);
            prop_assert_eq!(k, j);
        }
    }
}

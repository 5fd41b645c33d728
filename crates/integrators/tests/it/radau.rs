//! The implicit method: stability, its linear algebra, its failures.

use linkdyn_integrators::{
    EvalError, Integration, IntegrationError, NotSettled, Ode, Progress, Radau5, SecondOrder, Settings, SettingsError,
    Statistics,
};
use proptest::prelude::*;

use crate::problems::{Counting, Damped, Function, Kink, Pleiades, distance, finish, solve};

/// (1 + 2/5 z + z²/20) / (1 − 3/5 z + 3/20 z² − z³/60) for z = a + ib, as real and imaginary part (Hairer, Wanner II, IV.3).
fn stability(a: f64, b: f64) -> [f64; 2] {
    let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    let horner = |coefficients: &[f64]| {
        let step = |sum: [f64; 2], c: &f64| {
            let [re, im] = times(sum, [a, b]);
            [re + c, im]
        };
        coefficients.iter().fold([0.0; 2], step)
    };
    let (p, q) = (horner(&[1.0 / 20.0, 0.4, 1.0]), horner(&[-1.0 / 60.0, 0.15, -0.6, 1.0]));
    let size = q[0] * q[0] + q[1] * q[1];
    times(p, [q[0] / size, -q[1] / size])
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]
    /// y' = λ y with complex λ: one step multiplies by R(h λ), so the method is A- and L-stable with its function R.
    #[test]
    fn one_step_is_the_stability_function(re in -9.0_f64..1.0, sign in prop_oneof![Just(-1.0), Just(1.0)], im in -9.0_f64..9.0) {
        // Sizes from 1e-9 to 1e9, apart from the poles on the right.
        let (a, b) = (-f64::powf(10.0, re.abs()) * f64::from(u8::from(re < 0.0)), sign * f64::powf(10.0, im));
        let rhs = move |_: f64, y: &[f64], dy: &mut [f64]| {
            dy.copy_from_slice(&[a * y[0] - b * y[1], b * y[0] + a * y[1]]);
            Ok(())
        };
        let (y, statistics) = solve(Function(2, rhs), Radau5::fixed(1.0), &[1.0, 0.0], 1.0, Settings::default());
        prop_assert_eq!(statistics.accepted, 1);
        let [x, z] = stability(a, b);
        prop_assert!((y[0] - x).hypot(y[1] - z) < 1e-7 * x.hypot(z) + 1e-14, "{:?} {} {}", y, x, z);
        prop_assert!(y[0].hypot(y[1]) <= 1.0 + 1e-12);
    }
}

/// Stiff decay is damped in one step of any length, and the adaptive method does not follow it.
#[test]
fn dahlquist() {
    let decay = || {
        Function(1, |_: f64, y: &[f64], dy: &mut [f64]| {
            dy[0] = -1e6 * y[0];
            Ok(())
        })
    };
    let (y, _) = solve(decay(), Radau5::fixed(1.0), &[1.0], 1.0, Settings::default());
    // R(z) = −3 / z + O(1 / z²).
    assert!((y[0] - 3e-6).abs() < 1e-10, "{}", y[0]);
    let (y, statistics) = solve(decay(), Radau5::default(), &[1.0], 1.0, Settings::default());
    assert!(
        y[0].abs() < 1e-9 && statistics.accepted < 140,
        "{} {statistics:?}",
        y[0]
    );
}

/// y' = λ (y − cos t) − sin t with λ = −1e6, solved by cos t (Hairer, Wanner II, IV.15).
pub fn prothero_robinson(t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
    dy[0] = -1e6 * (y[0] - t.cos()) - t.sin();
    Ok(())
}

#[test]
fn stiff_order() {
    let error = |h: f64| {
        let (y, _) = solve(
            Function(1, prothero_robinson),
            Radau5::fixed(h),
            &[1.0],
            2.0,
            Settings::default(),
        );
        (y[0] - 2.0_f64.cos()).abs()
    };
    // Error O(h³ / λ).
    for h in [0.2, 0.1, 0.05] {
        let order = (error(h) / error(0.5 * h)).log2();
        assert!(
            (2.5..3.6).contains(&order),
            "order {order} at {h}, error {:e}",
            error(h)
        );
        assert!(error(h) < 0.01 * h * h * h / 1e6, "{:e} at {h}", error(h));
    }
}

#[test]
fn steps_follow_the_slow_solution() {
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9, 1e-11] {
        let settings = Settings::tolerances(tolerance, tolerance);
        let (y, statistics) = solve(
            Function(1, prothero_robinson),
            Radau5::default(),
            &[1.0],
            10.0,
            settings,
        );
        assert!(
            (y[0] - 10.0_f64.cos()).abs() < tolerance,
            "{tolerance:e}: {}",
            y[0] - 10.0_f64.cos()
        );
        assert!(statistics.accepted < 200, "{tolerance:e}: {statistics:?}");
    }
}

/// A problem that tells of its structure, or keeps it to itself.
pub struct Told<P> {
    pub problem: P,
    pub pairs: usize,
    pub quadratures: usize,
}

impl<P: Ode> Ode for Told<P> {
    fn dim(&self) -> usize {
        self.problem.dim()
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        self.problem.rhs(t, y, dy)
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
        self.problem.project(t, y)
    }
    fn quadratures(&self) -> usize {
        self.quadratures
    }
    fn second_order_pairs(&self) -> usize {
        self.pairs
    }
}

impl<P: Ode> SecondOrder for Told<P> {
    fn pairs(&self) -> usize {
        0
    }
}

/// Three masses on stiffening springs between walls, damped; with a variable of first order, the work of the dampers and the area
/// under the first mass.
pub struct Chain;

impl Chain {
    pub const START: [f64; 9] = [0.3, -0.2, 0.5, 1.0, 0.0, -2.0, 0.1, 0.0, 0.0];
}

impl Ode for Chain {
    fn dim(&self) -> usize {
        9
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        let spring = |x: f64| 1e4 * x + 3e4 * x * x * x;
        let (x, v, z) = (&y[..3], &y[3..6], y[6]);
        dy[..3].copy_from_slice(v);
        let forces = [spring(x[0]), spring(x[1] - x[0]), spring(x[2] - x[1]), spring(-x[2])];
        for i in 0..3 {
            dy[3 + i] = forces[i + 1] - forces[i] - 30.0 * v[i] * (1.0 + z * z) + 100.0 * t.sin();
        }
        dy[6] = v[0] - 50.0 * z + z * x[1];
        dy[7] = 30.0 * (1.0 + z * z) * v.iter().map(|v| v * v).sum::<f64>();
        dy[8] = x[0];
        Ok(())
    }
}

fn chain(pairs: usize, quadratures: usize, settings: &Settings, method: Radau5) -> (Vec<f64>, Statistics) {
    let problem = Told {
        problem: Chain,
        pairs,
        quadratures,
    };
    solve(problem, method, &Chain::START, 1.0, settings.clone())
}

/// Largest difference, relative to components larger than 1.
pub fn relative_distance(y: &[f64], exact: &[f64]) -> f64 {
    let difference = |(y, exact): (&f64, &f64)| (y - exact).abs() / exact.abs().max(1.0);
    y.iter().zip(exact).map(difference).fold(0.0, f64::max)
}

/// Elimination of the positions, and quadratures apart from Newton's iteration, change the result by rounding only.
#[test]
fn structure_changes_nothing_but_the_work() {
    let settings = Settings::default();
    let (plain, all) = chain(0, 0, &settings, Radau5::fixed(0.002));
    for (pairs, quadratures) in [(3, 0), (3, 2), (3, 1), (0, 2)] {
        let (y, told) = chain(pairs, quadratures, &settings, Radau5::fixed(0.002));
        let distance = relative_distance(&y, &plain);
        assert!(distance < 1e-11, "{pairs} {quadratures}: {distance:e}");
        let columns = 9 - quadratures as u64;
        let expected = columns * told.jacobians..(columns + 1) * told.jacobians;
        assert!(expected.contains(&told.jacobian_evaluations), "{told:?}");
    }
    assert!(all.jacobian_evaluations >= 9 * all.jacobians);
    let settings = Settings::tolerances(1e-8, 1e-8);
    let (plain, all) = chain(0, 0, &settings, Radau5::default());
    let (y, told) = chain(3, 2, &settings, Radau5::default());
    assert!(
        relative_distance(&y, &plain) < 1e-9,
        "{:e}",
        relative_distance(&y, &plain)
    );
    assert!(
        told.accepted.abs_diff(all.accepted) <= all.accepted / 20,
        "{told:?} {all:?}"
    );
}

/// Quadratures are as accurate as what they integrate, also if nothing controls them.
#[test]
fn quadratures_without_tolerance() {
    let settings = Settings::tolerances(1e-9, [vec![1e-9; 7], vec![f64::INFINITY; 2]].concat());
    let (y, free) = chain(3, 2, &settings, Radau5::default());
    let (exact, _) = chain(3, 2, &Settings::tolerances(1e-12, 1e-13), Radau5::default());
    let error = relative_distance(&y, &exact);
    assert!(error < 1e-9, "{error:e}");
    assert!(free.accepted > 20);
    // With z the integral of x at hand in closed form.
    let told = Told {
        problem: Damped,
        pairs: 1,
        quadratures: 1,
    };
    let settings = Settings::tolerances(1e-10, vec![1e-10, 1e-10, f64::INFINITY]);
    let (y, _) = solve(told, Radau5::default(), &Damped::START, 20.0, settings);
    assert!(
        distance(&y, &Damped::exact(20.0)) < 1e-9,
        "{:e}",
        distance(&y, &Damped::exact(20.0))
    );
}

/// The same with df/dy given: right, or wrong by this factor.
pub struct Given(pub f64);

impl Ode for Given {
    fn dim(&self) -> usize {
        3
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        Kink.rhs(t, y, dy)
    }
    fn jacobian(&mut self, _t: f64, y: &[f64], matrix: &mut [f64]) -> Result<bool, EvalError> {
        assert!(matrix.iter().all(|entry| *entry == 0.0));
        (matrix[1], matrix[3], matrix[8]) = (1.0, self.0 * (6.0 * y[0] * y[0] - 2.0), -2.0 * self.0 * y[2]);
        Ok(true)
    }
}

impl SecondOrder for Given {
    fn pairs(&self) -> usize {
        0
    }
}

#[test]
fn a_given_jacobian() {
    let settings = Settings::tolerances(1e-9, 1e-9);
    let (y, given) = solve(Given(1.0), Radau5::default(), &Kink::START, 1.5, settings.clone());
    let (y_differences, differences) = solve(Kink, Radau5::default(), &Kink::START, 1.5, settings.clone());
    assert_eq!(given.jacobian_evaluations, 0);
    assert_eq!(differences.jacobian_evaluations, 4 * differences.jacobians - 1);
    assert_eq!(given.accepted, differences.accepted);
    assert!(distance(&y, &y_differences) < 1e-11 && distance(&y, &Kink::exact(1.5)) < 1e-9);
    // A wrong one costs work, not digits.
    let (y, wrong) = solve(Given(0.5), Radau5::default(), &Kink::START, 1.5, settings);
    assert!(distance(&y, &Kink::exact(1.5)) < 1e-8);
    assert!(wrong.iterations > given.iterations);
}

#[test]
fn reuse_trades_matrices_for_iterations() {
    let settings = Settings::tolerances(1e-8, 1e-8);
    let run = |part: f64| chain(3, 2, &settings, Radau5::default().with_reuse(part)).1;
    let (never, little, often) = (run(0.0), run(0.001), run(0.2));
    assert!(never.jacobians >= never.accepted);
    assert!(little.jacobians < never.jacobians && 2 * often.jacobians < little.jacobians);
    assert!(often.iterations > never.iterations);
    // By default about what costs least.
    let usual = chain(3, 2, &settings, Radau5::default()).1.evaluations;
    let least = [never, little, often].map(|s| s.evaluations).into_iter().min();
    assert!(least.is_some_and(|least| 20 * usual < 21 * least), "{usual} {least:?}");
}

#[test]
fn counters() {
    let mut problem = Counting::new(Pleiades);
    let settings = Settings {
        first_step: Some(1e-3),
        ..Settings::tolerances(1e-6, 1e-6)
    };
    let mut run = Integration::new(&mut problem, Radau5::default(), 0.0, &Pleiades::START, settings).expect("good");
    finish(&mut run, 3.0);
    let s = run.statistics();
    assert_eq!(s.evaluations, problem.evaluations);
    // One for each column, and one for f itself unless it is known, as at the start.
    assert!(
        (28 * s.jacobians..29 * s.jacobians).contains(&s.jacobian_evaluations),
        "{s:?}"
    );
    assert_eq!(s.dense_evaluations, 0);
    // The start, three for each iteration, fewer where one fails; the estimate is filtered twice only in a refused step, in the
    // first, or in one after a refusal.
    let rest = s.evaluations - s.jacobian_evaluations - (1 + 3 * s.iterations);
    assert!(rest <= 1 + 2 * s.rejected, "{s:?}");
    assert!(s.factorisations % 2 == 0 && s.factorisations >= 2 * s.jacobians && s.divergences <= s.rejected);
}

/// f exists on one side only: the other direction serves, as long as there is one.
#[test]
fn differences_keep_to_the_domain() {
    #[derive(Debug, thiserror::Error)]
    #[error("outside")]
    struct Outside;
    let edge = |above: f64| {
        Function(2, move |_: f64, y: &[f64], dy: &mut [f64]| {
            // y₁ rests at 1, the end of the domain (which begins at `above`).
            if y[1] > 1.0 || y[1] < above {
                return Err(EvalError::Retry(Outside.into()));
            }
            (dy[0], dy[1]) = (-y[0] * y[1], 0.0);
            Ok(())
        })
    };
    let settings = || Settings {
        first_step: Some(0.1),
        ..Settings::default()
    };
    let (y, statistics) = solve(edge(0.0), Radau5::default(), &[1.0, 1.0], 1.0, settings());
    assert!((y[0] - f64::exp(-1.0)).abs() < 1e-6 && y[1] == 1.0);
    // Two tries for the second column; f itself is known at the start.
    let expected = 4 * statistics.jacobians - 1;
    assert_eq!((statistics.retries, statistics.jacobian_evaluations), (0, expected));
    let mut run = Integration::new(edge(1.0), Radau5::default(), 0.0, &[1.0, 1.0], settings()).expect("good settings");
    let error = run.advance(1.0).expect_err("no direction is left");
    let IntegrationError::StepTooSmall {
        source: Some(source), ..
    } = error
    else {
        panic!("{error}")
    };
    assert!(source.downcast_ref::<Outside>().is_some());
}

#[test]
fn a_jacobian_that_is_not_finite() {
    let infinite = Function(1, |_: f64, y: &[f64], dy: &mut [f64]| {
        dy[0] = if y[0] == 1.0 { 1.0 } else { f64::NAN };
        Ok(())
    });
    let mut run = Integration::new(infinite, Radau5::default(), 0.0, &[1.0], Settings::default()).expect("good");
    let error = run.advance(1.0).expect_err("no matrix");
    assert!(error.to_string().contains("small"), "{error}");
    assert_eq!(run.statistics().accepted, 0);
}

/// Where Newton's method meets a jump it gives up, the step is shortened, and the run goes on.
#[test]
fn divergence_shortens_the_step() {
    let switch = || {
        Function(1, |_: f64, y: &[f64], dy: &mut [f64]| {
            dy[0] = if y[0] < 0.5 { 1.0 } else { 1.0 - 1e5 * (y[0] - 0.5) };
            Ok(())
        })
    };
    let settings = Settings {
        first_step: Some(0.4),
        ..Settings::tolerances(1e-6, 1e-9)
    };
    let (y, statistics) = solve(switch(), Radau5::default(), &[0.0], 1.0, settings);
    assert!((y[0] - 0.50001).abs() < 1e-6, "{}", y[0]);
    assert!(statistics.divergences > 0 && statistics.retries == 0, "{statistics:?}");
    // A fixed step cannot be shortened.
    let sharp = Function(1, |_: f64, y: &[f64], dy: &mut [f64]| {
        dy[0] = if y[0] < 0.5 { 1.0 } else { -1.0 };
        Ok(())
    });
    let mut run = Integration::new(sharp, Radau5::fixed(0.3), 0.0, &[0.1], Settings::default()).expect("good settings");
    let error = loop {
        match run.advance(10.0) {
            Ok(Progress::Step { t }) => assert!(t < 0.5),
            Ok(other) => panic!("{other:?}"),
            Err(error) => break error,
        }
    };
    let IntegrationError::Problem { source, .. } = error else {
        panic!("{error}")
    };
    assert!(source.downcast_ref::<NotSettled>().expect("its own error").iterations > 1);
}

#[test]
fn what_does_not_fit_is_refused() {
    let refused = |pairs: usize, quadratures: usize, method: Radau5| {
        let problem = Told {
            problem: Kink,
            pairs,
            quadratures,
        };
        let run = Integration::new(problem, method, 0.0, &Kink::START, Settings::default());
        matches!(run, Err(IntegrationError::Settings(SettingsError::Method(_))))
    };
    assert!(!refused(1, 1, Radau5::default()) && !refused(0, 3, Radau5::default()));
    for (pairs, quadratures) in [(2, 0), (1, 2), (0, 4), (usize::MAX, 0), (0, usize::MAX)] {
        assert!(refused(pairs, quadratures, Radau5::default()), "{pairs} {quadratures}");
    }
    for part in [-0.1, 1.0, f64::NAN] {
        assert!(refused(1, 0, Radau5::default().with_reuse(part)), "{part}");
    }
}

/// All that is integrated are quadratures; nothing at all; and components with no tolerance that others depend on.
#[test]
fn unusual_problems() {
    let area = Told {
        problem: Function(2, |t: f64, _: &[f64], dy: &mut [f64]| {
            (dy[0], dy[1]) = (t.cos(), 3.0 * t * t);
            Ok(())
        }),
        pairs: 0,
        quadratures: 2,
    };
    let (y, statistics) = solve(
        area,
        Radau5::default(),
        &[0.0, 0.0],
        2.0,
        Settings::tolerances(1e-8, 1e-8),
    );
    assert!(distance(&y, &[2.0_f64.sin(), 8.0]) < 1e-8);
    assert_eq!(statistics.jacobian_evaluations, 0);
    let nothing = Function(0, |_: f64, _: &[f64], _: &mut [f64]| Ok(()));
    assert!(
        solve(nothing, Radau5::default(), &[], 1.0, Settings::default())
            .0
            .is_empty()
    );
}

/// Between the steps the error is of the order of its estimate.
#[test]
fn interpolation_within_the_tolerance() {
    let run = |tolerance: f64| {
        let settings = Settings::tolerances(tolerance, tolerance);
        Integration::new(Chain, Radau5::default(), 0.0, &Chain::START, settings).expect("good settings")
    };
    let (mut rough, mut fine) = (run(1e-6), run(1e-12));
    let (mut y, mut exact, mut worst, mut at_ends) = ([0.0; 9], [0.0; 9], 0.0_f64, 0.0_f64);
    fine.advance(1.0).expect("smooth");
    while !matches!(rough.advance(1.0).expect("smooth"), Progress::Done { .. }) {
        let (from, to) = rough.last_step();
        for i in 1..=5 {
            let t = if i == 5 {
                to
            } else {
                from + 0.2 * f64::from(i) * (to - from)
            };
            while fine.last_step().1 < t {
                fine.advance(1.0).expect("smooth");
            }
            fine.interpolate(t, &mut exact).expect("inside");
            rough.interpolate(t, &mut y).expect("inside");
            let error = relative_distance(&y, &exact);
            let worst = if i == 5 { &mut at_ends } else { &mut worst };
            *worst = worst.max(error);
        }
    }
    assert!(
        worst < 3e-6 && at_ends < 1e-6,
        "{worst:e} between, {at_ends:e} at the ends"
    );
}

/// `SecondOrder` and what the method is told agree.
#[test]
fn pairs_through_references() {
    struct Paired;
    impl Ode for Paired {
        fn dim(&self) -> usize {
            3
        }
        fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
            Damped.rhs(t, y, dy)
        }
        fn quadratures(&self) -> usize {
            1
        }
        fn second_order_pairs(&self) -> usize {
            self.pairs()
        }
    }
    impl SecondOrder for Paired {
        fn pairs(&self) -> usize {
            1
        }
    }
    fn structure<P: Ode>(problem: P) -> (usize, usize) {
        (problem.second_order_pairs(), problem.quadratures())
    }
    let boxed: Box<dyn Ode> = Box::new(Paired);
    assert_eq!([structure(&mut Paired), structure(boxed)], [(1, 1); 2]);
}

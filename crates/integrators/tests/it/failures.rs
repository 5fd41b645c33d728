//! Every failure is typed and says where.

use std::error::Error;

use linkdyn_integrators::{
    Adams, Auto, Bdf, Corrector, Dop853, DormandPrince5, EvalError, Integration, IntegrationError, Method, Newmark,
    NotSettled, Ode, Progress, Radau5, Rk4, Rodas, SecondOrder, Settings,
};

use crate::problems::{Any, Damped, Function, Kink, begin};

type Rhs = fn(f64, &[f64], &mut [f64]) -> Result<(), EvalError>;

/// Runs until it fails; the error and the time reached.
fn failure<'a>(
    problem: impl SecondOrder + 'a,
    method: impl Method<Any<'a>> + 'a,
    t0: f64,
    y0: &[f64],
    end: f64,
    settings: Settings,
) -> (IntegrationError, f64) {
    let mut run = begin(problem, method, t0, y0, settings).expect("good settings");
    for _ in 0..1_000_000 {
        match run.advance(end) {
            Ok(Progress::Done { .. }) => panic!("reached the end"),
            Ok(_) => {}
            Err(error) => {
                let (t, y) = run.state();
                assert!(y.iter().all(|y| y.is_finite()), "the state kept is not finite");
                return (error, t);
            }
        }
    }
    panic!("no end");
}

/// The same with each adaptive method.
fn failures(rhs: Rhs, y0: &[f64], end: f64) -> [(IntegrationError, f64); 7] {
    let dim = y0.len();
    [
        failure(
            Function(dim, rhs),
            DormandPrince5::default(),
            0.0,
            y0,
            end,
            Settings::default(),
        ),
        failure(Function(dim, rhs), Dop853::default(), 0.0, y0, end, Settings::default()),
        failure(Function(dim, rhs), Adams::default(), 0.0, y0, end, Settings::default()),
        failure(Function(dim, rhs), Radau5::default(), 0.0, y0, end, Settings::default()),
        failure(Function(dim, rhs), Bdf::default(), 0.0, y0, end, Settings::default()),
        failure(Function(dim, rhs), Auto::default(), 0.0, y0, end, Settings::default()),
        failure(Function(dim, rhs), Rodas::default(), 0.0, y0, end, Settings::default()),
    ]
}

#[test]
fn blow_up() {
    let square: Rhs = |_, y, dy| {
        (dy[0], dy[1]) = (0.0, y[1] * y[1]);
        Ok(())
    };
    for (error, reached) in failures(square, &[0.0, 1.0], 2.0) {
        assert!((reached - 1.0).abs() < 1e-3, "{error}");
        match error {
            IntegrationError::StepTooSmall { time, component, .. } => {
                assert_eq!((time, component), (reached, Some(1)));
            }
            IntegrationError::NonFinite { time, component, .. } => assert_eq!((time, component), (reached, 1)),
            other => panic!("{other}"),
        }
    }
}

#[test]
fn singular_right_hand_side() {
    let pole: Rhs = |t, _, dy| {
        dy[0] = 1.0 / (t - 1.0);
        Ok(())
    };
    for (error, reached) in failures(pole, &[0.0], 2.0) {
        assert!((reached - 1.0).abs() < 1e-3, "{error}");
        assert!(
            matches!(
                error,
                IntegrationError::StepTooSmall { .. } | IntegrationError::NonFinite { .. }
            ),
            "{error}"
        );
    }
}

#[test]
fn not_a_number_from_some_time_on() {
    let late: Rhs = |t, y, dy| {
        (dy[0], dy[1]) = (-y[0], if t > 0.7 { f64::NAN } else { y[0] });
        Ok(())
    };
    for (error, reached) in failures(late, &[1.0, 0.0], 2.0) {
        assert!(
            matches!(error, IntegrationError::NonFinite { component: 1, .. }),
            "{error}"
        );
        assert!((reached - 0.7).abs() < 1e-3);
    }
    let fixed = failure(
        Function(2, late),
        Rk4::new(0.1),
        0.0,
        &[1.0, 0.0],
        2.0,
        Settings::default(),
    );
    assert!(
        matches!(fixed.0, IntegrationError::NonFinite { component: 1, .. }),
        "{}",
        fixed.0
    );
}

#[test]
fn infinity_and_overflow() {
    let infinite: Rhs = |t, _, dy| {
        dy[0] = if t > 0.5 { f64::INFINITY } else { 1.0 };
        Ok(())
    };
    for (error, reached) in failures(infinite, &[1.0], 2.0) {
        assert!(
            matches!(error, IntegrationError::NonFinite { component: 0, .. }),
            "{error}"
        );
        assert!((reached - 0.5).abs() < 1e-3);
    }
    // Also in a component that is not controlled.
    let settings = Settings::tolerances(1e-6, f64::INFINITY);
    let error = failure(Function(1, infinite), Dop853::default(), 0.0, &[1.0], 2.0, settings).0;
    assert!(
        matches!(error, IntegrationError::NonFinite { component: 0, .. }),
        "{error}"
    );
}

#[test]
fn not_finite_at_the_start() {
    let rhs: Rhs = |_, _, dy| {
        (dy[0], dy[1]) = (0.0, f64::NAN);
        Ok(())
    };
    for (error, reached) in failures(rhs, &[0.0, 0.0], 1.0) {
        assert!(
            matches!(error, IntegrationError::NonFinite { component: 1, .. }),
            "{error}"
        );
        assert_eq!(reached, 0.0);
    }
}

#[derive(Debug, thiserror::Error)]
#[error("y = {0} is outside the domain")]
struct Outside(f64);

/// Even where the step wanted is lost in rounding of t.
#[test]
fn a_cause_is_named_however_short_the_step() {
    let rhs: Rhs = |t, _, dy| {
        dy[0] = 1.0;
        if t > 1e6 {
            Err(EvalError::Retry(Outside(t).into()))
        } else {
            Ok(())
        }
    };
    let settings = Settings {
        first_step: Some(1e-12),
        ..Settings::default()
    };
    let (error, reached) = failure(Function(1, rhs), Dop853::default(), 1e6, &[1.0], 2e6, settings);
    assert_eq!(reached, 1e6);
    assert!(error.source().is_some_and(|source| source.is::<Outside>()), "{error}");
}

/// y' = −√y from 1: reaches 0 at t = 2, where the domain ends.
fn root(_: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
    if y[0] < 0.0 {
        return Err(EvalError::Retry(Outside(y[0]).into()));
    }
    dy[0] = -1.0 - y[0].sqrt();
    Ok(())
}

#[test]
fn retry_shortens_the_step_and_then_fails_with_its_source() {
    // 2 (1 − ln 2): where y' = −1 − √y meets 0.
    let end_of_domain = 2.0 * (1.0 - std::f64::consts::LN_2);
    for (error, reached) in failures(root, &[1.0], 2.0) {
        assert!((reached - end_of_domain).abs() < 1e-3, "{reached}");
        let IntegrationError::StepTooSmall {
            source: Some(source), ..
        } = &error
        else {
            panic!("{error}")
        };
        assert!(source.downcast_ref::<Outside>().is_some());
        assert!(error.source().is_some());
    }
    // A retry alone does no harm.
    let settings = Settings {
        first_step: Some(0.5),
        ..Settings::tolerances(1e-3, 1e-3)
    };
    let mut run = Integration::new(Function(1, root), Dop853::default(), 0.0, &[1.0], settings).expect("good settings");
    while !matches!(run.advance(0.6).expect("inside the domain"), Progress::Done { .. }) {}
    let run = run.statistics();
    assert!(run.retries <= run.rejected);
    // A fixed step cannot be shortened.
    let (error, _) = failure(
        Function(1, root as Rhs),
        Rk4::new(0.1),
        0.0,
        &[1.0],
        2.0,
        Settings::default(),
    );
    let IntegrationError::Problem { source, .. } = error else {
        panic!("{error}")
    };
    assert!(source.downcast_ref::<Outside>().is_some());
}

#[test]
fn abort_stops_at_once() {
    let mut calls = 0;
    let rhs = |t: f64, _: &[f64], dy: &mut [f64]| {
        calls += 1;
        dy[0] = 1.0;
        if t > 0.3 {
            Err(EvalError::Abort(Outside(t).into()))
        } else {
            Ok(())
        }
    };
    let settings = Settings {
        first_step: Some(0.5),
        ..Settings::default()
    };
    let (error, _) = failure(Function(1, rhs), DormandPrince5::default(), 0.0, &[1.0], 2.0, settings);
    assert!(matches!(error, IntegrationError::Problem { .. }), "{error}");
    assert!(calls < 10);
}

#[test]
fn a_failing_projection() {
    struct Stubborn;
    impl Ode for Stubborn {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, _: f64, _: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
            dy[0] = 1.0;
            Ok(())
        }
        fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
            if t > 1.0 {
                Err(EvalError::Retry(Outside(y[0]).into()))
            } else {
                Ok(false)
            }
        }
    }

    impl SecondOrder for Stubborn {
        fn pairs(&self) -> usize {
            0
        }
    }
    for (error, reached) in [
        failure(Stubborn, Dop853::default(), 0.0, &[0.0], 2.0, Settings::default()),
        failure(Stubborn, Adams::default(), 0.0, &[0.0], 2.0, Settings::default()),
        failure(Stubborn, Radau5::default(), 0.0, &[0.0], 2.0, Settings::default()),
        failure(Stubborn, Bdf::default(), 0.0, &[0.0], 2.0, Settings::default()),
    ] {
        assert!(
            matches!(error, IntegrationError::StepTooSmall { source: Some(_), .. }),
            "{error}"
        );
        assert!((reached - 1.0).abs() < 1e-3);
    }
}

#[test]
fn steps_below_the_spacing_of_time() {
    let settings = Settings {
        first_step: Some(1e-8),
        max_step: 1e-8,
        ..Settings::default()
    };
    let (error, _) = failure(Damped, Dop853::default(), 1e9, &Damped::START, 1e9 + 1.0, settings);
    assert!(matches!(error, IntegrationError::StepTooSmall { .. }), "{error}");
    let (error, _) = failure(
        Damped,
        Rk4::new(1e-8),
        1e9,
        &Damped::START,
        1e9 + 1.0,
        Settings::default(),
    );
    assert!(matches!(error, IntegrationError::StepTooSmall { .. }), "{error}");
}

#[test]
fn too_many_steps() {
    let settings = Settings {
        max_steps: 3,
        ..Settings::default()
    };
    let (error, _) = failure(Damped, Rk4::new(0.1), 0.0, &Damped::START, 10.0, settings);
    assert!(
        matches!(error, IntegrationError::TooManySteps { steps: 3, .. }),
        "{error}"
    );
}

#[test]
fn a_corrector_that_does_not_settle() {
    let newmark = Newmark::new(
        5.0,
        Corrector::Until {
            change: 1e-12,
            at_most: 4,
        },
    );
    let (error, _) = failure(Kink, newmark, 0.0, &Kink::START, 100.0, Settings::default());
    let IntegrationError::Problem { source, .. } = error else {
        panic!("{error}")
    };
    assert_eq!(
        source.downcast_ref::<NotSettled>().expect("its own error").iterations,
        4
    );
}

#[test]
fn the_end_is_no_number() {
    let mut run = Integration::new(Damped, Dop853::default(), 0.0, &Damped::START, Settings::default()).expect("good");
    assert!(matches!(run.advance(f64::NAN), Err(IntegrationError::Settings(_))));
}

#[test]
fn after_a_failure_the_run_can_go_on_elsewhere() {
    let mut run = Integration::new(
        Function(1, root as Rhs),
        Adams::default(),
        0.0,
        &[1.0],
        Settings::default(),
    )
    .expect("good");
    while run.advance(2.0).is_ok() {}
    let (t, y) = run.state();
    let (t, y) = (t, y[0]);
    let mut out = [0.0];
    assert!(run.interpolate(0.5 * t, &mut out).is_err());
    run.interpolate(t, &mut out).expect("the state itself is known");
    assert_eq!(out[0], y);
    run.restart(0.0, &[1.0]).expect("good state");
    while !matches!(run.advance(0.5).expect("inside the domain"), Progress::Done { .. }) {}
}

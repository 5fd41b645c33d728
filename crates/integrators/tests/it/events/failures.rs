//! Failures of root functions and of changes at events.

use super::*;
use crate::problems::Any;

fn decay<G: FnMut(f64, f64) -> Result<f64, EvalError>>(mut root: G, change: Option<EvalError>) -> impl Problem {
    let mut change = change;
    Switched {
        dim: 1,
        roots: 2,
        pairs: 0,
        mode: 0.0,
        rhs: |_, _, y: &[f64], dy: &mut [f64]| dy[0] = -y[0],
        root: move |_, t, y: &[f64], g: &mut [f64]| {
            (g[0], g[1]) = (1.0, root(t, y[0])?);
            Ok(())
        },
        change: move |_: &mut f64, _, _: &mut [f64], _: &[bool]| change.take().map_or(Ok(()), Err),
    }
}

fn retry() -> EvalError {
    EvalError::Retry("outside".into())
}

#[test]
fn a_root_function_that_is_not_a_number() {
    let failure = |method: Box<dyn Method<Any<'static>>>, from: f64| {
        let problem = decay(move |t, _| Ok(if t >= from { f64::NAN } else { 1.0 }), None);
        let mut run = start(problem, method, 0.0, &[1.0], 1e-6);
        let (_, error) = events_until_failure(&mut run, 2.0);
        match error {
            Some(IntegrationError::NonFiniteRoot { time, function: 1 }) => time,
            other => panic!("{other:?}"),
        }
    };
    let methods = || -> [Box<dyn Method<Any<'static>>>; 6] {
        [
            Box::new(Rk4::new(0.01)),
            Box::new(DormandPrince5::default()),
            Box::new(Dop853::default()),
            Box::new(Adams::default()),
            Box::new(Radau5::default()),
            Box::new(Bdf::default()),
        ]
    };
    for method in methods() {
        assert_eq!(failure(method, -1.0), 0.0, "at the start");
    }
    for method in methods() {
        assert!((failure(method, 0.7) - 0.7).abs() <= 0.01 + 1e-9);
    }
}

/// A root function that asks for a shorter step gets it, and ends the run if that does not help.
#[test]
fn a_root_function_that_asks_for_shorter_steps() {
    let shy = decay(
        |t, y| {
            if (y - (-t).exp()).abs() > 1e-9 {
                Err(retry())
            } else {
                Ok(y - 0.5)
            }
        },
        None,
    );
    let mut run = start(shy, DormandPrince5::default(), 0.0, &[1.0], 1e-3);
    assert_close(&times(&mut run, 1.0), &[2.0_f64.ln()], 1e-8);
    assert!(run.statistics().retries > 0);
    let never = decay(|t, _| if t > 0.5 { Err(retry()) } else { Ok(1.0) }, None);
    let mut run = start(never, Dop853::default(), 0.0, &[1.0], 1e-6);
    let (_, error) = events_until_failure(&mut run, 1.0);
    match error {
        Some(IntegrationError::StepTooSmall {
            time,
            source: Some(source),
            ..
        }) => {
            assert!((time - 0.5).abs() < 1e-9);
            assert_eq!(source.to_string(), "outside");
        }
        other => panic!("{other:?}"),
    }
    let broken = decay(
        |t, _| {
            if t > 0.5 {
                Err(EvalError::Abort("broken".into()))
            } else {
                Ok(1.0)
            }
        },
        None,
    );
    let mut run = start(broken, Adams::default(), 0.0, &[1.0], 1e-6);
    assert!(matches!(
        events_until_failure(&mut run, 1.0).1,
        Some(IntegrationError::Problem { .. })
    ));
    // It need not be defined beyond the event.
    let edge = decay(|_, y| if y < 0.5 - 1e-12 { Err(retry()) } else { Ok(y - 0.5) }, None);
    let mut run = start(edge, Dop853::default(), 0.0, &[1.0], 1e-6);
    let (found, _) = events_until_failure(&mut run, 1.0);
    assert!(found.len() <= 1);
}

/// The state before the event is kept.
#[test]
fn a_change_that_fails() {
    for error in [retry(), EvalError::Abort("broken".into())] {
        let mut run = start(
            decay(|_, y| Ok(y - 0.5), Some(error)),
            Dop853::default(),
            0.0,
            &[1.0],
            1e-9,
        );
        let (found, error) = events_until_failure(&mut run, 1.0);
        assert!(found.is_empty());
        match error {
            Some(IntegrationError::Problem { time, .. }) => assert!((time - 2.0_f64.ln()).abs() < 1e-8),
            other => panic!("{other:?}"),
        }
        assert!((run.state().1[0] - 0.5).abs() < 1e-14);
        assert_eq!(run.statistics().events, 0);
        // The change succeeds at the second time; the event is not lost.
        assert_eq!(times(&mut run, 1.0).len(), 1);
    }
    let mut lost = Switched {
        dim: 1,
        roots: 1,
        pairs: 0,
        mode: 0.0,
        rhs: |_, _, _: &[f64], dy: &mut [f64]| dy[0] = -1.0,
        root: |_, _, y: &[f64], g: &mut [f64]| {
            g[0] = y[0];
            Ok(())
        },
        change: |_: &mut f64, _, y: &mut [f64], _: &[bool]| {
            y[0] = f64::NAN;
            Ok(())
        },
    };
    let mut run = start(&mut lost, Rk4::new(0.3), 0.0, &[1.0], 1e-9);
    let (_, error) = events_until_failure(&mut run, 2.0);
    assert!(
        matches!(error, Some(IntegrationError::NonFinite { component: 0, .. })),
        "{error:?}"
    );
    assert!(run.state().1[0].abs() < 1e-15);
}

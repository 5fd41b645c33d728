//! Settings that make no sense are refused, each with its own error.

use linkdyn_integrators::{
    Corrector, Dop853, Integration, IntegrationError, Method, Newmark, Rk4, Settings, SettingsError, Tolerance,
};

use crate::problems::Damped;

fn refusal<M: Method<Damped>>(method: M, t0: f64, y0: &[f64], settings: Settings) -> SettingsError {
    match Integration::new(Damped, method, t0, y0, settings) {
        Err(IntegrationError::Settings(error)) => error,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("accepted"),
    }
}

fn refused(settings: Settings) -> SettingsError {
    refusal(Dop853::default(), 0.0, &Damped::START, settings)
}

#[test]
fn relative_tolerance() {
    for value in [-1e-6, f64::NAN, 1.0, 1e3, f64::INFINITY, f64::NEG_INFINITY] {
        let error = refused(Settings::tolerances(value, 1e-6));
        assert!(
            matches!(
                error,
                SettingsError::Tolerance {
                    name: "relative",
                    component: 0,
                    ..
                }
            ),
            "{error}"
        );
    }
}

#[test]
fn absolute_tolerance() {
    for value in [0.0, -1e-6, f64::NAN, f64::NEG_INFINITY] {
        let error = refused(Settings::tolerances(1e-6, vec![1e-6, value, 1e-6]));
        assert!(
            matches!(
                error,
                SettingsError::Tolerance {
                    name: "absolute",
                    component: 1,
                    ..
                }
            ),
            "{error}"
        );
    }
}

#[test]
fn length_of_lists() {
    let error = refused(Settings::tolerances(vec![1e-6; 2], 1e-6));
    assert_eq!(
        error,
        SettingsError::Length {
            name: "relative",
            expected: 3,
            found: 2
        }
    );
    let error = refused(Settings::tolerances(1e-6, &[1e-6; 4][..]));
    assert_eq!(
        error,
        SettingsError::Length {
            name: "absolute",
            expected: 3,
            found: 4
        }
    );
    let error = refusal(Dop853::default(), 0.0, &[1.0], Settings::default());
    assert_eq!(
        error,
        SettingsError::Length {
            name: "start",
            expected: 3,
            found: 1
        }
    );
}

#[test]
fn lengths_of_steps() {
    for value in [0.0, -1.0, f64::NAN] {
        let first = refused(Settings {
            first_step: Some(value),
            ..Settings::default()
        });
        assert!(matches!(first, SettingsError::Step { name: "first_step", .. }));
        let longest = refused(Settings {
            max_step: value,
            ..Settings::default()
        });
        assert!(matches!(longest, SettingsError::Step { name: "max_step", .. }));
        let fixed = refusal(Rk4::new(value), 0.0, &Damped::START, Settings::default());
        assert!(matches!(fixed, SettingsError::Step { .. }));
    }
    assert!(matches!(
        refused(Settings {
            first_step: Some(f64::INFINITY),
            ..Settings::default()
        }),
        SettingsError::Step { .. }
    ));
}

#[test]
fn no_steps_at_all() {
    assert_eq!(
        refused(Settings {
            max_steps: 0,
            ..Settings::default()
        }),
        SettingsError::NoSteps
    );
}

#[test]
fn start() {
    for value in [f64::NAN, f64::INFINITY] {
        let time = refusal(Dop853::default(), value, &Damped::START, Settings::default());
        assert!(matches!(time, SettingsError::NotFinite { name: "start time", .. }));
        let state = refusal(Dop853::default(), 0.0, &[1.0, value, 0.0], Settings::default());
        assert!(matches!(state, SettingsError::NotFinite { name: "start", .. }));
        let run = Integration::new(Damped, Dop853::default(), 0.0, &Damped::START, Settings::default()).expect("good");
        assert!(run.with_stops(&[1.0, value]).is_err());
    }
}

#[test]
fn parameters_of_newmark() {
    let bad = [
        Newmark::new(0.1, Corrector::Times(0)),
        Newmark::new(
            0.1,
            Corrector::Until {
                change: 1e-9,
                at_most: 0,
            },
        ),
        Newmark::new(
            0.1,
            Corrector::Until {
                change: 0.0,
                at_most: 5,
            },
        ),
        Newmark::new(
            0.1,
            Corrector::Until {
                change: f64::NAN,
                at_most: 5,
            },
        ),
        Newmark::new(0.1, Corrector::Times(1)).with_coefficients(0.6, 0.5),
        Newmark::new(0.1, Corrector::Times(1)).with_coefficients(0.25, f64::NAN),
    ];
    for method in bad {
        let error = refusal(method, 0.0, &Damped::START, Settings::default());
        assert!(matches!(error, SettingsError::Method(_)), "{error}");
    }
}

#[test]
fn tiny_tolerances_are_taken_as_ten_epsilon() {
    let settings = Settings {
        relative: Tolerance::Scalar(1e-20),
        ..Settings::tolerances(0.0, 1e-300)
    };
    let mut run = Integration::new(Damped, Dop853::default(), 0.0, &[1.0, 0.5, 1.0], settings).expect("clamped");
    run.advance(0.1).expect("one step");
}

//! Every field refuses what its formula cannot work with, by name and value.

use crate::fixtures::*;
use linkdyn_friction::*;
use proptest::prelude::*;

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn same(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

/// The field must be refused for these values and for anything that is not finite.
#[track_caller]
fn refuses(field: &'static str, values: &[f64], validate: impl Fn(f64) -> Result<(), ParameterError>) {
    for &value in values.iter().chain(&NOT_FINITE) {
        let error = validate(value).expect_err(&format!("{field} = {value} was accepted"));
        assert_eq!(error.field, field);
        assert!(same(error.value, value), "{error}");
        let text = error.to_string();
        assert!(text.contains(field) && text.contains(&value.to_string()), "{text}");
    }
}

/// What a speed, a length or an exponent must not be.
const NOT_POSITIVE: [f64; 4] = [0.0, -0.0, -1.0, 1e-310];
/// What a coefficient must not be.
const NEGATIVE: [f64; 2] = [-1e-9, -10.0];

#[test]
fn message_says_field_value_and_remedy() {
    let error = Exponential {
        reference_speed: -0.5,
        ..EXPONENTIAL
    }
    .validate()
    .unwrap_err();
    assert_eq!(
        error,
        ParameterError {
            field: "reference_speed",
            value: -0.5,
            expected: Expected::Positive
        }
    );
    assert_eq!(
        error.to_string(),
        "reference_speed is -0.5, but must be finite and greater than zero"
    );
}

#[test]
fn message_of_crossed_coefficients_names_both() {
    let error = LuGre {
        static_coefficient: 0.05,
        ..LUGRE
    }
    .validate()
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "static_coefficient is 0.05, but must be finite and at least 0.1 (kinetic_coefficient)"
    );
}

#[test]
fn exponential_speed() {
    refuses("reference_speed", &NOT_POSITIVE, |reference_speed| {
        Exponential {
            reference_speed,
            ..EXPONENTIAL
        }
        .validate()
    });
}

#[test]
fn exponential_steepness() {
    refuses("steepness", &NOT_POSITIVE, |steepness| {
        Exponential {
            steepness,
            ..EXPONENTIAL
        }
        .validate()
    });
}

#[test]
fn piecewise_linear_speed() {
    refuses("reference_speed", &NOT_POSITIVE, |reference_speed| {
        PiecewiseLinear { reference_speed }.validate()
    });
}

#[test]
fn hyperbolic_tangent_speed() {
    refuses("reference_speed", &NOT_POSITIVE, |reference_speed| {
        HyperbolicTangent { reference_speed }.validate()
    });
}

#[test]
fn cubic_speed() {
    refuses("reference_speed", &NOT_POSITIVE, |reference_speed| {
        Cubic { reference_speed }.validate()
    });
}

#[test]
fn stribeck_static_below_kinetic() {
    refuses("static_ratio", &[0.99, 0.0, -1.0], |static_ratio| {
        Stribeck {
            static_ratio,
            ..STRIBECK
        }
        .validate()
    });
}

#[test]
fn stribeck_speed() {
    refuses("stribeck_speed", &NOT_POSITIVE, |stribeck_speed| {
        Stribeck {
            stribeck_speed,
            ..STRIBECK
        }
        .validate()
    });
}

#[test]
fn stribeck_exponent() {
    refuses("exponent", &NOT_POSITIVE, |exponent| {
        Stribeck { exponent, ..STRIBECK }.validate()
    });
}

#[test]
fn stribeck_sign_speed() {
    refuses("reference_speed", &NOT_POSITIVE, |reference_speed| {
        Stribeck {
            reference_speed,
            ..STRIBECK
        }
        .validate()
    });
}

#[test]
fn viscous_growth() {
    refuses("per_speed", &NEGATIVE, |per_speed| Viscous { per_speed }.validate());
}

#[test]
fn sum_refuses_either_part() {
    let good = Viscous { per_speed: 1.0 };
    refuses("per_speed", &NEGATIVE, |per_speed| {
        Sum {
            first: Viscous { per_speed },
            second: good,
        }
        .validate()
    });
    refuses("per_speed", &NEGATIVE, |per_speed| {
        Sum {
            first: good,
            second: Viscous { per_speed },
        }
        .validate()
    });
}

#[test]
fn lugre_kinetic_coefficient() {
    refuses("kinetic_coefficient", &NEGATIVE, |kinetic_coefficient| {
        LuGre {
            kinetic_coefficient,
            ..LUGRE
        }
        .validate()
    });
}

#[test]
fn lugre_static_below_kinetic() {
    refuses("static_coefficient", &[0.09, 0.0, -1.0], |static_coefficient| {
        LuGre {
            static_coefficient,
            ..LUGRE
        }
        .validate()
    });
}

#[test]
fn lugre_stribeck_speed() {
    refuses("stribeck_speed", &NOT_POSITIVE, |stribeck_speed| {
        LuGre {
            stribeck_speed,
            ..LUGRE
        }
        .validate()
    });
}

#[test]
fn lugre_bristle_stiffness() {
    refuses("bristle_stiffness", &NEGATIVE, |bristle_stiffness| {
        LuGre {
            bristle_stiffness,
            ..LUGRE
        }
        .validate()
    });
}

#[test]
fn lugre_bristle_damping() {
    refuses("bristle_damping", &NEGATIVE, |bristle_damping| {
        LuGre {
            bristle_damping,
            ..LUGRE
        }
        .validate()
    });
}

#[test]
fn lugre_viscous_coefficient() {
    refuses("viscous_coefficient", &NEGATIVE, |viscous_coefficient| {
        LuGre {
            viscous_coefficient,
            ..LUGRE
        }
        .validate()
    });
}

#[test]
fn lugre_decay_speed() {
    refuses("guard.decay.speed", &NOT_POSITIVE, |speed| {
        LuGre {
            guard: Guard::Decay { speed },
            ..LUGRE
        }
        .validate()
    });
}

#[test]
fn elasto_plastic_share() {
    refuses("elastic_share", &[-0.1, 1.0, 1.5], |elastic_share| {
        ElastoPlastic {
            lugre: LUGRE,
            elastic_share,
        }
        .validate()
    });
}

#[test]
fn elasto_plastic_refuses_its_lugre() {
    refuses("bristle_damping", &NEGATIVE, |bristle_damping| {
        let lugre = LuGre {
            bristle_damping,
            ..LUGRE
        };
        ElastoPlastic {
            lugre,
            elastic_share: 0.5,
        }
        .validate()
    });
}

#[test]
fn journal_spacing() {
    refuses("spacing", &NOT_POSITIVE, |spacing| {
        JournalBearing { spacing, ..JOURNAL }.validate()
    });
}

#[test]
fn journal_diameters() {
    let coefficient = 0.2;
    refuses("surface_a.diameter", &NOT_POSITIVE, |diameter| {
        JournalBearing {
            surface_a: Surface { diameter, coefficient },
            ..JOURNAL
        }
        .validate()
    });
    refuses("surface_b.diameter", &NOT_POSITIVE, |diameter| {
        JournalBearing {
            surface_b: Surface { diameter, coefficient },
            ..JOURNAL
        }
        .validate()
    });
}

#[test]
fn journal_face_inside_the_journal() {
    refuses("face.diameter", &[0.00999, 0.0, -0.015], |diameter| {
        JournalBearing {
            face: Surface {
                diameter,
                coefficient: 0.2,
            },
            ..JOURNAL
        }
        .validate()
    });
}

#[test]
fn journal_coefficients() {
    let with = |coefficient| Surface {
        diameter: 0.01,
        coefficient,
    };
    refuses("surface_a.coefficient", &NEGATIVE, |mu| {
        JournalBearing {
            surface_a: with(mu),
            ..JOURNAL
        }
        .validate()
    });
    refuses("surface_b.coefficient", &NEGATIVE, |mu| {
        JournalBearing {
            surface_b: with(mu),
            ..JOURNAL
        }
        .validate()
    });
    refuses("face.coefficient", &NEGATIVE, |mu| {
        JournalBearing {
            face: with(mu),
            ..JOURNAL
        }
        .validate()
    });
}

#[test]
fn scaling_by_a_negative_factor_is_caught() {
    assert!(JOURNAL.scaled(-1.0).validate().is_err());
    assert!(GUIDE.scaled(f64::NAN).validate().is_err());
}

#[test]
fn guide_lengths() {
    refuses("spacing", &NOT_POSITIVE, |spacing| {
        PadGuide { spacing, ..GUIDE }.validate()
    });
    refuses("arm", &NOT_POSITIVE, |arm| PadGuide { arm, ..GUIDE }.validate());
}

#[test]
fn guide_coefficients() {
    refuses("pad_a", &NEGATIVE, |pad_a| PadGuide { pad_a, ..GUIDE }.validate());
    refuses("pad_b", &NEGATIVE, |pad_b| PadGuide { pad_b, ..GUIDE }.validate());
    refuses("key", &NEGATIVE, |key| PadGuide { key, ..GUIDE }.validate());
}

#[test]
fn choices_refuse_what_their_law_refuses() {
    assert!(Friction::from(Cubic { reference_speed: 0.0 }).validate().is_err());
    assert!(
        Bearing::from(JournalBearing {
            spacing: 0.0,
            ..JOURNAL
        })
        .validate()
        .is_err()
    );
    assert!(Bearing::from(PadGuide { arm: 0.0, ..GUIDE }).validate().is_err());
    assert!(
        Bristle::from(LuGre {
            stribeck_speed: 0.0,
            ..LUGRE
        })
        .validate()
        .is_err()
    );
    let bad = Cubic { reference_speed: 0.0 };
    assert!(
        Friction::from(Sum {
            first: bad,
            second: Viscous { per_speed: 0.0 }
        })
        .validate()
        .is_err()
    );
}

#[test]
fn no_friction_and_much_friction_are_valid() {
    for mu in [0.0, 10.0] {
        JOURNAL.scaled(mu).validate().unwrap();
        GUIDE.scaled(mu).validate().unwrap();
        LuGre::dahl(mu, 100.0).validate().unwrap();
    }
    LuGre {
        bristle_stiffness: 0.0,
        ..LUGRE
    }
    .validate()
    .unwrap();
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn generated_parameters_are_accepted((law, _) in bounded(), lugre in lugre(), bearing in bearing()) {
        prop_assert!(law.validate().is_ok());
        prop_assert!(lugre.validate().is_ok());
        prop_assert!(bearing.validate().is_ok());
    }
}

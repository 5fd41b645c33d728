//! Every parameter refuses what its formula cannot work with, by name and value.

use linkdyn_contact::*;

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[track_caller]
fn refuses<T>(field: &'static str, values: &[f64], make: impl Fn(f64) -> Result<T, ParameterError>) {
    for &value in values.iter().chain(&NOT_FINITE) {
        let Err(error) = make(value) else {
            panic!("{field} = {value} was accepted")
        };
        assert_eq!(error.field, field);
        assert!(error.value == value || value.is_nan(), "{error}");
        let text = error.to_string();
        assert!(text.contains(field) && text.contains(&value.to_string()), "{text}");
    }
}

const NOT_POSITIVE: [f64; 4] = [0.0, -0.0, -1.0, 1e-310];

#[test]
fn law_refuses() {
    let damping = RestitutionLaw::LankaraniNikravesh.with(0.9);
    refuses("stiffness", &NOT_POSITIVE, |k| NormalLaw::new(k, 1.5, damping));
    refuses("exponent", &[0.0, 0.99, -1.5], |n| NormalLaw::new(1e9, n, damping));
    refuses("constant", &[-1e-9], |constant| {
        NormalLaw::new(1e9, 1.5, Damping::Material { constant })
    });
    let law = NormalLaw::new(1e9, 1.5, damping).unwrap();
    refuses("least_impact_speed", &NOT_POSITIVE, |v| law.with_least_impact_speed(v));
    law.validate().unwrap();
}

#[test]
fn restitution_is_a_fraction() {
    use RestitutionLaw::*;
    for law in RestitutionLaw::ALL {
        refuses("restitution", &[-1e-9, 1.0 + 1e-9, 2.0], |e| law.damping_factor(e));
        let at_zero = law.damping_factor(0.0);
        match law {
            Gonthier | Flores | HuGuo | Exact => {
                let text = at_zero.unwrap_err().to_string();
                assert_eq!(text, "restitution is 0, but must be greater than zero and at most one");
            }
            _ => assert!(at_zero.unwrap().is_finite()),
        }
    }
}

#[test]
fn kelvin_voigt_refuses() {
    let law = KelvinVoigt {
        stiffness: 1e6,
        damping: 10.0,
    };
    refuses("stiffness", &NOT_POSITIVE, |stiffness| {
        KelvinVoigt { stiffness, ..law }.validate()
    });
    refuses("damping", &[-1e-9], |damping| KelvinVoigt { damping, ..law }.validate());
    KelvinVoigt { damping: 0.0, ..law }.validate().unwrap();
}

#[test]
fn materials_refuse() {
    let of = |youngs_modulus, poisson_ratio| {
        Material {
            youngs_modulus,
            poisson_ratio,
        }
        .compliance()
    };
    refuses("youngs_modulus", &NOT_POSITIVE, |e| of(e, 0.3));
    refuses("poisson_ratio", &[-1.0, 0.51, 2.0], |nu| of(2e11, nu));
    assert!(of(2e11, 0.5).is_ok());
}

#[test]
fn radii_that_do_not_fit_are_refused() {
    refuses("socket_radius", &NOT_POSITIVE, |r| ball_in_socket(r, 0.004, 1e-11));
    refuses("ball_radius", &[0.0, -1.0, 0.005, 0.006], |r| {
        ball_in_socket(0.005, r, 1e-11)
    });
    refuses("compliance", &NOT_POSITIVE, |s| ball_in_socket(0.005, 0.004, s));
    refuses("radius_i", &NOT_POSITIVE, |r| balls(r, 0.004, 1e-11));
    refuses("radius_j", &NOT_POSITIVE, |r| balls(0.004, r, 1e-11));
    refuses("radius", &NOT_POSITIVE, |r| ball_on_plane(r, 1e-11));
    refuses("bearing_radius", &NOT_POSITIVE, |r| Fit::new(r, 0.004));
    refuses("journal_radius", &[0.0, -1.0, 0.005, 0.006], |r| Fit::new(0.005, r));
    assert_eq!(
        Fit::new(0.005, 0.006).unwrap_err().to_string(),
        "journal_radius is 0.006, but must be greater than zero and below 0.005 (bearing_radius)"
    );
    assert_eq!(ball_on_plane(1.0, 1e-308).unwrap_err().field, "compliance");
    assert_eq!(
        ball_on_plane(f64::MAX, f64::MIN_POSITIVE).unwrap_err().field,
        "stiffness"
    );
}

//! What no beam can be made of is refused by name, value and range; never a panic, never NaN or infinity as a result.

use crate::fixtures::*;
use linkdyn_rfem::*;
use proptest::prelude::*;

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const NOT_POSITIVE: [f64; 4] = [0.0, -0.0, -1.0, 1e-310];
const NEGATIVE: [f64; 2] = [-1e-9, -10.0];

/// The item must be refused for these values and for anything that is not finite.
#[track_caller]
fn refuses<T: std::fmt::Debug>(item: &str, values: &[f64], with: impl Fn(f64) -> Result<T, BeamError>) {
    for &value in values.iter().chain(&NOT_FINITE) {
        let error = with(value).expect_err(&format!("{item} = {value} was accepted"));
        assert_eq!(error.item, item);
        assert!(
            error.value == value || (error.value.is_nan() && value.is_nan()),
            "{error}"
        );
        let text = error.to_string();
        assert!(text.contains(item) && text.contains(&value.to_string()), "{text}");
    }
}

fn cut(section: Section, material: Material) -> Result<Beam, BeamError> {
    divide(1.0, &section, &material, Division::Standard(3))
}

#[test]
fn message_says_item_value_and_remedy() {
    let error = divide(-0.4, &OWN, &STEEL, Division::Standard(4)).unwrap_err();
    let expected = Expected::Positive;
    assert_eq!(
        error,
        BeamError {
            item: "length",
            value: -0.4,
            expected
        }
    );
    assert_eq!(
        error.to_string(),
        "length is -0.4, but must be finite and greater than zero"
    );
    let error = Section::tube(0.02, 0.03).unwrap_err();
    assert_eq!(
        error.to_string(),
        "inner_diameter is 0.03, but must be not negative and below 0.02 (outer_diameter)"
    );
    let error = Material::isotropic(7850.0, 2.1e11, 0.6, 0.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "poissons_ratio is 0.6, but must be above -1 and at most 0.5"
    );
    let error = Material {
        relaxation_time: -1.0,
        ..STEEL
    }
    .validate()
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "material.relaxation_time is -1, but must be finite and not negative"
    );
}

#[test]
fn counts() {
    for (division, text) in [
        (
            Division::Standard(0),
            "division.standard is 0, but must be from 1 to 10000",
        ),
        (
            Division::Standard(10_001),
            "division.standard is 10001, but must be from 1 to 10000",
        ),
        (Division::Equal(1), "division.equal is 1, but must be from 2 to 10000"),
        (
            Division::Equal(10_001),
            "division.equal is 10001, but must be from 2 to 10000",
        ),
    ] {
        assert_eq!(divide(1.0, &OWN, &STEEL, division).unwrap_err().to_string(), text);
    }
    assert!(divide(1.0, &OWN, &STEEL, Division::Standard(usize::MAX)).is_err());
}

#[test]
fn lengths_and_sides() {
    refuses("length", &NOT_POSITIVE, |l| {
        divide(l, &OWN, &STEEL, Division::Standard(3))
    });
    refuses("diameter", &NOT_POSITIVE, Section::circle);
    refuses("outer_diameter", &NOT_POSITIVE, |d| Section::tube(d, 0.01));
    refuses("inner_diameter", &[-0.01, 0.02, 0.03], |d| Section::tube(0.02, d));
    refuses("width", &NOT_POSITIVE, |b| Section::rectangle(b, 0.01));
    refuses("height", &NOT_POSITIVE, |h| Section::rectangle(0.01, h));
}

#[test]
fn sections() {
    refuses("section.area", &NOT_POSITIVE, |area| {
        cut(Section { area, ..OWN }, STEEL)
    });
    refuses("section.bending[0]", &NOT_POSITIVE, |i| {
        cut(
            Section {
                bending: [i, 1e-9],
                ..OWN
            },
            STEEL,
        )
    });
    refuses("section.bending[1]", &NOT_POSITIVE, |i| {
        cut(
            Section {
                bending: [1e-9, i],
                ..OWN
            },
            STEEL,
        )
    });
    refuses("section.torsion", &NOT_POSITIVE, |torsion| {
        cut(Section { torsion, ..OWN }, STEEL)
    });
    let with = |factors| Section {
        shear_factors: factors,
        ..OWN
    };
    refuses("section.shear_factors[0]", &NEGATIVE, |k| cut(with([k, 1.0]), STEEL));
    refuses("section.shear_factors[1]", &NEGATIVE, |k| cut(with([1.0, k]), STEEL));
    // Rigid in shear: only where the springs do not become infinitely stiff by it.
    assert_eq!(
        cut(with([1.0, 0.0]), STEEL).unwrap_err().item,
        "section.shear_factors[1]"
    );
    assert!(divide_with(1.0, &with([0.0, 0.0]), &STEEL, Division::Standard(1), Shear::Improved).is_ok());
}

#[test]
fn materials() {
    refuses("material.density", &NOT_POSITIVE, |density| {
        cut(OWN, Material { density, ..STEEL })
    });
    refuses("material.youngs_modulus", &NOT_POSITIVE, |e| {
        cut(
            OWN,
            Material {
                youngs_modulus: e,
                ..STEEL
            },
        )
    });
    refuses("material.shear_modulus", &NOT_POSITIVE, |g| {
        cut(
            OWN,
            Material {
                shear_modulus: g,
                ..STEEL
            },
        )
    });
    refuses("material.relaxation_time", &NEGATIVE, |tau| {
        cut(
            OWN,
            Material {
                relaxation_time: tau,
                ..STEEL
            },
        )
    });
    refuses("poissons_ratio", &[-1.0, -2.0, 0.500001, 3.0], |nu| {
        Material::isotropic(1.0, 1.0, nu, 0.0)
    });
    refuses("material.density", &NOT_POSITIVE, |rho| {
        Material::isotropic(rho, 1.0, 0.3, 0.0)
    });
    refuses("material.youngs_modulus", &NOT_POSITIVE, |e| {
        Material::isotropic(1.0, e, 0.3, 0.0)
    });
    near(
        Material::isotropic(1.0, 2.6, 0.3, 0.0).unwrap().shear_modulus,
        1.0,
        1e-15,
    );
}

#[test]
fn results_out_of_range_are_named() {
    let section = Section { area: 1e-200, ..OWN };
    let error = cut(
        section,
        Material {
            density: 1e-200,
            ..STEEL
        },
    )
    .unwrap_err();
    assert_eq!(error.item, "mass of an element");
    let stiff = Material {
        youngs_modulus: 1e300,
        ..STEEL
    };
    let error = cut(Section { area: 1e10, ..OWN }, stiff).unwrap_err();
    assert_eq!(
        (error.item, error.value),
        ("longitudinal stiffness of an sde", f64::INFINITY)
    );
    let error = cut(
        OWN,
        Material {
            relaxation_time: 1e305,
            ..STEEL
        },
    )
    .unwrap_err();
    assert_eq!((error.item, error.value), ("damping of an sde", f64::INFINITY));
    assert_eq!(Section::circle(1e-100).unwrap_err().item, "section.bending[0]");
    assert_eq!(Section::rectangle(1e200, 1e200).unwrap_err().item, "section.area");
}

fn anything() -> impl Strategy<Value = f64> {
    prop_oneof![any::<f64>(), 1e-3..1e3, (-300..300_i32).prop_map(|e| 10_f64.powi(e))]
}

proptest! {
    /// Either an error or numbers: all finite, masses and stiffnesses positive.
    #[test]
    fn never_a_panic_never_a_number_that_is_none(
        l in anything(), [area, iy, iz, j, ky, kz] in prop::array::uniform6(anything()),
        [rho, e, g, tau] in prop::array::uniform4(anything()), division in any_division(), improved in any::<bool>(),
    ) {
        let section = Section { area, bending: [iy, iz], torsion: j, shear_factors: [ky, kz] };
        let material = Material { density: rho, youngs_modulus: e, shear_modulus: g, relaxation_time: tau };
        let shear = if improved { Shear::Improved } else { Shear::Classical };
        if let Ok(beam) = divide_with(l, &section, &material, division, shear) {
            for rfe in &beam.elements {
                prop_assert!(rfe.start.is_finite() && rfe.start >= 0.0);
                for value in [rfe.length, rfe.mass, rfe.inertia[0], rfe.inertia[1], rfe.inertia[2]] {
                    prop_assert!(value.is_finite() && value > 0.0, "{rfe:?}");
                }
            }
            for sde in &beam.springs {
                for c in [sde.stretch, sde.shear[0], sde.shear[1], sde.twist, sde.bend[0], sde.bend[1]] {
                    prop_assert!(c.stiffness.is_finite() && c.stiffness > 0.0, "{sde:?}");
                    prop_assert!(c.damping.is_finite() && c.damping >= 0.0, "{sde:?}");
                }
            }
        }
    }

    #[test]
    fn sections_are_valid_or_refused([a, b] in prop::array::uniform2(anything())) {
        for section in [Section::circle(a), Section::tube(a, b), Section::rectangle(a, b)].into_iter().flatten() {
            prop_assert!(section.validate().is_ok());
            prop_assert!(section.torsion <= section.polar() * (1.0 + 1e-14));
        }
    }
}

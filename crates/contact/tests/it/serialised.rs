//! Names of the file format, and refusal of what cannot be.

use crate::fixtures::*;
use linkdyn_contact::*;
use serde_json::{from_str, json, to_value};

#[test]
fn names_are_those_of_the_fields() {
    assert_eq!(
        to_value(ContactLaw::from(rsup())).unwrap(),
        json!({ "family": {
            "stiffness": 2.176e10, "exponent": 1.5, "least_impact_speed": 1e-6,
            "damping": { "restitution": { "law": "lankarani_nikravesh", "restitution": 0.9 } },
        } })
    );
    assert_eq!(
        to_value(ContactLaw::from(KelvinVoigt {
            stiffness: 1e6,
            damping: 2.0
        }))
        .unwrap(),
        json!({ "kelvin_voigt": { "stiffness": 1e6, "damping": 2.0 } })
    );
    assert_eq!(
        to_value(rsup_fit()).unwrap(),
        json!({ "bearing_radius": 0.005, "journal_radius": 0.004 })
    );
    assert_eq!(to_value(ForcePoint::OwnSurface).unwrap(), json!("own_surface"));
}

#[test]
fn writing_and_reading_gives_the_same() {
    let law = rsup().with_least_impact_speed(1e-3).unwrap();
    let text = serde_json::to_string(&law).unwrap();
    assert_eq!(from_str::<NormalLaw>(&text).unwrap(), law);
    let text = serde_json::to_string(&rsup_fit()).unwrap();
    assert_eq!(from_str::<Fit>(&text).unwrap(), rsup_fit());
}

#[test]
fn floor_may_be_left_out() {
    let text = r#"{ "stiffness": 1e9, "exponent": 1.5, "damping": "hertz" }"#;
    let law: NormalLaw = from_str(text).unwrap();
    assert_eq!(law, NormalLaw::new(1e9, 1.5, Damping::Hertz).unwrap());
}

#[test]
fn impossible_parameters_are_refused_on_reading() {
    let text = r#"{ "stiffness": 1e9, "exponent": 0.5, "damping": "hertz" }"#;
    let error = from_str::<NormalLaw>(text).unwrap_err().to_string();
    assert!(error.contains("exponent is 0.5"), "{error}");
    let error = from_str::<Fit>(r#"{ "bearing_radius": 1, "journal_radius": 2 }"#)
        .unwrap_err()
        .to_string();
    assert!(error.contains("journal_radius is 2"), "{error}");
}

#[test]
fn misspelt_fields_are_refused() {
    assert!(from_str::<Fit>(r#"{ "bearing_radius": 2, "journal_radius": 1, "length": 1 }"#).is_err());
    assert!(from_str::<Material>(r#"{ "youngs_modulus": 2e11, "poisson": 0.3 }"#).is_err());
    assert!(from_str::<Damping>(r#"{ "material": { "alpha": 0.3 } }"#).is_err());
    assert!(from_str::<ContactLaw>(r#"{ "custom": {} }"#).is_err());
}

//! Names of the file format, and refusal of misspelt ones.

use crate::fixtures::*;
use linkdyn_friction::*;
use serde_json::{from_str, json, to_value};

#[test]
fn names_are_those_of_the_fields() {
    let law = Friction::from(EXPONENTIAL);
    assert_eq!(
        to_value(law).unwrap(),
        json!({ "exponential": { "reference_speed": 0.01, "steepness": 3.0 } })
    );
    assert_eq!(
        to_value(Bearing::from(GUIDE)).unwrap(),
        json!({ "pad_guide": { "spacing": 0.1, "arm": 0.02, "pad_a": 0.1, "pad_b": 0.15, "key": 0.2 } })
    );
    assert_eq!(
        to_value(Guard::Decay { speed: 0.5 }).unwrap(),
        json!({ "decay": { "speed": 0.5 } })
    );
    assert_eq!(to_value(BristleStart::Steady).unwrap(), json!("steady"));
}

#[test]
fn writing_and_reading_gives_the_same() {
    let text = serde_json::to_string(&Bearing::from(JOURNAL)).unwrap();
    let Bearing::Journal(back) = from_str(&text).unwrap() else {
        panic!("{text}")
    };
    assert_eq!(back, JOURNAL);

    let capped = LuGre {
        guard: Guard::Cap,
        ..LUGRE
    };
    let text = serde_json::to_string(&Bristle::from(capped)).unwrap();
    let Bristle::LuGre(back) = from_str(&text).unwrap() else {
        panic!("{text}")
    };
    assert_eq!(back, capped);
}

#[test]
fn sums_nest() {
    let text = r#"{ "sum": { "first": { "cubic": { "reference_speed": 0.1 } },
                             "second": { "viscous": { "per_speed": 2.0 } } } }"#;
    let law: Friction = from_str(text).unwrap();
    assert_eq!(law.at(1.0).value, 3.0);
}

#[test]
fn guard_may_be_left_out() {
    let text = r#"{ "static_coefficient": 0.2, "kinetic_coefficient": 0.1, "stribeck_speed": 0.0175,
        "bristle_stiffness": 600, "bristle_damping": 24.49489742783178, "viscous_coefficient": 0 }"#;
    assert_eq!(from_str::<LuGre>(text).unwrap(), LUGRE);
}

#[test]
fn misspelt_field_is_refused() {
    assert!(from_str::<Cubic>(r#"{ "reference_sped": 1.0 }"#).is_err());
    assert!(from_str::<Cubic>(r#"{ "reference_speed": 1.0, "steepness": 3.0 }"#).is_err());
}

#[test]
fn missing_field_is_refused() {
    assert!(from_str::<Exponential>(r#"{ "reference_speed": 1.0 }"#).is_err());
}

#[test]
fn unknown_law_is_refused() {
    assert!(from_str::<Friction>(r#"{ "coulomb": {} }"#).is_err());
    assert!(from_str::<Friction>(r#"{ "custom": {} }"#).is_err());
}

#[test]
fn own_law_cannot_be_written() {
    #[derive(Debug)]
    struct Own;
    impl Characteristic for Own {
        fn at(&self, _: f64) -> Value {
            Value::default()
        }
    }
    assert!(to_value(Friction::Custom(std::sync::Arc::new(Own))).is_err());
}

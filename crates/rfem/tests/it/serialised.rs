//! Names of the file format, and refusal of misspelt ones.

use crate::fixtures::*;
use linkdyn_rfem::modes::{Axis, BarEnds, Ends};
use linkdyn_rfem::*;
use serde_json::{from_str, from_value, json, to_value};

#[test]
fn names_are_those_of_the_fields() {
    assert_eq!(
        to_value(OWN).unwrap(),
        json!({ "area": 3e-4, "bending": [5e-9, 2e-8], "torsion": 7e-9, "shear_factors": [1.5, 2.5] })
    );
    assert_eq!(
        to_value(STEEL).unwrap(),
        json!({ "density": 7850.0, "youngs_modulus": 2.1e11, "shear_modulus": 8.1e10, "relaxation_time": 2e-5 })
    );
    assert_eq!(to_value(Division::Standard(4)).unwrap(), json!({ "standard": 4 }));
    assert_eq!(to_value(Division::Equal(5)).unwrap(), json!({ "equal": 5 }));
    assert_eq!(to_value(Shear::Improved).unwrap(), json!("improved"));
    assert_eq!(to_value(Ends::ClampedFree).unwrap(), json!("clamped_free"));
    assert_eq!(to_value(BarEnds::FixedFree).unwrap(), json!("fixed_free"));
    assert_eq!(to_value(Axis::Y).unwrap(), json!("y"));
}

#[test]
fn writing_and_reading_gives_the_same() {
    let beam = standard(0.4, &OWN, 3);
    let value = to_value(&beam).unwrap();
    assert_eq!(
        value["springs"][2]["bend"][1]["stiffness"],
        beam.springs[2].bend[1].stiffness
    );
    assert_eq!(from_value::<Beam>(value).unwrap(), beam);
}

#[test]
fn misspelt_and_missing_fields_are_refused() {
    let text = serde_json::to_string(&STEEL).unwrap();
    assert_eq!(from_str::<Material>(&text).unwrap(), STEEL);
    assert!(from_str::<Material>(&text.replace("density", "densty")).is_err());
    assert!(from_str::<Material>(&text.replace("}", ", \"colour\": 1}")).is_err());
    assert!(from_str::<Section>(r#"{ "area": 1.0 }"#).is_err());
    assert!(from_str::<Division>(r#"{ "halves": 2 }"#).is_err());
    assert!(from_str::<Division>(r#"{ "standard": -1 }"#).is_err());
}

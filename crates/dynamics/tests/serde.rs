//! File form of inertias.

use linkdyn_dynamics::RigidInertia;
use nalgebra::Vector3;
use serde_json::{from_str, json, to_string, to_value};

#[test]
fn inertia_comes_back_to_the_last_bit() {
    let rod = RigidInertia::solid_cylinder(7850.0, 0.028, 0.2, &Vector3::new(1.0, 2.0, 3.0));
    assert_eq!(from_str::<RigidInertia>(&to_string(&rod).unwrap()).unwrap(), rod);
}

#[test]
fn names_are_those_of_the_fields() {
    let zeros = vec![0.0; 9];
    let expected = json!({ "mass": 0.0, "com": [0.0, 0.0, 0.0], "about_com": zeros });
    assert_eq!(to_value(RigidInertia::massless()).unwrap(), expected);
    assert!(from_str::<RigidInertia>(r#"{ "mas": 1, "com": [0, 0, 0], "about_com": [0,0,0,0,0,0,0,0,0] }"#).is_err());
}

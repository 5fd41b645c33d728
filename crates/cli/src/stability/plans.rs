//! The methods by name, at one tolerance or step.

use linkdyn_mechanisms::Switching;

use crate::run::Prepared;
use crate::run::methods::{ADAPTIVE, FIXED, Plan};

/// Tolerance without clearance \[rad, m\]: where work and accuracy are both those of everyday use.
const TOLERANCE: f64 = 1e-8;
/// With clearance, in clearances: penetrations are a thousandth of one to a hundredth.
const CONTACT_TOLERANCE: f64 = 1e-6;

/// Tolerance for a scene.
pub fn tolerance(prepared: &Prepared) -> f64 {
    let clearance = prepared.mechanism.clearances().flatten().reduce(f64::min);
    clearance.map_or(TOLERANCE, |size| CONTACT_TOLERANCE * size)
}

/// Names of all methods, those with error control first.
pub fn methods() -> impl Iterator<Item = &'static str> {
    ADAPTIVE.into_iter().chain(FIXED)
}

/// Whether steps of the method have a fixed length.
pub fn is_fixed(method: &str) -> bool {
    FIXED.contains(&method)
}

/// A method at a tolerance, or with a step if its steps are fixed.
pub fn plan(method: &str, setting: f64) -> Plan {
    let fixed = is_fixed(method);
    Plan {
        method: method.to_owned(),
        rtol: (!fixed).then_some(setting),
        atol: (!fixed).then_some(setting),
        step: fixed.then_some(setting),
        iterations: None,
        switching: Switching::Located,
    }
}

//! The methods with error control.

use linkdyn_integrators::{Adams, Auto, Bdf, Dop853, DormandPrince5, Method, Ode, Radau5, Rodas};

/// All of them, by the names that the program has for them.
pub fn adaptive<P: Ode + 'static>() -> Vec<(&'static str, Box<dyn Method<P>>)> {
    vec![
        ("auto", Box::new(Auto::default())),
        ("adams", Box::new(Adams::default())),
        ("dop853", Box::new(Dop853::default())),
        ("dopri5", Box::new(DormandPrince5::default())),
        ("radau5", Box::new(Radau5::default())),
        ("bdf", Box::new(Bdf::default())),
        ("rodas", Box::new(Rodas::default())),
    ]
}

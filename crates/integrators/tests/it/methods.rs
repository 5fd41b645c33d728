//! The methods with error control: a new one is one line more here, for tests of this crate and of mechanisms.

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

/// The k-th of them, made anew.
pub fn nth<P: Ode + 'static>(k: usize) -> Box<dyn Method<P>> {
    adaptive().swap_remove(k).1
}

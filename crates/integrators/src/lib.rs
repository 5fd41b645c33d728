#![doc = include_str!("../README.md")]

mod adams;
mod alpha;
mod auto;
mod bdf;
mod constrained;
mod control;
mod error;
mod event;
mod hermite;
mod integration;
mod jacobian;
mod lanes;
mod linear;
mod method;
mod newmark;
mod newton;
mod problem;
mod radau;
mod reduced;
mod root;
mod rosenbrock;
mod runge_kutta;
mod settings;
mod statistics;
mod sums;
mod weights;

pub use adams::Adams;
pub use alpha::GeneralisedAlpha;
pub use auto::Auto;
pub use bdf::Bdf;
pub use constrained::{Constrained, Equations, Form, Place, SingularConstraints, Terms};
pub use error::IntegrationError;
pub use integration::{Integration, Progress};
pub use method::{Counted, Method, Step};
pub use newmark::{Corrector, Newmark, NotSettled};
pub use problem::{EvalError, Ode, SecondOrder, Source};
pub use radau::Radau5;
pub use rosenbrock::Rodas;
pub use runge_kutta::{
    ClassicalTableau, Coefficients, Dop853, Dop853Tableau, DormandPrince5, DormandPrince5Tableau, Embedded, Rk4,
    RungeKutta, Tableau,
};
pub use settings::{Settings, SettingsError, Tolerance};
pub use statistics::Statistics;
pub use weights::Weights;

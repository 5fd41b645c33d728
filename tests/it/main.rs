//! All integration tests, one module a subject.

mod architecture;
mod closures;
mod cut_or_carried;
mod denavit_hartenberg;
mod derivatives;
mod energy;
mod invariances;
mod newton_euler;
mod puma560;
mod recursion_and_lagrange;

//! Public behaviour of the crate.

mod any_numbers;
mod convergence;
mod counters;
mod failures;
mod output;
mod problems;
mod settings;
mod stops;
mod tolerance;

//! Public behaviour of the crate.

mod any_numbers;
mod bdf;
mod benchmark_05_standard_odes;
mod convergence;
mod counters;
mod events;
mod failures;
mod output;
mod problems;
mod radau;
mod settings;
mod stops;
mod tolerance;

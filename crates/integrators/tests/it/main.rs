//! Public behaviour of the crate.

mod any_numbers;
mod auto;
mod bdf;
mod benchmark_01_andrews_squeezer;
mod benchmark_04_pendulum_index3;
mod benchmark_05_standard_odes;
mod convergence;
mod counters;
mod events;
mod failures;
mod methods;
mod output;
mod problems;
mod radau;
mod rodas;
mod settings;
mod standard_odes;
mod stops;
mod tolerance;

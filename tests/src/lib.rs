//! Shared fixtures of the tests: descriptions of machines that can be edited before they are built, strategies that draw them
//! at random, loads, known linkages, and small numerical tools.

mod blueprint;
pub mod budget;
pub mod ladders;
pub mod linkages;
pub mod loads;
#[path = "../../crates/integrators/tests/it/methods.rs"]
pub mod methods;
pub mod numbers;
pub mod reference;
pub mod scenes;
#[path = "../../crates/integrators/tests/it/standard_odes.rs"]
pub mod standard_odes;
pub mod strategies;

pub use blueprint::{Blueprint, Cut, Machine, Part};

/// The example of the workspace's README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

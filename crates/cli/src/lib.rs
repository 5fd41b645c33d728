#![doc = include_str!("../README.md")]

pub mod analyse;
pub mod args;
pub mod check;
pub mod draw;
pub mod errors;
pub mod figure;
pub mod interrupt;
pub mod machine;
pub mod output;
pub mod progress;
pub mod report;
pub mod results;
pub mod run;
pub mod scenes;
pub mod stability;
pub mod summary;

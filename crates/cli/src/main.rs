//! The `linkdyn` program.
fn main() {}

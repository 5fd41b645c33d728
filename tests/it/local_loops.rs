//! Loops eliminated where they close, beside all of them at once.

use linkdyn_dynamics::{Formulation, lagrange};
use linkdyn_tests::numbers::{condition, largest};
use linkdyn_tests::{Blueprint, strategies};
use proptest::prelude::*;

/// Trees with many loops, redundant ones too, whose condition is known.
fn loops() -> impl Strategy<Value = (Blueprint, f64)> {
    strategies::closed(2..=12, 1..=6).prop_filter_map("well conditioned", |blueprint| {
        let machine = blueprint.machine(Formulation::Lagrange);
        let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
        let product = condition(&equations)?.product();
        (product < 1e6).then_some((blueprint, product))
    })
}

/// Largest difference, relative to the largest entry or to 1, which is the order of all that there is.
fn apart(found: &[f64], known: &[f64]) -> f64 {
    let gaps: Vec<f64> = found.iter().zip(known).map(|(a, b)| a - b).collect();
    largest(&gaps) / largest(known).max(1.0)
}

proptest! {
    #![proptest_config(strategies::cases(300))]

    #[test]
    fn accelerations_and_multipliers_are_those_of_the_dense_way((blueprint, condition) in loops()) {
        let dense = blueprint.machine(Formulation::ArticulatedBody).evaluate();
        let local = blueprint.machine(Formulation::LocalLoops).evaluate();
        prop_assert_eq!(local.redundant(), dense.redundant());
        // Rounding of 1e-16, some of them, times the condition.
        let most = 1e-10_f64.max(1e-14 * condition);
        for (found, known) in [(local.rates(), dense.rates()), (local.multipliers(), dense.multipliers())] {
            let gap = apart(found, known);
            prop_assert!(gap < most, "{gap:e} of {:e}", largest(known));
        }
    }
}

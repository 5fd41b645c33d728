//! Drift terms [Baumgarte 1972]: accelerations that let an open loop close like a damped oscillator.

use linkdyn_dynamics::{Baumgarte, Formulation, System, Workspace, lagrange};
use linkdyn_kinematics::{Positions, Velocities};
use linkdyn_tests::numbers::{condition, largest};
use linkdyn_tests::{Blueprint, strategies};
use nalgebra::DVector;
use proptest::prelude::*;

const TERMS: Baumgarte = Baumgarte { alpha: 3.0, beta: 5.0 };

/// Rates with drift terms, for a formulation.
fn rates(blueprint: &Blueprint, formulation: Formulation, baumgarte: Option<Baumgarte>) -> DVector<f64> {
    let (mut description, _) = blueprint.description();
    (description.formulation, description.baumgarte) = (formulation, baumgarte);
    let system = System::new(description).expect("valid");
    let mut work = Workspace::new(&system);
    let (q, v) = (blueprint.coordinates(), blueprint.speeds());
    system.evaluate(0.0, &q, &v, &mut work).expect("regular");
    DVector::from_column_slice(work.rates())
}

/// The equations, where they are well conditioned and none is redundant.
fn regular(blueprint: &Blueprint) -> Option<lagrange::LagrangeEquations> {
    let machine = blueprint.machine(Formulation::Lagrange);
    let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
    let sound = condition(&equations).is_some_and(|c| c.rank == equations.gamma.len() && c.product() < 1e4);
    sound.then_some(equations)
}

const FORMULATIONS: [Formulation; 3] = [
    Formulation::CompositeBody,
    Formulation::ArticulatedBody,
    Formulation::Lagrange,
];

proptest! {
    #![proptest_config(strategies::cases(200))]

    #[test]
    fn an_open_loop_closes_like_a_damped_oscillator(blueprint in strategies::open()) {
        let equations = regular(&blueprint);
        prop_assume!(equations.is_some());
        let equations = equations.expect("checked");
        let (tree, links) = blueprint.tree();
        let closure = blueprint.closures(&tree, &links).remove(0);
        let (mut positions, mut velocities) = (Positions::new(&tree), Velocities::new(&tree));
        tree.positions(&blueprint.coordinates(), &mut positions);
        tree.velocities(&positions, &blueprint.speeds(), &mut velocities);
        let (mut phi, mut rate) = (equations.gamma.clone(), equations.gamma.clone());
        closure.residual(&positions, phi.as_mut_slice());
        closure.rate(&positions, &velocities, rate.as_mut_slice());
        for formulation in FORMULATIONS {
            let a = rates(&blueprint, formulation, Some(TERMS));
            let second = &equations.gradient * &a + &equations.gamma;
            let gap = second + &rate * (2.0 * TERMS.alpha) + &phi * TERMS.beta.powi(2);
            // Rounding of residuals of some metres times 25 and of the accelerations, times the condition.
            prop_assert!(largest(&gap) < 1e-10 * (1.0 + largest(&a)), "{formulation:?}: {gap}");
        }
    }

    #[test]
    fn a_closed_loop_does_not_notice(blueprint in strategies::closed(2..=6, 1..=1)) {
        prop_assume!(regular(&blueprint).is_some());
        for formulation in FORMULATIONS {
            let (with, without) = (rates(&blueprint, formulation, Some(TERMS)), rates(&blueprint, formulation, None));
            // Closed to 1e-15, times 25 and the condition.
            prop_assert!(largest(&(&with - &without)) < 1e-10 * (1.0 + largest(&without)));
        }
    }
}

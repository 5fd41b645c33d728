//! Recursive = Lagrange: three routes to the same equations of motion.

use linkdyn_dynamics::Formulation;
use linkdyn_dynamics::lagrange::{self, LagrangeEquations};
use linkdyn_tests::numbers::{condition, largest, magnitudes};
use linkdyn_tests::{Blueprint, Machine, strategies};
use nalgebra::DVector;
use proptest::prelude::*;

/// All ways to the equations of motion.
const FORMULATIONS: [Formulation; 3] = [
    Formulation::CompositeBody,
    Formulation::ArticulatedBody,
    Formulation::Lagrange,
];

/// Generalised forces of the applied loads by `T_i` alone: force times displacement of the origin, torque times turn.
fn generalised(blueprint: &Blueprint, machine: &Machine) -> DVector<f64> {
    let mut f: Vec<f64> = blueprint.parts.iter().flat_map(|part| part.drive.clone()).collect();
    let transforms = machine.tree().transforms(&machine.q);
    for (part, &link) in blueprint.parts.iter().zip(&machine.links) {
        let rotation = transforms.transform(link).fixed_view::<3, 3>(0, 0).into_owned();
        for (i, f) in f.iter_mut().enumerate() {
            let first = transforms.first(link, i);
            let spin = first.fixed_view::<3, 3>(0, 0) * rotation.transpose();
            let turn = nalgebra::Vector3::new(spin[(2, 1)], spin[(0, 2)], spin[(1, 0)]);
            *f += part.wrench.force.dot(&first.fixed_view::<3, 1>(0, 3)) + part.wrench.torque.dot(&turn);
        }
    }
    DVector::from_vec(f)
}

/// How well accelerations and multipliers fulfil `M a + bias = f + G^T lambda` and `G a + gamma = 0`, relative to the largest
/// sum of magnitudes in the equations, or to 1 where that is larger (random machines are made of numbers of the order of 1).
/// Elimination finds the accelerations without closures before it takes the closure's share off, so these belong to the scale
/// of the closure equations.
fn imbalance(e: &LagrangeEquations, f: &DVector<f64>, a: &DVector<f64>, lambda: &DVector<f64>) -> f64 {
    let motion = &e.mass * a + &e.bias - f - e.gradient.tr_mul(lambda);
    let motion_scale =
        magnitudes(&e.mass) * a.abs() + e.bias.abs() + f.abs() + magnitudes(&e.gradient).tr_mul(&lambda.abs());
    let free = e.mass.clone().cholesky().expect("regular").solve(&(f - &e.bias));
    let closure = &e.gradient * a + &e.gamma;
    let closure_scale = magnitudes(&e.gradient) * (free.abs() + a.abs()) + e.gamma.abs();
    let mut worst = largest(&motion) / largest(&motion_scale).max(1.0);
    if !closure.is_empty() {
        worst = worst.max(largest(&closure) / largest(&closure_scale).max(1.0));
    }
    worst
}

fn check(blueprint: &Blueprint) -> Result<(), TestCaseError> {
    let reference = blueprint.machine(Formulation::Lagrange);
    let equations = lagrange::equations(&reference.system, &reference.q, &reference.v);
    let Some(condition) = condition(&equations) else {
        return Err(TestCaseError::reject("rank in doubt"));
    };
    prop_assume!(condition.mass < 1e6 && condition.closure < 3e3);
    let f = generalised(blueprint, &reference);
    for formulation in FORMULATIONS {
        let work = blueprint.machine(formulation).evaluate();
        prop_assert_eq!(reference.system.equations() - work.redundant(), condition.rank);
        let a = DVector::from_column_slice(work.rates());
        let lambda = DVector::from_column_slice(work.multipliers());
        // Backward stable elimination leaves some 1e-16 times the number of unknowns. Multipliers in error by the square of the
        // closures' condition push along what hardly moves, so that the condition itself remains.
        let worst = imbalance(&equations, &f, &a, &lambda);
        prop_assert!(
            worst < 1e-12_f64.max(1e-14 * condition.closure),
            "{formulation:?}: {worst:e}, {condition:?}"
        );
        if condition.rank == lambda.len() {
            let (a_dense, lambda_dense) = equations.solve(f.as_slice()).expect("regular");
            // Forward errors are backward errors times the condition of what is solved.
            let allowed = 1e-12 + 1e-15 * condition.product();
            let free = equations
                .mass
                .clone()
                .cholesky()
                .expect("regular")
                .solve(&(&f - &equations.bias));
            let a_error = largest(&(&a - &a_dense)) / largest(&free).max(1.0);
            let lambda_error = largest(&(&lambda - &lambda_dense)) / largest(&lambda_dense).max(1.0);
            prop_assert!(
                a_error < allowed,
                "{formulation:?}: {a_error:e} > {allowed:e}, {condition:?}"
            );
            prop_assert!(
                lambda_error < allowed,
                "{formulation:?}: {lambda_error:e} > {allowed:e}, {condition:?}"
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(strategies::cases(1000))]

    #[test]
    fn on_trees_both_recursions_solve_the_lagrange_equations(blueprint in strategies::tree(1..=20)) {
        check(&blueprint)?;
    }

    #[test]
    fn on_loops_both_recursions_solve_the_lagrange_equations(blueprint in strategies::closed(2..=12, 1..=3)) {
        check(&blueprint)?;
    }
}

//! Projection of drifted states back onto the closures.

use linkdyn_dynamics::{Formulation, lagrange};
use linkdyn_kinematics::assembly::consistent_velocities;
use linkdyn_tests::numbers::{condition, difference, largest};
use linkdyn_tests::{Blueprint, strategies};
use nalgebra::DVector;
use proptest::prelude::*;

/// Loops with a condition up to 1e3.
fn loops() -> impl Strategy<Value = Blueprint> {
    strategies::closed(2..=10, 1..=2).prop_filter("well conditioned", |blueprint| {
        let machine = blueprint.machine(Formulation::Lagrange);
        let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
        condition(&equations).is_some_and(|c| c.rank > 0 && c.product() < 1e3)
    })
}

fn formulations() -> impl Strategy<Value = Formulation> {
    prop_oneof![Just(Formulation::CompositeBody), Just(Formulation::ArticulatedBody)]
}

/// Drift as steps leave it. Speeds are put right with the gradient of the drifted position, so that the product of both drifts
/// remains, 1e-14 of them.
fn drift() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(strategies::number(1e-7), 30)
}

proptest! {
    #![proptest_config(strategies::cases(300))]

    #[test]
    fn small_drift_is_removed_on_both_levels(
        blueprint in loops(),
        (dq, dv) in (drift(), drift()),
        formulation in formulations(),
    ) {
        let machine = blueprint.machine(formulation);
        let mut work = machine.evaluate();
        let (mut q, mut v) = (machine.q.clone(), machine.v.clone());
        machine.tree().displace(&mut q, &dq);
        v.iter_mut().zip(&dv).for_each(|(v, d)| *v += d);
        let before = machine.system.violation(0.0, &q, &v, &mut work);
        let found = machine.system.project(0.0, &mut q, &mut v, &mut work);
        prop_assert_eq!(found.position, before.0);
        let after = machine.system.violation(0.0, &q, &v, &mut work);
        let size = work.positions().nodes().iter().fold(1.0, |s: f64, n| s.max(n.origin.amax()));
        prop_assert!(after.0 < 1e-14 * size.max(10.0), "position {:e} after {:e}", after.0, before.0);
        prop_assert!(after.1 < 1e-14 * size.max(10.0), "velocity {:e} after {:e}", after.1, before.1);
    }

    #[test]
    fn drift_within_a_tolerance_stays(blueprint in loops(), (dq, dv) in (drift(), drift())) {
        let machine = blueprint.machine(Formulation::Recursive);
        let mut work = machine.evaluate();
        let (mut q, mut v) = (machine.q.clone(), machine.v.clone());
        machine.tree().displace(&mut q, &dq);
        v.iter_mut().zip(&dv).for_each(|(v, d)| *v += d);
        let (kept_q, kept_v) = (q.clone(), v.clone());
        let (position, velocity) = machine.system.violation(0.0, &q, &v, &mut work);
        prop_assume!(position.min(velocity) > 1e-12);
        let most = position.max(velocity);
        prop_assert!(!machine.system.project_beyond(0.0, 1.001 * most, &mut q, &mut v, &mut work).changed);
        prop_assert_eq!((&q, &v), (&kept_q, &kept_v));
        prop_assert!(machine.system.project_beyond(0.0, 0.999 * most, &mut q, &mut v, &mut work).changed);
    }

    #[test]
    fn a_state_on_the_closures_is_not_changed(blueprint in loops(), formulation in formulations()) {
        let machine = blueprint.machine(formulation);
        let mut work = machine.evaluate();
        let (mut q, mut v) = (machine.q.clone(), machine.v.clone());
        // Built closed to a few roundings, which one or two projections may still take away.
        let settled = (0..5).any(|_| !machine.system.project(0.0, &mut q, &mut v, &mut work).changed);
        let moved = |a: &[f64], b: &[f64]| largest(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>());
        prop_assert!(moved(&q, &machine.q) < 1e-12 && moved(&v, &machine.v) < 1e-11);
        // Long chains may keep on going to and fro by a rounding.
        prop_assume!(settled);
        let (kept_q, kept_v) = (q.clone(), v.clone());
        let drift = machine.system.project(0.0, &mut q, &mut v, &mut work);
        prop_assert!(!drift.changed, "{drift:?}");
        prop_assert_eq!((q, v), (kept_q, kept_v));
    }

    #[test]
    fn speeds_take_the_shortest_way_in_the_mass_metric(
        blueprint in loops(),
        dv in prop::collection::vec(strategies::number(1.0), 30),
        guess in prop::collection::vec(strategies::number(1.0), 30),
        formulation in formulations(),
    ) {
        let machine = blueprint.machine(formulation);
        let mut work = machine.evaluate();
        let (mut q, n) = (machine.q.clone(), machine.v.len());
        let given: Vec<f64> = machine.v.iter().zip(&dv).map(|(v, d)| v + d).collect();
        let mut v = given.clone();
        machine.system.project(0.0, &mut q, &mut v, &mut work);
        let way = DVector::from_vec(v) - DVector::from_vec(given);
        let mass = lagrange::equations(&machine.system, &machine.q, &machine.v).mass;
        // M (v - given) is a force of the closures: it has no power on any allowed speeds.
        let allowed = consistent_velocities(
            machine.tree(), machine.system.closures(), &machine.q, &guess[..n], &vec![false; n],
        ).expect("nothing is held");
        let momentum = &mass * &way;
        let power = momentum.dot(&DVector::from_vec(allowed));
        prop_assert!(power.abs() < 1e-10 * (1.0 + largest(&momentum)), "{power:e}");
    }

    #[test]
    fn quaternions_come_back_to_unit_length(blueprint in strategies::tree(1..=8), factor in 0.9..1.1f64) {
        let machine = blueprint.machine(Formulation::Recursive);
        let mut work = machine.evaluate();
        let (mut q, mut v) = (machine.q.clone(), machine.v.clone());
        for (part, &link) in blueprint.parts.iter().zip(&machine.links) {
            if part.q.len() == 4 {
                q[machine.tree().coordinate_range(link)].iter_mut().for_each(|x| *x *= factor);
            }
        }
        let stretched = q != machine.q;
        let drift = machine.system.project(0.0, &mut q, &mut v, &mut work);
        prop_assert_eq!(drift.changed, stretched);
        prop_assert!(difference(&q, &machine.q) < 1e-15);
        prop_assert_eq!(v, machine.v);
    }
}

//! Closures with more equations than they need: the motion does not depend on which of them are kept.

use linkdyn_dynamics::{Description, Formulation, RigidInertia, System, Workspace, lagrange};
use linkdyn_kinematics::{Attachment, Closure, Joint, LinkId, Pose, Row, Tree};
use linkdyn_mechanisms::Start;
use linkdyn_tests::linkages::FourBar;
use linkdyn_tests::numbers::{condition, difference, largest};
use linkdyn_tests::strategies;
use nalgebra::{DMatrix, DVector, Vector3};
use proptest::prelude::*;
use std::f64::consts::PI;

/// Rows of the null space of `G^T`: combinations of closure forces that push nothing.
fn idle(gradient: &DMatrix<f64>) -> Vec<DVector<f64>> {
    let eigen = (gradient * gradient.transpose()).symmetric_eigen();
    let most = eigen.eigenvalues.max();
    let none = |k: &usize| eigen.eigenvalues[*k] < 1e-12 * most;
    (0..gradient.nrows())
        .filter(none)
        .map(|k| eigen.eigenvectors.column(k).into_owned())
        .collect()
}

/// The multipliers are of smallest norm: they hold no idle part.
fn assert_smallest(work: &Workspace, gradient: &DMatrix<f64>) -> Result<(), TestCaseError> {
    let lambda = DVector::from_column_slice(work.multipliers());
    let idle = idle(gradient);
    prop_assert_eq!(idle.len(), work.redundant());
    for direction in idle {
        let share = direction.dot(&lambda);
        prop_assert!(share.abs() < 1e-9 * largest(&lambda).max(1.0), "{share:e} of {lambda}");
    }
    Ok(())
}

fn evaluate(description: &Description, q: &[f64], v: &[f64]) -> (System, Workspace) {
    let system = System::new(description.clone()).expect("valid");
    let mut work = Workspace::new(&system);
    system.evaluate(0.0, q, v, &mut work).expect("regular");
    (system, work)
}

proptest! {
    #![proptest_config(strategies::cases(300))]

    #[test]
    fn a_four_bar_with_five_equations_moves_like_one_with_two(
        plane in strategies::pose(1.0),
        crank in 0.0..2.0 * PI,
        speed in strategies::number(5.0),
    ) {
        let closing = Joint::revolute_z();
        let mechanism = FourBar { lengths: [0.3, 1.0, 0.9, 1.1], plane, closing }.linkage().build().expect("valid");
        let (state, _) = mechanism.assemble(&Start {
            positions: vec![("crank".into(), crank), ("coupler".into(), 0.9 - crank), ("rocker".into(), 1.6)],
            held: vec!["crank".into()],
            speeds: vec![("crank".into(), speed)],
        }).expect("a crank that turns fully");
        let five = mechanism.system();
        let description = Description {
            closures: five.closures().to_vec(),
            ..Description::new(five.tree().clone(), five.inertias().to_vec(), five.gravity())
        };
        let cut = &five.closures()[0];
        let in_plane = [Vector3::x(), Vector3::y()].map(|axis| Row::Along { axis });
        let two = Description {
            closures: vec![Closure::with_rows(five.tree(), *cut.predecessor(), *cut.successor(), in_plane.into())],
            ..description.clone()
        };
        let (_, minimal) = evaluate(&two, &state.q, &state.v);
        prop_assert_eq!(minimal.redundant(), 0);
        for formulation in [Formulation::CompositeBody, Formulation::ArticulatedBody, Formulation::Lagrange] {
            let (system, work) = evaluate(&Description { formulation, ..description.clone() }, &state.q, &state.v);
            prop_assert_eq!(work.redundant(), 3);
            // Rounding of the plane's orientation times the condition, some 1e2.
            let gap = difference(work.rates(), minimal.rates());
            prop_assert!(gap < 1e-11, "{formulation:?}: {gap:e}");
            let gradient = lagrange::equations(&system, &state.q, &state.v).gradient;
            assert_smallest(&work, &gradient)?;
            // In a plane only the force in it does anything: that is the force of the minimal closure.
            let axes = plane.rotation * five_axes(&state.q);
            let lambda = minimal.multipliers();
            let force = axes * Vector3::new(lambda[0], lambda[1], 0.0);
            let found = Vector3::from_column_slice(&work.multipliers()[..3]);
            prop_assert!((force - found).amax() < 1e-10 * force.amax().max(1.0), "{force} {found}");
        }
    }

    #[test]
    fn a_cut_joint_given_twice_carries_half_each_time(blueprint in strategies::closed(3..=8, 1..=1)) {
        let machine = blueprint.machine(Formulation::Recursive);
        let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
        let condition = condition(&equations);
        prop_assume!(condition.is_some_and(|c| c.rank == equations.gamma.len() && c.closure < 3e3 && c.mass < 1e6));
        let once = machine.evaluate();
        let mut double = blueprint.clone();
        double.cuts.extend(blueprint.cuts.clone());
        let twice = double.machine(Formulation::Recursive).evaluate();
        // Badly conditioned equations must not make the second set look independent.
        prop_assert_eq!(twice.redundant(), once.multipliers().len());
        let halves: Vec<f64> = once.multipliers().iter().map(|l| l / 2.0).collect();
        let (one, two) = twice.multipliers().split_at(halves.len());
        // Rounding of 1e-16 times the square of a condition of 3e3.
        let scale = largest(&halves).max(1.0);
        for half in [one, two] {
            let gaps: Vec<f64> = half.iter().zip(&halves).map(|(a, b)| a - b).collect();
            prop_assert!(largest(&gaps) < 1e-7 * scale, "{:e}", largest(&gaps) / scale);
        }
    }

    #[test]
    fn multipliers_of_random_redundant_loops_are_of_smallest_norm(blueprint in strategies::closed(2..=5, 1..=2)) {
        let machine = blueprint.machine(Formulation::Recursive);
        let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
        let condition = condition(&equations);
        prop_assume!(condition.is_some_and(|c| c.rank > 0 && c.rank < equations.gamma.len() && c.product() < 1e6));
        assert_smallest(&machine.evaluate(), &equations.gradient)?;
    }

    #[test]
    fn a_second_bearing_on_the_same_shaft_changes_nothing(
        base in strategies::pose(1.0),
        axis in strategies::direction(),
        (angle, speed) in (strategies::number(PI), strategies::number(5.0)),
        body in strategies::irregular(),
        joint in prop_oneof![Just(true), Just(false)],
    ) {
        // None of the second bearing's equations moves: their gradient is rounding, and must not count.
        let mut tree = Tree::new();
        let link = tree.attach(LinkId::GROUND, base, Joint::Revolute { axis }).expect("valid");
        let along = Pose { origin: *axis * 0.7, ..Pose::identity() };
        let at = |link, pose| Attachment { link, pose };
        let second = if joint { Joint::Revolute { axis } } else { Joint::Spherical };
        let closure = Closure::new(&tree, at(LinkId::GROUND, base * along), at(link, along), &second);
        let one = Description::new(tree, vec![body], Vector3::new(1.0, -9.0, 3.0));
        let two = Description { closures: vec![closure], ..one.clone() };
        let (_, alone) = evaluate(&one, &[angle], &[speed]);
        for formulation in [Formulation::CompositeBody, Formulation::ArticulatedBody, Formulation::Lagrange] {
            let (system, work) = evaluate(&Description { formulation, ..two.clone() }, &[angle], &[speed]);
            prop_assert_eq!(work.redundant(), system.equations());
            prop_assert!((work.rates()[0] - alone.rates()[0]).abs() < 1e-11 * alone.rates()[0].abs().max(1.0));
            prop_assert!(largest(work.multipliers()) == 0.0);
        }
    }
}

/// Axes of the coupler's end in the four-bar's plane: `Row::Along` counts along them.
fn five_axes(q: &[f64]) -> nalgebra::Matrix3<f64> {
    *nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), q[0] + q[1]).matrix()
}

#[test]
fn a_massless_closure_free_system_reports_no_redundancy() {
    let mut tree = Tree::new();
    tree.attach(LinkId::GROUND, Pose::identity(), Joint::revolute_z())
        .expect("valid");
    let inertia = RigidInertia::solid_cylinder(7850.0, 0.1, 0.5, &Vector3::x());
    let (_, work) = evaluate(&Description::new(tree, vec![inertia], Vector3::zeros()), &[0.0], &[1.0]);
    assert_eq!((work.redundant(), work.counters().redundant), (0, 0));
}

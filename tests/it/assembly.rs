//! Assembly of random loops, and its refusals.

use linkdyn_dynamics::{Formulation, lagrange};
use linkdyn_kinematics::assembly::{AssemblyError, Settings, assemble, consistent_velocities, gradient, residuals};
use linkdyn_kinematics::{Attachment, Closure, Joint, LinkId, Pose, Positions, Tree};
use linkdyn_tests::numbers::{condition, largest};
use linkdyn_tests::{Blueprint, strategies};
use nalgebra::DVector;
use proptest::prelude::*;

/// Loops that are well away from singular positions, so that the nearest closed position is the only one near.
fn loops() -> impl Strategy<Value = Blueprint> {
    strategies::closed_with(3..=10, 1..=2, strategies::moving_joint()).prop_filter("well conditioned", |blueprint| {
        let machine = blueprint.machine(Formulation::Lagrange);
        let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
        condition(&equations).is_some_and(|c| c.rank > 0 && c.rank == equations.gamma.len() && c.product() < 1e4)
    })
}

/// A chain of six revolute joints, its end tied to the ground by a seventh one.
fn seven_revolutes() -> impl Strategy<Value = Blueprint> {
    let joint = || strategies::direction().prop_map(|axis| Joint::Revolute { axis });
    (loops_of_chain(joint()), joint(), strategies::pose(0.5)).prop_map(|(mut chain, joint, frame)| {
        chain.close(Some(5), frame, joint, &[0.4], None);
        chain
    })
}

fn loops_of_chain(joint: impl Strategy<Value = Joint>) -> impl Strategy<Value = Blueprint> {
    let joints = prop::collection::vec((joint, strategies::pose(0.5), strategies::raw()), 6);
    (strategies::tree(6..=6), joints).prop_map(|(mut blueprint, joints)| {
        for (k, (part, (joint, placement, raw))) in blueprint.parts.iter_mut().zip(joints).enumerate() {
            (part.parent, part.joint, part.placement) = (k.checked_sub(1), joint, placement);
            part.q = strategies::coordinates(&joint, &raw);
            (part.v, part.drive) = (vec![0.0], vec![0.0]);
        }
        blueprint
    })
}

fn residual(tree: &Tree, closures: &[Closure], q: &[f64]) -> f64 {
    let mut positions = Positions::new(tree);
    tree.positions(q, &mut positions);
    let mut phi = vec![0.0; linkdyn_kinematics::assembly::equations(closures)];
    residuals(closures, &positions, &mut phi);
    largest(&phi)
}

proptest! {
    #![proptest_config(strategies::cases(100))]

    #[test]
    fn disturbed_loops_return_to_closed_and_what_is_held_stays(
        blueprint in loops(),
        shifts in prop::collection::vec(strategies::number(0.02), 30),
        hold in prop::collection::vec(prop::bool::weighted(0.2), 10),
    ) {
        let (tree, links) = blueprint.tree();
        let closures = blueprint.closures(&tree, &links);
        let mut held = Vec::new();
        for (part, hold) in blueprint.parts.iter().zip(&hold) {
            held.extend(vec![*hold; part.joint.speeds()]);
        }
        let step: Vec<f64> = shifts.iter().zip(&held).map(|(s, held)| if *held { 0.0 } else { *s }).collect();
        let mut q = blueprint.coordinates();
        tree.displace(&mut q, &step);
        let free = held.iter().filter(|held| !**held).count();
        match assemble(&tree, &closures, &q, &held, &Settings::default()) {
            Ok(assembly) => {
                prop_assert!(residual(&tree, &closures, &assembly.q) < 1e-12);
                prop_assert!(assembly.rank <= assembly.equations.min(free));
                for (link, hold) in links.iter().zip(&hold) {
                    if *hold {
                        let range = tree.coordinate_range(*link);
                        // Quaternions may be brought back to length 1 by a rounding.
                        let moved = assembly.q[range.clone()].iter().zip(&q[range]).map(|(a, b)| (a - b).abs());
                        prop_assert!(moved.fold(0.0, f64::max) < 1e-15);
                    }
                }
            }
            // With too much held the gradient in what is left may be far from regular.
            Err(AssemblyError::NotClosed { rank, .. }) if held.contains(&true) => prop_assert!(rank <= free),
            Err(AssemblyError::OtherBranch { .. }) if held.contains(&true) => {}
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn seven_revolute_joints_in_a_loop_have_one_freedom(
        blueprint in seven_revolutes(),
        shifts in prop::collection::vec(strategies::number(0.02), 6),
    ) {
        let (tree, links) = blueprint.tree();
        let closures = blueprint.closures(&tree, &links);
        let machine = blueprint.machine(Formulation::Lagrange);
        let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
        prop_assume!(condition(&equations).is_some_and(|c| c.product() < 1e6));
        let mut q = blueprint.coordinates();
        tree.displace(&mut q, &shifts);
        let assembly = assemble(&tree, &closures, &q, &[false; 6], &Settings::default()).expect("near a closed position");
        prop_assert!(residual(&tree, &closures, &assembly.q) < 1e-12);
        prop_assert_eq!((assembly.rank, assembly.equations), (5, 5));
    }

    #[test]
    fn consistent_speeds_are_the_nearest_that_keep_loops_closed(
        blueprint in loops(),
        guess in prop::collection::vec(strategies::number(2.0), 30),
    ) {
        let (tree, links) = blueprint.tree();
        let closures = blueprint.closures(&tree, &links);
        let (q, guess) = (blueprint.coordinates(), &guess[..tree.speeds()]);
        let v = consistent_velocities(&tree, &closures, &q, guess, &vec![false; tree.speeds()]).expect("nothing is held");
        let mut positions = Positions::new(&tree);
        tree.positions(&q, &mut positions);
        let g = gradient(&tree, &closures, &positions);
        let v = DVector::from_vec(v);
        prop_assert!(largest(&(&g * &v)) < 1e-12);
        // The way from the guess is normal to all allowed speeds: a combination of rows of the gradient.
        let way = DVector::from_column_slice(guess) - &v;
        let rows = &g * g.transpose();
        let share = rows.lu().solve(&(&g * &way)).expect("full rank");
        prop_assert!(largest(&(way - g.tr_mul(&share))) < 1e-10);
    }
}

/// A pendulum of two links whose end is tied to a point of the ground that it can reach.
fn tied_pendulum() -> (Tree, Vec<Closure>) {
    let mut tree = Tree::new();
    let first = tree
        .attach(LinkId::GROUND, Pose::identity(), Joint::revolute_z())
        .expect("valid");
    let second = tree
        .attach(first, Pose::translation(1.0, 0.0, 0.0), Joint::revolute_z())
        .expect("valid");
    let at = |link, pose| Attachment { link, pose };
    let closures = vec![Closure::new(
        &tree,
        at(second, Pose::translation(1.0, 0.0, 0.0)),
        at(LinkId::GROUND, Pose::translation(1.0, 1.0, 0.0)),
        &Joint::Spherical,
    )];
    (tree, closures)
}

fn refusal(guess: &[f64], held: &[bool]) -> AssemblyError {
    let (tree, closures) = tied_pendulum();
    assemble(&tree, &closures, guess, held, &Settings::default()).expect_err("must be refused")
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_name_and_place() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        match refusal(&[0.0, bad], &[false; 2]) {
            AssemblyError::NotFinite {
                what: "guess",
                index: 1,
                ..
            } => {}
            other => panic!("{other:?}"),
        }
        let (tree, closures) = tied_pendulum();
        match consistent_velocities(&tree, &closures, &[0.0, 1.5], &[bad, 0.0], &[false; 2]) {
            Err(AssemblyError::NotFinite {
                what: "v", index: 0, ..
            }) => {}
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn lists_of_wrong_length_are_refused() {
    let expected = 2;
    assert_eq!(
        refusal(&[0.0], &[false; 2]),
        AssemblyError::Length {
            what: "guess",
            found: 1,
            expected
        }
    );
    assert_eq!(
        refusal(&[0.0; 2], &[false; 3]),
        AssemblyError::Length {
            what: "held",
            found: 3,
            expected
        }
    );
    let (tree, closures) = tied_pendulum();
    let speeds =
        |q: &[f64], v: &[f64]| consistent_velocities(&tree, &closures, q, v, &[false; 2]).expect_err("refused");
    assert_eq!(
        speeds(&[0.0; 3], &[0.0; 2]),
        AssemblyError::Length {
            what: "q",
            found: 3,
            expected
        }
    );
    assert_eq!(
        speeds(&[0.0; 2], &[0.0; 1]),
        AssemblyError::Length {
            what: "v",
            found: 1,
            expected
        }
    );
}

#[test]
fn a_quaternion_of_length_zero_is_refused() {
    let mut tree = Tree::new();
    tree.attach(LinkId::GROUND, Pose::identity(), Joint::Spherical)
        .expect("valid");
    let result = assemble(&tree, &[], &[0.0; 4], &[false; 3], &Settings::default());
    assert!(
        matches!(result, Err(AssemblyError::NotFinite { index: 0, .. })),
        "{result:?}"
    );
}

#[test]
fn a_loop_that_cannot_close_tells_residual_rank_and_worst_equation() {
    // Both held: nothing may move, the guess is open by (1, -1, 0).
    match refusal(&[0.0; 2], &[true; 2]) {
        AssemblyError::NotClosed {
            residual,
            iterations,
            closure: 0,
            equation: 0,
            rank: 0,
            equations: 3,
        } => {
            assert_eq!(residual, 1.0);
            assert!(iterations <= 1);
        }
        other => panic!("{other:?}"),
    }
    // The first held at right angles away: the second can come as near as sqrt 2... from (0, -1) to (1, 1) are 5^1/2.
    match refusal(&[-std::f64::consts::FRAC_PI_2, 1.0], &[true, false]) {
        AssemblyError::NotClosed {
            residual,
            rank,
            equation,
            ..
        } => {
            // The nearest point lies sqrt 5 - 1 before the target, two thirds to nine tenths of it along y.
            let along_y = (5.0_f64.sqrt() - 1.0) * 2.0 / 5.0_f64.sqrt();
            assert!((residual - along_y).abs() < 1e-4, "{residual}");
            assert_eq!((rank, equation), (1, 1));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn held_speeds_that_contradict_the_loops_are_refused() {
    let (tree, closures) = tied_pendulum();
    let q = [0.0, std::f64::consts::FRAC_PI_2];
    match consistent_velocities(&tree, &closures, &q, &[1.0, 0.0], &[true, false]) {
        Err(AssemblyError::Velocities {
            rate,
            closure: 0,
            rank: 1,
            equations: 3,
            ..
        }) => {
            // The end moves by (-1, 1); the second joint can take its -1 away.
            assert!((rate - 1.0).abs() < 1e-12, "{rate}");
        }
        other => panic!("{other:?}"),
    }
    let rest = consistent_velocities(&tree, &closures, &q, &[0.0, 3.0], &[true, false]).expect("rest is consistent");
    assert!(largest(&rest) < 1e-15);
}

#[test]
fn without_closures_any_position_is_closed() {
    let (tree, _) = tied_pendulum();
    let assembly = assemble(&tree, &[], &[0.3, 0.4], &[false; 2], &Settings::default()).expect("nothing to close");
    assert_eq!(
        (assembly.q, assembly.residual, assembly.iterations),
        (vec![0.3, 0.4], 0.0, 0)
    );
}

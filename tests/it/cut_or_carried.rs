//! A joint of the tree and the same joint cut are one mechanism: both forms move alike, for every kind of joint.

use linkdyn_dynamics::lagrange;
use linkdyn_dynamics::{Formulation, RigidInertia, Workspace};
use linkdyn_kinematics::{Accelerations, Joint, Pose, Twist, Velocities, Wrench};
use linkdyn_tests::numbers::{condition, largest};
use linkdyn_tests::{Blueprint, Cut, Machine, Part, strategies};
use nalgebra::{Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};
use proptest::prelude::*;
use proptest::sample::Index;

/// The same blueprint with the joint of part `k` cut: the part hangs on the ground by three slides and a ball joint instead.
fn cut(blueprint: &Blueprint, k: usize) -> Blueprint {
    let original = blueprint.machine(Formulation::Recursive);
    let work = original.evaluate();
    let pose = work.positions().pose(original.links[k]);
    let twist = work.velocities().nodes()[original.links[k].node()];
    let slide = |axis: Unit<Vector3<f64>>| Part {
        parent: None,
        placement: Pose::identity(),
        joint: Joint::Prismatic { axis },
        inertia: RigidInertia::massless(),
        q: vec![axis.dot(&pose.origin)],
        v: vec![axis.dot(&twist.linear)],
        drive: vec![0.0],
        wrench: Wrench::zero(),
    };
    let turned = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(pose.rotation));
    let Quaternion { coords: q } = *turned.quaternion();
    let w = pose.rotation.tr_mul(&twist.angular);

    let mut parts: Vec<Part> = blueprint.parts[..k].to_vec();
    for (n, axis) in [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()]
        .into_iter()
        .enumerate()
    {
        parts.push(Part {
            parent: (n > 0).then(|| k + n - 1),
            ..slide(axis)
        });
    }
    parts.push(Part {
        parent: Some(k + 2),
        placement: Pose::identity(),
        joint: Joint::Spherical,
        q: vec![q.w, q.x, q.y, q.z],
        v: w.as_slice().to_vec(),
        drive: vec![0.0; 3],
        ..blueprint.parts[k].clone()
    });
    let moved = |part: Option<usize>| part.map(|j| if j >= k { j + 3 } else { j });
    for part in &blueprint.parts[k + 1..] {
        parts.push(Part {
            parent: moved(part.parent),
            ..part.clone()
        });
    }
    let mut cuts: Vec<Cut> = blueprint.cuts.clone();
    for cut in &mut cuts {
        cut.predecessor.0 = moved(cut.predecessor.0);
        cut.successor.0 = moved(cut.successor.0);
    }
    let part = &blueprint.parts[k];
    cuts.push(Cut {
        predecessor: (part.parent, part.placement),
        successor: (Some(k + 3), Pose::identity()),
        joint: part.joint,
    });
    Blueprint {
        parts,
        cuts,
        gravity: blueprint.gravity,
    }
}

/// Accelerations of all links.
fn accelerations(machine: &Machine, work: &Workspace) -> Vec<Twist> {
    let tree = machine.tree();
    let (mut velocities, mut accelerations) = (Velocities::new(tree), Accelerations::new(tree));
    tree.velocities(work.positions(), &machine.v, &mut velocities);
    let base = Vector3::zeros();
    tree.accelerations(
        work.positions(),
        &velocities,
        &machine.v,
        work.rates(),
        &base,
        &mut accelerations,
    );
    machine
        .links
        .iter()
        .map(|link| accelerations.nodes()[link.node()])
        .collect()
}

/// Largest entries of a list of accelerations.
fn size(list: &[Twist]) -> f64 {
    list.iter()
        .fold(0.0, |s: f64, t| s.max(t.angular.amax()).max(t.linear.amax()))
}

fn check(blueprint: &Blueprint, k: usize) -> Result<(), TestCaseError> {
    let mut blueprint = blueprint.clone();
    // A drive acts along the freedoms of a tree's joint only.
    blueprint.parts[k].drive.fill(0.0);
    give_mass(&mut blueprint);
    let other = cut(&blueprint, k);
    prop_assume!(well_conditioned(&blueprint) && well_conditioned(&other));
    let (tree, apart) = (
        blueprint.machine(Formulation::Recursive),
        other.machine(Formulation::Recursive),
    );
    let (mut tree_work, mut apart_work) = (tree.evaluate(), apart.evaluate());
    prop_assert_eq!(apart_work.redundant(), tree_work.redundant());
    let one = accelerations(&tree, &tree_work);
    let mut two = accelerations(&apart, &apart_work);
    two.drain(k..k + 3);
    // Weight sets the scale where nothing can move.
    let scale = size(&one).max(10.0);
    let gaps: Vec<Twist> = one
        .iter()
        .zip(&two)
        .map(|(a, b)| Twist {
            angular: a.angular - b.angular,
            linear: a.linear - b.linear,
        })
        .collect();
    // Rounding times the condition of both forms, which is bounded, and typically far smaller than the bound.
    prop_assert!(
        size(&gaps) < 1e-10 * scale,
        "{:?}: {:e} of {scale:e}",
        blueprint.parts[k].joint,
        size(&gaps)
    );

    // The reaction of the tree's joint is the wrench of the closure on its successor.
    tree.system.reactions(&mut tree_work);
    apart.system.reactions(&mut apart_work);
    let local = tree.system.reaction(tree.links[k], &tree_work);
    let closure = apart.system.closures().last().expect("there is one");
    let multipliers = apart_work.multipliers();
    let own = &multipliers[multipliers.len() - closure.equations()..];
    let (_, on_successor) = closure.wrenches(apart_work.positions(), own);
    let r = tree_work.positions().pose(tree.links[k]).rotation;
    let gap = [
        on_successor.force - r * local.force,
        on_successor.torque - r * local.torque,
    ];
    let scale = local.force.amax().max(local.torque.amax()).max(largest(own)).max(scale);
    if tree_work.redundant() == 0 {
        prop_assert!(gap[0].amax().max(gap[1].amax()) < 1e-9 * scale, "{gap:?} of {scale:e}");
    }
    Ok(())
}

fn well_conditioned(blueprint: &Blueprint) -> bool {
    let machine = blueprint.machine(Formulation::Lagrange);
    let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
    condition(&equations).is_some_and(|c| c.product() < 1e7)
}

/// Links without mass would move none where the joint that ties them to mass is cut.
fn give_mass(blueprint: &mut Blueprint) {
    for part in blueprint.parts.iter_mut().filter(|part| part.inertia.mass == 0.0) {
        part.inertia = RigidInertia::solid_cylinder(7850.0, 0.05, 0.3, &Vector3::x());
    }
}

proptest! {
    #![proptest_config(strategies::cases(300))]

    #[test]
    fn carried_and_cut_joints_of_trees_move_alike(
        blueprint in strategies::tree(1..=6),
        place in any::<Index>(),
        joint in strategies::joint(),
        raw in strategies::raw(),
    ) {
        let k = place.index(blueprint.parts.len());
        let mut blueprint = blueprint;
        let part = &mut blueprint.parts[k];
        part.joint = joint;
        part.q = strategies::coordinates(&joint, &raw);
        part.v = raw[..joint.speeds()].to_vec();
        part.drive = vec![0.0; joint.speeds()];
        prop_assume!(blueprint.parts.iter().any(|part| part.joint.speeds() > 0));
        check(&blueprint, k)?;
    }

    #[test]
    fn carried_and_cut_joints_of_loops_move_alike(
        blueprint in strategies::closed_with(3..=6, 1..=1, strategies::moving_joint()),
        place in any::<Index>(),
    ) {
        let k = place.index(blueprint.parts.len());
        check(&blueprint, k)?;
    }
}

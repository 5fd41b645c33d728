//! The same machine described differently moves the same.

use linkdyn_dynamics::{Formulation, lagrange};
use linkdyn_kinematics::{Joint, Pose, Wrench};
use linkdyn_tests::numbers::{condition, difference};
use linkdyn_tests::{Blueprint, Cut, Part, strategies};
use nalgebra::{Matrix3, Unit, Vector3};
use proptest::prelude::*;

/// Well-conditioned machines with and without loops. Two descriptions then differ by rounding times a condition of 1e4.
fn machines() -> impl Strategy<Value = Blueprint> {
    strategies::closed(1..=8, 0..=2).prop_filter("well conditioned", |blueprint| {
        let machine = blueprint.machine(Formulation::Lagrange);
        let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
        condition(&equations).is_some_and(|c| c.mass * c.closure < 1e4)
    })
}

/// Accelerations, one list a part.
fn accelerations(blueprint: &Blueprint) -> Vec<Vec<f64>> {
    let work = blueprint.machine(Formulation::Recursive).evaluate();
    let mut rates = work.rates();
    let mut lists = Vec::new();
    for part in &blueprint.parts {
        let (own, rest) = rates.split_at(part.v.len());
        lists.push(own.to_vec());
        rates = rest;
    }
    lists
}

/// Largest difference relative to the largest acceleration, or to 10 rad/s^2, about gravity's, where that is larger.
fn gap(one: &[Vec<f64>], two: &[Vec<f64>]) -> f64 {
    let with_unit = |lists: &[Vec<f64>]| [lists.concat(), vec![10.0]].concat();
    difference(&with_unit(one), &with_unit(two))
}

/// The parts in another order in which parents still come first: `order` holds sort keys, a child is ready after its parent.
fn permuted(blueprint: &Blueprint, keys: &[u32]) -> (Blueprint, Vec<usize>) {
    let mut order: Vec<usize> = Vec::new();
    while order.len() < blueprint.parts.len() {
        let ready = |k: &usize| !order.contains(k) && blueprint.parts[*k].parent.is_none_or(|p| order.contains(&p));
        let next = (0..blueprint.parts.len()).filter(ready).min_by_key(|&k| keys[k]);
        order.push(next.expect("parents come first"));
    }
    let place = |part: Option<usize>| part.map(|p| order.iter().position(|&k| k == p).expect("a permutation"));
    let parts = order.iter().map(|&k| Part {
        parent: place(blueprint.parts[k].parent),
        ..blueprint.parts[k].clone()
    });
    let cuts = blueprint.cuts.iter().map(|cut| Cut {
        predecessor: (place(cut.predecessor.0), cut.predecessor.1),
        successor: (place(cut.successor.0), cut.successor.1),
        joint: cut.joint,
    });
    let permuted = Blueprint {
        parts: parts.collect(),
        cuts: cuts.collect(),
        gravity: blueprint.gravity,
    };
    (permuted, order)
}

/// Everything that stands on the ground, gravity and all outside wrenches, moved by `pose`.
fn moved(blueprint: &Blueprint, pose: &Pose) -> Blueprint {
    let mut moved = blueprint.clone();
    moved.gravity = pose.rotation * moved.gravity;
    for part in &mut moved.parts {
        part.wrench = Wrench {
            torque: pose.rotation * part.wrench.torque,
            force: pose.rotation * part.wrench.force,
        };
        if part.parent.is_none() {
            part.placement = *pose * part.placement;
        }
    }
    for cut in &mut moved.cuts {
        for side in [&mut cut.predecessor, &mut cut.successor] {
            if side.0.is_none() {
                side.1 = *pose * side.1;
            }
        }
    }
    moved
}

/// The mirror image in the plane z = 0: turns are about mirrored axes the other way round.
fn mirrored(blueprint: &Blueprint) -> Blueprint {
    let mirror = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0));
    let slide = |axis: &Unit<Vector3<f64>>| Unit::new_unchecked(mirror * **axis);
    let turn = |axis: &Unit<Vector3<f64>>| Unit::new_unchecked(-mirror * **axis);
    let joint = |joint: &Joint| match joint {
        Joint::Revolute { axis } => Joint::Revolute { axis: turn(axis) },
        Joint::Prismatic { axis } => Joint::Prismatic { axis: slide(axis) },
        Joint::Screw { axis, pitch } => Joint::Screw {
            axis: turn(axis),
            pitch: -pitch,
        },
        Joint::Cylindrical { axis } => Joint::Cylindrical { axis: slide(axis) },
        Joint::Universal { first, second } => Joint::Universal {
            first: turn(first),
            second: turn(second),
        },
        Joint::Planar { along, normal } => Joint::Planar {
            along: slide(along),
            normal: turn(normal),
        },
        other => *other,
    };
    let pose = |pose: &Pose| Pose {
        rotation: mirror * pose.rotation * mirror,
        origin: mirror * pose.origin,
    };
    let mut image = blueprint.clone();
    image.gravity = mirror * image.gravity;
    for part in &mut image.parts {
        for (x, sign) in part.q.iter_mut().zip(signs(&part.joint, part.joint.coordinates())) {
            *x *= sign;
        }
        for list in [&mut part.v, &mut part.drive] {
            for (x, sign) in list.iter_mut().zip(signs(&part.joint, part.joint.speeds())) {
                *x *= sign;
            }
        }
        part.joint = joint(&part.joint);
        part.placement = pose(&part.placement);
        part.inertia.com = mirror * part.inertia.com;
        part.inertia.about_com = mirror * part.inertia.about_com * mirror;
        part.wrench = Wrench {
            torque: -mirror * part.wrench.torque,
            force: mirror * part.wrench.force,
        };
    }
    for cut in &mut image.cuts {
        cut.predecessor.1 = pose(&cut.predecessor.1);
        cut.successor.1 = pose(&cut.successor.1);
        cut.joint = joint(&cut.joint);
    }
    image
}

/// Signs that coordinates or speeds change by in the mirror: of joints whose axes are not turned about themselves.
fn signs(joint: &Joint, count: usize) -> &'static [f64] {
    match (joint, count) {
        (Joint::Cylindrical { .. }, _) => &[1.0, -1.0],
        (Joint::SphericalZyx, _) | (Joint::Spherical, 3) => match joint {
            Joint::SphericalZyx => &[1.0, -1.0, -1.0],
            _ => &[-1.0, -1.0, 1.0],
        },
        (Joint::Spherical, _) => &[1.0, -1.0, -1.0, 1.0],
        (Joint::Free, 6) => &[1.0, 1.0, -1.0, -1.0, -1.0, 1.0],
        (Joint::Free, _) => &[1.0, 1.0, -1.0, 1.0, -1.0, -1.0, 1.0],
        (Joint::Planar { .. }, _) => &[1.0; 3],
        _ => &[1.0, 1.0],
    }
}

proptest! {
    #![proptest_config(strategies::cases(300))]

    #[test]
    fn the_order_of_attachment_does_not_matter(
        blueprint in machines(),
        keys in prop::collection::vec(any::<u32>(), 8),
    ) {
        let (other, order) = permuted(&blueprint, &keys);
        let one = accelerations(&blueprint);
        let two = accelerations(&other);
        let mut back = vec![Vec::new(); order.len()];
        for (list, &k) in two.into_iter().zip(&order) {
            back[k] = list;
        }
        prop_assert!(gap(&one, &back) < 1e-11, "{:e}", gap(&one, &back));
    }

    #[test]
    fn turning_everything_does_not_matter(blueprint in machines(), pose in strategies::pose(1.0)) {
        let gap = gap(&accelerations(&blueprint), &accelerations(&moved(&blueprint, &pose)));
        prop_assert!(gap < 1e-11, "{gap:e}");
    }

    #[test]
    fn a_thousand_kilometres_away_nine_digits_remain(blueprint in machines(), pose in strategies::pose(1.0)) {
        // Arms are kept apart from origins: trees lose no digit. Closures compare points 1e6 m away, known to 1e-10 m; this
        // enters their gradient, and the condition of 1e2 to 1e3 makes 1e-7 of it at worst.
        let far = Pose {
            origin: pose.origin.normalize() * 1e6,
            ..pose
        };
        let gap = gap(&accelerations(&blueprint), &accelerations(&moved(&blueprint, &far)));
        let allowed = if blueprint.cuts.is_empty() { 1e-11 } else { 1e-7 };
        prop_assert!(gap < allowed, "{gap:e}, {} cuts", blueprint.cuts.len());
    }

    #[test]
    fn a_mirror_image_moves_like_a_mirror_image(blueprint in machines()) {
        let one = accelerations(&blueprint);
        let mut two = accelerations(&mirrored(&blueprint));
        for (list, part) in two.iter_mut().zip(&blueprint.parts) {
            for (x, sign) in list.iter_mut().zip(signs(&part.joint, part.joint.speeds())) {
                *x *= sign;
            }
        }
        prop_assert!(gap(&one, &two) < 1e-11, "{:e}", gap(&one, &two));
    }
}

//! All assemblies that a search finds: as many as closed forms have.

use linkdyn_kinematics::assembly::Branch;
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::analysis::branches::Search;
use linkdyn_mechanisms::analysis::{AnalysisError, branches};
use linkdyn_mechanisms::{Linkage, Mechanism, Mount, Start};
use linkdyn_tests::linkages::{FourBar, Rssr, start};
use linkdyn_tests::numbers::apart;
use linkdyn_tests::strategies;
use nalgebra::{Unit, Vector3};
use proptest::prelude::*;
use std::f64::consts::PI;

proptest! {
    #![proptest_config(strategies::cases(20))]

    #[test]
    fn four_bars_have_two(crank in 0.0..2.0 * PI, [b, c, d] in prop::array::uniform3(0.9..1.1f64), spherical in any::<bool>()) {
        let (a, plane) = (0.3, Pose::identity());
        let closing = if spherical { Joint::Spherical } else { Joint::revolute_z() };
        let mechanism = FourBar { lengths: [a, b, c, d], plane, closing }.linkage().build().expect("valid");
        let search = Search { guesses: 40, ..Search::default() };
        let found = branches(&mechanism, &start(&[("crank", crank)], &["crank"]), &search).expect("isolated");
        prop_assert_eq!(found.positions.len(), 2);
        prop_assert!(found.singles == 0 && found.lost < 10, "{found:?}");
        for one in &found.positions {
            // Freudenthal's equation.
            let (r1, r2, r3) = (d / a, d / c, (a * a - b * b + c * c + d * d) / (2.0 * a * c));
            let phi = one.q[2];
            prop_assert!((r1 * phi.cos() - r2 * crank.cos() + r3 - (crank - phi).cos()).abs() < 1e-12);
            prop_assert!(one.q[0] == crank && one.q[1..].iter().all(|x| x.abs() <= PI));
        }
        prop_assert!(apart(found.positions[0].q[2], found.positions[1].q[2]) > 1e-3);
    }
}

#[test]
fn an_rssr_has_two_rocker_angles_with_the_rod_on_either_side_of_its_universal_joint() {
    let rssr = Rssr::FULL_TURN;
    let mechanism = rssr.build();
    for theta in [0.0, 1.0, 2.0, 4.0] {
        let found =
            branches(&mechanism, &start(&[("theta", theta)], &["theta"]), &Search::default()).expect("isolated");
        assert_eq!(found.positions.len(), 4);
        for phi in rssr.rocker_angles(theta).expect("a full turn") {
            let here: Vec<_> = found
                .positions
                .iter()
                .filter(|one| apart(one.q[3], phi) < 1e-10)
                .collect();
            let [one, other] = here[..] else {
                panic!("{} at {phi}", here.len())
            };
            // The rod lies the same with the first axis turned by half a turn.
            assert!((apart(one.q[1], other.q[1]) - PI).abs() < 1e-10);
            assert!(apart(one.q[2], PI - other.q[2]) < 1e-10);
            assert!(
                [one, other]
                    .iter()
                    .all(|one| matches!(one.branch, Branch::Positive | Branch::Negative))
            );
        }
    }
}

#[test]
fn a_locked_angle_has_none() {
    let rssr = Rssr::LOCKING;
    let search = Search {
        guesses: 50,
        ..Search::default()
    };
    let found = branches(&rssr.build(), &start(&[("theta", PI)], &["theta"]), &search).expect("no error");
    assert!(found.positions.is_empty() && found.lost == 50);
}

/// A planar arm of two links whose end a slide along x carries.
fn slider_crank() -> Mechanism {
    let mut linkage = Linkage::new([0.0; 3]);
    let rod = |length| linkdyn_dynamics::RigidInertia::solid_cylinder(7850.0, 0.02, length, &Vector3::x());
    let [crank, rod_link, slider] =
        [("crank", 0.3), ("rod", 1.0), ("slider", 0.1)].map(|(n, l)| linkage.link(n, rod(l)));
    let z = Joint::revolute_z();
    linkage.joint("crank", z, Mount::at_origin(Linkage::GROUND), Mount::at_origin(crank));
    linkage.joint("rod", z, Mount::at(crank, [0.3, 0.0, 0.0]), Mount::at_origin(rod_link));
    let x = Joint::Prismatic {
        axis: Vector3::x_axis(),
    };
    linkage.joint("x", x, Mount::at_origin(Linkage::GROUND), Mount::at_origin(slider));
    linkage.cut("pin", z, Mount::at(rod_link, [1.0, 0.0, 0.0]), Mount::at_origin(slider));
    linkage.build().expect("valid")
}

#[test]
fn slides_are_searched_as_far_as_the_lengths_reach() {
    let found = branches(
        &slider_crank(),
        &start(&[("crank", 0.7)], &["crank"]),
        &Search::default(),
    )
    .expect("isolated");
    let mut places: Vec<f64> = found.positions.iter().map(|one| one.q[2]).collect();
    places.sort_by(f64::total_cmp);
    let (along, up) = (0.3 * 0.7_f64.cos(), 0.3 * 0.7_f64.sin());
    let half = (1.0 - up * up).sqrt();
    assert_eq!(places.len(), 2);
    assert!((places[0] - along + half).abs() < 1e-12 && (places[1] - along - half).abs() < 1e-12);
}

#[test]
fn ball_joints_with_quaternions_are_counted_once() {
    // A tripod leg: a ball joint whose link must reach a fixed direction, by a cut that leaves no freedom.
    let mut linkage = Linkage::new([0.0; 3]);
    let rod = linkdyn_dynamics::RigidInertia::solid_cylinder(7850.0, 0.02, 1.0, &Vector3::x());
    let link = linkage.link("ball", rod);
    linkage.joint(
        "b",
        Joint::Spherical,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(link),
    );
    let turned = Pose::turn(Unit::new_normalize(Vector3::new(1.0, 2.0, 3.0)), 1.0);
    linkage.cut(
        "weld",
        Joint::Fixed,
        Mount::at_origin(link),
        Mount::with_pose(Linkage::GROUND, turned),
    );
    let mechanism = linkage.build().expect("valid");
    let found = branches(&mechanism, &Start::default(), &Search::default()).expect("isolated");
    // Its equations ask for three right angles only, which seven other orientations fulfil too.
    assert!(found.positions.len() == 1 && found.reversed > 100, "{found:?}");
    let [w, x, y, z] = found.positions[0].q[..] else {
        panic!("four")
    };
    let axis = Vector3::new(1.0, 2.0, 3.0).normalize() * 0.5_f64.sin();
    let expected = [0.5_f64.cos(), axis.x, axis.y, axis.z];
    let product: f64 = [w, x, y, z].iter().zip(expected).map(|(a, b)| a * b).sum();
    assert!((product.abs() - 1.0).abs() < 1e-12);
}

#[test]
fn equal_seeds_give_equal_searches_and_too_little_held_is_refused() {
    let mechanism = slider_crank();
    let search = |seed| {
        branches(
            &mechanism,
            &start(&[("crank", 0.7)], &["crank"]),
            &Search {
                seed,
                ..Search::default()
            },
        )
        .expect("isolated")
    };
    assert_eq!(search(7), search(7));
    assert_eq!(search(7).positions.len(), search(8).positions.len());
    assert_ne!(search(7).positions[0].hits, 0);
    match branches(&mechanism, &Start::default(), &Search::default()) {
        Err(AnalysisError::Undetermined { driven, free }) => {
            assert_eq!((driven.as_str(), free.as_str()), ("nothing", "`crank`, `rod`, `x`"))
        }
        other => panic!("{other:?}"),
    }
    let none = branches(
        &mechanism,
        &start(&[("crank", 0.7)], &["crank"]),
        &Search {
            guesses: 0,
            ..Search::default()
        },
    );
    assert!(matches!(none, Err(AnalysisError::Number { .. })));
}

//! Mobility of known linkages: what is redundant by name, and which motion lasts.

use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::analysis::{AnalysisError, mobility};
use linkdyn_mechanisms::catalogue::{Rsrrr, Rsup, rsrrr, rsup};
use linkdyn_mechanisms::{Linkage, Mechanism, Mount};
use linkdyn_tests::linkages::{FourBar, bennett, bricard, cardan, closed};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Speeds less equations, instantaneous, finite and general mobility.
fn counts(mechanism: &Mechanism, q: &[f64]) -> (isize, usize, usize, usize) {
    let found = mobility(mechanism, q).expect("a closed position");
    assert_eq!(found.independent.len(), found.freedoms);
    assert_eq!(found.redundant.len(), found.equations - found.rank);
    assert!(
        found.rest < 1e-3 * found.weakest,
        "{:e} {:e}",
        found.rest,
        found.weakest
    );
    assert!(found.redundant.iter().all(|row| row.measure < 1e-12));
    (found.counted, found.freedoms, found.finite, found.general)
}

#[test]
fn four_bars_have_one_freedom_however_they_are_closed() {
    for (closing, counted, redundant) in [
        (Joint::revolute_z(), -2, vec!["pin.fz", "pin.n1", "pin.n2"]),
        (Joint::Spherical, 0, vec!["pin.fz"]),
    ] {
        let plane = Pose::identity();
        let four_bar = FourBar {
            lengths: [0.3, 1.0, 0.9, 1.1],
            plane,
            closing,
        };
        let mechanism = four_bar.linkage().build().expect("valid");
        let q = closed(
            &mechanism,
            &[("crank", 0.4), ("coupler", 0.5), ("rocker", 1.6)],
            &["crank"],
        );
        // A planar loop moves in its plane whatever its dimensions are.
        assert_eq!(counts(&mechanism, &q), (counted, 1, 1, 1));
        let found = mobility(&mechanism, &q).expect("closed");
        let mut names: Vec<String> = found.redundant.iter().map(|row| row.row.to_string()).collect();
        names.sort();
        assert_eq!(names, redundant);
        // Nothing moves these rows at all.
        assert!(found.redundant.iter().all(|row| row.combination.is_empty()));
    }
}

#[test]
fn published_linkages_have_one_freedom() {
    let scene = rsrrr(&Rsrrr::default());
    let mechanism = scene.linkage.build().expect("valid");
    let (state, _) = mechanism.assemble(&scene.start).expect("closes");
    assert_eq!(counts(&mechanism, &state.q), (1, 1, 1, 1));

    let scene = rsup(&Rsup::default()).expect("a variant");
    let mechanism = scene.linkage.build().expect("valid");
    let (state, _) = mechanism.assemble(&scene.start).expect("closes");
    assert_eq!(counts(&mechanism, &state.q), (1, 1, 1, 1));

    // Each of three springy elements adds three freedoms.
    let scene = rsup(&Rsup {
        flexible: Some(3),
        ..Rsup::default()
    })
    .expect("a variant");
    let mechanism = scene.linkage.build().expect("valid");
    let (state, _) = mechanism.assemble(&scene.start).expect("closes");
    assert_eq!(counts(&mechanism, &state.q).1, 10);
}

#[test]
fn loops_that_move_by_their_dimensions_are_told() {
    let alpha = 40.0_f64.to_radians();
    let mechanism = bennett([1.0, 1.4], [alpha, (1.4 * alpha.sin()).asin()]);
    let q = closed(&mechanism, &[("th1", 1.4), ("th2", 2.7), ("th3", -1.4)], &["th1"]);
    // 3 - 5 by count, one freedom in truth, none for other dimensions.
    assert_eq!(counts(&mechanism, &q), (-2, 1, 1, 0));

    let mechanism = bricard();
    let q = vec![0.0; 5];
    assert_eq!(counts(&mechanism, &q), (0, 1, 1, 0));
    let found = mobility(&mechanism, &q).expect("closed");
    assert_eq!((found.rank, found.redundant.len()), (4, 1));

    // Axes of both shafts and of the cross meet in one point.
    let mechanism = cardan(0.6);
    let q = closed(&mechanism, &[("input", 0.3), ("output", 0.4)], &["input"]);
    assert_eq!(counts(&mechanism, &q), (-2, 1, 1, 1));
}

#[test]
fn combinations_make_up_the_rows_that_they_replace() {
    let alpha = 40.0_f64.to_radians();
    let mechanism = bennett([1.0, 1.4], [alpha, (1.4 * alpha.sin()).asin()]);
    let q = closed(&mechanism, &[("th1", 1.4), ("th2", 2.7), ("th3", -1.4)], &["th1"]);
    let found = mobility(&mechanism, &q).expect("closed");
    assert_eq!(found.redundant.len(), 3);
    let system = mechanism.system();
    let mut positions = linkdyn_kinematics::Positions::new(system.tree());
    system.tree().positions(&q, &mut positions);
    let gradient = linkdyn_kinematics::assembly::gradient(system.tree(), system.closures(), &positions);
    let row = |name: &str| {
        ["fx", "fy", "fz", "n1", "n2"]
            .iter()
            .position(|c| *c == name)
            .expect("a component")
    };
    for redundant in &found.redundant {
        assert_eq!(redundant.row.cut, "th4");
        let mut left = gradient.row(row(&redundant.row.component)).into_owned();
        for (other, factor) in &redundant.combination {
            left -= gradient.row(row(&other.component)) * *factor;
        }
        assert!(
            left.amax() < 1e-12 && !redundant.combination.is_empty(),
            "{redundant:?}"
        );
    }
}

/// Two bars between fixed pins as far apart as the bars are long together.
fn stretched(distance: f64) -> Mechanism {
    let mut linkage = Linkage::new([0.0; 3]);
    let rod = linkdyn_dynamics::RigidInertia::solid_cylinder(7850.0, 0.02, 1.0, &Vector3::x());
    let (one, two) = (linkage.link("one", rod), linkage.link("two", rod));
    linkage.joint(
        "a",
        Joint::revolute_z(),
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(one),
    );
    linkage.joint(
        "b",
        Joint::revolute_z(),
        Mount::at(one, [1.0, 0.0, 0.0]),
        Mount::at_origin(two),
    );
    let end = Mount::at(two, [1.0, 0.0, 0.0]);
    linkage.cut(
        "pin",
        Joint::revolute_z(),
        end,
        Mount::at(Linkage::GROUND, [distance, 0.0, 0.0]),
    );
    linkage.build().expect("valid")
}

#[test]
fn a_structure_that_only_shakes_has_no_finite_mobility() {
    assert_eq!(counts(&stretched(2.0), &[0.0, 0.0]), (-3, 1, 0, 0));
    let bent = stretched(1.0);
    let q = closed(&bent, &[("a", 1.0), ("b", -2.0)], &[]);
    assert_eq!(counts(&bent, &q), (-3, 0, 0, 0));
}

#[test]
fn where_branches_meet_more_seems_to_move_than_does() {
    // A parallelogram laid flat.
    let plane = Pose::identity();
    let four_bar = FourBar {
        lengths: [0.5, 1.0, 0.5, 1.0],
        plane,
        closing: Joint::revolute_z(),
    };
    let mechanism = four_bar.linkage().build().expect("valid");
    assert_eq!(counts(&mechanism, &[0.0, 0.0, 0.0]), (-2, 2, 1, 1));
    let q = closed(
        &mechanism,
        &[("crank", 1.0), ("coupler", -1.0), ("rocker", 1.0)],
        &["crank"],
    );
    assert_eq!(counts(&mechanism, &q), (-2, 1, 1, 1));
}

#[test]
fn positions_that_do_not_fit_are_refused() {
    let mechanism = stretched(1.0);
    assert!(matches!(
        mobility(&mechanism, &[0.0]),
        Err(AnalysisError::Length {
            found: 1,
            expected: 2,
            ..
        })
    ));
    assert!(matches!(
        mobility(&mechanism, &[f64::NAN, 0.0]),
        Err(AnalysisError::Number { .. })
    ));
    match mobility(&mechanism, &[0.0, PI]) {
        Err(AnalysisError::Open { residual, .. }) => assert!((residual - 1.0).abs() < 1e-12),
        other => panic!("{other:?}"),
    }
}

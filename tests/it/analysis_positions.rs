//! Position, velocity and acceleration analysis against closed forms and differences, and its ends at limits of motion.

use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::analysis::positions::{Driven, Path, Sweep};
use linkdyn_mechanisms::analysis::{AnalysisError, positions};
use linkdyn_mechanisms::{Linkage, Mechanism, Mount};
use linkdyn_tests::linkages::{FourBar, Rssr, bennett, bricard, closed};
use linkdyn_tests::numbers::{apart, difference};
use linkdyn_tests::strategies;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use std::f64::consts::PI;

fn four_bar(lengths: [f64; 4]) -> Mechanism {
    let (plane, closing) = (Pose::identity(), Joint::revolute_z());
    FourBar {
        lengths,
        plane,
        closing,
    }
    .linkage()
    .build()
    .expect("valid")
}

/// Angles of coupler (against the crank) and rocker of a four-bar, closed with the rocker above; none where it cannot be.
fn by_hand([a, b, c, d]: [f64; 4], crank: f64) -> Option<(f64, f64)> {
    let (x, y) = (a * crank.cos() - d, a * crank.sin());
    let r = x.hypot(y);
    let cosine = (r * r + c * c - b * b) / (2.0 * r * c);
    let rocker = y.atan2(x) - cosine.acos();
    let coupler = (c * rocker.sin() - y).atan2(c * rocker.cos() - x) - crank;
    (cosine.abs() <= 1.0).then_some((coupler, rocker))
}

/// Speeds and accelerations of a path are derivatives of its coordinates, for unit speed of the driven one.
fn assert_derivatives(path: &Path, spacing: f64, tolerance: f64) {
    for window in path.rows.windows(5) {
        let [a, b, c, d, e] = window else { panic!("five rows") };
        for i in 0..c.v.len() {
            let first = (8.0 * (d.q[i] - b.q[i]) - (e.q[i] - a.q[i])) / (12.0 * spacing);
            let second = (8.0 * (d.v[i] - b.v[i]) - (e.v[i] - a.v[i])) / (12.0 * spacing);
            let size = 1.0 + c.v[i].abs() + c.a[i].abs();
            assert!(
                (first - c.v[i]).abs() < tolerance * size,
                "{} {first} {}",
                c.share,
                c.v[i]
            );
            assert!(
                (second - c.a[i]).abs() < tolerance * size,
                "{} {second} {}",
                c.share,
                c.a[i]
            );
        }
    }
}

#[test]
fn a_four_bar_goes_round_as_in_closed_form() {
    let lengths = [0.3, 1.0, 0.9, 1.1];
    let mechanism = four_bar(lengths);
    let (coupler, rocker) = by_hand(lengths, 0.2).expect("Grashof");
    let q = closed(
        &mechanism,
        &[("crank", 0.2), ("coupler", coupler), ("rocker", rocker)],
        &["crank"],
    );
    let parts = 720;
    let path = positions(&mechanism, &q, &Sweep::new("crank", 0.2 + 2.0 * PI, parts)).expect("turns fully");
    assert!(path.limit.is_none() && path.rows.len() == parts + 1);
    for row in &path.rows {
        let (coupler, rocker) = by_hand(lengths, row.q[0]).expect("Grashof");
        assert!(
            apart(row.q[1], coupler) < 1e-13 && apart(row.q[2], rocker) < 1e-13,
            "{row:?}"
        );
        assert!(row.v[0] == 1.0 && row.a[0] == 0.0);
    }
    // Fourth order in steps of 9e-3.
    assert_derivatives(&path, 2.0 * PI / parts as f64, 1e-7);
    assert!(apart(path.rows[parts].q[2], path.rows[0].q[2]) < 1e-13);
}

#[test]
fn an_rssr_goes_round_on_both_branches_as_in_closed_form() {
    let rssr = Rssr::FULL_TURN;
    let mechanism = rssr.build();
    for branch in 0..2 {
        let phi = rssr.rocker_angles(0.0).expect("a full turn")[branch];
        let [psi, tilt] = rssr.rod_angles(0.0, phi);
        let q = closed(
            &mechanism,
            &[("theta", 0.0), ("rod.psi", psi), ("rod.theta", tilt), ("phi", phi)],
            &["theta"],
        );
        let path = positions(&mechanism, &q, &Sweep::new("theta", 2.0 * PI, 360)).expect("turns fully");
        assert!(path.limit.is_none());
        for row in &path.rows {
            let phi = rssr.rocker_angles(row.q[0]).expect("a full turn")[branch];
            assert!(apart(row.q[3], phi) < 1e-12, "{row:?} {phi}");
        }
        assert_derivatives(&path, PI / 180.0, 1e-6);
    }
}

#[test]
fn an_rssr_ends_at_its_locking_angle() {
    let rssr = Rssr::LOCKING;
    let mechanism = rssr.build();
    // Published locking angle.
    let end = 171.663_033_639_726_4_f64.to_radians();
    for branch in 0..2 {
        let phi = rssr.rocker_angles(1.0).expect("closes")[branch];
        let [psi, tilt] = rssr.rod_angles(1.0, phi);
        let q = closed(
            &mechanism,
            &[("theta", 1.0), ("rod.psi", psi), ("rod.theta", tilt), ("phi", phi)],
            &["theta"],
        );
        let path = positions(&mechanism, &q, &Sweep::new("theta", 2.0 * PI, 64)).expect("a start");
        let limit = path.limit.expect("it locks");
        assert!(
            (limit.driven[0] - end).abs() < 1e-8,
            "{} instead of {end}",
            limit.driven[0]
        );
        assert!(limit.measure < 1e-3, "{limit:?}");
        // At the limit the rocker turns about its pin without end, and the rod with it.
        assert!(
            limit.coordinate == "phi" || limit.coordinate.starts_with("rod."),
            "{limit:?}"
        );
        assert!(path.rows.iter().all(|row| row.q[0] <= end) && path.rows.len() > 15);
    }
}

#[test]
fn a_four_bar_that_rocks_ends_where_coupler_and_rocker_are_in_line() {
    let lengths = [1.0, 0.6, 0.7, 0.5];
    let mechanism = four_bar(lengths);
    let [a, b, c, d] = lengths;
    let end = ((a * a + d * d - (b + c) * (b + c)) / (2.0 * a * d)).acos();
    let (coupler, rocker) = by_hand(lengths, 1.0).expect("closes");
    let q = closed(
        &mechanism,
        &[("crank", 1.0), ("coupler", coupler), ("rocker", rocker)],
        &["crank"],
    );
    let path = positions(&mechanism, &q, &Sweep::new("crank", 3.0, 10)).expect("a start");
    let limit = path.limit.expect("it ends");
    assert!(
        (limit.driven[0] - end).abs() < 1e-8,
        "{} instead of {end}",
        limit.driven[0]
    );
    assert_eq!(path.rows.len(), 1 + ((end - 1.0) / 0.2) as usize);
    assert!(limit.share > 0.0 && limit.share < 1.0 && limit.value.is_finite());
}

/// The spatial slider-crank of the IFToMM library: crank about x at (0, 0.1, 0.12) m, ball joint to the rod, universal joint to a slide
/// along x.
fn spatial_slider_crank() -> Mechanism {
    let body = |mass: f64, moment: f64| linkdyn_dynamics::RigidInertia {
        mass,
        com: Vector3::zeros(),
        about_com: Matrix3::identity() * moment,
    };
    let mut linkage = Linkage::new([0.0, 0.0, -9.81]);
    let (crank, rod, slider) = (
        linkage.link("crank", body(0.12, 1e-4)),
        linkage.link("rod", body(0.5, 4e-3)),
        linkage.link("slider", body(2.0, 1e-4)),
    );
    let x = Vector3::x_axis();
    let ground = Linkage::GROUND;
    linkage.joint(
        "crank",
        Joint::Revolute { axis: x },
        Mount::at(ground, [0.0, 0.1, 0.12]),
        Mount::at_origin(crank),
    );
    linkage.joint(
        "x",
        Joint::Prismatic { axis: x },
        Mount::at_origin(ground),
        Mount::at_origin(slider),
    );
    // The rod points from the slider along its own -z.
    let cross = Joint::Universal {
        first: x,
        second: Vector3::y_axis(),
    };
    linkage.joint("rod", cross, Mount::at_origin(slider), Mount::at_origin(rod));
    linkage.cut(
        "B",
        Joint::Spherical,
        Mount::at(rod, [0.0, 0.0, 0.3]),
        Mount::at(crank, [0.0, 0.0, 0.08]),
    );
    linkage.build().expect("valid")
}

#[test]
fn a_spatial_slider_crank_has_the_positions_and_speeds_of_its_benchmark() {
    let mechanism = spatial_slider_crank();
    // From the slider at 0.2 m the rod leads to the crank's pin at (0, 0.1, 0.2) m.
    let guess = [
        ("crank", 0.0),
        ("x", 0.2),
        ("rod.psi", (-0.1_f64).atan2(0.2)),
        ("rod.theta", -0.73),
    ];
    let q = closed(&mechanism, &guess, &["crank"]);
    assert!((q[1] - 0.2).abs() < 1e-13, "{q:?}");
    let speed = 6.0;
    let driven = vec![Driven {
        coordinate: "crank".into(),
        to: 2.0 * PI,
        speed,
        acceleration: 0.0,
    }];
    let sweep = Sweep {
        driven,
        parts: 360,
        largest_step: 0.1,
    };
    let path = positions(&mechanism, &q, &sweep).expect("turns fully");
    let (mut least, mut most) = (1.0_f64, 0.0_f64);
    for row in &path.rows {
        let (sine, cosine) = row.q[0].sin_cos();
        let (y, z) = (0.1 - 0.08 * sine, 0.12 + 0.08 * cosine);
        let x = (0.09 - y * y - z * z).sqrt();
        // x x' = -(y y' + z z').
        let x_rate = speed * 0.08 * (y * cosine + z * sine) / x;
        assert!((row.q[1] - x).abs() < 1e-13, "{row:?} {x}");
        assert!((row.v[1] - x_rate).abs() < 1e-12, "{row:?} {x_rate}");
        (least, most) = (least.min(x), most.max(x));
    }
    // The stroke of the benchmark's page, to its five digits.
    assert!((least - 0.18496).abs() < 1e-5 && (most - 0.29016).abs() < 1e-5);
}

#[test]
fn redundant_loops_are_followed_too() {
    let alpha = 40.0_f64.to_radians();
    let beta = (1.4 * alpha.sin()).asin();
    let product = ((beta + alpha) / 2.0).sin() / ((beta - alpha) / 2.0).sin();
    let mechanism = bennett([1.0, 1.4], [alpha, beta]);
    let of = |th1: f64| 2.0 * (product / (th1 / 2.0).tan()).atan();
    let q = closed(&mechanism, &[("th1", 0.5), ("th2", of(0.5)), ("th3", -0.5)], &["th1"]);
    let path = positions(&mechanism, &q, &Sweep::new("th1", 5.5, 500)).expect("moves");
    assert!(path.limit.is_none());
    for row in &path.rows {
        assert!(apart(row.q[1], of(row.q[0])) < 1e-12 && apart(row.q[2], -row.q[0]) < 1e-12);
    }
    assert_derivatives(&path, 0.01, 1e-6);

    // sin a + sin b + sin a sin b = 0 of every second joint.
    let mechanism = bricard();
    let path = positions(&mechanism, &[0.0; 5], &Sweep::new("t0", 1.5, 50)).expect("moves");
    assert!(path.limit.is_none());
    for row in &path.rows {
        let (a, b) = (row.q[0].sin(), row.q[1].sin());
        assert!(
            (a.abs() + -b.abs() - a.abs() * b.abs()).abs() < 1e-12 || (a + b + a * b).abs() < 1e-12,
            "{row:?}"
        );
    }
}

#[test]
fn drives_that_do_not_determine_the_motion_are_refused() {
    let lengths = [0.3, 1.0, 0.9, 1.1];
    let mechanism = four_bar(lengths);
    let (coupler, rocker) = by_hand(lengths, 0.2).expect("Grashof");
    let q = closed(
        &mechanism,
        &[("crank", 0.2), ("coupler", coupler), ("rocker", rocker)],
        &["crank"],
    );
    let one = |name: &str, to: f64| Driven {
        coordinate: name.into(),
        to,
        speed: 1.0,
        acceleration: 0.0,
    };
    let sweep = |driven: Vec<Driven>| Sweep {
        driven,
        parts: 2,
        largest_step: 0.1,
    };
    let both = positions(&mechanism, &q, &sweep(vec![one("crank", 1.0), one("rocker", 1.0)]));
    assert!(
        matches!(both, Err(AnalysisError::Overdetermined { freedoms: 1, .. })),
        "{both:?}"
    );
    assert!(matches!(
        positions(&mechanism, &q, &sweep(vec![])),
        Err(AnalysisError::Number { .. })
    ));
    assert!(matches!(
        positions(&mechanism, &q, &sweep(vec![one("crank", f64::NAN)])),
        Err(AnalysisError::Number { .. })
    ));
    let twice = positions(&mechanism, &q, &sweep(vec![one("crank", 1.0), one("crank", 1.0)]));
    assert!(matches!(twice, Err(AnalysisError::Number { .. })), "{twice:?}");
    assert!(matches!(
        positions(&mechanism, &q, &sweep(vec![one("cranc", 1.0)])),
        Err(AnalysisError::Start(_))
    ));
    let chain = linkdyn_tests::linkages::hanging(&[(1.0, 1.0), (1.0, 1.0)])
        .build()
        .expect("valid");
    match positions(&chain, &[0.0, 0.0], &sweep(vec![one("a0", 1.0)])) {
        Err(AnalysisError::Undetermined { driven, free }) => {
            assert_eq!((driven.as_str(), free.as_str()), ("`a0`", "`a1`"))
        }
        other => panic!("{other:?}"),
    }
}

proptest! {
    #![proptest_config(strategies::cases(30))]

    #[test]
    fn there_and_back_is_the_same_way(start in 0.0..2.0 * PI, by in -3.0..3.0f64) {
        let lengths = [0.3, 1.0, 0.9, 1.1];
        let mechanism = four_bar(lengths);
        let (coupler, rocker) = by_hand(lengths, start).expect("Grashof");
        let q = closed(&mechanism, &[("crank", start), ("coupler", coupler), ("rocker", rocker)], &["crank"]);
        let there = positions(&mechanism, &q, &Sweep::new("crank", start + by, 7)).expect("turns fully");
        let end = &there.rows.last().expect("eight rows").q;
        let back = positions(&mechanism, end, &Sweep::new("crank", start, 7)).expect("turns fully");
        for (one, other) in there.rows.iter().zip(back.rows.iter().rev()) {
            prop_assert!(difference(&one.q, &other.q) < 1e-12);
        }
    }
}

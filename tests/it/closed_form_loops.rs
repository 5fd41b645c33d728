//! Loops whose positions are known in closed form, assembled by Newton's method through the public interface.

use linkdyn_dynamics::RigidInertia;
use linkdyn_kinematics::assembly::{Assembly, AssemblyError, Branch, Settings, assemble};
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::{Linkage, Mechanism, Mount, Start, StartError, State};
use linkdyn_tests::linkages::{self, FourBar, Rssr, bennett, cardan};
use linkdyn_tests::numbers::apart;
use linkdyn_tests::strategies;
use nalgebra::Vector3;
use proptest::prelude::*;
use std::f64::consts::PI;

/// Closed positions are found to a residual of 1e-14; angles follow to that times the condition, some 10.
const ANGLE: f64 = 1e-12;

fn start(mechanism: &Mechanism, positions: &[(&str, f64)], held: &[&str]) -> Result<(State, Assembly), StartError> {
    mechanism.assemble(&linkages::start(positions, held))
}

const FULL_TURN: Rssr = Rssr::FULL_TURN;

#[test]
fn rssr_angles_are_those_published() {
    let published = [
        (0.0, 0.0, 2.21429743558818),
        (30.0, 0.28336185172381, 2.36827347561225),
        (60.0, 0.31467458354030, 2.69314333066962),
        (90.0, 0.10016742116156, 3.04142523242823),
        (120.0, -0.29515227433436, -2.98021511863530),
        (180.0, -1.14018782669520, -2.92870004489621),
        (270.0, -0.99915429586988, 2.56995062266478),
        (330.0, -0.38493747856685, 2.23952791457007_f64),
    ];
    for (theta, plus, minus) in published {
        let found = FULL_TURN.rocker_angles(f64::to_radians(theta)).expect("a full turn");
        // Fourteen digits are given.
        assert!(
            apart(found[0], plus) < 2e-14 && apart(found[1], minus) < 2e-14,
            "{theta}: {found:?}"
        );
    }
}

#[test]
fn rssr_closes_on_both_branches_all_the_way_round() {
    let mechanism = FULL_TURN.build();
    for degrees in (0..360).step_by(5) {
        let theta = f64::from(degrees).to_radians();
        let mut branches = Vec::new();
        for phi in FULL_TURN.rocker_angles(theta).expect("a full turn") {
            let [psi, tilt] = FULL_TURN.rod_angles(theta, phi);
            let guess = [
                ("theta", theta),
                ("rod.psi", psi + 0.05),
                ("rod.theta", tilt - 0.05),
                ("phi", phi + 0.05),
            ];
            let (state, assembly) = start(&mechanism, &guess, &["theta"]).expect("near a closed position");
            assert_eq!(state.q[0], theta, "held");
            assert!(
                apart(state.q[3], phi) < ANGLE,
                "{degrees}: {} instead of {phi}",
                state.q[3]
            );
            assert!(assembly.residual <= 1e-14 && assembly.rank == 3);
            branches.push(assembly.branch);
        }
        branches.sort_by_key(|&b| b == Branch::Positive);
        assert_eq!(branches, [Branch::Negative, Branch::Positive], "{degrees}");
    }
}

const LOCKING: Rssr = Rssr::LOCKING;

#[test]
fn rssr_cannot_be_assembled_between_its_locking_angles() {
    let (from, to) = (
        171.663_033_639_726_4_f64.to_radians(),
        185.604_454_672_194_3_f64.to_radians(),
    );
    let mechanism = LOCKING.build();
    // On both sides of both ends; 1e-6 rad from an end the rocker is 1e-3 rad from standing still.
    for (theta, possible) in [
        (from - 1e-6, true),
        (from + 1e-5, false),
        (to - 1e-5, false),
        (to + 1e-6, true),
    ] {
        assert_eq!(LOCKING.rocker_angles(theta).is_some(), possible);
        let near = if theta < 3.1 { from - 1e-3 } else { to + 1e-3 };
        let phi = LOCKING.rocker_angles(near).expect("outside")[0];
        let [psi, tilt] = LOCKING.rod_angles(near, phi);
        let guess = [("theta", theta), ("rod.psi", psi), ("rod.theta", tilt), ("phi", phi)];
        match start(&mechanism, &guess, &["theta"]) {
            Ok((state, _)) => {
                assert!(possible, "{theta}");
                let angles = LOCKING.rocker_angles(theta).expect("outside");
                // A residual of 1e-14 beside a double root.
                assert!(angles.iter().any(|&phi| apart(state.q[3], phi) < 1e-9), "{state:?}");
            }
            Err(StartError::Assembly(AssemblyError::NotClosed { residual, .. })) => {
                assert!(!possible && residual > 1e-10, "{theta}: {residual:e}");
            }
            Err(other) => panic!("{theta}: {other}"),
        }
    }
}

#[test]
fn rods_too_short_or_too_long_are_told_with_the_gap_that_is_left() {
    // The lengths between which the locking linkage can be closed at some angle.
    for (rod, gap) in [(0.301_084_469_971_9 - 1e-3, 1e-3), (0.697_743_603_317_2 + 1e-3, 1e-3)] {
        let mechanism = Rssr { rod, ..LOCKING }.build();
        let mut least = f64::INFINITY;
        for k in 0..16 {
            let (theta, phi) = (f64::from(k % 4) * PI / 2.0, f64::from(k / 4) * PI / 2.0);
            let [psi, tilt] = LOCKING.rod_angles(theta, phi);
            let guess = [("theta", theta), ("rod.psi", psi), ("rod.theta", tilt), ("phi", phi)];
            match start(&mechanism, &guess, &[]) {
                Err(StartError::Assembly(AssemblyError::NotClosed {
                    residual,
                    rank,
                    equations: 3,
                    closure: 0,
                    equation,
                    iterations,
                })) => {
                    // The largest of three components is at least 1/sqrt 3 of the distance.
                    assert!(residual > 0.99 * gap / 3.0_f64.sqrt(), "{residual:e}");
                    assert!(rank >= 2 && equation < 3 && iterations <= 100);
                    least = least.min(residual);
                }
                other => panic!("{other:?}"),
            }
        }
        // Where a rod stretched straight is all but long enough Newton creeps, and stops within a tenth of the least gap.
        assert!(least < 1.1 * gap, "the smallest gap is {gap:e}, found {least:e}");
    }
}

#[test]
fn a_change_of_branch_is_refused_and_accepted_on_demand() {
    let mechanism = FULL_TURN.build();
    let (tree, closures) = (mechanism.system().tree(), mechanism.system().closures());
    let held = [true, false, false, false];
    let (mut refused, mut kept) = (0, 0);
    for k in 0..1000_i32 {
        let angle = |k: i32| f64::from(k % 10) * PI / 5.0;
        let guess = [1.0, angle(k), 0.25 * angle(k / 10) - PI / 4.0, angle(k / 100)];
        let strict = assemble(tree, closures, &guess, &held, &Settings::default());
        let free = Settings {
            accept_other_branch: true,
            ..Settings::default()
        };
        match strict {
            Err(AssemblyError::OtherBranch { guess: from, found }) => {
                assert_ne!(from, found);
                let accepted = assemble(tree, closures, &guess, &held, &free).expect("only the branch was wrong");
                assert_eq!(accepted.branch, found);
                refused += 1;
            }
            Ok(assembly) => {
                assert_eq!(assemble(tree, closures, &guess, &held, &free), Ok(assembly));
                kept += 1;
            }
            Err(AssemblyError::NotClosed { .. }) => {}
            Err(other) => panic!("{other}"),
        }
    }
    assert!(refused > 50 && kept > 300, "{refused} refused, {kept} kept");
}

#[test]
fn bennett_angles_are_those_in_closed_form() {
    let (alpha, beta) = (40.0_f64.to_radians(), 64.145_274_431_004_18_f64.to_radians());
    let beta_exact = (1.4 * alpha.sin()).asin();
    assert!((beta - beta_exact).abs() < 1e-9);
    let product = ((beta_exact + alpha) / 2.0).sin() / ((beta_exact - alpha) / 2.0).sin();
    assert!((product - 3.771_382_631_945_855).abs() < 1e-11, "{product}");
    let mechanism = bennett([1.0, 1.4], [alpha, beta_exact]);
    for (th1, published) in [
        (30.0, 171.87215654),
        (80.0, 154.91300883),
        (140.0, 107.8528243),
        (200.0, -67.2475352_f64),
    ] {
        let th1 = f64::to_radians(th1);
        let th2 = 2.0 * (product / (th1 / 2.0).tan()).atan();
        assert!(apart(th2, published.to_radians()) < 1e-9, "{th2}");
        let guess = [("th1", th1), ("th2", th2 + 0.02), ("th3", -th1 - 0.02)];
        let (state, assembly) = start(&mechanism, &guess, &["th1"]).expect("near a closed position");
        assert!(
            apart(state.q[1], th2) < ANGLE && apart(state.q[2], -th1) < ANGLE,
            "{state:?}"
        );
        // Five equations for three joints: one freedom, so that three equations are redundant.
        assert_eq!(
            (assembly.rank, assembly.equations, assembly.branch),
            (2, 5, Branch::Undefined)
        );
        let (_, all) = start(&mechanism, &guess, &[]).expect("near a closed position");
        assert_eq!(all.rank, 2, "mobility 3 - 2 = 1");
    }
}

/// Bricard's threefold symmetric loop: six links of 1 m, twists `alpha` and `-alpha` in turn; coordinates `t1` to `t5`, the sixth joint cut.
fn threefold(alpha: f64) -> Mechanism {
    let link = |alpha: f64| Pose {
        origin: Vector3::x(),
        ..Pose::turn(Vector3::x_axis(), alpha)
    };
    let mut linkage = Linkage::new([0.0, 0.0, -9.81]);
    let mut last = Mount::at_origin(Linkage::GROUND);
    for k in 1..=5 {
        let body = linkage.link(
            &format!("{k}"),
            RigidInertia::solid_cylinder(7850.0, 0.02, 1.0, &Vector3::x()),
        );
        linkage.joint(&format!("t{k}"), Joint::revolute_z(), last, Mount::at_origin(body));
        last = Mount::with_pose(body, link(if k % 2 == 1 { alpha } else { -alpha }));
    }
    let ground = Mount::with_pose(Linkage::GROUND, link(-alpha).inverse());
    linkage.cut("t6", Joint::revolute_z(), last, ground);
    linkage.build().expect("a valid linkage")
}

#[test]
fn threefold_bricard_angles_are_those_in_closed_form() {
    let mut closed = 0;
    for alpha in [40.0_f64, 70.0, 110.0].map(f64::to_radians) {
        let (sin, cos) = alpha.sin_cos();
        let mechanism = threefold(alpha);
        for t in [10.0_f64, 60.0, 100.0, 150.0].map(f64::to_radians) {
            // cos^2 alpha + sin^2 alpha (cos t + cos p) + (1 + cos^2 alpha) cos t cos p = 2 cos alpha sin t sin p, solved for p.
            let (a, b) = (sin * sin + (1.0 + cos * cos) * t.cos(), -2.0 * cos * t.sin());
            let ratio = -(cos * cos + sin * sin * t.cos()) / a.hypot(b);
            if ratio.abs() > 1.0 {
                continue;
            }
            for p in [1.0, -1.0].map(|side| b.atan2(a) + side * ratio.acos()) {
                let guess = [
                    ("t1", t),
                    ("t2", p + 0.02),
                    ("t3", t - 0.02),
                    ("t4", p),
                    ("t5", t + 0.01),
                ];
                let (state, assembly) = start(&mechanism, &guess, &["t1"]).expect("near a closed position");
                for (found, angle) in state.q.iter().zip([t, p, t, p, t]) {
                    assert!(apart(*found, angle) < ANGLE, "{alpha} {t}: {found} instead of {angle}");
                }
                // One of five equations is redundant, and one freedom is held.
                assert_eq!((assembly.rank, assembly.equations), (4, 5));
                closed += 1;
            }
        }
    }
    // Of twelve angles two are out of reach.
    assert_eq!(closed, 20);
}

#[test]
fn cardan_angles_and_speeds_are_those_in_closed_form() {
    let beta = 0.6_f64;
    let mechanism = cardan(beta);
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for k in 0..36 {
        let theta = f64::from(k) * PI / 18.0;
        let output = (theta.sin() / beta.cos()).atan2(theta.cos());
        let (state, assembly) = mechanism
            .assemble(&Start {
                positions: vec![("input".into(), theta), ("output".into(), output + 0.1)],
                held: vec!["input".into()],
                speeds: vec![("input".into(), 1.0)],
            })
            .expect("near a closed position");
        assert!(apart(state.q[1], output) < ANGLE, "{} instead of {output}", state.q[1]);
        let ratio = beta.cos() / (1.0 - (beta.sin() * theta.cos()).powi(2));
        assert!((state.v[1] - ratio).abs() < ANGLE, "{} instead of {ratio}", state.v[1]);
        assert_eq!((assembly.rank, assembly.equations), (1, 4));
        (least, most) = (least.min(state.v[1]), most.max(state.v[1]));
    }
    assert!((least - beta.cos()).abs() < ANGLE && (most - 1.0 / beta.cos()).abs() < ANGLE);
}

proptest! {
    #![proptest_config(strategies::cases(100))]

    #[test]
    fn four_bars_fulfil_freudenthal_in_any_plane(
        plane in strategies::pose(1.0),
        crank in 0.0..2.0 * PI,
        [b, c, d] in prop::array::uniform3(0.9..1.1f64),
        spherical in any::<bool>(),
    ) {
        // Crank 0.3: the shortest and the longest bar together are shorter than the two others, whatever they are.
        let a = 0.3;
        let closing = if spherical { Joint::Spherical } else { Joint::revolute_z() };
        let mechanism = FourBar { lengths: [a, b, c, d], plane, closing }.linkage().build().expect("valid");
        let guess = [("crank", crank), ("coupler", 0.9 - crank), ("rocker", 1.6)];
        let (state, assembly) = start(&mechanism, &guess, &["crank"]).expect("Grashof's crank turns fully");
        let (theta, phi) = (crank, state.q[2]);
        let (r1, r2, r3) = (d / a, d / c, (a * a - b * b + c * c + d * d) / (2.0 * a * c));
        // With R1, R2 up to 4 and residuals of 1e-14.
        let freudenthal = r1 * phi.cos() - r2 * theta.cos() + r3 - (theta - phi).cos();
        prop_assert!(freudenthal.abs() < ANGLE, "{freudenthal:e}");
        prop_assert_eq!(assembly.rank, 2);
        prop_assert!(phi.sin() > 0.0, "the branch of the guess");
    }
}

//! Linearised motion against closed forms, second derivatives written out, and differences of accelerations.

use linkdyn_dynamics::{Instant, MotionTerms, RigidInertia, Workspace};
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::analysis::equilibrium::Settings;
use linkdyn_mechanisms::analysis::{AnalysisError, equilibrium, linearise};
use linkdyn_mechanisms::catalogue::{Rsrrr, rsrrr};
use linkdyn_mechanisms::rfem::modes::{Axis, Ends, bending_frequency};
use linkdyn_mechanisms::{Linkage, Mechanism, Mount, Simulation, Spring, Start, State};
use linkdyn_tests::linkages::{Cantilever, FourBar, Rssr, cantilever, hanging};
use linkdyn_tests::numbers::{derivative, difference};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use std::f64::consts::PI;

fn at_rest(q: &[f64], speeds: usize) -> State {
    State {
        q: q.to_vec(),
        v: vec![0.0; speeds],
    }
}

#[test]
fn a_pendulum_with_spring_and_damper() {
    let (length, mass, stiffness, damping) = (0.7, 2.0, 5.0, 0.6);
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let inertia = RigidInertia {
        mass,
        com: Vector3::new(0.0, -length, 0.0),
        about_com: Matrix3::zeros(),
    };
    let link = linkage.link("bar", inertia);
    let joint = linkage.joint(
        "a",
        Joint::revolute_z(),
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(link),
    );
    let spring = Spring {
        stiffness,
        damping,
        ..Spring::default()
    };
    linkage.springs(joint, &[spring]);
    let mechanism = linkage.build().expect("valid");
    let found = linearise(&mechanism, 0.0, &at_rest(&[0.0], 1)).expect("at rest");
    let (m, k) = (mass * length * length, mass * 9.81 * length + stiffness);
    assert!((found.mass[(0, 0)] - m).abs() < 1e-12 && (found.damping[(0, 0)] - damping).abs() < 1e-11);
    assert!((found.stiffness[(0, 0)] - k).abs() < 1e-9);
    let modes = found.modes().expect("regular");
    assert_eq!(modes.len(), 1);
    let (omega, ratio) = ((k / m).sqrt(), damping / (2.0 * (k * m).sqrt()));
    assert!((modes[0].frequency() * 2.0 * PI / omega - 1.0).abs() < 1e-9);
    assert!((modes[0].damping_ratio().expect("not zero") - ratio).abs() < 1e-9);
    assert!((modes[0].damped_frequency() * 2.0 * PI - omega * (1.0 - ratio * ratio).sqrt()).abs() < 1e-8);
    assert!((modes[0].shape[0] - 1.0).norm() < 1e-12);
}

#[test]
fn a_double_pendulum() {
    let (length, mass) = (0.7, 2.0);
    let mechanism = hanging(&[(length, mass), (length, mass)]).build().expect("valid");
    let modes = linearise(&mechanism, 0.0, &at_rest(&[0.0, 0.0], 2))
        .expect("at rest")
        .modes()
        .expect("regular");
    assert_eq!(modes.len(), 2);
    for (mode, sign) in modes.iter().zip([-1.0, 1.0]) {
        let square = (2.0 + sign * 2.0_f64.sqrt()) * 9.81 / length;
        assert!((mode.eigenvalue.im / square.sqrt() - 1.0).abs() < 1e-9 && mode.eigenvalue.re == 0.0);
        assert_eq!(mode.damping_ratio(), Some(0.0));
        // The lower bar turns by sqrt 2 times as much, with or against the upper one; its joint by the difference.
        let ratio = mode.shape[1] / mode.shape[0];
        assert!((ratio.re - (-sign * 2.0_f64.sqrt() - 1.0)).abs() < 1e-9, "{ratio}");
    }
    // Upright the upper bar falls: pairs of real eigenvalues.
    let modes = linearise(&mechanism, 0.0, &at_rest(&[PI, 0.0], 2))
        .expect("at rest")
        .modes()
        .expect("regular");
    let real: Vec<f64> = modes
        .iter()
        .filter(|mode| mode.eigenvalue.im == 0.0)
        .map(|mode| mode.eigenvalue.re)
        .collect();
    assert!(real.len() == 4 && real.iter().sum::<f64>().abs() < 1e-9, "{modes:?}");
}

#[test]
fn a_cantilever_of_elements_approaches_the_beam_as_published() {
    // Relative errors of the first mode for 2, 4, 8 elements; the bar's two planes are alike.
    for (n, published) in [(2, 6.08e-2), (4, 1.45e-2), (8, 3.60e-3)] {
        let Cantilever {
            mechanism,
            section,
            material,
            ..
        } = cantilever(n, 0.0, 0.0);
        let state = at_rest(&vec![0.0; 3 * n], 3 * n);
        let modes = linearise(&mechanism, 0.0, &state)
            .expect("at rest")
            .modes()
            .expect("regular");
        assert_eq!(modes.len(), 3 * n);
        let exact =
            bending_frequency(1.0, &section, &material, Axis::Y, Ends::ClampedFree, 1).expect("a mode") / (2.0 * PI);
        for mode in &modes[..2] {
            let error = mode.frequency() / exact - 1.0;
            assert!((error / published - 1.0).abs() < 1e-2, "{n}: {error:e}");
        }
        // Two shapes, each its own.
        let product: f64 = modes[0]
            .shape
            .iter()
            .zip(&modes[1].shape)
            .map(|(a, b)| a.re * b.re)
            .sum();
        let size = |k: usize| modes[k].shape.iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt();
        assert!(product.abs() < 0.99 * size(0) * size(1));
    }
}

#[test]
fn damping_of_the_material_grows_with_the_frequency() {
    let relaxation_time = 1e-4;
    let mechanism = cantilever(3, 0.0, relaxation_time).mechanism;
    let modes = linearise(&mechanism, 0.0, &at_rest(&[0.0; 9], 9))
        .expect("at rest")
        .modes()
        .expect("regular");
    // D = tau K: the ratio is tau omega/2 for every mode.
    let slow: Vec<_> = modes.iter().filter(|mode| mode.eigenvalue.im > 0.0).collect();
    assert!(slow.len() > 3);
    for mode in slow {
        let expected = relaxation_time * mode.frequency() * PI;
        let ratio = mode.damping_ratio().expect("not zero");
        assert!((ratio - expected).abs() < 1e-6, "{ratio} {expected}");
    }
}

#[test]
fn a_sagged_cantilever_vibrates_like_a_straight_one() {
    let straight = cantilever(4, 0.0, 0.0).mechanism;
    let heavy = cantilever(4, 9.81, 0.0).mechanism;
    let sagged = equilibrium(&heavy, &[0.0; 12], &Settings::default()).expect("sags");
    let frequencies = |mechanism: &Mechanism, q: &[f64]| -> Vec<f64> {
        let modes = linearise(mechanism, 0.0, &at_rest(q, 12))
            .expect("at rest")
            .modes()
            .expect("regular");
        modes.iter().map(|mode| mode.frequency()).collect()
    };
    let (one, other) = (frequencies(&straight, &[0.0; 12]), frequencies(&heavy, &sagged.q));
    // The sag is 5e-3 of the length: squares of it count.
    for (a, b) in one.iter().zip(&other).take(4) {
        assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
    }
    assert!((other[0] * 2.0 * PI / sagged.lowest.sqrt() - 1.0).abs() < 1e-6);
}

/// The stiffness written out: `-T^T (df/dq + d(G^T lambda)/dq) T` with the multipliers kept.
fn written_out(mechanism: &Mechanism, q: &[f64], lambda: &[f64], tangent: &DMatrix<f64>) -> DMatrix<f64> {
    let system = mechanism.system();
    let n = system.tree().speeds();
    let along = |k: usize| {
        derivative(|by| {
            let mut at = q.to_vec();
            system.tree().displace(&mut at, (tangent.column(k) * by).as_slice());
            let (mut work, mut terms) = (Workspace::new(system), MotionTerms::new(system));
            system
                .write_terms(&Instant::new(0.0, &at, &vec![0.0; n]), &mut work, &mut terms)
                .expect("no loads that refuse");
            let gradient = DMatrix::from_column_slice(n, lambda.len(), &terms.gradient);
            DVector::from_column_slice(&terms.force) + gradient * DVector::from_column_slice(lambda)
        })
    };
    let columns: Vec<_> = (0..tangent.ncols()).map(|k| -tangent.tr_mul(&along(k))).collect();
    DMatrix::from_columns(&columns)
}

#[test]
fn the_stiffness_holds_multipliers_times_second_derivatives() {
    let closing = Joint::revolute_z();
    let four_bar = FourBar {
        lengths: [0.3, 1.0, 0.9, 1.1],
        plane: Pose::turn(Vector3::y_axis(), 0.4),
        closing,
    };
    let rssr = Rssr::FULL_TURN;
    let phi = rssr.rocker_angles(0.5).expect("closes")[0];
    let [psi, tilt] = rssr.rod_angles(0.5, phi);
    let cases = [
        (
            four_bar.linkage().build().expect("valid"),
            vec![("crank", 0.2), ("coupler", 0.7), ("rocker", 1.6)],
        ),
        (
            rssr.build(),
            vec![("theta", 0.5), ("rod.psi", psi), ("rod.theta", tilt), ("phi", phi)],
        ),
    ];
    for (mechanism, guess) in cases {
        let start = Start {
            positions: guess.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            held: vec![guess[0].0.to_owned()],
            speeds: Vec::new(),
        };
        let (state, _) = mechanism.assemble(&start).expect("closes");
        let rest = equilibrium(&mechanism, &state.q, &Settings::default()).expect("hangs");
        let found = linearise(&mechanism, 0.0, &at_rest(&rest.q, state.v.len())).expect("at rest");
        let all = written_out(&mechanism, &rest.q, &rest.multipliers, &found.tangent);
        let gap = (&found.stiffness - &all).amax();
        assert!(gap < 1e-8 * all.amax(), "{} {all}", found.stiffness);
        assert!((&found.stiffness - &rest.stiffness).amax() < 1e-9 * all.amax());
        // Without that term it would be another one.
        let without = written_out(&mechanism, &rest.q, &vec![0.0; rest.multipliers.len()], &found.tangent);
        assert!((&without - &all).amax() > 1e-2 * all.amax());
    }
}

/// A mass on an arm whose hinge is carried round by a shaft about z.
fn governor(inertia: f64, mass: f64, length: f64) -> Mechanism {
    let mut linkage = Linkage::new([0.0, 0.0, -9.81]);
    let shaft = RigidInertia {
        mass: 1.0,
        com: Vector3::zeros(),
        about_com: Matrix3::identity() * inertia,
    };
    let (shaft, arm) = (
        linkage.link("shaft", shaft),
        linkage.link(
            "arm",
            RigidInertia {
                mass,
                com: Vector3::new(0.0, 0.0, -length),
                about_com: Matrix3::zeros(),
            },
        ),
    );
    linkage.joint(
        "spin",
        Joint::revolute_z(),
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(shaft),
    );
    let hinge = Joint::Revolute {
        axis: Vector3::y_axis(),
    };
    linkage.joint("arm", hinge, Mount::at_origin(shaft), Mount::at_origin(arm));
    linkage.build().expect("valid")
}

#[test]
fn a_flyball_governor_swings_about_its_steady_spin() {
    let (j, m, l, spin) = (0.2, 1.5, 0.4, 7.0_f64);
    let mechanism = governor(j, m, l);
    let cosine = 9.81 / (l * spin * spin);
    let sine = (1.0 - cosine * cosine).sqrt();
    let state = State {
        q: vec![0.3, cosine.acos()],
        v: vec![spin, 0.0],
    };
    let found = linearise(&mechanism, 0.0, &state).expect("regular");
    assert!(found.rates.iter().all(|a| a.abs() < 1e-12), "steady: {:?}", found.rates);
    let modes = found.modes().expect("regular");
    // By the effective potential at constant momentum; the spin itself leaves two zeros.
    let square = (spin * sine).powi(2) * (1.0 + 4.0 * m * l * l * cosine * cosine / (j + m * l * l * sine * sine));
    let swing = modes.last().expect("three modes");
    assert!(
        (swing.eigenvalue.im / square.sqrt() - 1.0).abs() < 1e-8 && swing.eigenvalue.re.abs() < 1e-7,
        "{modes:?}"
    );
    assert!(
        modes[..modes.len() - 1]
            .iter()
            .all(|mode| mode.eigenvalue.norm() < 1e-4)
    );
}

#[test]
fn a_loop_with_friction_in_motion_has_the_derivatives_of_its_accelerations() {
    for friction in [false, true] {
        let scene = rsrrr(&Rsrrr {
            friction,
            friction_scale: 1.0,
        });
        let mechanism = scene.linkage.build().expect("valid");
        let at = |angle: f64, speed: f64| {
            let mut start = scene.start.clone();
            start.positions[0].1 += angle;
            start.speeds = vec![("psi11".into(), speed)];
            mechanism.assemble(&start).expect("closes").0
        };
        let state = at(0.3, 2.0);
        let found = linearise(&mechanism, 1.0, &state).expect("regular");
        assert_eq!(found.independent.len(), 1);
        let own = mechanism
            .coordinate_names()
            .position(|name| *name == *found.independent[0])
            .expect("a turn");
        let rate = |angle: f64, speed: f64| {
            let state = at(0.3 + angle, 2.0 + speed);
            let mut simulation = Simulation::new(&mechanism);
            let a = simulation.accelerations(1.0, &state.q, &state.v).expect("moves")[0];
            DVector::from_vec(vec![a])
        };
        assert_eq!(own, 0, "the crank");
        let by_angle = derivative(|by| rate(by, 0.0))[0];
        let by_speed = derivative(|by| rate(0.0, by))[0];
        let mass = found.mass[(0, 0)];
        let (k, d) = (found.stiffness[(0, 0)] / mass, found.damping[(0, 0)] / mass);
        assert!((k + by_angle).abs() < 1e-6 * (1.0 + k.abs()), "{k} {by_angle}");
        assert!((d + by_speed).abs() < 1e-6 * (1.0 + d.abs()), "{d} {by_speed}");
        let a = found.state_matrix().expect("regular");
        assert!(difference(a.as_slice(), &[0.0, -k, 1.0, -d]) < 1e-12);
    }
}

#[test]
fn ball_joints_with_quaternions_swing_about_rest_only() {
    let mut linkage = Linkage::new([0.0, 0.0, -9.81]);
    let rod = RigidInertia {
        mass: 2.0,
        com: Vector3::new(0.0, 0.0, -0.5),
        about_com: Matrix3::identity() * 0.1,
    };
    let link = linkage.link("bob", rod);
    linkage.joint(
        "ball",
        Joint::Spherical,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(link),
    );
    let mechanism = linkage.build().expect("valid");
    let q = mechanism.system().tree().neutral();
    let modes = linearise(&mechanism, 0.0, &at_rest(&q, 3))
        .expect("at rest")
        .modes()
        .expect("regular");
    let square: f64 = 2.0 * 9.81 * 0.5 / (0.1 + 2.0 * 0.25);
    let swings = modes
        .iter()
        .filter(|mode| (mode.eigenvalue.im / square.sqrt() - 1.0).abs() < 1e-9)
        .count();
    assert_eq!(swings, 2, "{modes:?}");
    let moving = State {
        q,
        v: vec![1.0, 0.0, 0.0],
    };
    assert!(matches!(
        linearise(&mechanism, 0.0, &moving),
        Err(AnalysisError::Quaternion { .. })
    ));
}

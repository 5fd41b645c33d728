//! What each analysis makes of every kind of load: right, or refused by the load's name.

use crate::limits::law;
use linkdyn_dynamics::RigidInertia;
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::analysis::equilibrium::{Settings, Stability};
use linkdyn_mechanisms::analysis::inverse_dynamics::Prescribed;
use linkdyn_mechanisms::analysis::positions::Sweep;
use linkdyn_mechanisms::analysis::{
    AnalysisError, branches, equilibrium, inverse_dynamics, linearise, mobility, positions,
};
use linkdyn_mechanisms::{
    Axes, Drive, Limit, Linkage, Mechanism, Mount, Observation, PointLoad, PrescribedMotion, Simulation, Spring, Start,
    State, Strut,
};
use linkdyn_tests::linkages::{FourBar, hanging, start};
use linkdyn_tests::numbers::difference;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

fn at_rest(mechanism: &Mechanism, q: &[f64]) -> State {
    State {
        q: q.to_vec(),
        v: vec![0.0; mechanism.system().tree().speeds()],
    }
}

fn single(coordinate: &str, speed: f64, acceleration: f64) -> [Prescribed; 1] {
    [Prescribed {
        coordinate: coordinate.into(),
        speed,
        acceleration,
    }]
}

/// A mass on a rail along x, pushed along it, with a strut from a point beside the rail: with its length `l` the strut's energy is
/// `k (l - l0)^2 / 2`, so that it pulls with `k (l - l0) x/l` and has the stiffness `k (1 - l0/l) + k l0 x^2/l^3`.
#[test]
fn struts_and_forces_on_points_count_at_rest() {
    let (m, k, d, free, height, push) = (2.0, 300.0, 4.0, 0.2, 0.3, 25.0);
    let mut linkage = Linkage::new([0.0, 0.0, -9.81]);
    let inertia = RigidInertia {
        mass: m,
        com: Vector3::zeros(),
        about_com: Matrix3::identity() * 0.01,
    };
    let block = linkage.link("block", inertia);
    let along = Joint::Prismatic {
        axis: Vector3::x_axis(),
    };
    let (ground, on_block) = (Mount::at_origin(Linkage::GROUND), Mount::at_origin(block));
    linkage.joint("x", along, ground, on_block);
    linkage.strut(
        "strut",
        Strut {
            from: Mount::at(Linkage::GROUND, [0.0, height, 0.0]),
            to: on_block,
            free_length: free,
            stiffness: k,
            damping: d,
        },
    );
    linkage.force(
        "push",
        PointLoad {
            at: on_block,
            direction: [2.0, 0.0, 0.0],
            axes: Axes::Ground,
            drives: vec![
                Drive::Constant { torque: push },
                Drive::Resistance {
                    torque: 0.5,
                    reference_speed: 1.0,
                },
            ],
        },
    );
    let mechanism = linkage.build().expect("sound");
    let rest = equilibrium(&mechanism, &[0.01], &Settings::default()).expect("there is one");
    let x = rest.q[0];
    let l = x.hypot(height);
    assert!(x > 0.05 && (k * (l - free) * x / l - push).abs() < 1e-9, "{x}");
    let stiffness = k * (1.0 - free / l) + k * free * x * x / l.powi(3);
    assert!(
        (rest.stiffness[(0, 0)] - stiffness).abs() < 1e-7 * stiffness,
        "{rest:?}"
    );
    let found = linearise(&mechanism, 0.0, &at_rest(&mechanism, &rest.q)).expect("at rest");
    assert!((found.stiffness[(0, 0)] - stiffness).abs() < 1e-7 * stiffness);
    assert!((found.mass[(0, 0)] - m).abs() < 1e-12);
    assert!(
        (found.damping[(0, 0)] - d * (x / l).powi(2) - 0.5).abs() < 1e-9,
        "{found:?}"
    );
    let (speed, acceleration) = (0.4, -3.0);
    let needs = inverse_dynamics(&mechanism, 0.0, &[x], &single("x", speed, acceleration)).expect("moves");
    let force = m * acceleration + (d * (x / l).powi(2) + 0.5) * speed;
    assert!((needs.drives[0] - force).abs() < 1e-9, "{needs:?}");
}

/// `(J + m p^2) theta'' + k theta + m g p = 0`.
#[test]
fn a_screw_with_a_spring_rests_and_swings_as_its_closed_form() {
    let (m, moment, pitch, k) = (3.0, 0.02, 0.05, 4.0);
    let mut linkage = Linkage::new([0.0, 0.0, -9.81]);
    let inertia = RigidInertia {
        mass: m,
        com: Vector3::zeros(),
        about_com: Matrix3::identity() * moment,
    };
    let nut = linkage.link("nut", inertia);
    let axis = Vector3::z_axis();
    let (ground, on_nut) = (Mount::at_origin(Linkage::GROUND), Mount::at_origin(nut));
    let thread = linkage.joint("thread", Joint::Screw { axis, pitch }, ground, on_nut);
    let spring = Spring {
        stiffness: k,
        ..Spring::default()
    };
    linkage.springs(thread, &[spring]);
    let mechanism = linkage.build().expect("sound");
    let rest = equilibrium(&mechanism, &[0.5], &Settings::default()).expect("there is one");
    assert!((rest.q[0] + m * 9.81 * pitch / k).abs() < 1e-10, "{rest:?}");
    let modes = linearise(&mechanism, 0.0, &at_rest(&mechanism, &rest.q))
        .expect("at rest")
        .modes();
    let omega = (k / (moment + m * pitch * pitch)).sqrt();
    assert!((modes.expect("one")[0].frequency() * 2.0 * PI / omega - 1.0).abs() < 1e-9);
    let needs = inverse_dynamics(&mechanism, 0.0, &[0.3], &single("thread", 1.0, 2.0)).expect("moves");
    let torque = (moment + m * pitch * pitch) * 2.0 + k * 0.3 + m * 9.81 * pitch;
    assert!((needs.drives[0] - torque).abs() < 1e-12, "{needs:?}");
}

/// A four-bar with every load that has no states of its own; the drive of its crank is what inverse dynamics must give back.
fn loaded(torque: f64) -> Linkage {
    let four_bar = FourBar {
        lengths: [0.3, 1.0, 0.9, 1.1],
        plane: Pose::turn(Vector3::x_axis(), 0.7),
        closing: Joint::Spherical,
    };
    let mut linkage = four_bar.linkage();
    let handle = |linkage: &Linkage, name: &str| linkage.joint_named(name).expect("it is there");
    let (crank, coupler, rocker) = (
        handle(&linkage, "crank"),
        handle(&linkage, "coupler"),
        handle(&linkage, "rocker"),
    );
    let link = |name: &str| linkage.link_named(name).expect("it is there");
    let (on_coupler, on_rocker) = (link("coupler"), link("rocker"));
    let harmonic = Drive::Harmonic {
        amplitude: 3.0,
        frequency: 0.4,
        phase: 0.2,
    };
    let resistance = Drive::QuadraticResistance {
        torque: 2.0,
        reference_speed: 1.5,
    };
    let spring = Spring {
        stiffness: 6.0,
        damping: 0.4,
        rest: 0.3,
    };
    linkage.drive(crank, Drive::Constant { torque });
    linkage
        .drive(rocker, harmonic.clone())
        .drive(rocker, resistance.clone());
    linkage.springs(coupler, &[spring]);
    let strut = Strut {
        from: Mount::at(Linkage::GROUND, [0.2, 0.9, 0.4]),
        to: Mount::at(on_coupler, [0.6, 0.1, 0.0]),
        free_length: 0.3,
        stiffness: 120.0,
        damping: 5.0,
    };
    let force = PointLoad {
        at: Mount::at(on_coupler, [0.5, -0.2, 0.1]),
        direction: [1.0, -2.0, 0.5],
        axes: Axes::Mount,
        drives: vec![harmonic, resistance],
    };
    let moment = PointLoad {
        at: Mount::at_origin(on_rocker),
        direction: [0.3, 0.2, 1.0],
        axes: Axes::Ground,
        drives: vec![Drive::Constant { torque: 4.0 }],
    };
    linkage
        .strut("strut", strut)
        .force("force", force)
        .moment("moment", moment);
    linkage
}

#[test]
fn inverse_dynamics_gives_back_the_drive_beside_loads_of_all_kinds() {
    let (free, time) = (loaded(0.0).build().expect("sound"), 0.7);
    for (angle, speed, torque) in [(0.2, 3.0, 5.0), (2.0, -4.0, 1.0), (4.5, 1.0, -8.0)] {
        let mut start = start(
            &[("crank", angle), ("coupler", 0.9 - angle), ("rocker", 1.6)],
            &["crank"],
        );
        start.speeds = vec![("crank".into(), speed)];
        let driven = loaded(torque).build().expect("sound");
        let (state, _) = driven.assemble(&start).expect("closes");
        let mut simulation = Simulation::new(&driven);
        let (y, mut forward) = (simulation.state_vector(&state), Observation::default());
        simulation.observe(time, &y, &mut forward).expect("moves");
        let motion = single("crank", speed, forward.a[0]);
        let back = inverse_dynamics(&free, time, &state.q, &motion).expect("moves");
        assert!(
            (back.drives[0] - torque).abs() < 1e-9,
            "{} instead of {torque}",
            back.drives[0]
        );
        assert!(difference(&back.multipliers, &forward.multipliers) < 1e-10);
        for (one, other) in back.reactions.iter().zip(&forward.reactions) {
            assert!((one.force - other.force).amax() < 1e-8 && (one.torque - other.torque).amax() < 1e-8);
        }
    }
}

/// Two bars that hang on one another, the upper one swung to and fro: 0.5 rad in the middle, 0.7 rad after a quarter of a second.
fn swung() -> Mechanism {
    let mut linkage = hanging(&[(0.6, 1.0), (0.4, 2.0)]);
    let motion = PrescribedMotion::Harmonic {
        mean: 0.5,
        amplitude: 0.2,
        frequency: 1.0,
        phase: 0.0,
    };
    let upper = linkage.joint_named("a0").expect("it is there");
    linkage.prescribe(upper, motion);
    linkage.build().expect("sound")
}

#[test]
fn prescribed_coordinates_are_held_where_a_mechanism_rests_and_swings() {
    let mechanism = swung();
    let settings = Settings {
        time: 0.25,
        ..Settings::default()
    };
    let rest = equilibrium(&mechanism, &[0.5, 0.1], &settings).expect("the lower bar hangs");
    assert!(rest.q[0] == 0.7 && (rest.q[1] + 0.7).abs() < 1e-10, "{:?}", rest.q);
    assert_eq!(
        (rest.stability, rest.independent.as_slice()),
        (Stability::Stable, &["a1".to_owned()][..])
    );
    let torque = 3.0 * 9.81 * 0.6 * 0.7_f64.sin();
    assert!((rest.multipliers[0] - torque).abs() < 1e-9, "{:?}", rest.multipliers);
    let state = at_rest(&mechanism, &rest.q);
    let found = linearise(&mechanism, 0.25, &state).expect("at rest");
    let modes = found.modes().expect("one");
    let omega = (9.81_f64 / 0.4).sqrt();
    assert!(
        modes.len() == 1 && (modes[0].frequency() * 2.0 * PI / omega - 1.0).abs() < 1e-8,
        "{modes:?}"
    );
    assert!(modes[0].shape[0].norm() < 1e-12);
    // Away from rest the lower bar falls as if the upper one stood still.
    let found = linearise(&mechanism, 0.25, &at_rest(&mechanism, &[0.7, 0.3])).expect("let go");
    assert!(found.rates[0].abs() < 1e-12 && (found.rates[1] + 9.81 / 0.4 * 1.0_f64.sin()).abs() < 1e-9);
    let moving = State {
        v: vec![0.0, 1.0],
        ..state
    };
    match linearise(&mechanism, 0.25, &moving) {
        Err(AnalysisError::Internals { what }) => assert!(what.contains("`a0`"), "{what}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn prescribed_coordinates_are_free_where_motion_is_asked_for() {
    let (mechanism, free) = (swung(), hanging(&[(0.6, 1.0), (0.4, 2.0)]).build().expect("sound"));
    let counted = mobility(&mechanism, &[0.9, 0.2]).expect("whatever the time");
    assert_eq!((counted.freedoms, counted.equations), (2, 0));
    let motion = [single("a0", 1.0, 2.0), single("a1", -0.5, 0.3)].concat();
    let [one, other] = [&mechanism, &free].map(|m| inverse_dynamics(m, 0.0, &[0.9, 0.2], &motion).expect("moves"));
    assert_eq!(one.drives, other.drives);
    assert!(one.multipliers == [0.0] && other.multipliers.is_empty());

    // A crank whose speed is prescribed, and one whose position is.
    for motion in [vec![1.0, 6.0], vec![1.0]] {
        let mut linkage = loaded(0.0);
        let crank = linkage.joint_named("crank").expect("it is there");
        linkage.prescribe(crank, PrescribedMotion::Polynomial { coefficients: motion });
        let mechanism = linkage.build().expect("sound");
        let begin = start(&[("coupler", -0.1), ("rocker", 1.6)], &[]);
        let (state, _) = mechanism.assemble(&begin).expect("closes");
        assert_eq!(mobility(&mechanism, &state.q).expect("closed").freedoms, 1);
        let path = positions(&mechanism, &state.q, &Sweep::new("crank", 2.0, 4)).expect("moves");
        assert!(path.rows.len() == 5 && path.limit.is_none());
        let found = branches(&mechanism, &Start::default(), &Default::default()).expect("the crank is held");
        assert_eq!(found.positions.len(), 2);
        assert!(found.positions.iter().all(|closed| closed.q[0] == 1.0));
        match equilibrium(&mechanism, &state.q, &Settings::default()) {
            Err(AnalysisError::NoFreedom) => {}
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn stops_do_not_hinder_positions_and_are_named_where_forces_are_asked_for() {
    let mut linkage = hanging(&[(0.6, 1.0)]);
    let joint = linkage.joint_named("a0").expect("it is there");
    linkage.limit(
        joint,
        Limit {
            lower: Some(-0.5),
            upper: Some(0.5),
            law: law(0.5),
        },
    );
    let mechanism = linkage.build().expect("sound");
    assert_eq!(mobility(&mechanism, &[0.1]).expect("closed").freedoms, 1);
    let path = positions(&mechanism, &[0.1], &Sweep::new("a0", 1.0, 3)).expect("moves");
    assert_eq!(path.rows.len(), 4);
    let refused = [
        equilibrium(&mechanism, &[0.1], &Settings::default()).map(drop),
        inverse_dynamics(&mechanism, 0.0, &[0.1], &single("a0", 0.0, 0.0)).map(drop),
        linearise(&mechanism, 0.0, &at_rest(&mechanism, &[0.1])).map(drop),
    ];
    for refused in refused {
        let message = refused.expect_err("contacts have states").to_string();
        assert!(message.contains("joint `a0` has a limit"), "{message}");
    }
}

#[test]
fn coordinates_are_held_by_name_but_not_parts_of_quaternions() {
    let mut linkage = hanging(&[(0.6, 1.0), (0.4, 2.0)]);
    let ball = linkage.link("ball", RigidInertia::solid_cylinder(1000.0, 0.1, 0.2, &Vector3::z()));
    linkage.joint(
        "S",
        Joint::Spherical,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(ball),
    );
    let mechanism = linkage.build().expect("sound");
    let held = |name: &str| Settings {
        held: vec![name.to_owned()],
        ..Settings::default()
    };
    let q = [0.5, 0.2, 1.0, 0.0, 0.0, 0.0];
    let refused = equilibrium(&mechanism, &q, &held("S.w")).expect_err("no coordinate of its own");
    assert!(matches!(refused, AnalysisError::Quaternion { .. }), "{refused}");
    let refused = equilibrium(&mechanism, &q, &held("a2")).expect_err("unknown");
    assert!(refused.to_string().contains("there is no coordinate `a2`"), "{refused}");
    let rest = equilibrium(&mechanism, &q, &held("a0")).expect("the lower bar hangs");
    assert!(rest.q[0] == 0.5 && (rest.q[1] + 0.5).abs() < 1e-9, "{:?}", rest.q);
}

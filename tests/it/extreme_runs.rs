//! What brings the outcomes of extreme cases: linkages at the edge of sense, built, closed and run.

use crate::linkage_refusals::{arm, rod};
use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::{Exponential, JournalBearing, Surface};
use linkdyn_integrators::{Dop853, Integration, Method, Radau5, Rk4};
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::{Drive, Linkage, Mount, Observation, Scene, Simulation, Spring, Start, run};
use linkdyn_tests::linkages::FourBar;
use nalgebra::{Matrix3, Vector3};
use std::error::Error;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Most steps of a run: enough for all that come to an end.
const MOST_STEPS: u64 = 20_000;

/// `done`, or `refused` with the reason.
pub(crate) fn told<T, E: Error>(result: Result<T, E>) -> String {
    result.map_or_else(|error| format!("refused: {error}"), |_| "done".to_owned())
}

/// Builds, closes and runs.
pub(crate) fn outcome(linkage: Linkage, start: &Start, method: impl Method<Simulation>, until: f64) -> String {
    rows(linkage, start, method, (until, 0.01))
}

pub(crate) fn rows(linkage: Linkage, start: &Start, method: impl Method<Simulation>, grid: (f64, f64)) -> String {
    watched(linkage, start, method, grid, |_| ())
}

/// The same, with a look at each row: `done`, `refused` before the first step, or `stops` after it.
pub(crate) fn watched(
    linkage: Linkage,
    start: &Start,
    method: impl Method<Simulation>,
    (until, every): (f64, f64),
    mut look: impl FnMut(&Observation),
) -> String {
    let mechanism = match linkage.build() {
        Ok(mechanism) => mechanism,
        Err(error) => return format!("refused: {error}"),
    };
    let state = match mechanism.assemble(start) {
        Ok((state, _)) => state,
        Err(error) => return format!("refused: {error}"),
    };
    let simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&state);
    let mut settings = simulation.settings(1e-8, 1e-8);
    settings.max_steps = MOST_STEPS;
    let stops = mechanism.system().stop_times();
    let integration = Integration::new(simulation, method, 0.0, &y, settings);
    let mut integration = match integration.and_then(|integration| integration.with_stops(&stops)) {
        Ok(integration) => integration,
        Err(error) => return format!("refused: {error}"),
    };
    let mut seen = 0;
    let ended = run(&mut integration, until, every, |o| {
        assert!(
            o.q.iter().chain(&o.v).chain(&o.a).all(|x| x.is_finite()),
            "a row at {} s",
            o.t
        );
        seen += 1;
        look(o);
        ControlFlow::Continue(())
    });
    match ended {
        Ok(()) => "done".to_owned(),
        Err(error) if seen == 0 => format!("refused: {error}"),
        Err(error) => format!("stops: {error}"),
    }
}

pub(crate) fn scene_outcome(scene: Scene, until: f64) -> String {
    outcome(scene.linkage, &scene.start, Radau5::default(), until)
}

/// The arm with a third link on a hinge, its inertia changed.
pub(crate) fn end_of_the_arm(change: impl FnOnce(&mut RigidInertia)) -> String {
    let mut arm = arm();
    let mut inertia = rod();
    change(&mut inertia);
    let third = arm.linkage.link("third", inertia);
    let elbow = Mount::at(arm.lower, [0.5, 0.0, 0.0]);
    arm.linkage
        .joint("wrist", Joint::revolute_z(), elbow, Mount::at_origin(third));
    outcome(arm.linkage, &Start::default(), Dop853::default(), 0.1)
}

pub(crate) fn massless_between() -> String {
    let mut arm = arm();
    let nothing = RigidInertia {
        mass: 0.0,
        com: Vector3::zeros(),
        about_com: Matrix3::zeros(),
    };
    let (middle, end) = (arm.linkage.link("middle", nothing), arm.linkage.link("end", rod()));
    let elbow = Mount::at(arm.lower, [0.5, 0.0, 0.0]);
    arm.linkage
        .joint("wrist", Joint::revolute_z(), elbow, Mount::at_origin(middle));
    arm.linkage
        .joint("bolt", Joint::Fixed, Mount::at_origin(middle), Mount::at_origin(end));
    outcome(arm.linkage, &Start::default(), Dop853::default(), 0.1)
}

/// A rod on a hinge; gives the hinge.
pub(crate) fn pendulum(linkage: &mut Linkage) -> linkdyn_mechanisms::JointHandle {
    let link = linkage.link("rod", rod());
    linkage.joint(
        "hinge",
        Joint::revolute_z(),
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(link),
    )
}

pub(crate) fn stiff_spring(method: impl Method<Simulation>) -> String {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let hinge = pendulum(&mut linkage);
    if let Some(inertia) = linkage.inertia_mut("rod") {
        inertia.about_com *= 1e-6 / inertia.mass;
        inertia.mass = 1e-6;
    }
    linkage.springs(
        hinge,
        &[Spring {
            stiffness: 1e12,
            ..Spring::default()
        }],
    );
    outcome(linkage, &Start::default(), method, 0.01)
}

pub(crate) fn friction(coefficient: f64, reference_speed: f64) -> String {
    let mut arm = arm();
    let surface = |diameter: f64| Surface { diameter, coefficient };
    let bearing = JournalBearing {
        spacing: 0.03,
        surface_a: surface(0.01),
        surface_b: surface(0.01),
        face: surface(0.015),
    };
    arm.linkage.friction(
        arm.elbow,
        Exponential {
            reference_speed,
            steepness: 3.0,
        },
        bearing,
    );
    outcome(arm.linkage, &Start::default(), Radau5::default(), 0.1)
}

pub(crate) fn no_number() -> String {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let joint = pendulum(&mut linkage);
    let function = Arc::new(|t: f64, _: f64, _: f64| if t < 0.1 { 1.0 } else { f64::NAN });
    let stop_times = Vec::new();
    linkage.drive(joint, Drive::Custom { function, stop_times });
    outcome(linkage, &Start::default(), Dop853::default(), 1.0)
}

pub(crate) fn spinning() -> String {
    let mut linkage = Linkage::new([0.0; 3]);
    let about_com = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5));
    let body = linkage.link(
        "body",
        RigidInertia {
            mass: 1.0,
            com: Vector3::zeros(),
            about_com,
        },
    );
    linkage.joint(
        "ball",
        Joint::Spherical,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(body),
    );
    let mechanism = linkage.build().expect("valid");
    let names: Vec<String> = mechanism.coordinate_names().map(str::to_owned).collect();
    let start = Start {
        speeds: vec![(names[1].clone(), 1e4), (names[2].clone(), 1.0)],
        ..Start::default()
    };
    let (mut length, mut first, mut energy) = (0.0_f64, None, 0.0_f64);
    let outcome = watched(linkage, &start, Dop853::default(), (0.01, 1e-4), |o| {
        length = length.max((o.q.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0).abs());
        let now = o.energy.total();
        energy = energy.max((now / *first.get_or_insert(now) - 1.0).abs());
    });
    assert!(
        length < 1e-12 && energy < 1e-6,
        "quaternion {length:e}, energy {energy:e}"
    );
    outcome
}

pub(crate) fn parallelogram() -> FourBar {
    FourBar {
        lengths: [0.1, 0.3, 0.1, 0.3],
        plane: Pose::identity(),
        closing: Joint::Spherical,
    }
}

/// Passes the flat position twice, and stays a parallelogram: of the two branches there the smooth one.
pub(crate) fn change_point() -> String {
    let turned = 0.5;
    let start = Start {
        positions: [("crank", turned), ("coupler", -turned), ("rocker", turned)]
            .map(|(n, x)| (n.to_owned(), x))
            .into(),
        held: vec!["crank".to_owned()],
        speeds: vec![("crank".to_owned(), -20.0)],
    };
    let mut apart = 0.0_f64;
    let mut turns = 0.0_f64;
    let outcome = watched(
        parallelogram().linkage(),
        &start,
        Dop853::default(),
        (0.6, 0.003),
        |o| {
            apart = apart.max((o.q[0] - o.q[2]).abs());
            turns = turns.max((o.q[0] - turned).abs());
        },
    );
    if outcome == "done" {
        assert!(
            apart < 1e-6 && turns > 6.5,
            "crank and rocker {apart:e} apart after {turns} rad"
        );
    }
    outcome
}

/// `count` links on hinges; link i hangs on link `parent(i)`, counted from 1, or on the ground.
pub(crate) fn tree(count: usize, parent: fn(usize) -> usize) -> String {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let mut links = Vec::new();
    for i in 0..count {
        let link = linkage.link(&format!("link {i}"), rod());
        links.push(link);
        let predecessor = match parent(i) {
            0 => Mount::at_origin(Linkage::GROUND),
            k => Mount::at(links[k - 1], [0.5, 0.0, 0.0]),
        };
        linkage.joint(
            &format!("joint {i}"),
            Joint::revolute_z(),
            predecessor,
            Mount::at_origin(link),
        );
    }
    rows(linkage, &Start::default(), Rk4::new(1e-3), (1e-3, 1e-3))
}

/// Upright the weight has no lever; half a turn has the rounding of π, which grows by e each 0.18 s.
pub(crate) fn upside_down() -> String {
    let mut linkage = Linkage::new([-9.81, 0.0, 0.0]);
    pendulum(&mut linkage);
    let start = Start::default();
    let start = Start {
        positions: vec![("hinge".to_owned(), std::f64::consts::PI)],
        held: vec!["hinge".to_owned()],
        ..start
    };
    let mut tilt = 0.0_f64;
    let outcome = watched(linkage, &start, Dop853::default(), (2.0, 0.1), |o| {
        tilt = tilt.max((o.q[0] - std::f64::consts::PI).abs());
    });
    assert!(tilt < 1e-9, "it has fallen by {tilt:e} rad");
    outcome
}

/// Drift of energy at most in proportion to time, over two decades.
pub(crate) fn many_steps() -> String {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    pendulum(&mut linkage);
    let (mut first, mut drift) = (None, [0.0_f64; 2]);
    let outcome = watched(linkage, &Start::default(), Rk4::new(1e-3), (19.9, 0.1), |o| {
        let off = (o.energy.total() - *first.get_or_insert(o.energy.total())).abs();
        drift[1] = drift[1].max(off);
        if o.t < 2.0 {
            drift[0] = drift[0].max(off);
        }
    });
    assert!(drift[0] > 0.0 && drift[1] < 15.0 * drift[0], "{drift:?} J");
    outcome
}

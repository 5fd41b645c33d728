//! Joints with clearance at the start of a run: journals that already touch, wedge or lie across their bearing; rows at events.

use linkdyn_contact::{Damping, Fit, ForcePoint, NormalLaw, RestitutionLaw};
use linkdyn_dynamics::RigidInertia;
use linkdyn_integrators::{Dop853, Integration, Rk4};
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::{
    BuildError, Clearance, ClearanceModel, ContactEvent, Linkage, Mechanism, Mount, Observation, RunError, Seen, Side,
    Simulation, State, Switching, run_watched,
};
use nalgebra::{Matrix3, Vector3};
use std::ops::ControlFlow;

const CLEARANCE: f64 = 1e-3;

fn inertia() -> RigidInertia {
    RigidInertia {
        mass: 0.5,
        com: Vector3::zeros(),
        about_com: Matrix3::from_diagonal_element(1e-4),
    }
}

fn clearance(model: ClearanceModel) -> Clearance {
    let damping = Damping::Restitution {
        law: RestitutionLaw::LankaraniNikravesh,
        restitution: 0.9,
    };
    Clearance {
        fit: Fit::new(5e-3, 5e-3 - CLEARANCE).expect("a fit"),
        bearing: Side::Predecessor,
        model,
        law: NormalLaw::new(1e9, 1.5, damping).expect("a law").into(),
        friction: None,
        bristle_start: Default::default(),
        force_point: ForcePoint::Common,
    }
}

/// A pin that slides along x and y in a hole of the ground.
fn pin() -> Mechanism {
    let mut linkage = Linkage::new([0.0; 3]);
    let (carriage, pin) = (linkage.link("carriage", inertia()), linkage.link("pin", inertia()));
    let slide = |axis| Joint::Prismatic { axis };
    linkage.joint(
        "x",
        slide(Vector3::x_axis()),
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(carriage),
    );
    linkage.joint(
        "y",
        slide(Vector3::y_axis()),
        Mount::at_origin(carriage),
        Mount::at_origin(pin),
    );
    let hole = linkage.cut(
        "R",
        Joint::revolute_z(),
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(pin),
    );
    linkage.clearance(hole, clearance(ClearanceModel::Planar));
    linkage.build().expect("it builds")
}

type Events = Vec<(f64, ContactEvent)>;

fn run(q: [f64; 2], v: [f64; 2], until: f64, every: f64, switching: Switching) -> (Vec<Observation>, Events) {
    let mechanism = pin();
    let mut simulation = Simulation::new(&mechanism);
    simulation.set_switching(switching);
    let y = simulation.state_vector(&State {
        q: q.into(),
        v: v.into(),
    });
    let settings = simulation.settings(1e-11, 1e-11);
    let (mut rows, mut events) = (Vec::new(), Vec::new());
    let watch = |seen: Seen<'_>| {
        match seen {
            Seen::Row(o) => rows.push(o.clone()),
            Seen::Contact { t, event } => events.push((t, event)),
            Seen::Step { .. } => {}
        }
        ControlFlow::Continue(())
    };
    let ended = if switching == Switching::AtSteps {
        let mut integration = Integration::new(simulation, Rk4::new(1e-6), 0.0, &y, settings).expect("valid");
        run_watched(&mut integration, until, every, watch)
    } else {
        let mut integration = Integration::new(simulation, Dop853::default(), 0.0, &y, settings).expect("valid");
        run_watched(&mut integration, until, every, watch)
    };
    ended.expect("runs to the end");
    (rows, events)
}

#[test]
fn a_journal_that_starts_in_its_bearing_is_pushed_out_at_once() {
    for switching in [Switching::Located, Switching::AtSteps] {
        // Deeper than the clearance, and a little.
        for depth in [2.0 * CLEARANCE, 1e-6] {
            let (rows, events) = run([0.0, CLEARANCE + depth], [0.0; 2], 1e-3, 1e-5, switching);
            assert_eq!((events[0].0, events[0].1.made), (0.0, true), "{switching:?} {depth}");
            let first = &rows[0];
            assert!((first.contacts[0].depth - depth).abs() < 1e-15 && first.contacts[0].normal > 0.0);
            let across = first.a[0].abs() < 1e-12 * first.a[1].abs();
            assert!(first.a[1] < 0.0 && across, "pressed in +y, pushed to -y: {:?}", first.a);
            // The law damps a contact that begins at rest as one at its least impact speed: the journal comes out slowly.
            let depths = || rows.iter().map(|o| o.contacts[0].depth);
            assert!(depths().is_sorted_by(|a, b| a > b), "{switching:?} {depth}");
            if switching == Switching::AtSteps {
                // Fixed steps do not resolve such a damper.
                continue;
            }
            let stored = first.energy.total();
            let drift = rows
                .iter()
                .map(|o| (o.energy_balance() - stored).abs())
                .fold(0.0, f64::max);
            assert!(drift < 1e-6 * stored, "{depth}: {drift:e} of {stored:e} J");
        }
    }
}

#[test]
fn a_journal_at_the_rim_makes_contact_only_if_it_moves_outward() {
    for (speed, made) in [(0.1, true), (-0.1, false)] {
        let (rows, events) = run([CLEARANCE, 0.0], [speed, 0.0], 1e-4, 1e-5, Switching::Located);
        assert_eq!(events.first().is_some_and(|(t, event)| *t == 0.0 && event.made), made);
        assert_eq!(rows[0].contacts[0].impact_speed, if made { speed } else { 0.0 });
        // Outward it never gets far.
        assert!(rows.iter().all(|o| o.q[0] < CLEARANCE + 1e-4));
        assert_eq!(rows[5].contacts[0].normal > 0.0, made);
    }
}

/// A row at the very time of an event shows the state after it, bristle and impact speed together.
#[test]
fn a_row_at_an_event_shows_the_state_after_it() {
    let (_, events) = run([0.0; 2], [0.1, 0.0], 0.02, 0.02, Switching::Located);
    let (made, event) = events[0];
    let (rows, _) = run([0.0; 2], [0.1, 0.0], 0.02, made, Switching::Located);
    let row = rows.iter().find(|o| o.t == made).expect("a row at the contact");
    assert_eq!(row.contacts[0].impact_speed, event.speed);
    assert!(row.contacts[0].depth.abs() < 1e-12);
    // At the end of a run rounding decides whether it still happens; the row agrees with that.
    for until in [made.next_down(), made, made.next_up()] {
        let (rows, again) = run([0.0; 2], [0.1, 0.0], until, 1.0, Switching::Located);
        let last = rows.last().expect("rows");
        assert_eq!(last.t, until);
        assert_eq!(last.contacts[0].impact_speed > 0.0, again.len() == 1);
    }
}

#[test]
fn a_journal_across_its_bearing_is_refused_by_name() {
    let mut linkage = Linkage::new([0.0; 3]);
    let pin = linkage.link("pin", inertia());
    let ground = Mount::at_origin(Linkage::GROUND);
    linkage.joint("ball", Joint::SphericalZyx, ground, Mount::at_origin(pin));
    let hole = linkage.cut("R", Joint::revolute_z(), ground, Mount::at_origin(pin));
    linkage.clearance(hole, clearance(ClearanceModel::Spatial { length: 0.02 }));
    let mechanism = linkage.build().expect("it builds");
    let simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&State {
        q: vec![0.0, 1.2, 0.0],
        v: vec![0.0; 3],
    });
    let settings = simulation.settings(1e-9, 1e-9);
    let mut integration = Integration::new(simulation, Dop853::default(), 0.0, &y, settings).expect("valid");
    let ended = linkdyn_mechanisms::run(&mut integration, 1.0, 0.1, |_| ControlFlow::Continue(()));
    let Err(RunError::Motion(error)) = ended else {
        panic!("{ended:?}")
    };
    let message = error.to_string();
    assert!(
        message.contains("joint `R`") && message.contains("inclined"),
        "{message}"
    );
}

#[test]
fn contact_points_have_names_of_their_own() {
    let mut linkage = Linkage::new([0.0; 3]);
    let pin = linkage.link("pin", inertia());
    let ground = Mount::at_origin(Linkage::GROUND);
    linkage.joint("ball", Joint::SphericalZyx, ground, Mount::at_origin(pin));
    let joints = [
        ("R", ClearanceModel::Spatial { length: 0.02 }),
        ("R1", ClearanceModel::Planar),
    ];
    for (name, model) in joints {
        let cut = linkage.cut(name, Joint::revolute_z(), ground, Mount::at_origin(pin));
        linkage.clearance(cut, clearance(model));
    }
    let error = linkage.build().expect_err("two contacts called R1");
    assert_eq!(error, BuildError::DuplicateName { name: "R1".into() });
}

/// Of a planar joint with clearance one equation is a force along the axis, two are torques.
#[test]
fn forces_of_loops_leave_out_torques() {
    let mechanism = pin();
    let forces: Vec<f64> = mechanism.loop_forces(&[-3.0, 40.0, 50.0]).collect();
    assert_eq!(forces, [3.0]);
}

//! Stops on joint coordinates, against the closed forms of their contact law.

use linkdyn_contact::{ContactLaw, Damping, KelvinVoigt, NormalLaw, NormalModel, RestitutionLaw};
use linkdyn_dynamics::RigidInertia;
use linkdyn_integrators::Dop853;
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::analysis::{AnalysisError, linearise};
use linkdyn_mechanisms::{BuildError, Limit, LimitError, Linkage, Mount, RunSettings, Scene, Start, State};
use linkdyn_tests::scenes::{Finished, Ready, prepare, simulate};
use nalgebra::{Matrix3, Vector3};

const MASS: f64 = 2.0;

pub(crate) fn law(restitution: f64) -> ContactLaw {
    let damping = Damping::Restitution {
        law: RestitutionLaw::Exact,
        restitution,
    };
    NormalLaw::new(1e8, 1.5, damping).expect("in range").into()
}

/// A mass on a vertical rail with stops.
fn rail(gravity: f64, limit: Limit, q: f64, v: f64) -> Result<Ready, BuildError> {
    let mut linkage = Linkage::new([0.0, 0.0, -gravity]);
    let mass = RigidInertia {
        mass: MASS,
        com: Vector3::zeros(),
        about_com: Matrix3::identity(),
    };
    let mass = linkage.link("mass", mass);
    let ground = Mount::at_origin(Linkage::GROUND);
    let rail = linkage.joint("rail", Joint::prismatic_z(), ground, Mount::at_origin(mass));
    linkage.limit(rail, limit);
    linkage.build()?;
    Ok(prepare(Scene {
        name: "rail".into(),
        summary: String::new(),
        linkage,
        start: Start {
            positions: vec![("rail".into(), q)],
            held: vec!["rail".into()],
            speeds: vec![("rail".into(), v)],
        },
        until: 1.0,
        reactions: false,
        crank: "rail".into(),
        output: None,
        settings: RunSettings::default(),
    }))
}

fn between(lower: Option<f64>, upper: Option<f64>, law: ContactLaw) -> Limit {
    Limit { lower, upper, law }
}

fn balance(run: &Finished) -> f64 {
    let start = run.rows[0].energy_balance();
    run.rows
        .iter()
        .fold(0.0, |worst, row| f64::max(worst, (row.energy_balance() - start).abs()))
}

#[test]
fn a_slider_bounces_between_its_stops_with_the_restitution_of_the_law() {
    for restitution in [1.0, 0.8, 0.5] {
        let law = law(restitution);
        let scene = rail(0.0, between(Some(-0.1), Some(0.2), law.clone()), 0.0, -1.5).expect("sound");
        let names: Vec<String> = scene.mechanism.contact_names().collect();
        assert_eq!(names, ["rail.lower", "rail.upper"]);
        let run = simulate(&scene, Dop853::default(), 1e-11, 0.8, 0.01);
        run.end.as_ref().expect("runs to its end");
        assert!(run.contacts.len() >= 4, "{:?}", run.contacts);
        let (mut speed, mut lost, mut side) = (1.5, [0.0; 2], 0);
        for pair in run.contacts.chunks_exact(2) {
            let ((t1, made), (t2, left)) = (pair[0], pair[1]);
            assert!(made.made && !left.made && t1 < t2);
            assert_eq!((made.point, left.point), (side, side));
            let delivered = law.delivered_restitution(MASS, speed);
            assert!((delivered - restitution).abs() < 1e-9);
            // Tolerance 1e-11 on coordinates is 1e-8 on speeds.
            assert!((made.speed - speed).abs() < 1e-7, "{} for {speed}", made.speed);
            assert!(
                (left.speed - delivered * speed).abs() < 1e-7,
                "{}",
                left.speed / made.speed
            );
            lost[side] += law.energy_loss(MASS, speed);
            (speed, side) = (left.speed, 1 - side);
        }
        let end = run.rows.last().expect("rows");
        let losses = [end.integrals[0], end.integrals[4]];
        if run.contacts.len() % 2 == 0 {
            for (found, right) in losses.into_iter().zip(lost) {
                assert!((found - right).abs() < 1e-6, "{found} J for {right} J");
            }
        }
        assert!(balance(&run) < 1e-6, "{}", balance(&run));
        let columns = run.simulation.columns(false);
        assert!(columns.iter().any(|column| column == "contact.rail.upper.impact_speed"));
    }
}

#[test]
fn the_greatest_depth_is_that_of_the_law() {
    let law = law(0.7);
    let scene = rail(0.0, between(None, Some(0.0), law.clone()), -0.01, 2.0).expect("sound");
    let run = simulate(&scene, Dop853::default(), 1e-11, 0.0075, 1e-6);
    let depth = run.rows.iter().map(|row| row.contacts[0].depth).fold(0.0, f64::max);
    let right = law.greatest_depth(MASS, 2.0);
    // Rows of 1 us are half of one off the top: 1/2 a (dt/2)^2 with a of some 2e4 m/s^2.
    assert!((depth - right).abs() < 1e-8, "{depth} for {right}");
}

#[test]
fn a_slider_comes_to_rest_at_the_depth_that_carries_it() {
    let law = ContactLaw::from(KelvinVoigt {
        stiffness: 1e5,
        damping: 400.0,
    });
    let scene = rail(9.81, between(Some(0.0), None, law), 0.05, 0.0).expect("sound");
    let run = simulate(&scene, Dop853::default(), 1e-9, 2.0, 0.01);
    run.end.as_ref().expect("runs to its end");
    let end = run.rows.last().expect("rows");
    assert!((end.q[0] + MASS * 9.81 / 1e5).abs() < 1e-8, "{}", end.q[0]);
    assert!((end.contacts[0].normal - MASS * 9.81).abs() < 1e-3);
    assert!(balance(&run) < 1e-6, "{}", balance(&run));
    // All of the fall is lost or stored in the stop.
    let lost = end.integrals[0] + end.energy.elastic;
    assert!((lost - MASS * 9.81 * (0.05 - end.q[0])).abs() < 1e-6, "{lost}");
}

#[test]
fn a_start_beyond_a_stop_begins_in_contact() {
    // Pressed in at rest it leaves with the energy that is stored.
    let law = ContactLaw::from(NormalLaw::new(1e8, 1.5, Damping::Hertz).expect("in range"));
    let depth = 1e-4;
    let scene = rail(0.0, between(Some(0.3), None, law.clone()), 0.3 - depth, 0.0).expect("sound");
    let run = simulate(&scene, Dop853::default(), 1e-12, 0.05, 0.01);
    assert!(run.contacts[0].0 == 0.0 && run.contacts[0].1.made);
    assert!((run.rows[0].energy.elastic - law.stored_energy(depth)).abs() < 1e-13);
    let speed = run.rows.last().expect("rows").v[0];
    let right = (2.0 * law.stored_energy(depth) / MASS).sqrt();
    assert!((speed - right).abs() < 1e-9, "{speed} for {right}");
}

#[test]
fn many_short_hops_become_a_contact_that_is_held() {
    // Without loss, hops of 1 mm/s never end; some 200 of 0.2 ms and a contact of 2 ms each fit into the time.
    let law = ContactLaw::from(NormalLaw::new(1e10, 1.5, Damping::Hertz).expect("in range"));
    let scene = rail(9.81, between(Some(0.0), None, law), 0.0, -1e-3).expect("sound");
    let run = simulate(&scene, Dop853::default(), 1e-12, 0.5, 0.1);
    run.end.as_ref().expect("runs to its end");
    let made: Vec<_> = run.contacts.iter().filter(|(_, event)| event.made).collect();
    assert_eq!(made.iter().filter(|(_, event)| event.held).count(), 1);
    assert!(made.len() < 40, "{} contacts made", made.len());
    // It goes on hopping all the same: the energy of a hop is 1e-6 J.
    assert!(balance(&run) < 1e-8, "{}", balance(&run));
}

#[test]
fn limits_that_make_no_sense_are_refused() {
    let refused = |lower, upper, law| match rail(0.0, between(lower, upper, law), 0.0, 0.0) {
        Err(BuildError::Limit { joint, source }) => {
            assert_eq!(joint, "rail");
            source
        }
        other => panic!("{:?}", other.err()),
    };
    assert_eq!(refused(None, None, law(0.5)), LimitError::NoStop);
    for (lower, upper) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
        assert!(matches!(
            refused(Some(lower), Some(upper), law(0.5)),
            LimitError::Stops { .. }
        ));
    }
    let soft = KelvinVoigt {
        stiffness: 0.0,
        damping: 1.0,
    };
    assert!(matches!(refused(Some(0.0), None, soft.into()), LimitError::Law(_)));

    let mut linkage = Linkage::new([0.0; 3]);
    let link = linkage.link("link", RigidInertia::massless());
    let ground = Mount::at_origin(Linkage::GROUND);
    let ball = linkage.joint("ball", Joint::SphericalZyx, ground, Mount::at_origin(link));
    linkage.limit(ball, between(Some(0.0), None, law(0.5)));
    assert!(matches!(linkage.build(), Err(BuildError::NotOneCoordinate { .. })));
}

#[test]
fn analyses_name_the_joint_whose_limit_they_cannot_take() {
    let scene = rail(0.0, between(Some(0.0), None, law(0.5)), 0.1, 0.0).expect("sound");
    let at = State {
        q: vec![0.1],
        v: vec![0.0],
    };
    match linearise(&scene.mechanism, 0.0, &at) {
        Err(AnalysisError::Internals { what }) => assert_eq!(what, "joint `rail` has a limit"),
        other => panic!("{other:?}"),
    }
}

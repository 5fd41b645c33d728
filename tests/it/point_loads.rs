//! Forces on points, moments on links and struts between points, against closed forms and against the same loads on joints.

use linkdyn_dynamics::RigidInertia;
use linkdyn_integrators::Dop853;
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::analysis::linearise;
use linkdyn_mechanisms::{
    Axes, BuildError, Drive, JointHandle, LinkHandle, Linkage, Mount, Observation, PointLoad, RunError, RunSettings,
    Scene, Spring, Start, Strut,
};
use linkdyn_tests::scenes::{distance, prepare, simulate};
use nalgebra::{Matrix3, Vector3};

const MASS: f64 = 2.0;

fn body(mass: f64, com: [f64; 3], inertia: f64) -> RigidInertia {
    RigidInertia {
        mass,
        com: Vector3::from(com),
        about_com: Matrix3::identity() * inertia,
    }
}

fn ground() -> Mount {
    Mount::at_origin(Linkage::GROUND)
}

/// A linkage with one link on one joint, which has the coordinate `name`.
fn single(gravity: f64, joint: Joint, inertia: RigidInertia) -> (Linkage, LinkHandle, JointHandle) {
    let mut linkage = Linkage::new([0.0, 0.0, -gravity]);
    let link = linkage.link("link", inertia);
    let joint = linkage.joint("q", joint, ground(), Mount::at_origin(link));
    (linkage, link, joint)
}

/// All rows of a run from coordinates and speeds by name.
fn rows(linkage: &Linkage, positions: &[(&str, f64)], speeds: &[(&str, f64)], until: f64) -> Vec<Observation> {
    let named = |list: &[(&str, f64)]| list.iter().map(|(name, value)| (name.to_string(), *value)).collect();
    let scene = prepare(Scene {
        name: "single".into(),
        summary: String::new(),
        linkage: linkage.clone(),
        start: Start {
            positions: named(positions),
            held: Vec::new(),
            speeds: named(speeds),
        },
        until,
        reactions: false,
        crank: String::new(),
        output: None,
        settings: RunSettings::default(),
    });
    let run = simulate(&scene, Dop853::default(), 1e-12, until, 0.05 * until);
    run.end.expect("runs to its end");
    for row in &run.rows {
        near(row.energy_balance(), run.rows[0].energy_balance());
    }
    run.rows
}

fn near(found: f64, right: f64) {
    assert!(
        (found - right).abs() < 1e-9 * right.abs().max(1.0),
        "{found} for {right}"
    );
}

#[test]
fn a_falling_body_with_drag_comes_to_its_terminal_speed() {
    let (mut linkage, link, _) = single(9.81, Joint::prismatic_z(), body(MASS, [0.0; 3], 1.0));
    let terminal = 3.0;
    let drag = Drive::QuadraticResistance {
        torque: MASS * 9.81,
        reference_speed: terminal,
    };
    linkage.force(
        "drag",
        PointLoad {
            at: Mount::at(link, [0.3, 0.0, 0.0]),
            direction: [0.0, 0.0, -2.0],
            axes: Axes::Ground,
            drives: vec![drag],
        },
    );
    for row in rows(&linkage, &[], &[], 3.0) {
        let share = 9.81 * row.t / terminal;
        near(row.v[0], -terminal * share.tanh());
        near(row.q[0], -terminal * terminal / 9.81 * share.cosh().ln());
    }
}

#[test]
fn a_force_that_turns_with_its_link_does_more_work_than_one_that_does_not() {
    let (length, force) = (0.5, 3.0);
    let about_pivot = 0.02 + MASS * 0.25 * 0.25;
    for axes in [Axes::Ground, Axes::Mount] {
        let (mut linkage, link, _) = single(0.0, Joint::revolute_z(), body(MASS, [0.25, 0.0, 0.0], 0.02));
        linkage.force(
            "push",
            PointLoad {
                at: Mount::at(link, [length, 0.0, 0.0]),
                direction: [0.0, 1.0, 0.0],
                axes,
                drives: vec![Drive::Constant { torque: force }],
            },
        );
        for row in rows(&linkage, &[], &[], 0.5) {
            let (angle, kinetic) = (row.q[0], 0.5 * about_pivot * row.v[0] * row.v[0]);
            let work = match axes {
                Axes::Mount => force * length * angle,
                Axes::Ground => force * length * angle.sin(),
            };
            near(kinetic, work);
            near(row.work, work);
        }
    }
}

#[test]
fn a_force_through_the_centre_of_a_free_body_does_not_turn_it_and_one_beside_it_does() {
    let centre = [0.1, -0.2, 0.3];
    for beside in [0.0, 0.05] {
        let (mut linkage, link, _) = single(0.0, Joint::Free, body(MASS, centre, 0.01));
        linkage.force(
            "push",
            PointLoad {
                at: Mount::at(link, [centre[0], centre[1] + beside, centre[2]]),
                direction: [1.0, 0.0, 0.0],
                axes: Axes::Mount,
                drives: vec![Drive::Constant { torque: 4.0 }],
            },
        );
        let row = rows(&linkage, &[], &[], 0.3).pop().expect("rows");
        // About z by -beside times the force; free joints have their speeds in order: slides, then turns.
        near(row.v[5], -beside * 4.0 / 0.01 * 0.3);
        if beside == 0.0 {
            near(row.v[0], 4.0 / MASS * 0.3);
            near(row.q[0], 0.5 * 4.0 / MASS * 0.09);
        }
    }
}

#[test]
fn a_moment_is_the_torque_of_a_drive_on_the_same_axis() {
    let drives = vec![
        Drive::Harmonic {
            amplitude: 2.0,
            frequency: 1.5,
            phase: 0.3,
        },
        Drive::Resistance {
            torque: 0.4,
            reference_speed: 2.0,
        },
        Drive::Ramp {
            torque: 1.0,
            rise_time: 0.31,
        },
    ];
    let about_y = Joint::Revolute {
        axis: Vector3::y_axis(),
    };
    let inertia = body(MASS, [0.25, 0.0, 0.0], 0.02);
    let (mut by_drive, _, joint) = single(9.81, about_y, inertia);
    for drive in &drives {
        by_drive.drive(joint, drive.clone());
    }
    let by_drive = rows(&by_drive, &[("q", 0.2)], &[("q", 1.0)], 1.0);
    for axes in [Axes::Ground, Axes::Mount] {
        let (mut by_moment, link, _) = single(9.81, about_y, inertia);
        by_moment.moment(
            "motor",
            PointLoad {
                at: Mount::at(link, [7.0, 8.0, 9.0]),
                direction: [0.0, 3.0, 0.0],
                axes,
                drives: drives.clone(),
            },
        );
        let by_moment = rows(&by_moment, &[("q", 0.2)], &[("q", 1.0)], 1.0);
        for (one, two) in by_drive.iter().zip(&by_moment) {
            assert!(distance(&one.q, &two.q) < 1e-10 && distance(&one.v, &two.v) < 1e-10);
            near(one.work, two.work);
        }
    }
}

fn strut(from: Mount, to: Mount, (free_length, stiffness, damping): (f64, f64, f64)) -> Strut {
    Strut {
        from,
        to,
        free_length,
        stiffness,
        damping,
    }
}

#[test]
fn a_mass_on_a_strut_swings_as_on_a_spring_in_its_joint() {
    let (stiffness, free_length) = (200.0, 0.4);
    for damping in [0.0, 1.5] {
        let (mut by_strut, link, _) = single(9.81, Joint::prismatic_z(), body(MASS, [0.0; 3], 1.0));
        // The ends stand one above the other whatever the arms: 0.1 m higher on the ground, 0.3 m on the mass.
        let from = Mount::at(Linkage::GROUND, [0.5, 0.2, 0.1]);
        let to = Mount::at(link, [0.5, 0.2, 0.3]);
        by_strut.strut("strut", strut(from, to, (free_length, stiffness, damping)));
        let (mut by_spring, _, joint) = single(9.81, Joint::prismatic_z(), body(MASS, [0.0; 3], 1.0));
        let spring = Spring {
            stiffness,
            damping,
            rest: free_length - 0.2,
        };
        by_spring.springs(joint, &[spring]);
        let (start, until) = ([("q", 0.3)], 2.0);
        let one = rows(&by_strut, &start, &[], until);
        let two = rows(&by_spring, &start, &[], until);
        let (w, middle) = ((stiffness / MASS).sqrt(), 0.2 - MASS * 9.81 / stiffness);
        for (one, two) in one.iter().zip(&two) {
            assert!(distance(&one.q, &two.q) < 1e-10 && distance(&one.v, &two.v) < 1e-10);
            near(one.energy.elastic, two.energy.elastic);
            if damping == 0.0 {
                near(one.q[0], middle + (0.3 - middle) * (w * one.t).cos());
            }
        }
        let mechanism = by_strut.build().expect("sound");
        let at = linkdyn_mechanisms::State {
            q: vec![middle],
            v: vec![0.0],
        };
        let small = linearise(&mechanism, 0.0, &at).expect("at rest");
        // By differences.
        assert!((small.stiffness[(0, 0)] - stiffness).abs() < 1e-6 && (small.damping[(0, 0)] - damping).abs() < 1e-6);
    }
}

#[test]
fn two_masses_on_a_strut_swing_with_their_reduced_mass() {
    let mut linkage = Linkage::new([0.0; 3]);
    let masses = [1.0, 3.0];
    let [a, b] = ["a", "b"].map(|name| linkage.link(name, RigidInertia::massless()));
    for (name, mass, link) in [("a", masses[0], a), ("b", masses[1], b)] {
        *linkage.inertia_mut(name).expect("there") = body(mass, [0.0; 3], 1.0);
        linkage.joint(name, Joint::prismatic_z(), ground(), Mount::at_origin(link));
    }
    let (stiffness, free_length) = (30.0, 0.5);
    linkage.strut(
        "strut",
        strut(Mount::at_origin(a), Mount::at_origin(b), (free_length, stiffness, 0.0)),
    );
    let w = (stiffness * (1.0 / masses[0] + 1.0 / masses[1])).sqrt();
    for row in rows(&linkage, &[("b", 0.6)], &[("a", 0.7)], 2.0) {
        let apart = 0.1 * (w * row.t).cos() - 0.7 / w * (w * row.t).sin();
        near(row.q[1] - row.q[0], free_length + apart);
        near(masses[0] * row.v[0] + masses[1] * row.v[1], 0.7);
    }
}

#[test]
fn a_strut_without_length_draws_ellipses_and_passes_its_middle() {
    let stiffness = 8.0;
    for damping in [0.0, 2.0] {
        let (mut linkage, link, _) = single(0.0, Joint::Free, body(MASS, [0.0; 3], 1.0));
        linkage.strut(
            "strut",
            strut(ground(), Mount::at_origin(link), (0.0, stiffness, damping)),
        );
        let names: Vec<String> = linkage
            .build()
            .expect("sound")
            .coordinate_names()
            .map(str::to_owned)
            .collect();
        let w = f64::sqrt(stiffness / MASS);
        if damping == 0.0 {
            for row in rows(&linkage, &[(&names[0], 0.3)], &[(&names[1], 1.1)], 2.0) {
                near(row.q[0], 0.3 * (w * row.t).cos());
                near(row.q[1], 1.1 / w * (w * row.t).sin());
            }
        } else {
            // Through the middle, where it starts: the damper stays that of the line.
            let (decay, w) = (
                0.5 * damping / MASS,
                (w * w - f64::powi(0.5 * damping / MASS, 2)).sqrt(),
            );
            // By names too: a free joint has a coordinate more than speeds behind its slides.
            for row in rows(&linkage, &[], &[(&names[1], 1.1)], 2.0) {
                near(row.q[1], 1.1 / w * (-decay * row.t).exp() * (w * row.t).sin());
            }
        }
    }
}

#[test]
fn a_strut_whose_ends_meet_is_refused_by_name() {
    let (mut linkage, link, _) = single(0.0, Joint::prismatic_z(), body(MASS, [0.0; 3], 1.0));
    linkage.strut("gas spring", strut(ground(), Mount::at_origin(link), (0.2, 1.0, 0.0)));
    let scene = |place: f64| {
        prepare(Scene {
            name: "meets".into(),
            summary: String::new(),
            linkage: linkage.clone(),
            start: Start {
                positions: vec![("q".into(), place)],
                ..Start::default()
            },
            until: 1.0,
            reactions: false,
            crank: "q".into(),
            output: None,
            settings: RunSettings::default(),
        })
    };
    match simulate(&scene(0.0), Dop853::default(), 1e-9, 1.0, 0.1).end {
        Err(error @ (RunError::Motion(_) | RunError::Integration(_))) => {
            let told = format!(
                "{error}: {:?}",
                std::error::Error::source(&error).map(ToString::to_string)
            );
            assert!(told.contains("the ends of strut `gas spring` meet"), "{told}");
        }
        other => panic!("{other:?}"),
    }
    assert!(simulate(&scene(0.1), Dop853::default(), 1e-9, 0.1, 0.1).end.is_ok());
}

#[test]
fn loads_that_make_no_sense_are_refused_by_name() {
    let refused = |change: &dyn Fn(&mut Linkage, LinkHandle)| {
        let (mut linkage, link, _) = single(0.0, Joint::prismatic_z(), body(MASS, [0.0; 3], 1.0));
        change(&mut linkage, link);
        linkage.build().err()
    };
    let push = |link, direction, torque| PointLoad {
        at: Mount::at_origin(link),
        direction,
        axes: Axes::Ground,
        drives: vec![Drive::Constant { torque }],
    };
    let told = |error: Option<BuildError>| match error {
        Some(BuildError::Load {
            what, name, parameter, ..
        }) => (what, name, parameter),
        other => panic!("{other:?}"),
    };
    for direction in [[0.0; 3], [f64::NAN, 0.0, 0.0], [f64::INFINITY, 0.0, 0.0]] {
        let error = refused(&|linkage, link| {
            linkage.moment("m", push(link, direction, 1.0));
        });
        assert_eq!(told(error), ("moment", "m".into(), "length of the direction"));
    }
    let error = refused(&|linkage, link| {
        linkage.force("f", push(link, [1.0, 0.0, 0.0], f64::NAN));
    });
    assert_eq!(told(error), ("force", "f".into(), "torque"));
    for (numbers, parameter) in [
        ((-1.0, 1.0, 1.0), "free_length"),
        ((1.0, f64::NAN, 1.0), "stiffness"),
        ((1.0, 1.0, -1.0), "damping"),
    ] {
        let error = refused(&|linkage, link| {
            linkage.strut("s", strut(ground(), Mount::at_origin(link), numbers));
        });
        assert_eq!(told(error), ("strut", "s".into(), parameter));
    }
    let error = refused(&|linkage, link| {
        let end = Mount::at(link, [f64::NAN, 0.0, 0.0]);
        linkage.strut("s", strut(ground(), end, (1.0, 1.0, 1.0)));
    });
    assert_eq!(told(error), ("strut", "s".into(), "error of its frame"));
    let error = refused(&|linkage, link| {
        let ends = (Mount::at_origin(link), Mount::at(link, [1.0, 0.0, 0.0]));
        linkage.strut("s", strut(ends.0, ends.1, (1.0, 1.0, 1.0)));
    });
    assert!(matches!(error, Some(BuildError::SelfStrut { .. })), "{error:?}");
    let error = refused(&|linkage, link| {
        linkage.force("f", push(link, [1.0, 0.0, 0.0], 1.0));
        linkage.strut("f", strut(ground(), Mount::at_origin(link), (1.0, 1.0, 1.0)));
    });
    assert!(matches!(error, Some(BuildError::DuplicateName { .. })), "{error:?}");
    let foreign = Linkage::new([0.0; 3]).link("other", RigidInertia::massless());
    let error = refused(&|_, _| ());
    assert_eq!(error, None);
    let mut empty = Linkage::new([0.0; 3]);
    empty.force("f", push(foreign, [1.0, 0.0, 0.0], 1.0));
    assert!(matches!(empty.build(), Err(BuildError::Foreign { .. })));
}

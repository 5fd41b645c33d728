//! A body with an arm, on the ground by each kind of joint, moves as the same body that is free but for the joint's cut form.

use linkdyn_kinematics::{Attachment, Closure, Joint, LinkId, Pose, Positions, Row, Tree};
use linkdyn_mechanisms::dynamics::RigidInertia;
use linkdyn_mechanisms::integrators::{Dop853, Integration, Settings};
use linkdyn_mechanisms::{BuildError, Drive, Linkage, Mechanism, Mount, Simulation, Start, run};
use linkdyn_tests::strategies;
use nalgebra::{DMatrix, Matrix3, Unit, UnitQuaternion, Vector3};
use proptest::prelude::*;
use std::ops::ControlFlow;

/// Pose of the arm after one second.
fn after_a_second(mechanism: &Mechanism) -> Pose {
    let (state, _) = mechanism.assemble(&Start::default()).expect("closed at the start");
    let simulation = Simulation::new(mechanism);
    let y = simulation.state_vector(&state);
    let settings = Settings::tolerances(1e-12, 1e-12);
    let mut steps = Integration::new(simulation, Dop853::default(), 0.0, &y, settings).expect("a sound problem");
    let mut q = Vec::new();
    run(&mut steps, 1.0, 1.0, |now| {
        q.clone_from(&now.q);
        ControlFlow::Continue(())
    })
    .expect("runs to the end");
    let tree = mechanism.system().tree();
    let mut positions = Positions::new(tree);
    tree.positions(&q, &mut positions);
    let link = mechanism.attachment("arm").expect("it is there");
    let pose = positions.pose(link.link);
    Pose {
        rotation: pose.rotation * link.pose.rotation,
        origin: pose.origin + pose.rotation * link.pose.origin,
    }
}

fn own_inertia() -> RigidInertia {
    RigidInertia {
        mass: 2.0,
        com: Vector3::new(0.1, -0.05, 0.08),
        about_com: Matrix3::from_diagonal(&Vector3::new(0.03, 0.04, 0.05)),
    }
}

/// One joint of each kind.
fn kinds() -> Vec<Joint> {
    let axis = Unit::new_normalize(Vector3::new(0.3, -0.4, 0.8));
    let across = Unit::new_normalize(axis.cross(&Vector3::x()));
    let skew = Unit::new_normalize(Vector3::new(0.9, 0.2, -0.3));
    vec![
        Joint::Fixed,
        Joint::Revolute { axis },
        Joint::Prismatic { axis },
        Joint::Screw { axis, pitch: -0.04 },
        Joint::Cylindrical { axis },
        Joint::Universal {
            first: axis,
            second: skew,
        },
        Joint::SphericalZyx,
        Joint::Spherical,
        Joint::Planar {
            along: across,
            normal: axis,
        },
        Joint::Free,
    ]
}

/// How a joint stands in the linkage.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Carried,
    Cut,
    /// Described from the body's side, so that the body is carried backwards.
    CarriedBackwards,
    /// Cut, and described from the body's side.
    CutBackwards,
}

#[test]
fn every_joint_moves_as_its_cut_form() {
    let axis = Unit::new_normalize(Vector3::new(0.3, -0.4, 0.8));
    let across = Unit::new_normalize(axis.cross(&Vector3::x()));
    let skew = Unit::new_normalize(Vector3::new(0.9, 0.2, -0.3));
    for kind in kinds() {
        // From the other side the axes of a universal joint change places.
        let turned = match kind {
            Joint::Universal { first, second } => Joint::Universal {
                first: second,
                second: first,
            },
            other => other,
        };
        let mechanism = |form: Form| {
            let mut m = Linkage::new([2.0, -3.0, 1.0]);
            let body = m.link("body", own_inertia());
            let base = Pose {
                origin: Vector3::new(0.2, 0.1, -0.3),
                ..Pose::turn(skew, 0.4)
            };
            let on_ground = Mount::with_pose(Linkage::GROUND, base);
            let on_body = Mount::at_origin(body);
            if matches!(form, Form::Cut | Form::CutBackwards) {
                m.joint("free", Joint::Free, on_ground, on_body);
            }
            match form {
                Form::Carried => drop(m.joint("joint", kind, on_ground, on_body)),
                Form::CarriedBackwards => drop(m.joint("joint", turned, on_body, on_ground)),
                Form::Cut => drop(m.cut("joint", kind, on_ground, on_body)),
                Form::CutBackwards => drop(m.cut("joint", turned, on_body, on_ground)),
            }
            let arm = m.link("arm", own_inertia());
            let elbow = Mount::at(body, [0.3, 0.1, 0.0]);
            m.joint("elbow", Joint::Revolute { axis: across }, elbow, Mount::at_origin(arm));
            m.build()
        };
        let carried = after_a_second(&mechanism(Form::Carried).expect("sound"));
        for form in [Form::Cut, Form::CutBackwards, Form::CarriedBackwards] {
            let mechanism = match (mechanism(form), kind) {
                (Ok(mechanism), _) => mechanism,
                // These cannot be carried backwards.
                (
                    Err(BuildError::Disconnected { .. }),
                    Joint::SphericalZyx | Joint::Spherical | Joint::Planar { .. } | Joint::Free,
                ) if form == Form::CarriedBackwards => continue,
                (Err(error), _) => panic!("{kind:?}, {form:?}: {error}"),
            };
            let other = after_a_second(&mechanism);
            let gap = (carried.rotation - other.rotation)
                .amax()
                .max((carried.origin - other.origin).amax());
            assert!(gap < 1e-9, "{kind:?}, {form:?}: {gap:e}");
        }
    }
}

proptest! {
    #![proptest_config(strategies::cases(200))]

    /// What a joint lets happen and what its cut form holds are all there is, and do no work on one another.
    #[test]
    fn motions_and_wrenches_of_a_joint_are_orthogonal_and_make_six(
        joint in strategies::joint(), raw in strategies::raw(), base in strategies::pose(1.0),
    ) {
        let mut tree = Tree::new();
        let body = tree.attach(LinkId::GROUND, base, joint).expect("sound");
        let q = strategies::coordinates(&joint, &raw);
        let mut positions = Positions::new(&tree);
        tree.positions(&q, &mut positions);
        let motions = tree.frame_jacobian(&positions, body, &Vector3::zeros());

        let mut free = Tree::new();
        let loose = free.attach(LinkId::GROUND, Pose::identity(), Joint::Free).expect("sound");
        let on = |link, pose| Attachment { link, pose };
        let closure = Closure::new(&free, on(LinkId::GROUND, base), on(loose, Pose::identity()), &joint);
        let pose = positions.pose(body);
        let turn = UnitQuaternion::from_matrix(&pose.rotation);
        let mut place = pose.origin.as_slice().to_vec();
        place.extend([turn.w, turn.i, turn.j, turn.k]);
        let mut positions = Positions::new(&free);
        free.positions(&place, &mut positions);
        let mut residual = vec![0.0; closure.equations()];
        closure.residual(&positions, &mut residual);
        prop_assert!(residual.iter().all(|phi| phi.abs() < 1e-12), "{residual:?}");
        let size = closure.equations();
        let wrenches = (0..size).map(|k| {
            let unit: Vec<f64> = (0..size).map(|i| f64::from(u8::from(i == k))).collect();
            let (_, on_body) = closure.wrenches(&positions, &unit);
            on_body.torque.iter().chain(&on_body.force).copied().collect::<Vec<_>>()
        });
        let wrenches = DMatrix::from_vec(6, size, wrenches.flatten().collect());
        let power = motions.tr_mul(&wrenches);
        prop_assert!(power.iter().all(|power| power.abs() < 1e-12), "{power}");
        let rank = |m: &DMatrix<f64>| if m.is_empty() { 0 } else { m.rank(1e-9) };
        prop_assert_eq!(rank(&motions), joint.speeds());
        prop_assert_eq!(rank(&wrenches), 6 - joint.speeds());
    }
}

/// A nut of mass m and moment J on an upright screw of pitch p: `(J + m p^2) theta'' = -m g p`, whether it is carried or cut.
#[test]
fn a_nut_on_a_screw_falls_as_the_closed_form_says() {
    let text = |cut: &str| {
        format!(
            r#"
            format = 1
            [links.nut]
            box = {{ density = 8000, size = [0.1, 0.1, 0.05] }}
            [joints.thread]
            kind = "screw"
            lead = 0.2
            successor = {{ link = "nut" }}
            {cut}
            "#
        )
    };
    let free = "cut = true\n[joints.way]\nkind = \"cylindrical\"\nsuccessor = { link = \"nut\" }\ncoordinates = [\"z\", \"thread\"]";
    let (m, p): (f64, f64) = (8000.0 * 0.1 * 0.1 * 0.05, 0.2 / std::f64::consts::TAU);
    let moment = m * (0.1 * 0.1 + 0.1 * 0.1) / 12.0;
    let expected = -0.5 * m * 9.81 * p / (moment + m * p * p);
    for cut in ["", free] {
        let scene = linkdyn_mechanisms::file::scene("nut", &text(cut)).expect("sound");
        let ready = linkdyn_tests::scenes::prepare(scene);
        let last = ready.mechanism.coordinate_names().count() - 1;
        let run = linkdyn_tests::scenes::simulate(&ready, Dop853::default(), 1e-12, 1.0, 1.0);
        run.end.expect("runs");
        let turned = run.rows.last().expect("rows").q[last];
        // Five turns: whole turns of the cut screw do not count.
        assert!((turned - expected).abs() < 1e-9 * expected.abs(), "{turned} {expected}");
    }
}

/// A joint that has no name of its own, a slide with a turn about an axis across it: carried as a chain, cut by equations.
#[test]
fn a_joint_of_ones_own_moves_as_its_own_equations_say() {
    let (slide, turn) = (Vector3::x_axis(), Vector3::y_axis());
    let across = Vector3::z();
    let along = [turn.into_inner(), across].map(|axis| Row::Along { axis });
    let angles = [slide.into_inner(), across].map(|on_predecessor| Row::Angle {
        on_predecessor,
        on_successor: turn.into_inner(),
        cosine: 0.0,
    });
    let mechanism = |cut: bool| {
        let mut m = Linkage::new([2.0, -3.0, 1.0]);
        let body = m.link("body", own_inertia());
        let base = Pose::turn(Unit::new_normalize(Vector3::new(0.9, 0.2, -0.3)), 0.4);
        let (on_ground, on_body) = (Mount::with_pose(Linkage::GROUND, base), Mount::at_origin(body));
        let steps = [Joint::Prismatic { axis: slide }, Joint::Revolute { axis: turn }];
        if cut {
            m.joint("free", Joint::Free, on_ground, on_body);
            m.cut_rows("own", &[along, angles].concat(), on_ground, on_body);
        } else {
            let handles = m.chain("own", &steps, on_ground, on_body);
            m.drive(handles[0], Drive::Constant { torque: 0.0 });
        }
        let arm = m.link("arm", own_inertia());
        let elbow = Mount::at(body, [0.3, 0.1, 0.0]);
        m.joint("elbow", Joint::revolute_z(), elbow, Mount::at_origin(arm));
        m.build().expect("sound")
    };
    let carried = mechanism(false);
    let names: Vec<_> = carried.coordinate_names().collect();
    assert_eq!(names, ["own.1", "own.2", "elbow"]);
    let (carried, cut) = (after_a_second(&carried), after_a_second(&mechanism(true)));
    let gap = (carried.rotation - cut.rotation)
        .amax()
        .max((carried.origin - cut.origin).amax());
    assert!(gap < 1e-9, "{gap:e}");
}

#[test]
fn chains_and_equations_that_make_no_joint_are_refused() {
    let refusal = |change: fn(&mut Linkage, Mount, Mount)| {
        let mut m = Linkage::new([0.0; 3]);
        let body = m.link("body", own_inertia());
        change(&mut m, Mount::at_origin(Linkage::GROUND), Mount::at_origin(body));
        m.build().expect_err("no joint").to_string()
    };
    let error = refusal(|m, ground, body| {
        m.chain("own", &[], ground, body);
    });
    assert!(error.contains("`body`"), "{error}");
    let error = refusal(|m, ground, body| {
        m.joint("free", Joint::Free, ground, body);
        m.cut_rows(
            "loop",
            &[Row::Along {
                axis: Vector3::new(0.0, 0.0, 2.0),
            }],
            ground,
            body,
        );
    });
    assert!(error.contains("`loop`") && error.contains("unit"), "{error}");
}

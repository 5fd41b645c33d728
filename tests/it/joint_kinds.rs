//! A body with an arm, on the ground by each kind of joint, moves as the same body that is free but for the joint's cut form.

use linkdyn_kinematics::{Joint, Pose, Positions};
use linkdyn_mechanisms::dynamics::RigidInertia;
use linkdyn_mechanisms::integrators::{Dop853, Integration, Settings};
use linkdyn_mechanisms::{Linkage, Mechanism, Mount, Simulation, Start, run};
use nalgebra::{Matrix3, Unit, Vector3};
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

#[test]
fn every_joint_moves_as_its_cut_form() {
    let axis = Unit::new_normalize(Vector3::new(0.3, -0.4, 0.8));
    let across = Unit::new_normalize(axis.cross(&Vector3::x()));
    let skew = Unit::new_normalize(Vector3::new(0.9, 0.2, -0.3));
    let kinds = [
        Joint::Fixed,
        Joint::Revolute { axis },
        Joint::Prismatic { axis },
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
    ];
    for kind in kinds {
        let mechanism = |cut: bool| {
            let mut m = Linkage::new([2.0, -3.0, 1.0]);
            let body = m.link("body", own_inertia());
            let base = Pose {
                origin: Vector3::new(0.2, 0.1, -0.3),
                ..Pose::turn(skew, 0.4)
            };
            let on_ground = Mount::with_pose(Linkage::GROUND, base);
            if cut {
                m.joint("free", Joint::Free, on_ground, Mount::at_origin(body));
                m.cut("joint", kind, on_ground, Mount::at_origin(body));
            } else {
                m.joint("joint", kind, on_ground, Mount::at_origin(body));
            }
            let arm = m.link("arm", own_inertia());
            let elbow = Mount::at(body, [0.3, 0.1, 0.0]);
            m.joint("elbow", Joint::Revolute { axis: across }, elbow, Mount::at_origin(arm));
            m.build().expect("sound")
        };
        let (carried, cut) = (after_a_second(&mechanism(false)), after_a_second(&mechanism(true)));
        let gap = (carried.rotation - cut.rotation)
            .amax()
            .max((carried.origin - cut.origin).amax());
        assert!(gap < 1e-9, "{kind:?}: {gap:e}");
    }
}

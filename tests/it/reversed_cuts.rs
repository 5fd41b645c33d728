//! A cut joint that could be put together the wrong way round is refused by name, and found the right way round where the guess is near.

use linkdyn_dynamics::RigidInertia;
use linkdyn_kinematics::{Joint, Row};
use linkdyn_mechanisms::analysis::branches;
use linkdyn_mechanisms::analysis::branches::Search;
use linkdyn_mechanisms::{Linkage, Mechanism, Mount, Start, StartError};
use nalgebra::{UnitQuaternion, Vector3};

fn body(cut: impl FnOnce(&mut Linkage, Mount, Mount)) -> Mechanism {
    let mut m = Linkage::new([0.0, 0.0, -9.81]);
    let body = m.link("body", RigidInertia::solid_cylinder(7850.0, 0.1, 0.3, &Vector3::x()));
    let (ground, own) = (Mount::at_origin(Linkage::GROUND), Mount::at_origin(body));
    m.joint("free", Joint::Free, ground, own);
    cut(&mut m, ground, own);
    m.build().expect("sound")
}

/// A start with the body turned about x.
fn turned(angle: f64) -> Start {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle);
    let parts = [
        ("free.qw", turn.w),
        ("free.qx", turn.i),
        ("free.qy", turn.j),
        ("free.qz", turn.k),
    ];
    Start {
        positions: parts.map(|(name, part)| (name.to_owned(), part)).into(),
        ..Start::default()
    }
}

#[test]
fn a_cut_joint_put_together_backwards_is_refused_by_name() {
    let (z, x) = (Vector3::z_axis(), Vector3::x_axis());
    let kinds = [
        Joint::Revolute { axis: z },
        Joint::Cylindrical { axis: z },
        Joint::Prismatic { axis: z },
        Joint::Screw { axis: z, pitch: 0.01 },
        Joint::Planar { along: x, normal: z },
        Joint::Fixed,
    ];
    for kind in kinds {
        let mechanism = body(|m, one, two| {
            m.cut("hinge", kind, one, two);
        });
        let (state, _) = mechanism.assemble(&turned(0.4)).expect("near the position meant");
        assert!(state.q[4].abs() < 1e-9, "{kind:?}: {:?}", state.q);
        let backwards = mechanism
            .assemble(&turned(2.8))
            .expect_err("farther from it than from its reverse");
        assert!(
            matches!(&backwards, StartError::Reversed { joint } if joint == "hinge"),
            "{kind:?}: {backwards}"
        );
        assert!(backwards.to_string().contains("`hinge` closes the wrong way round"));
    }
    // These have no wrong way round.
    for kind in [Joint::Spherical, Joint::Universal { first: z, second: x }, Joint::Free] {
        let mechanism = body(|m, one, two| {
            m.cut("hinge", kind, one, two);
        });
        mechanism.assemble(&turned(2.8)).expect("closes");
    }
}

/// Equations of one's own say all that is meant, in whatever order their axes are.
#[test]
fn equations_of_ones_own_are_taken_at_their_word() {
    let angle = |on_predecessor: Vector3<f64>| Row::Angle {
        on_predecessor,
        on_successor: Vector3::z(),
        cosine: 0.0,
    };
    for axes in [[Vector3::x(), Vector3::y()], [Vector3::y(), Vector3::x()]] {
        let mechanism = body(|m, one, two| {
            let rows = [Row::Coincident, angle(axes[0]), angle(axes[1])];
            m.cut_rows("own", &rows, one, two);
        });
        for guess in [0.4, 2.8] {
            mechanism.assemble(&turned(guess)).expect("closes");
        }
        let start = Start {
            held: vec!["free.qz".into()],
            ..Start::default()
        };
        let found = branches(&mechanism, &start, &Search::default()).expect("isolated");
        assert!(found.reversed == 0 && !found.positions.is_empty(), "{found:?}");
    }
}

//! File form of poses, joints and Denavit-Hartenberg tables.

use linkdyn_kinematics::{Joint, Pose, Tree, TreeError, dh};
use nalgebra::Vector3;
use serde_json::{from_str, json, to_string, to_value};

#[test]
fn poses_come_back_to_the_last_bit() {
    let pose = Pose::translation(0.1, -0.2, 1.0 / 3.0) * Pose::turn(Vector3::y_axis(), 0.7);
    assert_eq!(from_str::<Pose>(&to_string(&pose).unwrap()).unwrap(), pose);
}

#[test]
fn rotations_are_written_axis_by_axis() {
    let quarter = Pose::from_rows([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [1.0, 2.0, 3.0]);
    let expected = json!({
        "rotation": [0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        "origin": [1.0, 2.0, 3.0],
    });
    assert_eq!(to_value(quarter).unwrap(), expected);
}

#[test]
fn joints_come_back() {
    let (axis, second) = (Vector3::z_axis(), Vector3::x_axis());
    let joints = [
        Joint::Fixed,
        Joint::Revolute { axis },
        Joint::Prismatic { axis },
        Joint::Cylindrical { axis },
        Joint::Universal { first: axis, second },
        Joint::SphericalZyx,
        Joint::Spherical,
        Joint::Planar {
            along: second,
            normal: axis,
        },
        Joint::Free,
        Joint::Screw { axis, pitch: 0.01 },
    ];
    for joint in joints {
        assert_eq!(from_str::<Joint>(&to_string(&joint).unwrap()).unwrap(), joint);
    }
    assert_eq!(to_value(Joint::SphericalZyx).unwrap(), json!("spherical_zyx"));
    let revolute = json!({ "revolute": { "axis": [0.0, 0.0, 1.0] } });
    assert_eq!(to_value(joints[1]).unwrap(), revolute);
}

/// A file may hold any three numbers for an axis: the tree refuses what is no unit vector.
#[test]
fn axis_of_another_length_is_refused_by_the_tree() {
    let joint: Joint = from_str(r#"{ "revolute": { "axis": [0, 0, 2] } }"#).unwrap();
    let mut tree = Tree::new();
    let refused = tree.attach(linkdyn_kinematics::LinkId::GROUND, Pose::identity(), joint);
    assert_eq!(refused, Err(TreeError::BadAxis { joint }));
}

#[test]
fn tables_come_back_and_misspelt_fields_are_refused() {
    let row = dh::Row {
        theta: 0.1,
        d: 0.2,
        a: 0.3,
        alpha: 0.4,
    };
    assert_eq!(from_str::<dh::Row>(&to_string(&row).unwrap()).unwrap(), row);
    assert!(from_str::<dh::Row>(r#"{ "theta": 0, "d": 0, "a": 0, "alhpa": 0 }"#).is_err());
    assert_eq!(to_value(dh::Convention::Craig).unwrap(), json!("craig"));
    assert_eq!(to_value(dh::Variable::Theta).unwrap(), json!("theta"));
}

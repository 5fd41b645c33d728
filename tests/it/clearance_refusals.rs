//! What the builder must refuse of clearance and springs, and the catalogue of its scenes, by name.

use crate::linkage_refusals::{Arm, arm, bearing, characteristic, refusal, rod};
use linkdyn_contact::{ContactLaw, Fit, ForcePoint, KelvinVoigt};
use linkdyn_friction::{BristleStart, LuGre};
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::catalogue::{ClearanceKind, Rsup, RsupError, rsup};
use linkdyn_mechanisms::{BuildError, Clearance, ClearanceError, ClearanceModel, Linkage, Mount, Side, Spring};
use nalgebra::Vector3;

/// The arm's end in a hole of the ground, with steel that bounces and a bristle, everything in range.
fn with_clearance(change: impl FnOnce(&mut Clearance)) -> BuildError {
    let mut clearance = Clearance {
        fit: Fit::new(0.005, 0.004).expect("a pin in a hole"),
        bearing: Side::Predecessor,
        model: ClearanceModel::Planar,
        law: ContactLaw::from(KelvinVoigt {
            stiffness: 1e6,
            damping: 10.0,
        }),
        friction: Some(linkdyn_mechanisms::catalogue::bristle().into()),
        bristle_start: BristleStart::default(),
        force_point: ForcePoint::default(),
    };
    let add = |arm: &mut Arm, joint: Joint, clearance: Clearance| {
        let end = Mount::at(arm.lower, [0.5, 0.0, 0.0]);
        let hole = Mount::at(Linkage::GROUND, [0.5, 0.5, 0.0]);
        let cut = arm.linkage.cut("end", joint, hole, end);
        arm.linkage.clearance(cut, clearance);
    };
    let mut sound = arm();
    add(&mut sound, Joint::revolute_z(), clearance.clone());
    sound.linkage.build().expect("what is changed is what is refused");
    change(&mut clearance);
    refusal(|arm| add(arm, Joint::revolute_z(), clearance))
}

#[test]
fn clearance_out_of_range_is_refused_by_joint_part_and_value() {
    let law = |law: KelvinVoigt| match with_clearance(|c| c.law = law.into()) {
        BuildError::Clearance {
            joint,
            source: ClearanceError::Law(source),
        } => {
            assert_eq!(joint, "end");
            (source.field, source.value.to_string())
        }
        other => panic!("{other:?}"),
    };
    let (stiffness, damping) = (1e6, 10.0);
    for (given, field, value) in [
        ((-1.0, damping), "stiffness", "-1"),
        ((0.0, damping), "stiffness", "0"),
        ((f64::NAN, damping), "stiffness", "NaN"),
        ((f64::INFINITY, damping), "stiffness", "inf"),
        ((stiffness, -0.5), "damping", "-0.5"),
        ((stiffness, f64::NAN), "damping", "NaN"),
    ] {
        let (stiffness, damping) = given;
        let found = law(KelvinVoigt { stiffness, damping });
        assert_eq!(found, (field, value.to_owned()));
    }

    let sound = linkdyn_mechanisms::catalogue::bristle();
    let bristle = |model: LuGre| match with_clearance(|c| c.friction = Some(model.into())) {
        BuildError::Clearance {
            joint,
            source: ClearanceError::Bristle(source),
        } => {
            assert_eq!(joint, "end");
            (source.field, source.value)
        }
        other => panic!("{other:?}"),
    };
    let stiffness = LuGre {
        bristle_stiffness: -1.0,
        ..sound
    };
    assert_eq!(bristle(stiffness), ("bristle_stiffness", -1.0));
    let damping = LuGre {
        bristle_damping: -1.0,
        ..sound
    };
    assert_eq!(bristle(damping), ("bristle_damping", -1.0));
    let speed = LuGre {
        stribeck_speed: 0.0,
        ..sound
    };
    assert_eq!(bristle(speed), ("stribeck_speed", 0.0));

    for length in [0.0, -0.02, f64::NAN, f64::INFINITY] {
        let found = with_clearance(|c| c.model = ClearanceModel::Spatial { length });
        assert!(found.to_string().contains(&format!("{length} m")), "{found}");
        let BuildError::Clearance {
            joint,
            source: ClearanceError::Length(told),
        } = found
        else {
            panic!("{found:?}");
        };
        assert!(joint == "end" && told.total_cmp(&length).is_eq());
    }
}

#[test]
fn clearance_is_for_joints_of_its_kind_and_of_the_same_linkage() {
    let clearance = |model| Clearance {
        fit: Fit::new(0.005, 0.004).expect("a pin in a hole"),
        bearing: Side::Successor,
        model,
        law: ContactLaw::from(KelvinVoigt {
            stiffness: 1e6,
            damping: 0.0,
        }),
        friction: None,
        bristle_start: BristleStart::default(),
        force_point: ForcePoint::default(),
    };
    let axis = Vector3::z_axis();
    let (planar, spatial, ball) = (
        ("planar", ClearanceModel::Planar),
        ("spatial", ClearanceModel::Spatial { length: 0.02 }),
        ("spherical", ClearanceModel::Spherical),
    );
    for ((kind, joint), (name, model)) in [
        (("fixed", Joint::Fixed), planar),
        (("prismatic", Joint::Prismatic { axis }), spatial),
        (("cylindrical", Joint::Cylindrical { axis }), planar),
        (
            (
                "planar",
                Joint::Planar {
                    along: Vector3::x_axis(),
                    normal: axis,
                },
            ),
            ball,
        ),
        (("spherical", Joint::Spherical), planar),
        (("spherical zyx", Joint::SphericalZyx), spatial),
        (("revolute", Joint::revolute_z()), ball),
    ] {
        for cut in [false, true] {
            let found = refusal(|arm| {
                let (end, hole) = (Mount::at_origin(arm.lower), Mount::at_origin(Linkage::GROUND));
                if cut {
                    let cut = arm.linkage.cut("end", joint, end, hole);
                    arm.linkage.clearance(cut, clearance(model));
                } else {
                    let third = arm.linkage.link("third", rod());
                    let carrying = arm.linkage.joint("end", joint, end, Mount::at_origin(third));
                    arm.linkage.clearance(carrying, clearance(model));
                }
            });
            let joint = "end".to_owned();
            assert_eq!(
                found,
                BuildError::ClearanceKind {
                    joint,
                    kind,
                    model: name
                }
            );
            assert!(
                found.to_string().contains(&format!("is {kind}, its clearance {name}")),
                "{found}"
            );
        }
    }
    let found = refusal(|arm| {
        arm.linkage.clearance(arm.elbow, clearance(ClearanceModel::Planar));
        arm.linkage.friction(arm.elbow, characteristic(), bearing());
    });
    let joint = "elbow".to_owned();
    assert_eq!(found, BuildError::FrictionWithClearance { joint });
    let mut unsound = clearance(ClearanceModel::Spatial { length: -1.0 });
    unsound.friction = None;
    let found = refusal(|arm| {
        arm.linkage.clearance(arm.elbow, unsound);
    });
    assert!(
        matches!(&found, BuildError::Clearance { joint, .. } if joint == "elbow"),
        "{found:?}"
    );
    let mut other = arm();
    let foreign = other.linkage.cut(
        "end",
        Joint::revolute_z(),
        Mount::at_origin(other.lower),
        Mount::at_origin(Linkage::GROUND),
    );
    let found = refusal(|arm| {
        arm.linkage.clearance(foreign, clearance(ClearanceModel::Planar));
    });
    let BuildError::Foreign { what, name } = &found else {
        panic!("{found:?}");
    };
    assert!(what.contains("handle") && name.contains("clearance"), "{found}");
}

#[test]
fn springs_that_do_not_fit_are_refused_by_name() {
    let spring = |stiffness: f64, damping: f64| Spring {
        stiffness,
        damping,
        ..Spring::default()
    };
    let fault = |springs: &[Spring]| match refusal(|arm| {
        arm.linkage.springs(arm.elbow, springs);
    }) {
        BuildError::Parameter {
            joint,
            parameter,
            value,
            expected,
        } => {
            assert_eq!(joint, "elbow");
            assert!(expected.contains("not negative"), "{expected}");
            (parameter, value.to_string())
        }
        other => panic!("{other:?}"),
    };
    for (wrong, parameter, value) in [
        (spring(-1.0, 0.0), "stiffness", "-1"),
        (spring(f64::NAN, 0.0), "stiffness", "NaN"),
        (spring(f64::INFINITY, 0.0), "stiffness", "inf"),
        (spring(0.0, -2.0), "damping", "-2"),
        (spring(0.0, f64::NAN), "damping", "NaN"),
        (spring(0.0, f64::INFINITY), "damping", "inf"),
    ] {
        assert_eq!(fault(&[wrong]), (parameter, value.to_owned()));
    }

    let sound = spring(1.0, 0.0);
    let two = refusal(|arm| {
        arm.linkage.springs(arm.elbow, &[sound, sound]);
    });
    let told = |joint: &str, coordinates, speeds, found| BuildError::Springs {
        joint: joint.into(),
        coordinates,
        speeds,
        found,
    };
    assert_eq!(two, told("elbow", 1, 1, 2));
    for (kind, springs, expected) in [
        (Joint::Spherical, 4, told("wrist", 4, 3, 4)),
        (Joint::Spherical, 3, told("wrist", 4, 3, 3)),
        (Joint::SphericalZyx, 2, told("wrist", 3, 3, 2)),
        (Joint::Fixed, 1, told("wrist", 0, 0, 1)),
    ] {
        let found = refusal(|arm| {
            let third = arm.linkage.link("third", rod());
            let (inner, outer) = (Mount::at_origin(arm.lower), Mount::at_origin(third));
            let wrist = arm.linkage.joint("wrist", kind, inner, outer);
            arm.linkage.springs(wrist, &vec![sound; springs]);
        });
        assert_eq!(found, expected);
    }

    let mut other = arm();
    let third = other.linkage.link("third", rod());
    let (inner, outer) = (Mount::at_origin(other.lower), Mount::at_origin(third));
    let foreign = other.linkage.joint("wrist", Joint::revolute_z(), inner, outer);
    let found = refusal(|arm| {
        arm.linkage.springs(foreign, &[sound]);
    });
    let BuildError::Foreign { name, .. } = &found else {
        panic!("{found:?}");
    };
    assert!(name.contains("springs"), "{found}");
}

#[test]
fn scenes_that_do_not_exist_are_refused() {
    for size in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        for kind in [ClearanceKind::Planar, ClearanceKind::Spatial] {
            let variant = Rsup {
                clearance: Some(kind),
                clearance_size: size,
                ..Rsup::default()
            };
            let found = rsup(&variant).map(|_| ()).expect_err("must be refused");
            assert!(matches!(found, RsupError::Clearance(_)), "{size}: {found:?}");
            assert!(found.to_string().contains("joint R"), "{found}");
        }
    }
    let stiff = Rsup {
        flexible: Some(0),
        ..Rsup::default()
    };
    let found = rsup(&stiff).map(|_| ()).expect_err("must be refused");
    let RsupError::Coupler(source) = &found else {
        panic!("{found:?}");
    };
    assert_eq!((source.item, source.value), ("division.standard", 0.0));
}

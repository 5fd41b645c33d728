//! What the builder and the start of a mechanism must refuse, by name.

use linkdyn_dynamics::{InertiaError, RigidInertia, SystemError};
use linkdyn_friction::{Exponential, JournalBearing, Surface};
use linkdyn_kinematics::assembly::AssemblyError;
use linkdyn_kinematics::{Joint, Pose, TreeError};
use linkdyn_mechanisms::{BuildError, Drive, JointHandle, LinkHandle, Linkage, Mount, Start, StartError};
use nalgebra::{Matrix3, Unit, Vector3};

pub(crate) fn rod() -> RigidInertia {
    RigidInertia::solid_cylinder(7850.0, 0.02, 0.5, &Vector3::x())
}

/// A double pendulum of links `upper`, `lower` on joints `shoulder`, `elbow`.
pub(crate) struct Arm {
    pub linkage: Linkage,
    pub upper: LinkHandle,
    pub lower: LinkHandle,
    pub shoulder: JointHandle,
    pub elbow: JointHandle,
}

pub(crate) fn arm() -> Arm {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let (upper, lower) = (linkage.link("upper", rod()), linkage.link("lower", rod()));
    let joint = Joint::revolute_z();
    let shoulder = linkage.joint(
        "shoulder",
        joint,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(upper),
    );
    let elbow = linkage.joint(
        "elbow",
        joint,
        Mount::at(upper, [0.5, 0.0, 0.0]),
        Mount::at_origin(lower),
    );
    Arm {
        linkage,
        upper,
        lower,
        shoulder,
        elbow,
    }
}

pub(crate) fn refusal(change: impl FnOnce(&mut Arm)) -> BuildError {
    let mut arm = arm();
    change(&mut arm);
    arm.linkage.build().expect_err("must be refused")
}

fn bad_axis() -> Joint {
    Joint::Revolute {
        axis: Unit::new_unchecked(Vector3::zeros()),
    }
}

fn skewed() -> Pose {
    Pose::from_rows([[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3])
}

#[test]
fn the_arm_itself_is_accepted() {
    let mechanism = arm().linkage.build().expect("valid");
    assert_eq!(mechanism.coordinate_names().collect::<Vec<_>>(), ["shoulder", "elbow"]);
}

#[test]
fn names_used_twice_are_refused() {
    let twice = |name: &str| BuildError::DuplicateName { name: name.into() };
    let link = refusal(|arm| {
        arm.linkage.link("upper", rod());
    });
    assert_eq!(link, twice("upper"));
    let joint = refusal(|arm| {
        let third = arm.linkage.link("third", rod());
        arm.linkage.joint(
            "elbow",
            Joint::Fixed,
            Mount::at_origin(arm.lower),
            Mount::at_origin(third),
        );
    });
    assert_eq!(joint, twice("elbow"));
    let cut = refusal(|arm| {
        arm.linkage.cut(
            "elbow",
            Joint::Spherical,
            Mount::at_origin(arm.lower),
            Mount::at_origin(Linkage::GROUND),
        );
    });
    assert_eq!(cut, twice("elbow"));
    assert_eq!(
        refusal(|arm| {
            arm.linkage.coordinate_names(arm.elbow, &["shoulder"]);
        }),
        twice("shoulder")
    );
}

#[test]
fn handles_of_another_linkage_are_refused() {
    let mut other = arm();
    let foreign_link = other.linkage.link("third", rod());
    let foreign_joint = other.linkage.joint(
        "third",
        Joint::Fixed,
        Mount::at_origin(other.lower),
        Mount::at_origin(foreign_link),
    );
    let cut = refusal(|arm| {
        arm.linkage.cut(
            "cut",
            Joint::Spherical,
            Mount::at_origin(arm.lower),
            Mount::at_origin(foreign_link),
        );
    });
    assert_eq!(
        cut,
        BuildError::Foreign {
            what: "successor",
            name: "cut".into()
        }
    );
    let cut = refusal(|arm| {
        arm.linkage.cut(
            "cut",
            Joint::Spherical,
            Mount::at_origin(foreign_link),
            Mount::at_origin(arm.lower),
        );
    });
    assert_eq!(
        cut,
        BuildError::Foreign {
            what: "predecessor",
            name: "cut".into()
        }
    );
    for change in [
        |arm: &mut Arm, joint| {
            arm.linkage.drive(joint, Drive::Constant { torque: 1.0 });
        },
        |arm: &mut Arm, joint| {
            arm.linkage.coordinate_names(joint, &["q"]);
        },
        |arm: &mut Arm, joint| {
            arm.linkage.friction(joint, characteristic(), bearing());
        },
    ] {
        assert!(matches!(
            refusal(|arm| change(arm, foreign_joint)),
            BuildError::Foreign { .. }
        ));
    }
}

#[test]
fn joints_that_make_no_tree_are_refused() {
    let own = refusal(|arm| {
        arm.linkage.cut(
            "cut",
            Joint::Spherical,
            Mount::at_origin(arm.upper),
            Mount::at(arm.upper, [1.0, 0.0, 0.0]),
        );
    });
    assert_eq!(
        own,
        BuildError::SelfJoint {
            joint: "cut".into(),
            link: "upper".into()
        }
    );
    // A joint more than a tree has could be cut, were there not something on the coordinates of each.
    let drive_all = |arm: &mut Arm, wrist: JointHandle| {
        for joint in [arm.shoulder, arm.elbow, wrist] {
            arm.linkage.drive(joint, Drive::Constant { torque: 1.0 });
        }
    };
    let twice = refusal(|arm| {
        let wrist = arm.linkage.joint(
            "wrist",
            Joint::revolute_z(),
            Mount::at_origin(Linkage::GROUND),
            Mount::at_origin(arm.lower),
        );
        drive_all(arm, wrist);
    });
    let (first, second) = ("elbow".into(), "wrist".into());
    assert_eq!(
        twice,
        BuildError::CarriedTwice {
            link: "lower".into(),
            first,
            second
        }
    );
    // From the ground's side a ball cannot carry.
    let ground = refusal(|arm| {
        let wrist = arm.linkage.joint(
            "wrist",
            Joint::SphericalZyx,
            Mount::at_origin(arm.lower),
            Mount::at_origin(Linkage::GROUND),
        );
        arm.linkage.coordinate_names(wrist, &["a", "b", "c"]);
    });
    assert!(matches!(ground, BuildError::CarriedTwice { link, second, .. } if link == "ground" && second == "wrist"));
    let loose = refusal(|arm| {
        arm.linkage.link("loose", rod());
    });
    assert_eq!(loose, BuildError::Disconnected { link: "loose".into() });
    // Two links that carry each other hang on nothing.
    let circle = refusal(|arm| {
        let (one, two) = (arm.linkage.link("one", rod()), arm.linkage.link("two", rod()));
        arm.linkage
            .joint("there", Joint::Fixed, Mount::at_origin(one), Mount::at_origin(two));
        arm.linkage
            .joint("back", Joint::Fixed, Mount::at_origin(two), Mount::at_origin(one));
    });
    assert_eq!(circle, BuildError::Disconnected { link: "one".into() });
}

#[test]
fn links_may_be_described_in_any_order() {
    // The elbow before the shoulder: coordinates follow the way outward.
    let mut linkage = Linkage::new([0.0; 3]);
    let (lower, upper) = (linkage.link("lower", rod()), linkage.link("upper", rod()));
    let joint = Joint::revolute_z();
    linkage.joint(
        "elbow",
        joint,
        Mount::at(upper, [0.5, 0.0, 0.0]),
        Mount::at_origin(lower),
    );
    linkage.joint(
        "shoulder",
        joint,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(upper),
    );
    let mechanism = linkage.build().expect("valid");
    assert_eq!(mechanism.coordinate_names().collect::<Vec<_>>(), ["shoulder", "elbow"]);
}

#[test]
fn axes_and_mounts_that_are_not_rigid_are_refused() {
    let bad = |joint: &str, axis: Joint| BuildError::Joint {
        joint: joint.into(),
        source: TreeError::BadAxis { joint: axis },
    };
    let axis = Unit::new_unchecked(Vector3::zeros());
    for joint in [bad_axis(), Joint::Prismatic { axis }, Joint::Cylindrical { axis }] {
        let carried = refusal(|arm| {
            let third = arm.linkage.link("third", rod());
            arm.linkage
                .joint("wrist", joint, Mount::at_origin(arm.lower), Mount::at_origin(third));
        });
        assert_eq!(carried, bad("wrist", joint));
        let cut = refusal(|arm| {
            arm.linkage.cut(
                "cut",
                joint,
                Mount::at_origin(arm.lower),
                Mount::at_origin(Linkage::GROUND),
            );
        });
        assert_eq!(cut, bad("cut", joint));
    }
    let parallel = Joint::Universal {
        first: Vector3::x_axis(),
        second: Vector3::x_axis(),
    };
    let cut = refusal(|arm| {
        arm.linkage.cut(
            "cut",
            parallel,
            Mount::at_origin(arm.lower),
            Mount::at_origin(Linkage::GROUND),
        );
    });
    assert_eq!(cut, bad("cut", parallel));
    for (skew_first, expected) in [(true, "predecessor"), (false, "successor")] {
        let mount = refusal(|arm| {
            let (good, bad) = (Mount::at_origin(Linkage::GROUND), Mount::with_pose(arm.lower, skewed()));
            let (one, two) = if skew_first { (bad, good) } else { (good, bad) };
            arm.linkage.cut("cut", Joint::Spherical, one, two);
        });
        match mount {
            BuildError::Mount { joint, side, defect } => {
                assert_eq!((joint.as_str(), side), ("cut", expected));
                assert!((defect - 0.5).abs() < 1e-15);
            }
            other => panic!("{other:?}"),
        }
    }
    let nan = refusal(|arm| {
        arm.linkage.cut(
            "cut",
            Joint::Spherical,
            Mount::at(arm.lower, [f64::NAN; 3]),
            Mount::at_origin(Linkage::GROUND),
        );
    });
    assert!(matches!(
        nan,
        BuildError::Mount {
            defect: f64::INFINITY,
            ..
        }
    ));
}

pub fn characteristic() -> Exponential {
    Exponential {
        reference_speed: 0.01,
        steepness: 3.0,
    }
}

pub fn bearing() -> JournalBearing {
    let surface = |coefficient| Surface {
        diameter: 0.01,
        coefficient,
    };
    JournalBearing {
        spacing: 0.03,
        surface_a: surface(0.1),
        surface_b: surface(0.1),
        face: surface(0.0),
    }
}

#[test]
fn loads_on_joints_of_several_coordinates_are_refused() {
    let with_ball = |load: &dyn Fn(&mut Linkage, JointHandle)| {
        refusal(|arm| {
            let third = arm.linkage.link("third", rod());
            let ball = Joint::Spherical;
            let wrist = arm
                .linkage
                .joint("wrist", ball, Mount::at_origin(arm.lower), Mount::at_origin(third));
            load(&mut arm.linkage, wrist);
        })
    };
    let not_one = |what| BuildError::NotOneCoordinate {
        what,
        joint: "wrist".into(),
        coordinates: 4,
    };
    let driven = with_ball(&|linkage, joint| {
        linkage.drive(joint, Drive::Constant { torque: 1.0 });
    });
    assert_eq!(driven, not_one("a drive"));
    let rubbing = with_ball(&|linkage, joint| {
        linkage.friction(joint, characteristic(), bearing());
    });
    assert_eq!(rubbing, not_one("friction"));
    let names = with_ball(&|linkage, joint| {
        linkage.coordinate_names(joint, &["a", "b", "c"]);
    });
    assert_eq!(
        names,
        BuildError::CoordinateNames {
            joint: "wrist".into(),
            expected: 4,
            found: 3
        }
    );
}

#[test]
fn drives_and_friction_out_of_range_are_refused() {
    let drive = |drive: Drive| {
        refusal(|arm| {
            arm.linkage.drive(arm.elbow, drive);
        })
    };
    let fault = |found: BuildError| match found {
        BuildError::Parameter {
            joint,
            parameter,
            value,
            ..
        } => {
            assert_eq!(joint, "elbow");
            (parameter, value)
        }
        other => panic!("{other:?}"),
    };
    let infinite = f64::INFINITY;
    let (torque, rise_time, reference_speed) = (1.0, 1.0, 1.0);
    assert_eq!(fault(drive(Drive::Constant { torque: infinite })), ("torque", infinite));
    assert_eq!(
        fault(drive(Drive::Ramp {
            torque: infinite,
            rise_time
        })),
        ("torque", infinite)
    );
    assert_eq!(fault(drive(Drive::Ramp { torque, rise_time: 0.0 })), ("rise_time", 0.0));
    assert_eq!(
        fault(drive(Drive::Ramp {
            torque,
            rise_time: -1.0
        })),
        ("rise_time", -1.0)
    );
    assert_eq!(
        fault(drive(Drive::Resistance {
            torque: infinite,
            reference_speed
        })),
        ("torque", infinite)
    );
    assert_eq!(
        fault(drive(Drive::Resistance {
            torque,
            reference_speed: 0.0
        })),
        ("reference_speed", 0.0)
    );
    assert_eq!(
        fault(drive(Drive::Resistance {
            torque,
            reference_speed: infinite
        })),
        ("reference_speed", infinite)
    );

    let rough = |change: &dyn Fn(&mut Exponential, &mut JournalBearing)| {
        let (mut law, mut bearing) = (characteristic(), bearing());
        change(&mut law, &mut bearing);
        match refusal(|arm| {
            arm.linkage.friction(arm.shoulder, law, bearing);
        }) {
            BuildError::Friction { joint, source } => {
                assert_eq!(joint, "shoulder");
                (source.field, source.value)
            }
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(rough(&|law, _| law.reference_speed = 0.0), ("reference_speed", 0.0));
    assert_eq!(
        rough(&|_, bearing| bearing.surface_b.coefficient = -0.1),
        ("surface_b.coefficient", -0.1)
    );
    assert_eq!(rough(&|_, bearing| bearing.spacing = -1.0), ("spacing", -1.0));
}

#[test]
fn impossible_links_and_systems_are_refused_by_name() {
    let link = |change: &dyn Fn(&mut RigidInertia)| {
        refusal(|arm| {
            let mut inertia = rod();
            change(&mut inertia);
            let third = arm.linkage.link("third", inertia);
            arm.linkage.joint(
                "wrist",
                Joint::Fixed,
                Mount::at_origin(arm.lower),
                Mount::at_origin(third),
            );
        })
    };
    let named = |source| BuildError::Inertia {
        link: "third".into(),
        source,
    };
    assert_eq!(link(&|i| i.mass = -1.0), named(InertiaError::Mass(-1.0)));
    let triangle = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 3.0));
    assert_eq!(
        link(&|i| i.about_com = triangle),
        named(InertiaError::Triangle([1.0, 1.0, 3.0]))
    );

    let empty = Linkage::new([0.0; 3]).build().expect_err("nothing moves");
    assert_eq!(empty, BuildError::System(SystemError::NoFreedom));
    let mut floating = Linkage::new([0.0, f64::INFINITY, 0.0]);
    let link = floating.link("body", rod());
    floating.joint(
        "ball",
        Joint::Spherical,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(link),
    );
    let gravity = SystemError::Gravity([0.0, f64::INFINITY, 0.0]);
    assert_eq!(floating.build().expect_err("no number"), BuildError::System(gravity));
}

#[test]
fn starts_that_name_nothing_or_cannot_be_had_are_refused() {
    let mechanism = arm().linkage.build().expect("valid");
    let unknown = StartError::UnknownCoordinate {
        name: "wrist".into(),
        known: "shoulder, elbow".into(),
    };
    for start in [
        Start {
            positions: vec![("wrist".into(), 0.0)],
            ..Start::default()
        },
        Start {
            held: vec!["wrist".into()],
            ..Start::default()
        },
        Start {
            speeds: vec![("wrist".into(), 0.0)],
            ..Start::default()
        },
    ] {
        assert_eq!(mechanism.assemble(&start).map(|_| ()), Err(unknown.clone()));
    }
    let nan = |positions, speeds| {
        let start = Start {
            positions,
            speeds,
            ..Start::default()
        };
        mechanism.assemble(&start).map(|_| ()).expect_err("no number")
    };
    let list = || vec![("elbow".into(), f64::NAN)];
    for found in [nan(list(), Vec::new()), nan(Vec::new(), list())] {
        let told = matches!(found, StartError::Assembly(AssemblyError::NotFinite { index: 1, .. }));
        assert!(told, "{found:?}");
    }
}

#[test]
fn a_start_that_contradicts_itself_is_refused() {
    let mut arm = arm();
    // The end of the arm is tied to a point half a metre from the shoulder, at right angles.
    let end = Mount::at(arm.lower, [0.5, 0.0, 0.0]);
    arm.linkage.cut(
        "tie",
        Joint::Spherical,
        end,
        Mount::at(Linkage::GROUND, [0.0, 0.5, 0.0]),
    );
    let mechanism = arm.linkage.build().expect("valid");
    let positions = vec![("shoulder".into(), 0.4), ("elbow".into(), 2.0)];
    let both = vec!["shoulder".into(), "elbow".into()];
    let open = Start {
        positions: positions.clone(),
        held: both,
        speeds: Vec::new(),
    };
    assert!(matches!(
        mechanism.assemble(&open),
        Err(StartError::Assembly(AssemblyError::NotClosed {
            closure: 0,
            rank: 0,
            equations: 3,
            ..
        }))
    ));
    // The closed triangle cannot move.
    let moving = Start {
        positions,
        held: Vec::new(),
        speeds: vec![("shoulder".into(), 1.0)],
    };
    assert!(matches!(
        mechanism.assemble(&moving),
        Err(StartError::Assembly(AssemblyError::Velocities {
            closure: 0,
            rank: 1,
            ..
        }))
    ));
}

//! The joints of a scene file, and what sits in them.

use super::fault::{Faults, nearest};
use super::format::{DriveItem, FrictionItem, JointItem, Kind, MountItem, SceneFile, SurfaceItem};
use crate::drive::Drive;
use crate::linkage::{LinkHandle, Linkage, Mount};
use crate::spanning::{Edge, Role, spanning_tree};
use crate::spline::Spline;
use crate::spring::Spring;
use linkdyn_friction::{BearingModel, Characteristic, Exponential, JournalBearing, Surface};
use linkdyn_kinematics::{Joint, Pose};
use nalgebra::{Rotation3, Unit, Vector3};

/// Adds all joints, in the order of the file.
pub(super) fn add(file: &SceneFile, linkage: &mut Linkage, faults: &mut Faults<'_>) {
    let mut read = Vec::new();
    for (name, item) in &file.joints {
        let joint = joint(name, item, faults);
        let predecessor = mount(file, name, "predecessor", &item.predecessor, faults);
        let successor = mount(file, name, "successor", &item.successor, faults);
        if let (Some(one), Some(two)) = (predecessor, successor)
            && one.link == two.link
        {
            faults.add(
                &["joints", name],
                "connects a link to itself; give predecessor and successor different links",
            );
        }
        read.push((name, item, joint.zip(predecessor.zip(successor))));
    }
    let read: Vec<_> = read
        .into_iter()
        .filter_map(|(name, item, parts)| parts.map(|(joint, (one, two))| (name, item, joint, one, two)))
        .collect();
    let edges: Vec<Edge> = read
        .iter()
        .map(|(_, item, joint, one, two)| Edge {
            predecessor: one.link.0,
            successor: two.link.0,
            freedoms: joint.speeds(),
            cut: item.cut.or(sits_on_coordinates(item).map(|_| false)),
        })
        .collect();
    for ((name, item, joint, one, two), role) in read.into_iter().zip(spanning_tree(file.links.len(), &edges)) {
        match role {
            Role::Cut => {
                if item.cut == Some(false) {
                    faults.add(
                        &["joints", name, "cut"],
                        "both links are carried by other joints; leave `cut` out or cut another joint",
                    );
                }
                if let Some(key) = sits_on_coordinates(item) {
                    faults.add(
                        &["joints", name, key],
                        "goes with joints that carry a link; this one is cut, so cut another joint of its loop",
                    );
                }
                linkage.cut(name, joint, one, two);
            }
            Role::Carries => carry(name, item, (joint, one, two), linkage, faults),
            Role::CarriesBackwards => match backwards(joint) {
                Some(joint) => carry(name, item, (joint, two, one), linkage, faults),
                None => {
                    let message = "must carry its successor; exchange predecessor and successor, or set `cut = true`";
                    faults.add(&["joints", name], message);
                }
            },
        }
    }
}

/// The key of something that needs the joint's coordinates.
fn sits_on_coordinates(item: &JointItem) -> Option<&'static str> {
    let there = [
        (!item.drives.is_empty(), "drives"),
        (!item.springs.is_empty(), "springs"),
        (item.friction.is_some(), "friction"),
        (item.coordinates.is_some(), "coordinates"),
    ];
    there.into_iter().find_map(|(there, key)| there.then_some(key))
}

/// The same joint with exchanged sides and the same coordinates, where there is one.
fn backwards(joint: Joint) -> Option<Joint> {
    match joint {
        Joint::Revolute { axis } => Some(Joint::Revolute { axis: -axis }),
        Joint::Prismatic { axis } => Some(Joint::Prismatic { axis: -axis }),
        Joint::Cylindrical { axis } => Some(Joint::Cylindrical { axis: -axis }),
        Joint::Fixed => Some(Joint::Fixed),
        _ => None,
    }
}

fn joint(name: &str, item: &JointItem, faults: &mut Faults<'_>) -> Option<Joint> {
    let mut axis = |key: &str, given: Option<[f64; 3]>, default: Vector3<f64>| {
        let vector = given.map_or(default, Vector3::from);
        let sound = vector.iter().all(|x| x.is_finite());
        let unit = Unit::try_new(vector, f64::MIN_POSITIVE).filter(|unit| sound && unit.iter().all(|x| x.is_finite()));
        if unit.is_none() {
            faults.add(&["joints", name, key], "must be three finite numbers, not all zero");
        }
        unit
    };
    let second = if item.kind == Kind::Planar {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let (first, second) = (
        axis("axis", item.axis, Vector3::z())?,
        axis("second_axis", item.second_axis, second)?,
    );
    let joint = match item.kind {
        Kind::Fixed => Joint::Fixed,
        Kind::Revolute => Joint::Revolute { axis: first },
        Kind::Prismatic => Joint::Prismatic { axis: first },
        Kind::Cylindrical => Joint::Cylindrical { axis: first },
        Kind::Universal => Joint::Universal { first, second },
        Kind::Spherical => Joint::Spherical,
        Kind::SphericalZyx => Joint::SphericalZyx,
        Kind::Planar => Joint::Planar {
            along: second,
            normal: first,
        },
        Kind::Free => Joint::Free,
    };
    let no_axis = matches!(
        item.kind,
        Kind::Fixed | Kind::Spherical | Kind::SphericalZyx | Kind::Free
    );
    let two_axes = matches!(item.kind, Kind::Universal | Kind::Planar);
    for (key, idle) in [
        ("axis", no_axis && item.axis.is_some()),
        ("second_axis", !two_axes && item.second_axis.is_some()),
    ] {
        if idle {
            faults.add(
                &["joints", name, key],
                "says nothing for a joint of this kind; leave it out",
            );
        }
    }
    if joint.validate().is_err() {
        let message =
            "the axes of a universal joint must not be parallel, those of a planar one must be at right angles";
        faults.add(&["joints", name], message);
        return None;
    }
    Some(joint)
}

fn mount(file: &SceneFile, name: &str, side: &str, item: &MountItem, faults: &mut Faults<'_>) -> Option<Mount> {
    let link = match item.link.as_deref() {
        None | Some("ground") => Linkage::GROUND,
        Some(link) => match file.links.get_index_of(link) {
            Some(k) => LinkHandle(Some(k)),
            None => {
                let known = file.links.keys().map(String::as_str).chain(["ground"]);
                let hint = match nearest(link, known.clone()) {
                    Some(word) => format!("did you mean `{word}`?"),
                    None => format!("there are {}", known.collect::<Vec<_>>().join(", ")),
                };
                faults.add(
                    &["joints", name, side, "link"],
                    format!("there is no link `{link}`; {hint}"),
                );
                return None;
            }
        },
    };
    let pose = match (item.rotation, item.turn) {
        (Some(rows), None) => Pose::from_rows(rows, item.point),
        (None, None) => Pose::translation(item.point[0], item.point[1], item.point[2]),
        (None, Some(turn)) => {
            let axis = Unit::try_new(Vector3::from(turn.axis), f64::MIN_POSITIVE);
            let Some(axis) = axis.filter(|axis| axis.iter().all(|x| x.is_finite())) else {
                let message = "must be three finite numbers, not all zero";
                faults.add(&["joints", name, side, "turn", "axis"], message);
                return None;
            };
            Pose {
                rotation: *Rotation3::from_axis_angle(&axis, turn.angle.0).matrix(),
                origin: Vector3::from(item.point),
            }
        }
        (Some(_), Some(_)) => {
            faults.add(
                &["joints", name, side, "turn"],
                "says again what `rotation` says; give one of them",
            );
            return None;
        }
    };
    let defect = pose.defect();
    if defect.is_nan() || defect > 1e-9 {
        let message = format!(
            "point and rotation must be finite and the rotation proper, but it is off by {defect:e} (allowed: 1e-9)"
        );
        faults.add(&["joints", name, side], message);
        return None;
    }
    Some(Mount { link, pose })
}

fn carry(name: &str, item: &JointItem, parts: (Joint, Mount, Mount), linkage: &mut Linkage, faults: &mut Faults<'_>) {
    let (kind, predecessor, successor) = parts;
    let freedoms = kind.coordinates();
    let joint = linkage.joint(name, kind, predecessor, successor);
    if let Some(names) = &item.coordinates {
        if names.len() == freedoms {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            linkage.coordinate_names(joint, &names);
        } else {
            let message = format!("the joint has {freedoms} coordinates, {} names were given", names.len());
            faults.add(&["joints", name, "coordinates"], message);
        }
    }
    for item in &item.drives {
        let drive = drive(item);
        if let Some((parameter, value, expected)) = drive.fault() {
            faults.add(
                &["joints", name, "drives"],
                format!("{parameter} = {value} must be {expected}"),
            );
        }
        linkage.drive(joint, drive);
    }
    let springs: Vec<Spring> = item
        .springs
        .iter()
        .map(|spring| Spring {
            stiffness: spring.stiffness,
            damping: spring.damping,
            rest: spring.rest.0,
        })
        .collect();
    for (parameter, value, expected) in springs.iter().filter_map(Spring::fault) {
        faults.add(
            &["joints", name, "springs"],
            format!("{parameter} = {value} must be {expected}"),
        );
    }
    if !springs.is_empty() {
        linkage.springs(joint, &springs);
    }
    if let Some(item) = &item.friction {
        let (characteristic, bearing) = friction(item);
        if let Err(error) = characteristic.validate().and_then(|()| bearing.validate()) {
            faults.add(&["joints", name, "friction"], error.to_string());
        }
        linkage.friction(joint, characteristic, bearing);
    }
}

fn drive(item: &DriveItem) -> Drive {
    match *item {
        DriveItem::Ramp { torque, rise_time } => Drive::Ramp { torque, rise_time },
        DriveItem::Constant { torque } => Drive::Constant { torque },
        DriveItem::Harmonic {
            amplitude,
            frequency,
            phase,
        } => Drive::Harmonic {
            amplitude,
            frequency,
            phase,
        },
        DriveItem::Table { ref points, monotone } => {
            let nodes: Vec<(f64, f64)> = points.iter().map(|&[t, value]| (t, value)).collect();
            let through = if monotone { Spline::monotone } else { Spline::natural };
            Drive::Table {
                spline: through(&nodes),
            }
        }
        DriveItem::QuadraticResistance {
            torque,
            reference_speed,
        } => Drive::QuadraticResistance {
            torque,
            reference_speed,
        },
        DriveItem::Resistance {
            torque,
            reference_speed,
        } => Drive::Resistance {
            torque,
            reference_speed,
        },
    }
}

fn friction(item: &FrictionItem) -> (Exponential, JournalBearing) {
    let surface = |surface: SurfaceItem| Surface {
        diameter: surface.diameter,
        coefficient: surface.coefficient,
    };
    let characteristic = Exponential {
        reference_speed: item.exponential.reference_speed,
        steepness: item.exponential.steepness,
    };
    let bearing = JournalBearing {
        spacing: item.journal.spacing,
        surface_a: surface(item.journal.surface_a),
        surface_b: surface(item.journal.surface_b),
        face: surface(item.journal.face),
    };
    (characteristic, bearing)
}

//! The joints of a scene file: what they are, where they sit, which of them carry links.

use super::fault::{Faults, unknown};
use super::format::{JointItem, Kind, MountItem, SceneFile};
use super::loads::{self, Sitting};
use crate::linkage::{LinkHandle, Linkage, Mount};
use crate::spanning::{Edge, Role, spanning_tree};
use linkdyn_kinematics::{Joint, Pose};
use nalgebra::{Rotation3, Unit, Vector3};
use std::collections::HashSet;

/// A joint as the file has it.
struct Read<'f> {
    name: &'f str,
    item: &'f JointItem,
    joint: Joint,
    predecessor: Mount,
    successor: Mount,
    sitting: Sitting,
}

/// Adds all joints, in the order of the file. Which of them are cut is judged only where all could be read. The result are the names of
/// those that are.
pub(super) fn add(file: &SceneFile, linkage: &mut Linkage, faults: &mut Faults<'_>) -> Vec<String> {
    let mut read = Vec::new();
    let mut coordinates = HashSet::new();
    for (name, item) in &file.joints {
        let joint = joint(name, item, faults);
        let predecessor = mount(file, &["joints", name, "predecessor"], &item.predecessor, faults);
        let successor = mount(file, &["joints", name, "successor"], &item.successor, faults);
        if let (Some(one), Some(two)) = (predecessor, successor)
            && one.link == two.link
        {
            let message = "has the same link as the predecessor; a joint connects two";
            faults.add(&["joints", name, "successor"], message);
        }
        let sitting = loads::read(name, item, faults);
        for coordinate in item.coordinates.iter().flatten() {
            if !coordinates.insert(coordinate) {
                let message = format!("the name `{coordinate}` is used twice");
                faults.add(&["joints", name, "coordinates"], message);
            }
        }
        if let (Some(joint), Some(predecessor), Some(successor)) = (joint, predecessor, successor) {
            read.push(Read {
                name,
                item,
                joint,
                predecessor,
                successor,
                sitting,
            });
        }
    }
    if read.len() < file.joints.len() || faults.lacks(&["joints"]) {
        return Vec::new();
    }
    let edges: Vec<Edge> = read
        .iter()
        .map(|read| Edge {
            predecessor: read.predecessor.link.0,
            successor: read.successor.link.0,
            freedoms: read.joint.speeds(),
            cut: read.item.cut.or(sits_on_coordinates(read.item).map(|_| false)),
        })
        .collect();
    let roles = spanning_tree(file.links.len(), &edges);
    connected(file, &edges, &roles, faults);
    let mut cut = Vec::new();
    for (read, role) in read.into_iter().zip(roles) {
        let (name, item) = (read.name, read.item);
        let (one, two) = (read.predecessor, read.successor);
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
                linkage.cut(name, read.joint, one, two);
                cut.push(name.to_owned());
            }
            Role::Carries => {
                let joint = linkage.joint(name, read.joint, one, two);
                read.sitting.put(joint, item, linkage);
            }
            Role::CarriesBackwards => match backwards(read.joint) {
                Some(kind) => {
                    let joint = linkage.joint(name, kind, two, one);
                    read.sitting.put(joint, item, linkage);
                }
                None => {
                    let message = "must carry its successor; exchange predecessor and successor, or set `cut = true`";
                    faults.add(&["joints", name, "successor"], message);
                }
            },
        }
    }
    cut
}

/// Refuses links that hang on nothing.
fn connected(file: &SceneFile, edges: &[Edge], roles: &[Role], faults: &mut Faults<'_>) {
    let carried: HashSet<usize> = edges
        .iter()
        .zip(roles)
        .filter_map(|(edge, role)| match role {
            Role::Carries => edge.successor,
            Role::CarriesBackwards => edge.predecessor,
            Role::Cut => None,
        })
        .collect();
    let links = file.links.keys().enumerate();
    for (_, name) in links.filter(|(k, _)| !carried.contains(k)) {
        faults.add(
            &["links", name],
            "no chain of joints that are not cut leads from it to the ground",
        );
    }
}

/// The key of something that needs the joint's coordinates.
fn sits_on_coordinates(item: &JointItem) -> Option<&'static str> {
    let there = [
        (!item.drives.is_empty(), "drives"),
        (!item.springs.is_empty(), "springs"),
        (item.friction.is_some(), "friction"),
        (item.limit.is_some(), "limit"),
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
    let mut axis = |key: &str, given: Option<[f64; 3]>, default: Unit<Vector3<f64>>| {
        let vector = given.map_or(*default, Vector3::from);
        let sound = vector.iter().all(|x| x.is_finite());
        let unit = Unit::try_new(vector, f64::MIN_POSITIVE).filter(|unit| sound && unit.iter().all(|x| x.is_finite()));
        if unit.is_none() {
            faults.add(&["joints", name, key], "must be three finite numbers, not all zero");
        }
        unit
    };
    let (first, second) = default_axes(item.kind);
    let first = axis("axis", item.axis, first);
    let second = axis("second_axis", item.second_axis, second);
    let joint = of_kind(item.kind, first?, second?);
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
        let key = if item.second_axis.is_some() {
            "second_axis"
        } else {
            "axis"
        };
        faults.add(&["joints", name, key], message);
        return None;
    }
    Some(joint)
}

/// First and second axis of joints that give none.
fn default_axes(kind: Kind) -> (Unit<Vector3<f64>>, Unit<Vector3<f64>>) {
    let second = if kind == Kind::Planar {
        Vector3::x_axis()
    } else {
        Vector3::y_axis()
    };
    (Vector3::z_axis(), second)
}

/// A joint of a kind.
pub(super) fn any_of_kind(kind: Kind) -> Joint {
    let (first, second) = default_axes(kind);
    of_kind(kind, first, second)
}

fn of_kind(kind: Kind, first: Unit<Vector3<f64>>, second: Unit<Vector3<f64>>) -> Joint {
    match kind {
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
    }
}

/// The frame on a link to which `keys` lead.
pub(super) fn mount(file: &SceneFile, keys: &[&str], item: &MountItem, faults: &mut Faults<'_>) -> Option<Mount> {
    let below = |more: &[&'static str]| [keys, more].concat();
    let link = match item.link.as_deref() {
        None | Some("ground") => Linkage::GROUND,
        Some(link) => match file.links.get_index_of(link) {
            Some(k) => LinkHandle(Some(k)),
            None => {
                let known = file.links.keys().map(String::as_str);
                let left_out: Vec<&str> = faults.lacking("links").collect();
                if !left_out.contains(&link) && !faults.lacks_all("links") {
                    let message = unknown("link", link, known.chain(left_out).chain(["ground"]));
                    faults.add(&below(&["link"]), message);
                }
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
                faults.add(&below(&["turn", "axis"]), message);
                return None;
            };
            Pose {
                rotation: *Rotation3::from_axis_angle(&axis, turn.angle.0).matrix(),
                origin: Vector3::from(item.point),
            }
        }
        (Some(_), Some(_)) => {
            faults.add(&below(&["turn"]), "says again what `rotation` says; give one of them");
            return None;
        }
    };
    let defect = pose.defect();
    if defect.is_nan() || defect > 1e-9 {
        let message = format!(
            "point and rotation must be finite and the rotation proper, but it is off by {defect:e} (allowed: 1e-9)"
        );
        faults.add(keys, message);
        return None;
    }
    Some(Mount { link, pose })
}

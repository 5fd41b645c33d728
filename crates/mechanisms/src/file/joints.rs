//! The joints of a scene file: what they are, where they sit, which of them carry links.

use super::clearance;
use super::fault::{Faults, nearest, unknown};
use super::format::{JointItem, Kind, MountItem, SceneFile};
use super::links::Links;
use super::loads::{self, Sitting};
use super::names::unread;
use crate::clearance::Clearance;
use crate::linkage::{Linkage, Mount};
use crate::spanning::{Edge, Role, backwards, spanning_tree};
use linkdyn_kinematics::{Joint, Pose};
use nalgebra::{Rotation3, Unit, Vector3};
use std::collections::HashSet;
use std::f64::consts::TAU;

/// A joint as the file has it.
struct Read<'f> {
    name: &'f str,
    item: &'f JointItem,
    joint: Joint,
    predecessor: Mount,
    successor: Mount,
    sitting: Sitting,
    clearance: Option<Clearance>,
}

/// Adds all joints, in the order of the file. Which of them are cut is judged only where all could be read. The result are the names of
/// those that are.
pub(super) fn add(file: &SceneFile, links: &Links, linkage: &mut Linkage, faults: &mut Faults<'_>) -> Vec<String> {
    let mut read = Vec::new();
    let mut coordinates = HashSet::new();
    for (name, item) in &file.joints {
        let mut joint = if unread(name, faults) {
            None
        } else {
            joint(name, item, faults)
        };
        let predecessor = mount(links, &["joints", name, "predecessor"], &item.predecessor, faults);
        let successor = mount(links, &["joints", name, "successor"], &item.successor, faults);
        if let (Some(one), Some(two)) = (predecessor, successor)
            && one.link == two.link
        {
            let message = "has the same link as the predecessor; a joint connects two";
            faults.add(&["joints", name, "successor"], message);
            joint = None;
        }
        let sitting = loads::read(name, item, faults);
        let clearance = item
            .clearance
            .as_ref()
            .and_then(|clearance| clearance::read(name, clearance, faults));
        if item.clearance.is_some() && !unread(name, faults) && item.kind != Kind::Revolute {
            let message = "goes with revolute joints only";
            faults.add(&["joints", name, "clearance"], message);
        }
        if item.clearance.is_some() && item.cut == Some(false) {
            let message = "a joint with clearance is cut; leave `cut` out";
            faults.add(&["joints", name, "cut"], message);
        }
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
                clearance,
            });
        }
    }
    if read.len() < file.joints.len() || faults.lacks(&["joints"]) || faults.lacks_all(&["links"]) {
        return Vec::new();
    }
    // The joints in beams, which stand in the linkage already, carry as they are.
    let inner = linkage.joints.iter().map(|joint| Edge {
        predecessor: joint.predecessor.link.0,
        successor: joint.successor.link.0,
        freedoms: joint.joint.speeds(),
        cut: Some(false),
        backwards: false,
    });
    let outer = read.iter().map(|read| {
        let told = read.item.cut.or(sits_on_coordinates(read.item).map(|_| false));
        Edge {
            predecessor: read.predecessor.link.0,
            successor: read.successor.link.0,
            freedoms: read.joint.speeds(),
            cut: if read.item.clearance.is_some() {
                Some(true)
            } else {
                told
            },
            backwards: backwards(read.joint).is_some(),
        }
    });
    let edges: Vec<Edge> = inner.chain(outer).collect();
    let mut roles = spanning_tree(linkage.links.len(), &edges);
    connected(links, &edges, &roles, faults);
    let inner = linkage.joints.len();
    for (joint, _) in linkage
        .joints
        .iter()
        .zip(&roles)
        .filter(|(_, role)| **role != Role::Carries)
    {
        let (link, _) = joint.name.rsplit_once('.').unwrap_or((&joint.name, ""));
        let message = "its beginning must hang nearer to the ground than its end; let the beam run the other way";
        faults.add(&["links", link, "beam"], message);
    }
    roles.drain(..inner);
    let mut cut = Vec::new();
    for (read, role) in read.into_iter().zip(roles) {
        let (name, item) = (read.name, read.item);
        let (one, two) = (read.predecessor, read.successor);
        match role {
            Role::Cut => {
                if item.cut == Some(false) && item.clearance.is_none() {
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
                let joint = linkage.cut(name, read.joint, one, two);
                if let Some(clearance) = read.clearance {
                    linkage.clearance(joint, clearance);
                }
                cut.push(name.to_owned());
            }
            Role::Carries => {
                let joint = linkage.joint(name, read.joint, one, two);
                read.sitting.put(joint, linkage);
            }
            Role::CarriesBackwards => match backwards(read.joint) {
                Some((kind, exchanged)) => {
                    let joint = linkage.joint(name, kind, two, one);
                    let mut sitting = read.sitting;
                    if exchanged {
                        sitting.exchange(name, item.kind);
                    }
                    sitting.put(joint, linkage);
                }
                None => {
                    let message = "hangs nearer to the ground than the predecessor, which joints of this kind cannot carry; exchange \
                                   predecessor and successor";
                    faults.add(&["joints", name, "successor"], message);
                }
            },
        }
    }
    cut
}

/// Refuses links that hang on nothing.
fn connected(links: &Links, edges: &[Edge], roles: &[Role], faults: &mut Faults<'_>) {
    let carried = edges.iter().zip(roles).filter_map(|(edge, role)| match role {
        Role::Carries => edge.successor,
        Role::CarriesBackwards => edge.predecessor,
        Role::Cut => None,
    });
    let carried: HashSet<usize> = carried.collect();
    for name in links.names() {
        if links
            .find(name)
            .and_then(|link| link.0)
            .is_some_and(|link| !carried.contains(&link))
        {
            let message = "no chain of joints that are not cut leads from it to the ground";
            faults.add(&["links", name], message);
        }
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
        (item.prescribed.is_some(), "prescribed"),
    ];
    there.into_iter().find_map(|(there, key)| there.then_some(key))
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
    match item.lead {
        Some(lead) if item.kind != Kind::Screw || !lead.is_finite() => {
            let message =
                format!("{lead}: a screw has a lead, a finite number of metres a turn, and no other joint has one");
            faults.add(&["joints", name, "lead"], message);
        }
        None if item.kind == Kind::Screw => {
            faults.add(&["joints", name], "a screw needs its `lead`, in metres a turn");
        }
        _ => {}
    }
    let joint = of_kind(item.kind, first?, second?, item.lead.unwrap_or_default());
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
    of_kind(kind, first, second, 0.0)
}

fn of_kind(kind: Kind, first: Unit<Vector3<f64>>, second: Unit<Vector3<f64>>, lead: f64) -> Joint {
    match kind {
        Kind::Fixed => Joint::Fixed,
        Kind::Revolute => Joint::Revolute { axis: first },
        Kind::Prismatic => Joint::Prismatic { axis: first },
        Kind::Screw => Joint::Screw {
            axis: first,
            pitch: lead / TAU,
        },
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
pub(super) fn mount(links: &Links, keys: &[&str], item: &MountItem, faults: &mut Faults<'_>) -> Option<Mount> {
    let below = |more: &[&'static str]| [keys, more].concat();
    let link_name = item.link.as_deref().unwrap_or("ground");
    let link = links.find(link_name);
    if link.is_none() && !faults.lacks_all(&["links"]) {
        let known = || links.names().chain(["ground"]);
        let message = unknown("link", link_name, nearest(link_name, known()), known());
        faults.add(&below(&["link"]), message);
    }
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
    if !item.end {
        return Some(Mount { link: link?, pose });
    }
    let mount = links.at_end(link_name, pose);
    if mount.is_none() && link.is_some() && !faults.lacks(&["links", link_name]) {
        faults.add(&below(&["end"]), "only a beam has an end");
    }
    mount
}

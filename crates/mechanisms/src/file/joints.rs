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

impl Read<'_> {
    /// See [`backwards`]; coordinates that clearance adds are those of the successor's frame in the predecessor's.
    fn backwards(&self) -> Option<(Joint, bool)> {
        backwards(self.joint).filter(|_| self.clearance.is_none())
    }
}

/// Adds all joints, in the order of the file. Which of them are cut is judged only where all could be read. The result are the names of
/// those that are, where that was judged.
pub(super) fn add(
    file: &SceneFile,
    links: &Links,
    linkage: &mut Linkage,
    faults: &mut Faults<'_>,
) -> Option<Vec<String>> {
    let mut read = Vec::new();
    let inner = linkage.joints.len();
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
        let kind = (!unread(name, faults)).then_some(item.kind);
        let clearance = item.clearance.as_ref();
        let clearance = clearance.and_then(|clearance| clearance::read(name, kind, clearance, faults));
        if item.clearance.is_some() && item.friction.is_some() {
            let message = "needs the reaction of an ideal joint; with `clearance` give that a `friction`";
            faults.add(&["joints", name, "friction"], message);
        }
        if linkage.joints[..inner].iter().any(|joint| joint.name == *name) {
            let message = format!("the name `{name}` is used twice: it is that of a joint in a beam");
            faults.add(&["joints", name], message);
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
        return None;
    }
    // The joints in beams, which stand in the linkage already, carry as they are.
    let carrying = linkage.joints.iter().map(|joint| Edge {
        predecessor: joint.predecessor.link.0,
        successor: joint.successor.link.0,
        freedoms: joint.joint.speeds(),
        cut: Some(false),
        backwards: false,
    });
    let outer = read.iter().map(|read| {
        let item = read.item;
        let told = item.cut.or(sits_on_coordinates(item).map(|_| false));
        Edge {
            predecessor: read.predecessor.link.0,
            successor: read.successor.link.0,
            freedoms: read.joint.speeds(),
            cut: told.or(item.clearance.is_some().then_some(true)),
            backwards: read.backwards().is_some(),
        }
    });
    let edges: Vec<Edge> = carrying.chain(outer).collect();
    let mut roles = spanning_tree(linkage.links.len(), &edges);
    let by_clearance = |read: &&Read<'_>| read.item.clearance.is_some() && read.item.cut.is_none();
    let loose = read.iter().filter(by_clearance);
    let loose: HashSet<usize> = loose
        .flat_map(|read| [read.predecessor.link.0, read.successor.link.0])
        .flatten()
        .collect();
    connected(links, &edges, &roles, &loose, faults);
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
                let joint = linkage.cut(name, read.joint, one, two);
                if let Some(clearance) = read.clearance {
                    linkage.clearance(joint, clearance);
                }
                cut.push(name.to_owned());
            }
            Role::Carries => {
                let joint = linkage.joint(name, read.joint, one, two);
                read.sitting.put(joint, linkage);
                if let Some(clearance) = read.clearance {
                    linkage.clearance(joint, clearance);
                }
            }
            Role::CarriesBackwards => match read.backwards() {
                Some((kind, exchanged)) => {
                    let joint = linkage.joint(name, kind, two, one);
                    let mut sitting = read.sitting;
                    if exchanged {
                        sitting.exchange(name, item.kind);
                    }
                    sitting.put(joint, linkage);
                }
                None => {
                    let what = if read.clearance.is_some() {
                        "a joint with clearance"
                    } else {
                        "joints of this kind"
                    };
                    let message = format!(
                        "hangs nearer to the ground than the predecessor, which {what} cannot carry; exchange predecessor and successor"
                    );
                    faults.add(&["joints", name, "successor"], message);
                }
            },
        }
    }
    Some(cut)
}

/// Refuses links that hang on nothing; those in `loose` have a joint that is cut for its clearance alone.
fn connected(links: &Links, edges: &[Edge], roles: &[Role], loose: &HashSet<usize>, faults: &mut Faults<'_>) {
    let carried = edges.iter().zip(roles).filter_map(|(edge, role)| match role {
        Role::Carries => edge.successor,
        Role::CarriesBackwards => edge.predecessor,
        Role::Cut => None,
    });
    let carried: HashSet<usize> = carried.collect();
    for name in links.names() {
        let hangs = |link: usize| carried.contains(&link);
        if let Some(link) = links.find(name).and_then(|link| link.0).filter(|link| !hangs(*link)) {
            let message = "no chain of joints that are not cut leads from it to the ground";
            let hint = if loose.contains(&link) {
                "; write `cut = false` where a joint with clearance shall carry a link"
            } else {
                ""
            };
            faults.add(&["links", name], format!("{message}{hint}"));
        }
    }
}

/// Refuses names of contact points that are used twice: `A1` is one of a joint `A` with spatial clearance, and that of a joint `A1`.
pub(super) fn contact_names(linkage: &Linkage, faults: &mut Faults<'_>) {
    let mut seen = HashSet::new();
    for (joint, name) in linkage.contact_points() {
        if !seen.insert(name.clone()) {
            let message = format!("the name `{name}` of a contact point is used twice; give the joint another name");
            faults.add(&["joints", joint], message);
        }
    }
}

/// The key of something that needs the joint's coordinates.
fn sits_on_coordinates(item: &JointItem) -> Option<&'static str> {
    let there = [
        (!item.drives.is_empty(), "drives"),
        (!item.springs.is_empty(), "springs"),
        (item.friction.is_some() && item.clearance.is_none(), "friction"),
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
    let lead = item.lead.unwrap_or_default();
    if item.lead.is_some() && (item.kind != Kind::Screw || !lead.is_finite()) {
        let message =
            format!("{lead}: a screw has a lead, a finite number of metres a turn, and no other joint has one");
        faults.add(&["joints", name, "lead"], message);
    } else if item.lead.is_none() && item.kind == Kind::Screw {
        faults.add(&["joints", name], "a screw needs its `lead`, in metres a turn");
    }
    let joint = of_kind(item.kind, first?, second?, if lead.is_finite() { lead } else { 0.0 });
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

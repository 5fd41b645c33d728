//! The names that a scene file may use for coordinates.

use super::fault::{Faults, unknown};
use super::format::{JointItem, SceneFile};
use super::joints::any_of_kind;
use crate::linkage::qualified;
use toml::de::DeTable;

/// Names of coordinates, as far as they are known.
pub(super) struct Names {
    known: Vec<String>,
    /// Joints whose coordinates are not known, because they could not be read.
    unread: Vec<String>,
    /// Whether anything may be the name of a coordinate.
    any: bool,
}

impl Names {
    /// Refuses a name that no coordinate can have.
    pub fn check(&self, keys: &[&str], name: &str, faults: &mut Faults<'_>) {
        let of_unread = |joint: &String| {
            name.strip_prefix(joint.as_str())
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        if !(self.any || self.known.iter().any(|known| known == name) || self.unread.iter().any(of_unread)) {
            faults.add(keys, unknown("coordinate", name, self.known.iter().map(String::as_str)));
        }
    }
}

fn of_joint(name: &str, item: &JointItem) -> Vec<String> {
    let default = || qualified(name, any_of_kind(item.kind).coordinate_names());
    item.coordinates.clone().unwrap_or_else(default)
}

/// The names that the joints of a file give, without those in `cut`. `given` is the table of the whole text: a joint that could not be
/// read may still name its coordinates in it.
pub(super) fn coordinates(file: &SceneFile, cut: &[String], given: &DeTable<'_>, faults: &Faults<'_>) -> Names {
    let carrying = file.joints.iter().filter(|(name, _)| !cut.contains(name));
    let mut names = Names {
        known: carrying.flat_map(|(name, item)| of_joint(name, item)).collect(),
        unread: Vec::new(),
        any: file.joints.is_empty() && faults.lacks(&["joints"]),
    };
    let joints = given.iter().find(|(key, _)| key.get_ref() == "joints");
    for name in faults.lacking("joints") {
        let joint = joints.and_then(|(_, joints)| joints.get_ref().get(name));
        match joint.and_then(|joint| joint.get_ref().get("coordinates")?.get_ref().as_array()) {
            Some(list) => names
                .known
                .extend(list.iter().filter_map(|name| Some(name.get_ref().as_str()?.to_owned()))),
            None => names.unread.push(name.to_owned()),
        }
    }
    for (name, _) in &file.joints {
        names.any |= faults.lacks(&["joints", name, "coordinates"]);
    }
    names
}

//! The names that a scene file may use for coordinates.

use super::fault::{Faults, nearest, unknown};
use super::format::SceneFile;
use super::joints::any_of_kind;
use crate::linkage::{Linkage, qualified};

/// Names of coordinates, as far as they are known.
pub(super) struct Names {
    known: Vec<String>,
    /// Joints and beams whose coordinates are not known.
    unread: Vec<String>,
    /// Whether anything may be the name of a coordinate.
    any: bool,
}

impl Names {
    /// The names of the turns in beams, which are all joints that the linkage has so far.
    pub fn of_beams(file: &SceneFile, linkage: &Linkage, faults: &Faults<'_>) -> Self {
        Self {
            known: linkage.joints.iter().flat_map(|joint| joint.coordinates()).collect(),
            unread: file
                .links
                .keys()
                .filter(|name| faults.lacks(&["links", name]))
                .cloned()
                .collect(),
            any: faults.lacks_all(&["joints"]) || faults.lacks_all(&["links"]),
        }
    }

    /// The names that the joints of a file give, without those in `cut`.
    pub fn add_joints(&mut self, file: &SceneFile, cut: &[String], faults: &Faults<'_>) {
        for (name, item) in file.joints.iter().filter(|(name, _)| !cut.contains(name)) {
            self.any |= faults.lacks(&["joints", name, "coordinates"]);
            match &item.coordinates {
                Some(given) => self.known.extend(given.iter().cloned()),
                None if unread(name, faults) => self.unread.push(name.clone()),
                None => self
                    .known
                    .extend(qualified(name, any_of_kind(item.kind).coordinate_names())),
            }
        }
    }

    /// Refuses a name that no coordinate can have.
    pub fn check(&self, keys: &[&str], name: &str, faults: &mut Faults<'_>) {
        let of_unread = |joint: &String| {
            let rest = name.strip_prefix(joint.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let known = || self.known.iter().map(String::as_str);
        if !(self.any || known().any(|known| known == name) || self.unread.iter().any(of_unread)) {
            faults.add(keys, unknown("coordinate", name, nearest(name, known()), known()));
        }
    }
}

/// Whether the kind of a joint is not known.
pub(super) fn unread(joint: &str, faults: &Faults<'_>) -> bool {
    faults.lacks(&["joints", joint, "kind"]) || faults.lacks_all(&["joints", joint])
}

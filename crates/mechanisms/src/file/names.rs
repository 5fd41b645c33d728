//! The names that a scene file may use for coordinates.

use super::fault::{Faults, nearest, unknown};
use super::format::SceneFile;
use super::joints::any_of_kind;
use crate::clearance::carried;
use crate::linkage::Linkage;
use std::collections::HashSet;

/// Names of coordinates, as far as they are known.
#[derive(Default)]
pub(super) struct Names {
    /// In the order of the file, those in beams first.
    known: Vec<String>,
    all: HashSet<String>,
    /// The first coordinate of a joint that is not one in a beam and not one that clearance adds.
    pub first: Option<String>,
    /// Joints and beams whose coordinates are not known.
    unread: Vec<String>,
    /// Whether anything may be the name of a coordinate.
    any: bool,
}

impl Names {
    /// The names of the turns in beams, which are all joints that the linkage has so far.
    pub fn of_beams(file: &SceneFile, linkage: &Linkage, faults: &mut Faults<'_>) -> Self {
        let mut names = Self {
            any: faults.lacks_all(&["joints"]) || faults.lacks_all(&["links"]),
            ..Self::default()
        };
        for (name, item) in file.links.iter().filter(|(name, _)| faults.lacks(&["links", name])) {
            names.unread.push(name.clone());
            let given = item.beam.iter().flat_map(|beam| &beam.coordinates).flatten();
            names.unread.extend(given.cloned());
        }
        for joint in &linkage.joints {
            let (beam, _) = joint.name.rsplit_once('.').unwrap_or((&joint.name, ""));
            for name in joint.coordinates() {
                names.put(&["links", beam, "beam", "coordinates"], name, faults);
            }
        }
        names
    }

    /// The names that the joints of a file give, without those in `cut`, if that was judged.
    pub fn add_joints(&mut self, file: &SceneFile, cut: Option<&[String]>, faults: &mut Faults<'_>) {
        for (name, item) in &file.joints {
            let given = item.coordinates.as_deref();
            if cut.is_some_and(|cut| cut.contains(name)) {
                // Refused already.
                self.all.extend(given.into_iter().flatten().cloned());
                continue;
            }
            self.any |= faults.lacks(&["joints", name, "coordinates"]);
            let keys = ["joints", name, "coordinates"];
            let new = if unread(name, faults) {
                if given.is_none() || item.clearance.is_some() {
                    self.unread.push(name.clone());
                }
                given.map(<[String]>::to_vec).unwrap_or_default()
            } else {
                let clearance = item.clearance.as_ref();
                let model = clearance.and_then(|clearance| clearance.model(item.kind));
                let kind = any_of_kind(item.kind);
                let own = carried::names(name, &kind, None, given);
                self.first = self.first.take().or(own.into_iter().next());
                carried::names(name, &kind, model, given)
            };
            for coordinate in new {
                // A joint may be cut after all, and then has no coordinates.
                if cut.is_some() || given.is_some_and(|given| given.contains(&coordinate)) {
                    self.put(&keys, coordinate, faults);
                } else if self.all.insert(coordinate.clone()) {
                    self.known.push(coordinate);
                }
            }
        }
    }

    fn put(&mut self, keys: &[&str], name: String, faults: &mut Faults<'_>) {
        if self.all.insert(name.clone()) {
            self.known.push(name);
        } else {
            faults.add(keys, format!("the name `{name}` is used twice"));
        }
    }

    /// Refuses a name that no coordinate can have.
    pub fn check(&self, keys: &[&str], name: &str, faults: &mut Faults<'_>) {
        let of_unread = |joint: &String| {
            let rest = name.strip_prefix(joint.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        if !(self.any || self.all.contains(name) || self.unread.iter().any(of_unread)) {
            let known = || self.known.iter().map(String::as_str);
            faults.add(keys, unknown("coordinate", name, nearest(name, known()), known()));
        }
    }
}

/// Whether the kind of a joint is not known.
pub(super) fn unread(joint: &str, faults: &Faults<'_>) -> bool {
    faults.lacks(&["joints", joint, "kind"]) || faults.lacks_all(&["joints", joint])
}

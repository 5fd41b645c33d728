//! The topology of a linkage as text.

use crate::clearance::Clearance;
use crate::linkage::{CutItem, JointItem, LinkHandle, Linkage};
use crate::point_load::Acts;
use linkdyn_kinematics::Joint;
use std::fmt::Write;

impl Linkage {
    /// The tree of links from the ground, one a line behind the joint that carries it and what sits in that, then the cut joints, then
    /// forces, moments and struts. A beam is one link; links without a way to the ground are left out.
    pub fn outline(&self) -> String {
        if let Some(chosen) = self.with_cuts_chosen() {
            return chosen.outline_of_tree();
        }
        self.outline_of_tree()
    }

    fn outline_of_tree(&self) -> String {
        let mut text = "ground\n".to_owned();
        let mut carried: Vec<Vec<usize>> = vec![Vec::new(); self.links.len() + 1];
        let place = |link: LinkHandle| link.0.map_or(0, |k| k + 1);
        for (k, joint) in self.joints.iter().enumerate().rev() {
            if let Some(list) = carried.get_mut(place(joint.predecessor.link)) {
                list.push(k);
            }
        }
        let beams = self.beams_of_links();
        let beam = |link: LinkHandle| link.0.and_then(|k| beams.get(k).copied().flatten());
        // Each link's joints are taken from their list, so that descriptions that are no tree end as well.
        let mut open: Vec<(usize, LinkHandle)> = vec![(1, Self::GROUND)];
        while let Some((depth, link)) = open.pop() {
            let Some(k) = carried.get_mut(place(link)).and_then(Vec::pop) else {
                continue;
            };
            let item = &self.joints[k];
            let next = item.successor.link;
            open.push((depth, link));
            if beam(link).is_some() && beam(link) == beam(next) {
                open.push((depth, next));
                continue;
            }
            let (indent, name) = (2 * depth, self.outlined(next, &beams));
            let long = beam(next).map_or_else(String::new, |k| {
                format!(" (beam of {} elements)", self.beams[k].1.len().saturating_sub(1))
            });
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{:indent$}{} ({}) - {name}{long}", "", item.name, described(item));
            open.push((depth + 1, next));
        }
        for cut in &self.cuts {
            let [one, two] = [&cut.predecessor, &cut.successor].map(|mount| self.outlined(mount.link, &beams));
            let kind = described_cut(cut);
            let _ = writeln!(text, "cut: {one} - {} ({kind}) - {two}", cut.name);
        }
        for (name, acts, load) in &self.point_loads {
            let what = match acts {
                Acts::Force => "force",
                Acts::Moment => "moment",
            };
            let _ = writeln!(text, "{what}: {name} on {}", self.outlined(load.at.link, &beams));
        }
        for (name, strut) in &self.struts {
            let [one, two] = [&strut.from, &strut.to].map(|mount| self.outlined(mount.link, &beams));
            let _ = writeln!(text, "strut: {one} - {name} - {two}");
        }
        text
    }

    /// Which beam each link is an element of.
    fn beams_of_links(&self) -> Vec<Option<usize>> {
        let mut beams = vec![None; self.links.len()];
        for (k, (_, elements)) in self.beams.iter().enumerate() {
            for link in elements.iter().filter_map(|element| element.0) {
                if let Some(beam) = beams.get_mut(link) {
                    *beam = Some(k);
                }
            }
        }
        beams
    }

    /// Name of a link, for an element that of its beam.
    fn outlined(&self, link: LinkHandle, beams: &[Option<usize>]) -> String {
        match link.0.and_then(|k| beams.get(k).copied().flatten()) {
            Some(beam) => self.beams[beam].0.clone(),
            None => self.link_name(link),
        }
    }
}

/// Kind of a joint of the tree, and what sits in it.
pub(crate) fn described(item: &JointItem) -> String {
    let mut words = kind(&item.joint).to_owned();
    for (there, word) in [
        (!item.drives.is_empty(), "driven"),
        (item.prescribed.is_some(), "prescribed motion"),
        (!item.springs.is_empty(), "sprung"),
        (item.friction.is_some(), "friction"),
        (item.limit.is_some(), "stops"),
    ] {
        if there {
            words = words + ", " + word;
        }
    }
    with_clearance(words, item.clearance.as_ref())
}

/// Kind of a cut joint, and of its clearance.
pub(crate) fn described_cut(item: &CutItem) -> String {
    match item.rows {
        None => with_clearance(kind(&item.joint).to_owned(), item.clearance.as_ref()),
        Some(_) => "its own equations".into(),
    }
}

fn with_clearance(words: String, clearance: Option<&Clearance>) -> String {
    match clearance {
        None => words,
        Some(clearance) => format!("{words}, {} clearance", clearance.model.name()),
    }
}

/// Kind of a joint, for messages.
pub(crate) fn kind(joint: &Joint) -> &'static str {
    match joint {
        Joint::Fixed => "fixed",
        Joint::Revolute { .. } => "revolute",
        Joint::Prismatic { .. } => "prismatic",
        Joint::Cylindrical { .. } => "cylindrical",
        Joint::Universal { .. } => "universal",
        Joint::SphericalZyx => "spherical zyx",
        Joint::Spherical => "spherical",
        Joint::Planar { .. } => "planar",
        Joint::Free => "free",
        Joint::Screw { .. } => "screw",
    }
}

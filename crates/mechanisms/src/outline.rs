//! The topology of a linkage as text.

use crate::clearance::Clearance;
use crate::linkage::{LinkHandle, Linkage};
use linkdyn_kinematics::Joint;
use std::fmt::Write;

impl Linkage {
    /// The tree of links from the ground, one a line behind the joint that carries it, then the cut joints. Links without a way to
    /// the ground are left out.
    pub fn outline(&self) -> String {
        if let Some(chosen) = self.with_cuts_chosen() {
            return chosen.outline_of_tree();
        }
        self.outline_of_tree()
    }

    fn outline_of_tree(&self) -> String {
        let mut text = "ground\n".to_owned();
        // A joint is drawn once, so that descriptions that are no tree end as well.
        let mut drawn = vec![false; self.joints.len()];
        let mut open: Vec<(usize, LinkHandle)> = vec![(1, Self::GROUND)];
        while let Some((depth, link)) = open.pop() {
            let next = (0..self.joints.len()).find(|&k| !drawn[k] && self.joints[k].predecessor.link == link);
            if let Some(k) = next {
                drawn[k] = true;
                let item = &self.joints[k];
                let kind = described(&item.joint, item.clearance.as_ref());
                let (indent, carried) = (2 * depth, self.link_name(item.successor.link));
                // Writing to a string cannot fail.
                let _ = writeln!(text, "{:indent$}{} ({kind}) - {carried}", "", item.name);
                open.push((depth, link));
                open.push((depth + 1, item.successor.link));
            }
        }
        for cut in &self.cuts {
            let (one, two) = (self.link_name(cut.predecessor.link), self.link_name(cut.successor.link));
            let kind = match cut.rows {
                None => described(&cut.joint, cut.clearance.as_ref()),
                Some(_) => "its own equations".into(),
            };
            let _ = writeln!(text, "cut: {one} - {} ({kind}) - {two}", cut.name);
        }
        text
    }
}

/// Kind of a joint and of its clearance.
pub(crate) fn described(joint: &Joint, clearance: Option<&Clearance>) -> String {
    match clearance {
        None => kind(joint).to_owned(),
        Some(clearance) => format!("{}, {} clearance", kind(joint), clearance.model.name()),
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

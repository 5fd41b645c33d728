//! Which joints of a linkage carry its links and which are cut.

use crate::linkage::{CutItem, JointItem, Linkage};
use linkdyn_kinematics::Joint;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A joint between two links, as far as the choice of cuts sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// One side; `None` is the ground.
    pub predecessor: Option<usize>,
    /// The other side.
    pub successor: Option<usize>,
    /// Number of freedoms.
    pub freedoms: usize,
    /// Whether the joint must be cut (or carried) as its user says.
    pub cut: Option<bool>,
    /// Whether it can carry its predecessor from the successor's side.
    pub backwards: bool,
}

/// What becomes of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// It carries its successor.
    Carries,
    /// It carries its predecessor, from the successor's side.
    CarriesBackwards,
    /// It closes a loop by equations.
    Cut,
}

/// Chooses a spanning tree of `links` links from the ground. Step by step a link is hung on those that hang already: first by a
/// joint that shall not be cut, then by the joint with the fewest freedoms, so that the cut joints are those with many and so
/// with few equations; among equals where the link hangs on the fewest joints, then in the order of `joints`.
///
/// Links without a way to the ground stay without a joint that carries them; a joint that shall not be cut is cut all the same
/// if both its links hang already.
pub fn spanning_tree(links: usize, joints: &[Edge]) -> Vec<Role> {
    let mut roles = vec![Role::Cut; joints.len()];
    let mut depths: Vec<Option<usize>> = vec![None; links];
    let mut ends: Vec<Vec<usize>> = vec![Vec::new(); links];
    // How many joints shall carry a link that cannot but carry their successor.
    let mut bound = vec![0; links];
    let one_way = |joint: &Edge| !joint.backwards && joint.cut == Some(false);
    for (k, joint) in joints.iter().enumerate() {
        for link in [joint.predecessor, joint.successor].into_iter().flatten() {
            if let Some(ends) = ends.get_mut(link) {
                ends.push(k);
            }
        }
        if let Some(bound) = joint.successor.and_then(|link| bound.get_mut(link)) {
            *bound += usize::from(one_way(joint));
        }
    }
    let depth = |depths: &[Option<usize>], link: Option<usize>| match link {
        None => Some(0),
        Some(k) => depths.get(k).copied().flatten(),
    };
    // A joint that could hang a link on what hangs already, the first one to be taken the least; its rank ends with its own number.
    let candidate = |depths: &[Option<usize>], k: usize| {
        let joint = joints.get(k).filter(|joint| joint.cut != Some(true))?;
        let (role, depth, link) = match (depth(depths, joint.predecessor), depth(depths, joint.successor)) {
            (Some(depth), None) => (Role::Carries, depth, joint.successor?),
            (None, Some(depth)) => (Role::CarriesBackwards, depth, joint.predecessor?),
            _ => return None,
        };
        let own = usize::from(one_way(joint) && joint.successor == Some(link));
        let last = *bound.get(link)? > own || (role == Role::CarriesBackwards && !joint.backwards);
        Some(((last, joint.cut.is_none(), joint.freedoms, depth, k), role, link))
    };
    let mut open: BinaryHeap<_> = (0..joints.len())
        .filter_map(|k| candidate(&depths, k))
        .map(|(rank, ..)| Reverse(rank))
        .collect();
    while let Some(Reverse((.., k))) = open.pop() {
        // Both its links may hang by now.
        let Some(((.., depth, _), role, link)) = candidate(&depths, k) else {
            continue;
        };
        roles[k] = role;
        depths[link] = Some(depth + 1);
        let further = ends[link].iter().filter_map(|&k| candidate(&depths, k));
        open.extend(further.map(|(rank, ..)| Reverse(rank)));
    }
    roles
}

/// The same joint with exchanged sides and coordinates that mean the same, where there is one, and whether their order is the opposite.
/// Coordinates of balls, planes and free links would have to say how the predecessor moves against the successor.
pub(crate) fn backwards(joint: Joint) -> Option<(Joint, bool)> {
    match joint {
        Joint::Revolute { axis } => Some((Joint::Revolute { axis: -axis }, false)),
        Joint::Prismatic { axis } => Some((Joint::Prismatic { axis: -axis }, false)),
        Joint::Cylindrical { axis } => Some((Joint::Cylindrical { axis: -axis }, false)),
        Joint::Screw { axis, pitch } => Some((Joint::Screw { axis: -axis, pitch }, false)),
        Joint::Universal { first, second } => {
            let (first, second) = (-second, -first);
            Some((Joint::Universal { first, second }, true))
        }
        Joint::Fixed => Some((Joint::Fixed, false)),
        _ => None,
    }
}

impl Linkage {
    /// The same linkage with as many joints cut as its loops need, where its joints make no tree; see [`Linkage::joint`]. What cannot be
    /// made a tree so stays as it is, for [`Linkage::build`] to refuse.
    pub(crate) fn with_cuts_chosen(&self) -> Option<Self> {
        let mut carried = vec![false; self.links.len()];
        let once = |joint: &JointItem| {
            let place = joint.successor.link.0.and_then(|link| carried.get_mut(link));
            place.is_some_and(|place| !std::mem::replace(place, true))
        };
        if self.joints.iter().all(once) {
            return None;
        }
        let edge = |joint: &JointItem| Edge {
            predecessor: joint.predecessor.link.0,
            successor: joint.successor.link.0,
            freedoms: joint.joint.speeds(),
            cut: joint.must_carry().then_some(false),
            // The offsets of a joint with clearance are those of its successor.
            backwards: joint.clearance.is_none() && backwards(joint.joint).is_some(),
        };
        let edges: Vec<Edge> = self.joints.iter().map(edge).collect();
        let mut chosen = self.clone();
        chosen.joints.clear();
        let roles = spanning_tree(self.links.len(), &edges);
        for ((item, edge), role) in self.joints.iter().zip(&edges).zip(roles) {
            match (role, backwards(item.joint).filter(|_| edge.backwards)) {
                (Role::CarriesBackwards, Some((joint, exchanged))) => {
                    chosen.joints.push(item.clone().turned_round(joint, exchanged));
                }
                (Role::Cut, _) if !item.must_carry() => chosen.cuts.push(CutItem {
                    name: item.name.clone(),
                    joint: item.joint,
                    predecessor: item.predecessor,
                    successor: item.successor,
                    clearance: None,
                    rows: None,
                }),
                _ => chosen.joints.push(item.clone()),
            }
        }
        Some(chosen)
    }
}

impl JointItem {
    /// Whether something sits on its coordinates, or adds to them.
    fn must_carry(&self) -> bool {
        self.coordinate_names.is_some()
            || !self.drives.is_empty()
            || !self.springs.is_empty()
            || self.friction.is_some()
            || self.prescribed.is_some()
            || self.limit.is_some()
            || self.clearance.is_some()
    }

    /// The same as `joint` with exchanged sides, and coordinates in the opposite order where these are exchanged too.
    fn turned_round(mut self, joint: Joint, exchanged: bool) -> Self {
        std::mem::swap(&mut self.predecessor, &mut self.successor);
        if exchanged {
            let mut names = self.coordinates();
            names.reverse();
            self.coordinate_names = Some(names);
            self.springs.reverse();
        }
        self.joint = joint;
        self
    }
}

//! Which joints of a linkage carry its links and which are cut.

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
    // Joints of a link that shall carry it and cannot but carry their successor.
    let one_way =
        |joint: &Edge, link: usize| !joint.backwards && joint.cut == Some(false) && joint.successor == Some(link);
    let mut carriers = vec![0; links];
    for joint in joints {
        if let Some(link) = joint.successor.filter(|&link| link < links && one_way(joint, link)) {
            carriers[link] += 1;
        }
    }
    let bound = |link: usize, k: usize| carriers[link] > usize::from(one_way(&joints[k], link));
    let depth = |depths: &[Option<usize>], link: Option<usize>| match link {
        None => Some(0),
        Some(k) => depths.get(k).copied().flatten(),
    };
    loop {
        let next = joints.iter().enumerate().filter(|(_, joint)| joint.cut != Some(true));
        let next = next.filter_map(|(k, joint)| {
            let before = depth(&depths, joint.predecessor);
            let behind = depth(&depths, joint.successor);
            let (role, depth, link) = match (before, behind) {
                (Some(depth), None) => (Role::Carries, depth, joint.successor?),
                (None, Some(depth)) => (Role::CarriesBackwards, depth, joint.predecessor?),
                _ => return None,
            };
            if link >= links {
                return None;
            }
            let last = bound(link, k) || (role == Role::CarriesBackwards && !joint.backwards);
            Some(((last, joint.cut.is_none(), joint.freedoms, depth, k), role, link))
        });
        let Some(((.., depth, k), role, link)) = next.min_by_key(|&(rank, ..)| rank) else {
            return roles;
        };
        roles[k] = role;
        depths[link] = Some(depth + 1);
    }
}

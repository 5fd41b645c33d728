//! The links of a scene file.

use super::beam;
use super::fault::Faults;
use super::format::{CuboidItem, CylinderItem, LinkItem, SceneFile};
use crate::linkage::{LinkHandle, Linkage, Mount};
use indexmap::IndexMap;
use linkdyn_dynamics::RigidInertia;
use linkdyn_kinematics::Pose;
use nalgebra::{Matrix3, Vector3};
use std::collections::HashSet;

/// How many spring-damping elements all beams of a file may have together, which is what one may have: matrices grow with the square
/// of it, and a short text shall not ask for more memory than there is.
const MOST_ELEMENTS: u32 = 500;

/// The links of a file on their linkage.
pub(super) struct Links {
    /// By name: the link, for a beam its first element, and the end of a beam.
    known: IndexMap<String, (LinkHandle, Option<Mount>)>,
    /// Coordinates of beams that are held straight.
    pub straight: Vec<String>,
}

impl Links {
    /// Adds all links, in the order of the file, beams with the joints in them.
    pub fn add(file: &SceneFile, linkage: &mut Linkage, faults: &mut Faults<'_>) -> Self {
        let mut links = Self {
            known: IndexMap::new(),
            straight: Vec::new(),
        };
        let (mut names, mut elements) = (HashSet::new(), 0);
        for (name, item) in &file.links {
            let first = linkage.links.len();
            if name == "ground" {
                let message = "the ground is there already; give the link another name";
                faults.add(&["links", name], message);
            }
            if ways(item) != 1 {
                let message = "give one of `cylinder`, `box`, `beam`, or `mass` with `centre` and `inertia`";
                faults.add(&["links", name], message);
            }
            let before = linkage.joints.len();
            let flexible = item
                .beam
                .as_ref()
                .and_then(|item| beam::add(name, item, linkage, faults));
            if flexible.is_none() && item.beam.is_some() {
                faults.leave_out(&["links", name, "beam"]);
            }
            let place = match flexible {
                Some(link) => (
                    link.elements.first().copied().unwrap_or(Linkage::GROUND),
                    Some(link.end),
                ),
                None => {
                    let inertia = inertia(name, item, faults).unwrap_or_else(RigidInertia::massless);
                    if let Err(error) = inertia.validate() {
                        faults.add(&["links", name], error.to_string());
                    }
                    let link = linkage.link(name, inertia);
                    (link, item.beam.as_ref().map(|_| Mount::at_origin(link)))
                }
            };
            if item.beam.as_ref().is_some_and(|beam| beam.straight) {
                let turns = linkage.joints[before..].iter().flat_map(|joint| joint.coordinates());
                links.straight.extend(turns);
            }
            links.known.insert(name.clone(), place);
            for (new, _) in &linkage.links[first..] {
                if !names.insert(new.clone()) {
                    let message =
                        format!("the name `{new}` is used twice: elements of a beam are called `BEAM,0` and so on");
                    faults.add(&["links", name], message);
                }
            }
            let before = elements;
            elements += item.beam.as_ref().map_or(0, |beam| u32::from(beam.elements));
            if elements > MOST_ELEMENTS && before <= MOST_ELEMENTS {
                let message = format!("makes {elements} elements in all beams up to here, more than {MOST_ELEMENTS}");
                faults.add(&["links", name, "beam", "elements"], message);
            }
        }
        links
    }

    /// The link of a name; the ground is one.
    pub fn find(&self, name: &str) -> Option<LinkHandle> {
        match name {
            "ground" => Some(Linkage::GROUND),
            _ => self.known.get(name).map(|(link, _)| *link),
        }
    }

    /// Where a frame at the end of a beam sits.
    pub fn at_end(&self, name: &str, pose: Pose) -> Option<Mount> {
        let end = self.known.get(name)?.1?;
        Some(Mount::with_pose(end.link, end.pose * pose))
    }

    /// Names of all links.
    pub fn names(&self) -> impl Iterator<Item = &str> + Clone {
        self.known.keys().map(String::as_str)
    }
}

/// In how many ways the link is given.
fn ways(item: &LinkItem) -> usize {
    let mass = item.mass.is_some();
    let only_mass = item.centre.is_some() || item.inertia.is_some();
    let ways = [
        mass,
        item.cylinder.is_some(),
        item.cuboid.is_some(),
        item.beam.is_some(),
    ];
    // Centre and inertia say nothing without a mass, as a second way.
    ways.into_iter()
        .chain([only_mass && !mass])
        .filter(|there| *there)
        .count()
}

/// Inertia of a rigid link; none where it cannot be.
fn inertia(name: &str, item: &LinkItem, faults: &mut Faults<'_>) -> Option<RigidInertia> {
    let mut positive = |key: &str, parts: &[(&str, f64)]| {
        let mut sound = true;
        for (part, value) in parts.iter().filter(|(_, value)| !(value.is_finite() && *value > 0.0)) {
            let what = if *part == "along" { "its length " } else { "" };
            let message = format!("{what}{value} must be a finite positive number");
            faults.add(&["links", name, key, part], message);
            sound = false;
        }
        sound
    };
    if let Some(CylinderItem {
        density,
        diameter,
        along,
    }) = item.cylinder
    {
        let along = Vector3::from(along);
        let length = along.norm();
        let parts = [("density", density), ("diameter", diameter), ("along", length)];
        return positive("cylinder", &parts).then(|| RigidInertia::solid_cylinder(density, diameter, length, &along));
    }
    if let Some(CuboidItem {
        density,
        size: [x, y, z],
        centre,
    }) = item.cuboid
    {
        let parts = [("density", density), ("size", x), ("size", y), ("size", z)];
        let mass = density * x * y * z;
        let squares = Vector3::new(y * y + z * z, z * z + x * x, x * x + y * y);
        return positive("box", &parts).then(|| RigidInertia {
            mass,
            com: Vector3::from(centre),
            about_com: Matrix3::from_diagonal(&(squares * (mass / 12.0))),
        });
    }
    let rows = item.inertia.unwrap_or_default();
    Some(RigidInertia {
        mass: item.mass?,
        com: Vector3::from(item.centre.unwrap_or_default()),
        about_com: Matrix3::from_fn(|r, c| rows[r][c]),
    })
}

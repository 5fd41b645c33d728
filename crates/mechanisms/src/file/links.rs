//! The links of a scene file.

use super::fault::Faults;
use super::format::{LinkItem, SceneFile};
use crate::linkage::Linkage;
use linkdyn_dynamics::RigidInertia;
use nalgebra::{Matrix3, Vector3};

/// Adds all links, in the order of the file.
pub(super) fn add(file: &SceneFile, linkage: &mut Linkage, faults: &mut Faults<'_>) {
    for (name, item) in &file.links {
        if name == "ground" {
            faults.add(
                &["links", name],
                "the ground is there already; give the link another name",
            );
        }
        let inertia = inertia(name, item, faults).unwrap_or_else(RigidInertia::massless);
        if let Err(error) = inertia.validate() {
            faults.add(&["links", name], error.to_string());
        }
        linkage.link(name, inertia);
    }
}

fn inertia(name: &str, item: &LinkItem, faults: &mut Faults<'_>) -> Option<RigidInertia> {
    match (&item.cylinder, item.mass) {
        (Some(cylinder), None) if item.centre.is_none() && item.inertia.is_none() => {
            let along = Vector3::from(cylinder.along);
            let length = along.norm();
            let mut sound = true;
            for (key, value) in [
                ("density", cylinder.density),
                ("diameter", cylinder.diameter),
                ("along", length),
            ] {
                if !(value.is_finite() && value > 0.0) {
                    let what = if key == "along" { "its length " } else { "" };
                    let message = format!("{what}{value} must be a finite positive number");
                    faults.add(&["links", name, "cylinder", key], message);
                    sound = false;
                }
            }
            sound.then(|| RigidInertia::solid_cylinder(cylinder.density, cylinder.diameter, length, &along))
        }
        (None, Some(mass)) => {
            let rows = item.inertia.unwrap_or_default();
            Some(RigidInertia {
                mass,
                com: Vector3::from(item.centre.unwrap_or_default()),
                about_com: Matrix3::from_fn(|r, c| rows[r][c]),
            })
        }
        _ => {
            let message = "give either `cylinder`, or `mass` with `centre` and `inertia`";
            faults.add(&["links", name], message);
            None
        }
    }
}

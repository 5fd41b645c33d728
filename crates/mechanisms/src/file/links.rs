//! The links of a scene file.

use super::fault::Faults;
use super::format::{CuboidItem, CylinderItem, LinkItem, SceneFile};
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
    let ways = [item.mass.is_some(), item.cylinder.is_some(), item.cuboid.is_some()];
    let only_mass = item.centre.is_some() || item.inertia.is_some();
    if ways.into_iter().filter(|there| *there).count() != 1 || (only_mass && item.mass.is_none()) {
        let message = "give one of `cylinder`, `box`, or `mass` with `centre` and `inertia`";
        faults.add(&["links", name], message);
        return None;
    }
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

//! What sits in the joints of a scene file: drives, springs, friction, limits, prescribed motions.

use super::fault::Faults;
use super::format::{DriveItem, JointItem, Kind};
use super::friction;
use super::joints::any_of_kind;
use super::names::unread;
use super::points;
use super::prescribed;
use crate::drive::Drive;
use crate::limit::Limit;
use crate::linkage::{JointHandle, Linkage, qualified};
use crate::prescribed::PrescribedMotion;
use crate::spline::Spline;
use crate::spring::Spring;
use linkdyn_friction::{Bearing, Friction};

/// What sits in a joint.
pub(super) struct Sitting {
    names: Option<Vec<String>>,
    drives: Vec<Drive>,
    springs: Vec<Spring>,
    friction: Option<(Friction, Bearing)>,
    limit: Option<Limit>,
    prescribed: Option<PrescribedMotion>,
}

/// Reads what sits in a joint, whether or not the joint itself can be read.
pub(super) fn read(name: &str, item: &JointItem, faults: &mut Faults<'_>) -> Sitting {
    if !unread(name, faults) {
        numbers(name, item, faults);
    }
    let drives = drives(&["joints", name, "drives"], &item.drives, faults);
    let springs = item.springs.iter().map(|spring| Spring {
        stiffness: spring.stiffness,
        damping: spring.damping,
        rest: spring.rest.0,
    });
    let springs: Vec<Spring> = springs.collect();
    for (k, spring) in springs.iter().enumerate() {
        if let Some((parameter, value, expected)) = spring.fault() {
            faults.add(
                &["joints", name, "springs", &format!("[{k}]"), key_of(parameter)],
                format!("{parameter} = {value} must be {expected}"),
            );
        }
    }
    let kind = (!unread(name, faults)).then_some(item.kind);
    let friction = item.friction.as_ref();
    let friction = friction.and_then(|friction| friction::read(name, kind, friction, faults));
    let limit = item.limit.as_ref();
    let limit = limit.and_then(|limit| points::limit(&["joints", name, "limit"], limit, faults));
    let prescribed = item.prescribed.as_ref();
    let prescribed = prescribed.and_then(|motion| prescribed::read(name, motion, faults));
    Sitting {
        names: item.coordinates.clone(),
        drives,
        springs,
        friction,
        limit,
        prescribed,
    }
}

/// How many names, springs and so on the joint can have.
fn numbers(name: &str, item: &JointItem, faults: &mut Faults<'_>) {
    let joint = any_of_kind(item.kind);
    let freedoms = joint.coordinates();
    let names = item.coordinates.as_ref().map_or(freedoms, Vec::len);
    let springs = item.springs.len();
    for (key, found) in [("coordinates", names), ("springs", springs)] {
        if key == "springs" && springs > 0 && joint.speeds() != freedoms {
            let message =
                "need a joint whose speeds are the rates of its coordinates; take `spherical_zyx` for a ball joint";
            faults.add(&["joints", name, key], message);
        } else if found != freedoms && (key == "coordinates" || springs > 0) {
            let message = format!("must have one entry for each coordinate of the joint: {freedoms}, not {found}");
            faults.add(&["joints", name, key], message);
        }
    }
    for (key, there) in [
        ("drives", !item.drives.is_empty()),
        ("friction", item.friction.is_some()),
        ("limit", item.limit.is_some()),
        ("prescribed", item.prescribed.is_some()),
    ] {
        if there && freedoms != 1 {
            let message = format!("needs a joint with one coordinate; this one has {freedoms}");
            faults.add(&["joints", name, key], message);
        }
    }
}

impl Sitting {
    /// Puts the coordinates of a joint into the opposite order.
    pub fn exchange(&mut self, name: &str, kind: Kind) {
        let default = || qualified(name, any_of_kind(kind).coordinate_names());
        self.names.get_or_insert_with(default).reverse();
        self.springs.reverse();
    }

    /// Puts all of it into a joint that carries a link.
    pub fn put(self, joint: JointHandle, linkage: &mut Linkage) {
        if let Some(names) = self.names {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            linkage.coordinate_names(joint, &names);
        }
        for drive in self.drives {
            linkage.drive(joint, drive);
        }
        if !self.springs.is_empty() {
            linkage.springs(joint, &self.springs);
        }
        if let Some((characteristic, bearing)) = self.friction {
            linkage.friction(joint, characteristic, bearing);
        }
        if let Some(limit) = self.limit {
            linkage.limit(joint, limit);
        }
        if let Some(motion) = self.prescribed {
            linkage.prescribe(joint, motion);
        }
    }
}

/// The drives to which `keys` lead.
pub(super) fn drives(keys: &[&str], items: &[DriveItem], faults: &mut Faults<'_>) -> Vec<Drive> {
    let drives: Vec<Drive> = items.iter().map(drive).collect();
    for (k, drive) in drives.iter().enumerate() {
        if let Some((parameter, value, expected)) = drive.fault() {
            let message = format!("{parameter} = {value} must be {expected}");
            let (entry, word) = (format!("[{k}]"), kind_of_drive(&items[k]));
            faults.add(&[keys, &[&entry, word, key_of(parameter)]].concat(), message);
        }
    }
    drives
}

/// The key at which a parameter is given.
pub(super) fn key_of(parameter: &'static str) -> &'static str {
    match parameter {
        "node" | "nodes" | "value" => "points",
        "coefficient" => "coefficients",
        other => other,
    }
}

fn kind_of_drive(item: &DriveItem) -> &'static str {
    match item {
        DriveItem::Ramp { .. } => "ramp",
        DriveItem::Constant { .. } => "constant",
        DriveItem::Harmonic { .. } => "harmonic",
        DriveItem::Table { .. } => "table",
        DriveItem::QuadraticResistance { .. } => "quadratic_resistance",
        DriveItem::Resistance { .. } => "resistance",
    }
}

fn drive(item: &DriveItem) -> Drive {
    match *item {
        DriveItem::Ramp { torque, rise_time } => Drive::Ramp { torque, rise_time },
        DriveItem::Constant { torque } => Drive::Constant { torque },
        DriveItem::Harmonic {
            amplitude,
            frequency,
            phase,
        } => Drive::Harmonic {
            amplitude,
            frequency,
            phase: phase.0,
        },
        DriveItem::Table { ref points, monotone } => {
            let nodes: Vec<(f64, f64)> = points.iter().map(|&[t, value]| (t, value)).collect();
            let through = if monotone { Spline::monotone } else { Spline::natural };
            Drive::Table {
                spline: through(&nodes),
            }
        }
        DriveItem::QuadraticResistance {
            torque,
            reference_speed,
        } => Drive::QuadraticResistance {
            torque,
            reference_speed,
        },
        DriveItem::Resistance {
            torque,
            reference_speed,
        } => Drive::Resistance {
            torque,
            reference_speed,
        },
    }
}

//! What sits in the joints of a scene file: drives, springs, friction, limits.

use super::fault::Faults;
use super::format::{DriveItem, FrictionItem, JointItem, SurfaceItem};
use super::joints::any_of_kind;
use super::points;
use crate::drive::Drive;
use crate::limit::Limit;
use crate::linkage::{JointHandle, Linkage};
use crate::spline::Spline;
use crate::spring::Spring;
use linkdyn_friction::{BearingModel, Characteristic, Exponential, JournalBearing, Surface};

/// What sits in a joint.
pub(super) struct Sitting {
    drives: Vec<Drive>,
    springs: Vec<Spring>,
    friction: Option<(Exponential, JournalBearing)>,
    limit: Option<Limit>,
}

/// Reads what sits in a joint, whether or not the joint itself can be read.
pub(super) fn read(name: &str, item: &JointItem, faults: &mut Faults<'_>) -> Sitting {
    let joint = any_of_kind(item.kind);
    let freedoms = joint.coordinates();
    if let Some(names) = item.coordinates.as_ref().filter(|names| names.len() != freedoms) {
        let message = format!("the joint has {freedoms} coordinates, {} names were given", names.len());
        faults.add(&["joints", name, "coordinates"], message);
    }
    for (key, there) in [
        ("drives", !item.drives.is_empty()),
        ("friction", item.friction.is_some()),
        ("limit", item.limit.is_some()),
    ] {
        if there && freedoms != 1 {
            let message = format!("needs a joint with one coordinate; this one has {freedoms}");
            faults.add(&["joints", name, key], message);
        }
    }
    let drives: Vec<Drive> = item.drives.iter().map(drive).collect();
    for (k, drive) in drives.iter().enumerate() {
        if let Some((parameter, value, expected)) = drive.fault() {
            faults.add(
                &["joints", name, "drives", &format!("[{k}]")],
                format!("{parameter} = {value} must be {expected}"),
            );
        }
    }
    let springs = item.springs.iter().map(|spring| Spring {
        stiffness: spring.stiffness,
        damping: spring.damping,
        rest: spring.rest.0,
    });
    let springs: Vec<Spring> = springs.collect();
    for (k, spring) in springs.iter().enumerate() {
        if let Some((parameter, value, expected)) = spring.fault() {
            faults.add(
                &["joints", name, "springs", &format!("[{k}]")],
                format!("{parameter} = {value} must be {expected}"),
            );
        }
    }
    if !springs.is_empty() && joint.speeds() != freedoms {
        let message =
            "need a joint whose speeds are the rates of its coordinates; take `spherical_zyx` for a ball joint";
        faults.add(&["joints", name, "springs"], message);
    } else if !springs.is_empty() && springs.len() != freedoms {
        let message = format!(
            "the joint has {freedoms} coordinates, {} springs were given",
            springs.len()
        );
        faults.add(&["joints", name, "springs"], message);
    }
    let friction = item.friction.as_ref().map(friction);
    if let Some((characteristic, bearing)) = &friction
        && let Err(error) = characteristic.validate().and_then(|()| bearing.validate())
    {
        faults.add(&["joints", name, "friction"], error.to_string());
    }
    let limit = item.limit.as_ref();
    let limit = limit.and_then(|limit| points::limit(&["joints", name, "limit"], limit, faults));
    Sitting {
        drives,
        springs,
        friction,
        limit,
    }
}

impl Sitting {
    /// Puts all of it, and the names of the coordinates, into a joint that carries a link.
    pub fn put(self, joint: JointHandle, item: &JointItem, linkage: &mut Linkage) {
        if let Some(names) = &item.coordinates {
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
    }
}

pub(super) fn drive(item: &DriveItem) -> Drive {
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
            phase,
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

fn friction(item: &FrictionItem) -> (Exponential, JournalBearing) {
    let surface = |surface: SurfaceItem| Surface {
        diameter: surface.diameter,
        coefficient: surface.coefficient,
    };
    let characteristic = Exponential {
        reference_speed: item.exponential.reference_speed,
        steepness: item.exponential.steepness,
    };
    let bearing = JournalBearing {
        spacing: item.journal.spacing,
        surface_a: surface(item.journal.surface_a),
        surface_b: surface(item.journal.surface_b),
        face: surface(item.journal.face),
    };
    (characteristic, bearing)
}

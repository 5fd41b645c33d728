//! RSRRR: the one-freedom loop with four revolute joints and a spherical one of Harlecki and Urbaś, *Dynamic analysis of the
//! RSRRR spatial linkage mechanism with friction in joints*.
//!
//! The paper leaves out the material, the place of the second base, the branch and the shape of the drive; these are completed
//! as steel, (0, -0.30, 0.25) m, `psi23 > 0` and a linear ramp.

use crate::drive::Drive;
use crate::linkage::{Linkage, Mount};
use crate::mechanism::Start;
use crate::scene::{RunSettings, Scene};
use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::{Exponential, JournalBearing, Surface};
use linkdyn_kinematics::{Joint, Pose};
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Variants of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rsrrr {
    /// Whether the revolute joints have friction.
    pub friction: bool,
    /// Factor on all coefficients of friction \[-\].
    pub friction_scale: f64,
}

impl Default for Rsrrr {
    /// Ideal joints.
    fn default() -> Self {
        Self {
            friction: false,
            friction_scale: 1.0,
        }
    }
}

/// Density of steel \[kg/m^3\] (completed).
const STEEL: f64 = 7850.0;
/// Diameter of all links \[m\] (Table 1).
const DIAMETER: f64 = 0.028;
/// Lengths of the links (1,1), (2,1), (2,2), (2,3) \[m\] (Table 1).
const LENGTHS: [f64; 4] = [0.2, 0.2, 0.1, 0.3];
/// Place of the base of chain 2 in the global frame \[m\] (completed).
const SECOND_BASE: [f64; 3] = [0.0, -0.30, 0.25];

/// The scene, 0 to 5 s from rest with all links in the vertical plane.
pub fn rsrrr(variant: &Rsrrr) -> Scene {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let rod = |length: f64, direction: Vector3<f64>| RigidInertia::solid_cylinder(STEEL, DIAMETER, length, &direction);
    let link11 = linkage.link("1,1", rod(LENGTHS[0], Vector3::x()));
    let link21 = linkage.link("2,1", rod(LENGTHS[1], Vector3::z()));
    let link22 = linkage.link("2,2", rod(LENGTHS[2], Vector3::x()));
    let link23 = linkage.link("2,3", rod(LENGTHS[3], Vector3::x()));

    let revolute = Joint::revolute_z();
    // The constant parts of the papers' transforms: T~ = frame * Rz(psi).
    let frame21 = Pose::from_rows([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], SECOND_BASE);
    let frame22 = Pose::from_rows(
        [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
        [0.0, 0.0, LENGTHS[1]],
    );
    let ground = Linkage::GROUND;
    let j11 = linkage.joint("J11", revolute, Mount::at_origin(ground), Mount::at_origin(link11));
    let j21 = linkage.joint(
        "J21",
        revolute,
        Mount::with_pose(ground, frame21),
        Mount::at_origin(link21),
    );
    let j22 = linkage.joint(
        "J22",
        revolute,
        Mount::with_pose(link21, frame22),
        Mount::at_origin(link22),
    );
    let j23 = linkage.joint(
        "J23",
        revolute,
        Mount::at(link22, [LENGTHS[2], 0.0, 0.0]),
        Mount::at_origin(link23),
    );
    let joints = [(j11, "psi11"), (j21, "psi21"), (j22, "psi22"), (j23, "psi23")];
    for (joint, name) in joints {
        linkage.coordinate_names(joint, &[name]);
    }
    let s_on_11 = Mount::at(link11, [LENGTHS[0], 0.0, 0.0]);
    let s_on_23 = Mount::at(link23, [LENGTHS[3], 0.0, 0.0]);
    linkage.cut("S", Joint::Spherical, s_on_11, s_on_23);

    let (torque, rise_time, reference_speed) = (10.0, 2.0, 9.0);
    linkage.drive(j11, Drive::Ramp { torque, rise_time });
    linkage.drive(
        j11,
        Drive::Resistance {
            torque,
            reference_speed,
        },
    );
    if variant.friction {
        for (joint, bearing) in [j11, j21, j22, j23].into_iter().zip(bearings()) {
            linkage.friction(joint, characteristic(), bearing.scaled(variant.friction_scale));
        }
    }

    Scene {
        name: "rsrrr".into(),
        summary: "spatial loop of four revolute joints and a spherical one, with or without joint friction".into(),
        linkage,
        start: Start {
            // psi22, psi23 are the closed position on the branch psi23 > 0, to plotting accuracy.
            positions: [("psi11", FRAC_PI_2), ("psi21", PI), ("psi22", -1.257), ("psi23", 0.505)]
                .map(|(name, value)| (name.to_owned(), value))
                .into(),
            held: vec!["psi11".into()],
            speeds: Vec::new(),
        },
        until: 5.0,
        reactions: true,
        crank: "psi11".into(),
        output: None,
        settings: RunSettings::default(),
    }
}

/// Friction characteristic of Table 1: 95 % of the coefficient at 0.01 rad/s.
fn characteristic() -> Exponential {
    Exponential {
        reference_speed: 0.01,
        steepness: 3.0,
    }
}

/// Bearings (1,1), (2,1), (2,2), (2,3) of Table 1.
fn bearings() -> [JournalBearing; 4] {
    let bearing = |journal: f64, face: f64, face_coefficient: f64| JournalBearing {
        spacing: 0.03,
        surface_a: Surface {
            diameter: journal,
            coefficient: 0.2,
        },
        surface_b: Surface {
            diameter: journal,
            coefficient: 0.2,
        },
        face: Surface {
            diameter: face,
            coefficient: face_coefficient,
        },
    };
    [
        bearing(0.01, 0.015, 0.0),
        bearing(0.028, 0.028, 0.2),
        bearing(0.01, 0.015, 0.2),
        bearing(0.01, 0.015, 0.2),
    ]
}

//! RSUP: the one-freedom loop of crank, coupler, slider and yoke of Augustynek and Urbaś, *Mathematical modelling of spatial
//! linkages with clearance, friction and links' flexibility effects*.
//!
//! The paper leaves out material and masses, the coupler's length, the place of the slide, the directions of gravity and of the
//! drive's rise, the bearing's length and the material's damping; these are completed as said at each constant.

use crate::clearance::{Clearance, ClearanceModel, Side};
use crate::drive::Drive;
use crate::flexible::Along;
use crate::linkage::{Linkage, Mount};
use crate::mechanism::Start;
use crate::scene::{RunSettings, Scene};
use linkdyn_contact::{Damping, Fit, ForcePoint, NormalLaw, RestitutionLaw, ball_in_socket};
use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::{Bristle, BristleStart, Guard, LuGre};
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_rfem::{Division, Material, Section, divide};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};
use thiserror::Error;

/// Variants of the scene; ideal joints and a rigid coupler by default.
#[derive(Clone, Debug)]
pub struct Rsup {
    /// Clearance of the joint R between coupler and yoke, if any.
    pub clearance: Option<ClearanceKind>,
    /// Radius of the hole less that of the pin \[m\]; the pin stays as it is.
    pub clearance_size: f64,
    /// Friction of that clearance joint, if any.
    pub friction: Option<Bristle>,
    /// How its bristle is deflected when a contact is made.
    pub bristle_start: BristleStart,
    /// Number of spring-damping elements of a flexible coupler; none for a rigid one.
    pub flexible: Option<usize>,
}

/// Model of the clearance joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearanceKind {
    /// The axes stay parallel.
    Planar,
    /// The pin may tilt in its hole.
    Spatial,
}

impl Default for Rsup {
    fn default() -> Self {
        Self {
            clearance: None,
            clearance_size: CLEARANCE,
            friction: Some(bristle().into()),
            bristle_start: BristleStart::Relaxed,
            flexible: None,
        }
    }
}

/// Density of steel \[kg/m^3\] (completed).
const STEEL: f64 = 7850.0;
/// Length of the crank \[m\].
const CRANK: f64 = 0.2;
/// Diameter of the crank \[m\] (completed).
const CRANK_DIAMETER: f64 = 0.028;
/// Length of the coupler \[m\] (completed).
const COUPLER: f64 = 0.4;
/// Diameter of the coupler \[m\] (completed).
const COUPLER_DIAMETER: f64 = 0.010;
/// Place of the slide in the global frame \[m\] (completed).
const SLIDE: [f64; 3] = [0.0, -0.1, 0.0];
/// Mass of the slider \[kg\] (completed).
const SLIDER_MASS: f64 = 1.0;
/// Mass of the yoke \[kg\] and its moment of inertia about each axis \[kg m^2\] (completed).
const YOKE: (f64, f64) = (0.1, 2e-5);

/// Radius of the pin on the yoke \[m\].
const PIN: f64 = 0.004;
/// Radius of the hole in the coupler less that of the pin \[m\].
const CLEARANCE: f64 = 0.001;
/// Length of the hole \[m\] (completed).
const BEARING: f64 = 0.02;
/// Coefficient of restitution \[-\].
const RESTITUTION: f64 = 0.9;
/// Steel: Young's modulus \[Pa\], Poisson's ratio \[-\] and relaxation time \[s\] (completed).
const ELASTIC: (f64, f64, f64) = (2.1e11, 0.3, 2e-5);

/// Friction of the clearance joint as published. Its bristle damping makes it passive only up to 0.02 m/s; a
/// [`Guard`](linkdyn_friction::Guard) mends that.
pub fn bristle() -> LuGre {
    LuGre {
        static_coefficient: 0.2,
        kinetic_coefficient: 0.1,
        stribeck_speed: 0.0175,
        bristle_stiffness: 600.0,
        bristle_damping: 600_f64.sqrt(),
        viscous_coefficient: 0.0,
        guard: Guard::None,
    }
}

/// The scene, 0 to 5 s from rest.
///
/// # Errors
/// A size of the clearance or a number of elements that makes no sense.
pub fn rsup(variant: &Rsup) -> Result<Scene, RsupError> {
    let mut linkage = Linkage::new([0.0, 0.0, -9.81]);
    let rod = |diameter: f64, length: f64, direction: Vector3<f64>| {
        RigidInertia::solid_cylinder(STEEL, diameter, length, &direction)
    };
    let point = |mass: f64, moment: f64| RigidInertia {
        mass,
        com: Vector3::zeros(),
        about_com: Matrix3::from_diagonal_element(moment),
    };
    let crank = linkage.link("1,1", rod(CRANK_DIAMETER, CRANK, Vector3::y()));
    let (coupler, coupler_end, sdes) = match variant.flexible {
        None => {
            let link = linkage.link("1,2", rod(COUPLER_DIAMETER, COUPLER, -Vector3::y()));
            (link, Mount::at(link, [0.0, -COUPLER, 0.0]), Vec::new())
        }
        Some(n) => {
            let (modulus, poisson, tau) = ELASTIC;
            let material = Material::isotropic(STEEL, modulus, poisson, tau)?;
            let beam = divide(
                COUPLER,
                &Section::circle(COUPLER_DIAMETER)?,
                &material,
                Division::Standard(n),
            )?;
            let link = linkage.flexible_link("1,2", &beam, Along::MinusY);
            (link.elements[0], link.end, link.joints)
        }
    };
    let slider = linkage.link("2,1", point(SLIDER_MASS, 0.0));
    let yoke = linkage.link("2,2", point(YOKE.0, YOKE.1));

    // The constant parts of the paper's transforms: T(1,0) and T(2,0).
    let base1 = Pose::from_rows([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]], [0.0; 3]);
    let base2 = Pose::from_rows([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], SLIDE);
    let ground = Linkage::GROUND;
    let j11 = linkage.joint(
        "J11",
        Joint::revolute_z(),
        Mount::with_pose(ground, base1),
        Mount::at_origin(crank),
    );
    let s = linkage.joint(
        "S",
        Joint::SphericalZyx,
        Mount::at(crank, [0.0, CRANK, 0.0]),
        Mount::at_origin(coupler),
    );
    let j21 = linkage.joint(
        "J21",
        Joint::prismatic_z(),
        Mount::with_pose(ground, base2),
        Mount::at_origin(slider),
    );
    let j22 = linkage.joint(
        "J22",
        Joint::revolute_z(),
        Mount::at_origin(slider),
        Mount::at_origin(yoke),
    );
    linkage.coordinate_names(j11, &["psi11"]);
    linkage.coordinate_names(s, &["psi12", "theta12", "phi12"]);
    linkage.coordinate_names(j21, &["z21"]);
    linkage.coordinate_names(j22, &["psi22"]);
    let axis = Vector3::x_axis();
    let r = linkage.cut("R", Joint::Revolute { axis }, coupler_end, Mount::at_origin(yoke));
    // The paper starts with a straight coupler.
    let mut held = vec!["psi11".to_owned()];
    for (sde, s) in sdes.into_iter().zip(1..) {
        let names = ["psi", "theta", "phi"].map(|angle| format!("{angle}12.{s}"));
        linkage.coordinate_names(sde, &names.each_ref().map(String::as_str));
        held.extend(names);
    }
    if let Some(kind) = variant.clearance {
        linkage.clearance(r, clearance(kind, variant)?);
    }

    let (torque, rise_time, reference_speed) = (10.0, 2.0, 9.0);
    linkage.drive(j11, Drive::Ramp { torque, rise_time });
    linkage.drive(
        j11,
        Drive::Resistance {
            torque,
            reference_speed,
        },
    );

    let guess = [
        ("psi11", FRAC_PI_2),
        ("psi12", 0.0),
        ("theta12", 0.0),
        ("phi12", -FRAC_PI_3),
        ("z21", 0.25),
        ("psi22", 0.0),
    ];
    Ok(Scene {
        name: "rsup".into(),
        summary: "spatial crank, coupler, slider and yoke; clearance and friction in a joint, flexible coupler".into(),
        linkage,
        start: Start {
            positions: guess.map(|(name, value)| (name.to_owned(), value)).into(),
            held,
            speeds: Vec::new(),
        },
        until: 5.0,
        reactions: false,
        crank: "psi11".into(),
        output: Some("z21".into()),
        settings: RunSettings::default(),
    })
}

fn clearance(kind: ClearanceKind, variant: &Rsup) -> Result<Clearance, RsupError> {
    let fit = Fit::new(PIN + variant.clearance_size, PIN)?;
    let steel = linkdyn_contact::Material {
        youngs_modulus: ELASTIC.0,
        poisson_ratio: ELASTIC.1,
    };
    let compliance = 2.0 * steel.compliance()?;
    let stiffness = ball_in_socket(fit.bearing_radius(), fit.journal_radius(), compliance)?;
    let damping = Damping::Restitution {
        law: RestitutionLaw::LankaraniNikravesh,
        restitution: RESTITUTION,
    };
    Ok(Clearance {
        fit,
        bearing: Side::Predecessor,
        model: match kind {
            ClearanceKind::Planar => ClearanceModel::Planar,
            ClearanceKind::Spatial => ClearanceModel::Spatial { length: BEARING },
        },
        law: NormalLaw::new(stiffness, 1.5, damping)?.into(),
        friction: variant.friction.clone(),
        bristle_start: variant.bristle_start,
        force_point: ForcePoint::OwnSurface,
    })
}

/// Why there is no such variant of the scene.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RsupError {
    /// The clearance makes no sense.
    #[error("clearance of joint R: {0}")]
    Clearance(#[from] linkdyn_contact::ParameterError),
    /// The division of the coupler makes no sense.
    #[error("flexible coupler: {0}")]
    Coupler(#[from] linkdyn_rfem::BeamError),
}

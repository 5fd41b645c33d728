//! Scene files say what Rust says: loads, stops, motions, beams, frames, starts and runs.

use linkdyn_contact::{KelvinVoigt, NormalLaw, RestitutionLaw};
use linkdyn_dynamics::RigidInertia;
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::rfem::{Division, Material, Section, divide};
use linkdyn_mechanisms::{
    Along, Axes, Drive, Limit, Linkage, Mount, PointLoad, PrescribedMotion, RunSettings, Scene, Spline, Spring, Strut,
    file,
};
use nalgebra::{Matrix3, Vector3};

pub(crate) fn read(text: &str) -> Scene {
    file::scene("file", text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

pub(crate) fn faults(text: &str) -> Vec<String> {
    let error = file::scene("file", text).expect_err("broken");
    error.0.iter().map(ToString::to_string).collect()
}

/// Two bodies in a row, the first on the ground; what stands behind is added to the text.
pub(crate) const BODIES: &str = r#"
format = 1
[links]
one = { mass = 2, centre = [0.1, 0, 0] }
two = { mass = 2, centre = [0.1, 0, 0] }
[joints.A]
kind = "revolute"
successor.link = "one"
[joints.B]
kind = "revolute"
predecessor = { link = "one", point = [0.2, 0, 0] }
successor.link = "two"
"#;

pub(crate) const LOADS: &str = r#"
[forces.push]
at = { link = "two", point = [0.1, 0, 0], turn = { axis = [0, 0, 1], angle = "90 deg" } }
direction = [0, 3, 4]
axes = "link"
drives = [
    { harmonic = { amplitude = 2, frequency = 3, phase = "30 deg" } },
    { quadratic_resistance = { torque = 1, reference_speed = 2 } },
    { table = { points = [[0, 1], [1, 2], [2, 0]] } },
    { table = { points = [[0, 1], [1, 2], [2, 0]], monotone = true } },
]
[moments.twist]
at.link = "one"
direction = [0, 0, 1]
axes = "ground"
drives = [{ constant = { torque = 5 } }]
[struts.spring]
from.point = [0, 1, 0]
to = { link = "two", point = [0.2, 0, 0] }
free_length = 0.5
stiffness = 100
damping = 3
"#;

pub(crate) const SITTING: &str = r#"
format = 1
[links]
one = { mass = 2, centre = [0.1, 0, 0] }
two = { mass = 2, centre = [0.1, 0, 0] }
three = { mass = 2, centre = [0.1, 0, 0] }
four = { mass = 2, centre = [0.1, 0, 0] }
[joints.A]
kind = "revolute"
successor.link = "one"
springs = [{ stiffness = 2, damping = 0.1, rest = "90 deg" }]
limit = { lower = "-90 deg", upper = 1, contact = { kelvin_voigt = { stiffness = 1e4, damping = 10 } } }
prescribed = { harmonic = { mean = 1, amplitude = "90 deg", frequency = 2, phase = "-90 deg" } }
[joints.B]
kind = "screw"
lead = 0.01
predecessor.link = "one"
successor.link = "two"
prescribed = { polynomial = { coefficients = [0.5, 1, -2] } }
[joints.C]
kind = "prismatic"
predecessor.link = "two"
successor.link = "three"
limit = { upper = 0.2, contact = { power = { stiffness = 1e6, exponent = 2, least_impact_speed = 1e-4, damping = { restitution = { law = "flores", restitution = 0.5 } } } } }
prescribed = { speeds = { points = [[0, 1], [1, 2], [2, 0]] } }
[joints.D]
kind = "revolute"
predecessor.link = "three"
successor.link = "four"
prescribed = { table = { points = [[0, 1], [1, 2], [2, 0]] } }
"#;

pub(crate) const BEAM: &str = r#"
format = 1
[links.beam.beam]
along = "y"
length = 0.5
section = { rectangle = { width = 0.01, height = 0.02 } }
density = 7850
youngs_modulus = 2e11
poissons_ratio = 0.3
relaxation_time = 1e-4
elements = 3
coordinates = ["bend", "sway", "twist"]
straight = false
[links.tip.box]
density = 1000
size = [0.1, 0.1, 0.1]
centre = [0, 0, 0.05]
[joints.A]
kind = "fixed"
successor = { link = "beam" }
[joints.B]
kind = "planar"
axis = [0, 1, 0]
second_axis = [1, 0, 0]
predecessor = { link = "beam", end = true, point = [0, 0.1, 0], rotation = [[0, -1, 0], [1, 0, 0], [0, 0, 1]] }
successor = { link = "tip" }
cut = false
[forces.pull]
at = { link = "beam", end = true }
direction = [0, 0, -1]
drives = [{ ramp = { torque = 1, rise_time = 1 } }]
[start]
positions = { "bend.2" = 0.01, "B.psi" = "45 deg" }
held = ["twist.1"]
speeds = { "sway.3" = 0.1 }
[run]
until = 3
reactions = true
crank = "B.psi"
output = "bend.1"
every = 0.1
method = "newmark"
step = 1e-3
"#;

/// A pipe that bends, on a slide with all friction there is, and a pin with clearance at its end.
pub(crate) const REST: &str = r#"
format = 1
summary = "all that rubs"
[links.pipe.beam]
length = 0.5
section = { tube = { outer_diameter = 0.02, inner_diameter = 0.01 } }
density = 7850
youngs_modulus = 2e11
poissons_ratio = 0.3
elements = 1
[links]
bob = { mass = 1, inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }
ball = { mass = 1 }
[joints.slide]
kind = "prismatic"
successor.link = "pipe"
[joints.slide.friction]
exponential = { reference_speed = 0.01, steepness = 3 }
piecewise_linear = { reference_speed = 0.01 }
hyperbolic_tangent = { reference_speed = 0.01 }
cubic = { reference_speed = 0.01 }
stribeck = { static_ratio = 1.5, stribeck_speed = 0.02, exponent = 2, reference_speed = 0.01 }
viscous = { per_speed = 0.5 }
pad_guide = { spacing = 0.1, arm = 0.02, pad_a = 0.2, pad_b = 0.2, key = 0.1 }
[joints.pin]
kind = "revolute"
predecessor = { link = "pipe", end = true }
successor.link = "bob"
cut = false
[joints.pin.clearance]
bearing_radius = 0.005
journal_radius = 0.004
bearing = "successor"
length = 0.02
contact = { hertz = { material = { youngs_modulus = 2.1e11, poisson_ratio = 0.3 }, damping = { material = { constant = 0.1 } }, least_impact_speed = 1e-4 } }
bristle_start = "steady"
friction = { elasto_plastic = { elastic_share = 0.5, lugre = { static_coefficient = 0.2, kinetic_coefficient = 0.1, stribeck_speed = 0.02, bristle_stiffness = 600, bristle_damping = 10, viscous_coefficient = 0, guard = { decay = { speed = 0.1 } } } } }
[joints.socket]
kind = "spherical"
predecessor.link = "bob"
successor.link = "ball"
cut = false
[joints.socket.clearance]
bearing_radius = 0.02
journal_radius = 0.019
contact = { kelvin_voigt = { stiffness = 1e6, damping = 10 } }
friction = { dahl = { coefficient = 0.1, bristle_stiffness = 600 } }
force_point = "common"
[run]
rtol = 1e-8
atol = 1e-9
"#;

fn body() -> RigidInertia {
    RigidInertia {
        mass: 2.0,
        com: Vector3::new(0.1, 0.0, 0.0),
        about_com: Matrix3::zeros(),
    }
}

fn nodes() -> [(f64, f64); 3] {
    [(0.0, 1.0), (1.0, 2.0), (2.0, 0.0)]
}

fn degrees(angle: f64) -> f64 {
    angle.to_radians()
}

#[test]
fn forces_moments_and_struts_are_those_of_rust() {
    let mut rust = Linkage::new([0.0, 0.0, -9.81]);
    let [one, two] = ["one", "two"].map(|name| rust.link(name, body()));
    let (hinge, ground) = (Joint::revolute_z(), Linkage::GROUND);
    rust.joint("A", hinge, Mount::at_origin(ground), Mount::at_origin(one));
    rust.joint("B", hinge, Mount::at(one, [0.2, 0.0, 0.0]), Mount::at_origin(two));
    let turned = Pose {
        origin: Vector3::new(0.1, 0.0, 0.0),
        ..Pose::turn(Vector3::z_axis(), degrees(90.0))
    };
    let push = PointLoad {
        at: Mount::with_pose(two, turned),
        direction: [0.0, 3.0, 4.0],
        axes: Axes::Mount,
        drives: vec![
            Drive::Harmonic {
                amplitude: 2.0,
                frequency: 3.0,
                phase: degrees(30.0),
            },
            Drive::QuadraticResistance {
                torque: 1.0,
                reference_speed: 2.0,
            },
            Drive::Table {
                spline: Spline::natural(&nodes()),
            },
            Drive::Table {
                spline: Spline::monotone(&nodes()),
            },
        ],
    };
    let twist = PointLoad {
        at: Mount::at_origin(one),
        direction: [0.0, 0.0, 1.0],
        axes: Axes::Ground,
        drives: vec![Drive::Constant { torque: 5.0 }],
    };
    let spring = Strut {
        from: Mount::at(ground, [0.0, 1.0, 0.0]),
        to: Mount::at(two, [0.2, 0.0, 0.0]),
        free_length: 0.5,
        stiffness: 100.0,
        damping: 3.0,
    };
    rust.force("push", push).moment("twist", twist).strut("spring", spring);
    let file = read(&[BODIES, LOADS].concat()).linkage;
    assert_eq!(format!("{rust:?}"), format!("{file:?}"));
    let outline = file.outline();
    assert!(
        outline.ends_with("force: push on two\nmoment: twist on one\nstrut: ground - spring - two\n"),
        "{outline}"
    );
}

#[test]
fn stops_prescribed_motions_leads_and_rests_are_those_of_rust() {
    let mut rust = Linkage::new([0.0, 0.0, -9.81]);
    let links = ["one", "two", "three", "four"].map(|name| rust.link(name, body()));
    let axis = Vector3::z_axis();
    let screw = Joint::Screw {
        axis,
        pitch: 0.01 / std::f64::consts::TAU,
    };
    let kinds = [
        Joint::revolute_z(),
        screw,
        Joint::Prismatic { axis },
        Joint::revolute_z(),
    ];
    let mut before = Linkage::GROUND;
    let mut hang = |(k, name): (usize, &str)| {
        let (one, two) = (Mount::at_origin(before), Mount::at_origin(links[k]));
        before = links[k];
        rust.joint(name, kinds[k], one, two)
    };
    let [a, b, c, d] = [(0, "A"), (1, "B"), (2, "C"), (3, "D")].map(&mut hang);
    let rest = degrees(90.0);
    rust.springs(
        a,
        &[Spring {
            stiffness: 2.0,
            damping: 0.1,
            rest,
        }],
    );
    let linear = KelvinVoigt {
        stiffness: 1e4,
        damping: 10.0,
    };
    rust.limit(
        a,
        Limit {
            lower: Some(-rest),
            upper: Some(1.0),
            law: linear.into(),
        },
    );
    let power = NormalLaw::new(1e6, 2.0, RestitutionLaw::Flores.with(0.5)).expect("in range");
    rust.limit(
        c,
        Limit {
            lower: None,
            upper: Some(0.2),
            law: power.with_least_impact_speed(1e-4).expect("in range").into(),
        },
    );
    let spline = Spline::natural(&nodes());
    rust.prescribe(
        a,
        PrescribedMotion::Harmonic {
            mean: 1.0,
            amplitude: rest,
            frequency: 2.0,
            phase: -rest,
        },
    );
    rust.prescribe(
        b,
        PrescribedMotion::Polynomial {
            coefficients: vec![0.5, 1.0, -2.0],
        },
    );
    rust.prescribe(c, PrescribedMotion::Speeds { spline: spline.clone() });
    rust.prescribe(d, PrescribedMotion::Table { spline });
    let file = read(SITTING).linkage;
    assert_eq!(format!("{rust:?}"), format!("{file:?}"));
    let outline = file.outline();
    let expected =
        "ground\n  A (revolute, prescribed motion, sprung, stops) - one\n    B (screw, prescribed motion) - two\n";
    assert!(outline.starts_with(expected), "{outline}");
}

#[test]
fn beams_boxes_frames_starts_and_runs_are_those_of_rust() {
    let mut rust = Linkage::new([0.0, 0.0, -9.81]);
    let material = Material::isotropic(7850.0, 2e11, 0.3, 1e-4).expect("in range");
    let section = Section::rectangle(0.01, 0.02).expect("in range");
    let beam = divide(0.5, &section, &material, Division::Standard(3)).expect("in range");
    let beam = rust.flexible_link("beam", &beam, Along::Y);
    for (k, &joint) in beam.joints.iter().enumerate() {
        let names = ["bend", "sway", "twist"].map(|name| format!("{name}.{}", k + 1));
        rust.coordinate_names(joint, &names.each_ref().map(String::as_str));
    }
    let tip = RigidInertia {
        mass: 1000.0 * 0.1 * 0.1 * 0.1,
        com: Vector3::new(0.0, 0.0, 0.05),
        about_com: Matrix3::identity() * ((0.1 * 0.1 + 0.1 * 0.1) * (1000.0 * 0.1 * 0.1 * 0.1 / 12.0)),
    };
    let tip = rust.link("tip", tip);
    let start = beam.elements[0];
    rust.joint(
        "A",
        Joint::Fixed,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(start),
    );
    let rows = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    let place = Mount::with_pose(beam.end.link, beam.end.pose * Pose::from_rows(rows, [0.0, 0.1, 0.0]));
    let planar = Joint::Planar {
        along: Vector3::x_axis(),
        normal: Vector3::y_axis(),
    };
    rust.joint("B", planar, place, Mount::at_origin(tip));
    let pull = PointLoad {
        at: beam.end,
        direction: [0.0, 0.0, -1.0],
        axes: Axes::Ground,
        drives: vec![Drive::Ramp {
            torque: 1.0,
            rise_time: 1.0,
        }],
    };
    rust.force("pull", pull);
    let scene = read(BEAM);
    assert_eq!(format!("{rust:?}"), format!("{:?}", scene.linkage));
    let outline = scene.linkage.outline();
    let expected = "ground\n  A (fixed) - beam (beam of 3 elements)\n    B (planar) - tip\nforce: pull on beam\n";
    assert_eq!(outline, expected);

    let named = |name: &str, value: f64| (name.to_owned(), value);
    assert_eq!(
        scene.start.positions,
        [named("bend.2", 0.01), named("B.psi", degrees(45.0))]
    );
    assert_eq!(scene.start.held, ["twist.1"]);
    assert_eq!(scene.start.speeds, [named("sway.3", 0.1)]);
    assert_eq!((scene.until, scene.reactions), (3.0, true));
    assert_eq!(
        (scene.crank.as_str(), scene.output.as_deref()),
        ("B.psi", Some("bend.1"))
    );
    let settings = RunSettings {
        every: Some(0.1),
        method: Some("newmark".into()),
        step: Some(1e-3),
        ..RunSettings::default()
    };
    assert_eq!(scene.settings, settings);
    // Straight unless told: all turns are held then, each once.
    let straight = read(&BEAM.replace("straight = false", ""));
    assert_eq!(straight.start.held.len(), 9);
    let tolerances = BEAM
        .replace("\"newmark\"", "\"bdf\"")
        .replace("step = 1e-3", "rtol = 1e-8\natol = 1e-9");
    let settings = read(&tolerances).settings;
    assert_eq!(
        (settings.rtol, settings.atol, settings.step),
        (Some(1e-8), Some(1e-9), None)
    );
}

//! Clearance in scene files: of revolute and ball joints, cut and in the tree; the same linkage as in Rust, names in starts, and runs.

use crate::hung_rod;
use linkdyn_contact::ForcePoint;
use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::BristleStart;
use linkdyn_integrators::Dop853;
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::{Clearance, ClearanceModel, Linkage, Mount, Scene, Side, file};
use linkdyn_tests::scenes::{Finished, prepare, simulate};
use nalgebra::{Matrix3, Vector3};

const CLEARANCE: &str = r#"
bearing_radius = 0.005
journal_radius = 0.004
bearing = "successor"
contact = { power = { stiffness = 1e9, damping = { restitution = { law = "exact", restitution = 0.6 } } } }
bristle_start = "steady"
force_point = "own_surface"
[joints.J.clearance.friction.lugre]
static_coefficient = 0.2
kinetic_coefficient = 0.1
stribeck_speed = 0.02
bristle_stiffness = 600
bristle_damping = 10
viscous_coefficient = 0.01
guard = "cap"
"#;

fn clearance(model: ClearanceModel) -> Clearance {
    Clearance {
        bearing: Side::Successor,
        bristle_start: BristleStart::Steady,
        force_point: ForcePoint::OwnSurface,
        ..hung_rod::clearance(model, hung_rod::CLEARANCE)
    }
}

/// A body that hangs on the ground by the joint J; where J is cut, it floats.
fn text(kind: &str, cut: Option<bool>, length: &str, rest: &str) -> String {
    let axis = if kind == "revolute" { "axis = [0, 1, 0]" } else { "" };
    let cut_key = cut.map_or_else(String::new, |cut| format!("cut = {cut}"));
    let float = match cut {
        Some(false) => "",
        _ => "[joints.float]\nkind = \"free\"\nsuccessor.link = \"rod\"\ncut = false",
    };
    format!(
        "format = 1\n[links.rod]\nmass = 2\ncentre = [0.1, 0, 0]\ninertia = [[0.01, 0, 0], [0, 0.02, 0], [0, 0, 0.02]]\n{float}\n\
         [joints.J]\nkind = \"{kind}\"\n{axis}\n{cut_key}\nsuccessor.link = \"rod\"\n{rest}\n[joints.J.clearance]\n{length}{CLEARANCE}"
    )
}

fn read(text: &str) -> Scene {
    file::scene("file", text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn faults(text: &str) -> Vec<String> {
    let error = file::scene("file", text).expect_err("broken");
    error.0.iter().map(ToString::to_string).collect()
}

#[test]
fn all_models_cut_and_in_the_tree_are_the_same_linkage_as_in_rust() {
    let revolute = Joint::Revolute {
        axis: Vector3::y_axis(),
    };
    for (kind, joint, length, model) in [
        ("revolute", revolute, "", ClearanceModel::Planar),
        (
            "revolute",
            revolute,
            "length = 0.02",
            ClearanceModel::Spatial { length: 0.02 },
        ),
        ("spherical", Joint::Spherical, "", ClearanceModel::Spherical),
        ("spherical_zyx", Joint::SphericalZyx, "", ClearanceModel::Spherical),
    ] {
        for cut in [None, Some(true), Some(false)] {
            let mut rust = Linkage::new([0.0, 0.0, -9.81]);
            let body = RigidInertia {
                mass: 2.0,
                com: Vector3::new(0.1, 0.0, 0.0),
                about_com: Matrix3::from_diagonal(&Vector3::new(0.01, 0.02, 0.02)),
            };
            let rod = rust.link("rod", body);
            let (one, two) = (Mount::at_origin(Linkage::GROUND), Mount::at_origin(rod));
            if cut == Some(false) {
                let joint = rust.joint("J", joint, one, two);
                rust.clearance(joint, clearance(model));
            } else {
                rust.joint("float", Joint::Free, one, two);
                let joint = rust.cut("J", joint, one, two);
                rust.clearance(joint, clearance(model));
            }
            let file = read(&text(kind, cut, length, "")).linkage;
            assert_eq!(format!("{rust:?}"), format!("{file:?}"), "{kind} {cut:?}");
        }
    }
}

/// Energy is where it should be, and there were contacts.
fn assert_runs(scene: Scene, until: f64) -> Finished {
    let run = simulate(&prepare(scene), Dop853::default(), 1e-12, until, until / 100.0);
    run.end.as_ref().expect("runs");
    assert!(run.contacts.len() > 1, "{}", run.contacts.len());
    let first = run.rows[0].energy_balance();
    for row in &run.rows {
        assert!(
            (row.energy_balance() - first).abs() < 1e-8,
            "{} {first}",
            row.energy_balance()
        );
    }
    run
}

#[test]
fn a_pin_of_the_tree_starts_where_the_file_says_and_runs() {
    let start = "[start]\npositions = { \"J.x\" = -0.9e-3, J = 0.4 }\nspeeds = { \"J.y\" = 0.1 }\n";
    let scene = read(&(text("revolute", Some(false), "", "") + start));
    assert_eq!(scene.crank, "J");
    let ready = prepare(scene.clone());
    let names: Vec<_> = ready.mechanism.coordinate_names().collect();
    assert_eq!(names, ["J.x", "J.y", "J"]);
    assert_eq!((&ready.start.q[..], ready.start.v[1]), (&[-0.9e-3, 0.0, 0.4][..], 0.1));
    assert_runs(scene, 0.1);

    let spatial = read(&text("revolute", Some(false), "length = 0.02", ""));
    let ready = prepare(spatial.clone());
    let names: Vec<_> = ready.mechanism.coordinate_names().collect();
    assert_eq!(names, ["J.x", "J.y", "J", "J.theta", "J.phi"]);
    assert_runs(spatial, 0.1);
}

#[test]
fn balls_run_in_the_tree_and_cut() {
    let start = "[start]\npositions = { \"J.z\" = -0.5e-3 }\n";
    for kind in ["spherical", "spherical_zyx"] {
        let scene = read(&(text(kind, Some(false), "", "") + start));
        assert_eq!(prepare(scene.clone()).start.q[2], -0.5e-3);
        assert_runs(scene, 0.05);
        assert_runs(read(&text(kind, None, "", "")), 0.05);
    }
}

#[test]
fn what_sits_on_the_turn_keeps_a_joint_with_clearance_in_the_tree() {
    let rest = "coordinates = [\"turn\"]\nsprings = [{ stiffness = 5 }]\ndrives = [{ constant = { torque = 0.7 } }]";
    let text = text("revolute", Some(false), "", rest).replace("cut = false", "");
    let scene = read(&text);
    assert_eq!(scene.crank, "turn");
    let outline = scene.linkage.outline();
    assert_eq!(
        outline,
        "ground\n  J (revolute, driven, sprung, planar clearance) - rod\n"
    );
    let mechanism = scene.linkage.build().expect("a linkage");
    let names: Vec<_> = mechanism.coordinate_names().collect();
    assert_eq!(names, ["J.x", "J.y", "turn"]);
}

#[test]
fn what_does_not_go_with_clearance_is_told_with_place_and_remedy() {
    let told = |text: &str, expected: &[&str]| {
        let found = faults(text);
        assert_eq!(found.len(), expected.len(), "{found:#?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!(found.contains(expected), "{found}");
        }
    };
    let ball = text("spherical", Some(false), "length = 0.02", "");
    told(
        &ball,
        &["`joints.J.clearance.length`: goes with the bearing of a revolute joint; a ball has none, so leave it out"],
    );
    for (kind, name) in [
        ("prismatic", "prismatic"),
        ("universal", "universal"),
        ("fixed", "fixed"),
        ("free", "free"),
    ] {
        let found = faults(&text(kind, Some(false), "", ""));
        let words = format!("`revolute`, `spherical` and `spherical_zyx` joints; this one is {name}");
        assert!(found.iter().any(|fault| fault.contains(&words)), "{found:#?}");
    }
    let friction = "friction = { viscous = { per_speed = 1 }, journal = { spacing = 1, surface_a = { diameter = 1, coefficient = 0 }, \
                    surface_b = { diameter = 1, coefficient = 0 }, face = { diameter = 1, coefficient = 0 } } }";
    let rubbing = text("revolute", Some(false), "", friction);
    told(
        &rubbing,
        &["`joints.J.friction`: needs the reaction of an ideal joint; with `clearance` give that a `friction`"],
    );
    // Cut unless told, which leaves the rod without a hold.
    let open = text("revolute", Some(false), "", "").replace("cut = false", "");
    told(
        &open,
        &["`links.rod`: no chain of joints that are not cut leads from it to the ground; write `cut = false`"],
    );
    let turned = text("revolute", Some(false), "", "").replace("successor.link", "predecessor.link");
    told(
        &turned,
        &["which a joint with clearance cannot carry; exchange predecessor and successor"],
    );
    // An offset that a pin does not have, and one of a joint that is cut.
    let along = text("revolute", Some(false), "", "") + "[start]\npositions = { \"J.z\" = 1e-4 }\n";
    told(&along, &["there is no coordinate `J.z`; did you mean `J.y`?"]);
    let cut = text("revolute", Some(true), "", "") + "[start]\npositions = { \"J.x\" = 1e-4 }\n";
    told(&cut, &["there is no coordinate `J.x`; there are `float.x`, "]);
    // `J1` is the first edge of J.
    let edges = text("revolute", Some(false), "length = 0.02", "")
        + "[links.two]\nmass = 1\n[joints.J1]\nkind = \"spherical\"\ncut = false\nsuccessor.link = \"two\"\n[joints.J1.clearance]\n\
           bearing_radius = 0.005\njournal_radius = 0.004\ncontact = { power = { stiffness = 1e9 } }\n";
    told(
        &edges,
        &["`joints.J1`: the name `J1` of a contact point is used twice; give the joint another name"],
    );
    // A name that clearance gives.
    let twice = text("revolute", Some(false), "", "")
        + "[links.two]\nmass = 1\n[joints.K]\nkind = \"revolute\"\nsuccessor.link = \"two\"\ncoordinates = [\"J.x\"]\n";
    told(&twice, &["`joints.K.coordinates`: the name `J.x` is used twice"]);
}

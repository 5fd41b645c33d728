//! Linkages described in code by joints alone: which of them are cut is chosen, and can be said.

use linkdyn_dynamics::RigidInertia;
use linkdyn_integrators::Dop853;
use linkdyn_kinematics::{Joint, Positions};
use linkdyn_mechanisms::{Drive, Linkage, Mechanism, Mount, RunSettings, Scene, Start};
use linkdyn_tests::scenes::{prepare, simulate};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// How a joint of the four-bar is described.
#[derive(Clone, Copy)]
enum Told {
    Joint,
    Cut,
}

/// A four-bar with bars along x, a crank that is driven, a ball at C. The rocker's base may be told from the rocker's side.
fn four_bar(c: Told, d: Told, backwards: bool) -> Linkage {
    let rod = |length| RigidInertia::solid_cylinder(7850.0, 0.02, length, &Vector3::x());
    let mut m = Linkage::new([0.0, -9.81, 0.0]);
    let (crank, coupler, rocker) = (
        m.link("crank", rod(0.1)),
        m.link("coupler", rod(0.3)),
        m.link("rocker", rod(0.25)),
    );
    let (hinge, ground) = (Joint::revolute_z(), Linkage::GROUND);
    let a = m.joint("A", hinge, Mount::at_origin(ground), Mount::at_origin(crank));
    m.joint("B", hinge, Mount::at(crank, [0.1, 0.0, 0.0]), Mount::at_origin(coupler));
    let mut add = |name: &str, told: Told, joint: Joint, one: Mount, two: Mount| match told {
        Told::Joint => drop(m.joint(name, joint, one, two)),
        Told::Cut => drop(m.cut(name, joint, one, two)),
    };
    let (base, foot) = (Mount::at(ground, [0.3, 0.0, 0.0]), Mount::at_origin(rocker));
    let ends = [Mount::at(coupler, [0.3, 0.0, 0.0]), Mount::at(rocker, [0.25, 0.0, 0.0])];
    add("C", c, Joint::Spherical, ends[0], ends[1]);
    match backwards {
        true => add("D", d, hinge, foot, base),
        false => add("D", d, hinge, base, foot),
    }
    m.drive(a, Drive::Constant { torque: 4.0 });
    m
}

/// Places of all links after half a second.
fn after_a_while(linkage: &Linkage, guess: &[(&str, f64)]) -> BTreeMap<String, Vec<f64>> {
    let scene = Scene {
        name: "four-bar".into(),
        summary: String::new(),
        linkage: linkage.clone(),
        start: Start {
            positions: guess.iter().map(|(name, angle)| ((*name).to_owned(), *angle)).collect(),
            held: vec!["A".into()],
            speeds: Vec::new(),
        },
        until: 0.5,
        reactions: false,
        crank: "A".into(),
        output: None,
        settings: RunSettings::default(),
    };
    let ready = prepare(scene);
    let run = simulate(&ready, Dop853::default(), 1e-12, 0.5, 0.5);
    run.end.expect("runs to the end");
    let (tree, last) = (ready.mechanism.system().tree(), run.rows.last().expect("rows"));
    let mut places = Positions::new(tree);
    tree.positions(&last.q, &mut places);
    let place = |link: &str| {
        let at = ready.mechanism.attachment(link).expect("it is there");
        let pose = places.pose(at.link) * at.pose;
        pose.rotation.iter().chain(&pose.origin).copied().collect()
    };
    ["crank", "coupler", "rocker"]
        .map(|link| (link.to_owned(), place(link)))
        .into()
}

fn cuts(mechanism: &Mechanism) -> Vec<&str> {
    mechanism.loop_names().collect()
}

#[test]
fn the_joint_with_most_freedoms_is_cut_unless_another_is_said() {
    let planar = [("A", 1.0), ("B", -0.5), ("D", 1.5)];
    let said = four_bar(Told::Cut, Told::Joint, false);
    let right = after_a_while(&said, &planar);
    // The rocker as a pendulum on the coupler by a ball, and its base cut.
    let turned = [("A", 1.0), ("B", -0.5), ("C.w", 0.54), ("C.z", 0.84)];
    for (linkage, cut, guess) in [
        (four_bar(Told::Joint, Told::Joint, false), "C", &planar[..]),
        (
            four_bar(Told::Joint, Told::Joint, true),
            "C",
            &planar.map(|(name, angle)| (name, if name == "D" { -angle } else { angle })),
        ),
        (four_bar(Told::Joint, Told::Cut, false), "D", &turned),
    ] {
        assert_eq!(cuts(&linkage.build().expect("sound")), [cut]);
        assert!(linkage.outline().contains("cut: ") && linkage.outline().contains(cut));
        let found = after_a_while(&linkage, guess);
        for (link, place) in &right {
            let gap = place
                .iter()
                .zip(&found[link])
                .fold(0.0, |s, (a, b)| f64::max(s, (a - b).abs()));
            assert!(gap < 1e-9, "{cut} cut: {link} {gap:e}");
        }
    }
}

#[test]
fn what_has_something_on_its_coordinates_is_not_cut() {
    let mut linkage = four_bar(Told::Joint, Told::Joint, false);
    let c = linkage.joint_named("C").expect("it is there");
    linkage.coordinate_names(c, &["w", "x", "y", "z"]);
    // The ball carries the rocker now, which it can from the coupler only.
    let mechanism = linkage.build().expect("sound");
    assert!(
        mechanism.coordinate_names().any(|name| name == "w"),
        "{}",
        linkage.outline()
    );
    assert_eq!(cuts(&mechanism), ["D"]);
    let d = linkage.joint_named("D").expect("it is there");
    linkage.drive(d, Drive::Constant { torque: 1.0 });
    let error = linkage.build().expect_err("both carry the rocker").to_string();
    assert!(
        error.contains("`C` and joint `D`; make one of them a cut joint"),
        "{error}"
    );
}

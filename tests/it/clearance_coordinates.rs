//! What clearance adds to a joint of the tree: names, freedoms, starts, and what acts on the joint's own coordinates.

use crate::clearance::go;
use crate::hung_rod::{CLEARANCE, Hung, SPATIAL, begin, clearance, kinds, skew};
use linkdyn_dynamics::RigidInertia;
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::analysis::mobility;
use linkdyn_mechanisms::{
    Clearance, ClearanceModel, Drive, JointHandle, Limit, Linkage, Mechanism, Mount, Observation, PrescribedMotion,
    Simulation, Spring, Start,
};
use nalgebra::Vector3;

#[test]
fn coordinates_of_a_joint_with_clearance_are_called_by_what_they_are() {
    let names = |joint, model, given: &[&str]| {
        let mut linkage = Linkage::new([0.0; 3]);
        let body = RigidInertia::solid_cylinder(1000.0, 0.1, 0.3, &Vector3::x());
        let link = linkage.link("rod", body);
        let handle = linkage.joint("J", joint, Mount::at_origin(Linkage::GROUND), Mount::at_origin(link));
        linkage.clearance(handle, clearance(model, CLEARANCE));
        if !given.is_empty() {
            linkage.coordinate_names(handle, given);
        }
        let built = linkage.build().expect("valid");
        let list = |names: Vec<&str>| names.join(" ");
        (
            list(built.coordinate_names().collect()),
            list(built.speed_names().collect()),
            built.contact_names().collect::<Vec<_>>().join(" "),
        )
    };
    let told = |q: &str, v: &str, contacts: &str| (q.to_owned(), v.to_owned(), contacts.to_owned());
    let revolute = Joint::Revolute { axis: skew() };
    assert_eq!(
        names(revolute, ClearanceModel::Planar, &[]),
        told("J.x J.y J", "J.x J.y J", "J")
    );
    assert_eq!(
        names(revolute, ClearanceModel::Planar, &["psi"]),
        told("J.x J.y psi", "J.x J.y psi", "J")
    );
    let spatial = "J.x J.y J J.theta J.phi";
    assert_eq!(names(revolute, SPATIAL, &[]), told(spatial, spatial, "J1 J2"));
    let quaternion = told("J.x J.y J.z J.qw J.qx J.qy J.qz", "J.x J.y J.z J.wx J.wy J.wz", "J");
    assert_eq!(names(Joint::Spherical, ClearanceModel::Spherical, &[]), quaternion);
    let turns = "J.x J.y J.z J.psi J.theta J.phi";
    assert_eq!(
        names(Joint::SphericalZyx, ClearanceModel::Spherical, &[]),
        told(turns, turns, "J")
    );
}

#[test]
fn both_forms_have_the_same_freedoms_and_rows_as_long_as_their_columns() {
    for ((joint, model, speeds), kind) in kinds().into_iter().zip(["planar", "spatial", "spherical", "spherical"]) {
        let hung = Hung::new(joint, Some(clearance(model, CLEARANCE)), speeds);
        let (tree, cut) = (hung.run(0.06), hung.run_cut(0.06));
        let freedoms = [&tree, &cut].map(|(mechanism, run)| {
            let found = mobility(mechanism, &run.rows[0].q).expect("closed");
            assert_eq!(found.freedoms, found.finite);
            found.freedoms
        });
        // Two turns of the arm, and what the joint leaves with its clearance.
        let left = match kind {
            "planar" => 3,
            "spatial" => 5,
            _ => 6,
        };
        assert_eq!(freedoms, [2 + left; 2], "{joint:?}");
        // While nothing touches, the joint holds as much as the equations that are left.
        let held = tree.1.rows[5].reactions[1].force.norm();
        let by_equations = cut.1.rows[5].multipliers.first().map_or(0.0, |force| force.abs());
        assert!((held - by_equations).abs() < 1e-8, "{joint:?}: {held} {by_equations}");
        assert_eq!(held < 1e-10, kind == "spherical", "{held}");
        for (mechanism, run) in [&tree, &cut] {
            let mut simulation = Simulation::new(mechanism);
            let mut row = Vec::new();
            for with_reactions in [false, true] {
                run.rows[90].write(with_reactions, &mut row);
                assert_eq!(simulation.columns(with_reactions).len(), row.len(), "{joint:?}");
            }
            // What was observed is all that a run needs to go on.
            let touching = run
                .rows
                .iter()
                .find(|row| row.contacts[0].normal > 0.0)
                .expect("a contact");
            let y = simulation.restore(touching);
            let mut again = Observation::default();
            simulation.observe(touching.t, &y, &mut again).expect("regular");
            assert_eq!(
                (&again.a, &again.contacts),
                (&touching.a, &touching.contacts),
                "{joint:?}"
            );
        }
        let described = [hung.tree().outline(), hung.cut().outline()];
        let line = format!(", {kind} clearance) - rod\n");
        assert!(described.iter().all(|text| text.contains(&line)), "{described:?}");
    }
}

#[test]
fn drives_and_springs_act_on_the_turn() {
    for (joint, model, speeds) in &kinds()[..2] {
        let hung = Hung::new(*joint, Some(clearance(*model, CLEARANCE)), speeds);
        let (mut linkage, _, one, two) = hung.begin();
        let handle = linkage.joint("J", *joint, one, two);
        linkage.clearance(handle, hung.clearance.clone().expect("some"));
        linkage.drive(handle, Drive::Constant { torque: 0.7 });
        let spring = Spring {
            stiffness: 5.0,
            damping: 0.0,
            rest: 0.0,
        };
        linkage.springs(handle, &[spring]);
        let mechanism = linkage.build().expect("valid");
        let mut state = hung.start(&mechanism);
        let turn = mechanism
            .coordinate_names()
            .position(|name| name == "J")
            .expect("a turn");
        state.q[turn] = 0.4;
        let mut simulation = Simulation::new(&mechanism);
        let y = simulation.state_vector(&state);
        let mut rates = vec![0.0; y.len()];
        linkdyn_integrators::Ode::rhs(&mut simulation, 0.0, &y, &mut rates).expect("regular");
        let work = rates[simulation.layout().work.start];
        assert!((work - 0.7 * state.v[turn]).abs() < 1e-12, "{work}");
        let mut seen = Observation::default();
        simulation.observe(0.0, &y, &mut seen).expect("regular");
        assert!(
            (seen.energy.elastic - 0.5 * 5.0 * 0.16).abs() < 1e-12,
            "{:?}",
            seen.energy
        );
    }
}

#[test]
fn limits_and_prescribed_motion_act_on_the_turn() {
    for (joint, model, _) in &kinds()[..2] {
        let hung = Hung::new(*joint, Some(clearance(*model, CLEARANCE)), &[]);
        let with = |change: &dyn Fn(&mut Linkage, JointHandle)| {
            let mut linkage = hung.tree();
            let handle = linkage.joint_named("J").expect("it is there");
            change(&mut linkage, handle);
            linkage.build().expect("valid")
        };
        let turn = |mechanism: &Mechanism| {
            mechanism
                .coordinate_names()
                .position(|name| name == "J")
                .expect("a turn")
        };

        let coefficients = vec![0.1, 3.0];
        let guided = with(&|linkage, handle| {
            let coefficients = coefficients.clone();
            linkage.prescribe(handle, PrescribedMotion::Polynomial { coefficients });
        });
        let aside = Start {
            speeds: vec![("J.x".into(), 0.5)],
            ..Start::default()
        };
        let (start, _) = guided.assemble(&aside).expect("closed");
        let run = go(&mut begin(&guided, &start), 0.02, 0.001);
        assert!(!run.contacts.is_empty());
        for row in &run.rows {
            assert!((row.q[turn(&guided)] - 0.1 - 3.0 * row.t).abs() < 1e-12);
        }

        let stopped = with(&|linkage, handle| {
            let (lower, upper, law) = (None, Some(0.02), crate::limits::law(0.5));
            linkage.limit(handle, Limit { lower, upper, law });
        });
        let names: Vec<String> = stopped.contact_names().collect();
        assert_eq!(names[0], "J.upper");
        let (mut start, _) = stopped.assemble(&Start::default()).expect("closed");
        start.v[turn(&stopped)] = 3.0;
        let run = go(&mut begin(&stopped, &start), 0.02, 0.001);
        assert!(run.contacts.iter().any(|(_, event)| event.point == 0 && event.made));
        let farthest = run.rows.iter().fold(0.0, |s, row| f64::max(s, row.q[turn(&stopped)]));
        assert!(farthest < 0.04, "{farthest}");
    }
}

/// Crank and slider with the joint between crank and rod in the tree, and the rod's end cut.
fn crank_slider(in_tree: Option<Clearance>, in_cut: Option<Clearance>) -> Mechanism {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let body = RigidInertia::solid_cylinder(1000.0, 0.05, 0.3, &Vector3::x());
    let [crank, rod, slider] = ["crank", "rod", "slider"].map(|name| linkage.link(name, body));
    let ground = Mount::at_origin(Linkage::GROUND);
    linkage.joint("A", Joint::revolute_z(), ground, Mount::at_origin(crank));
    let pin = linkage.joint(
        "B",
        Joint::revolute_z(),
        Mount::at(crank, [0.1, 0.0, 0.0]),
        Mount::at_origin(rod),
    );
    let axis = Vector3::x_axis();
    linkage.joint("S", Joint::Prismatic { axis }, ground, Mount::at_origin(slider));
    let end = linkage.cut(
        "C",
        Joint::revolute_z(),
        Mount::at(rod, [0.3, 0.0, 0.0]),
        Mount::at_origin(slider),
    );
    if let Some(clearance) = in_tree {
        linkage.clearance(pin, clearance);
    }
    if let Some(clearance) = in_cut {
        linkage.clearance(end, clearance);
    }
    linkage.build().expect("valid")
}

#[test]
fn a_start_is_centred_unless_it_says_otherwise() {
    let named = |list: &[(&str, f64)]| list.iter().map(|&(name, x)| (name.to_owned(), x)).collect::<Vec<_>>();
    let mut start = Start {
        positions: named(&[("A", 1.0), ("B", -1.2), ("S", 0.35)]),
        held: vec!["A".into()],
        speeds: named(&[("A", 4.0)]),
    };
    let (ideal, _) = crank_slider(None, None).assemble(&start).expect("closed");
    for model in [ClearanceModel::Planar, SPATIAL] {
        let mechanism = crank_slider(Some(clearance(model, CLEARANCE)), None);
        let (loose, _) = mechanism.assemble(&start).expect("closed");
        let names: Vec<&str> = mechanism.coordinate_names().collect();
        let of = |values: &[f64], name: &str| values[names.iter().position(|&known| known == name).expect(name)];
        for (k, name) in ["A", "B", "S"].into_iter().enumerate() {
            assert!((of(&loose.q, name) - ideal.q[k]).abs() < 1e-14 && (of(&loose.v, name) - ideal.v[k]).abs() < 1e-13);
        }
        let added = names.iter().filter(|name| name.starts_with("B."));
        assert!(
            added.clone().count() > 1
                && added
                    .clone()
                    .all(|name| of(&loose.q, name) == 0.0 && of(&loose.v, name) == 0.0)
        );

        start.positions.push(("B.x".into(), -0.9e-3));
        start.speeds.push(("B.y".into(), 0.01));
        let (aside, _) = mechanism.assemble(&start).expect("closed");
        assert_eq!((of(&aside.q, "B.x"), of(&aside.v, "B.y")), (-0.9e-3, 0.01));
        assert_eq!(of(&aside.q, "A"), 1.0);
        let simulation = &mut Simulation::new(&mechanism);
        let y = simulation.state_vector(&aside);
        let mut seen = Observation::default();
        simulation.observe(0.0, &y, &mut seen).expect("regular");
        assert!(seen.violation.0 < 1e-14 && seen.violation.1 < 1e-13);
        assert!(
            (seen.contacts[0].depth + 0.1e-3).abs() < 1e-15 && (seen.contacts[0].journal[0] + 0.9e-3).abs() < 1e-15
        );
        start.positions.pop();
        start.speeds.pop();
    }
}

#[test]
fn clearance_in_the_tree_and_in_a_cut_joint_go_together() {
    let (pin, end) = (clearance(SPATIAL, 1e-3), clearance(ClearanceModel::Planar, 5e-4));
    let mechanism = crank_slider(Some(pin), Some(end));
    let start = Start {
        positions: vec![("A".into(), 1.0), ("B".into(), -1.2), ("S".into(), 0.35)],
        held: vec!["A".into()],
        speeds: vec![("A".into(), 4.0)],
    };
    let (start, _) = mechanism.assemble(&start).expect("closed");
    let run = go(&mut begin(&mechanism, &start), 0.1, 0.01);
    assert_eq!(mechanism.contact_names().collect::<Vec<_>>(), ["B1", "B2", "C"]);
    let sizes: Vec<f64> = mechanism.clearances().flatten().collect();
    let (first, last) = (&run.rows[0], run.rows.last().expect("rows"));
    for (point, size) in first.contacts.iter().zip(&sizes) {
        assert!((point.depth + size).abs() < 1e-14, "{} {size}", point.depth);
    }
    for point in 0..3 {
        assert!(run.contacts.iter().any(|(_, event)| event.point == point), "{point}");
    }
    let lost: f64 = last.integrals.chunks(4).map(|one| one[0] + one[1]).sum();
    assert!(lost > 1e-4 && (last.work + lost).abs() < 1e-9, "{} {lost}", last.work);
    assert!((last.energy_balance() - first.energy_balance()).abs() < 1e-8);
}

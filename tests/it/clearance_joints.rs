//! Clearance in a joint of the tree and in the same joint cut, planar, spatial and of a ball: one motion, a closed balance, names that
//! tell the truth, and the ideal joint in the limit.

use crate::clearance::{Run, go, integration_to};
use linkdyn_contact::{ContactLaw, Fit, ForcePoint, NormalLaw, RestitutionLaw};
use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::{BristleStart, ElastoPlastic, Guard, LuGre};
use linkdyn_kinematics::{Joint, Pose, Positions, Velocities};
use linkdyn_mechanisms::analysis::mobility;
use linkdyn_mechanisms::{
    Clearance, ClearanceModel, Drive, JointHandle, Limit, LinkHandle, Linkage, Mechanism, Mount, Observation,
    PrescribedMotion, Side, Simulation, Spring, Start, State,
};
use nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};

/// Radial clearance \[m\].
const CLEARANCE: f64 = 1e-3;

fn lugre() -> LuGre {
    LuGre {
        static_coefficient: 0.2,
        kinetic_coefficient: 0.1,
        stribeck_speed: 0.02,
        bristle_stiffness: 600.0,
        bristle_damping: 10.0,
        viscous_coefficient: 0.01,
        guard: Guard::Cap,
    }
}

fn clearance(model: ClearanceModel, size: f64) -> Clearance {
    Clearance {
        fit: Fit::new(0.004 + size, 0.004).expect("a pin in a hole"),
        bearing: Side::Predecessor,
        model,
        law: ContactLaw::from(NormalLaw::new(1e9, 1.5, RestitutionLaw::Exact.with(0.6)).expect("in range")),
        friction: Some(lugre().into()),
        bristle_start: BristleStart::default(),
        force_point: ForcePoint::default(),
    }
}

/// Contacts that hardly bounce, so that the journal soon slides in its bearing and the place of contact moves far.
fn dead(mut clearance: Clearance, stiffness: f64) -> Clearance {
    let damping = RestitutionLaw::Exact.with(0.2);
    clearance.law = NormalLaw::new(stiffness, 1.5, damping).expect("in range").into();
    clearance
}

fn skew() -> Unit<Vector3<f64>> {
    Unit::new_normalize(Vector3::new(0.3, -0.5, 0.8))
}

const SPATIAL: ClearanceModel = ClearanceModel::Spatial { length: 0.02 };

type Kind = (Joint, ClearanceModel, &'static [(&'static str, f64)]);

/// Every joint that may have clearance, with speeds of the joint itself.
fn kinds() -> [Kind; 4] {
    let revolute = Joint::Revolute { axis: skew() };
    [
        (revolute, ClearanceModel::Planar, &[("J", 3.0)]),
        (revolute, SPATIAL, &[("J", 3.0)]),
        (
            Joint::Spherical,
            ClearanceModel::Spherical,
            &[("J.qx", 2.0), ("J.qz", -3.0)],
        ),
        (
            Joint::SphericalZyx,
            ClearanceModel::Spherical,
            &[("J.psi", 2.0), ("J.phi", -3.0)],
        ),
    ]
}

/// An arm that hangs on the ground by two turns, and a rod on it by the joint J.
#[derive(Clone)]
struct Hung {
    hinge: Joint,
    joint: Joint,
    clearance: Option<Clearance>,
    /// Where everything is.
    place: Pose,
    /// In the axes of that place \[m/s^2\].
    gravity: Vector3<f64>,
    inertias: [RigidInertia; 2],
    /// Frames of J on the arm and on the rod.
    frames: [Pose; 2],
    speeds: Vec<(String, f64)>,
}

impl Hung {
    fn new(joint: Joint, clearance: Option<Clearance>, speeds: &[(&str, f64)]) -> Self {
        let tensor = Matrix3::new(0.03, 0.004, -0.002, 0.004, 0.025, 0.001, -0.002, 0.001, 0.02);
        let body = |mass, com: [f64; 3]| RigidInertia {
            mass,
            com: Vector3::from(com),
            about_com: tensor,
        };
        let frame = |axis: Vector3<f64>, angle, origin: [f64; 3]| Pose {
            origin: Vector3::from(origin),
            ..Pose::turn(Unit::new_normalize(axis), angle)
        };
        let own = speeds.iter().map(|&(name, v)| (name.to_owned(), v));
        let (first, second) = (Vector3::y_axis(), Vector3::z_axis());
        Self {
            hinge: Joint::Universal { first, second },
            joint,
            clearance,
            place: Pose::identity(),
            gravity: Vector3::new(0.5, -9.0, 1.0),
            inertias: [body(1.2, [0.2, 0.05, -0.03]), body(0.8, [0.15, -0.05, 0.1])],
            frames: [
                frame(Vector3::new(1.0, 2.0, -1.0), 0.7, [0.4, 0.0, 0.1]),
                frame(Vector3::new(-1.0, 0.5, 1.0), 1.1, [-0.1, 0.02, 0.0]),
            ],
            speeds: own
                .chain([("hinge.psi".into(), 1.0), ("hinge.theta".into(), -2.0)])
                .collect(),
        }
    }

    /// All in a plane: turns about z only, and bodies that are symmetric about it.
    fn flat(joint: Joint, model: ClearanceModel, turn: &str) -> Self {
        let mut hung = Self::new(joint, Some(dead(clearance(model, CLEARANCE), 1e9)), &[]);
        hung.hinge = Joint::revolute_z();
        hung.gravity.z = 0.0;
        hung.frames = [Pose::translation(0.4, 0.1, 0.0), Pose::translation(-0.1, 0.02, 0.0)];
        for body in &mut hung.inertias {
            body.com.z = 0.0;
            body.about_com = Matrix3::from_diagonal_element(0.02);
        }
        hung.speeds = vec![(turn.into(), 3.0), ("hinge".into(), -2.0)];
        hung
    }

    fn begin(&self) -> (Linkage, LinkHandle, Mount, Mount) {
        let gravity = self.place.rotation * self.gravity;
        let mut linkage = Linkage::new(gravity.into());
        let arm = linkage.link("arm", self.inertias[0]);
        let rod = linkage.link("rod", self.inertias[1]);
        let on_ground = Mount::with_pose(Linkage::GROUND, self.place);
        linkage.joint("hinge", self.hinge, on_ground, Mount::at_origin(arm));
        (
            linkage,
            rod,
            Mount::with_pose(arm, self.frames[0]),
            Mount::with_pose(rod, self.frames[1]),
        )
    }

    fn tree(&self) -> Linkage {
        let (mut linkage, _, one, two) = self.begin();
        let joint = linkage.joint("J", self.joint, one, two);
        if let Some(clearance) = &self.clearance {
            linkage.clearance(joint, clearance.clone());
        }
        linkage
    }

    /// The rod floats, and J is cut.
    fn cut(&self) -> Linkage {
        let (mut linkage, rod, one, two) = self.begin();
        let (ground, free) = (Mount::at_origin(Linkage::GROUND), Mount::at_origin(rod));
        linkage.joint("float", Joint::Free, ground, free);
        let cut = linkage.cut("J", self.joint, one, two);
        if let Some(clearance) = &self.clearance {
            linkage.clearance(cut, clearance.clone());
        }
        linkage
    }

    fn start(&self, tree: &Mechanism) -> State {
        let start = Start {
            speeds: self.speeds.clone(),
            ..Start::default()
        };
        tree.assemble(&start).expect("closed").0
    }

    fn run(&self, until: f64) -> (Mechanism, Run) {
        let tree = self.tree().build().expect("valid");
        let start = self.start(&tree);
        let run = go(&mut begin(&tree, &start), until, until / 200.0);
        (tree, run)
    }

    fn run_cut(&self, until: f64) -> (Mechanism, Run) {
        let tree = self.tree().build().expect("valid");
        let start = self.start(&tree);
        let system = tree.system();
        let (mut places, mut motions) = (Positions::new(system.tree()), Velocities::new(system.tree()));
        system.tree().positions(&start.q, &mut places);
        system.tree().velocities(&places, &start.v, &mut motions);
        let frame = tree.attachment("rod").expect("there is one");
        let node = places.pose(frame.link);
        let pose = node * frame.pose;
        let twist = motions.nodes()[frame.link.node()];
        let speed = twist.linear + twist.angular.cross(&(pose.origin - node.origin));
        let spin = pose.rotation.tr_mul(&twist.angular);
        let turned = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(pose.rotation));
        let hinge = self.hinge.speeds();
        let (mut q, mut v) = (start.q[..hinge].to_vec(), start.v[..hinge].to_vec());
        q.extend(pose.origin.iter());
        q.extend([turned.w, turned.i, turned.j, turned.k]);
        v.extend(speed.iter().chain(spin.iter()));
        let cut = self.cut().build().expect("valid");
        let run = go(&mut begin(&cut, &State { q, v }), until, until / 200.0);
        (cut, run)
    }
}

/// The differences between forms are errors of integration, which contacts magnify: they fall with the tolerance.
fn begin(
    mechanism: &Mechanism,
    start: &State,
) -> linkdyn_integrators::Integration<Simulation, linkdyn_integrators::Dop853> {
    let simulation = Simulation::new(mechanism);
    let y = simulation.state_vector(start);
    integration_to(1e-13, simulation, (0.0, &y))
}

/// Pose of the rod at the state of a row.
fn rod(mechanism: &Mechanism, row: &Observation) -> Pose {
    let mut places = Positions::new(mechanism.system().tree());
    mechanism.system().tree().positions(&row.q, &mut places);
    let frame = mechanism.attachment("rod").expect("there is one");
    places.pose(frame.link) * frame.pose
}

/// Largest distance of the rods of two runs over all rows \[m, -\].
fn apart((one, first): &(Mechanism, Run), (two, second): &(Mechanism, Run)) -> f64 {
    assert_eq!(first.rows.len(), second.rows.len());
    let rows = first.rows.iter().zip(&second.rows);
    rows.fold(0.0, |worst: f64, (a, b)| {
        let (a, b) = (rod(one, a), rod(two, b));
        worst
            .max((a.rotation - b.rotation).amax())
            .max((a.origin - b.origin).amax())
    })
}

/// Largest difference of what can be seen of contacts, but for their forces \[m, m/s\].
fn contacts_apart(first: &Run, second: &Run) -> f64 {
    let rows = first.rows.iter().zip(&second.rows);
    rows.fold(0.0, |worst: f64, (a, b)| {
        a.contacts.iter().zip(&b.contacts).fold(worst, |worst, (a, b)| {
            let lengths = |c: &linkdyn_mechanisms::ContactPoint| [[c.depth, 0.0, 0.0], c.bristle, c.journal].concat();
            let (a, b) = (lengths(a), lengths(b));
            a.iter().zip(&b).fold(worst, |worst, (a, b)| worst.max((a - b).abs()))
        })
    })
}

#[test]
fn a_joint_of_the_tree_and_the_same_joint_cut_move_alike() {
    for (joint, model, speeds) in kinds() {
        for bearing in [Side::Predecessor, Side::Successor] {
            let clearance = Clearance {
                bearing,
                ..clearance(model, CLEARANCE)
            };
            let hung = Hung::new(joint, Some(clearance), speeds);
            let (tree, cut) = (hung.run(0.06), hung.run_cut(0.06));
            let (made, touching) = (tree.1.contacts.len(), |row: &&Observation| {
                row.contacts.iter().any(|point| point.tangent != [0.0; 3])
            });
            assert!(made > 2, "{joint:?}: {made}");
            assert!(tree.1.rows.iter().filter(touching).count() > 2, "{joint:?}");
            let told = |run: &Run| -> Vec<(usize, bool)> {
                run.contacts
                    .iter()
                    .map(|(_, event)| (event.point, event.made))
                    .collect()
            };
            assert_eq!(told(&tree.1), told(&cut.1), "{joint:?}");
            let (rods, points) = (apart(&tree, &cut), contacts_apart(&tree.1, &cut.1));
            assert!(
                rods < 1e-9 && points < 1e-9,
                "{joint:?}, {model:?}, {bearing:?}: {rods:e} {points:e}"
            );
        }
    }
}

#[test]
fn energy_is_stored_or_lost_in_the_contact() {
    for (joint, model, speeds) in kinds() {
        for force_point in [ForcePoint::Common, ForcePoint::OwnSurface] {
            let clearance = Clearance {
                force_point,
                ..clearance(model, CLEARANCE)
            };
            let (_, run) = Hung::new(joint, Some(clearance), speeds).run(0.06);
            let (first, last) = (&run.rows[0], run.rows.last().expect("rows"));
            let lost: f64 = last.integrals.chunks(4).map(|one| one[0] + one[1]).sum();
            assert!(lost > 1e-4 && last.integrals[1] > 1e-6, "{joint:?}: {lost}");
            assert!((last.work + lost).abs() < 1e-9, "{joint:?}: {} {lost}", last.work);
            for row in &run.rows {
                let change = row.energy_balance() - first.energy_balance();
                assert!(change.abs() < 1e-8, "{joint:?}, {model:?} at {}: {change:e}", row.t);
            }
        }
    }
}

#[test]
fn the_bristle_of_a_ball_lies_in_the_plane_of_contact_and_keeps_its_limit() {
    let (joint, model, speeds) = kinds()[2];
    let elasto_plastic = ElastoPlastic {
        lugre: lugre(),
        elastic_share: 0.5,
    };
    // Bristle damping comes on top of an elastic bristle, up to the same again.
    for (friction, bristle_start, limit) in [
        (lugre().into(), BristleStart::Relaxed, 0.2),
        (elasto_plastic.into(), BristleStart::Steady, 0.4),
    ] {
        let clearance = Clearance {
            friction: Some(friction),
            bristle_start,
            ..dead(clearance(model, CLEARANCE), 1e9)
        };
        let (_, run) = Hung::new(joint, Some(clearance), speeds).run(0.2);
        // How long the last contact has lasted, and where it began.
        let (mut since, mut first, mut turned) = (0.0, Vector3::zeros(), 0.0_f64);
        for row in run.rows.iter().filter(|row| row.contacts[0].impact_speed > 0.0) {
            let point = &row.contacts[0];
            let [e, z, force, slip] = [point.journal, point.bristle, point.tangent, point.slip].map(Vector3::from);
            assert!((e.norm() - CLEARANCE - point.depth).abs() < 1e-15);
            assert!(
                e.dot(&z).abs() < 1e-9 * CLEARANCE && z.norm() <= 0.2 / 600.0 * (1.0 + 1e-9),
                "{e} {z}"
            );
            assert!(e.dot(&force).abs() < 1e-12 * point.normal.max(1.0) && e.dot(&slip).abs() < 1e-15);
            assert!(force.norm() <= (limit + 0.01 * slip.norm()) * point.normal * (1.0 + 1e-9));
            let made = run
                .contacts
                .iter()
                .rev()
                .find(|(t, event)| event.made && *t <= row.t)
                .expect("made")
                .0;
            if made > since {
                (since, first) = (made, e);
            }
            turned = turned.max(e.angle(&first));
        }
        // The plane of contact does turn while the contact lasts.
        assert!(turned > 0.3, "{turned}");
    }
}

#[test]
fn a_ball_in_a_plane_is_a_pin() {
    let pin = Hung::flat(Joint::revolute_z(), ClearanceModel::Planar, "J").run(0.2);
    assert!(pin.1.contacts.len() > 2, "{}", pin.1.contacts.len());
    for (joint, turn) in [(Joint::Spherical, "J.qz"), (Joint::SphericalZyx, "J.psi")] {
        let ball = Hung::flat(joint, ClearanceModel::Spherical, turn).run(0.2);
        let rods = apart(&pin, &ball);
        assert!(rods < 1e-9, "{joint:?}: {rods:e}");
        for (a, b) in pin.1.rows.iter().zip(&ball.1.rows) {
            let (a, b) = (&a.contacts[0], &b.contacts[0]);
            assert!(
                (a.depth - b.depth).abs() < 1e-10 && (a.normal - b.normal).abs() < 1e-3,
                "{a:?} {b:?}"
            );
            assert!(
                (a.bristle[0].abs() - Vector3::from(b.bristle).norm()).abs() < 1e-9,
                "{a:?} {b:?}"
            );
            assert!(
                (a.tangent[0].abs() - Vector3::from(b.tangent).norm()).abs() < 1e-3,
                "{a:?} {b:?}"
            );
            assert!(b.bristle[2].abs() < 1e-15 && b.journal[2].abs() < 1e-15);
        }
    }
}

#[test]
fn nothing_changes_where_everything_is_turned_and_moved() {
    let place = Pose {
        origin: Vector3::new(0.3, -0.7, 0.2),
        ..Pose::turn(Unit::new_normalize(Vector3::new(-0.4, 0.9, 0.6)), 2.1)
    };
    for (joint, model, speeds) in kinds() {
        let here = Hung::new(joint, Some(clearance(model, CLEARANCE)), speeds);
        let there = Hung { place, ..here.clone() };
        let ((_, one), (_, two)) = (here.run(0.06), there.run(0.06));
        let coordinates = one.rows.iter().zip(&two.rows).flat_map(|(a, b)| a.q.iter().zip(&b.q));
        let worst = coordinates.fold(contacts_apart(&one, &two), |worst, (a, b)| worst.max((a - b).abs()));
        assert!(worst < 1e-9, "{joint:?}, {model:?}: {worst:e}");
    }
}

#[test]
fn small_clearance_is_the_ideal_joint() {
    for (joint, model, speeds) in kinds() {
        let ideal = match joint {
            Joint::Spherical => vec![("J.x", 2.0), ("J.z", -3.0)],
            _ => speeds.to_vec(),
        };
        let ideal = Hung::new(joint, None, &ideal).run(0.05);
        let error = |size: f64| {
            // A bearing as long as the rod, that tilts shall count no more than the rest.
            let model = match model {
                ClearanceModel::Spatial { .. } => ClearanceModel::Spatial { length: 0.3 },
                other => other,
            };
            // So stiff that it is the clearance that counts.
            let mut clearance = dead(clearance(model, size), 1e11);
            clearance.friction = None;
            let run = Hung::new(joint, Some(clearance), speeds).run(0.05);
            apart(&run, &ideal)
        };
        for size in [1e-3, 1e-4, 1e-5] {
            let share = error(size) / size;
            assert!((0.3..20.0).contains(&share), "{joint:?}, {model:?}, {size:e}: {share}");
        }
    }
}

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
        let lines = [
            format!(", {kind} clearance) - rod\n"),
            format!(", {kind} clearance) - rod\n"),
        ];
        assert!(
            described[0].contains(&lines[0]) && described[1].contains(&lines[1]),
            "{described:?}"
        );
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

//! A rod on an arm by a joint with clearance, in the tree and cut: for the tests of such joints.

use crate::clearance::{Run, go, integration_to};
use linkdyn_contact::{ContactLaw, Fit, ForcePoint, NormalLaw, RestitutionLaw};
use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::{BristleStart, Guard, LuGre};
use linkdyn_kinematics::{Joint, Pose, Positions, Velocities};
use linkdyn_mechanisms::{
    Clearance, ClearanceModel, LinkHandle, Linkage, Mechanism, Mount, Observation, Side, Simulation, Start, State,
};
use nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};

/// Radial clearance \[m\].
pub const CLEARANCE: f64 = 1e-3;

pub fn lugre() -> LuGre {
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

pub fn clearance(model: ClearanceModel, size: f64) -> Clearance {
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
pub fn dead(mut clearance: Clearance, stiffness: f64) -> Clearance {
    let damping = RestitutionLaw::Exact.with(0.2);
    clearance.law = NormalLaw::new(stiffness, 1.5, damping).expect("in range").into();
    clearance
}

pub fn skew() -> Unit<Vector3<f64>> {
    Unit::new_normalize(Vector3::new(0.3, -0.5, 0.8))
}

pub const SPATIAL: ClearanceModel = ClearanceModel::Spatial { length: 0.02 };

pub type Kind = (Joint, ClearanceModel, &'static [(&'static str, f64)]);

/// Every joint that may have clearance, with speeds of the joint itself.
pub fn kinds() -> [Kind; 4] {
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
pub struct Hung {
    pub hinge: Joint,
    pub joint: Joint,
    pub clearance: Option<Clearance>,
    /// Where everything is.
    pub place: Pose,
    /// In the axes of that place \[m/s^2\].
    pub gravity: Vector3<f64>,
    pub inertias: [RigidInertia; 2],
    /// Frames of J on the arm and on the rod.
    pub frames: [Pose; 2],
    pub speeds: Vec<(String, f64)>,
}

impl Hung {
    pub fn new(joint: Joint, clearance: Option<Clearance>, speeds: &[(&str, f64)]) -> Self {
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
    pub fn flat(joint: Joint, model: ClearanceModel, turn: &str) -> Self {
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

    pub fn begin(&self) -> (Linkage, LinkHandle, Mount, Mount) {
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

    pub fn tree(&self) -> Linkage {
        let (mut linkage, _, one, two) = self.begin();
        let joint = linkage.joint("J", self.joint, one, two);
        if let Some(clearance) = &self.clearance {
            linkage.clearance(joint, clearance.clone());
        }
        linkage
    }

    /// The rod floats, and J is cut.
    pub fn cut(&self) -> Linkage {
        let (mut linkage, rod, one, two) = self.begin();
        let (ground, free) = (Mount::at_origin(Linkage::GROUND), Mount::at_origin(rod));
        linkage.joint("float", Joint::Free, ground, free);
        let cut = linkage.cut("J", self.joint, one, two);
        if let Some(clearance) = &self.clearance {
            linkage.clearance(cut, clearance.clone());
        }
        linkage
    }

    pub fn start(&self, tree: &Mechanism) -> State {
        let start = Start {
            speeds: self.speeds.clone(),
            ..Start::default()
        };
        tree.assemble(&start).expect("closed").0
    }

    pub fn run(&self, until: f64) -> (Mechanism, Run) {
        let tree = self.tree().build().expect("valid");
        let start = self.start(&tree);
        let run = go(&mut begin(&tree, &start), until, until / 200.0);
        (tree, run)
    }

    pub fn run_cut(&self, until: f64) -> (Mechanism, Run) {
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
pub fn begin(
    mechanism: &Mechanism,
    start: &State,
) -> linkdyn_integrators::Integration<Simulation, linkdyn_integrators::Dop853> {
    let simulation = Simulation::new(mechanism);
    let y = simulation.state_vector(start);
    integration_to(1e-13, simulation, (0.0, &y))
}

/// Pose of the rod at the state of a row.
pub fn rod(mechanism: &Mechanism, row: &Observation) -> Pose {
    let mut places = Positions::new(mechanism.system().tree());
    mechanism.system().tree().positions(&row.q, &mut places);
    let frame = mechanism.attachment("rod").expect("there is one");
    places.pose(frame.link) * frame.pose
}

/// Largest distance of the rods of two runs over all rows \[m, -\].
pub fn apart((one, first): &(Mechanism, Run), (two, second): &(Mechanism, Run)) -> f64 {
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
pub fn contacts_apart(first: &Run, second: &Run) -> f64 {
    let rows = first.rows.iter().zip(&second.rows);
    rows.fold(0.0, |worst: f64, (a, b)| {
        a.contacts.iter().zip(&b.contacts).fold(worst, |worst, (a, b)| {
            let lengths = |c: &linkdyn_mechanisms::ContactPoint| [[c.depth, 0.0, 0.0], c.bristle, c.journal].concat();
            let (a, b) = (lengths(a), lengths(b));
            a.iter().zip(&b).fold(worst, |worst, (a, b)| worst.max((a - b).abs()))
        })
    })
}

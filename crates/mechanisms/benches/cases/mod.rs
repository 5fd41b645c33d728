//! States at which one evaluation is timed, and whole runs. Each bench uses some of them.

#![allow(dead_code)]

use linkdyn_mechanisms::catalogue::{Rsrrr, rsrrr};
use linkdyn_mechanisms::dynamics::{Description, RigidInertia, System, Workspace};
use linkdyn_mechanisms::integrators::{Adams, Dop853, Integration, Method, Progress};
use linkdyn_mechanisms::kinematics::{Joint, LinkId, Pose, Tree};
use linkdyn_mechanisms::{Mechanism, Simulation};
use nalgebra::{SMatrix, SVector, Vector3};

/// A system with a state in full motion.
pub struct Case {
    pub system: System,
    pub work: Workspace,
    pub t: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
}

impl Case {
    /// State to accelerations and multipliers.
    pub fn evaluate(&mut self) {
        let state = std::hint::black_box((self.t, self.q.as_slice(), self.v.as_slice()));
        let result = self.system.evaluate(state.0, state.1, state.2, &mut self.work);
        result.expect("the benchmark states are regular");
        std::hint::black_box(self.work.rates());
    }
}

/// RSRRR near its steady motion: the crank at 1 rad turns with 8.5 rad/s.
pub fn rsrrr_case(friction: bool) -> Case {
    let scene = rsrrr(&Rsrrr {
        friction,
        ..Rsrrr::default()
    });
    let mechanism: Mechanism = scene.linkage.build().expect("the catalogue builds");
    let mut start = scene.start.clone();
    start.positions[0].1 = 1.0;
    start.speeds.push(("psi11".into(), 8.5));
    let (state, _) = mechanism.assemble(&start).expect("the crank turns fully");
    let simulation = Simulation::new(&mechanism);
    assert_eq!(simulation.layout().coordinates.len(), 4);
    Case {
        work: Workspace::new(mechanism.system()),
        system: mechanism.system().clone(),
        t: 2.5,
        q: state.q,
        v: state.v,
    }
}

/// Open chain of `n` revolute joints with twisted axes and solid links.
pub fn chain_case(n: usize) -> Case {
    let mut tree = Tree::new();
    let mut last = LinkId::GROUND;
    let mut inertias = Vec::new();
    for k in 0..n {
        let twist = Pose::turn(Vector3::x_axis(), 0.3 + 0.1 * k as f64);
        let placement = Pose::translation(if k == 0 { 0.0 } else { 0.3 }, 0.0, 0.0) * twist;
        last = tree
            .attach(last, placement, Joint::revolute_z())
            .expect("the placement is rigid");
        inertias.push(RigidInertia::solid_cylinder(7850.0, 0.03, 0.3, &Vector3::x()));
    }
    let system = System::new(Description::new(tree, inertias, Vector3::new(0.0, 0.0, -9.81))).expect("valid");
    Case {
        work: Workspace::new(&system),
        system,
        t: 0.0,
        q: (0..n).map(|k| (0.7 * k as f64).sin()).collect(),
        v: (0..n).map(|k| (1.3 * k as f64).cos()).collect(),
    }
}

/// The unit of the tables: factor and solve of one dense 7 x 7 system.
pub fn lu7() -> impl FnMut() {
    let a =
        SMatrix::<f64, 7, 7>::from_fn(|i, j| 1.0 / (1.0 + i as f64 + 2.0 * j as f64) + if i == j { 3.0 } else { 0.0 });
    let b = SVector::<f64, 7>::from_fn(|i, _| 1.0 + i as f64);
    move || {
        let x = std::hint::black_box(a).lu().solve(std::hint::black_box(&b));
        std::hint::black_box(x);
    }
}

/// The whole RSRRR scene without output.
pub struct WholeRun {
    mechanism: Mechanism,
    y: Vec<f64>,
    stops: Vec<f64>,
}

/// Absolute tolerances at which the crank angle stays within 1e-9 of the reference at the ends of all steps.
const TOLERANCE_DOP853: f64 = 3e-9;
const TOLERANCE_ADAMS: f64 = 1e-10;

impl WholeRun {
    pub fn rsrrr(friction: bool) -> Self {
        let scene = rsrrr(&Rsrrr {
            friction,
            ..Rsrrr::default()
        });
        let mechanism = scene.linkage.build().expect("the catalogue builds");
        let (start, _) = mechanism.assemble(&scene.start).expect("the scene closes");
        Self {
            y: Simulation::new(&mechanism).state_vector(&start),
            stops: mechanism.system().stop_times(),
            mechanism,
        }
    }

    /// Crank angle at 5 s, and evaluations.
    pub fn by_dop853(&self) -> (f64, u64) {
        self.by(Dop853::default(), TOLERANCE_DOP853)
    }

    /// Crank angle at 5 s, and evaluations.
    pub fn by_adams(&self) -> (f64, u64) {
        self.by(Adams::default(), TOLERANCE_ADAMS)
    }

    fn by(&self, method: impl Method<Simulation>, tolerance: f64) -> (f64, u64) {
        let mut simulation = Simulation::new(std::hint::black_box(&self.mechanism));
        simulation.set_drift_tolerance(0.1 * tolerance);
        let settings = simulation.settings(0.0, tolerance);
        let integration = Integration::new(simulation, method, 0.0, &self.y, settings).expect("valid settings");
        let mut integration = integration.with_stops(&self.stops).expect("finite stops");
        while !matches!(integration.advance(5.0).expect("smooth"), Progress::Done { .. }) {}
        (integration.state().1[0], integration.statistics().evaluations)
    }
}

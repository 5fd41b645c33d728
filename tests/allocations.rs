//! Accepted steps allocate nothing after the first, and events nothing after the first: every method on every scene. (A target of its
//! own: it replaces the global allocator.)

use linkdyn_integrators::{Equations, Form, GeneralisedAlpha, Integration, Method, Ode, Radau5, Settings};
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::catalogue::bristle;
use linkdyn_mechanisms::contact::{Fit, ForcePoint, KelvinVoigt};
use linkdyn_mechanisms::dynamics::RigidInertia;
use linkdyn_mechanisms::friction::{BristleStart, Guard, LuGre};
use linkdyn_mechanisms::{
    Clearance, ClearanceModel, ConstrainedMechanism, Linkage, Mechanism, Mount, Side, Simulation, State,
};
use linkdyn_tests::methods::adaptive;
use linkdyn_tests::scenes::{builtin, ready_rsrrr};
use nalgebra::Vector3;

/// Steps before the count and in it.
const WARM_UP: usize = 40;
const COUNTED: usize = 100;

/// Allocations of one step; unknown if a state was refused on the way: as where a step leads too deep into a contact, it comes with its cause in
/// a box and with names.
fn step<P: Ode, M: Method<P>>(run: &mut Integration<P, M>) -> Option<u64> {
    let retries = run.statistics().retries;
    let counted = allocation_counter::measure(|| {
        run.advance(5.0).expect("regular");
    });
    (run.statistics().retries == retries).then_some(counted.count_total)
}

/// Allocations of so many steps, of which few are unknown.
fn counted<P: Ode, M: Method<P>>(run: &mut Integration<P, M>) -> u64 {
    let known: Vec<u64> = (0..COUNTED).filter_map(|_| step(run)).collect();
    assert!(known.len() > COUNTED / 2, "only {} steps were counted", known.len());
    known.iter().sum()
}

/// Allocations of further steps, and where there is clearance of the steps that make or lose two contacts.
fn allocations(mechanism: &Mechanism, start: &State, method: Box<dyn Method<Simulation>>) -> u64 {
    let simulation = Simulation::new(mechanism);
    let y = simulation.state_vector(start);
    let settings = simulation.settings(1e-7, 1e-7);
    let events = if simulation.roots() > 0 { 2 } else { 0 };
    let mut run = Integration::new(simulation, method, 0.0, &y, settings).expect("valid");
    for _ in 0..WARM_UP {
        step(&mut run);
    }
    while run.statistics().events < events {
        step(&mut run);
    }
    let mut allocated = counted(&mut run);
    while run.statistics().events < 2 * events {
        allocated += step(&mut run).unwrap_or(0);
    }
    allocated
}

#[test]
fn steps_and_events_allocate_nothing() {
    for (scene, ready) in builtin() {
        for (name, method) in adaptive() {
            assert_eq!(
                allocations(&ready.mechanism, &ready.start, method),
                0,
                "{scene}, {name}"
            );
        }
    }
}

/// An arm on a pin with clearance, a rod on the arm by a ball with clearance: both in the tree, with friction.
fn loose_arm() -> Mechanism {
    let clearance = |model| Clearance {
        fit: Fit::new(0.005, 0.004).expect("a pin in a hole"),
        bearing: Side::Predecessor,
        model,
        law: KelvinVoigt {
            stiffness: 1e6,
            damping: 100.0,
        }
        .into(),
        friction: Some(
            LuGre {
                guard: Guard::Cap,
                ..bristle()
            }
            .into(),
        ),
        bristle_start: BristleStart::default(),
        force_point: ForcePoint::default(),
    };
    let mut linkage = Linkage::new([0.0, -9.81, 1.0]);
    let inertia = RigidInertia::solid_cylinder(7800.0, 0.02, 0.3, &Vector3::x());
    let [arm, rod] = ["arm", "rod"].map(|name| linkage.link(name, inertia));
    let pin = Joint::revolute_z();
    let pin = linkage.joint("pin", pin, Mount::at_origin(Linkage::GROUND), Mount::at_origin(arm));
    let ball = linkage.joint(
        "ball",
        Joint::Spherical,
        Mount::at(arm, [0.3, 0.0, 0.0]),
        Mount::at_origin(rod),
    );
    linkage.clearance(pin, clearance(ClearanceModel::Spatial { length: 0.02 }));
    linkage.clearance(ball, clearance(ClearanceModel::Spherical));
    linkage.build().expect("valid")
}

#[test]
fn steps_and_contacts_of_joints_of_the_tree_allocate_nothing() {
    let mechanism = loose_arm();
    let tree = mechanism.system().tree();
    let start = State {
        q: tree.neutral(),
        v: vec![0.0; tree.speeds()],
    };
    for (name, method) in adaptive() {
        assert_eq!(allocations(&mechanism, &start, method), 0, "{name}");
    }
}

/// Nor do steps with multipliers as unknowns.
#[test]
fn steps_of_constrained_forms_allocate_nothing() {
    fn check<M: Method<Equations<ConstrainedMechanism>>>(form: Form, method: M) {
        let ready = ready_rsrrr(false, 1.0);
        let motion = ConstrainedMechanism::new(&ready.mechanism).expect("no friction");
        let mut equations = Equations::new(motion, form).with_projection();
        let y = equations.start(0.0, &ready.start.q, &ready.start.v).expect("closed");
        let mut run = Integration::new(equations, method, 0.0, &y, Settings::tolerances(1e-6, 1e-6)).expect("it fits");
        for _ in 0..WARM_UP {
            step(&mut run);
        }
        assert_eq!(counted(&mut run), 0, "{form:?}");
    }
    for form in [
        Form::Explicit,
        Form::Index1,
        Form::Index2,
        Form::Stabilised,
        Form::Index3,
    ] {
        check(form, Radau5::default());
    }
    check(Form::Index3, GeneralisedAlpha::default());
}

#[test]
fn the_counter_counts() {
    let counted = allocation_counter::measure(|| drop(std::hint::black_box(vec![0_u8; 10])));
    assert!(counted.count_total > 0);
}

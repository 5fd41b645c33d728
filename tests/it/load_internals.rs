//! Loads of one's own with internals: their energy, their events forward, backward and after steps, beside contacts.

use linkdyn_dynamics::{Internals, Load, Loads, Motion, RigidInertia};
use linkdyn_integrators::{Dop853, Integration, Rk4};
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::catalogue::{ClearanceKind, Rsup, rsup};
use linkdyn_mechanisms::{Linkage, Mechanism, Mount, Observation, Simulation, Start, Switching, run};
use nalgebra::{Matrix3, Vector3};
use std::ops::ControlFlow;

/// A spring of one stiffness where its coordinate is positive and another where it is negative. The side is kept in the memory, which
/// counts the passages of zero; a state notes the time, an integral the way.
#[derive(Debug)]
struct TwoSided {
    speed: usize,
    stiffness: [f64; 2],
}

impl TwoSided {
    fn stiffness(&self, motion: &Motion<'_>) -> f64 {
        self.stiffness[usize::from(motion.internal.memory[0] % 2.0 == 1.0)]
    }
}

impl Load for TwoSided {
    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>) {
        loads.add(self.speed, -self.stiffness(motion) * motion.q[self.speed]);
        loads.state_rates[0] = 1.0;
        loads.integral_rates[0] = motion.v[self.speed];
    }

    fn is_conservative(&self) -> bool {
        true
    }

    fn potential_energy(&self, motion: &Motion<'_>) -> f64 {
        0.5 * self.stiffness(motion) * motion.q[self.speed].powi(2)
    }

    fn internals(&self) -> Internals {
        Internals {
            states: 1,
            integrals: 1,
            memory: 1,
            roots: 1,
        }
    }

    fn roots(&self, motion: &Motion<'_>, roots: &mut [f64]) {
        let negative = motion.internal.memory[0] % 2.0 == 1.0;
        let q = motion.q[self.speed];
        roots[0] = if negative { -q } else { q };
    }

    fn at_event(&self, _motion: &Motion<'_>, _fired: &[bool], _states: &mut [f64], memory: &mut [f64]) {
        memory[0] += 1.0;
    }
}

/// A mass on a slide between two springs, let go at 0.1 m.
fn oscillator() -> (Mechanism, Start) {
    let mut linkage = Linkage::new([0.0; 3]);
    let mass = RigidInertia {
        mass: 1.0,
        com: Vector3::zeros(),
        about_com: Matrix3::zeros(),
    };
    let block = linkage.link("block", mass);
    linkage.joint(
        "x",
        Joint::prismatic_z(),
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(block),
    );
    linkage.load(TwoSided {
        speed: 0,
        stiffness: [100.0, 400.0],
    });
    let start = Start {
        positions: vec![("x".into(), 0.1)],
        ..Start::default()
    };
    (linkage.build().expect("it builds"), start)
}

/// Half a period on each side.
const PERIOD: f64 = std::f64::consts::PI * (1.0 / 10.0 + 1.0 / 20.0);

#[test]
fn a_conservative_load_with_internals_does_no_work() {
    let (mechanism, start) = oscillator();
    let (state, _) = mechanism.assemble(&start).expect("no loops");
    let simulation = Simulation::new(&mechanism);
    assert!(simulation.layout().work.is_empty());
    let y = simulation.state_vector(&state);
    let settings = simulation.settings(1e-12, 1e-12);
    let mut integration = Integration::new(simulation, Dop853::default(), 0.0, &y, settings).expect("valid");
    let mut last = Observation::default();
    run(&mut integration, 3.0 * PERIOD, 0.1, |o| {
        assert!((o.energy_balance() - 0.5).abs() < 1e-10, "{}", o.energy_balance());
        assert!((o.states[0] - o.t).abs() < 1e-12 && (o.integrals[0] + 0.1 - o.q[0]).abs() < 1e-10);
        last.clone_from(o);
        ControlFlow::Continue(())
    })
    .expect("runs");
    assert!((last.q[0] - 0.1).abs() < 1e-9 && last.v[0].abs() < 1e-8);
    assert_eq!(last.memory, [6.0]);
    // Of an evaluation too: its power is no work.
    let mut simulation = Simulation::new(&mechanism);
    let y = simulation.restore(&last);
    let mut again = Observation::default();
    simulation.observe(last.t, &y, &mut again).expect("the state exists");
    assert_eq!(again, last);
}

#[test]
fn events_are_met_in_both_directions_of_time() {
    let (mechanism, start) = oscillator();
    let (state, _) = mechanism.assemble(&start).expect("no loops");
    let simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&state);
    let settings = simulation.settings(1e-13, 1e-13);
    let mut integration = Integration::new(simulation, Dop853::default(), 0.0, &y, settings).expect("valid");
    let there = 2.2 * PERIOD;
    for (until, passages) in [(there, 4.0), (0.0, 8.0)] {
        while integration.state().0 != until {
            integration.advance(until).expect("a smooth problem between events");
        }
        assert_eq!(integration.problem().memory(), [passages]);
    }
    let back = integration.state().1;
    assert!((back[0] - 0.1).abs() < 1e-10 && back[1].abs() < 1e-9, "{back:?}");
}

/// A root function that stays negative after its event is no further event.
#[test]
fn events_after_steps_are_met_once() {
    #[derive(Debug)]
    struct Once;
    impl Load for Once {
        fn apply(&self, _motion: &Motion<'_>, _loads: &mut Loads<'_>) {}
        fn internals(&self) -> Internals {
            Internals {
                memory: 1,
                roots: 2,
                ..Internals::default()
            }
        }
        fn roots(&self, motion: &Motion<'_>, roots: &mut [f64]) {
            // The second one is negative from the start and never fires.
            roots.copy_from_slice(&[0.25 - motion.t, -1.0]);
        }
        fn at_event(&self, _motion: &Motion<'_>, fired: &[bool], _states: &mut [f64], memory: &mut [f64]) {
            assert_eq!(fired, [true, false]);
            memory[0] += 1.0;
        }
    }
    for switching in [Switching::Located, Switching::AtSteps] {
        let mut linkage = Linkage::new([0.0; 3]);
        let rod = RigidInertia::solid_cylinder(7850.0, 0.01, 0.3, &Vector3::x());
        let rod = linkage.link("rod", rod);
        linkage.joint(
            "pin",
            Joint::revolute_z(),
            Mount::at_origin(Linkage::GROUND),
            Mount::at_origin(rod),
        );
        linkage.load(Once);
        let mechanism = linkage.build().expect("it builds");
        let (state, _) = mechanism.assemble(&Start::default()).expect("no loops");
        let mut simulation = Simulation::new(&mechanism);
        simulation.set_switching(switching);
        let y = simulation.state_vector(&state);
        let settings = simulation.settings(1e-6, 1e-6);
        let mut integration = Integration::new(simulation, Rk4::new(0.1), 0.0, &y, settings).expect("valid");
        run(&mut integration, 1.0, 0.5, |_| ControlFlow::Continue(())).expect("runs");
        assert_eq!(integration.problem().memory(), [1.0], "{switching:?}");
    }
}

#[test]
fn contacts_are_the_same_beside_a_load_with_internals() {
    let observed = |with: bool| {
        let mut scene = rsup(&Rsup {
            clearance: Some(ClearanceKind::Planar),
            ..Rsup::default()
        })
        .expect("a variant");
        if with {
            scene.linkage.load(TwoSided {
                speed: 0,
                stiffness: [0.0, 0.0],
            });
        }
        let mechanism = scene.linkage.build().expect("it builds");
        let (state, _) = mechanism.assemble(&scene.start).expect("it closes");
        let simulation = Simulation::new(&mechanism);
        let y = simulation.state_vector(&state);
        let settings = simulation.settings(1e-9, 1e-9);
        let mut integration = Integration::new(simulation, Rk4::new(2e-5), 0.0, &y, settings).expect("valid");
        let mut rows = Vec::new();
        run(&mut integration, 0.03, 1e-4, |o| {
            rows.push((o.q.clone(), o.contacts.clone(), o.energy));
            ControlFlow::Continue(())
        })
        .expect("runs");
        rows
    };
    let (without, with) = (observed(false), observed(true));
    assert!(without.iter().any(|(_, contacts, _)| contacts[0].normal > 0.0));
    assert_eq!(without, with);
}

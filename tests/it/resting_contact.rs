//! A journal that falls into its bearing and comes to rest there, or hops so little that its contact is held.

use linkdyn_contact::{ContactLaw, Damping, Fit, ForcePoint, NormalLaw, RestitutionLaw};
use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::BristleStart;
use linkdyn_integrators::{Dop853, Integration, Radau5, Settings};
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::{
    Clearance, ClearanceModel, ContactEvent, Drive, Linkage, Mount, Observation, Seen, Side, Simulation, Tally,
    run_watched,
};
use nalgebra::{Matrix3, Vector3};
use std::ops::ControlFlow;
use std::sync::Arc;

const CLEARANCE: f64 = 1e-3;
const STIFFNESS: f64 = 2e10;
const MASS: f64 = 1.0;

/// A force as a function of time, and the times of its kinks.
type Force = (fn(f64) -> f64, Vec<f64>);

/// A block that slides up and down along z, with a pin across in a hole of the ground.
struct Block {
    damping: Damping,
    gravity: f64,
    /// Force on it along z at a time, with the times of its kinks.
    force: Option<Force>,
    /// Height at the start, against the middle of the hole.
    start: f64,
}

struct Run {
    rows: Vec<Observation>,
    contacts: Vec<(f64, ContactEvent)>,
    tally: Tally,
    steps: u64,
}

impl Run {
    fn held(&self) -> usize {
        self.contacts.iter().filter(|(_, event)| event.held).count()
    }
}

impl Block {
    fn simulation(&self) -> Simulation {
        let mut linkage = Linkage::new([0.0, 0.0, -self.gravity]);
        let block = linkage.link(
            "block",
            RigidInertia {
                mass: MASS,
                com: Vector3::zeros(),
                about_com: Matrix3::from_diagonal_element(1e-3),
            },
        );
        let (here, there) = (Mount::at_origin(Linkage::GROUND), Mount::at_origin(block));
        let slide = linkage.joint("z", Joint::prismatic_z(), here, there);
        if let Some((force, stop_times)) = self.force.clone() {
            let function = Arc::new(move |t: f64, _: f64, _: f64| force(t));
            linkage.drive(slide, Drive::Custom { function, stop_times });
        }
        let axis = Vector3::x_axis();
        let cut = linkage.cut("R", Joint::Revolute { axis }, here, there);
        let law = NormalLaw::new(STIFFNESS, 1.5, self.damping).expect("in range");
        linkage.clearance(
            cut,
            Clearance {
                fit: Fit::new(0.004 + CLEARANCE, 0.004).expect("a pin in a hole"),
                bearing: Side::Predecessor,
                model: ClearanceModel::Planar,
                law: ContactLaw::from(law),
                friction: None,
                bristle_start: BristleStart::default(),
                force_point: ForcePoint::default(),
            },
        );
        Simulation::new(&linkage.build().expect("valid"))
    }

    fn run(&self, until: f64, implicit: bool) -> Run {
        let simulation = self.simulation();
        let mut y = vec![0.0; simulation.layout().len()];
        y[0] = self.start;
        let settings = Settings {
            max_steps: 20_000,
            ..simulation.settings(1e-10, 1e-10)
        };
        let stops = simulation.mechanism().system().stop_times();
        let (mut rows, mut contacts, mut tally) = (Vec::new(), Vec::new(), Tally::default());
        let watch = |mut seen: Seen<'_>| {
            tally.see(&mut seen);
            match seen {
                Seen::Row(o) => rows.push(o.clone()),
                Seen::Contact { t, event } => contacts.push((t, event)),
                Seen::Step { .. } => {}
            }
            ControlFlow::Continue(())
        };
        let every = until / 500.0;
        let steps = if implicit {
            let run = Integration::new(simulation, Radau5::default(), 0.0, &y, settings).expect("valid");
            let mut run = run.with_stops(&stops).expect("finite");
            run_watched(&mut run, until, every, watch).expect("runs to the end");
            run.statistics().accepted
        } else {
            let run = Integration::new(simulation, Dop853::default(), 0.0, &y, settings).expect("valid");
            let mut run = run.with_stops(&stops).expect("finite");
            run_watched(&mut run, until, every, watch).expect("runs to the end");
            run.statistics().accepted
        };
        Run {
            rows,
            contacts,
            tally,
            steps,
        }
    }
}

/// Depth at which the contact carries a force.
fn depth(force: f64) -> f64 {
    (force / STIFFNESS).powf(2.0 / 3.0)
}

#[test]
fn a_heavy_journal_comes_to_rest_in_its_bearing() {
    for (law, restitution) in [(RestitutionLaw::HuntCrossley, 0.1), (RestitutionLaw::Exact, 0.3)] {
        for implicit in [false, true] {
            let block = Block {
                damping: law.with(restitution),
                gravity: 1000.0,
                force: None,
                start: 0.0,
            };
            let run = block.run(0.2, implicit);
            assert!((1..60).contains(&run.contacts.len()), "{}", run.contacts.len());
            assert!(run.contacts.last().expect("some").1.made);
            let last = run.rows.last().expect("rows");
            let point = &last.contacts[0];
            let rest = depth(MASS * block.gravity);
            assert!(
                (point.depth / rest - 1.0).abs() < 1e-3,
                "{law:?} {} {rest}",
                point.depth
            );
            assert!((point.normal - MASS * block.gravity).abs() < 1.0, "{}", point.normal);
            assert!(last.v[0].abs() < 1e-5, "{}", last.v[0]);
            // All that it had is lost, but for what weight stores in the contact.
            let fallen = MASS * block.gravity * (CLEARANCE + point.depth);
            let lost = run.tally.points[0].integrals.damping_loss;
            let stored = last.energy.elastic;
            assert!(
                (lost + stored - fallen).abs() < 1e-5 * fallen,
                "{lost} {stored} {fallen}"
            );
        }
    }
}

/// Hops a tenth of a micrometre high: without damping they never end.
fn hopper(force: Option<Force>) -> Block {
    Block {
        damping: Damping::Hertz,
        gravity: 9.81,
        force,
        start: -CLEARANCE + 1e-7,
    }
}

#[test]
fn a_contact_that_hops_too_often_is_held_and_says_so() {
    for implicit in [false, true] {
        let run = hopper(None).run(0.1, implicit);
        // The 32nd short hop in a row is the last one told of.
        let told: Vec<bool> = run.contacts.iter().map(|(_, event)| event.made).collect();
        assert_eq!(told.iter().filter(|made| **made).count(), 32, "{told:?}");
        assert_eq!((run.held(), run.tally.points[0].held), (1, 1));
        let (since, event) = run.contacts.last().expect("some");
        assert!(event.held && event.made && *since < 0.05);
        // It goes on hopping, and its force never pulls.
        let after = || run.rows.iter().filter(|row| row.t > *since).map(|row| &row.contacts[0]);
        assert!(after().any(|point| point.depth < 0.0 && point.normal == 0.0 && point.impact_speed > 0.0));
        assert!(after().any(|point| point.depth > 0.0 && point.normal > 0.0));
        let start = run.rows[0].energy_balance();
        let deep = STIFFNESS * depth(MASS * 9.81).powf(2.5) + MASS * 9.81 * 1e-7;
        for row in &run.rows {
            assert!(row.contacts[0].normal >= 0.0);
            assert!(
                (row.energy_balance() - start).abs() < 0.05 * deep,
                "{:e}",
                row.energy_balance() - start
            );
        }
        assert!(run.steps < 10_000, "{}", run.steps);
    }
}

#[test]
fn a_held_contact_is_lost_when_a_gap_opens_and_not_before() {
    /// From 0.1 s on it pulls up with twice the weight.
    fn pull(t: f64) -> f64 {
        if t > 0.1 { 2.0 * 9.81 } else { 0.0 }
    }
    let run = hopper(Some((pull, vec![0.1]))).run(0.15, true);
    let held = run
        .contacts
        .iter()
        .position(|(_, event)| event.held)
        .expect("one is held");
    let (lost, event) = run.contacts[held + 1];
    assert!(lost > 0.1 && !event.made && !event.held);
    // Lost at a hundredth of the clearance, up to the bottom of which it rises with 9.81 m/s^2.
    let way = 0.5 * 9.81 * (lost - 0.1).powi(2);
    assert!((way / (1e-2 * CLEARANCE) - 1.0).abs() < 0.3, "{way:e}");
    // The next contact is one like any other, on the other side of the hole.
    let (made, event) = run.contacts[held + 2];
    assert!(event.made && !event.held && event.speed > 0.1);
    let row = run.rows.iter().find(|row| row.t > made).expect("a row after it");
    assert!(row.q[0] > 0.5 * CLEARANCE);
}

#[test]
fn hops_that_matter_are_not_held() {
    let block = Block {
        start: -CLEARANCE + 1e-5,
        ..hopper(None)
    };
    let run = block.run(0.2, true);
    assert!(run.contacts.iter().filter(|(_, event)| event.made).count() > 33);
    assert_eq!((run.held(), run.tally.points[0].held), (0, 0));
}

//! Clearance joints between planar bodies drawn at random: power, momentum, what a row holds, what a run depends on.

use linkdyn_contact::{ContactLaw, Fit, ForcePoint, NormalLaw, RestitutionLaw};
use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::{Bristle, BristleStart, Guard, LuGre};
use linkdyn_integrators::{Dop853, Integration, Ode, Settings};
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::{
    Clearance, ClearanceModel, ContactEvent, LinkHandle, Linkage, Mechanism, Mount, Observation, Seen, Side,
    Simulation, State, run_watched,
};
use linkdyn_tests::strategies::{cases, number};
use nalgebra::{Matrix3, Vector2, Vector3};
use proptest::prelude::*;
use std::f64::consts::PI;
use std::ops::ControlFlow;

/// Radial clearance \[m\].
const CLEARANCE: f64 = 1e-3;
const PIN: f64 = 0.004;

/// A body that moves freely in the x-y plane, with its part of the joint at `arm` along its x axis.
#[derive(Clone, Copy, Debug)]
struct Body {
    mass: f64,
    moment: f64,
    com: [f64; 2],
    arm: f64,
}

impl Body {
    fn add(&self, linkage: &mut Linkage, name: &str) -> LinkHandle {
        let nothing = RigidInertia {
            mass: 0.0,
            com: Vector3::zeros(),
            about_com: Matrix3::zeros(),
        };
        let own = RigidInertia {
            mass: self.mass,
            com: Vector3::new(self.com[0], self.com[1], 0.0),
            about_com: Matrix3::from_diagonal_element(self.moment),
        };
        let (x, y) = (Vector3::x_axis(), Vector3::y_axis());
        let steps = [
            ("x", Joint::Prismatic { axis: x }, nothing),
            ("y", Joint::Prismatic { axis: y }, nothing),
            ("psi", Joint::revolute_z(), own),
        ];
        let mut last = Linkage::GROUND;
        for (step, joint, inertia) in steps {
            let link = linkage.link(&format!("{name}{step}"), inertia);
            linkage.joint(
                &format!("{name}.{step}"),
                joint,
                Mount::at_origin(last),
                Mount::at_origin(link),
            );
            last = link;
        }
        last
    }

    /// Linear momentum and angular momentum about the origin, from coordinates and speeds x, y, psi.
    fn momentum(&self, q: &[f64], v: &[f64]) -> [f64; 3] {
        let turned = turned(q[2], self.com);
        let place = Vector2::new(q[0], q[1]) + turned;
        let speed = Vector2::new(v[0], v[1]) + v[2] * Vector2::new(-turned.y, turned.x);
        let [px, py] = [self.mass * speed.x, self.mass * speed.y];
        [px, py, place.x * py - place.y * px + self.moment * v[2]]
    }
}

fn turned(angle: f64, [x, y]: [f64; 2]) -> Vector2<f64> {
    Vector2::new(x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos())
}

fn body() -> impl Strategy<Value = Body> {
    (0.2..3.0, 0.01..0.1, number(0.2), number(0.2), 0.05..0.4).prop_map(|(mass, moment, x, y, arm)| Body {
        mass,
        moment,
        com: [x, y],
        arm,
    })
}

fn lugre(friction: f64) -> Bristle {
    LuGre {
        static_coefficient: 1.5 * friction,
        kinetic_coefficient: friction,
        stribeck_speed: 0.02,
        bristle_stiffness: 600.0,
        bristle_damping: 10.0,
        viscous_coefficient: 0.01,
        guard: Guard::Cap,
    }
    .into()
}

fn clearance() -> impl Strategy<Value = Clearance> {
    let law = (1e8..1e10, 0.3..0.95).prop_map(|(stiffness, restitution)| {
        let damping = RestitutionLaw::Exact.with(restitution);
        ContactLaw::from(NormalLaw::new(stiffness, 1.5, damping).expect("in range"))
    });
    let friction = prop_oneof![1 => Just(None), 3 => (0.02..0.3).prop_map(|mu| Some(lugre(mu)))];
    let side = prop_oneof![Just(Side::Predecessor), Just(Side::Successor)];
    let point = prop_oneof![Just(ForcePoint::Common), Just(ForcePoint::OwnSurface)];
    (law, friction, side, point).prop_map(|(law, friction, bearing, force_point)| Clearance {
        fit: Fit::new(PIN + CLEARANCE, PIN).expect("a pin in a hole"),
        bearing,
        model: ClearanceModel::Planar,
        law,
        friction,
        bristle_start: BristleStart::default(),
        force_point,
    })
}

/// Two bodies in contact.
#[derive(Clone, Debug)]
struct Pair {
    bodies: [Body; 2],
    clearance: Clearance,
    gravity: f64,
    /// Of the first body; of the second, but for its place.
    q: [f64; 4],
    v: [f64; 6],
    depth: f64,
    /// In which direction the second body's part of the joint lies from that of the first.
    direction: f64,
    impact_speed: f64,
    bristle: f64,
}

fn pair() -> impl Strategy<Value = Pair> {
    let start = (
        prop::array::uniform4(number(1.0)),
        prop::array::uniform6(number(0.5)),
        1e-6..1e-4,
        number(PI),
        0.01..0.5,
        number(1e-4),
    );
    ([body(), body()], clearance(), 0.0..10.0, start).prop_map(|(bodies, clearance, gravity, start)| {
        let (q, v, depth, direction, impact_speed, bristle) = start;
        Pair {
            bodies,
            bristle: if clearance.friction.is_some() { bristle } else { 0.0 },
            clearance,
            gravity,
            q,
            v,
            depth,
            direction,
            impact_speed,
        }
    })
}

impl Pair {
    fn mechanism(&self) -> Mechanism {
        let mut linkage = Linkage::new([0.0, -self.gravity, 0.0]);
        let [one, two] = [(0, "A"), (1, "B")].map(|(k, name)| {
            let link = self.bodies[k].add(&mut linkage, name);
            Mount::at(link, [self.bodies[k].arm, 0.0, 0.0])
        });
        let cut = linkage.cut("R", Joint::revolute_z(), one, two);
        linkage.clearance(cut, self.clearance.clone());
        linkage.build().expect("valid")
    }

    fn coordinates(&self) -> Vec<f64> {
        let [x, y, psi, other] = self.q;
        let [one, two] =
            [(psi, self.bodies[0].arm), (other, self.bodies[1].arm)].map(|(psi, arm)| turned(psi, [arm, 0.0]));
        let apart = turned(self.direction, [CLEARANCE + self.depth, 0.0]);
        let place = Vector2::new(x, y) + one + apart - two;
        vec![x, y, psi, place.x, place.y, other]
    }

    /// A simulation in contact and its state vector.
    fn begin(&self) -> (Simulation, Vec<f64>) {
        let mut simulation = Simulation::new(&self.mechanism());
        let state = State {
            q: self.coordinates(),
            v: self.v.to_vec(),
        };
        let mut y = simulation.state_vector(&state);
        assert!(simulation.begin(0.0, &mut y), "the journal lies in its bearing");
        // As if it had come there faster, and slid since.
        let mut memory = simulation.memory().to_vec();
        memory[0] = self.impact_speed;
        simulation.set_memory(&memory);
        let bristles = simulation.layout().states.clone();
        y[bristles].fill(self.bristle);
        (simulation, y)
    }
}

/// The state a time `h` along its rates.
fn along(y: &[f64], rates: &[f64], h: f64) -> Vec<f64> {
    y.iter().zip(rates).map(|(y, rate)| y + h * rate).collect()
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn what_energy_loses_is_the_work_and_the_work_is_what_the_contact_loses(pair in pair()) {
        let (mut simulation, y) = pair.begin();
        let mut seen = Observation::default();
        simulation.observe(0.0, &y, &mut seen).expect("the state exists");
        let point = seen.contacts[0];
        prop_assert!((point.depth - pair.depth).abs() < 1e-14 && point.normal >= 0.0);
        let mut rates = vec![0.0; y.len()];
        simulation.rhs(0.0, &y, &mut rates).expect("the state exists");
        let layout = simulation.layout().clone();
        let work = rates[layout.work.start];
        let lost = &rates[layout.integrals];
        // A journal torn away faster than its force can follow loses what was stored, without any force.
        let scale = point.normal * (point.rate.abs() + point.slip[0].abs()) + work.abs() + 1.0;
        prop_assert!((work + lost[0] + lost[1]).abs() < 1e-12 * scale, "{work} {lost:?}");

        let h = 1e-3 * point.depth / (point.rate.abs() + 0.01);
        let mut energy = |h: f64| {
            simulation.observe(0.0, &along(&y, &rates, h), &mut seen).expect("the state exists");
            seen.energy.total()
        };
        // The stored energy is no polynomial, and its rounding is that of all energy.
        let power = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
        let rounding = 20.0 * f64::EPSILON * (seen.energy.kinetic + seen.energy.potential.abs() + 1.0) / h;
        prop_assert!((power - work).abs() < 1e-8 * scale + rounding, "{power} {work} of {scale}, {rounding:e}");
    }

    #[test]
    fn contact_keeps_momentum_and_only_separate_points_of_force_make_a_couple(pair in pair()) {
        let pair = Pair { gravity: 0.0, ..pair };
        let (mut simulation, y) = pair.begin();
        let mut seen = Observation::default();
        simulation.observe(0.0, &y, &mut seen).expect("the state exists");
        let point = seen.contacts[0];
        let mut rates = vec![0.0; y.len()];
        simulation.rhs(0.0, &y, &mut rates).expect("the state exists");
        let h = 1e-6;
        let momentum = |h: f64| {
            let y = along(&y, &rates, h);
            let (q, v) = (&y[..6], &y[6..12]);
            let [one, two] = [0, 1].map(|k| pair.bodies[k].momentum(&q[3 * k..3 * k + 3], &v[3 * k..3 * k + 3]));
            [0, 1, 2].map(|k| one[k] + two[k])
        };
        let (after, before) = (momentum(h), momentum(-h));
        let [fx, fy, torque] = [0, 1, 2].map(|k| (after[k] - before[k]) / (2.0 * h));
        let force = point.normal.hypot(point.tangent[0]) + 10.0;
        prop_assert!(fx.abs() < 1e-8 * force && fy.abs() < 1e-8 * force, "{fx} {fy} of {force}");
        let couple = match pair.clearance.force_point {
            ForcePoint::Common => 0.0,
            // The force on the bearing is -f_t t, its point lies by depth n from the journal's.
            ForcePoint::OwnSurface => point.depth * point.tangent[0],
        };
        prop_assert!((torque.abs() - couple.abs()).abs() < 1e-8 * force, "{torque} {couple} of {force}");
        prop_assert!(pair.clearance.friction.is_some() || point.tangent == [0.0; 3]);
    }

    #[test]
    fn a_restored_state_is_the_one_observed(pair in pair()) {
        let (mut simulation, mut y) = pair.begin();
        let layout = simulation.layout().clone();
        y[layout.work.start] = -0.25;
        y[layout.integrals.clone()].copy_from_slice(&[0.1, 0.15, 3.0, 4.0]);
        let mut seen = Observation::default();
        simulation.observe(2.0, &y, &mut seen).expect("the state exists");
        prop_assert_eq!(&seen.q, &pair.coordinates());
        prop_assert_eq!(seen.contacts[0].impact_speed, pair.impact_speed);
        prop_assert_eq!(seen.contacts[0].bristle, [pair.bristle, 0.0, 0.0]);
        let mut fresh = Simulation::new(&pair.mechanism());
        let again = fresh.restore(&seen);
        prop_assert_eq!(&again, &y);
        prop_assert_eq!(fresh.memory(), simulation.memory());
        let mut twice = Observation::default();
        fresh.observe(2.0, &again, &mut twice).expect("the state exists");
        prop_assert_eq!(twice, seen);
    }
}

/// A pendulum that hangs on the ground by a joint with clearance and begins to fall from its middle.
#[derive(Clone, Debug)]
struct Hanging {
    body: Body,
    clearance: Clearance,
    angle: f64,
    speed: f64,
}

fn hanging() -> impl Strategy<Value = Hanging> {
    (body(), clearance(), number(PI), number(3.0)).prop_map(|(body, clearance, angle, speed)| Hanging {
        body,
        clearance,
        angle,
        speed,
    })
}

/// What a run shows.
pub struct Run {
    pub rows: Vec<Observation>,
    pub contacts: Vec<(f64, ContactEvent)>,
    t: f64,
    y: Vec<f64>,
    memory: Vec<f64>,
}

const TOLERANCE: f64 = 1e-10;

fn integration(simulation: Simulation, start: (f64, &[f64])) -> Integration<Simulation, Dop853> {
    integration_to(TOLERANCE, simulation, start)
}

pub fn integration_to(
    tolerance: f64,
    simulation: Simulation,
    (t, y): (f64, &[f64]),
) -> Integration<Simulation, Dop853> {
    let settings = Settings {
        max_steps: 100_000,
        ..simulation.settings(tolerance, tolerance)
    };
    Integration::new(simulation, Dop853::default(), t, y, settings).expect("valid")
}

pub fn go(integration: &mut Integration<Simulation, Dop853>, until: f64, every: f64) -> Run {
    let (mut rows, mut contacts) = (Vec::new(), Vec::new());
    run_watched(integration, until, every, |seen| {
        match seen {
            Seen::Row(o) => rows.push(o.clone()),
            Seen::Contact { t, event } => contacts.push((t, event)),
            Seen::Step { .. } => {}
        }
        ControlFlow::Continue(())
    })
    .expect("runs to the end");
    let (t, y) = integration.state();
    Run {
        rows,
        contacts,
        t,
        y: y.to_vec(),
        memory: integration.problem().memory().to_vec(),
    }
}

impl Hanging {
    fn simulation(&self) -> Simulation {
        let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
        let link = self.body.add(&mut linkage, "B");
        let (here, there) = (
            Mount::at_origin(Linkage::GROUND),
            Mount::at(link, [self.body.arm, 0.0, 0.0]),
        );
        let cut = linkage.cut("R", Joint::revolute_z(), here, there);
        linkage.clearance(cut, self.clearance.clone());
        Simulation::new(&linkage.build().expect("valid"))
    }

    /// It turns about the middle of the joint.
    fn start(&self) -> Vec<f64> {
        let arm = turned(self.angle, [self.body.arm, 0.0]);
        let mut y = vec![0.0; self.simulation().layout().len()];
        y[..3].copy_from_slice(&[-arm.x, -arm.y, self.angle]);
        y[3..6].copy_from_slice(&[self.speed * arm.y, -self.speed * arm.x, self.speed]);
        y
    }

    fn run(&self, until: f64, every: f64) -> Run {
        go(&mut integration(self.simulation(), (0.0, &self.start())), until, every)
    }
}

/// Impact speed that counts at a time, by the contacts told of.
fn expected_impact_speed(contacts: &[(f64, ContactEvent)], t: f64) -> f64 {
    let last = contacts.iter().rev().find(|(at, _)| *at <= t);
    last.map_or(0.0, |(_, event)| if event.made { event.speed } else { 0.0 })
}

proptest! {
    #![proptest_config(cases(12))]

    #[test]
    fn rows_before_an_event_know_nothing_of_it_and_those_after_it_do(hanging in hanging()) {
        let run = hanging.run(0.15, 1e-4);
        prop_assert!(run.contacts.len() > 2, "{}", run.contacts.len());
        // Contacts are made and lost in turn, and each has a speed.
        for (k, (_, event)) in run.contacts.iter().enumerate() {
            prop_assert_eq!(event.made, k % 2 == 0);
            prop_assert!(event.speed > 0.0);
        }
        let mut touching = 0;
        for row in &run.rows {
            let point = &row.contacts[0];
            prop_assert_eq!(point.impact_speed, expected_impact_speed(&run.contacts, row.t), "t = {}", row.t);
            if point.impact_speed > 0.0 {
                touching += 1;
                prop_assert!(point.depth > -1e-9 * CLEARANCE, "{} at {}", point.depth, row.t);
            } else {
                prop_assert!(point.depth < 1e-9 * CLEARANCE, "{} at {}", point.depth, row.t);
                prop_assert!(point.normal == 0.0 && point.tangent == [0.0; 3] && point.bristle == [0.0; 3]);
            }
        }
        prop_assert!(touching > 0);
    }

    #[test]
    fn a_run_with_contacts_does_not_depend_on_where_output_is_wanted(hanging in hanging()) {
        let (coarse, fine) = (hanging.run(0.15, 0.1), hanging.run(0.15, 3e-4));
        prop_assert!(fine.rows.len() > 400 && coarse.rows.len() == 3);
        prop_assert_eq!(&coarse.contacts, &fine.contacts);
        prop_assert_eq!((&coarse.y, &coarse.memory), (&fine.y, &fine.memory));
    }

    #[test]
    fn a_run_taken_up_from_state_and_memory_meets_the_same_contacts(hanging in hanging(), part in 0.2..0.8) {
        let until = 0.15;
        let mut whole = integration(hanging.simulation(), (0.0, &hanging.start()));
        let first = go(&mut whole, part * until, 0.01);
        let rest = go(&mut whole, until, 0.01);
        let mut simulation = hanging.simulation();
        simulation.set_memory(&first.memory);
        let again = go(&mut integration(simulation, (first.t, &first.y)), until, 0.01);
        prop_assert_eq!(rest.contacts.len().min(2), again.contacts.len().min(2));
        // The rows at which it is taken up are the same, forces and losses included.
        let (one, two) = (&rest.rows[0], &again.rows[0]);
        prop_assert_eq!(&one.contacts, &two.contacts);
        prop_assert_eq!((&one.a, one.energy_balance()), (&two.a, two.energy_balance()));
        // Contacts make errors grow; the next two show that nothing has been forgotten.
        for ((t, event), (expected_t, expected)) in again.contacts.iter().zip(&rest.contacts).take(2) {
            prop_assert_eq!((event.point, event.made), (expected.point, expected.made));
            let way = (t - expected_t).abs() * expected.speed;
            prop_assert!(way < 1e-5 * CLEARANCE, "{t} {expected_t}");
            prop_assert!((event.speed - expected.speed).abs() < 1e-5, "{} {}", event.speed, expected.speed);
        }
    }
}

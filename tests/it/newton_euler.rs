//! Newton and Euler for every single link: the reactions found carry exactly what the links need.

use linkdyn_dynamics::{Formulation, Workspace};
use linkdyn_kinematics::assembly::consistent_velocities;
use linkdyn_kinematics::{Closure, Pose, Positions, Row, Twist, Velocities, Wrench};
use linkdyn_tests::numbers::largest;
use linkdyn_tests::{Blueprint, Machine, strategies};
use nalgebra::{Matrix3, Matrix4, Vector3};
use proptest::prelude::*;

/// Reactions on all links at their origins, in global axes.
fn reactions(machine: &Machine, work: &mut Workspace) -> Vec<Wrench> {
    machine.system.reactions(work);
    let global = |&link| {
        let (r, local) = (
            work.positions().pose(link).rotation,
            machine.system.reaction(link, work),
        );
        Wrench {
            torque: r * local.torque,
            force: r * local.force,
        }
    };
    machine.links.iter().map(global).collect()
}

/// What multipliers do to the predecessor, by the words of [`Row`] alone: a force at the successor's point, and a torque.
fn on_predecessor(closure: &Closure, positions: &Positions, mut multipliers: &[f64]) -> (Vector3<f64>, Wrench) {
    let pose = |a: &linkdyn_kinematics::Attachment| positions.pose(a.link) * a.pose;
    let (one, two): (Pose, Pose) = (pose(closure.predecessor()), pose(closure.successor()));
    let mut wrench = Wrench::zero();
    for row in closure.rows() {
        let count = match row {
            Row::Coincident => {
                wrench.force += Vector3::from_column_slice(&multipliers[..3]);
                3
            }
            Row::Along { axis } => {
                wrench.force += one.rotation * axis * multipliers[0];
                1
            }
            Row::Screw { axis, pitch } => {
                let force = one.rotation * axis * multipliers[0];
                wrench.force += force;
                wrench.torque -= force * *pitch;
                1
            }
            Row::Angle {
                on_predecessor,
                on_successor,
                ..
            } => {
                wrench.torque += (one.rotation * on_predecessor).cross(&(two.rotation * on_successor)) * multipliers[0];
                1
            }
        };
        multipliers = &multipliers[count..];
    }
    (two.origin, wrench)
}

/// All outside and reaction loads on each link about its origin, the link's own reaction included; and the largest of them.
fn sums(blueprint: &Blueprint, machine: &Machine, work: &mut Workspace) -> (Vec<Wrench>, f64) {
    let reactions = reactions(machine, work);
    let origin = |k: usize| work.positions().pose(machine.links[k]).origin;
    let mut sums = reactions.clone();
    let mut scale: f64 = 1.0;
    let mut add = |k: usize, at: Vector3<f64>, wrench: Wrench| {
        let shifted = wrench.shifted(&(at - origin(k)));
        scale = scale.max(shifted.force.amax()).max(shifted.torque.amax());
        sums[k] += shifted;
    };
    for (k, part) in blueprint.parts.iter().enumerate() {
        if let Some(parent) = part.parent {
            let Wrench { torque, force } = reactions[k];
            add(
                parent,
                origin(k),
                Wrench {
                    torque: -torque,
                    force: -force,
                },
            );
        }
        add(k, origin(k), part.wrench);
        let weight = Wrench {
            torque: Vector3::zeros(),
            force: blueprint.gravity * part.inertia.mass,
        };
        add(
            k,
            work.positions().pose(machine.links[k]).point(&part.inertia.com),
            weight,
        );
    }
    let mut multipliers = work.multipliers();
    for (cut, closure) in blueprint.cuts.iter().zip(machine.system.closures()) {
        let (point, wrench) = on_predecessor(closure, work.positions(), &multipliers[..closure.equations()]);
        multipliers = &multipliers[closure.equations()..];
        if let Some(k) = cut.predecessor.0 {
            add(k, point, wrench);
        }
        if let Some(k) = cut.successor.0 {
            add(
                k,
                point,
                Wrench {
                    torque: -wrench.torque,
                    force: -wrench.force,
                },
            );
        }
    }
    (sums, scale)
}

/// Vector of a skew matrix.
fn vee(m: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12) * 0.5
}

/// Rate of momentum and of moment of momentum about the link's origin, from 4 x 4 transforms and their derivatives.
fn momentum_rates(blueprint: &Blueprint, machine: &Machine, rates: &[f64]) -> Vec<Wrench> {
    let transforms = machine.tree().transforms(&machine.q);
    let n = machine.tree().speeds();
    let of = |(part, &link): (&linkdyn_tests::Part, &linkdyn_kinematics::LinkId)| {
        let (mut first, mut second) = (Matrix4::zeros(), Matrix4::zeros());
        for i in 0..n {
            let t_i = transforms.first(link, i);
            first += t_i * machine.v[i];
            second += t_i * rates[i];
            for j in 0..n {
                second += transforms.second(link, i, j) * (machine.v[i] * machine.v[j]);
            }
        }
        let r = transforms.transform(link).fixed_view::<3, 3>(0, 0).into_owned();
        let omega = vee(&(first.fixed_view::<3, 3>(0, 0) * r.transpose()));
        let alpha = vee(&(second.fixed_view::<3, 3>(0, 0) * r.transpose()));
        let inertia = r * part.inertia.about_com * r.transpose();
        let com_acceleration = (second * part.inertia.com.push(1.0)).xyz();
        let force = com_acceleration * part.inertia.mass;
        Wrench {
            torque: inertia * alpha + omega.cross(&(inertia * omega)) + (r * part.inertia.com).cross(&force),
            force,
        }
    };
    blueprint.parts.iter().zip(&machine.links).map(of).collect()
}

fn machines() -> impl Strategy<Value = Blueprint> {
    strategies::closed(1..=10, 0..=2)
}

proptest! {
    #![proptest_config(strategies::cases(1000))]

    #[test]
    fn on_every_link_reactions_and_loads_make_the_rate_of_momentum(blueprint in machines()) {
        let machine = blueprint.machine(Formulation::Recursive);
        let mut work = machine.evaluate();
        let (sums, scale) = sums(&blueprint, &machine, &mut work);
        let needed = momentum_rates(&blueprint, &machine, work.rates());
        for (k, (sum, needed)) in sums.iter().zip(&needed).enumerate() {
            // Loads of a whole branch pass through a joint: rounding of the largest of them, and of accelerations up to
            // some hundred times those loads over the smallest mass.
            let allowed = 1e-12 * (scale + needed.force.amax() + needed.torque.amax());
            prop_assert!((sum.force - needed.force).amax() < allowed, "link {k}: force");
            prop_assert!((sum.torque - needed.torque).amax() < allowed, "link {k}: torque");
        }
    }

    #[test]
    fn inverse_after_forward_dynamics_is_the_identity(blueprint in machines()) {
        // Components of the reactions along the freedoms are the torques and forces that were applied there.
        let machine = blueprint.machine(Formulation::Recursive);
        let mut work = machine.evaluate();
        let reactions = reactions(&machine, &mut work);
        let scale = reactions.iter().fold(1.0, |s: f64, r| s.max(r.force.amax()).max(r.torque.amax()));
        for ((part, reaction), &link) in blueprint.parts.iter().zip(&reactions).zip(&machine.links) {
            let end = work.positions().pose(link).origin;
            // The steps of a joint have no mass: each passes on the same load.
            let steps = link.node() + 1 - part.joint.speeds()..=link.node();
            for (node, drive) in steps.zip(&part.drive) {
                let here = work.positions().nodes()[node];
                let load = reaction.shifted(&(end - here.origin));
                let torque = here.axis.dot(&load.torque);
                let force = here.axis.dot(&load.force);
                let along = match machine.tree().nodes()[node].freedom {
                    linkdyn_kinematics::Freedom::Linear => force,
                    linkdyn_kinematics::Freedom::Screw { pitch } => torque + pitch * force,
                    _ => torque,
                };
                prop_assert!((along - drive).abs() < 1e-11 * scale, "{along} for {drive}, scale {scale:e}");
            }
        }
    }

    #[test]
    fn closures_do_no_work_on_allowed_motions(
        blueprint in strategies::closed(2..=10, 1..=3),
        guess in prop::collection::vec(strategies::number(1.0), 60),
    ) {
        let machine = blueprint.machine(Formulation::Recursive);
        let work = machine.evaluate();
        let (tree, closures) = (machine.tree(), machine.system.closures());
        let held = vec![false; tree.speeds()];
        let allowed = consistent_velocities(tree, closures, &machine.q, &guess[..tree.speeds()], &held)
            .expect("nothing is held");
        let mut velocities = Velocities::new(tree);
        tree.velocities(work.positions(), &allowed, &mut velocities);
        let mut multipliers = work.multipliers();
        for closure in closures {
            let (own, rest) = multipliers.split_at(closure.equations());
            let (on_one, on_two) = closure.wrenches(work.positions(), own);
            let twist = |a: &linkdyn_kinematics::Attachment| velocities.nodes()[a.link.node()];
            let sides: [(Wrench, Twist); 2] = [(on_one, twist(closure.predecessor())), (on_two, twist(closure.successor()))];
            let power: f64 = sides.iter().map(|(wrench, twist)| wrench.power(twist)).sum();
            // Speeds are consistent to 1e-12 times the multipliers; powers of both sides are of the size of multipliers.
            prop_assert!(power.abs() < 1e-11 * largest(own).max(1.0), "{power:e}");
            multipliers = rest;
        }
    }
}

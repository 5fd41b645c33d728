//! A four-bar driven by a constant torque against a resistance: coupler curve, speeds and joint forces.

use linkdyn_mechanisms::dynamics::RigidInertia;
use linkdyn_mechanisms::integrators::{Dop853, Integration, Settings};
use linkdyn_mechanisms::kinematics::Joint;
use linkdyn_mechanisms::{Drive, Linkage, Mount, Simulation, Start, run};
use nalgebra::Vector3;
use std::ops::ControlFlow;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let steel_rod = |length: f64| RigidInertia::solid_cylinder(7850.0, 0.02, length, &Vector3::x());
    let crank = linkage.link("crank", steel_rod(0.1));
    let coupler = linkage.link("coupler", steel_rod(0.3));
    let rocker = linkage.link("rocker", steel_rod(0.25));

    let hinge = Joint::revolute_z();
    let ground = Linkage::GROUND;
    let a = linkage.joint("A", hinge, Mount::at_origin(ground), Mount::at_origin(crank));
    linkage.joint("B", hinge, Mount::at(crank, [0.1, 0.0, 0.0]), Mount::at_origin(coupler));
    linkage.joint("D", hinge, Mount::at(ground, [0.3, 0.0, 0.0]), Mount::at_origin(rocker));
    // The loop is closed at C. A ball there leaves one redundant equation, out of the plane; a hinge would leave three.
    let end_of_coupler = Mount::at(coupler, [0.3, 0.0, 0.0]);
    let end_of_rocker = Mount::at(rocker, [0.25, 0.0, 0.0]);
    linkage.cut("C", Joint::Spherical, end_of_coupler, end_of_rocker);
    linkage.drive(a, Drive::Constant { torque: 5.0 }).drive(
        a,
        Drive::Resistance {
            torque: 5.0,
            reference_speed: 10.0,
        },
    );
    let mechanism = linkage.build()?;

    // Joint angles count from the link before: the crank is held at 1 rad, the others are guessed and then closed.
    let guess = [("A", 1.0), ("B", 0.0), ("D", 1.5)];
    let start = Start {
        positions: guess.map(|(name, angle)| (name.to_owned(), angle)).into(),
        held: vec!["A".into()],
        speeds: Vec::new(),
    };
    let (state, closed) = mechanism.assemble(&start)?;
    println!(
        "closed to {:.1e} m in {} steps, rank {} of {} equations",
        closed.residual, closed.iterations, closed.rank, closed.equations
    );

    let simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&state);
    let settings = Settings::tolerances(1e-10, 1e-12);
    let mut integration = Integration::new(simulation, Dop853::default(), 0.0, &y, settings)?;
    println!("   t [s]  crank [rad/s]  coupler point [m]    |force in B| [N]");
    let (mut first, mut worst, mut row) = (None, 0.0_f64, 0);
    run(&mut integration, 2.0, 0.05, |now| {
        if row % 4 == 0 {
            let (alpha, beta) = (now.q[0], now.q[0] + now.q[1]);
            let point = [
                0.1 * alpha.cos() + 0.15 * beta.cos() - 0.1 * beta.sin(),
                0.1 * alpha.sin() + 0.15 * beta.sin() + 0.1 * beta.cos(),
            ];
            let force = now.reactions[1].force.norm();
            println!(
                "{:8.2}  {:13.6}  ({:+.4}, {:+.4})  {force:16.4}",
                now.t, now.v[0], point[0], point[1]
            );
        }
        row += 1;
        let balance = now.energy_balance();
        worst = worst.max((balance - *first.get_or_insert(balance)).abs());
        ControlFlow::Continue(())
    })?;
    println!(
        "energy less work constant to {worst:.1e} J; {:?}",
        integration.statistics()
    );
    assert!(worst < 1e-8);
    Ok(())
}

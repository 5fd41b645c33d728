//! The RSRRR mechanism of the catalogue with ideal joints and with friction in its revolute joints.

use linkdyn_mechanisms::catalogue::{Rsrrr, rsrrr};
use linkdyn_mechanisms::integrators::{Dop853, Integration, Settings};
use linkdyn_mechanisms::{Simulation, run};
use std::ops::ControlFlow;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for friction in [false, true] {
        let scene = rsrrr(&Rsrrr {
            friction,
            ..Rsrrr::default()
        });
        let mechanism = scene.linkage.build()?;
        let (state, _) = mechanism.assemble(&scene.start)?;
        let simulation = Simulation::new(&mechanism);
        let y = simulation.state_vector(&state);
        // The drive has a kink; a step must end on it.
        let stops = mechanism.system().stop_times();
        let settings = Settings::tolerances(1e-9, 1e-9);
        let mut integration = Integration::new(simulation, Dop853::default(), 0.0, &y, settings)?.with_stops(&stops)?;

        let (mut angle, mut late, mut hardest, mut strongest) = (0.0, f64::NAN, 0.0_f64, 0.0_f64);
        run(&mut integration, scene.until, 0.01, |now| {
            angle = now.q[0];
            if late.is_nan() && now.t >= 4.0 {
                late = angle;
            }
            let forces = now.reactions.iter().map(|reaction| reaction.force.norm());
            hardest = forces.fold(hardest, f64::max);
            strongest = now
                .friction
                .iter()
                .fold(strongest, |most, torque| most.max(torque.abs()));
            ControlFlow::Continue(())
        })?;

        println!("friction: {friction}");
        println!("  mean crank speed from 4 s to 5 s      {:.4} rad/s", angle - late);
        println!("  largest joint force                  {hardest:.3} N");
        println!("  largest friction torque              {strongest:.5} N m");
        let (simulation, statistics) = (integration.problem(), integration.statistics());
        println!(
            "  largest drift off the loop           {:.1e} m",
            simulation.worst().position_drift
        );
        println!(
            "  friction loop solved to              {:.1e}",
            simulation.worst().friction_residual
        );
        println!("  {statistics:?}");
        assert!(simulation.worst().friction_residual < 1e-9);
    }
    Ok(())
}

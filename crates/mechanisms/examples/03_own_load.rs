//! A load of one's own: a spring between a point of the ground and a point of a double pendulum.

use linkdyn_mechanisms::dynamics::{Load, Loads, Motion, RigidInertia};
use linkdyn_mechanisms::integrators::{Dop853, Integration, Settings};
use linkdyn_mechanisms::kinematics::{Joint, LinkId, Wrench};
use linkdyn_mechanisms::{Linkage, Mount, Simulation, Start, run};
use nalgebra::Vector3;
use std::ops::ControlFlow;

/// Pulls `point` of a link towards `anchor` of the ground. It holds parameters only: what it may look at is the motion.
#[derive(Debug)]
struct Spring {
    link: LinkId,
    /// In the link's frame [m].
    point: Vector3<f64>,
    /// In the global frame [m].
    anchor: Vector3<f64>,
    /// [N/m].
    stiffness: f64,
}

impl Spring {
    /// Arm of the point, and the way from it to the anchor, global axes [m].
    fn stretch(&self, motion: &Motion<'_>) -> (Vector3<f64>, Vector3<f64>) {
        let pose = motion.positions.pose(self.link);
        let arm = pose.rotation * self.point;
        (arm, self.anchor - (pose.origin + arm))
    }
}

impl Load for Spring {
    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>) {
        let (arm, stretch) = self.stretch(motion);
        let force = stretch * self.stiffness;
        // Wrenches are given at the link's origin, in global axes.
        let torque = arm.cross(&force);
        loads.add_wrench(self.link, Wrench { torque, force });
    }

    fn is_conservative(&self) -> bool {
        true
    }

    fn potential_energy(&self, motion: &Motion<'_>) -> f64 {
        self.stiffness * self.stretch(motion).1.norm_squared() / 2.0
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let rod = RigidInertia::solid_cylinder(7850.0, 0.02, 0.3, &Vector3::x());
    let (upper, lower) = (linkage.link("upper", rod), linkage.link("lower", rod));
    let ground = Linkage::GROUND;
    linkage.joint(
        "hip",
        Joint::Spherical,
        Mount::at_origin(ground),
        Mount::at_origin(upper),
    );
    let knee = Mount::at(upper, [0.3, 0.0, 0.0]);
    linkage.joint("knee", Joint::revolute_z(), knee, Mount::at_origin(lower));

    // Where a link sits on the tree is known after building: build once, ask, add the load, build again.
    let on_tree = linkage.build()?.attachment("lower").expect("the link was added above");
    linkage.load(Spring {
        link: on_tree.link,
        point: on_tree.pose.point(&Vector3::new(0.3, 0.0, 0.0)),
        anchor: Vector3::new(0.5, 0.2, 0.3),
        stiffness: 40.0,
    });
    let mechanism = linkage.build()?;

    let (state, _) = mechanism.assemble(&Start::default())?;
    let simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&state);
    let settings = Settings::tolerances(1e-11, 1e-12);
    let mut integration = Integration::new(simulation, Dop853::default(), 0.0, &y, settings)?;
    println!("   t [s]  kinetic [J]  potential [J]  elastic [J]  total [J]");
    let (mut start, mut worst) = (f64::NAN, 0.0_f64);
    run(&mut integration, 3.0, 0.25, |now| {
        let energy = &now.energy;
        if now.t == 0.0 {
            start = energy.total();
        }
        worst = worst.max((energy.total() - start).abs());
        println!(
            "{:8.2}  {:11.6}  {:13.6}  {:11.6}  {:9.6}",
            now.t,
            energy.kinetic,
            energy.potential,
            energy.elastic,
            energy.total()
        );
        ControlFlow::Continue(())
    })?;
    println!("total energy constant to {worst:.1e} J");
    assert!(worst < 1e-8);
    Ok(())
}

//! One evaluation and one accepted step allocate nothing after the first. (A target of its own: it replaces the global
//! allocator.)

use linkdyn_integrators::{Adams, Dop853, Integration, Method, Settings};
use linkdyn_mechanisms::Simulation;
use linkdyn_tests::scenes::ready_rsrrr;

fn allocations_of_steps<M: Method<Simulation>>(friction: bool, method: M) -> u64 {
    let scene = ready_rsrrr(friction, 1.0);
    let simulation = Simulation::new(&scene.mechanism);
    let y = simulation.state_vector(&scene.start);
    let settings = Settings::tolerances(1e-8, 1e-8);
    let mut run = Integration::new(simulation, method, 0.0, &y, settings).expect("valid");
    for _ in 0..20 {
        run.advance(5.0).expect("regular");
    }
    let counted = allocation_counter::measure(|| {
        for _ in 0..100 {
            run.advance(5.0).expect("regular");
        }
    });
    counted.count_total
}

#[test]
fn steps_of_rsrrr_allocate_nothing() {
    for friction in [false, true] {
        assert_eq!(allocations_of_steps(friction, Dop853::default()), 0);
        assert_eq!(allocations_of_steps(friction, Adams::default()), 0);
    }
}

//! What the way of the RSRRR paper costs in accuracy: Newmark's method with fixed step, friction from k sweeps
//! reactions - friction - accelerations at each evaluation. Error of the crank angle after 5 s \[rad\].
//!
//! The first argument may give the smallest step \[s\]; 1e-4 takes a minute, the default 1e-3 a few seconds.

use linkdyn_mechanisms::catalogue::{Rsrrr, rsrrr};
use linkdyn_mechanisms::dynamics::ReactionSolver;
use linkdyn_mechanisms::integrators::{Adams, Corrector, Integration, Method, Newmark, Settings};
use linkdyn_mechanisms::{Simulation, run};
use std::error::Error;
use std::ops::ControlFlow;

const END: f64 = 5.0;

/// Crank angle at the end, and evaluations.
fn crank_angle(solver: ReactionSolver, method: impl Method<Simulation>) -> Result<(f64, u64), Box<dyn Error>> {
    let mut scene = rsrrr(&Rsrrr {
        friction: true,
        ..Rsrrr::default()
    });
    scene.linkage.reaction_solver = solver;
    let mechanism = scene.linkage.build()?;
    let (start, _) = mechanism.assemble(&scene.start)?;
    let simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&start);
    let settings = Settings::tolerances(1e-12, 1e-12);
    let integration = Integration::new(simulation, method, 0.0, &y, settings)?;
    let mut integration = integration.with_stops(&mechanism.system().stop_times())?;
    run(&mut integration, END, END, |_| ControlFlow::Continue(()))?;
    Ok((integration.state().1[0], integration.statistics().evaluations))
}

fn main() -> Result<(), Box<dyn Error>> {
    let smallest: f64 = match std::env::args().nth(1) {
        Some(text) => text.parse()?,
        None => 1e-3,
    };
    let (reference, evaluations) = crank_angle(ReactionSolver::default(), Adams::default())?;
    println!("reference: {reference:.12} rad (Adams, 1e-12, {evaluations} evaluations)");
    println!(
        "{:>9} {:>8} {:>12} {:>12}",
        "step (s)", "k", "error (rad)", "evaluations"
    );
    let corrector = Corrector::Until {
        change: 1e-12,
        at_most: 200,
    };
    let solvers = [1, 2, 3, 4, 6, 10, 20].map(|sweeps| (sweeps.to_string(), ReactionSolver::Sweeps { sweeps }));
    let solved = ("solved".to_owned(), ReactionSolver::default());
    for step in [1e-2, 1e-3, 1e-4].into_iter().filter(|&step| step >= 0.999 * smallest) {
        for (name, solver) in solvers.iter().chain([&solved]) {
            let row = crank_angle(*solver, Newmark::new(step, corrector));
            match row {
                Ok((angle, evaluations)) => {
                    println!("{step:>9} {name:>8} {:>12.3e} {evaluations:>12}", angle - reference);
                }
                Err(error) => println!("{step:>9} {name:>8} {error}"),
            }
        }
    }
    Ok(())
}

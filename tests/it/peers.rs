//! Our integrators and those of another library find the same states.

use linkdyn_tests::standard_odes::{HIRES, PLEIADES, Standard};

#[path = "../examples/peer_side_by_side/solvers.rs"]
mod solvers;

use solvers::{EXPLICIT, STIFF, Solver, Work};

fn find<'a>(solvers: &'a [Solver], ours: bool, name: &str) -> &'a Solver {
    let found = solvers.iter().find(|solver| solver.ours == ours && solver.name == name);
    found.expect("a solver of that name")
}

/// Both runs at a relative tolerance, after a check that they agree to so many digits with each other and with the test set.
fn agree(problem: &Standard, ours: &Solver, peer: &Solver, tolerance: f64, digits: f64) -> (Work, Work) {
    let run = |solver: &Solver| (solver.solve)(problem, tolerance).expect("the run succeeds");
    let (a, b) = (run(ours), run(peer));
    for work in [&a, &b] {
        let found = problem.digits(&work.y);
        assert!(found >= digits, "{}: {found} digits by {work:?}", problem.name);
    }
    for (a, b) in a.y.iter().zip(&b.y) {
        let apart = ((a - b) / b).abs();
        assert!(apart <= 10.0_f64.powf(-digits), "{}: {a} and {b}", problem.name);
    }
    (a, b)
}

#[test]
fn hires_by_radau5() {
    let (ours, peer) = (find(&STIFF, true, "Radau5"), find(&STIFF, false, "radau5"));
    let (ours, peer) = agree(&HIRES, ours, peer, 1e-8, 6.5);
    // The counters beside each other mean the same things.
    for work in [ours, peer] {
        let factorisations = work.factorisations.expect("both tell them");
        assert!(work.jacobians <= factorisations && factorisations <= work.evaluations);
        assert!(work.steps > 100 && work.evaluations > 9 * work.jacobians + 3 * work.steps);
    }
}

#[test]
fn hires_by_bdf() {
    let (ours, peer) = (find(&STIFF, true, "Bdf"), find(&STIFF, false, "bdf"));
    agree(&HIRES, ours, peer, 1e-9, 6.0);
}

#[test]
fn pleiades_by_dop853() {
    let (ours, peer) = (find(&EXPLICIT, true, "Dop853"), find(&EXPLICIT, false, "dop853"));
    agree(&PLEIADES, ours, peer, 1e-10, 6.9);
}

//! Mechanisms by the implicit method: it takes what they tell of their structure, and comes to the same motion.

use linkdyn_integrators::{Dop853, EvalError, Integration, Ode, Progress, Radau5, Settings, Statistics};
use linkdyn_mechanisms::Simulation;
use linkdyn_tests::scenes::{Ready, distance, ready_rsrrr, simulate};

#[test]
fn implicit_and_explicit_agree() {
    let rsrrr = ready_rsrrr(true, 1.0);
    let explicit = simulate(&rsrrr, Dop853::default(), 1e-10, 1.0, 0.05);
    let implicit = simulate(&rsrrr, Radau5::default(), 1e-9, 1.0, 1.0);
    explicit.end.expect("the run ends");
    implicit.end.expect("the run ends");
    let last = |rows: &[linkdyn_mechanisms::Observation]| rows.last().expect("rows").clone();
    let (a, b) = (last(&explicit.rows), last(&implicit.rows));
    assert!(distance(&a.q, &b.q) < 1e-7, "{:e}", distance(&a.q, &b.q));
    assert!(distance(&a.v, &b.v) < 1e-6, "{:e}", distance(&a.v, &b.v));
    assert!((a.work - b.work).abs() < 1e-7, "{} {}", a.work, b.work);
}

/// A simulation that keeps its structure to itself.
struct Silent(Simulation);

impl Ode for Silent {
    fn dim(&self) -> usize {
        self.0.dim()
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        self.0.rhs(t, y, dy)
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
        self.0.project(t, y)
    }
}

fn end<P: Ode>(problem: P, y: &[f64], settings: Settings) -> (Vec<f64>, Statistics) {
    let mut run = Integration::new(problem, Radau5::default(), 0.0, y, settings).expect("good settings");
    while !matches!(run.advance(0.2).expect("the run ends"), Progress::Done { .. }) {}
    (run.state().1.to_vec(), run.statistics())
}

#[test]
fn structure_saves_work_and_changes_no_digit_that_counts() {
    let Ready { mechanism, start, .. } = ready_rsrrr(true, 1.0);
    let simulation = Simulation::new(&mechanism);
    let (y, settings) = (simulation.state_vector(&start), simulation.settings(1e-8, 1e-8));
    let (told, work) = end(simulation.clone(), &y, settings.clone());
    let (silent, more_work) = end(Silent(simulation), &y, settings);
    assert!(distance(&told, &silent) < 1e-8, "{:e}", distance(&told, &silent));
    assert!(work.jacobian_evaluations < more_work.jacobian_evaluations);
}

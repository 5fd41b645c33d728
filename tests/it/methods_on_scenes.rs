//! Every method with error control on every built-in scene: what a tolerance buys, that output changes nothing, that counters are
//! true, and what the work consists of.

use linkdyn_integrators::{EvalError, Integration, Method, Ode, Progress, Statistics};
use linkdyn_mechanisms::{Observation, Simulation};
use linkdyn_tests::methods::{adaptive, nth};
use linkdyn_tests::scenes::{Ready, builtin, distance, simulate};

/// For each scene how far to run and the loosest of three tolerances. The runs with clearance make and lose contacts; their
/// tolerances are lengths. Where links are elastic, runs are short: explicit methods make steps of 2e-5 s.
fn plan(scene: &str) -> (f64, f64) {
    match (scene.contains("clearance"), scene.contains("flexible")) {
        (false, false) => (1.0, 1e-5),
        (true, false) => (0.03, 1e-8),
        (false, true) => (0.01, 1e-6),
        (true, true) => (0.0145, 1e-8),
    }
}

fn rows(ready: &Ready, method: impl Method<Simulation>, tolerance: f64, until: f64, every: f64) -> Vec<Observation> {
    let finished = simulate(ready, method, tolerance, until, every);
    finished.end.expect("the run reaches its end");
    finished.rows
}

/// Coordinates and speeds at the end.
fn end(ready: &Ready, method: impl Method<Simulation>, tolerance: f64, until: f64) -> Vec<f64> {
    let last = rows(ready, method, tolerance, until, until).pop().expect("rows");
    [last.q, last.v].concat()
}

/// NaN if one of them is.
fn larger(a: f64, b: f64) -> f64 {
    if a <= b || b.is_nan() { b } else { a }
}

/// Four digits of tolerance buy at least two of accuracy, and each two at least one, down to what two references differ by.
///
/// One rule for all, which allows for three things. Kinks of friction and contacts, here or there in a step, scatter errors: where four digits buy
/// three, the error between may be what it likes. Elastic links make explicit methods take steps so short that errors are far below the tolerance:
/// two digits need not buy one within ten tolerances, nor four two below a hundredth of one.
#[test]
fn errors_follow_tolerances() {
    for (scene, ready) in builtin() {
        let (until, loosest) = plan(scene);
        let [explicit, implicit] = [("dop853", 1e-7), ("radau5", 1e-6)].map(|(name, part)| {
            let (_, method) = adaptive()
                .into_iter()
                .find(|(method, _)| *method == name)
                .expect("a method");
            end(&ready, method, part * loosest, until)
        });
        let known = 3.0 * distance(&explicit, &implicit);
        for k in 0..adaptive::<Simulation>().len() {
            let (name, _) = adaptive::<Simulation>().swap_remove(k);
            let tolerances = [1.0, 1e-2, 1e-4].map(|part| part * loosest);
            let error = |tolerance| {
                let found = end(&ready, nth(k), tolerance, until);
                let [one, two] = [&explicit, &implicit].map(|exact| distance(&found, exact));
                larger(one, two)
            };
            // The larger one of two, since a single error may be small by luck.
            let errors = tolerances.map(|tolerance| larger(error(tolerance), error(0.6 * tolerance)));
            let [rough, middle, fine] = errors;
            assert!(
                fine <= (0.01 * rough).max(0.01 * tolerances[2]).max(known),
                "{scene}, {name}: {errors:?}, {known:e}"
            );
            let steady = middle <= (0.1 * rough).max(10.0 * tolerances[1]).max(known)
                && fine <= (0.1 * middle).max(10.0 * tolerances[2]).max(known);
            assert!(steady || fine <= 1e-3 * rough, "{scene}, {name}: {errors:?}, {known:e}");
        }
    }
}

/// The state at the end is the same to the last bit, whatever has been written on the way.
#[test]
fn output_changes_nothing() {
    for (scene, ready) in builtin() {
        let (until, tolerance) = plan(scene);
        for k in 0..adaptive::<Simulation>().len() {
            let (name, _) = adaptive::<Simulation>().swap_remove(k);
            let ends = [1.0, 7.0, 500.0, 3.7].map(|parts| {
                let last = rows(&ready, nth(k), tolerance, until, until / parts)
                    .pop()
                    .expect("rows");
                assert_eq!(last.t, until);
                [last.q, last.v]
                    .concat()
                    .into_iter()
                    .map(f64::to_bits)
                    .collect::<Vec<_>>()
            });
            assert!(ends.iter().all(|end| *end == ends[0]), "{scene}, {name}: {ends:?}");
        }
    }
}

/// A simulation that counts what it is asked.
struct Counting {
    simulation: Simulation,
    evaluations: u64,
    projections: u64,
    roots: u64,
    jacobians: u64,
    events: u64,
}

impl Ode for Counting {
    fn dim(&self) -> usize {
        self.simulation.dim()
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        self.evaluations += 1;
        self.simulation.rhs(t, y, dy)
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
        self.projections += 1;
        self.simulation.project(t, y)
    }
    fn jacobian(&mut self, t: f64, y: &[f64], matrix: &mut [f64]) -> Result<bool, EvalError> {
        self.jacobians += 1;
        self.simulation.jacobian(t, y, matrix)
    }
    fn quadratures(&self) -> usize {
        self.simulation.quadratures()
    }
    fn second_order_pairs(&self) -> usize {
        self.simulation.second_order_pairs()
    }
    fn roots(&self) -> usize {
        self.simulation.roots()
    }
    fn root(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        self.roots += 1;
        self.simulation.root(t, y, g)
    }
    fn at_event(&mut self, t: f64, y: &mut [f64], fired: &[bool]) -> Result<(), EvalError> {
        self.events += 1;
        self.simulation.at_event(t, y, fired)
    }
}

/// Runs without output; the counters, which are those of the problem.
fn work(ready: &Ready, method: Box<dyn Method<Counting>>, tolerance: f64, until: f64) -> Statistics {
    let simulation = Simulation::new(&ready.mechanism);
    let y = simulation.state_vector(&ready.start);
    let settings = simulation.settings(tolerance, tolerance);
    let problem = Counting {
        simulation,
        evaluations: 0,
        projections: 0,
        roots: 0,
        jacobians: 0,
        events: 0,
    };
    let run = Integration::new(problem, method, 0.0, &y, settings).expect("valid settings");
    let mut run = run.with_stops(&ready.mechanism.system().stop_times()).expect("finite");
    while !matches!(run.advance(until).expect("regular"), Progress::Done { .. }) {}
    let (claimed, counted) = (run.statistics(), run.problem());
    assert_eq!(
        [
            claimed.evaluations,
            claimed.projections,
            claimed.root_evaluations,
            claimed.jacobians,
            claimed.events
        ],
        [
            counted.evaluations,
            counted.projections,
            counted.roots,
            counted.jacobians,
            counted.events
        ]
    );
    claimed
}

/// Counters tell the truth, and are these to the last one: a change that costs or saves work, or makes other steps, shows.
#[test]
fn work_is_counted_and_known() {
    let mut found = String::new();
    for (scene, ready) in builtin() {
        let (until, tolerance) = plan(scene);
        for (name, method) in adaptive() {
            let s = work(&ready, method, tolerance, until);
            let columns = [
                s.evaluations,
                s.accepted,
                s.rejected,
                s.jacobians,
                s.factorisations,
                s.events,
            ];
            let columns = columns.map(|count| format!("{count:7}")).concat();
            found += &format!("{scene:37}{name:7}{columns}\n");
        }
    }
    let known = include_str!("methods_on_scenes.txt");
    let table: String = known.lines().skip(1).map(|line| format!("{line}\n")).collect();
    assert_eq!(found, table, "\n{found}");
}

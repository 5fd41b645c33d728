//! The counters tell the truth.

use linkdyn_integrators::{
    Adams, Corrector, Dop853, DormandPrince5, Integration, Method, Newmark, Progress, Rk4, Settings,
};

use crate::problems::{Counting, Kink, Pleiades, finish};

fn check<M: for<'a> Method<&'a mut Counting<Kink>>>(method: M, claim: bool, dense_per_step: u64) {
    let mut problem = Counting::new(Kink);
    problem.claim = claim;
    let mut run = Integration::new(&mut problem, method, 0.0, &Kink::START, Settings::default()).expect("good");
    let (mut y, mut steps) = ([0.0; 3], 0);
    while !matches!(run.advance(1.5).expect("smooth"), Progress::Done { .. }) {
        steps += 1;
        let (from, to) = run.last_step();
        run.interpolate(0.3 * from + 0.7 * to, &mut y).expect("inside");
        run.interpolate(0.5 * from + 0.5 * to, &mut y).expect("inside");
    }
    let statistics = run.statistics();
    assert_eq!(statistics.accepted, steps + 1);
    assert_eq!(statistics.dense_evaluations, dense_per_step * steps);
    assert_eq!(statistics.evaluations, problem.evaluations);
    assert_eq!(statistics.projections, problem.projections);
    assert_eq!(statistics.projections, statistics.accepted);
    assert_eq!(
        [
            statistics.retries,
            statistics.jacobians,
            statistics.factorisations,
            statistics.events
        ],
        [0; 4]
    );
}

#[test]
fn evaluations_are_counted() {
    for claim in [false, true] {
        check(Rk4::new(0.01), claim, 0);
        check(Newmark::new(0.01, Corrector::Times(2)), claim, 0);
        check(DormandPrince5::default(), claim, 0);
        check(Dop853::default(), claim, 3);
        check(Adams::default(), claim, 0);
    }
}

#[test]
fn work_per_step() {
    fn statistics<M: Method<Pleiades>>(method: M) -> linkdyn_integrators::Statistics {
        let settings = Settings {
            first_step: Some(1e-3),
            ..Settings::tolerances(1e-7, 1e-7)
        };
        let mut run = Integration::new(Pleiades, method, 0.0, &Pleiades::START, settings).expect("good settings");
        finish(&mut run, 3.0);
        run.statistics()
    }
    let dp5 = statistics(DormandPrince5::default());
    assert_eq!(dp5.evaluations, 1 + 6 * (dp5.accepted + dp5.rejected));
    let dop = statistics(Dop853::default());
    assert_eq!(dop.evaluations, 1 + 12 * dop.accepted + 11 * dop.rejected);
    assert!(dop.rejected > 0);
    let adams = statistics(Adams::default());
    assert_eq!(adams.evaluations, 1 + 2 * adams.accepted + adams.rejected);
}

#[test]
fn newmark_counts_its_iterations() {
    let mut run = Integration::new(
        Kink,
        Newmark::new(0.1, Corrector::Times(3)),
        0.0,
        &Kink::START,
        Settings::default(),
    )
    .expect("good settings");
    finish(&mut run, 1.5);
    let statistics = run.statistics();
    assert_eq!(
        (statistics.accepted, statistics.iterations, statistics.evaluations),
        (15, 45, 1 + 4 * 15)
    );
}

//! Loops eliminated where they close, beside all of them at once.

use linkdyn_dynamics::{Baumgarte, Formulation, Guide, Guided, ReactionLoad, System, Workspace, lagrange};
use linkdyn_mechanisms::catalogue::{Rsrrr, rsrrr};
use linkdyn_tests::ladders::{Stage, folded};
use linkdyn_tests::loads::Rough;
use linkdyn_tests::numbers::{condition, largest};
use linkdyn_tests::{Blueprint, strategies};
use proptest::prelude::*;
use std::sync::Arc;

/// Trees with many loops, redundant ones too, whose condition is known.
fn loops() -> impl Strategy<Value = (Blueprint, f64)> {
    strategies::closed(2..=12, 1..=6).prop_filter_map("well conditioned", |blueprint| {
        let machine = blueprint.machine(Formulation::Lagrange);
        let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
        let product = condition(&equations)?.product();
        (product < 1e6).then_some((blueprint, product))
    })
}

/// Largest difference, relative to the largest entry or to 1, which is the order of all that there is.
fn apart(found: &[f64], known: &[f64]) -> f64 {
    let gaps: Vec<f64> = found.iter().zip(known).map(|(a, b)| a - b).collect();
    largest(&gaps) / largest(known).max(1.0)
}

/// Rounding of 1e-16, some of them, times the condition.
fn rounding(condition: f64) -> f64 {
    (1e-14 * condition).max(1e-10)
}

/// An acceleration of 1.
#[derive(Debug)]
struct Hurried;

impl Guide for Hurried {
    fn at(&self, t: f64) -> [f64; 3] {
        [0.5 * t * t, t, 1.0]
    }
}

/// The dense way and the local one.
const BOTH: [Formulation; 2] = [Formulation::ArticulatedBody, Formulation::LocalLoops];

fn assert_same([dense, local]: &[Workspace; 2], most: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(local.redundant(), dense.redundant());
    let pairs = [
        (local.rates(), dense.rates()),
        (local.multipliers(), dense.multipliers()),
        (local.reaction_loads(), dense.reaction_loads()),
    ];
    for (k, (found, known)) in pairs.into_iter().enumerate() {
        let gap = apart(found, known);
        prop_assert!(gap < most, "{k}: {gap:e} of {:e}", largest(known));
    }
    Ok(())
}

proptest! {
    #![proptest_config(strategies::cases(200))]

    #[test]
    fn accelerations_and_multipliers_are_those_of_the_dense_way((blueprint, condition) in loops()) {
        let both = BOTH.map(|formulation| blueprint.machine(formulation).evaluate());
        assert_same(&both, rounding(condition))?;
    }

    /// Speeds that break the loops: redundant equations then contradict each other.
    #[test]
    fn so_they_are_with_drift_terms_and_loads_by_reactions(
        (blueprint, condition) in loops(),
        dv in prop::collection::vec(strategies::number(0.1), 80),
    ) {
        let both = BOTH.map(|formulation| {
            let (mut description, links) = blueprint.description();
            description.formulation = formulation;
            description.baumgarte = Some(Baumgarte { alpha: 3.0, beta: 5.0 });
            let rough = Rough { scale: 0.01, floor: 0.1, arm: 0.05 };
            let single = |link: &&_| description.tree.speed_range(**link).len() == 1;
            let rubbing = links.iter().filter(single).take(5);
            description.reaction_loads = rubbing.map(|&link| (link, Arc::new(rough) as Arc<dyn ReactionLoad>)).collect();
            let system = System::new(description).expect("valid");
            let mut work = Workspace::new(&system);
            let v: Vec<f64> = blueprint.speeds().iter().zip(&dv).map(|(v, d)| v + d).collect();
            let outcome = system.evaluate(0.0, &blueprint.coordinates(), &v, &mut work);
            outcome.is_ok().then_some(work)
        });
        let [Some(dense), Some(local)] = both.clone() else {
            // A jammed joint is one both ways.
            prop_assert!(both.iter().all(Option::is_none));
            return Ok(());
        };
        assert_same(&[dense, local], rounding(condition))?;
    }

    /// Prescribed motions of some coordinates, which may fight the loops.
    #[test]
    fn so_they_are_with_prescribed_motions((blueprint, condition) in loops(), every in 2_usize..6) {
        let both = BOTH.map(|formulation| {
            let (mut description, links) = blueprint.description();
            description.formulation = formulation;
            let single = |link: &&_| description.tree.speed_range(**link).len() == 1;
            let guided = links.iter().filter(single).step_by(every).map(|&link| Guided {
                coordinate: description.tree.coordinate_range(link).start,
                speed: description.tree.speed_range(link).start,
                speed_only: false,
                guide: Arc::new(Hurried),
            });
            description.guided = guided.collect();
            let system = System::new(description).expect("valid");
            let mut work = Workspace::new(&system);
            let outcome = system.evaluate(0.0, &blueprint.coordinates(), &blueprint.speeds(), &mut work);
            (outcome.map(|()| work), system)
        });
        // The Lagrange equations know the closures only.
        let system = &both[0].1;
        let mut equations = lagrange::equations(system, &blueprint.coordinates(), &blueprint.speeds());
        let first = equations.gradient.nrows();
        equations.gradient.resize_vertically_mut(first + system.guided().len(), 0.0);
        for (k, guided) in system.guided().iter().enumerate() {
            equations.gradient[(first + k, guided.speed)] = 1.0;
        }
        let held = linkdyn_tests::numbers::condition(&equations).map_or(f64::INFINITY, |condition| condition.product());
        prop_assume!(held < 1e6);
        let [(Ok(dense), _), (Ok(local), _)] = both else {
            return Err(TestCaseError::fail("refused"));
        };
        assert_same(&[dense, local], rounding(condition.max(held)))?;
    }

    #[test]
    fn projection_takes_the_same_way(
        (blueprint, condition) in loops(),
        dq in prop::collection::vec(strategies::number(1e-7), 80),
        dv in prop::collection::vec(strategies::number(1.0), 80),
    ) {
        let [dense, local] = BOTH.map(|formulation| blueprint.machine(formulation));
        let mut works = [&dense, &local].map(|machine| Workspace::new(&machine.system));
        let off: Vec<f64> = dense.v.iter().zip(&dv).map(|(v, d)| v + d).collect();
        let mut drifted = dense.q.clone();
        dense.tree().displace(&mut drifted, &dq);
        // Both ways take the metric near the drifted state, but not at the same place.
        for (q, most) in [(&dense.q, rounding(condition)), (&drifted, 1e-7 * condition.max(10.0))] {
            let [one, other] = [(&dense, 0), (&local, 1)].map(|(machine, k)| {
                let (mut q, mut v) = (q.clone(), off.clone());
                let drift = machine.system.project(0.0, &mut q, &mut v, &mut works[k]);
                (q, v, drift)
            });
            // The second steps differ by products of drifts.
            prop_assert!(apart(&other.0, &one.0) < 1e-12 * condition.max(1.0), "{:e}", apart(&other.0, &one.0));
            prop_assert!(apart(&other.1, &one.1) < most, "{:e}", apart(&other.1, &one.1));
            prop_assert_eq!(other.2.changed, one.2.changed);
        }
    }
}

#[test]
fn ladders_and_crowds_move_as_by_the_dense_way() {
    for stage in Stage::ALL {
        for count in [1, 2, 7, 20] {
            let mut blueprint = stage.times(count);
            blueprint.make_speeds_consistent();
            let [dense, local] = BOTH.map(|formulation| blueprint.machine(formulation).evaluate());
            let loops = blueprint.cuts.len();
            assert_eq!(
                (dense.redundant(), local.redundant()),
                (3 * loops, 3 * loops),
                "{stage:?} {count}"
            );
            let gaps = [
                apart(local.rates(), dense.rates()),
                apart(local.multipliers(), dense.multipliers()),
            ];
            assert!(largest(&gaps) < 1e-10, "{stage:?} {count}: {gaps:?}");
        }
    }
}

#[test]
fn ladders_are_projected_as_by_the_dense_way() {
    for stage in Stage::ALL {
        let mut blueprint = stage.times(12);
        blueprint.make_speeds_consistent();
        let [dense, local] = BOTH.map(|formulation| {
            let machine = blueprint.machine(formulation);
            let mut work = machine.evaluate();
            let (mut q, mut v) = (machine.q.clone(), machine.v.clone());
            q.iter_mut()
                .enumerate()
                .for_each(|(k, q)| *q += 1e-6 * (k as f64).sin());
            v.iter_mut()
                .enumerate()
                .for_each(|(k, v)| *v += 1e-6 * (k as f64).cos());
            machine.system.project_beyond(0.0, 1e-12, &mut q, &mut v, &mut work);
            let (position, velocity) = machine.system.violation(0.0, &q, &v, &mut work);
            assert!(
                position < 1e-11 && velocity < 1e-10,
                "{stage:?}, {formulation:?}: {position:e} {velocity:e}"
            );
            (q, v)
        });
        let gaps = [apart(&local.0, &dense.0), apart(&local.1, &dense.1)];
        assert!(largest(&gaps) < 1e-9, "{stage:?}: {gaps:?}");
    }
}

/// The dense way pivots over all loops at once, the local one has to take the bad loop first.
#[test]
fn a_loop_that_is_nearly_singular_by_itself_costs_no_digits() {
    for angle in [0.5, 1e-2, 1e-3, 1e-4] {
        let mut blueprint = folded(angle);
        blueprint.make_speeds_consistent();
        let [dense, local] = BOTH.map(|formulation| blueprint.machine(formulation).evaluate());
        assert_eq!((dense.redundant(), local.redundant()), (7, 7), "{angle}");
        let gaps = [
            apart(local.rates(), dense.rates()),
            apart(local.multipliers(), dense.multipliers()),
        ];
        assert!(largest(&gaps) < 1e-11, "{angle}: {gaps:?}");
    }
}

fn loop_work(system: &System) -> Option<usize> {
    Workspace::new(system).loop_work()
}

/// Beyond the first ones each stage takes the same work as the one before, so that all of it is linear to the last operation.
#[test]
fn work_on_small_loops_is_linear_in_their_number() {
    for stage in Stage::ALL {
        let work = |count| loop_work(&stage.times(count).machine(Formulation::LocalLoops).system).expect("local");
        let works = [10, 20, 40].map(work);
        assert_eq!(works[2] - works[1], 2 * (works[1] - works[0]), "{stage:?}: {works:?}");
        assert_eq!(works[1] > works[0], stage != Stage::Link, "{stage:?}: {works:?}");
    }
}

#[test]
fn many_loops_are_eliminated_one_by_one_and_few_at_once() {
    let many = Stage::Apart.times(20).machine(Formulation::Recursive);
    assert!(loop_work(&many.system).is_some());
    let few = rsrrr(&Rsrrr::default()).linkage.build().expect("valid");
    assert_eq!(few.system().equations(), 3);
    assert_eq!(loop_work(few.system()), None);
}

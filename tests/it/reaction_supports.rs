//! Loads on supports are found on a way of their own, by fours and for all right-hand sides at once; here it is compared with the
//! plain one: the loads found are put on as drives, and reactions found by Newton and Euler.

use crate::reaction_loop::{Rubbing, gap, single, sound};
use linkdyn_dynamics::{
    Description, DynamicsError, Formulation, ReactionLoad, ReactionSolver, Supports, System, Workspace,
};
use linkdyn_kinematics::LinkId;
use linkdyn_tests::loads::OnSupports;
use linkdyn_tests::numbers::largest;
use linkdyn_tests::strategies;
use proptest::prelude::*;
use std::mem::discriminant;

fn on_supports(scale: f64) -> impl Strategy<Value = OnSupports> {
    let weight = || 0.0..1.0;
    let pair = move || [weight(), weight()];
    (0.1 * scale..scale, [pair(), pair()], pair()).prop_map(|(scale, [one, [a, b]], along)| OnSupports {
        scale,
        supports: Supports {
            across: [one, [a, -b]],
            along,
        },
        told: true,
    })
}

/// One to fourteen loads: of one four, of two, of three, and more than are found by fours. Several may be on one joint.
fn rubbing(scale: f64) -> impl Strategy<Value = Rubbing<OnSupports>> {
    let blueprint = sound(strategies::closed(1..=6, 0..=2));
    (blueprint, prop::collection::vec(on_supports(scale), 1..=14)).prop_filter_map(
        "a joint of one freedom",
        |(blueprint, rough)| {
            let parts = single(&blueprint);
            let rough: Vec<_> = parts.iter().copied().cycle().zip(rough).collect();
            (!rough.is_empty()).then_some(Rubbing { blueprint, rough })
        },
    )
}

/// The same loads, of which some do not tell their supports.
fn silent(case: &Rubbing<OnSupports>, which: impl Fn(usize) -> bool) -> Rubbing<OnSupports> {
    let mut silent = case.clone();
    silent
        .rough
        .iter_mut()
        .enumerate()
        .for_each(|(j, (_, rough))| rough.told = !which(j));
    silent
}

/// An evaluation. It may fail: sums of lengths have kinks, at which Newton's method may go to and fro.
fn attempt(case: &Rubbing<OnSupports>, description: Description) -> Result<Workspace, DynamicsError> {
    let system = System::new(description).expect("valid");
    let mut work = Workspace::new(&system);
    system.evaluate(0.0, &case.blueprint.coordinates(), &case.blueprint.speeds(), &mut work)?;
    Ok(work)
}

proptest! {
    #![proptest_config(strategies::cases(300))]

    #[test]
    fn loads_found_fulfil_the_loop_when_put_on_as_drives(case in rubbing(0.03)) {
        let found = attempt(&case, case.description());
        prop_assume!(found.is_ok());
        let work = found.expect("checked");
        prop_assert!(work.reaction_residual() <= 1e-12 && work.reaction_measure() > 0.0);
        let (plain, driven) = case.driven(work.reaction_loads());
        // The loop is solved to 1e-12 of its loads, the rest is the condition.
        let gaps = (gap(work.rates(), driven.rates()), gap(work.multipliers(), driven.multipliers()));
        prop_assert!(gaps.0 < 1e-11 && gaps.1 < 1e-11, "{gaps:?}");
        let links: Vec<LinkId> = plain.tree().joints().iter().map(|(link, _)| *link).collect();
        for ((part, rough), force) in case.rough.iter().zip(work.reaction_loads()) {
            let capacity = rough.capacity(&plain.reaction(links[*part], &driven)).value;
            let asked = -rough.gain(case.blueprint.parts[*part].v[0]) * capacity;
            prop_assert!((asked - force).abs() < 1e-11 * largest(work.reaction_loads()).max(1.0), "{asked} {force}");
        }
        prop_assert!((work.power() - driven.power()).abs() < 1e-10 * (1.0 + work.power().abs()));
    }

    #[test]
    fn told_supports_change_nothing_but_the_way(case in rubbing(0.03), untold in 1..15_usize) {
        let told = attempt(&case, case.description());
        prop_assume!(told.is_ok());
        let told = told.expect("checked");
        // None of the loads tells, or some of them do not.
        for silent in [silent(&case, |_| true), silent(&case, |j| j % untold == 0)] {
            let plain = attempt(&silent, silent.description()).expect("the same loop");
            prop_assert!(gap(told.reaction_loads(), plain.reaction_loads()) < 1e-11);
            prop_assert!(gap(told.rates(), plain.rates()) < 1e-11);
            prop_assert!(gap(told.multipliers(), plain.multipliers()) < 1e-11);
            let measures = (told.reaction_measure(), plain.reaction_measure());
            prop_assert!((measures.0 - measures.1).abs() < 1e-9 * measures.1, "{measures:?}");
        }
    }

    #[test]
    fn all_formulations_find_the_same_loads(case in rubbing(0.03)) {
        let with = |formulation| Description { formulation, ..case.description() };
        let first = attempt(&case, with(Formulation::Lagrange));
        prop_assume!(first.is_ok());
        let reference = first.expect("checked");
        for formulation in [Formulation::CompositeBody, Formulation::ArticulatedBody] {
            let work = attempt(&case, with(formulation)).expect("the same equations");
            prop_assert!(gap(work.reaction_loads(), reference.reaction_loads()) < 1e-11);
            prop_assert!(gap(work.rates(), reference.rates()) < 1e-11);
        }
    }

    #[test]
    fn jams_are_the_same_whether_supports_are_told_or_not(case in rubbing(1.0)) {
        let plain = silent(&case, |_| true);
        match (attempt(&case, case.description()), attempt(&plain, plain.description())) {
            (Ok(told), Ok(plain)) => {
                // The condition of the loop comes on top.
                let gap = gap(told.reaction_loads(), plain.reaction_loads());
                let condition = 1.0 / told.reaction_measure().min(1.0);
                prop_assert!(gap < 1e-9 * condition, "{gap:e} at a measure of {}", told.reaction_measure());
            }
            (Err(told), Err(plain)) => prop_assert_eq!(discriminant(&told), discriminant(&plain), "{} {}", told, plain),
            (told, plain) => prop_assert!(false, "{:?} {:?}", told.err(), plain.err()),
        }
    }

    #[test]
    fn sweeps_are_the_same_whether_supports_are_told_or_not(case in rubbing(0.03), sweeps in 0..4_usize) {
        let solver = ReactionSolver::Sweeps { sweeps };
        let loads = |case: &Rubbing<OnSupports>| {
            let description = Description { reaction_solver: solver, ..case.description() };
            let work = attempt(case, description).expect("sweeps never fail");
            (work.reaction_loads().to_vec(), work.reaction_residual())
        };
        let (told, plain) = (loads(&case), loads(&silent(&case, |_| true)));
        prop_assert!(gap(&told.0, &plain.0) < 1e-11 && (told.1 - plain.1).abs() < 1e-10);
    }
}

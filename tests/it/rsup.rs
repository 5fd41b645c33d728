//! The RSUP scene in all its variants against independent reference solutions, against itself by other routes, and its energy.

use linkdyn_integrators::{Adams, Dop853, Radau5};
use linkdyn_mechanisms::catalogue::{ClearanceKind, Rsup};
use linkdyn_mechanisms::{Observation, Simulation};
use linkdyn_tests::reference::{self, Table};
use linkdyn_tests::scenes::{Finished, Ready, distance, ready_rsup, simulate};

/// Radial clearance of the nominal scene \[m\].
const CLEARANCE: f64 = 1e-3;

fn planar() -> Rsup {
    Rsup {
        clearance: Some(ClearanceKind::Planar),
        ..Rsup::default()
    }
}

fn spatial() -> Rsup {
    Rsup {
        clearance: Some(ClearanceKind::Spatial),
        ..Rsup::default()
    }
}

/// Largest difference of the columns of the reference that begin with `head`, over all its rows.
fn difference(ready: &Ready, rows: &[Observation], table: &Table, head: &str) -> f64 {
    let columns = Simulation::new(&ready.mechanism).columns(false);
    let shared: Vec<(usize, usize)> = (0..columns.len())
        .filter(|&k| columns[k].starts_with(head))
        .filter_map(|k| Some((k, table.columns().iter().position(|name| *name == columns[k])?)))
        .collect();
    assert!(!shared.is_empty(), "no column {head}");
    let mut numbers = Vec::new();
    let mut worst = 0.0_f64;
    let last = rows.last().expect("rows").t;
    for expected in table.rows().iter().filter(|expected| expected[0] <= last + 1e-9) {
        let row = rows
            .iter()
            .find(|row| (row.t - expected[0]).abs() < 1e-9)
            .expect("a row at this time");
        row.write(false, &mut numbers);
        for &(own, theirs) in &shared {
            worst = worst.max((numbers[own] - expected[theirs]).abs());
        }
    }
    worst
}

fn energy_error(rows: &[Observation]) -> f64 {
    let start = rows[0].energy_balance();
    rows.iter()
        .map(|o| (o.energy_balance() - start).abs())
        .fold(0.0, f64::max)
}

#[test]
fn the_ideal_run_equals_the_independent_reference() {
    let ready = ready_rsup(&Rsup::default());
    let run = simulate(&ready, Dop853::default(), 1e-13, 5.0, 0.05);
    run.end.as_ref().expect("runs to the end");
    let table = reference::rsup_ideal();
    for (head, limit) in [
        ("q.", 1e-11),
        ("v.", 1e-10),
        ("a.", 1e-8),
        ("energy.kinetic", 1e-10),
        ("energy.potential", 1e-11),
    ] {
        let found = difference(&ready, &run.rows, &table, head);
        assert!(found < limit, "{head} {found:e}");
    }
}

#[test]
fn the_ideal_run_agrees_between_families_and_keeps_energy_and_loop() {
    let ready = ready_rsup(&Rsup::default());
    let multistep = simulate(&ready, Adams::default(), 1e-13, 5.0, 0.01);
    let one_step = simulate(&ready, Dop853::default(), 1e-13, 5.0, 0.01);
    for run in [&multistep, &one_step] {
        assert!(energy_error(&run.rows) < 1e-10, "{:e} J", energy_error(&run.rows));
        assert!(run.rows.iter().all(|o| o.violation.0 < 1e-12 && o.violation.1 < 1e-12));
    }
    let pairs = multistep.rows.iter().zip(&one_step.rows);
    let apart = pairs.map(|(a, b)| distance(&a.q, &b.q).max(distance(&a.v, &b.v)));
    let apart = apart.fold(0.0, f64::max);
    assert!(apart < 1e-9, "{apart:e}");
}

/// Times of contacts made and lost, to 1e-6 clearances of way, and their speeds \[m/s\]. The reference lists the rate of the depth,
/// negative where contact is lost.
fn assert_events(run: &Finished, events: &Table, speed: f64) {
    for ((t, event), expected) in run.contacts.iter().zip(events.rows()) {
        let way = (t - expected[0]) * event.speed;
        assert!(way.abs() < 1e-6 * CLEARANCE, "{t} {}", expected[0]);
        assert!(
            (event.speed - expected[3].abs()).abs() < speed,
            "{} {}",
            event.speed,
            expected[3]
        );
        assert_eq!(event.made, expected[3] > 0.0);
    }
}

#[test]
fn contacts_at_the_edges_of_the_bearing_equal_the_independent_reference() {
    let ready = ready_rsup(&spatial());
    let run = simulate(&ready, Dop853::default(), 1e-12, 0.5, 0.01);
    run.end.as_ref().expect("runs to the end");
    let events = reference::rsup_spatial_events();
    assert_eq!(run.contacts.len(), events.rows().len());
    assert_events(&run, &events, 1e-6);
    let table = reference::rsup_spatial();
    let heads = ["contact.R1.depth", "contact.R2.depth"].map(|head| (head, 1e-6 * CLEARANCE));
    let others = [
        ("q.", 1e-9),
        ("contact.R1.bristle", 1e-9),
        ("contact.R1.impact_speed", 1e-7),
    ];
    for (head, limit) in heads.into_iter().chain(others) {
        let found = difference(&ready, &run.rows, &table, head);
        assert!(found < limit, "{head} {found:e}");
    }
}

#[test]
fn contacts_without_friction_equal_the_independent_reference_before_chaos_takes_over() {
    let ready = ready_rsup(&Rsup {
        friction: None,
        ..planar()
    });
    let run = simulate(&ready, Dop853::default(), 1e-13, 0.2, 0.01);
    run.end.as_ref().expect("runs to the end");
    let events = reference::rsup_planar_frictionless_events();
    assert!(run.contacts.len() > 10);
    assert_events(&run, &events, 1e-6);
}

#[test]
fn the_flexible_coupler_equals_the_independent_reference() {
    let ready = ready_rsup(&Rsup {
        flexible: Some(4),
        ..Rsup::default()
    });
    let table = reference::rsup_flexible();
    let run = simulate(&ready, Dop853::default(), 1e-11, 0.15, 0.05);
    run.end.as_ref().expect("runs to the end");
    let limits = [
        ("q.", 1e-9),
        ("v.", 1e-6),
        ("energy.kinetic", 1e-9),
        ("energy.elastic", 1e-9),
    ];
    for (head, limit) in limits {
        let found = difference(&ready, &run.rows, &table, head);
        assert!(found < limit, "{head} {found:e}");
    }
    assert!(energy_error(&run.rows) < 1e-9);
    assert!(run.rows.iter().any(|row| row.energy.elastic > 1e-6));
}

#[test]
fn explicit_and_implicit_methods_agree_on_contacts_and_on_elastic_links() {
    for variant in [
        planar(),
        Rsup {
            flexible: Some(2),
            ..Rsup::default()
        },
    ] {
        let ready = ready_rsup(&variant);
        let until = if variant.flexible.is_some() { 0.02 } else { 0.2 };
        let explicit = simulate(&ready, Dop853::default(), 1e-12, until, 0.01);
        let implicit = simulate(&ready, Radau5::default(), 1e-12, until, 0.01);
        assert_eq!(explicit.contacts.len(), implicit.contacts.len());
        for (a, b) in explicit.rows.iter().zip(&implicit.rows) {
            let apart = distance(&a.q, &b.q);
            assert!(apart < 1e-6 * CLEARANCE, "{apart:e} at {}", a.t);
        }
    }
}

#[test]
fn contacts_and_motion_with_clearance_equal_the_independent_reference() {
    let ready = ready_rsup(&planar());
    let run = simulate(&ready, Dop853::default(), 1e-12, 5.0, 0.01);
    run.end.as_ref().expect("runs to the end");
    let events = reference::rsup_planar_events();
    assert_eq!(run.contacts.len(), events.rows().len());
    assert_events(&run, &events, 1e-6);
    let table = reference::rsup_planar();
    for (head, limit) in [
        ("q.", 1e-9),
        ("contact.R.depth", 1e-6 * CLEARANCE),
        ("contact.R.impact_speed", 1e-7),
    ] {
        let found = difference(&ready, &run.rows, &table, head);
        assert!(found < limit, "{head} {found:e}");
    }
}

fn contact_run(variant: &Rsup, tolerance: f64, until: f64) -> (Ready, Finished) {
    let ready = ready_rsup(variant);
    let run = simulate(&ready, Dop853::default(), tolerance, until, 0.001);
    run.end.as_ref().expect("runs to the end");
    (ready, run)
}

#[test]
fn energy_with_contacts_is_kept_and_the_losses_are_the_work() {
    for kind in [ClearanceKind::Planar, ClearanceKind::Spatial] {
        for friction in [true, false] {
            let mut variant = Rsup {
                clearance: Some(kind),
                ..Rsup::default()
            };
            if !friction {
                variant.friction = None;
            }
            let (_, run) = contact_run(&variant, 1e-10, 0.2);
            assert!(run.contacts.len() > 4);
            let error = energy_error(&run.rows);
            let size = run.rows.iter().map(|o| o.energy.total().abs()).fold(0.0, f64::max);
            assert!(error < 1e-6 * size, "{kind:?} {friction}: {error:e} J of {size} J");
        }
    }
}

#[test]
fn rows_with_contacts_can_be_recomputed_from_their_own_state() {
    for kind in [ClearanceKind::Planar, ClearanceKind::Spatial] {
        let variant = Rsup {
            clearance: Some(kind),
            ..Rsup::default()
        };
        let (ready, run) = contact_run(&variant, 1e-9, 0.12);
        let mut touching = 0;
        for row in run.rows.iter().step_by(2) {
            let mut fresh = Simulation::new(&ready.mechanism);
            let y = fresh.restore(row);
            let mut again = Observation::default();
            fresh.observe(row.t, &y, &mut again).expect("the state exists");
            assert_eq!((&again.a, &again.contacts), (&row.a, &row.contacts), "t = {}", row.t);
            touching += usize::from(row.contacts.iter().any(|point| point.normal > 0.0));
        }
        assert!(touching > 3);
    }
}

#[test]
fn without_clearance_the_scene_is_the_ideal_one_to_the_last_bit() {
    let ideal = simulate(&ready_rsup(&Rsup::default()), Dop853::default(), 1e-9, 0.3, 0.01);
    let variant = Rsup {
        clearance: None,
        clearance_size: 2e-4,
        ..planar()
    };
    let without = simulate(&ready_rsup(&variant), Dop853::default(), 1e-9, 0.3, 0.01);
    assert_eq!(ideal.rows, without.rows);
    assert_eq!(ideal.statistics, without.statistics);
}

#[test]
fn the_journal_is_pushed_back_from_where_it_touches() {
    let (_, run) = contact_run(&planar(), 1e-9, 0.05);
    let touching = run.rows.iter().filter(|row| row.contacts[0].normal > 0.0);
    for row in touching {
        let point = &row.contacts[0];
        assert!(point.depth > 0.0 && point.impact_speed > 0.0);
        let [y, z, _] = point.journal;
        assert!((y.hypot(z) - CLEARANCE - point.depth).abs() < 1e-15);
    }
}

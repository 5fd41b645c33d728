//! The comparison of counts with the budget fails where it should and nowhere else.

use linkdyn_tests::budget::{Budget, Row};

fn budget(compiler: &str, rows: &[(&str, Option<u64>, u64)]) -> Budget {
    let row = |&(scene, instructions, allocations): &(&str, Option<u64>, u64)| Row {
        scene: scene.to_owned(),
        what: "evaluation".to_owned(),
        instructions,
        allocations,
    };
    Budget {
        compiler: compiler.to_owned(),
        processor: "x86_64".to_owned(),
        rows: rows.iter().map(row).collect(),
    }
}

fn one(instructions: u64, allocations: u64) -> Budget {
    budget("rustc 1", &[("rsup --flexible 4", Some(instructions), allocations)])
}

/// Failures and notes of a count against a budget of 10 000 instructions and no allocation.
fn found(counted: &Budget) -> (Vec<String>, Vec<String>) {
    let found = one(10_000, 0).compare(counted);
    (found.failures, found.notes)
}

#[test]
fn more_than_three_percent_fails_by_name() {
    assert_eq!(found(&one(10_300, 0)), (vec![], vec![]));
    let expected = "rsup --flexible 4, evaluation: 10301 instructions, +3.0 %, the budget is 10000";
    assert_eq!(found(&one(10_301, 0)), (vec![expected.to_owned()], vec![]));
}

#[test]
fn much_less_is_a_note() {
    assert_eq!(found(&one(9_700, 0)), (vec![], vec![]));
    let (failures, notes) = found(&one(9_699, 0));
    assert!(
        failures.is_empty() && notes[0].ends_with("it may be lowered"),
        "{failures:?} {notes:?}"
    );
}

#[test]
fn allocations_are_exact() {
    let (failures, _) = found(&one(10_000, 1));
    assert_eq!(
        failures,
        ["rsup --flexible 4, evaluation: 1 allocations, the budget is 0"]
    );
    assert_eq!(one(10_000, 1).compare(&one(10_000, 0)).failures.len(), 1);
}

#[test]
fn another_compiler_compares_allocations_only() {
    let other = budget("rustc 2", &[("rsup --flexible 4", Some(20_000), 0)]);
    let (failures, notes) = found(&other);
    assert!(failures.is_empty() && notes[0].contains("not compared"), "{notes:?}");
    let other = budget("rustc 2", &[("rsup --flexible 4", Some(20_000), 3)]);
    assert_eq!(found(&other).0.len(), 1);
    let without = budget("rustc 1", &[("rsup --flexible 4", None, 0)]);
    assert_eq!(
        found(&without),
        (vec![], vec!["instructions: not compared (no valgrind)".to_owned()])
    );
}

#[test]
fn figures_missing_on_either_side_fail() {
    let other = budget("rustc 1", &[("another", Some(1), 0)]);
    assert_eq!(found(&other).0.len(), 2);
    // A budget of nothing is exceeded by anything and not a number by nothing.
    assert_eq!(one(0, 0).compare(&one(0, 0)).failures.len(), 1);
}

#[test]
fn the_file_is_read_as_it_is_written() {
    let written = one(10_000, 0).to_string();
    assert_eq!(Budget::parse(&written), Ok(one(10_000, 0)));
    let error = Budget::parse(&written.replace("10000", "many")).unwrap_err();
    assert!(error.starts_with("line 4"), "{error}");
    assert!(Budget::parse(&written.replace("# compiler: ", "")).is_err());
}

/// The budget of the project: every scene by evaluation and step, none with an allocation.
#[test]
fn the_budget_of_the_project() {
    let budget = Budget::parse(include_str!("../../tools/budget.csv")).unwrap();
    assert_eq!(budget.rows.len(), 14);
    assert!(budget.rows.iter().all(|row| row.allocations == 0));
}

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use tempfile::tempdir;

use super::*;

/// Writes a run with one table of one row.
fn write(target: &Path, value: f64) -> Result<PathBuf, ResultsError> {
    let mut run = RunFolder::create(target)?;
    let mut table = run.table("states.csv", &["t", "q.psi"])?;
    table.row(&[0.0, value])?;
    table.finish()?;
    run.commit(&json!({ "scene": { "name": "test" } }))
}

fn value_in(target: &Path) -> f64 {
    let text = fs::read_to_string(target.join("states.csv")).expect("a table");
    text.lines()
        .nth(1)
        .expect("a row")
        .split(',')
        .nth(1)
        .expect("a value")
        .parse()
        .expect("a number")
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn a_run_has_its_files_and_a_manifest_and_leaves_nothing_beside() {
    let place = tempdir().unwrap();
    let target = place.path().join("a/b");
    let mut run = RunFolder::create(&target).unwrap();
    assert!(!target.exists());
    let mut table = run.table("states.csv", &["t", "v"]).unwrap();
    let mut events = run.events("events.csv").unwrap();
    table.row(&[0.0, 1.0]).unwrap();
    events.event(0.25, "contact made", "R", Some(-0.5)).unwrap();
    events.event(0.5, "a, \"b\"", "S", None).unwrap();
    assert_eq!((table.finish().unwrap(), events.finish().unwrap()), (1, 2));
    run.write("figure.svg", "<svg/>").unwrap();
    run.commit(&json!({ "method": "radau" })).unwrap();
    assert_eq!(names(&target), ["events.csv", "figure.svg", "run.json", "states.csv"]);
    assert_eq!(names(&place.path().join("a")), ["b"]);
    let states = fs::read(target.join("states.csv")).unwrap();
    assert_eq!(states, b"t,v\n0.0000000000000000e0,1.0000000000000000e0\n");
    let events = fs::read_to_string(target.join("events.csv")).unwrap();
    assert_eq!(
        events,
        "t,kind,name,speed\n2.5000000000000000e-1,contact made,R,-5.0000000000000000e-1\n5.0000000000000000e-1,\"a, \"\"b\"\"\",S,\n"
    );
    let manifest: Value = serde_json::from_slice(&fs::read(target.join("run.json")).unwrap()).unwrap();
    assert_eq!(manifest["method"], "radau");
    assert_eq!(manifest["program"]["name"], "linkdyn");
    assert_eq!(manifest["schema"], SCHEMA);
    assert_eq!(manifest["files"], json!(["events.csv", "figure.svg", "states.csv"]));
}

#[test]
fn a_run_without_events_has_no_such_file() {
    let place = tempdir().unwrap();
    let mut run = RunFolder::create(&place.path().join("r")).unwrap();
    run.events("events.csv").unwrap().finish().unwrap();
    let target = run.commit(&json!({})).unwrap();
    assert_eq!(names(&target), ["run.json"]);
    // And can be replaced like any other.
    write(&target, 1.0).unwrap();
}

#[test]
fn an_earlier_run_is_replaced_as_a_whole() {
    let place = tempdir().unwrap();
    let target = place.path().join("r");
    let mut run = RunFolder::create(&target).unwrap();
    run.write("only-in-the-first.svg", "").unwrap();
    run.commit(&json!({})).unwrap();
    write(&target, 2.0).unwrap();
    assert_eq!(names(&target), ["run.json", "states.csv"]);
    assert_eq!(names(place.path()), ["r"]);
}

#[test]
fn an_earlier_run_stays_until_the_commit_and_when_the_new_one_is_dropped() {
    let place = tempdir().unwrap();
    let target = place.path().join("r");
    write(&target, 1.0).unwrap();
    let mut run = RunFolder::create(&target).unwrap();
    let mut table = run.table("states.csv", &["t", "x"]).unwrap();
    table.row(&[0.0, 2.0]).unwrap();
    assert_eq!(value_in(&target), 1.0);
    drop(table);
    drop(run);
    assert_eq!(value_in(&target), 1.0);
    assert_eq!(names(place.path()), ["r"]);
}

#[cfg(target_os = "linux")]
#[test]
fn at_no_time_is_there_no_run() {
    use std::sync::atomic::{AtomicBool, Ordering};
    let place = tempdir().unwrap();
    let target = place.path().join("r");
    write(&target, 0.0).unwrap();
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let reader = scope.spawn(|| {
            let mut looks = 0;
            while !done.load(Ordering::SeqCst) {
                assert!(target.join("run.json").exists() && target.join("states.csv").exists());
                looks += 1;
            }
            looks
        });
        for i in 1..=50 {
            write(&target, f64::from(i)).unwrap();
        }
        done.store(true, Ordering::SeqCst);
        assert!(reader.join().unwrap() > 0);
    });
    assert_eq!(value_in(&target), 50.0);
}

#[test]
fn an_empty_folder_is_taken() {
    let place = tempdir().unwrap();
    let target = place.path().join("empty");
    fs::create_dir(&target).unwrap();
    write(&target, 1.0).unwrap();
    assert_eq!(value_in(&target), 1.0);
}

#[test]
fn folders_that_are_not_runs_are_refused_and_untouched() {
    let place = tempdir().unwrap();
    for (name, file, contents) in [
        ("thesis", "chapter.tex", "text"),
        ("other-json", "run.json", "{\"program\": {\"name\": \"other\"}}"),
        ("bare-json", "run.json", "[]"),
        ("broken-json", "run.json", "{\"program\""),
    ] {
        let target = place.path().join(name);
        fs::create_dir(&target).unwrap();
        fs::write(target.join(file), contents).unwrap();
        let error = write(&target, 1.0).expect_err(name);
        assert!(matches!(error, ResultsError::NotARun { .. }), "{error}");
        assert!(error.is_usage() && error.hint().is_some() && error.to_string().contains(name));
        assert_eq!(fs::read_to_string(target.join(file)).unwrap(), contents);
    }
}

#[test]
fn what_the_user_added_to_a_run_is_not_lost() {
    let place = tempdir().unwrap();
    let target = place.path().join("r");
    write(&target, 1.0).unwrap();
    fs::write(target.join("notes.txt"), "important").unwrap();
    assert!(matches!(write(&target, 2.0), Err(ResultsError::Foreign { extra, .. }) if extra == "notes.txt"));
    assert_eq!(value_in(&target), 1.0);
    fs::remove_file(target.join("notes.txt")).unwrap();

    // Also when it was added while the new run was on its way.
    let run = RunFolder::create(&target).unwrap();
    fs::create_dir(target.join("figures")).unwrap();
    assert!(matches!(run.commit(&json!({})), Err(ResultsError::Foreign { .. })));
    assert_eq!(value_in(&target), 1.0);
    assert_eq!(names(place.path()), ["r"]);
}

#[test]
fn files_and_paths_without_a_name_are_no_targets() {
    let place = tempdir().unwrap();
    let file = place.path().join("file");
    fs::write(&file, "").unwrap();
    for target in [file.as_path(), Path::new("/"), Path::new("")] {
        assert!(
            matches!(RunFolder::create(target), Err(ResultsError::NotAFolder { .. })),
            "{target:?}"
        );
    }
    let below = RunFolder::create(&file.join("x")).expect_err("a folder below a file");
    assert!(below.to_string().contains("file"), "{below}");
}

#[cfg(unix)]
#[test]
fn a_link_stays_and_its_folder_is_replaced() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let place = tempdir().unwrap();
    let (real, link) = (place.path().join("real"), place.path().join("link"));
    write(&real, 1.0).unwrap();
    symlink(&real, &link).unwrap();
    write(&link, 2.0).unwrap();
    assert!(link.is_symlink());
    assert_eq!(value_in(&real), 2.0);
    // Not private, as temporary folders are.
    let plain = place.path().join("plain");
    fs::create_dir(&plain).unwrap();
    let mode = |p: &Path| fs::metadata(p).unwrap().permissions().mode();
    assert_eq!(mode(&real), mode(&plain));
    symlink(place.path().join("nowhere"), place.path().join("dangling")).unwrap();
    let dangling = RunFolder::create(&place.path().join("dangling"));
    assert!(matches!(
        dangling,
        Err(ResultsError::NotAFolder {
            what: "a link to nothing",
            ..
        })
    ));
}

#[test]
fn what_a_killed_run_left_is_swept_and_a_living_one_is_not() {
    let place = tempdir().unwrap();
    let target = place.path().join("r");
    let dead = place.path().join(".r.linkdyn-new-dead");
    fs::create_dir(&dead).unwrap();
    fs::write(dead.join(".lock"), "").unwrap();
    fs::write(dead.join("states.csv"), "t\n").unwrap();
    let others = place.path().join(".r2.linkdyn-new-dead");
    fs::create_dir(&others).unwrap();
    let living = RunFolder::create(&target).unwrap();
    assert!(!dead.exists(), "the abandoned folder is still there");
    let second = RunFolder::create(&target).unwrap();
    assert!(others.exists(), "a folder of another target was removed");
    // Two runs into one folder: both finish, and the last one stays.
    living.commit(&json!({ "which": 1 })).unwrap();
    second.commit(&json!({ "which": 2 })).unwrap();
    let manifest: Value = serde_json::from_slice(&fs::read(target.join("run.json")).unwrap()).unwrap();
    assert_eq!(manifest["which"], 2);
}

#[test]
fn without_an_exchange_in_one_step_a_kill_in_between_is_repaired() {
    let place = tempdir().unwrap();
    let target = place.path().join("r");
    write(&target, 1.0).unwrap();
    let (new, aside) = (place.path().join("new"), place.path().join(".r.linkdyn-old"));
    write(&new, 2.0).unwrap();
    swap::in_two_steps(&new, &target, &aside).unwrap();
    assert_eq!((value_in(&target), value_in(&new)), (2.0, 1.0));
    // The new one cannot follow: the old one is back.
    assert!(swap::in_two_steps(&place.path().join("missing"), &target, &aside).is_err());
    assert_eq!(value_in(&target), 2.0);
    // Killed after the first step: the next run finds the old one again before it begins.
    fs::rename(&target, &aside).unwrap();
    let run = RunFolder::create(&target).unwrap();
    assert_eq!(value_in(&target), 2.0);
    drop(run);
    // Killed before the old one was removed: it goes.
    fs::create_dir(&aside).unwrap();
    write(&target, 3.0).unwrap();
    assert!(!aside.exists());
}

#[test]
fn numbers_come_back_bit_by_bit() {
    let place = tempdir().unwrap();
    let numbers = [
        0.1,
        -0.0,
        1.0 / 3.0,
        5e-324,
        f64::MIN_POSITIVE,
        f64::MAX,
        -f64::MAX,
        1e22,
        123_456_789.123_456_78,
        std::f64::consts::PI,
    ];
    let mut run = RunFolder::create(&place.path().join("r")).unwrap();
    let mut table = run.table("x.csv", &["x"]).unwrap();
    for x in numbers {
        table.row(&[x]).unwrap();
    }
    assert_eq!(table.finish().unwrap(), numbers.len() as u64);
    let target = run.commit(&json!({})).unwrap();
    let text = fs::read_to_string(target.join("x.csv")).unwrap();
    assert!(!text.contains('\r') && text.ends_with('\n'));
    let back: Vec<u64> = text
        .lines()
        .skip(1)
        .map(|l| l.parse::<f64>().unwrap().to_bits())
        .collect();
    assert_eq!(back, numbers.map(f64::to_bits));
}

proptest::proptest! {
    #[test]
    fn any_finite_number_comes_back(bits: u64) {
        let x = f64::from_bits(bits);
        if x.is_finite() {
            let text = format!("{x:.16e}");
            proptest::prop_assert_eq!(text.parse::<f64>().unwrap().to_bits(), bits);
        }
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_name() {
    let place = tempdir().unwrap();
    let mut run = RunFolder::create(&place.path().join("r")).unwrap();
    let mut table = run.table("x.csv", &["t", "q.psi"]).unwrap();
    table.row(&[0.0, 1.0]).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = table.row(&[1.0, bad]).expect_err("not finite");
        assert!(
            matches!(&error, ResultsError::NotFinite { row: 1, column, .. } if column == "q.psi"),
            "{error}"
        );
    }
    let error = table.row(&[1.0]).expect_err("too short");
    assert!(matches!(
        error,
        ResultsError::RowLength {
            expected: 2,
            found: 1,
            row: 1,
            ..
        }
    ));
    assert_eq!(table.finish().unwrap(), 1);
    let mut events = run.events("events.csv").unwrap();
    assert!(matches!(
        events.event(f64::NAN, "k", "n", None),
        Err(ResultsError::NotFinite { .. })
    ));
    assert!(matches!(
        events.event(0.0, "k", "n", Some(f64::INFINITY)),
        Err(ResultsError::NotFinite { .. })
    ));
    assert_eq!(events.finish().unwrap(), 0);
}

#[test]
fn impossible_columns_and_file_names_are_refused() {
    let place = tempdir().unwrap();
    let mut run = RunFolder::create(&place.path().join("r")).unwrap();
    for columns in [
        vec![],
        vec![""],
        vec!["t", "t"],
        vec!["a,b"],
        vec!["a b"],
        vec!["a\nb"],
        vec!["\"a\""],
    ] {
        assert!(
            matches!(run.table("x.csv", &columns), Err(ResultsError::Column { .. })),
            "{columns:?}"
        );
    }
    for name in ["", "run.json", "../x.csv", "a/b", "a\\b", ".lock", "..", "ä.csv"] {
        assert!(
            matches!(run.write(name, ""), Err(ResultsError::FileName { .. })),
            "{name}"
        );
    }
    run.write("x.svg", "").unwrap();
    for again in ["x.svg", "X.SVG"] {
        assert!(matches!(run.write(again, ""), Err(ResultsError::FileName { .. })));
    }
    // A table that could not be begun does not stand in the way of the commit.
    run.commit(&json!({})).unwrap();
}

#[test]
fn an_unfinished_table_or_a_manifest_that_is_no_object_is_not_committed() {
    let place = tempdir().unwrap();
    let target = place.path().join("r");
    let mut run = RunFolder::create(&target).unwrap();
    let table = run.table("x.csv", &["t"]).unwrap();
    assert!(matches!(
        run.commit(&json!({})),
        Err(ResultsError::Unfinished { count: 1, .. })
    ));
    drop(table);
    let run = RunFolder::create(&target).unwrap();
    assert!(matches!(run.commit(&json!([1, 2])), Err(ResultsError::Manifest { .. })));
    assert!(names(place.path()).is_empty());
}

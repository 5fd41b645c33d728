//! `linkdyn analyse` as a user starts it.

use std::process::{Command, Output};

fn linkdyn(words: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_linkdyn"));
    program.args(words).output().expect("the program starts")
}

/// The tables printed as JSON.
fn tables(words: &[&str]) -> Vec<serde_json::Value> {
    let run = linkdyn(&[&["analyse"], words, &["--json"]].concat());
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    serde_json::from_slice(&run.stdout).expect("JSON and nothing else")
}

#[test]
fn a_scene_is_analysed_in_every_way() {
    let text = |words: &[&str]| String::from_utf8(linkdyn(words).stdout).expect("UTF-8");
    let mobility = text(&["analyse", "rsrrr", "mobility"]);
    assert!(
        mobility.contains("freedoms that last") && !mobility.contains("redundant equation"),
        "{mobility}"
    );
    assert!(text(&["analyse", "rsup", "equilibrium"]).contains("stable"));

    let positions = tables(&["rsrrr", "positions", "--parts", "6"]);
    assert_eq!(positions[0]["rows"].as_array().expect("rows").len(), 7, "{positions:?}");

    // A spring-damping element adds three freedoms to that of the crank, which its resistance lets creep back in two ways.
    let modes = tables(&["rsup", "modes", "--flexible", "1"]);
    let rows = modes[1]["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 5, "{modes:?}");
    assert!(
        rows.iter()
            .all(|row| row["frequency"].as_f64().expect("a number") > 0.0)
    );
    let shapes = modes[2]["rows"].as_array().expect("rows");
    assert!(shapes.iter().all(|row| row["psi11"].is_number()), "{shapes:?}");
    // With the crank held nothing creeps.
    let modes = tables(&["rsup", "modes", "--flexible", "1", "--hold", "psi11"]);
    let rows = modes[1]["rows"].as_array().expect("rows");
    assert!(
        rows.len() == 3 && rows.iter().all(|row| row["moves most"] != "psi11"),
        "{modes:?}"
    );
    let shapes = modes[2]["rows"].as_array().expect("rows");
    assert!(
        shapes.iter().all(|row| row["psi11"].as_f64() == Some(0.0)),
        "{shapes:?}"
    );

    let branches = tables(&["rsrrr", "branches", "--guesses", "30"]);
    let (found, search) = (branches[0]["rows"].as_array().expect("rows"), &branches[1]);
    assert!(
        found.len() >= 2 && found.iter().all(|row| row["psi11"] == found[0]["psi11"]),
        "{branches:?}"
    );
    assert!(search.to_string().contains("led nowhere"), "{search:?}");

    let drives = tables(&[
        "rsrrr",
        "drives",
        "--parts",
        "3",
        "--speed=-2",
        "--to",
        "0.5",
        "--friction",
    ]);
    let rows = drives[0]["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 4, "{drives:?}");
    for row in rows {
        let number = |name: &str| row[name].as_f64().unwrap_or_else(|| panic!("{name}: {row:?}"));
        assert!((number("power") + 2.0 * number("drive")).abs() < 1e-9 * number("power").abs());
        assert!(number("reaction.J11.fz").abs() > 0.0 && number("friction.psi11") < 0.0);
    }
}

/// A run from the sagged coupler with the crank where it was; the same scene with clearance has contacts that forbid it.
#[test]
fn a_run_begins_from_equilibrium() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out").display().to_string();
    let run = |words: &[&str]| {
        let begin = [
            "run",
            "rsup",
            "--flexible",
            "1",
            "--until",
            "1e-4",
            "--every",
            "1e-4",
            "--json",
            "--out",
            &out,
        ];
        linkdyn(&[&begin, words].concat())
    };
    let positions = |words: &[&str]| -> Vec<(String, f64)> {
        let run = run(words);
        assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
        let rows = std::fs::read_to_string(folder.path().join("out/states.csv")).expect("rows");
        let mut lines = rows.lines().filter(|line| !line.starts_with('#'));
        let (head, first) = (lines.next().expect("a head"), lines.next().expect("a row"));
        let pairs = head.split(',').zip(first.split(','));
        let pairs = pairs.filter_map(|(name, value)| Some((name.strip_prefix("q.")?.to_owned(), value)));
        pairs
            .map(|(name, value)| (name, value.parse().expect("a number")))
            .collect()
    };
    let (straight, sagged) = (positions(&[]), positions(&["--equilibrium"]));
    let gap = |name: &str| {
        let of = |list: &[(String, f64)]| list.iter().find(|(known, _)| known == name).expect("it is there").1;
        (of(&straight) - of(&sagged)).abs()
    };
    assert_eq!(gap("psi11"), 0.0);
    let bent: f64 = straight.iter().map(|(name, _)| gap(name)).fold(0.0, f64::max);
    assert!(bent > 1e-7 && bent < 0.1, "{bent:e}");
    let refused = run(&["--equilibrium", "--clearance", "planar"]);
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        refused.status.code() == Some(1) && error.contains("joint `R` has clearance"),
        "{error}"
    );
    let unknown = run(&["--equilibrium=theta9"]);
    let error = String::from_utf8_lossy(&unknown.stderr).into_owned();
    assert!(error.contains("there is no coordinate `theta9`"), "{error}");
}

#[test]
fn what_cannot_be_analysed_says_why() {
    for (words, code, why) in [
        (
            vec!["analyse", "rsup", "equilibrium", "--clearance", "planar"],
            1,
            "joint `R` has clearance",
        ),
        (
            vec!["analyse", "rsrrr", "positions", "--drive", "psi12"],
            1,
            "there is no coordinate `psi12`",
        ),
        (vec!["analyse", "rsrrr", "colour"], 2, "possible values"),
        (vec!["analyse", "rsrr", "mobility"], 2, "did you mean `rsrrr`"),
    ] {
        let run = linkdyn(&words);
        let error = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(
            run.status.code() == Some(code) && error.contains(why),
            "{words:?}: {error}"
        );
    }
}

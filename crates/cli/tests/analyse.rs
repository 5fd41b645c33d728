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

//! The program with scene files of its user.

use std::fs;
use std::process::{Command, Output};

fn linkdyn(words: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_linkdyn"));
    program.args(words).output().expect("the program starts")
}

fn said(run: &Output) -> String {
    String::from_utf8_lossy(&run.stdout).into_owned() + &String::from_utf8_lossy(&run.stderr)
}

#[test]
fn a_new_file_is_checked_run_and_never_overwritten() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.toml");
    let (file, out) = (file.display().to_string(), folder.path().join("out"));
    let made = linkdyn(&["new", &file]);
    assert_eq!(made.status.code(), Some(0), "{}", said(&made));

    let checked = linkdyn(&["check", &file]);
    assert!(
        said(&checked).contains("cut: coupler - C (spherical) - rocker") && said(&checked).contains("C.fz"),
        "{}",
        said(&checked)
    );
    let analysed = linkdyn(&["analyse", &file, "equilibrium"]);
    assert!(said(&analysed).contains("stable"), "{}", said(&analysed));
    let run = linkdyn(&["run", &file, "--until", "0.1", "--out", &out.display().to_string()]);
    assert_eq!(run.status.code(), Some(0), "{}", said(&run));
    assert!(out.join("states.csv").is_file() && out.join("run.json").is_file());

    let before = fs::read_to_string(&file).expect("the file");
    let again = linkdyn(&["new", &file]);
    assert_eq!(again.status.code(), Some(2), "{}", said(&again));
    assert!(said(&again).contains("not there yet"), "{}", said(&again));
    assert_eq!(fs::read_to_string(&file).expect("the file"), before);
}

#[test]
fn a_wrong_key_is_told_with_its_place_and_the_right_word() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("broken.toml");
    fs::write(&file, "format = 1\n[links.rod]\nmas = 1\n").expect("written");
    let checked = linkdyn(&["check", &file.display().to_string()]);
    assert_eq!(checked.status.code(), Some(2), "{}", said(&checked));
    assert!(
        said(&checked).contains("line 3, column 1") && said(&checked).contains("did you mean `mass`?"),
        "{}",
        said(&checked)
    );
}

/// A prescribed crank is a drive to a run and held to what asks for rest; a loop that does not close is called by its cut joint.
#[test]
fn a_prescribed_crank_is_checked_and_analysed_and_an_open_loop_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.toml").display().to_string();
    assert_eq!(linkdyn(&["new", &file]).status.code(), Some(0));
    let made = fs::read_to_string(&file).expect("the file");
    let begin = made.find("drives = ").expect("the crank is driven");
    let end = begin + made[begin..].find('\n').expect("a line");
    let guided = made.replace(
        &made[begin..end],
        "prescribed = { polynomial = { coefficients = [1.0, 6.0] } }",
    );
    fs::write(&file, &guided).expect("written");
    for words in [
        vec!["check"],
        vec!["analyse", "mobility"],
        vec!["analyse", "positions"],
        vec!["analyse", "drives"],
        vec!["analyse", "branches"],
    ] {
        let words: Vec<&str> = [words[0], &file]
            .into_iter()
            .chain(words[1..].iter().copied())
            .collect();
        let run = linkdyn(&words);
        assert_eq!(run.status.code(), Some(0), "{words:?}: {}", said(&run));
    }
    let rest = linkdyn(&["analyse", &file, "equilibrium"]);
    assert!(said(&rest).contains("no freedom"), "{}", said(&rest));

    let far = made.replace("point = [0.4, 0, 0]", "point = [4.0, 0, 0]");
    assert!(far != made, "{made}");
    fs::write(&file, far).expect("written");
    let open = linkdyn(&["run", &file]);
    assert!(
        open.status.code() == Some(2) && said(&open).contains("cut joint `C`"),
        "{}",
        said(&open)
    );
}

#[test]
fn the_schema_is_json() {
    let schema: serde_json::Value = serde_json::from_slice(&linkdyn(&["schema"]).stdout).expect("JSON");
    assert!(schema["properties"]["joints"].is_object(), "{schema}");
}

#[test]
fn a_file_says_how_it_is_run_and_the_command_line_overrides_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.toml");
    let run = "[run]\nuntil = 0.1\nevery = 0.05\nmethod = \"rk4\"\nstep = 1e-3\n";
    let rod = "cylinder = { density = 7850, diameter = 0.02, along = [0.5, 0, 0] }";
    let joint = "kind = \"revolute\"\naxis = [0, 1, 0]\nsuccessor.link = \"rod\"";
    let text = format!("format = 1\n[links.rod]\n{rod}\n[joints.A]\n{joint}\n{run}");
    fs::write(&file, text).expect("written");
    let (file, out) = (
        file.display().to_string(),
        folder.path().join("out").display().to_string(),
    );
    let said_in = |words: &[&str]| {
        let run = linkdyn(&[&["run", &file, "--json", "--out", &out], words].concat());
        let manifest: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
        (
            manifest,
            fs::read_to_string(folder.path().join("out/states.csv"))
                .expect("rows")
                .lines()
                .count(),
        )
    };
    let (manifest, lines) = said_in(&[]);
    assert!(manifest.to_string().contains("\"method\":\"rk4\""), "{manifest}");
    assert_eq!(lines, 1 + 3);
    let (manifest, lines) = said_in(&["--method", "adams", "--every", "0.02"]);
    assert!(manifest.to_string().contains("\"method\":\"adams\""), "{manifest}");
    assert_eq!(lines, 1 + 6);
}

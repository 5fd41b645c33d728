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
fn all_examples_are_drawn_counted_and_can_start() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../mechanisms/scenes");
    let scenes = fs::read_dir(folder).expect("the scenes");
    let mut checked = 0;
    for path in scenes.map(|entry| entry.expect("an entry").path()) {
        let file = path.display().to_string();
        let run = linkdyn(&["check", &file]);
        assert_eq!(run.status.code(), Some(0), "{file}: {}", said(&run));
        for words in [
            "ground\n  ",
            "speeds of the tree",
            "freedoms here",
            "independent coordinates",
        ] {
            assert!(said(&run).contains(words), "{file}: {}", said(&run));
        }
        checked += 1;
    }
    assert!(checked >= 18, "{checked}");
}

/// What `linkdyn check` says of a text, and its exit code.
fn checked(text: &str) -> (String, Option<i32>) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.toml");
    fs::write(&file, text).expect("written");
    let run = linkdyn(&["check", &file.display().to_string()]);
    (said(&run), run.status.code())
}

const SLIDER: &str = r#"
format = 1
[links]
crank = { mass = 1, inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }
rod = { mass = 1, inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }
slider = { mass = 1 }
[joints.A]
kind = "revolute"
successor.link = "crank"
prescribed = { polynomial = { coefficients = [1, 10] } }
[joints.B]
kind = "revolute"
predecessor = { link = "crank", point = [0.1, 0, 0] }
successor.link = "rod"
[joints.C]
kind = "prismatic"
axis = [1, 0, 0]
successor.link = "slider"
limit = { lower = 0.1, contact = { kelvin_voigt = { stiffness = 1e6, damping = 10 } } }
[joints.D]
kind = "spherical"
predecessor = { link = "rod", point = [0.3, 0, 0] }
successor.link = "slider"
[forces.press]
at.link = "slider"
direction = [-1, 0, 0]
drives = [{ constant = { torque = 5 } }]
[struts.return]
to.link = "slider"
stiffness = 10
[start]
positions = { B = -1.3, C = 0.35 }
"#;

#[test]
fn what_moves_pushes_and_stops_is_drawn_and_a_prescribed_motion_takes_a_freedom() {
    let (said, code) = checked(SLIDER);
    assert_eq!(code, Some(0), "{said}");
    let drawn = "ground\n  A (revolute, prescribed motion) - crank\n    B (revolute) - rod\n  C (prismatic, stops) - slider\n\
                 cut: rod - D (spherical) - slider\nforce: press on slider\nstrut: ground - return - slider\n";
    assert!(said.starts_with(drawn), "{said}");
    let entry = |name: &str| {
        let line = said.lines().find(|line| line.starts_with(name)).expect("such a line");
        line[name.len()..].trim().to_owned()
    };
    assert_eq!(
        (entry("freedoms here"), entry("prescribed motions")),
        ("1".into(), "1".into())
    );
    assert_eq!(entry("freedoms left to forces"), "0");
}

#[test]
fn a_linkage_that_cannot_start_is_drawn_all_the_same() {
    // A rod too short to reach.
    let (said, code) = checked(&SLIDER.replace("point = [0.3, 0, 0]", "point = [0.01, 0, 0]"));
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.starts_with("ground\n  A (revolute") && said.contains("cannot start"),
        "{said}"
    );
    // A link without inertia that only its own turn would move.
    let (said, code) = checked(
        &SLIDER
            .replace("slider = { mass = 1 }", "slider = { mass = 1 }\nwheel = { mass = 0 }\n")
            .replace(
                "[joints.C]",
                "[joints.W]\nkind = \"revolute\"\nsuccessor.link = \"wheel\"\n[joints.C]",
            ),
    );
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("no accelerations at its start") && said.contains("`W`"),
        "{said}"
    );
}

#[test]
fn all_that_is_wrong_is_said_at_once() {
    let broken = SLIDER
        .replace("kind = \"prismatic\"", "kind = \"prismatik\"")
        .replace("stiffness = 10\n", "stiffness = -10\n")
        .replace("direction = [-1, 0, 0]", "direction = [0, 0, 0]");
    let (said, code) = checked(&broken);
    assert_eq!(code, Some(2), "{said}");
    for words in [
        "line 16, column 1: `joints.C.kind`: there is no word `prismatik`; did you mean `prismatic`?",
        "line 26, column 1: `forces.press.direction`: its length 0 must be a finite positive number",
        "line 30, column 1: `struts.return.stiffness`: stiffness = -10 must be",
    ] {
        assert!(said.contains(words), "{said}");
    }
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

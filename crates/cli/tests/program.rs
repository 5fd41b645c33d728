//! The program as a user starts it.

use std::process::{Command, Output};

fn linkdyn(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_linkdyn"))
        .args(words)
        .output()
        .expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("not killed")
}

#[test]
fn version_and_help_go_to_standard_output() {
    let version = linkdyn(&["--version"]);
    assert_eq!(code(&version), 0);
    assert_eq!(
        String::from_utf8_lossy(&version.stdout),
        format!("linkdyn {}\n", env!("CARGO_PKG_VERSION"))
    );
    let help = linkdyn(&["run", "--help"]);
    assert_eq!(code(&help), 0);
    for option in [
        "--friction",
        "--out",
        "--method",
        "--rtol",
        "--atol",
        "--step",
        "--until",
        "--every",
        "--json",
    ] {
        assert!(String::from_utf8_lossy(&help.stdout).contains(option), "{option}");
    }
}

#[test]
fn wrong_usage_has_exit_code_2_and_a_message_on_standard_error() {
    for words in [
        &[][..],
        &["fly"],
        &["run"],
        &["run", "rsrrr", "--out", "x", "--rtol", "-1"],
        &["run", "rsrrr", "--uot", "x"],
    ] {
        let output = linkdyn(words);
        assert_eq!(code(&output), 2, "{words:?}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{words:?}");
    }
}

/// A folder for results that goes when the test ends.
fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn text(path: &std::path::Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn scenes_are_listed() {
    let listed = linkdyn(&["scenes"]);
    assert_eq!(code(&listed), 0);
    assert!(String::from_utf8_lossy(&listed.stdout).contains("rsrrr"));
}

#[test]
fn a_run_writes_what_the_format_asks_for() {
    let folder = folder();
    let out = folder.path().join("run");
    let run = linkdyn(&[
        "run",
        "rsrrr",
        "--friction",
        "--until",
        "0.2",
        "--every",
        "0.05",
        "--out",
        &out.to_string_lossy(),
    ]);
    assert_eq!(code(&run), 0, "{}", String::from_utf8_lossy(&run.stderr));
    assert!(run.stderr.is_empty(), "silent where there is no terminal");
    assert!(String::from_utf8_lossy(&run.stdout).contains("peak force in J11"));
    let states = text(&out.join("states.csv"));
    let mut lines = states.lines();
    let head = lines.next().expect("a header");
    assert!(head.starts_with("t,q.psi11,q.psi21,q.psi22,q.psi23,v.psi11"), "{head}");
    for name in [
        "a.psi23",
        "lambda.S.fz",
        "reaction.J11.fx",
        "friction.psi11",
        "energy.work",
        "violation.velocity",
    ] {
        assert!(head.split(',').any(|column| column == name), "{name}");
    }
    let times: Vec<f64> = lines
        .map(|line| line.split(',').next().expect("t").parse().expect("a number"))
        .collect();
    assert_eq!(times.len(), 5);
    assert!(
        times
            .iter()
            .zip([0.0, 0.05, 0.1, 0.15, 0.2])
            .all(|(a, b)| (a - b).abs() < 1e-12),
        "{times:?}"
    );
    let manifest: serde_json::Value = serde_json::from_str(&text(&out.join("run.json"))).expect("JSON");
    assert_eq!(manifest["status"], "complete");
    assert_eq!(manifest["integration"]["method"], "adams");
    assert_eq!(manifest["scene"]["linkage"]["links"][0][0], "1,1");
    assert!(manifest["counters"]["evaluations"].as_u64().is_some_and(|n| n > 10));
    for picture in ["coordinates", "joint-loads"] {
        assert!(text(&out.join(format!("{picture}.svg"))).starts_with("<svg"));
        assert!(out.join(format!("{picture}.png")).is_file());
    }
}

#[test]
fn json_goes_to_standard_output_alone() {
    let folder = folder();
    let out = folder.path().join("run");
    let run = linkdyn(&[
        "run",
        "rsrrr",
        "--until",
        "0.1",
        "--json",
        "--out",
        &out.to_string_lossy(),
    ]);
    assert_eq!(code(&run), 0);
    let printed: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON and nothing else");
    assert_eq!(printed["scene"]["name"], "rsrrr");
}

#[test]
fn jamming_ends_with_exit_code_1_and_keeps_the_rows_up_to_there() {
    let folder = folder();
    let out = folder.path().join("run");
    let out_text = out.to_string_lossy();
    let run = linkdyn(&[
        "run",
        "rsrrr",
        "--friction",
        "--friction-scale",
        "2",
        "--rtol",
        "1e-8",
        "--out",
        &out_text,
    ]);
    assert_eq!(code(&run), 1);
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(
        said.contains("jams") && said.contains("psi21") && said.contains("0.529"),
        "{said}"
    );
    let manifest: serde_json::Value = serde_json::from_str(&text(&out.join("run.json"))).expect("JSON");
    assert_eq!(manifest["status"], "partial");
    assert_eq!(text(&out.join("states.csv")).lines().count(), 1 + 53);
}

#[test]
fn wrong_names_and_options_tell_what_would_be_right() {
    let folder = folder();
    let out = folder.path().join("run");
    let out_text = out.to_string_lossy();
    let cases: [(&[&str], &str); 9] = [
        (&["rsrr"], "did you mean `rsrrr`"),
        (&["rsrrr", "--method", "adam"], "did you mean `adams`"),
        (&["rsrrr", "--method", "rk4", "--rtol", "1e-8"], "--step"),
        (&["rsrrr", "--step", "1e-3"], "rk4"),
        (&["rsrrr", "--iterations", "3"], "newmark"),
        (&["rsrrr", "--rtol", "0.1"], "too loose"),
        (&["rsrrr", "--atol", "10"], "too loose"),
        (&["rsrrr", "--every", "1e-12"], "--every"),
        (&["rsrrr", "--friction", "--friction-scale", "1e300"], "1000"),
    ];
    for (words, expected) in cases {
        let words: Vec<&str> = ["run"]
            .iter()
            .chain(words)
            .copied()
            .chain(["--out", &out_text])
            .collect();
        let run = linkdyn(&words);
        assert_eq!(code(&run), 2, "{words:?}");
        let said = String::from_utf8_lossy(&run.stderr);
        assert!(said.contains(expected), "{words:?}: {said}");
        assert!(!out.exists(), "nothing is written");
    }
}

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

#[test]
fn a_report_has_certified_errors_that_fall_with_the_tolerance() {
    let folder = folder();
    let out = folder.path().join("report");
    let words = |until| {
        [
            "report",
            "rsrrr",
            "--friction",
            "--until",
            until,
            "--budget",
            "40",
            "--json",
            "--out",
        ]
    };
    let report = |until| linkdyn(&[&words(until)[..], &[&out.to_string_lossy()]].concat());
    // The folder is replaced as a whole.
    assert_eq!(code(&report("0.01")), 0);
    let printed = report("0.2");
    assert_eq!(code(&printed), 0, "{}", String::from_utf8_lossy(&printed.stderr));
    let printed: serde_json::Value = serde_json::from_slice(&printed.stdout).expect("JSON and nothing else");
    let written: serde_json::Value = serde_json::from_str(&text(&out.join("report.json"))).expect("JSON");
    assert_eq!(printed, written);
    assert_eq!(
        (&written["until"], &written["reference"]["horizon"]),
        (&0.2.into(), &0.2.into())
    );
    let accuracy = written["reference"]["accuracy"]["positions"]
        .as_f64()
        .expect("a number");
    assert!(accuracy > 0.0 && accuracy < 1e-9, "{accuracy}");
    let rows = written["rows"].as_array().expect("rows");
    let error = |method: &str, tolerance: f64| {
        let same = |row: &&serde_json::Value| {
            row["integration"]["method"] == method && row["integration"]["rtol"].as_f64() == Some(tolerance)
        };
        let positions = &rows.iter().find(same).expect("a row")["errors"]["positions"];
        let number = positions.get("value").or(positions.get("below"));
        number.and_then(serde_json::Value::as_f64).expect("an error or a bound")
    };
    assert!(rows.iter().all(|row| row["outcome"] == "done"), "{rows:#?}");
    for method in ["adams", "dop853", "dopri5", "radau5"] {
        assert!(error(method, 1e-10) < 0.1 * error(method, 1e-6), "{method}");
        assert!(error(method, 1e-12) >= accuracy, "{method}");
    }
    let papers: Vec<_> = rows.iter().filter(|row| row["papers_way"] == true).collect();
    assert_eq!(papers.len(), 1);
    assert_eq!(papers[0]["integration"]["method"], "newmark");
    assert_eq!(papers[0]["ratio_to_papers_way"]["evaluations"], 1.0);
    let table = text(&out.join("report.csv"));
    assert_eq!(table.lines().count(), 1 + rows.len());
    assert!(table.lines().all(|line| line.split(',').count() == 21));
    for picture in ["error-evaluations", "error-time", "reference"] {
        assert!(
            text(&out.join(format!("{picture}.svg"))).starts_with("<svg"),
            "{picture}"
        );
        assert!(out.join(format!("{picture}.png")).is_file(), "{picture}");
    }
}

#[test]
fn a_report_beyond_its_means_tells_so() {
    let folder = folder();
    let out = folder.path().join("report");
    let out_text = out.to_string_lossy();
    let cases: [(&[&str], i32, &str); 4] = [
        (&["rsrrr", "--budget", "1e-9"], 1, "--budget"),
        (&["rsrrr", "--friction", "--friction-scale", "2"], 1, "--until"),
        (&["rsrrr", "--clearance", "planar"], 2, "rsup"),
        (&["rsrrr", "--budget", "0"], 2, "greater than zero"),
    ];
    for (words, expected, said) in cases {
        let report = linkdyn(&[&["report"], words, &["--out", &out_text]].concat());
        let error = String::from_utf8_lossy(&report.stderr);
        assert!(code(&report) == expected && error.contains(said), "{words:?}: {error}");
        assert!(!out.exists(), "nothing is written");
    }
}

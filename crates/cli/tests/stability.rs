//! `linkdyn stability` as a user starts it.

use std::path::Path;
use std::process::{Command, Output};

fn linkdyn(words: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_linkdyn"));
    program.args(words).output().expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("not killed")
}

/// A folder for results that goes when the test ends.
fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn stability_tells_of_every_method_whatever_the_budget() {
    let folder = folder();
    let out = folder.path().join("stability");
    let out_text = out.to_string_lossy();
    let words = ["stability", "rsup", "--clearance", "planar", "--until", "0.016"];
    let run = linkdyn(&[&words[..], &["--budget", "2", "--json", "--out", &out_text]].concat());
    assert_eq!(code(&run), 0, "{}", String::from_utf8_lossy(&run.stderr));
    let printed: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON and nothing else");
    let whole: serde_json::Value = serde_json::from_str(&text(&out.join("stability.json"))).expect("JSON");
    assert_eq!(printed, whole);
    let rows = |table: &str| whole["tables"][table]["rows"].as_array().expect("rows").clone();

    let sweeps = rows("sweeps");
    for quantity in ["contact stiffness", "bristle stiffness", "mass ratio"] {
        for method in ["auto", "adams", "dop853", "dopri5", "radau5", "rk4", "newmark"] {
            let same = |row: &&serde_json::Value| row["quantity"] == quantity && row["method"] == method;
            assert_eq!(sweeps.iter().filter(same).count(), 7, "{quantity} {method}");
        }
    }
    for row in &sweeps {
        let outcome = row["outcome"].as_str().expect("a word");
        assert!(["done", "failed", "out of time", "not run"].contains(&outcome), "{row}");
        assert_eq!(
            outcome == "done",
            row["evaluations"].as_u64().is_some_and(|n| n > 0),
            "{row}"
        );
        assert_eq!(outcome == "failed", row["why"].is_string(), "{row}");
    }
    assert!(sweeps.iter().any(|row| row["outcome"] == "done"));

    // In free flight a pair of friction and gravity, in contact a fast oscillation.
    let eigenvalues = rows("eigenvalues");
    let number = |cell: &serde_json::Value| cell.as_str().and_then(|x| x.parse::<f64>().ok()).expect("a number");
    let fastest = |pressed: bool| {
        let some = eigenvalues
            .iter()
            .filter(|row| (number(&row["contact force"]) > 0.0) == pressed);
        some.map(|row| number(&row["largest modulus"])).fold(0.0, f64::max)
    };
    assert!(
        fastest(true) > 50.0 * fastest(false),
        "{} {}",
        fastest(true),
        fastest(false)
    );
    assert!(rows("long_run").len() >= 6);
    assert_eq!(rows("repeat").len(), 4 * rows("long_run").len());
    for row in rows("limits") {
        let [limited, of] = ["limited", "of"].map(|name| row[name].as_u64().expect("a count"));
        assert!(limited <= of && of == eigenvalues.len() as u64, "{row}");
    }
    assert!(
        rows("repeat")
            .iter()
            .all(|row| row["outcome"] != "differs" || row["what"] != "once more")
    );
    for file in [
        "sweeps.csv",
        "eigenvalues.csv",
        "eigenvalues.svg",
        "steps-contact-stiffness.png",
        "stable-steps.svg",
    ] {
        assert!(out.join(file).is_file(), "{file}");
    }
}

#[test]
fn stability_with_no_time_says_not_run() {
    let folder = folder();
    let out = folder.path().join("stability");
    let run = linkdyn(&[
        "stability",
        "rsrrr",
        "--budget",
        "1e-9",
        "--out",
        &out.to_string_lossy(),
    ]);
    assert_eq!(code(&run), 0, "{}", String::from_utf8_lossy(&run.stderr));
    let printed = String::from_utf8_lossy(&run.stdout).into_owned();
    assert!(
        printed.contains("mass ratio") && printed.contains("not run"),
        "{printed}"
    );
    let sweeps = text(&out.join("sweeps.csv"));
    assert!(
        sweeps.lines().count() >= 43 && sweeps.lines().skip(1).all(|line| line.contains("not run")),
        "{sweeps}"
    );
}

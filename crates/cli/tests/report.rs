//! `linkdyn report` as a user starts it.

use std::path::Path;
use std::process::{Command, Output};

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

/// Runs `linkdyn report` with references kept in `folder`.
fn report(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_linkdyn"))
        .arg("report")
        .args(words)
        .env("LINKDYN_CACHE", folder.join("cache"))
        .output()
        .expect("the program starts")
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&text(path)).expect("JSON")
}

#[test]
fn a_report_has_certified_errors_that_fall_with_the_tolerance() {
    let folder = folder();
    let out = folder.path().join("report");
    let out_text = out.to_string_lossy();
    let report = |until| {
        let words = ["rsrrr", "--friction", "--budget", "40", "--json", "--out", &out_text];
        report(folder.path(), &[&words[..], &["--until", until]].concat())
    };
    // The folder is replaced as a whole.
    assert_eq!(code(&report("0.01")), 0);
    let printed = report("0.1");
    assert_eq!(code(&printed), 0, "{}", String::from_utf8_lossy(&printed.stderr));
    let printed: serde_json::Value = serde_json::from_slice(&printed.stdout).expect("JSON and nothing else");
    let written = json(&out.join("report.json"));
    assert_eq!(printed, written);
    assert_eq!(
        (&written["until"], &written["reference"]["horizon"]),
        (&0.1.into(), &0.1.into())
    );
    let accuracy = |kind: &str| written["reference"]["accuracy"][kind].as_f64().expect("a number");
    assert!(accuracy("positions") > 0.0 && accuracy("positions") < 1e-9);
    let rows = written["rows"].as_array().expect("rows");
    let error = |method: &str, tolerance: f64, kind: &str| {
        let same = |row: &&serde_json::Value| {
            row["integration"]["method"] == method && row["integration"]["rtol"].as_f64() == Some(tolerance)
        };
        let error = &rows.iter().find(same).expect("a row")["errors"][kind];
        let number = error.get("value").or(error.get("below"));
        number.and_then(serde_json::Value::as_f64).expect("an error or a bound")
    };
    assert!(rows.iter().all(|row| row["outcome"] == "done"), "{rows:#?}");
    for method in ["auto", "adams", "dop853", "dopri5", "radau5", "bdf", "rodas"] {
        for kind in ["positions", "speeds", "forces"] {
            assert!(error(method, 1e-10, kind) < 0.1 * error(method, 1e-6, kind), "{method}");
            assert!(error(method, 1e-12, kind) >= accuracy(kind), "{method}");
        }
    }
    let papers: Vec<_> = rows.iter().filter(|row| row["papers_step"] == true).collect();
    assert_eq!(papers.len(), 1);
    assert_eq!(papers[0]["integration"]["method"], "newmark");
    assert_eq!(papers[0]["ratio_to_papers_way"]["evaluations"], 1.0);
    assert!(!written["best"]["rows"].as_array().expect("rows").is_empty());
    let table = text(&out.join("report.csv"));
    assert_eq!(table.lines().count(), 1 + rows.len());
    assert!(table.lines().all(|line| line.split(',').count() == 25));
    let page = text(&out.join("report.html"));
    assert_eq!(page.matches("<svg").count(), 3);
    for picture in ["error-evaluations", "error-time", "reference"] {
        assert!(
            text(&out.join(format!("{picture}.svg"))).starts_with("<svg"),
            "{picture}"
        );
        assert!(out.join(format!("{picture}.png")).is_file(), "{picture}");
    }
}

#[test]
fn references_are_kept_and_damaged_ones_are_not_used() {
    let folder = folder();
    let out = folder.path().join("report");
    let out_text = out.to_string_lossy();
    let made = |more: &[&str]| {
        let words = [
            "rsrrr", "--until", "0.01", "--budget", "2", "--quiet", "--out", &out_text,
        ];
        let done = report(folder.path(), &[&words[..], more].concat());
        assert_eq!(code(&done), 0, "{}", String::from_utf8_lossy(&done.stderr));
        json(&out.join("report.json"))["reference"].clone()
    };
    let unkept = made(&["--no-cache"]);
    assert!(!folder.path().join("cache").exists());
    let computed = made(&[]);
    let cached = made(&[]);
    assert_eq!(
        (&unkept["cached"], &computed["cached"], &cached["cached"]),
        (&false.into(), &false.into(), &true.into())
    );
    // To the last bit.
    for reference in [&unkept, &cached] {
        assert_eq!(reference["disagreement"], computed["disagreement"]);
        assert_eq!(reference["accuracy"], computed["accuracy"]);
    }
    let files: Vec<_> = std::fs::read_dir(folder.path().join("cache"))
        .expect("a folder")
        .collect();
    assert_eq!(files.len(), 1);
    let file = files[0].as_ref().expect("a file").path();
    std::fs::write(&file, &text(&file)[..1000]).expect("writes");
    let again = made(&[]);
    assert_eq!(again["cached"], false);
    assert!(
        again["note"].as_str().is_some_and(|note| note.contains("damaged")),
        "{again}"
    );
    assert_eq!(made(&[])["cached"], true);
}

#[test]
fn a_report_beyond_its_means_tells_so() {
    let folder = folder();
    let out = folder.path().join("report");
    let out_text = out.to_string_lossy();
    let cases: [(&[&str], i32, &str); 5] = [
        (&["rsrrr", "--budget", "1e-9"], 1, "--budget"),
        (&["rsrrr", "--clearance", "planar"], 2, "rsup"),
        (&["rsrrr", "--budget", "0"], 2, "greater than zero"),
        (&["rsrrr", "--all"], 2, "--all"),
        (&["--quiet"], 2, "SCENE"),
    ];
    for (words, expected, said) in cases {
        let report = report(folder.path(), &[words, &["--out", &out_text]].concat());
        let error = String::from_utf8_lossy(&report.stderr);
        assert!(code(&report) == expected && error.contains(said), "{words:?}: {error}");
        assert!(!out.exists(), "nothing is written");
    }
    // Twice the friction jams the linkage; what comes before that, or before the budget ends, is reported.
    let words = [
        "rsrrr",
        "--friction",
        "--friction-scale",
        "2",
        "--budget",
        "5",
        "--out",
        &out_text,
    ];
    let jammed = report(folder.path(), &words);
    let written = json(&out.join("report.json"));
    let why = written["reference"]["ended_early"].as_str().expect("a reason");
    assert_eq!(code(&jammed), i32::from(why.contains("ended early")), "{why}");
    let horizon = written["reference"]["horizon"].as_f64().expect("a time");
    assert!(horizon > 0.0 && horizon < 0.6, "{horizon}");
    assert_eq!(written["reference"]["whole_run"], false);
}

#[test]
fn all_scenes_make_one_page() {
    let folder = folder();
    let out = folder.path().join("report");
    let words = [
        "--all",
        "--until",
        "0.001",
        "--budget",
        "6",
        "--quiet",
        "--out",
        &out.to_string_lossy(),
    ];
    let all = report(folder.path(), &words);
    assert_eq!(code(&all), 0, "{}", String::from_utf8_lossy(&all.stderr));
    let scenes = json(&out.join("report.json"))["scenes"].clone();
    assert_eq!(scenes.as_array().map(Vec::len), Some(6));
    assert_eq!(scenes[3]["clearance"], 1e-3);
    let page = text(&out.join("report.html"));
    for title in ["RSRRR: joint friction", "RSUP: planar clearance, flexible coupler of 4"] {
        assert!(page.contains(&format!("<h2>{title}</h2>")), "{title}");
    }
    assert!(out.join("rsup-planar-flexible4-reference.svg").is_file());
}

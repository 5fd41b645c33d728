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
    assert_eq!(manifest["integration"]["method"], "auto");
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

/// A method that steps over a singular position may come out on another branch; its energy tells.
#[test]
fn a_run_that_loses_its_energy_is_none() {
    for (method, tolerance) in [("dopri5", "1e-10"), ("dop853", "1e-8")] {
        let out = folder();
        let path = out.path().join("run");
        let words = ["run", "n_four_bar", "--method", method, "--rtol", tolerance, "--out"];
        let output = linkdyn(&[&words[..], &[path.to_str().expect("text")]].concat());
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(code(&output), 1, "{method}: {error}");
        assert!(
            error.contains("energy balance is off by") && error.contains("singular position"),
            "{error}"
        );
        assert!(path.join("states.csv").exists());
    }
}

#[test]
fn wrong_names_and_options_tell_what_would_be_right() {
    let folder = folder();
    let out = folder.path().join("run");
    let out_text = out.to_string_lossy();
    let cases: [(&[&str], &str); 22] = [
        (&["rsrr"], "did you mean `rsrrr`"),
        (&["rsrrr", "--method", "adam"], "did you mean `adams`"),
        (&["rsrrr", "--method", "rk4", "--rtol", "1e-8"], "--step"),
        (&["rsrrr", "--step", "1e-3"], "rk4"),
        (&["rsrrr", "--iterations", "3"], "newmark"),
        (&["rsrrr", "--rtol", "0.1"], "too loose"),
        (&["rsrrr", "--atol", "10"], "too loose"),
        (&["rsup", "--clearance", "planar", "--rtol", "1e-5"], "give at most"),
        (&["rsrrr", "--every", "1e-12"], "--every"),
        (&["rsrrr", "--friction", "--friction-scale", "1e300"], "1000"),
        (&["rsrrr", "--clearance", "planar"], "scenes that have it: rsup"),
        (&["rsrrr", "--flexible", "2"], "scenes that have it: rsup"),
        (&["rsrrr", "--as-published"], "scenes that have it: rsup"),
        (&["rsup", "--friction-scale", "2"], "scenes that have it: rsrrr"),
        (&["rsup", "--bristle", "cap"], "add `--clearance planar`"),
        (&["rsup", "--clearance-size", "1e-4"], "add `--clearance planar`"),
        (&["rsup", "--clearance", "round"], "planar"),
        (
            &["rsup", "--clearance", "planar", "--clearance-size", "0"],
            "greater than zero",
        ),
        (
            &["rsup", "--clearance", "planar", "--clearance-size=-1e-3"],
            "greater than zero",
        ),
        (
            &["rsup", "--clearance", "planar", "--bristle", "brush"],
            "elasto-plastic",
        ),
        (
            &["rsup", "--method", "adams", "--as-published"],
            "leave one of them out",
        ),
        (&["rsup", "--flexible", "0"], "1..=500"),
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

/// Runs RSUP with options; tells the folder's header and rows of `states.csv`, and what was printed.
fn rsup(options: &[&str], out: &std::path::Path) -> (Vec<String>, Vec<Vec<f64>>, String) {
    let out_text = out.to_string_lossy();
    let words: Vec<&str> = ["run", "rsup", "--out", &out_text]
        .into_iter()
        .chain(options.iter().copied())
        .collect();
    let run = linkdyn(&words);
    assert_eq!(code(&run), 0, "{words:?}: {}", String::from_utf8_lossy(&run.stderr));
    let states = text(&out.join("states.csv"));
    let mut lines = states.lines();
    let head = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let rows = lines.map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect());
    let rows: Vec<Vec<f64>> = rows.collect();
    (head, rows, String::from_utf8_lossy(&run.stdout).into_owned())
}

/// The columns of RSUP in the order of the format.
fn columns(multipliers: &[&str], contacts: &[&str], bristles: &[&str]) -> Vec<String> {
    let coordinates = ["psi11", "psi12", "theta12", "phi12", "z21", "psi22"];
    let of = |kind: &str| coordinates.map(|name| format!("{kind}.{name}"));
    let mut all = vec!["t".to_owned()];
    all.extend(["q", "v", "a"].iter().flat_map(|kind| of(kind)));
    all.extend(multipliers.iter().map(|component| format!("lambda.R.{component}")));
    for contact in contacts {
        let columns = ["depth", "rate", "normal", "tangent", "bristle", "impact_speed"];
        let columns = columns.iter().chain(bristles);
        all.extend(columns.map(|column| format!("contact.{contact}.{column}")));
    }
    all.extend(["kinetic", "potential", "elastic", "work"].map(|name| format!("energy.{name}")));
    all.extend(["position", "velocity"].map(|name| format!("violation.{name}")));
    all
}

#[test]
fn rsup_writes_the_columns_of_each_of_its_joints() {
    let folder = folder();
    let short = ["--until", "0.06", "--every", "0.0001", "--rtol", "1e-7"];
    let with = |more: &[&'static str]| [&short[..], more].concat();

    let (head, rows, said) = rsup(&short, &folder.path().join("ideal"));
    assert_eq!(head, columns(&["fx", "fy", "fz", "n1", "n2"], &[], &[]));
    assert_eq!(rows.len(), 601);
    assert!(!said.contains("contact") && !folder.path().join("ideal/events.csv").exists());

    let (head, rows, said) = rsup(&with(&["--clearance", "planar"]), &folder.path().join("planar"));
    assert_eq!(head, columns(&["f1", "n1", "n2"], &["R"], &[]));
    let place = |name: &str| head.iter().position(|column| column == name).expect(name);
    let (depth, normal, speed) = (
        place("contact.R.depth"),
        place("contact.R.normal"),
        place("contact.R.impact_speed"),
    );
    assert!(rows.iter().any(|row| row[normal] > 0.0));
    for row in &rows {
        assert!(row[normal] >= 0.0 && row.iter().all(|x| x.is_finite()));
        assert_eq!(row[depth] > 0.0, row[speed] > 0.0, "t = {}", row[0]);
    }
    assert!(
        said.contains("impacts in R") && said.contains("greatest penetration in R"),
        "{said}"
    );
    assert!(!said.contains("contacts held"), "{said}");

    let (head, ..) = rsup(&with(&["--clearance", "spatial"]), &folder.path().join("spatial"));
    let axial = ["tangent_axial", "bristle_axial"];
    assert_eq!(head, columns(&["f1"], &["R1", "R2"], &axial));

    let (head, ..) = rsup(&with(&["--flexible", "2"]), &folder.path().join("flexible"));
    for name in ["q.psi12.1", "v.theta12.2", "a.phi12.2"] {
        assert!(head.iter().any(|column| column == name), "{name}");
    }
    assert!(!head.iter().any(|column| column == "q.psi12.3"));
}

#[test]
fn events_are_written_in_the_order_of_time() {
    let folder = folder();
    let out = folder.path().join("run");
    rsup(
        &[
            "--clearance",
            "planar",
            "--until",
            "2.02",
            "--every",
            "0.1",
            "--rtol",
            "1e-7",
        ],
        &out,
    );
    let events = text(&out.join("events.csv"));
    let mut lines = events.lines();
    assert_eq!(lines.next(), Some("t,kind,name,speed"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let time = |row: &[&str]| -> f64 { row[0].parse().expect("a time") };
    assert!(rows.windows(2).all(|pair| time(&pair[0]) <= time(&pair[1])));
    let stops: Vec<_> = rows.iter().filter(|row| row[1] == "stop").collect();
    assert_eq!(stops.len(), 1);
    assert_eq!((time(stops[0]), stops[0][2], stops[0][3]), (2.0, "drive", ""));
    let contacts: Vec<_> = rows.iter().filter(|row| row[1] != "stop").collect();
    assert!(contacts.len() > 10);
    for (k, row) in contacts.iter().enumerate() {
        assert_eq!((row[1], row[2]), (["contact_made", "contact_lost"][k % 2], "R"));
        assert!(row[3].parse::<f64>().expect("a speed") > 0.0);
    }
}

#[test]
fn the_published_way_runs_and_says_how() {
    let folder = folder();
    let out = folder.path().join("run");
    let options = [
        "--as-published",
        "--clearance",
        "planar",
        "--until",
        "0.03",
        "--every",
        "0.0001",
    ];
    let (head, rows, _) = rsup(&options, &out);
    let manifest: serde_json::Value = serde_json::from_str(&text(&out.join("run.json"))).expect("JSON");
    let plan = &manifest["integration"];
    assert_eq!(plan["method"], "rk4");
    assert_eq!(plan["step"], 5e-6);
    assert_eq!(plan["switching"], "at_steps");
    assert_eq!(manifest["scene"]["linkage"]["baumgarte"]["alpha"], 100.0);
    assert_eq!(
        manifest["counters"]["evaluations"].as_u64().map(|n| n / 4 / 1000),
        Some(6)
    );
    let normal = head
        .iter()
        .position(|column| column == "contact.R.normal")
        .expect("a column");
    assert!(rows.iter().any(|row| row[normal] > 0.0));
    let events = text(&out.join("events.csv"));
    // Contacts are made at the ends of steps.
    for line in events.lines().skip(1) {
        let t: f64 = line.split(',').next().expect("t").parse().expect("a time");
        assert!((t / 5e-6 - (t / 5e-6).round()).abs() < 1e-6, "{t}");
    }
    assert!(events.lines().count() > 1);
}

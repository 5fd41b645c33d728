//! Pictures of linkages, and the scenes that the program carries as files.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use linkdyn_mechanisms::file::EXAMPLES;

const PICTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/linkages");

fn linkdyn(words: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_linkdyn"));
    program.args(words).output().expect("the program starts")
}

fn said(run: &Output) -> String {
    String::from_utf8_lossy(&run.stdout).into_owned() + &String::from_utf8_lossy(&run.stderr)
}

fn drawn(words: &[&str], out: &Path) -> String {
    let run = linkdyn(&[&["draw", "--out", &out.display().to_string()], words].concat());
    assert_eq!(run.status.code(), Some(0), "{words:?}: {}", said(&run));
    fs::read_to_string(out).expect("a picture")
}

/// The text without its numbers, and these.
fn parts(svg: &str) -> (String, Vec<f64>) {
    let (mut rest, mut numbers, mut number) = (String::new(), Vec::new(), String::new());
    for c in svg.chars().chain([' ']) {
        if c.is_ascii_digit() || (c == '.' && !number.is_empty()) || (c == '-' && number.is_empty()) {
            number.push(c);
        } else {
            match number.parse() {
                Ok(value) => numbers.push(value),
                Err(_) => rest.push_str(&number),
            }
            number.clear();
            rest.push(c);
        }
    }
    (rest, numbers)
}

#[test]
fn pictures_of_the_examples_are_those_that_the_program_draws() {
    let files = fs::read_dir(PICTURES).expect("pictures");
    let there: BTreeSet<String> = files
        .map(|file| file.expect("a picture").file_name().to_string_lossy().into_owned())
        .collect();
    let names = EXAMPLES.iter().map(|(name, _)| format!("{name}.svg"));
    assert_eq!(there, names.collect());
    let folder = tempfile::tempdir().expect("a folder");
    for (name, _) in EXAMPLES {
        let drawn = drawn(&[name], &folder.path().join("picture.svg"));
        let kept = fs::read_to_string(Path::new(PICTURES).join(format!("{name}.svg"))).expect("text");
        let ((text, numbers), (kept_text, kept)) = (parts(&drawn), parts(&kept));
        assert_eq!(
            text, kept_text,
            "`linkdyn draw {name} --out docs/linkages/{name}.svg` draws it anew"
        );
        // Last digits of coordinates are those of the machine's sines and cosines.
        assert_eq!(numbers.len(), kept.len(), "{name}");
        for (number, kept) in numbers.iter().zip(kept) {
            assert!((number - kept).abs() < 0.25, "{name}: {number} for {kept}");
        }
    }
}

#[test]
fn pictures_name_what_they_show() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("picture.svg");
    let picture = drawn(&["rsup", "--clearance", "planar"], &out);
    for title in ["J21 (prismatic)", "R (revolute, planar clearance)", "S (spherical zyx)"] {
        assert!(picture.contains(title), "{title}: {picture}");
    }
    assert!(picture.contains("R (clearance)"), "{picture}");
    assert!(!drawn(&["rsup"], &out).contains("clearance"));
    // Six legs, each of two rods, and nothing of the free joint that says where the platform is.
    let picture = drawn(&["stewart_platform"], &out);
    for kind in ["base", "leg", "ball"] {
        for k in 1..=6 {
            assert!(picture.contains(&format!("{kind}{k} (")), "{kind}{k}");
        }
    }
    assert!(!picture.contains("(free)"));
}

#[test]
fn a_png_has_twice_the_pixels() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("picture.png");
    let run = linkdyn(&["draw", "four_bar", "--out", &out.display().to_string()]);
    assert_eq!(run.status.code(), Some(0), "{}", said(&run));
    let bytes = fs::read(&out).expect("a picture");
    let number = |at: usize| {
        bytes[at..at + 4]
            .iter()
            .fold(0, |sum, byte| 256 * sum + u32::from(*byte))
    };
    assert!(bytes.starts_with(b"\x89PNG"));
    assert_eq!((number(16), number(20)), (840, 600));
}

#[test]
fn what_cannot_be_drawn_is_told_and_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    fs::write(path("broken.toml"), "format = 1\n[links.rod]\nmas = 1\n").expect("written");
    let cases = [
        (["rssr", &path("picture.jpg")], "ends in .svg or .png"),
        (["rssr", &path("picture")], "ends in .svg or .png"),
        (["rssr", &path("none/picture.svg")], "in a folder that is there"),
        (["rssrr", &path("picture.svg")], "did you mean `rssr`?"),
        ([&path("none.toml"), &path("picture.svg")], "cannot read"),
        ([&path("broken.toml"), &path("picture.svg")], "line 3, column 1"),
    ];
    for ([scene, out], expected) in cases {
        let run = linkdyn(&["draw", scene, "--out", out]);
        assert_eq!(run.status.code(), Some(2), "{scene} {out}: {}", said(&run));
        assert!(said(&run).contains(expected), "{scene} {out}: {}", said(&run));
        assert!(!Path::new(out).exists(), "{out}");
    }
}

#[test]
fn examples_are_listed_run_by_name_and_written_as_files() {
    let listed = said(&linkdyn(&["scenes"]));
    for (name, _) in EXAMPLES {
        let lines = listed.lines().filter(|line| line.split(' ').next() == Some(name));
        assert_eq!(lines.count(), 1, "{name}: {listed}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let run = |scene: &str, out: &str| {
        let run = linkdyn(&["run", scene, "--until", "0.1", "--every", "0.05", "--out", &path(out)]);
        assert_eq!(run.status.code(), Some(0), "{}", said(&run));
        fs::read_to_string(folder.path().join(out).join("states.csv")).expect("rows")
    };
    let new = linkdyn(&["new", &path("mine.toml"), "--from", "rssr"]);
    assert_eq!(new.status.code(), Some(0), "{}", said(&new));
    // Its own file to the last bit.
    assert_eq!(run("rssr", "one"), run(&path("mine.toml"), "two"));

    let unknown = linkdyn(&["new", &path("other.toml"), "--from", "rsssr"]);
    assert_eq!(unknown.status.code(), Some(2), "{}", said(&unknown));
    assert!(said(&unknown).contains("did you mean `rssr`?"), "{}", said(&unknown));
    let friction = linkdyn(&["run", "rssr", "--friction", "--out", &path("out")]);
    assert_eq!(friction.status.code(), Some(2), "{}", said(&friction));
    assert!(
        said(&friction).contains("linkdyn new mine.toml --from rssr"),
        "{}",
        said(&friction)
    );
}

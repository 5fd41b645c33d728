//! Broken scene files: all that is wrong is told at once, with place and word, and none is too broken to be refused.

use linkdyn_mechanisms::file;
use std::fs;
use std::path::Path;

const RSRRR: &str = include_str!("../../crates/mechanisms/scenes/rsrrr.toml");

/// The files of a folder of the project, by name.
pub(crate) fn files(folder: &str) -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files: Vec<_> = fs::read_dir(&folder)
        .expect("there is such a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .map(|path| (path.display().to_string(), fs::read_to_string(&path).expect("a text")))
        .collect();
    files.sort();
    files
}

/// The example scenes.
pub(crate) fn scenes() -> Vec<(String, String)> {
    files("../crates/mechanisms/scenes")
}

/// All faults of a text.
fn faults(text: &str) -> Vec<String> {
    let error = file::scene("file", text).expect_err("broken");
    error.0.iter().map(ToString::to_string).collect()
}

/// Line from 1 on which a text first occurs.
fn line(text: &str, needle: &str) -> usize {
    let before = text.split(needle).next().expect("there is always a first part");
    assert!(before.len() < text.len(), "{needle}");
    before.matches('\n').count() + 1
}

/// Breaks a text in several places and expects one fault for each, at its line and with its words, and no other.
fn assert_told(text: &str, breaks: &[(&str, &str, &str)]) {
    let mut broken = text.to_owned();
    for (sound, wrong, _) in breaks {
        assert!(broken.contains(sound), "{sound}");
        broken = broken.replacen(sound, wrong, 1);
    }
    let found = faults(&broken);
    for (_, wrong, words) in breaks {
        let line = format!("line {}, ", line(&broken, wrong));
        let told = found
            .iter()
            .any(|fault| fault.starts_with(&line) && fault.contains(words));
        assert!(told, "`{words}` on {line}: {found:#?}");
    }
    assert_eq!(found.len(), breaks.len(), "{found:#?}");
}

#[test]
fn faults_of_shape_names_and_values_are_told_at_once() {
    assert_told(
        RSRRR,
        &[
            (
                "summary =",
                "sumary =",
                "`sumary`: there is no key `sumary`; did you mean `summary`?",
            ),
            (
                "diameter = 0.028, along = [0, 0, 0.2]",
                "diameter = \"thick\", along = [0, 0, 0.2]",
                "`links.2,1.cylinder.diameter`: must be a number, not a text",
            ),
            (
                "kind = \"revolute\"\ncoordinates = [\"psi21\"]",
                "kind = \"revolut\"\ncoordinates = [\"psi21\"]",
                "`joints.J21.kind`: there is no word `revolut`; did you mean `revolute`?",
            ),
            (
                "rise_time = 2",
                "rise_time = -2",
                "`joints.J11.drives[0].ramp.rise_time`: rise_time = -2 must be a finite positive number",
            ),
            ("link = \"2,2\" }", "link = \"2,2x\" }", "did you mean `2,2`?"),
            ("held = [\"psi11\"]", "held = [\"psi1\"]", "did you mean `psi11`?"),
            (
                "until = 5",
                "until = nan",
                "`run.until`: NaN s must be a finite positive number",
            ),
            (
                "reactions = true",
                "reactions = 1",
                "must be true or false, not a whole number",
            ),
        ],
    );
}
#[test]
fn the_corpus_is_refused_as_each_file_expects() {
    let corpus = files("corpus");
    assert!(corpus.len() >= 90);
    for (name, text) in corpus {
        let expected: Vec<_> = text
            .lines()
            .map_while(|line| line.strip_prefix("# expects: "))
            .collect();
        let found = faults(&text);
        assert_eq!(found.len(), expected.len(), "{name}: {found:#?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!(found.starts_with(expected), "{name}: {found}");
        }
    }
}

#[test]
fn the_example_scenes_can_start() {
    let scenes = scenes();
    assert!(scenes.len() >= 10);
    for (name, text) in scenes {
        let scene = file::scene("file", &text).unwrap_or_else(|error| panic!("{name}: {error}"));
        let mechanism = scene.linkage.build().expect("what is read can be built");
        mechanism
            .assemble(&scene.start)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

#[test]
fn faults_of_what_sits_in_joints_are_told_although_the_joint_cannot_be_read() {
    assert_told(
        RSRRR,
        &[
            (
                "[joints.J11]\nkind = \"revolute\"",
                "[joints.J11]",
                "`joints.J11.kind`: is missing",
            ),
            (
                "reference_speed = 9",
                "reference_speed = 0",
                "`joints.J11.drives[1].resistance.reference_speed`: reference_speed = 0",
            ),
            (
                "link = \"1,1\" }\ndrives",
                "link = \"1.1\" }\ndrives",
                "there is no link `1.1`; did you mean `1,1`?",
            ),
            (
                "psi23 = 0.505",
                "psi24 = 0.505",
                "there is no coordinate `psi24`; did you mean `psi23`?",
            ),
        ],
    );
}

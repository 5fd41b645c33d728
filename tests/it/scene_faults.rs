//! Broken scene files: all that is wrong is told at once, with place and word, and none is too broken to be refused.

use linkdyn_mechanisms::file;
use std::fs;
use std::path::Path;

const RSRRR: &str = include_str!("../../crates/mechanisms/scenes/rsrrr.toml");

/// The files of a folder of the project, by name.
fn files(folder: &str) -> Vec<(String, String)> {
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
fn scenes() -> Vec<(String, String)> {
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
                "`joints.J11.drives[0]`: rise_time = -2 must be a finite positive number",
            ),
            ("link = \"2,2\" }", "link = \"2,2x\" }", "did you mean `2,2`?"),
            ("held = [\"psi11\"]", "held = [\"psi1\"]", "did you mean `psi11`?"),
            ("until = 5", "until = nan", "`run.until`: NaN s must be"),
            (
                "reactions = true",
                "reactions = 1",
                "must be true or false, not a whole number",
            ),
        ],
    );
}
/// A generator of its own (Knuth's constants), so that the same thousand files are tried everywhere.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n.max(1)
    }
}

/// What a file may be broken with, in place of a word or a number.
const WORDS: [&str; 17] = [
    "nan",
    "inf",
    "-1",
    "0",
    "3",
    "1e308",
    "1e-300",
    "\"ground\"",
    "\"30 deg\"",
    "[]",
    "{}",
    "=",
    "\"",
    "true",
    "kind",
    "cut = true",
    "é",
];

/// Breaks a text in one of several ways: words, lines, numbers, keys.
fn broken(text: &str, dice: &mut Dice) -> String {
    let ways = dice.below(8);
    let by_lines = ways >= 6;
    let mut parts: Vec<String> = if by_lines {
        text.split_inclusive('\n').map(str::to_owned).collect()
    } else {
        text.split_inclusive([' ', '\n']).map(str::to_owned).collect()
    };
    let (at, other) = (dice.below(parts.len()), dice.below(parts.len()));
    let chosen = |fits: fn(&String) -> bool, dice: &mut Dice| {
        let fitting: Vec<usize> = (0..parts.len()).filter(|&k| fits(&parts[k])).collect();
        fitting.get(dice.below(fitting.len())).copied().unwrap_or(at)
    };
    match ways {
        0 | 6 => drop(parts.remove(at)),
        1 => parts[at] = WORDS[dice.below(WORDS.len())].to_owned() + " ",
        2 | 7 => parts.swap(at, other),
        3 => parts.insert(at, parts[other].clone()),
        4 => {
            let number = chosen(|part| part.starts_with(|c: char| c.is_ascii_digit()), dice);
            let rest = parts[number]
                .trim_start_matches(|c: char| c.is_ascii_digit() || c == '.')
                .to_owned();
            parts[number] = WORDS[dice.below(WORDS.len())].to_owned() + &rest;
        }
        _ => {
            let key = chosen(|part| part.starts_with(|c: char| c.is_ascii_lowercase()), dice);
            let letters = parts[key].chars().count();
            let lost = dice.below(letters);
            parts[key] = parts[key]
                .chars()
                .enumerate()
                .filter(|(k, _)| *k != lost)
                .map(|(_, c)| c)
                .collect();
        }
    }
    parts.concat()
}

#[test]
fn a_thousand_broken_files_are_refused_or_read_and_never_panic() {
    let mut dice = Dice(1);
    let scenes = scenes();
    let mut refused = 0;
    for k in 0..1000 {
        let mut text = scenes[k % scenes.len()].1.clone();
        for _ in 0..=dice.below(3) {
            text = broken(&text, &mut dice);
        }
        match file::scene("file", &text) {
            Ok(scene) => {
                let mechanism = scene.linkage.build().expect("what is read can be built");
                // May close or not, but must end.
                let _ = mechanism.assemble(&scene.start);
            }
            Err(error) => {
                refused += 1;
                assert!(!error.0.is_empty(), "{text}");
                for fault in &error.0 {
                    assert!(fault.place.0 <= text.matches('\n').count() + 1, "{fault}");
                    // What the shape lets pass can be read: these are said where it cannot.
                    let unread = [
                        "missing field",
                        "invalid type",
                        "invalid length",
                        "unknown field",
                        "unknown variant",
                    ];
                    assert!(
                        !unread.iter().any(|words| fault.message.contains(words)),
                        "{fault}\n{text}"
                    );
                }
            }
        }
    }
    assert!(refused > 500, "only {refused} were broken");
}

#[test]
fn the_corpus_is_refused_as_each_file_expects() {
    let corpus = files("corpus");
    assert!(corpus.len() >= 70);
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
                "kind = \"revolute\"\ncoordinates = [\"psi11\"]",
                "coordinates = [\"psi11\"]",
                "`joints.J11.kind`: is missing",
            ),
            (
                "reference_speed = 9",
                "reference_speed = 0",
                "`joints.J11.drives[1]`: reference_speed = 0",
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

//! Broken scene files: all that is wrong is told at once, with place and word, and none is too broken to be refused.

use linkdyn_mechanisms::file;

const FOUR_BAR: &str = include_str!("../../crates/mechanisms/scenes/four_bar.toml");
const RSRRR: &str = include_str!("../../crates/mechanisms/scenes/rsrrr.toml");
const RSRRR_FRICTION: &str = include_str!("../../crates/mechanisms/scenes/rsrrr_friction.toml");
const SLIDER_CRANK: &str = include_str!("../../crates/mechanisms/scenes/slider_crank.toml");
const RSSR: &str = include_str!("../../crates/mechanisms/scenes/rssr.toml");

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

#[test]
fn a_thousand_broken_files_are_refused_or_read_and_never_panic() {
    let mut dice = Dice(1);
    let words = [
        "nan",
        "inf",
        "-1",
        "0",
        "1e308",
        "\"ground\"",
        "[]",
        "{}",
        "=",
        "\"",
        "true",
        "kind",
        "cut = true",
        "\n",
        "é",
    ];
    let mut refused = 0;
    for k in 0..1000 {
        let source = [FOUR_BAR, RSRRR, RSRRR_FRICTION, SLIDER_CRANK, RSSR][k % 5];
        let mut tokens: Vec<&str> = source.split_inclusive([' ', '\n']).collect();
        for _ in 0..=dice.below(3) {
            let (at, other) = (dice.below(tokens.len()), dice.below(tokens.len()));
            match dice.below(4) {
                0 => drop(tokens.remove(at)),
                1 => tokens[at] = words[dice.below(words.len())],
                2 => tokens.swap(at, other),
                _ => tokens.insert(at, tokens[other]),
            }
        }
        match file::scene("file", &tokens.concat()) {
            Ok(scene) => {
                let mechanism = scene.linkage.build().expect("what is read can be built");
                // May close or not, but must end.
                let _ = mechanism.assemble(&scene.start);
            }
            Err(error) => {
                refused += 1;
                assert!(!error.0.is_empty() && error.0.iter().all(|fault| fault.place.0 > 0));
            }
        }
    }
    assert!(refused > 500, "only {refused} were broken");
}

//! A thousand broken scene files and more, made from all the examples: each is refused with its faults or is a linkage that can be
//! built, drawn, closed, counted and evaluated; no panic, no hang, and no success that is not a number.

use crate::scene_faults::scenes;
use linkdyn_mechanisms::analysis::mobility;
use linkdyn_mechanisms::{Observation, Simulation, file};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// How many broken files must be refused, and how many texts are tried at most to get them.
const BROKEN: usize = 1000;
const TRIED: usize = 3000;
/// What counts as a hang. The whole takes a few seconds on a machine that has nothing else to do.
const HANG: Duration = Duration::from_secs(60);

/// A generator of its own (Knuth's constants), so that the same files are tried everywhere.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n.max(1)
    }

    fn one_of<'a, T>(&mut self, list: &'a [T]) -> Option<&'a T> {
        list.get(self.below(list.len()))
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

/// What a number may become without the file being broken for it: sound text, odd mechanics.
const NUMBERS: [&str; 8] = ["0", "1", "-1", "1e-12", "1e12", "1e-300", "1e300", "0.5"];

/// Lines that fit where a joint's table stands.
const LINES: [&str; 8] = [
    "cut = true\n",
    "cut = false\n",
    "springs = [{ stiffness = 1e9, rest = 3 }]\n",
    "drives = [{ constant = { torque = 1e9 } }]\n",
    "prescribed = { polynomial = { coefficients = [0, 1] } }\n",
    "limit = { lower = -0.1, contact = { kelvin_voigt = { stiffness = 1e6, damping = 1 } } }\n",
    "clearance = { bearing_radius = 0.005, journal_radius = 0.004, contact = { power = { stiffness = 1e9 } } }\n",
    "axis = [1, 1, 0]\n",
];

/// Breaks a text in one of several ways: words, lines, numbers, keys, tables, its end.
fn broken(text: &str, others: &[(String, String)], dice: &mut Dice) -> String {
    let ways = dice.below(13);
    let by_lines = ways >= 6;
    let mut parts: Vec<String> = if by_lines {
        text.split_inclusive('\n').map(str::to_owned).collect()
    } else {
        text.split_inclusive([' ', '\n']).map(str::to_owned).collect()
    };
    if parts.is_empty() {
        return text.to_owned();
    }
    let (at, other) = (dice.below(parts.len()), dice.below(parts.len()));
    let those = |fits: fn(&String) -> bool| -> Vec<usize> { (0..parts.len()).filter(|&k| fits(&parts[k])).collect() };
    let mut chosen = |fits: fn(&String) -> bool| dice.one_of(&those(fits)).copied().unwrap_or(at);
    match ways {
        0 | 6 => drop(parts.remove(at)),
        1 => parts[at] = WORDS[dice.below(WORDS.len())].to_owned() + " ",
        2 | 7 => parts.swap(at, other),
        3 => parts.insert(at, parts[other].clone()),
        4 => {
            let number = chosen(|part| part.starts_with(|c: char| c.is_ascii_digit()));
            let rest = parts[number]
                .trim_start_matches(|c: char| c.is_ascii_digit() || c == '.')
                .to_owned();
            let words = if dice.below(2) == 0 { &WORDS[..] } else { &NUMBERS[..] };
            parts[number] = words[dice.below(words.len())].to_owned() + &rest;
        }
        5 => {
            let key = chosen(|part| part.starts_with(|c: char| c.is_ascii_lowercase()));
            let letters = parts[key].chars().count();
            let lost = dice.below(letters);
            let kept = parts[key].chars().enumerate().filter(|(k, _)| *k != lost);
            parts[key] = kept.map(|(_, letter)| letter).collect();
        }
        // A line of another scene.
        8 => {
            let lines: Vec<&str> = dice
                .one_of(others)
                .map_or("", |(_, text)| text)
                .split_inclusive('\n')
                .collect();
            let line = dice.one_of(&lines).copied().unwrap_or_default();
            parts.insert(at, line.to_owned());
        }
        // Something that could stand in a joint, behind its kind.
        9 | 10 => {
            let kind = chosen(|line| line.starts_with("kind"));
            parts.insert(kind + 1, LINES[dice.below(LINES.len())].to_owned());
        }
        // A joint or link called otherwise.
        11 => {
            let table = chosen(|line| line.starts_with('['));
            parts[table] = parts[table].replace(']', "x]");
        }
        _ => parts.truncate(at),
    }
    parts.concat()
}

/// Whether a text was refused; what is wrong with what became of it.
fn tried(text: &str) -> Result<bool, String> {
    let scene = match file::scene("file", text) {
        Ok(scene) => scene,
        Err(error) => {
            if error.0.is_empty() {
                return Err("refused without a fault".into());
            }
            for fault in &error.0 {
                // What the shape lets pass can be read: these are said where it cannot.
                let unread = [
                    "missing field",
                    "invalid type",
                    "invalid length",
                    "unknown field",
                    "unknown variant",
                ];
                let lines = text.matches('\n').count() + 1;
                if fault.place.0 > lines || unread.iter().any(|words| fault.message.contains(words)) {
                    return Err(fault.to_string());
                }
            }
            return Ok(true);
        }
    };
    let mechanism = scene.linkage.build().map_err(|error| format!("not built: {error}"))?;
    if !scene.linkage.outline().starts_with("ground\n") {
        return Err("no outline".into());
    }
    // May close or not, but must end, and with numbers.
    let Ok((start, _)) = mechanism.assemble(&scene.start) else {
        return Ok(false);
    };
    let mut simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&start);
    let mut seen = Observation::default();
    let observed = simulation.observe(0.0, &y, &mut seen);
    let counted = mobility(&mechanism, &start.q);
    let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite());
    if !finite(&start.q) || !finite(&start.v) || (observed.is_ok() && !finite(&seen.a)) {
        return Err("a start that is no number".into());
    }
    match counted {
        Ok(counted) if counted.finite > counted.freedoms || counted.rank > counted.equations => {
            Err(format!("counted {counted:?}"))
        }
        _ => Ok(false),
    }
}

#[test]
fn a_thousand_broken_files_are_refused_or_read_and_never_panic_or_hang() {
    let (give, take) = mpsc::channel::<String>();
    let (answer, answers) = mpsc::channel();
    // Ends with the channel, when all has been tried.
    thread::spawn(move || {
        take.iter()
            .map(|text| tried(&text))
            .try_for_each(|told| answer.send(told))
    });
    let mut dice = Dice(1);
    let scenes = scenes();
    let (mut refused, mut read, mut tries) = (0, 0, 0);
    while refused < BROKEN && tries < TRIED {
        let mut text = scenes[tries % scenes.len()].1.clone();
        for _ in 0..=dice.below(3) {
            text = broken(&text, &scenes, &mut dice);
        }
        give.send(text.clone()).expect("somebody tries");
        match answers.recv_timeout(HANG) {
            Ok(Ok(true)) => refused += 1,
            Ok(Ok(false)) => read += 1,
            Ok(Err(told)) => panic!("{told}\n{text}"),
            Err(mpsc::RecvTimeoutError::Timeout) => panic!("hangs for {HANG:?}\n{text}"),
            Err(mpsc::RecvTimeoutError::Disconnected) => panic!("panics\n{text}"),
        }
        tries += 1;
    }
    assert!(
        refused >= BROKEN && read >= BROKEN / 20,
        "{refused} refused and {read} read of {tries}"
    );
}

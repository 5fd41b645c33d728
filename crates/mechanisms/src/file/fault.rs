//! What is wrong with a scene file, and where.

use std::fmt;
use thiserror::Error;
use toml::de::{DeTable, DeValue};

/// One thing that is wrong with a scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Line and column, both from 1.
    pub place: (usize, usize),
    /// The keys that lead there, like `joints.A.drives[0]`; empty where the text is no TOML.
    pub key: String,
    /// What is wrong and what would be right.
    pub message: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: ", self.place.0, self.place.1)?;
        if !self.key.is_empty() {
            write!(f, "`{}`: ", self.key)?;
        }
        f.write_str(&self.message)
    }
}

/// All that was found to be wrong with a scene file, in the order of the text.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
pub struct SceneFileError(pub Vec<Fault>);

/// The known word that is most like the given one, if one is.
pub(super) fn nearest<'a>(given: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let ranked = known.map(|word| (strsim::jaro_winkler(given, word), word));
    let best = ranked.max_by(|a, b| a.0.total_cmp(&b.0));
    // Below this the words have little in common.
    best.filter(|(likeness, _)| *likeness > 0.7).map(|(_, word)| word)
}

/// That there is no such thing, and the word that was meant or those there are.
pub(super) fn unknown<'a>(
    what: &str,
    given: &str,
    meant: Option<&str>,
    known: impl Iterator<Item = &'a str>,
) -> String {
    let known: Vec<String> = known.map(|word| format!("`{word}`")).collect();
    let hint = match meant {
        Some(word) => format!("did you mean `{word}`?"),
        None if known.is_empty() => "there are none".into(),
        None => format!("there are {}", known.join(", ")),
    };
    format!("there is no {what} `{given}`; {hint}")
}

/// Line and column of a byte of the text, both from 1.
fn place(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count()) + 1;
    (line, column)
}

/// Collects faults with the places of their keys. An entry of a list has its number in square brackets for a key.
pub(super) struct Faults<'a> {
    text: &'a str,
    /// What is read.
    mended: DeValue<'a>,
    left_out: Vec<Vec<String>>,
    found: Vec<Fault>,
}

impl<'a> Faults<'a> {
    pub fn new(text: &'a str) -> Self {
        Self {
            text,
            mended: DeValue::Table(DeTable::new()),
            left_out: Vec::new(),
            found: Vec::new(),
        }
    }

    /// From now on keys are looked up in this table.
    pub fn look_up_in(&mut self, mended: DeTable<'a>) {
        self.mended = DeValue::Table(mended);
    }

    /// A fault at a byte of the text.
    pub fn at(&mut self, byte: usize, keys: &[&str], message: impl Into<String>) {
        self.found.push(Fault {
            place: place(self.text, byte),
            key: keys.join(".").replace(".[", "["),
            message: message.into(),
        });
    }

    /// Remembers that what these keys lead to is not read, and that at most something stands in for it.
    pub fn leave_out(&mut self, keys: &[&str]) {
        self.left_out.push(keys.iter().map(ToString::to_string).collect());
    }

    /// Whether what these keys lead to was left out, or something in it.
    pub fn lacks(&self, keys: &[&str]) -> bool {
        let inside = |path: &Vec<String>| path.len() >= keys.len() && path.iter().zip(keys).all(|(a, b)| a == b);
        self.left_out.iter().any(inside)
    }

    /// Whether all that these keys lead to was left out.
    pub fn lacks_all(&self, keys: &[&str]) -> bool {
        self.left_out.iter().any(|path| path == keys)
    }

    /// A fault of the value to which the keys lead, at the last of them that is there; none where something in that value was left
    /// out, which may be all that is wrong with it, or where it belongs to what stands in for something.
    pub fn add(&mut self, keys: &[&str], message: impl Into<String>) {
        let (mut byte, mut value) = (0, Some(&self.mended));
        for &key in keys {
            let next = match value {
                Some(DeValue::Table(table)) => {
                    let entry = table.iter().find(|(name, _)| name.get_ref() == key);
                    entry.map(|(name, value)| (name.span(), value.get_ref()))
                }
                Some(DeValue::Array(list)) => {
                    let entry = key
                        .trim_matches(['[', ']'])
                        .parse()
                        .ok()
                        .and_then(|k: usize| list.get(k));
                    entry.map(|entry| (entry.span(), entry.get_ref()))
                }
                _ => None,
            };
            byte = next.as_ref().map_or(byte, |(span, _)| span.start);
            value = next.map(|(_, value)| value);
        }
        let stands_in = |path: &Vec<String>| path.len() < keys.len() && path.iter().zip(keys).all(|(a, b)| a == b);
        if !self.lacks(keys) && !self.left_out.iter().any(stands_in) {
            self.at(byte, keys, message);
        }
    }

    /// Whether nothing was wrong so far.
    pub fn none(&self) -> bool {
        self.found.is_empty()
    }

    /// All faults in the order of the text.
    pub fn result(mut self) -> SceneFileError {
        self.found.sort_by_key(|fault| fault.place);
        self.found.dedup();
        SceneFileError(self.found)
    }
}

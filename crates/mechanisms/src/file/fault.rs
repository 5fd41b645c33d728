//! What is wrong with a scene file, and where.

use std::fmt;
use thiserror::Error;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// One thing that is wrong with a scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Line and column, both from 1.
    pub place: (usize, usize),
    /// The keys that lead there, like `joints.A.axis`; empty where the text is no TOML or a key is unknown.
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

/// All that was found to be wrong with a scene file.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
pub struct SceneFileError(pub Vec<Fault>);

impl From<Fault> for SceneFileError {
    fn from(fault: Fault) -> Self {
        Self(vec![fault])
    }
}

/// The fault of a text that the parser refuses, with the nearest right word for an unknown one.
pub(super) fn refused(text: &str, error: &toml::de::Error) -> Fault {
    let mut message = error.message().to_owned();
    // Serde says: unknown field `a`, expected one of `b`, `c`.
    let mut words = error.message().split('`').skip(1).step_by(2);
    if let (true, Some(given)) = (error.message().starts_with("unknown "), words.next())
        && let Some(word) = nearest(given, words)
    {
        message = format!("{message}; did you mean `{word}`?");
    }
    Fault {
        place: place(text, error.span().map_or(0, |span| span.start)),
        key: String::new(),
        message,
    }
}

/// The known word that is most like the given one, if one is.
pub(super) fn nearest<'a>(given: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let ranked = known.map(|word| (strsim::jaro_winkler(given, word), word));
    let best = ranked.max_by(|a, b| a.0.total_cmp(&b.0));
    // Below this the words have little in common.
    best.filter(|(likeness, _)| *likeness > 0.7).map(|(_, word)| word)
}

/// Line and column of a byte of the text, both from 1.
fn place(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count()) + 1;
    (line, column)
}

/// Collects faults with the places of their keys.
pub(super) struct Faults<'a> {
    text: &'a str,
    table: Option<Spanned<DeTable<'a>>>,
    pub found: Vec<Fault>,
}

impl<'a> Faults<'a> {
    pub fn new(text: &'a str) -> Self {
        Self {
            text,
            table: DeTable::parse(text).ok(),
            found: Vec::new(),
        }
    }

    /// A fault at the value to which the keys lead, or at the last of them that is there.
    pub fn add(&mut self, keys: &[&str], message: impl Into<String>) {
        let mut byte = 0;
        let mut table = self.table.as_ref().map(Spanned::get_ref);
        for key in keys {
            let Some((name, value)) = table.and_then(|table| table.iter().find(|(name, _)| name.get_ref() == key))
            else {
                break;
            };
            byte = name.span().start;
            table = match value.get_ref() {
                DeValue::Table(inner) => Some(inner),
                _ => None,
            };
        }
        self.found.push(Fault {
            place: place(self.text, byte),
            key: keys.join("."),
            message: message.into(),
        });
    }
}

//! Whether a parsed text has the shape that the format's JSON Schema describes: its keys, types and words. All that has not is told at
//! once, and the rest is left to be read.

use super::fault::{Faults, nearest, unknown};
use super::quantity::Quantity;
use serde_json::Value as Json;
use std::borrow::Cow;
use std::mem::take;
use toml::Spanned;
use toml::de::{DeArray, DeString, DeTable, DeValue};

/// Mends a table until it has the shape: words that are nearly right are taken for those, so that what they say is judged too; keys
/// without meaning go; something stands in for what is missing or of the wrong kind. [`Faults::lacks`] knows the last two.
pub(super) fn mend(schema: &Json, table: &mut DeTable<'_>, faults: &mut Faults<'_>) {
    Shape { schema, faults }.object(schema, table, 0, &[]);
}

/// Makes the descriptions of a schema, which are those of Rust's documentation, readable in editors: plain brackets, no breaks of
/// lines but between paragraphs, and a description of a kind of table at the key that chooses it.
pub(super) fn describe(schema: &mut Json) {
    match schema {
        Json::Object(entries) => {
            if let Some(Json::String(text)) = entries.get_mut("description") {
                let plain = text.replace("\\[", "[").replace("\\]", "]");
                // Paragraphs in one line, but for those with formulas.
                *text = if plain.contains("```") {
                    plain
                } else {
                    plain.replace("\n\n", "\r").replace('\n', " ").replace('\r', "\n\n")
                };
            }
            let text = entries.get("description").cloned();
            let properties = entries.get_mut("properties").and_then(Json::as_object_mut);
            let chosen = properties.filter(|chosen| chosen.len() == 1);
            for value in chosen.into_iter().flat_map(|chosen| chosen.values_mut()) {
                if let (Some(text), Some(value)) = (&text, value.as_object_mut()) {
                    value.entry("description").or_insert(text.clone());
                }
            }
            entries.values_mut().for_each(describe);
        }
        Json::Array(list) => list.iter_mut().for_each(describe),
        _ => {}
    }
}

struct Shape<'s, 'f, 'a> {
    schema: &'s Json,
    faults: &'f mut Faults<'a>,
}

impl<'s> Shape<'s, '_, '_> {
    /// The schemas any of which a value may have: references followed, the absence of a value left out.
    fn choices(&self, schema: &'s Json) -> Vec<&'s Json> {
        if let Some(reference) = schema["$ref"].as_str() {
            let target = reference.strip_prefix('#').and_then(|path| self.schema.pointer(path));
            return target.map_or(Vec::new(), |target| self.choices(target));
        }
        let list = schema["anyOf"].as_array().or(schema["oneOf"].as_array());
        match list {
            Some(list) => list.iter().flat_map(|choice| self.choices(choice)).collect(),
            None if schema["type"] == "null" => Vec::new(),
            None => vec![schema],
        }
    }

    /// Mends a value; its faults are at the byte `at`.
    fn value<'a>(&mut self, schema: &'s Json, value: &mut DeValue<'a>, at: usize, keys: &[&str]) {
        if let Err(message) = self.try_value(schema, value, at, keys) {
            self.faults.at(at, keys, message);
            self.faults.leave_out(keys);
            *value = self.stand_in(schema);
        }
    }

    /// The error says why nothing in the value can be kept.
    fn try_value(&mut self, schema: &'s Json, value: &mut DeValue<'_>, at: usize, keys: &[&str]) -> Result<(), String> {
        let choices = self.choices(schema);
        let of_type = |name: &str| -> Vec<&'s Json> {
            let fitting = choices.iter().filter(|choice| types(choice).any(|known| known == name));
            fitting.copied().collect()
        };
        let (integers, numbers) = (of_type("integer"), of_type("number"));
        match value {
            DeValue::Table(table) => match of_type("object").as_slice() {
                [] => {}
                [one] => {
                    self.object(one, table, at, keys);
                    return Ok(());
                }
                several => return self.one_of(several, table, at, keys),
            },
            DeValue::Array(list) => {
                if let Some(choice) = of_type("array").first() {
                    return self.list(choice, list, keys);
                }
            }
            DeValue::String(text) => {
                let texts = of_type("string");
                if !texts.is_empty() {
                    return self.text(&texts, text, at, keys);
                }
            }
            DeValue::Integer(number) if !(integers.is_empty() && numbers.is_empty()) => {
                let value = i64::from_str_radix(number.as_str(), number.radix()).ok();
                let bound = |name: &str| integers.first().and_then(|choice| choice[name].as_i64());
                let range = bound("minimum").unwrap_or(i64::MIN)..=bound("maximum").unwrap_or(i64::MAX);
                return match value {
                    Some(value) if range.contains(&value) => Ok(()),
                    Some(_) if bound("maximum").is_none() => {
                        Err(format!("{number} must be at least {}", range.start()))
                    }
                    Some(_) => Err(format!(
                        "{number} must lie between {} and {}",
                        range.start(),
                        range.end()
                    )),
                    None => Err(format!("{number} has too many digits for a whole number")),
                };
            }
            DeValue::Float(number) if !numbers.is_empty() => {
                let text = number.as_str();
                let value: f64 = text.parse().unwrap_or(f64::INFINITY);
                if value.is_finite() || value.is_nan() || text.contains("inf") {
                    return Ok(());
                }
                return Err(format!("{text} is larger than all numbers"));
            }
            DeValue::Boolean(_) if !of_type("boolean").is_empty() => return Ok(()),
            _ => {}
        }
        let mut wanted: Vec<&str> = choices.iter().flat_map(|choice| types(choice)).map(in_words).collect();
        wanted.dedup();
        Err(format!(
            "must be {}, not {}",
            wanted.join(" or "),
            in_words(value.type_str())
        ))
    }

    /// A table with known keys, or with any names and values of one kind.
    fn object(&mut self, schema: &'s Json, table: &mut DeTable<'_>, at: usize, keys: &[&str]) {
        let properties = schema["properties"].as_object();
        let entries = Some(&schema["additionalProperties"]).filter(|entry| entry.is_object());
        let find = |name: &str| properties.and_then(|known| known.get(name)).or(entries);
        let given: Vec<String> = table.keys().map(|key| key.get_ref().to_string()).collect();
        let words = properties.into_iter().flatten().map(|(word, _)| word.as_str());
        let mut free: Vec<&str> = words
            .clone()
            .filter(|word| !given.iter().any(|given| given == word))
            .collect();
        for (mut key, mut value) in take(table) {
            let (name, at) = (key.get_ref().to_string(), key.span().start);
            let keys = [keys, &[name.as_str()]].concat();
            let mut schema = find(&name);
            if schema.is_none() {
                let meant = nearest(&name, free.iter().copied());
                self.faults.at(at, &keys, unknown("key", &name, meant, words.clone()));
                if let Some(word) = meant {
                    free.retain(|free| *free != word);
                    schema = find(word);
                    *key.get_mut() = Cow::Owned(word.to_owned());
                }
            }
            match schema {
                Some(schema) => {
                    self.value(schema, value.get_mut(), at, &keys);
                    table.insert(key, value);
                }
                None => self.faults.leave_out(&keys),
            }
        }
        for key in required(schema).filter(|key| free.contains(key)) {
            let keys = [keys, &[key]].concat();
            self.faults.at(at, &keys, "is missing");
            self.faults.leave_out(&keys);
            let value = self.stand_in(&schema["properties"][key]);
            table.insert(
                Spanned::new(at..at, Cow::Owned(key.to_owned())),
                Spanned::new(at..at, value),
            );
        }
    }

    /// A table whose one key says which of several kinds of table its value is.
    fn one_of(
        &mut self,
        choices: &[&'s Json],
        table: &mut DeTable<'_>,
        at: usize,
        keys: &[&str],
    ) -> Result<(), String> {
        let words = choices.iter().flat_map(|choice| required(choice));
        let key = table.keys().next().filter(|_| table.len() == 1);
        let Some(key) = key.map(|key| key.get_ref().to_string()) else {
            let words: Vec<String> = words.map(|word| format!("`{word}`")).collect();
            return Err(format!("must have one key of {}", words.join(", ")));
        };
        let word = words.clone().find(|word| *word == key).or(nearest(&key, words.clone()));
        let choice = choices
            .iter()
            .find(|choice| word.is_some() && required(choice).next() == word);
        let choice = choice.ok_or_else(|| unknown("key", &key, None, words))?;
        self.object(choice, table, at, keys);
        Ok(())
    }

    fn list(&mut self, schema: &'s Json, list: &mut DeArray<'_>, keys: &[&str]) -> Result<(), String> {
        let size = schema["minItems"].as_u64().filter(|size| schema["maxItems"] == *size);
        if let Some(size) = size.filter(|size| *size != list.len() as u64) {
            return Err(format!("must have {size} entries, not {}", list.len()));
        }
        for (number, entry) in list.iter_mut().enumerate() {
            let (at, name) = (entry.span().start, format!("[{number}]"));
            self.value(&schema["items"], entry.get_mut(), at, &[keys, &[&name]].concat());
        }
        Ok(())
    }

    /// A text, free or one of some words.
    fn text(&mut self, choices: &[&'s Json], text: &mut DeString<'_>, at: usize, keys: &[&str]) -> Result<(), String> {
        let words = choices.iter().flat_map(|choice| words(choice));
        if words.clone().next().is_none() {
            // The one kind of text that must have a form.
            let formed = choices.iter().any(|choice| choice.get("pattern").is_some());
            if !formed || Quantity::degrees(text).is_some() {
                return Ok(());
            }
            return Err(format!("must be a number or degrees like \"30 deg\", not \"{text}\""));
        }
        if words.clone().any(|word| word == text) {
            return Ok(());
        }
        let meant = nearest(text, words.clone());
        let message = unknown("word", text, meant, words);
        let meant = meant.ok_or_else(|| message.clone())?;
        self.faults.at(at, keys, message);
        *text = Cow::Owned(meant.to_owned());
        Ok(())
    }

    /// Some value that can be read.
    fn stand_in<'a>(&self, schema: &'s Json) -> DeValue<'a> {
        let choices = self.choices(schema);
        let Some(schema) = choices.first() else {
            return DeValue::Table(DeTable::new());
        };
        let spanned = |value| Spanned::new(0..0, value);
        match types(schema).next() {
            Some("object") => {
                let entry = |key: &str| {
                    let value = self.stand_in(&schema["properties"][key]);
                    (Spanned::new(0..0, Cow::Owned(key.to_owned())), spanned(value))
                };
                DeValue::Table(required(schema).map(entry).collect())
            }
            Some("array") => {
                let size = schema["minItems"].as_u64().unwrap_or(0);
                DeValue::Array((0..size).map(|_| spanned(self.stand_in(&schema["items"]))).collect())
            }
            Some("string") => DeValue::String(words(schema).next().unwrap_or_default().to_owned().into()),
            Some("boolean") => DeValue::Boolean(false),
            // Within all bounds there are.
            _ => DeValue::parse("1").map_or(DeValue::Boolean(false), Spanned::into_inner),
        }
    }
}

/// The words that a text may be.
fn words(schema: &Json) -> impl Iterator<Item = &str> + Clone {
    let several = schema["enum"].as_array().into_iter().flatten();
    several.chain(schema.get("const")).filter_map(Json::as_str)
}

fn required(schema: &Json) -> impl Iterator<Item = &str> + Clone {
    schema["required"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Json::as_str)
}

/// Types of a schema's values, without the absence of a value.
fn types(schema: &Json) -> impl Iterator<Item = &str> {
    let several = schema["type"].as_array().into_iter().flatten();
    let one = several.chain(Some(&schema["type"])).filter_map(Json::as_str);
    one.filter(|name| *name != "null")
}

/// Types of JSON Schema and of TOML as one says them.
fn in_words(kind: &str) -> &str {
    match kind {
        "object" | "table" => "a table",
        "array" => "a list",
        "string" => "a text",
        "number" | "float" => "a number",
        "integer" => "a whole number",
        "boolean" => "true or false",
        _ => "a date",
    }
}

//! Whether a parsed text has the shape that the format's JSON Schema describes: its keys, types and words. All that has not is told at
//! once, and the rest is left to be read.

use super::fault::{Faults, nearest, unknown};
use super::quantity::Quantity;
use serde_json::Value as Json;
use std::borrow::Cow;
use std::mem::{replace, take};
use toml::Spanned;
use toml::de::{DeArray, DeInteger, DeString, DeTable, DeValue};

/// Takes out of `table` what has no meaning, and mends words that are nearly right, so that what they say is judged too. Required keys
/// at the top are filled in, for the rest to be read without them.
pub(super) fn mend(schema: &Json, table: &mut DeTable<'_>, faults: &mut Faults<'_>) {
    Shape { schema, faults }.object(schema, table, 0, &[]);
    for key in required(schema) {
        let value = match schema["properties"][key]["type"].as_str() {
            Some("integer") => DeValue::Integer(DeInteger::default()),
            _ => DeValue::Table(DeTable::new()),
        };
        let key = Spanned::new(0..0, DeString::Owned(key.to_owned()));
        table.entry(key).or_insert(Spanned::new(0..0, value));
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

    fn refuse(&mut self, at: usize, keys: &[&str], message: impl Into<String>) -> bool {
        self.faults.at(at, keys, message);
        self.faults.leave_out(keys);
        false
    }

    /// Whether a value, as far as it is mended, can be read. Its faults are at the byte `at`.
    fn value(&mut self, schema: &'s Json, value: &mut DeValue<'_>, at: usize, keys: &[&str]) -> bool {
        let choices = self.choices(schema);
        let of_type = |name: &str| -> Vec<&'s Json> {
            let fitting = choices.iter().filter(|choice| types(choice).any(|known| known == name));
            fitting.copied().collect()
        };
        let (integers, numbers) = (of_type("integer"), of_type("number"));
        match value {
            DeValue::Table(table) => match of_type("object").as_slice() {
                [] => {}
                [one] => return self.object(one, table, at, keys),
                several => return self.one_of(several, table, at, keys),
            },
            DeValue::Array(list) => {
                if let Some(choice) = of_type("array").first() {
                    return self.list(choice, list, at, keys);
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
                if value.is_some_and(|value| range.contains(&value)) {
                    return true;
                }
                let message = format!("{number} must lie between {} and {}", range.start(), range.end());
                return self.refuse(at, keys, message);
            }
            DeValue::Float(number) if !numbers.is_empty() => {
                let text = number.as_str();
                let value: f64 = text.parse().unwrap_or(f64::INFINITY);
                if value.is_finite() || value.is_nan() || text.contains("inf") {
                    return true;
                }
                return self.refuse(at, keys, format!("{text} is larger than all numbers"));
            }
            DeValue::Boolean(_) if !of_type("boolean").is_empty() => return true,
            _ => {}
        }
        let mut wanted: Vec<&str> = choices.iter().flat_map(|choice| types(choice)).map(in_words).collect();
        wanted.dedup();
        let message = format!("must be {}, not {}", wanted.join(" or "), in_words(value.type_str()));
        self.refuse(at, keys, message)
    }

    /// A table with known keys, or with any names and values of one kind.
    fn object(&mut self, schema: &'s Json, table: &mut DeTable<'_>, at: usize, keys: &[&str]) -> bool {
        let properties = schema["properties"].as_object();
        let entries = Some(&schema["additionalProperties"]).filter(|entry| entry.is_object());
        let find = |name: &str| properties.and_then(|known| known.get(name)).or(entries);
        let given: Vec<String> = table.keys().map(|key| key.get_ref().to_string()).collect();
        let words = properties.into_iter().flatten().map(|(word, _)| word.as_str());
        let free = words.filter(|word| !given.iter().any(|given| given == word));
        let mut mended = Vec::new();
        let mut kept = DeTable::new();
        for (mut key, mut value) in take(table) {
            let (name, at) = (key.get_ref().to_string(), key.span().start);
            let keys = [keys, &[name.as_str()]].concat();
            let mut schema = find(&name);
            if schema.is_none() {
                self.faults.at(at, &keys, unknown("key", &name, free.clone()));
                // Taken for the word that it is nearly, once.
                if let Some(word) = nearest(&name, free.clone()).filter(|word| !mended.contains(word)) {
                    mended.push(word);
                    schema = find(word);
                    *key.get_mut() = Cow::Owned(word.to_owned());
                }
            }
            match schema {
                Some(schema) if self.value(schema, value.get_mut(), at, &keys) => {
                    kept.insert(key, value);
                }
                _ => self.faults.leave_out(&keys),
            }
        }
        *table = kept;
        let mut whole = true;
        for key in required(schema) {
            if !given.iter().any(|given| given == key) && !mended.contains(&key) {
                self.refuse(at, &[keys, &[key]].concat(), "is missing");
            }
            whole &= table.keys().any(|there| there.get_ref() == key);
        }
        whole
    }

    /// A table whose one key says which of several kinds of table its value is.
    fn one_of(&mut self, choices: &[&'s Json], table: &mut DeTable<'_>, at: usize, keys: &[&str]) -> bool {
        let words = choices.iter().flat_map(|choice| required(choice));
        let key = table.keys().next().filter(|_| table.len() == 1);
        let Some((at_key, key)) = key.map(|key| (key.span().start, key.get_ref().to_string())) else {
            let words: Vec<String> = words.map(|word| format!("`{word}`")).collect();
            return self.refuse(at, keys, format!("must have one key of {}", words.join(", ")));
        };
        let word = words.clone().find(|word| *word == key).or(nearest(&key, words.clone()));
        match choices.iter().find(|choice| required(choice).next() == word) {
            Some(choice) if word.is_some() => self.object(choice, table, at, keys),
            _ => self.refuse(at_key, &[keys, &[&key]].concat(), unknown("key", &key, words)),
        }
    }

    fn list(&mut self, schema: &'s Json, list: &mut DeArray<'_>, at: usize, keys: &[&str]) -> bool {
        let size = schema["minItems"].as_u64().filter(|size| schema["maxItems"] == *size);
        if let Some(size) = size.filter(|size| *size != list.len() as u64) {
            return self.refuse(at, keys, format!("must have {size} entries, not {}", list.len()));
        }
        let all = list.len();
        let mut number = 0;
        *list = replace(list, DeArray::new())
            .into_iter()
            .filter_map(|mut entry| {
                let name = format!("[{number}]");
                number += 1;
                let (at, keys) = (entry.span().start, [keys, &[name.as_str()]].concat());
                let sound = self.value(&schema["items"], entry.get_mut(), at, &keys);
                if !sound {
                    self.faults.leave_out(&keys);
                }
                sound.then_some(entry)
            })
            .collect();
        size.is_none() || list.len() == all
    }

    /// A text, free or one of some words.
    fn text(&mut self, choices: &[&'s Json], text: &mut DeString<'_>, at: usize, keys: &[&str]) -> bool {
        let words = choices.iter().flat_map(|choice| {
            let several = choice["enum"].as_array().into_iter().flatten();
            several.chain(choice.get("const")).filter_map(Json::as_str)
        });
        if words.clone().next().is_none() {
            // The one kind of text that must have a form.
            let formed = choices.iter().any(|choice| choice.get("pattern").is_some());
            if !formed || Quantity::degrees(text).is_some() {
                return true;
            }
            let message = format!("must be a number or degrees like \"30 deg\", not \"{text}\"");
            return self.refuse(at, keys, message);
        }
        if words.clone().any(|word| word == text) {
            return true;
        }
        let message = unknown("word", text, words.clone());
        if let Some(word) = nearest(text, words) {
            self.faults.at(at, keys, message);
            *text = Cow::Owned(word.to_owned());
            return true;
        }
        self.refuse(at, keys, message)
    }
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

//! The format of scene files by its JSON Schema: every key is described, occurs in a sound file, and is refused with a value of the wrong kind.

use crate::scene_faults::scenes;
use crate::scene_keys::{BEAM, BODIES, LOADS, REST, SITTING, faults, read};
use linkdyn_mechanisms::file;
use serde_json::Value;
use std::collections::BTreeSet;

/// A key of the format.
struct Property<'s> {
    /// The definition that has it, and its name.
    name: String,
    key: &'s str,
    schema: &'s Value,
    /// Whether it must be there.
    required: bool,
}

/// All keys of the format.
fn properties(schema: &Value) -> Vec<Property<'_>> {
    fn walk<'s>(definition: &str, schema: &'s Value, found: &mut Vec<Property<'s>>) {
        let required = schema["required"].as_array();
        for (key, property) in schema["properties"].as_object().into_iter().flatten() {
            let name = format!("{definition}.{key}");
            walk(&name, property, found);
            found.push(Property {
                name,
                key,
                schema: property,
                required: required.is_some_and(|list| list.iter().any(|required| required == key)),
            });
        }
        for list in ["oneOf", "anyOf"] {
            for choice in schema[list].as_array().into_iter().flatten() {
                walk(definition, choice, found);
            }
        }
    }
    let mut found = Vec::new();
    walk("", schema, &mut found);
    for (name, definition) in schema["$defs"].as_object().into_iter().flatten() {
        walk(name, definition, &mut found);
    }
    found
}

#[test]
fn every_key_is_described_with_unit_and_default() {
    let schema = file::schema();
    let all = properties(&schema);
    assert!(all.len() > 150, "{}", all.len());
    let mut wrong = Vec::new();
    for Property {
        name,
        key,
        schema,
        required,
    } in all
    {
        let text = schema["description"].as_str().unwrap_or_default().to_lowercase();
        if text.len() < 9 || text.contains('\\') {
            wrong.push(format!("{name} has no description: {text}"));
        }
        let kind = schema.to_string();
        let number = schema["properties"].is_null() && (kind.contains("\"number\"") || kind.contains("Quantity"));
        // Only directions are of any unit.
        if number && !["axis", "second_axis", "direction", "rotation"].contains(&key) && !text.contains('[') {
            wrong.push(format!("{name} has no unit: {text}"));
        }
        let default = ["unless given", "by default", "in place of", "where"];
        if !required && !default.iter().any(|words| text.contains(words)) {
            wrong.push(format!("{name} has no default: {text}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_key_occurs_in_a_sound_file() {
    let schema = file::schema();
    let mut texts: Vec<String> = scenes().into_iter().map(|(_, text)| text).collect();
    texts.extend([&[BODIES, LOADS].concat(), SITTING, BEAM, REST].map(str::to_owned));
    for text in &texts {
        let mechanism = read(text).linkage.build().expect("what is read can be built");
        assert!(mechanism.coordinate_names().count() > 0);
    }
    let words: BTreeSet<&str> = texts
        .iter()
        .flat_map(|text| text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')))
        .collect();
    for Property { name, key, .. } in properties(&schema) {
        assert!(words.contains(key), "no file has {name}");
    }
}

/// Walks through all that a file may hold by its schema, with a value at each place that none may have.
struct Refusals<'s> {
    schema: &'s Value,
    /// How many places there were.
    places: usize,
}

impl<'s> Refusals<'s> {
    /// The schemas any of which a value may have, without that of its absence.
    fn choices(&self, schema: &'s Value) -> Vec<&'s Value> {
        if let Some(path) = schema["$ref"].as_str() {
            let target = self.schema.pointer(path.trim_start_matches('#')).expect("a definition");
            return self.choices(target);
        }
        match schema["anyOf"].as_array().or(schema["oneOf"].as_array()) {
            Some(list) => list.iter().flat_map(|choice| self.choices(choice)).collect(),
            None => vec![schema],
        }
    }

    /// The places at and below `path`; `around` makes a file of what stands there.
    fn at(&mut self, schema: &'s Value, path: &str, around: &dyn Fn(&str) -> String) {
        if !path.is_empty() {
            self.places += 1;
            let text = around("1979-05-27");
            let words = format!("`{path}`: must be ");
            let found = faults(&text);
            let told = found
                .iter()
                .any(|fault| fault.contains(&words) && fault.ends_with("not a date"));
            assert!(told, "{text}: {found:#?}");
        }
        for choice in self.choices(schema) {
            let mut below = |name: &str, entry: &'s Value| {
                let inner = format!("{path}{}{name}", if path.is_empty() { "" } else { "." });
                let within = |value: &str| match path {
                    "" => format!("{name} = {value}"),
                    _ => around(&format!("{{ {name} = {value} }}")),
                };
                self.at(entry, &inner, &within);
            };
            for (name, entry) in choice["properties"].as_object().into_iter().flatten() {
                below(name, entry);
            }
            if choice["additionalProperties"].is_object() {
                below("any", &choice["additionalProperties"]);
            }
            if choice["type"] == "array" && choice["minItems"].is_null() {
                self.at(&choice["items"], &format!("{path}[0]"), &|value| {
                    around(&format!("[{value}]"))
                });
            }
        }
    }
}

#[test]
fn every_key_is_refused_where_its_value_is_of_the_wrong_kind() {
    let schema = file::schema();
    let mut refusals = Refusals {
        schema: &schema,
        places: 0,
    };
    refusals.at(&schema, "", &str::to_owned);
    assert!(refusals.places > 250, "{}", refusals.places);
}

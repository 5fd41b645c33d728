//! Numbers that may be angles in degrees.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
use std::borrow::Cow;
use std::fmt;

/// A number in SI units; an angle may also be a text like `"30 deg"`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quantity(pub f64);

impl Quantity {
    /// From degrees with their unit.
    pub(super) fn degrees(text: &str) -> Option<Self> {
        let number = text.strip_suffix("deg")?.trim().parse::<f64>().ok()?;
        Some(Self(number.to_radians()))
    }
}

impl<'de> Deserialize<'de> for Quantity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

struct Reader;

impl Visitor<'_> for Reader {
    type Value = Quantity;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or degrees as in \"30 deg\"")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Quantity, E> {
        Ok(Quantity(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Quantity, E> {
        Ok(Quantity(value as f64))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Quantity, E> {
        Quantity::degrees(text).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }
}

impl JsonSchema for Quantity {
    fn schema_name() -> Cow<'static, str> {
        "Quantity".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number in SI units; an angle may also be a text like \"30 deg\".",
            "anyOf": [{ "type": "number" }, { "type": "string", "pattern": "^[-+]?[0-9.]+(e[-+]?[0-9]+)? *deg$" }],
        })
    }
}

//! Tables with units for the terminal, and the same as JSON.
//!
//! ```
//! use linkdyn_cli::summary::{Cell, Table};
//!
//! let mut table = Table::new("speeds", &[("joint", ""), ("mean", "rad/s"), ("largest", "rad/s")]);
//! table.row([Cell::text("J11"), Cell::number(8.76), Cell::number(10.25)]);
//! assert_eq!(table.to_text().lines().next(), Some("joint  mean (rad/s)  largest (rad/s)"));
//! assert_eq!(table.to_json()["rows"][0]["mean"], 8.76);
//! ```

use comfy_table::{CellAlignment, ContentArrangement, Table as Layout};
use serde_json::{Map, Value, json};

/// Significant digits of numbers on the terminal; JSON has all of them.
const DIGITS: usize = 6;

/// A table: named columns with units, and rows.
#[derive(Clone, Debug)]
pub struct Table {
    name: String,
    columns: Vec<(String, String)>,
    rows: Vec<Vec<Cell>>,
}

/// What stands in one place of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A number.
    Number(f64),
    /// A count.
    Count(u64),
    /// A word.
    Text(String),
    /// Nothing.
    Empty,
}

impl Cell {
    /// A number.
    #[must_use]
    pub const fn number(value: f64) -> Self {
        Self::Number(value)
    }

    /// A count.
    #[must_use]
    pub const fn count(value: u64) -> Self {
        Self::Count(value)
    }

    /// A word.
    pub fn text(value: impl Into<String>) -> Self {
        Self::Text(value.into())
    }

    fn shown(&self) -> String {
        match self {
            Self::Number(x) => shown(*x),
            Self::Count(n) => grouped(*n),
            Self::Text(text) => text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect(),
            Self::Empty => String::new(),
        }
    }

    fn json(&self) -> Value {
        match self {
            // JSON has no NaN and no infinity; a word is more honest than `null`.
            Self::Number(x) if !x.is_finite() => json!(x.to_string()),
            Self::Number(x) => json!(x),
            Self::Count(n) => json!(n),
            Self::Text(text) => json!(text),
            Self::Empty => Value::Null,
        }
    }
}

impl Table {
    /// A table without rows. Each column has a name and a unit, which may be empty.
    pub fn new(name: impl Into<String>, columns: &[(&str, &str)]) -> Self {
        let columns = columns
            .iter()
            .map(|(name, unit)| ((*name).to_owned(), (*unit).to_owned()))
            .collect();
        Self {
            name: name.into(),
            columns,
            rows: Vec::new(),
        }
    }

    /// A table of two columns, `quantity` and `value`, in which every row may have another unit.
    pub fn list(name: impl Into<String>) -> Self {
        Self::new(name, &[("quantity", ""), ("value", ""), ("unit", "")])
    }

    /// Appends a row. Missing cells at its end are empty, and cells beyond the last column are left out.
    pub fn row(&mut self, cells: impl IntoIterator<Item = Cell>) -> &mut Self {
        let mut cells: Vec<Cell> = cells.into_iter().take(self.columns.len()).collect();
        cells.resize(self.columns.len(), Cell::Empty);
        self.rows.push(cells);
        self
    }

    /// Appends a quantity with its unit to a table made by [`Table::list`].
    pub fn entry(&mut self, quantity: &str, value: Cell, unit: &str) -> &mut Self {
        self.row([Cell::text(quantity), value, Cell::text(unit)])
    }

    /// Names of the columns with their units.
    pub fn heads(&self) -> impl Iterator<Item = String> {
        self.columns.iter().map(|(name, unit)| match unit.as_str() {
            "" => name.clone(),
            unit => format!("{name} ({unit})"),
        })
    }

    /// The rows as a reader sees them.
    pub fn shown(&self) -> impl Iterator<Item = Vec<String>> {
        self.rows.iter().map(|row| row.iter().map(Cell::shown).collect())
    }

    /// The table for a terminal: aligned columns, numbers on the right, no frame and no blanks at the ends of lines.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut layout = Layout::new();
        layout
            .load_style(comfy_table::presets::NOTHING)
            .set_content_arrangement(ContentArrangement::Disabled);
        layout.set_header(self.heads());
        for row in self.shown() {
            layout.add_row(row);
        }
        for (index, column) in layout.column_iter_mut().enumerate() {
            let words = self.rows.iter().any(|row| matches!(row[index], Cell::Text(_)));
            let alone = self
                .rows
                .iter()
                .all(|row| matches!(row[index], Cell::Text(_) | Cell::Empty));
            column.set_cell_alignment(if words && alone {
                CellAlignment::Left
            } else {
                CellAlignment::Right
            });
            column.set_padding((0, 2));
        }
        let mut text = String::new();
        for line in layout.to_string().lines() {
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }

    /// The table as CSV: names of columns with their units, blanks made underscores; numbers with all digits, empty cells empty.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let quoted = |text: &str| match text.contains([',', '"', '\n']) {
            true => format!("\"{}\"", text.replace('"', "\"\"")),
            false => text.to_owned(),
        };
        let head = self.columns.iter().map(|(name, unit)| match unit.as_str() {
            "" => quoted(&name.replace(' ', "_")),
            unit => quoted(&format!("{name} ({unit})").replace(' ', "_")),
        });
        let mut text = head.collect::<Vec<_>>().join(",");
        text.push('\n');
        for row in &self.rows {
            let cells = row.iter().map(|cell| match cell {
                Cell::Number(x) => format!("{x:e}"),
                Cell::Count(n) => n.to_string(),
                Cell::Text(text) => quoted(text),
                Cell::Empty => String::new(),
            });
            text += &cells.collect::<Vec<_>>().join(",");
            text.push('\n');
        }
        text
    }

    /// The table as JSON: its name, the units of its columns, and one object for each row.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let units: Map<String, Value> = self
            .columns
            .iter()
            .filter(|(_, unit)| !unit.is_empty())
            .map(|(name, unit)| (name.clone(), json!(unit)))
            .collect();
        let rows: Vec<Value> = self
            .rows
            .iter()
            .map(|row| {
                let row: Map<String, Value> = self
                    .columns
                    .iter()
                    .zip(row)
                    .map(|((name, _), cell)| (name.clone(), cell.json()))
                    .collect();
                Value::Object(row)
            })
            .collect();
        json!({ "name": self.name, "units": units, "rows": rows })
    }
}

/// A number with six significant digits, without zeros that say nothing.
fn shown(x: f64) -> String {
    if !x.is_finite() {
        return x.to_string();
    }
    if x == 0.0 {
        return "0".to_owned();
    }
    let exponential = format!("{:.*e}", DIGITS - 1, x);
    let (mantissa, exponent) = exponential.split_once('e').unwrap_or((&exponential, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    if (-4..DIGITS as i32).contains(&exponent) {
        let decimals = (DIGITS as i32 - 1 - exponent).max(0) as usize;
        trimmed(&format!("{x:.decimals$}"))
    } else {
        format!("{}e{exponent}", trimmed(mantissa))
    }
}

/// A count with its digits in groups of three.
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) && digits.len() > 4 {
            text.push(' ');
        }
        text.push(c);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_and_have_units() {
        let mut table = Table::new("joints", &[("joint", ""), ("mean", "rad/s"), ("note", "")]);
        table.row([Cell::text("J11"), Cell::number(8.762_345_678), Cell::text("drive")]);
        table.row([Cell::text("spherical"), Cell::number(-0.25)]);
        let expected = "\
joint      mean (rad/s)  note
J11             8.76235  drive
spherical         -0.25
";
        assert_eq!(table.to_text(), expected);
    }

    #[test]
    fn a_list_has_a_unit_in_each_row() {
        let mut list = Table::list("run");
        list.entry("time", Cell::number(0.5), "s")
            .entry("steps", Cell::count(12_345), "")
            .entry("worst", Cell::Empty, "m");
        assert_eq!(
            list.to_text(),
            "quantity   value  unit\ntime         0.5  s\nsteps     12 345\nworst             m\n"
        );
        let json = list.to_json();
        assert_eq!(
            json["rows"][1],
            json!({ "quantity": "steps", "value": 12_345, "unit": "" })
        );
        assert_eq!(json["rows"][2]["value"], Value::Null);
    }

    #[test]
    fn numbers_are_short_and_never_cut_off() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (100_000.0, "100000"),
            (1_234_567.0, "1.23457e6"),
            (0.000_123_456_78, "0.000123457"),
            (1.5e-9, "1.5e-9"),
            (-2.0 / 3.0, "-0.666667"),
            (999_999.9, "1e6"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(shown(x), text);
        }
        assert_eq!(
            [0, 999, 1234, 12_345, 1_234_567].map(grouped),
            ["0", "999", "1234", "12 345", "1 234 567"]
        );
    }

    #[test]
    fn json_keeps_all_digits_and_tells_what_is_not_finite() {
        let mut table = Table::new("x", &[("a", "m")]);
        table.row([Cell::number(0.1 + 0.2)]).row([Cell::number(f64::NAN)]);
        let json = table.to_json();
        assert_eq!(json["rows"][0]["a"], 0.1 + 0.2);
        assert_eq!(json["rows"][1]["a"], "NaN");
        assert_eq!(json["units"]["a"], "m");
    }

    #[test]
    fn csv_has_all_digits_and_quotes_what_needs_it() {
        let mut table = Table::new("x", &[("a step", "s"), ("b", ""), ("c", "")]);
        table.row([Cell::number(0.1 + 0.2), Cell::text("no, \"yes\"")]);
        table.row([Cell::number(f64::NAN), Cell::Empty, Cell::count(12_345)]);
        let expected = "a_step_(s),b,c\n3.0000000000000004e-1,\"no, \"\"yes\"\"\",\nNaN,,12345\n";
        assert_eq!(table.to_csv(), expected);
    }

    #[test]
    fn rows_of_the_wrong_length_and_control_characters_do_no_harm() {
        let mut table = Table::new("x", &[("a", ""), ("b", "")]);
        table
            .row([])
            .row([Cell::text("1\u{1b}[31m\n"), Cell::Empty, Cell::text("beyond")]);
        let text = table.to_text();
        assert_eq!(text.lines().count(), 3);
        assert!(!text.contains('\u{1b}') && !text.contains("beyond"));
        assert_eq!(Table::new("empty", &[("a", "")]).to_text(), "a\n");
    }
}

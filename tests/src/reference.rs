//! Reference solutions made by independent programs; see `tests/reference/README.md`.

/// A table of numbers with named columns.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads comma-separated numbers below one line of names.
    ///
    /// # Panics
    /// If a cell is not a number: the data are part of the tests.
    pub fn parse(text: &str) -> Self {
        let mut lines = text.lines();
        let columns = lines.next().expect("a header").split(',').map(str::to_owned).collect();
        let number = |cell: &str| cell.parse().expect("a number");
        let rows = lines.map(|line| line.split(',').map(number).collect()).collect();
        Self { columns, rows }
    }

    /// Names of the columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// All rows.
    pub fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    /// Index of a column.
    ///
    /// # Panics
    /// If there is none of that name.
    pub fn column(&self, name: &str) -> usize {
        let found = self.columns.iter().position(|column| column == name);
        found.unwrap_or_else(|| panic!("no column {name}"))
    }
}

/// RSRRR with ideal joints, 0 to 5 s, every 0.05 s; certified to 1e-13 in angles, 4e-13 in speeds and energies, 2e-11 in
/// accelerations, 3e-12 in reactions.
pub fn rsrrr_ideal() -> Table {
    Table::parse(include_str!("../reference/rsrrr_ideal.csv"))
}

/// RSRRR with joint friction; certified to 2e-12 in angles, 2e-11 in speeds, 5e-12 in energies, 5e-10 in accelerations, 1e-10
/// in reactions, 2e-12 in friction torques.
pub fn rsrrr_friction() -> Table {
    Table::parse(include_str!("../reference/rsrrr_friction.csv"))
}

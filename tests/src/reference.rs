//! Reference solutions made by independent programs; see `tests/reference/README.md`.

/// A table of numbers with named columns.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads comma-separated numbers below one line of names; words become NaN.
    ///
    /// # Panics
    /// If there is no line at all: the data are part of the tests.
    pub fn parse(text: &str) -> Self {
        let mut lines = text.lines();
        let columns = lines.next().expect("a header").split(',').map(str::to_owned).collect();
        let number = |cell: &str| cell.parse().unwrap_or(f64::NAN);
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

/// RSUP with ideal joints and a rigid coupler, 0 to 5 s, every 0.05 s; certified to 2e-15 in coordinates and speeds, 2e-14 in
/// accelerations and forces.
pub fn rsup_ideal() -> Table {
    Table::parse(include_str!("../reference/rsup_ideal.csv"))
}

/// RSUP with planar clearance and friction; certified to 2e-15 in coordinates, 1e-11 in speeds, 4e-16 m in depth, 2e-8 N in
/// the normal force.
pub fn rsup_planar() -> Table {
    Table::parse(include_str!("../reference/rsup_planar.csv"))
}

/// Contacts made and lost in that run; certified to 5e-14 s and 2e-13 m/s. Kinds and names are words.
pub fn rsup_planar_events() -> Table {
    Table::parse(include_str!("../reference/rsup_planar_events.csv"))
}

/// The same without friction, which is chaotic; the first second and a half is certified.
pub fn rsup_planar_frictionless_events() -> Table {
    Table::parse(include_str!("../reference/rsup_planar_frictionless_events.csv"))
}

/// RSUP with spatial clearance and friction, 0 to 0.5 s; certified to 6e-13 in coordinates, 1e-14 m in depth.
pub fn rsup_spatial() -> Table {
    Table::parse(include_str!("../reference/rsup_spatial.csv"))
}

/// Contacts made and lost in that run; certified to 3e-12 s and 1e-11 m/s.
pub fn rsup_spatial_events() -> Table {
    Table::parse(include_str!("../reference/rsup_spatial_events.csv"))
}

/// RSUP with a flexible coupler of four spring-damping elements; certified to 1e-15 in coordinates until 1 s.
pub fn rsup_flexible() -> Table {
    Table::parse(include_str!("../reference/rsup_flexible.csv"))
}

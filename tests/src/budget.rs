//! What evaluations and steps may cost: a file of instructions and allocations, and the comparison with what was counted.

use std::fmt;

/// Share of its budget by which a count may exceed it or fall short before that is told.
pub const MARGIN: f64 = 0.03;

const COLUMNS: &str = "scene,what,instructions,allocations";

/// One figure of one scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Scene with its variant.
    pub scene: String,
    /// What is counted, such as one evaluation.
    pub what: String,
    /// Instructions of one; `None` where they were not counted.
    pub instructions: Option<u64>,
    /// Allocations of all that were made in the count.
    pub allocations: u64,
}

/// All figures, with what instructions depend on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Version of the compiler, as it tells it.
    pub compiler: String,
    /// Processor, with what mathematical functions choose their code by.
    pub processor: String,
    /// All figures.
    pub rows: Vec<Row>,
}

/// What a comparison found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Comparison {
    /// What must not be.
    pub failures: Vec<String>,
    /// What is worth knowing.
    pub notes: Vec<String>,
}

impl Budget {
    /// Reads a budget as [`Display`](fmt::Display) writes it.
    ///
    /// # Errors
    /// A sentence with the number of the line that cannot be read.
    pub fn parse(text: &str) -> Result<Self, String> {
        let header = |key: &str| {
            let found = text.lines().find_map(|line| line.strip_prefix(key));
            found
                .map(str::to_owned)
                .ok_or(format!("the budget has no line `{key}...`"))
        };
        let (compiler, processor) = (header("# compiler: ")?, header("# processor: ")?);
        let lines = text.lines().enumerate();
        let mut lines = lines.filter(|(_, line)| !line.starts_with('#') && !line.is_empty());
        if lines.next().is_none_or(|(_, line)| line != COLUMNS) {
            return Err(format!("the budget has no line `{COLUMNS}`"));
        }
        let rows =
            lines.map(|(i, line)| Row::parse(line).ok_or(format!("line {}: `{line}` is not `{COLUMNS}`", i + 1)));
        Ok(Self {
            compiler,
            processor,
            rows: rows.collect::<Result<_, _>>()?,
        })
    }

    /// Compares a count with this budget. Instructions are those of the same compiler and processor only, or say nothing.
    #[must_use]
    pub fn compare(&self, counted: &Self) -> Comparison {
        let mut found = Comparison::default();
        let same_code = (&self.compiler, &self.processor) == (&counted.compiler, &counted.processor);
        if counted.rows.iter().all(|row| row.instructions.is_none()) {
            found.notes.push("instructions: not compared (no valgrind)".into());
        } else if !same_code {
            found.notes.push(format!(
                "instructions: not compared (the budget is for {}, {}; this is {}, {})",
                self.compiler, self.processor, counted.compiler, counted.processor
            ));
        }
        for row in &counted.rows {
            let Some(budget) = self.rows.iter().find(|budget| budget.names() == row.names()) else {
                found.failures.push(format!("{row}: the budget has no such figure"));
                continue;
            };
            if row.allocations != budget.allocations {
                let (is, due) = (row.allocations, budget.allocations);
                found
                    .failures
                    .push(format!("{row}: {is} allocations, the budget is {due}"));
            }
            if let (true, Some(is), Some(due)) = (same_code, row.instructions, budget.instructions) {
                let ratio = is as f64 / due as f64;
                let told = format!(
                    "{row}: {is} instructions, {:+.1} %, the budget is {due}",
                    100.0 * (ratio - 1.0)
                );
                // What is not a number is no success.
                if ratio < 1.0 - MARGIN {
                    found.notes.push(format!("{told}; it may be lowered"));
                } else if ratio.is_nan() || ratio > 1.0 + MARGIN {
                    found.failures.push(told);
                }
            }
        }
        for budget in &self.rows {
            if counted.rows.iter().all(|row| row.names() != budget.names()) {
                found.failures.push(format!("{budget}: in the budget, but not counted"));
            }
        }
        found
    }
}

impl Row {
    fn parse(line: &str) -> Option<Self> {
        let cells: Vec<&str> = line.split(',').collect();
        let &[scene, what, instructions, allocations] = &cells[..] else {
            return None;
        };
        Some(Self {
            scene: scene.to_owned(),
            what: what.to_owned(),
            instructions: Some(instructions.parse().ok()?),
            allocations: allocations.parse().ok()?,
        })
    }

    fn names(&self) -> (&str, &str) {
        (&self.scene, &self.what)
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.scene, self.what)
    }
}

impl fmt::Display for Budget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# compiler: {}", self.compiler)?;
        writeln!(f, "# processor: {}", self.processor)?;
        writeln!(f, "{COLUMNS}")?;
        for row in &self.rows {
            let (scene, what) = row.names();
            let instructions = row.instructions.unwrap_or_default();
            writeln!(f, "{scene},{what},{instructions},{}", row.allocations)?;
        }
        Ok(())
    }
}

//! A results folder that is replaced as a whole or not at all.
//!
//! A run writes into a temporary folder beside its target. [`RunFolder::commit`] adds `run.json` and puts the folder in
//! place in one step, so that at any time, also when the process is killed, the target holds the old run or the new one.
//! What a killed run leaves behind is removed by the next run with the same target.
//!
//! ```
//! use linkdyn_cli::results::RunFolder;
//!
//! let place = tempfile::tempdir()?;
//! let mut run = RunFolder::create(&place.path().join("pendulum"))?;
//! let mut states = run.table("states.csv", &["t", "q.psi"])?;
//! states.row(&[0.0, 0.1])?;
//! states.row(&[0.5, -0.3])?;
//! states.finish()?;
//! let folder = run.commit(&serde_json::json!({ "scene": "pendulum" }))?;
//! assert!(folder.join("states.csv").exists());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod folder;
mod swap;
mod table;

use std::io;
use std::path::{Path, PathBuf};

pub use folder::{RunFolder, SCHEMA};
pub use table::{EventWriter, TableWriter};

/// Name of the file that makes a folder a run.
pub const MANIFEST: &str = "run.json";

/// Why results cannot be written. Every message names the file or folder and says what would be right.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ResultsError {
    /// The operating system refused.
    #[error("cannot {action} `{}`", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The target is a file, or has no name of its own (like `/`).
    #[error("`{}` is {what}, but the results need a folder of their own", path.display())]
    NotAFolder {
        /// The target.
        path: PathBuf,
        /// What it is.
        what: &'static str,
    },
    /// The target has contents, and they are not a run of this program.
    #[error("`{}` is not empty and not a run of linkdyn ({reason}), so it is not replaced", path.display())]
    NotARun {
        /// The target.
        path: PathBuf,
        /// Why it does not count as a run.
        reason: String,
    },
    /// The target is a run, but somebody put more into it.
    #[error("`{}` is a run, but also holds `{extra}`, which no run wrote, so it is not replaced", path.display())]
    Foreign {
        /// The target.
        path: PathBuf,
        /// The first file or folder that the run did not write.
        extra: String,
    },
    /// A file of a run needs a plain name, used once, and not that of the manifest.
    #[error("`{name}` cannot be the name of a file in a run: {reason}")]
    FileName {
        /// The name.
        name: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A table without columns, or with a column name that is empty, double or would need quotes.
    #[error("`{}`: column {index} `{name}` {reason}", path.display())]
    Column {
        /// The file.
        path: PathBuf,
        /// Index of the column.
        index: usize,
        /// Name of the column.
        name: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A row has another number of values than the table has columns.
    #[error("`{}`, row {row}: {found} values for {expected} columns", path.display())]
    RowLength {
        /// The file.
        path: PathBuf,
        /// Index of the row, from 0.
        row: u64,
        /// Number of columns.
        expected: usize,
        /// Number of values.
        found: usize,
    },
    /// A value is NaN or infinite.
    #[error("`{}`, row {row}: `{column}` is {value}, which is not a finite number", path.display())]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// Index of the row, from 0.
        row: u64,
        /// Name of the column.
        column: String,
        /// The value.
        value: f64,
    },
    /// A table was not finished before the folder was to be put in place.
    #[error("{count} tables of `{}` are not finished", path.display())]
    Unfinished {
        /// The target.
        path: PathBuf,
        /// Number of tables.
        count: usize,
    },
    /// The manifest is not a JSON object, or cannot be written as JSON.
    #[error("`{}` cannot be described: {reason}", path.display())]
    Manifest {
        /// The target.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

impl ResultsError {
    fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Io {
            action,
            path: path.to_owned(),
            source,
        }
    }

    /// Whether the user gave a wrong folder (and not the system or the program failed).
    #[must_use]
    pub fn is_usage(&self) -> bool {
        matches!(
            self,
            Self::NotAFolder { .. } | Self::NotARun { .. } | Self::Foreign { .. }
        )
    }

    /// What the user may try.
    #[must_use]
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::NotAFolder { .. } | Self::NotARun { .. } => {
                Some("choose a folder that does not exist yet, is empty, or holds an earlier run".to_owned())
            }
            Self::Foreign { extra, .. } => Some(format!("move `{extra}` elsewhere, or choose another folder")),
            Self::Io { source, .. } => match source.kind() {
                io::ErrorKind::PermissionDenied => Some("choose a folder in which you may write".to_owned()),
                io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                    Some("free some space, or write fewer rows (`--every`)".to_owned())
                }
                _ => None,
            },
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;

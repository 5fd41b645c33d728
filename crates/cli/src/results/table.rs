//! Tables of numbers, written row by row.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::ResultsError;

/// Writes a CSV table of numbers with 17 significant digits, which every reader turns back into the same bits.
///
/// Rows go to the file as they come; the table is never in memory.
#[derive(Debug)]
pub struct TableWriter {
    csv: csv::Writer<File>,
    path: PathBuf,
    columns: Vec<String>,
    rows: u64,
    text: String,
    open: Open,
}

/// Counts a table as unfinished until it is closed.
#[derive(Debug)]
pub(super) struct Open(Arc<AtomicUsize>);

impl Open {
    pub(super) fn new(count: &Arc<AtomicUsize>) -> Self {
        count.fetch_add(1, Ordering::SeqCst);
        Self(Arc::clone(count))
    }

    fn close(&self) {
        self.0.fetch_sub(1, Ordering::SeqCst);
    }
}

fn writer(path: &Path) -> Result<csv::Writer<File>, ResultsError> {
    let file = File::create_new(path).map_err(|error| ResultsError::io("create", path, error))?;
    Ok(csv::WriterBuilder::new().buffer_capacity(1 << 16).from_writer(file))
}

fn csv_error(path: &Path) -> impl FnOnce(csv::Error) -> ResultsError + '_ {
    |error| {
        let source = match error.into_kind() {
            csv::ErrorKind::Io(error) => error,
            other => std::io::Error::other(format!("{other:?}")),
        };
        ResultsError::io("write", path, source)
    }
}

/// Writes everything out and asks the disk to keep it.
fn close(mut csv: csv::Writer<File>, path: &Path) -> Result<(), ResultsError> {
    csv.flush().map_err(|error| ResultsError::io("write", path, error))?;
    let file = csv
        .into_inner()
        .map_err(|error| ResultsError::io("write", path, error.into_error()))?;
    file.sync_all().map_err(|error| ResultsError::io("write", path, error))
}

/// The number with 17 significant digits.
fn number(text: &mut String, value: f64) {
    text.clear();
    // Writing to a string cannot fail.
    let _ = write!(text, "{value:.16e}");
}

impl TableWriter {
    pub(super) fn create(path: PathBuf, columns: &[impl AsRef<str>], open: Open) -> Result<Self, ResultsError> {
        let columns: Vec<String> = columns.iter().map(|c| c.as_ref().to_owned()).collect();
        let mut seen = HashSet::new();
        for (index, name) in columns.iter().enumerate() {
            let reason = if name.is_empty() {
                Some("has no name")
            } else if !seen.insert(name) {
                Some("is there twice")
            } else if name
                .chars()
                .any(|c| c.is_control() || c.is_whitespace() || matches!(c, ',' | '"'))
            {
                Some("has a blank, a comma or a quote in its name")
            } else {
                None
            };
            if let Some(reason) = reason {
                open.close();
                return Err(ResultsError::Column {
                    path,
                    index,
                    name: name.clone(),
                    reason,
                });
            }
        }
        if columns.is_empty() {
            open.close();
            return Err(ResultsError::Column {
                path,
                index: 0,
                name: String::new(),
                reason: "is missing: a table needs one",
            });
        }
        let made = writer(&path).and_then(|mut csv| csv.write_record(&columns).map_err(csv_error(&path)).map(|()| csv));
        match made {
            Ok(csv) => Ok(Self {
                csv,
                path,
                columns,
                rows: 0,
                text: String::with_capacity(32),
                open,
            }),
            Err(error) => {
                open.close();
                Err(error)
            }
        }
    }

    /// Appends a row.
    ///
    /// # Errors
    /// If the row has not one value for each column, a value is not finite (the row is not written then), or the file cannot be
    /// written.
    pub fn row(&mut self, values: &[f64]) -> Result<(), ResultsError> {
        let (path, row) = (&self.path, self.rows);
        if values.len() != self.columns.len() {
            let (expected, found) = (self.columns.len(), values.len());
            return Err(ResultsError::RowLength {
                path: path.clone(),
                row,
                expected,
                found,
            });
        }
        if let Some((column, &value)) = self.columns.iter().zip(values).find(|(_, x)| !x.is_finite()) {
            return Err(ResultsError::NotFinite {
                path: path.clone(),
                row,
                column: column.clone(),
                value,
            });
        }
        for value in values {
            number(&mut self.text, *value);
            self.csv.write_field(&self.text).map_err(csv_error(path))?;
        }
        self.csv.write_record(None::<&[u8]>).map_err(csv_error(path))?;
        self.rows += 1;
        Ok(())
    }

    /// Names of the columns.
    #[must_use]
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Writes out what is still in memory, and gives the number of rows.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(self) -> Result<u64, ResultsError> {
        close(self.csv, &self.path)?;
        self.open.close();
        Ok(self.rows)
    }
}

/// Writes the located events of a run (`t, kind, name, speed`). The file is made with the first event.
#[derive(Debug)]
pub struct EventWriter {
    csv: Option<csv::Writer<File>>,
    path: PathBuf,
    rows: u64,
    text: String,
    open: Open,
}

impl EventWriter {
    pub(super) fn new(path: PathBuf, open: Open) -> Self {
        Self {
            csv: None,
            path,
            rows: 0,
            text: String::with_capacity(32),
            open,
        }
    }

    /// Appends an event: its time, its kind (such as `contact made`), the joint or contact, and the speed there, if the
    /// event has one.
    ///
    /// # Errors
    /// If time or speed is not finite (nothing is written then), or the file cannot be written.
    pub fn event(&mut self, t: f64, kind: &str, name: &str, speed: Option<f64>) -> Result<(), ResultsError> {
        let path = &self.path;
        for (column, value) in [("t", Some(t)), ("speed", speed)] {
            if let Some(value) = value.filter(|x| !x.is_finite()) {
                return Err(ResultsError::NotFinite {
                    path: path.clone(),
                    row: self.rows,
                    column: column.to_owned(),
                    value,
                });
            }
        }
        let csv = match &mut self.csv {
            Some(csv) => csv,
            none => {
                let mut csv = writer(path)?;
                csv.write_record(["t", "kind", "name", "speed"])
                    .map_err(csv_error(path))?;
                none.insert(csv)
            }
        };
        number(&mut self.text, t);
        csv.write_field(&self.text).map_err(csv_error(path))?;
        csv.write_field(kind).map_err(csv_error(path))?;
        csv.write_field(name).map_err(csv_error(path))?;
        self.text.clear();
        if let Some(speed) = speed {
            number(&mut self.text, speed);
        }
        csv.write_field(&self.text).map_err(csv_error(path))?;
        csv.write_record(None::<&[u8]>).map_err(csv_error(path))?;
        self.rows += 1;
        Ok(())
    }

    /// Writes out what is still in memory, and gives the number of events.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(self) -> Result<u64, ResultsError> {
        if let Some(csv) = self.csv {
            close(csv, &self.path)?;
        }
        self.open.close();
        Ok(self.rows)
    }
}

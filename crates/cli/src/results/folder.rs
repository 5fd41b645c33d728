//! The folder of a run.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use serde::Serialize;
use serde_json::Value;
use tempfile::TempDir;

use super::table::Open;
use super::{EventWriter, MANIFEST, ResultsError, TableWriter, swap};
use crate::machine::{PROGRAM, Program};

/// Version of the form of a run; `run.json` has it as `schema`.
pub const SCHEMA: u32 = 1;

/// A file in the temporary folder that its process holds locked.
const LOCK: &str = ".lock";

/// The results of one run on their way into a folder. Dropped without [`RunFolder::commit`], it leaves nothing.
#[derive(Debug)]
pub struct RunFolder {
    target: PathBuf,
    temporary: TempDir,
    lock: File,
    files: Vec<String>,
    open: Arc<AtomicUsize>,
}

impl RunFolder {
    /// Begins a run whose results will be in `target`: a folder that does not exist yet (folders above it are made), is
    /// empty, or holds an earlier run and nothing else. Until [`RunFolder::commit`], it stays as it is.
    ///
    /// # Errors
    /// If the target is something else, or the folder beside it cannot be written.
    pub fn create(target: &Path) -> Result<Self, ResultsError> {
        let target = absolute(target)?;
        let (parent, name) = parts(&target)?;
        swap::restore(&target, &aside(&target)).map_err(|error| ResultsError::io("restore", &target, error))?;
        check(&target)?;
        fs::create_dir_all(parent).map_err(|error| ResultsError::io("create", parent, error))?;
        sweep(parent, &name);
        // Another process may take the lock for a moment to see whether the folder is abandoned, and remove it.
        let mut tries = 0;
        loop {
            match temporary(parent, &name) {
                Ok((temporary, lock)) => {
                    return Ok(Self {
                        target,
                        temporary,
                        lock,
                        files: Vec::new(),
                        open: Arc::default(),
                    });
                }
                Err(_) if tries < 3 => tries += 1,
                Err(error) => return Err(ResultsError::io("create a folder in", parent, error)),
            }
        }
    }

    /// The folder in which the results will be.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Begins a table of numbers. It must be finished before the folder is committed.
    ///
    /// # Errors
    /// If the file's or a column's name is impossible, or the file cannot be made.
    pub fn table(&mut self, file: &str, columns: &[impl AsRef<str>]) -> Result<TableWriter, ResultsError> {
        let path = self.path_of(file)?;
        let table = TableWriter::create(path, columns, Open::new(&self.open))?;
        self.files.push(file.to_owned());
        Ok(table)
    }

    /// Begins the table of events. It must be finished before the folder is committed; without events there is no file.
    ///
    /// # Errors
    /// If the file's name is impossible.
    pub fn events(&mut self, file: &str) -> Result<EventWriter, ResultsError> {
        let path = self.path_of(file)?;
        self.files.push(file.to_owned());
        Ok(EventWriter::new(path, Open::new(&self.open)))
    }

    /// Writes a whole file, such as a picture.
    ///
    /// # Errors
    /// If the file's name is impossible, or the file cannot be written.
    pub fn write(&mut self, file: &str, contents: impl AsRef<[u8]>) -> Result<(), ResultsError> {
        let path = self.path_of(file)?;
        fs::write(&path, contents).map_err(|error| ResultsError::io("write", &path, error))?;
        self.files.push(file.to_owned());
        Ok(())
    }

    /// Writes `run.json` and puts the folder in place; gives its path. To what is given (anything that becomes a JSON object)
    /// it adds `schema`, `program` (unless given) and `files`.
    ///
    /// Note that JSON has no NaN and no infinity: such numbers become `null`.
    ///
    /// # Errors
    /// If a table is not finished, the manifest is no JSON object, the target has become something else than a run in the
    /// meantime, or the system refuses. The target then is as it was.
    pub fn commit(self, manifest: &impl Serialize) -> Result<PathBuf, ResultsError> {
        let target = self.target;
        let count = self.open.load(Ordering::SeqCst);
        if count > 0 {
            return Err(ResultsError::Unfinished { path: target, count });
        }
        let refuse = |reason: String| ResultsError::Manifest {
            path: target.clone(),
            reason,
        };
        let mut manifest = match serde_json::to_value(manifest) {
            Ok(Value::Object(map)) => map,
            Ok(_) => return Err(refuse("its description is not a JSON object".to_owned())),
            Err(error) => return Err(refuse(error.to_string())),
        };
        let from = self.temporary.path().to_owned();
        let mut files: Vec<&str> = self
            .files
            .iter()
            .map(String::as_str)
            .filter(|f| from.join(f).exists())
            .collect();
        files.sort();
        manifest.insert("schema".to_owned(), SCHEMA.into());
        manifest.insert("files".to_owned(), files.into());
        if !manifest.contains_key("program") {
            manifest.insert(
                "program".to_owned(),
                serde_json::to_value(Program::this()).map_err(|e| refuse(e.to_string()))?,
            );
        }
        let mut text = serde_json::to_string_pretty(&manifest).map_err(|error| refuse(error.to_string()))?;
        text.push('\n');
        let path = from.join(MANIFEST);
        fs::write(&path, text).map_err(|error| ResultsError::io("write", &path, error))?;
        File::open(&path)
            .and_then(|f| f.sync_all())
            .map_err(|error| ResultsError::io("write", &path, error))?;
        readable_by_all_who_may(&from).map_err(|error| ResultsError::io("open", &from, error))?;

        check(&target)?;
        let placed = if target.exists() {
            swap::exchange(&from, &target, &aside(&target))
        } else {
            fs::rename(&from, &target)
        };
        placed.map_err(|error| ResultsError::io("put the results into", &target, error))?;
        drop(self.lock);
        // The run is in place; a lock file that cannot be removed does no harm.
        let _ = fs::remove_file(target.join(LOCK));
        // If a run was replaced, it now has the temporary name and goes; else there is nothing at that name.
        let _ = self.temporary.close();
        Ok(target)
    }

    /// The path of a new file, if it may have that name.
    fn path_of(&self, file: &str) -> Result<PathBuf, ResultsError> {
        let plain = !file.is_empty()
            && !file.starts_with('.')
            && file
                .chars()
                .all(|c| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_'));
        let reason = if !plain {
            "use letters, digits, `.`, `-` and `_`"
        } else if file == MANIFEST {
            "that file is written when the run is complete"
        } else if self.files.iter().any(|f| f.eq_ignore_ascii_case(file)) {
            "the run has such a file already"
        } else {
            return Ok(self.temporary.path().join(file));
        };
        Err(ResultsError::FileName {
            name: file.to_owned(),
            reason,
        })
    }
}

/// The target with all links resolved, so that a link to a folder stays and its folder is replaced.
fn absolute(target: &Path) -> Result<PathBuf, ResultsError> {
    if target.as_os_str().is_empty() {
        return Err(ResultsError::NotAFolder {
            path: target.to_owned(),
            what: "no name",
        });
    }
    let resolved = match fs::canonicalize(target) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            if target.is_symlink() {
                return Err(ResultsError::NotAFolder {
                    path: target.to_owned(),
                    what: "a link to nothing",
                });
            }
            std::path::absolute(target)
        }
        other => other,
    };
    resolved.map_err(|error| ResultsError::io("find", target, error))
}

fn parts(target: &Path) -> Result<(&Path, String), ResultsError> {
    match (target.parent(), target.file_name()) {
        (Some(parent), Some(name)) => Ok((parent, name.to_string_lossy().into_owned())),
        _ => Err(ResultsError::NotAFolder {
            path: target.to_owned(),
            what: "a path without a name of its own",
        }),
    }
}

/// Where the old run waits if the system cannot exchange two folders in one step.
fn aside(target: &Path) -> PathBuf {
    let name = target
        .file_name()
        .map(|n| n.to_string_lossy().into_owned())
        .unwrap_or_default();
    target.with_file_name(format!(".{name}.{PROGRAM}-old"))
}

fn prefix(name: &str) -> String {
    format!(".{name}.{PROGRAM}-new-")
}

fn temporary(parent: &Path, name: &str) -> io::Result<(TempDir, File)> {
    let folder = tempfile::Builder::new().prefix(&prefix(name)).tempdir_in(parent)?;
    let lock = File::create_new(folder.path().join(LOCK))?;
    lock.try_lock().or_else(|error| match error {
        // File systems without locks work too, only that nothing is swept there.
        TryLockError::Error(error) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        other => Err(io::Error::from(other)),
    })?;
    Ok((folder, lock))
}

/// A temporary folder is made for its owner only; a folder of results is as any other that the user makes.
fn readable_by_all_who_may(folder: &Path) -> io::Result<()> {
    if cfg!(unix) {
        // What the user's mask gives to new folders is seen on a new folder.
        let sample = folder.join(".sample");
        fs::create_dir(&sample)?;
        let permissions = fs::metadata(&sample)?.permissions();
        fs::remove_dir(&sample)?;
        fs::set_permissions(folder, permissions)?;
    }
    Ok(())
}

/// Refuses a target that is neither absent, nor empty, nor a run with nothing added.
fn check(target: &Path) -> Result<(), ResultsError> {
    match fs::metadata(target) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(ResultsError::io("look at", target, error)),
        Ok(found) if !found.is_dir() => {
            return Err(ResultsError::NotAFolder {
                path: target.to_owned(),
                what: "a file",
            });
        }
        Ok(_) => {}
    }
    let unreadable = |error| ResultsError::io("read", target, error);
    let mut entries = Vec::new();
    for entry in fs::read_dir(target).map_err(unreadable)? {
        entries.push(entry.map_err(unreadable)?.file_name().to_string_lossy().into_owned());
    }
    if entries.is_empty() {
        return Ok(());
    }
    entries.sort();
    let refuse = |reason: String| {
        Err(ResultsError::NotARun {
            path: target.to_owned(),
            reason,
        })
    };
    let manifest: Value = match fs::read(target.join(MANIFEST)) {
        Ok(text) => match serde_json::from_slice(&text) {
            Ok(manifest) => manifest,
            Err(error) => return refuse(format!("its {MANIFEST} is not JSON: {error}")),
        },
        Err(error) if error.kind() == io::ErrorKind::NotFound => return refuse(format!("it has no {MANIFEST}")),
        Err(error) => return Err(ResultsError::io("read", &target.join(MANIFEST), error)),
    };
    if manifest["program"]["name"] != PROGRAM {
        return refuse(format!("its {MANIFEST} is of another program"));
    }
    let files: Vec<&str> = manifest["files"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect();
    match entries
        .into_iter()
        .find(|e| e != MANIFEST && e != LOCK && !files.contains(&e.as_str()))
    {
        Some(extra) => Err(ResultsError::Foreign {
            path: target.to_owned(),
            extra,
        }),
        None => Ok(()),
    }
}

/// Removes what killed runs with the same target left. What cannot be removed stays: it is in nobody's way.
fn sweep(parent: &Path, name: &str) {
    let target = parent.join(name);
    let old = aside(&target);
    if target.exists() && old.exists() {
        let _ = fs::remove_dir_all(old);
    }
    let prefix = prefix(name);
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().starts_with(&prefix) && is_abandoned(&entry.path()) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

/// Whether no process works in a temporary folder any more.
fn is_abandoned(folder: &Path) -> bool {
    match File::open(folder.join(LOCK)) {
        Ok(lock) => lock.try_lock().is_ok(),
        // Without a lock it is either just being made, or long forgotten.
        Err(error) if error.kind() == io::ErrorKind::NotFound => fs::metadata(folder)
            .and_then(|m| m.modified())
            .is_ok_and(|at| at.elapsed().is_ok_and(|age| age > Duration::from_secs(60))),
        Err(_) => false,
    }
}

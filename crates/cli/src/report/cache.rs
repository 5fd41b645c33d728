//! References kept on disk, so that a second report of a scene spends its time on the rows.
//!
//! A file is named after scene, variant, times and methods, and begins with all that determines the numbers: the scene as JSON, the
//! two methods with their settings, the rows, and a hash of the program's own file. That hash costs milliseconds, and unlike the
//! version it also changes while the program is being worked on. What another build has left is computed anew and replaced.

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::run::Prepared;
use crate::run::methods::Plan;

use super::measure::Point;

/// The environment variable that names the folder.
const VARIABLE: &str = "LINKDYN_CACHE";

/// The two paths of a reference and what they cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The paths.
    pub paths: [Vec<Point>; 2],
    /// Time of one evaluation \[s\].
    pub evaluation: f64,
    /// Why the integrations ended early, if they did.
    pub failure: Option<String>,
}

/// The form of a pair in a file: numbers by their bits, so that every one comes back as it was.
#[derive(Serialize, Deserialize)]
struct Stored {
    key: String,
    paths: Vec<Vec<[Vec<u64>; 4]>>,
    evaluation: u64,
    failure: Option<String>,
}

/// What a cache says when it is asked.
#[derive(Debug, PartialEq)]
pub enum Found {
    /// The reference.
    Pair(Box<Pair>),
    /// There is none.
    Nothing,
    /// There is a file that cannot be used, and why.
    Unusable(&'static str),
}

/// Where one reference is kept.
pub struct Cache {
    file: PathBuf,
    key: String,
}

/// The folder of all references: `given`, else that of `LINKDYN_CACHE`, else the user's own for caches; `None` if the system names none.
pub fn folder(given: Option<&Path>) -> Option<PathBuf> {
    let named = |name: &str| env::var_os(name).map(PathBuf::from);
    let own = || {
        let base = if cfg!(windows) {
            named("LOCALAPPDATA")
        } else if cfg!(target_os = "macos") {
            named("HOME").map(|home| home.join("Library/Caches"))
        } else {
            // The XDG base directory specification: relative paths do not count.
            let xdg = named("XDG_CACHE_HOME").filter(|path| path.is_absolute());
            xdg.or_else(|| named("HOME").map(|home| home.join(".cache")))
        };
        base.filter(|path| path.is_absolute()).map(|base| base.join("linkdyn"))
    };
    let asked = given
        .map(Path::to_path_buf)
        .or_else(|| named(VARIABLE).filter(|path| !path.as_os_str().is_empty()));
    asked.or_else(own)
}

impl Cache {
    /// The place in `folder` for the reference of a scene by two methods; times of output are until and every \[s\]. `None` where the
    /// program cannot read its own file, so that nothing tells which program a reference is from.
    pub fn new(folder: &Path, ready: &Prepared, plans: &[Plan; 2], times: (f64, f64)) -> Option<Self> {
        let program = hash(&fs::read(env::current_exe().ok()?).ok()?);
        let asked = json!({
            "scene": ready.scene,
            "methods": plans,
            "until": times.0.to_bits(),
            "every": times.1.to_bits(),
        });
        let asked = asked.to_string();
        let name = format!("reference-{}-{:016x}.json", ready.scene.name, hash(asked.as_bytes()));
        let version = env!("CARGO_PKG_VERSION");
        Some(Self {
            file: folder.join(name),
            key: format!("{version} {program:016x} {asked}"),
        })
    }

    /// The file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// What is kept.
    pub fn read(&self) -> Found {
        let Ok(bytes) = fs::read(&self.file) else {
            return if self.file.exists() {
                Found::Unusable("it cannot be read")
            } else {
                Found::Nothing
            };
        };
        let damaged = Found::Unusable("it is damaged");
        let Ok(text) = String::from_utf8(bytes) else {
            return damaged;
        };
        let Some((sum, body)) = text.split_once('\n') else {
            return damaged;
        };
        if sum != format!("{:016x}", hash(body.as_bytes())) {
            return damaged;
        }
        let Ok(stored) = serde_json::from_str::<Stored>(body) else {
            return damaged;
        };
        if stored.key != self.key {
            return Found::Unusable("another build of the program made it");
        }
        let mut paths = stored
            .paths
            .into_iter()
            .map(|path| path.into_iter().map(point).collect::<Option<Vec<_>>>());
        match (paths.next().flatten(), paths.next().flatten()) {
            (Some(first), Some(second)) => Found::Pair(Box::new(Pair {
                paths: [first, second],
                evaluation: f64::from_bits(stored.evaluation),
                failure: stored.failure,
            })),
            _ => damaged,
        }
    }

    /// Keeps a reference; a file that is read at the same time is the old or the new one.
    ///
    /// # Errors
    /// If the folder cannot be written.
    pub fn write(&self, pair: &Pair) -> std::io::Result<()> {
        let parts = |p: &Point| [bits(&[p.t]), bits(&p.q), bits(&p.v), bits(&p.forces)];
        let stored = Stored {
            key: self.key.clone(),
            paths: pair.paths.iter().map(|path| path.iter().map(parts).collect()).collect(),
            evaluation: pair.evaluation.to_bits(),
            failure: pair.failure.clone(),
        };
        let body = serde_json::to_string(&stored)?;
        let folder = self.file.parent().unwrap_or(Path::new("."));
        fs::create_dir_all(folder)?;
        let mut file = tempfile::NamedTempFile::new_in(folder)?;
        write!(file, "{:016x}\n{body}", hash(body.as_bytes()))?;
        file.persist(&self.file)?;
        Ok(())
    }
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|x| x.to_bits()).collect()
}

fn point(parts: [Vec<u64>; 4]) -> Option<Point> {
    let [t, q, v, forces] = parts.map(|part| part.into_iter().map(f64::from_bits).collect::<Vec<_>>());
    match t[..] {
        [t] => Some(Point { t, q, v, forces }),
        _ => None,
    }
}

/// A fingerprint, stable within one build, which is all that files of that build need.
fn hash(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair() -> Pair {
        let odd = vec![0.1 + 0.2, -0.0, f64::MIN_POSITIVE / 3.0, f64::INFINITY, 1e300 / 7.0];
        let point = Point {
            t: 1.0 / 3.0,
            q: odd.clone(),
            v: odd.iter().map(|x| x / 3.0).collect(),
            forces: vec![f64::MAX],
        };
        Pair {
            paths: [vec![point.clone(), Point::default()], vec![point]],
            evaluation: 1e-6 / 3.0,
            failure: Some("jammed".to_owned()),
        }
    }

    fn cache(folder: &Path, key: &str) -> Cache {
        Cache {
            file: folder.join("below").join("x.json"),
            key: key.to_owned(),
        }
    }

    #[test]
    fn every_number_comes_back_as_it_was() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path(), "a");
        assert_eq!(cache.read(), Found::Nothing);
        cache.write(&pair()).expect("writes");
        let Found::Pair(found) = cache.read() else {
            panic!("not found")
        };
        assert_eq!(*found, pair());
        assert!(found.paths[0][0].q[1].is_sign_negative());
    }

    #[test]
    fn damaged_and_foreign_files_are_not_used() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache_a = cache(folder.path(), "a");
        cache_a.write(&pair()).expect("writes");
        let other = cache(folder.path(), "b").read();
        assert_eq!(other, Found::Unusable("another build of the program made it"));
        let good = fs::read(cache_a.file()).expect("reads");
        let mut flipped = good.clone();
        let last = flipped.len() - 40;
        flipped[last] ^= 1;
        for bytes in [&good[..good.len() / 2], &flipped, b"", b"\xff\xfe", b"0\n{}"] {
            fs::write(cache_a.file(), bytes).expect("writes");
            assert_eq!(cache_a.read(), Found::Unusable("it is damaged"));
        }
    }

    #[test]
    fn the_folder_asked_for_comes_first() {
        assert_eq!(folder(Some(Path::new("x"))), Some(PathBuf::from("x")));
    }
}

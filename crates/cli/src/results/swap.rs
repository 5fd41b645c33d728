//! Two folders change places.

use std::io;
use std::path::Path;

/// Puts `new` in the place of the existing `old` in one step; afterwards `new` is the path of what was there before.
///
/// Where the system has no such step (or the file system refuses), `old` goes to `aside` first, and comes back if `new`
/// cannot follow; [`restore`] repairs what a kill between the two leaves.
pub(super) fn exchange(new: &Path, old: &Path, aside: &Path) -> io::Result<()> {
    match in_one_step(new, old) {
        Some(Ok(())) => Ok(()),
        Some(Err(error)) if !unsupported(&error) => Err(error),
        _ => in_two_steps(new, old, aside),
    }
}

/// Brings back a run that was set aside by a process which was killed before it could put the new one in place.
pub(super) fn restore(target: &Path, aside: &Path) -> io::Result<()> {
    if aside.exists() && !target.exists() {
        std::fs::rename(aside, target)
    } else {
        Ok(())
    }
}

#[cfg(any(target_os = "linux", target_vendor = "apple"))]
fn in_one_step(new: &Path, old: &Path) -> Option<io::Result<()>> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Some(renameat_with(CWD, new, CWD, old, RenameFlags::EXCHANGE).map_err(io::Error::from))
}

#[cfg(not(any(target_os = "linux", target_vendor = "apple")))]
fn in_one_step(_new: &Path, _old: &Path) -> Option<io::Result<()>> {
    None
}

fn unsupported(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::Unsupported | io::ErrorKind::InvalidInput)
}

pub(super) fn in_two_steps(new: &Path, old: &Path, aside: &Path) -> io::Result<()> {
    if aside.exists() {
        // A run that was replaced, and not yet removed.
        std::fs::remove_dir_all(aside)?;
    }
    std::fs::rename(old, aside)?;
    if let Err(error) = std::fs::rename(new, old) {
        // The first failure is what the user should hear of.
        let _ = std::fs::rename(aside, old);
        return Err(error);
    }
    // As after an exchange, the replaced run is found under the name of the new one.
    std::fs::rename(aside, new)
}

//! Ctrl-C as a flag that a running simulation asks for.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::errors::{CliError, Failure};

/// Tells whether the user asked to stop. Clones share the same flag.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// A flag that nothing sets but [`Interrupt::request`].
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Listens to Ctrl-C (and to the termination signal of a batch system). The first one sets the flag, so that the
    /// simulation can stop and write what there is; the second one ends the process at once with exit code 130.
    ///
    /// # Errors
    /// If the process already listens (only one such flag can be installed) or the system refuses.
    pub fn install() -> Result<Self, CliError> {
        let flag = Self::new();
        let seen = flag.clone();
        ctrlc::set_handler(move || {
            if seen.0.swap(true, Ordering::SeqCst) {
                std::process::exit(i32::from(Failure::Interrupted.code()));
            }
        })
        .map_err(|error| CliError::failed("Ctrl-C cannot be listened to").with_source(error))?;
        Ok(flag)
    }

    /// Whether the user asked to stop.
    #[must_use]
    pub fn requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Asks to stop, as Ctrl-C does.
    pub fn request(&self) {
        self.0.store(true, Ordering::SeqCst);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_share_the_flag() {
        let flag = Interrupt::new();
        let other = flag.clone();
        assert!(!flag.requested());
        other.request();
        assert!(flag.requested());
    }

    #[test]
    fn only_one_listener_can_be_installed() {
        assert!(Interrupt::install().is_ok());
        let error = Interrupt::install().expect_err("second listener");
        assert!(error.report().contains("Ctrl-C"));
    }
}

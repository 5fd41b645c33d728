//! How the program fails: one message with its causes and a hint, and an exit code.

use std::error::Error;
use std::fmt;
use std::io::Write;
use std::process::ExitCode;

/// Why the program did not finish, which decides its exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The simulation or the writing of its results failed: exit code 1.
    Failed,
    /// The command line or the scene is wrong: exit code 2.
    Usage,
    /// The user stopped the program, and what there was has been written: exit code 130.
    Interrupted,
}

impl Failure {
    /// The exit code of the process.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::Failed => 1,
            Self::Usage => 2,
            Self::Interrupted => 130,
        }
    }
}

/// An error as the user sees it: what went wrong, why, and what to try.
#[derive(Debug)]
pub struct CliError {
    failure: Failure,
    message: String,
    hint: Option<String>,
    source: Option<Box<dyn Error + Send + Sync>>,
}

impl CliError {
    /// An error of the given kind.
    pub fn new(failure: Failure, message: impl Into<String>) -> Self {
        Self {
            failure,
            message: message.into(),
            hint: None,
            source: None,
        }
    }

    /// The simulation failed (exit code 1).
    pub fn failed(message: impl Into<String>) -> Self {
        Self::new(Failure::Failed, message)
    }

    /// The command line or the scene is wrong (exit code 2).
    pub fn usage(message: impl Into<String>) -> Self {
        Self::new(Failure::Usage, message)
    }

    /// The user stopped the program (exit code 130).
    pub fn interrupted(message: impl Into<String>) -> Self {
        Self::new(Failure::Interrupted, message)
    }

    /// A name that is not among the known ones (exit code 2), with the nearest one or all of them as a hint.
    ///
    /// ```
    /// use linkdyn_cli::errors::CliError;
    /// let error = CliError::unknown("scene", "rsrr", ["rsrrr", "rsup"]);
    /// assert_eq!(error.to_string(), "unknown scene `rsrr`");
    /// assert_eq!(error.hint(), Some("did you mean `rsrrr`?"));
    /// ```
    pub fn unknown<'a>(what: &str, given: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        let known: Vec<&str> = known.into_iter().collect();
        let error = Self::usage(format!("unknown {what} `{given}`"));
        match nearest(given, known.iter().copied()) {
            Some(name) => error.with_hint(format!("did you mean `{name}`?")),
            None if known.is_empty() => error.with_hint(format!("there is no {what} to choose from")),
            None => error.with_hint(format!("known are: {}", known.join(", "))),
        }
    }

    /// Adds what the user may try.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// Adds the error that caused this one.
    #[must_use]
    pub fn with_source(mut self, source: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        self.source = Some(source.into());
        self
    }

    /// The kind of failure, which decides the exit code.
    #[must_use]
    pub const fn failure(&self) -> Failure {
        self.failure
    }

    /// What the user may try.
    #[must_use]
    pub fn hint(&self) -> Option<&str> {
        self.hint.as_deref()
    }

    /// The whole report: `error: ...`, one line for each cause, and the hint.
    #[must_use]
    pub fn report(&self) -> String {
        let mut text = match self.failure {
            Failure::Interrupted => format!("interrupted: {}\n", self.message),
            Failure::Failed | Failure::Usage => format!("error: {}\n", self.message),
        };
        let mut said = self.message.clone();
        let mut cause = self.source();
        while let Some(error) = cause {
            let message = error.to_string();
            // Some errors repeat their source in their own message.
            if !said.contains(&message) {
                text.push_str(&format!("  caused by: {message}\n"));
            }
            said = message;
            cause = error.source();
        }
        if let Some(hint) = &self.hint {
            text.push_str(&format!("  hint: {hint}\n"));
        }
        text
    }
}

impl fmt::Display for CliError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl Error for CliError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.source.as_deref().map(|e| e as _)
    }
}

impl From<crate::results::ResultsError> for CliError {
    fn from(error: crate::results::ResultsError) -> Self {
        let failure = if error.is_usage() {
            Failure::Usage
        } else {
            Failure::Failed
        };
        let hint = error.hint();
        let mut wrapped = Self::new(failure, error.to_string()).with_source(error);
        wrapped.hint = hint;
        wrapped
    }
}

impl From<crate::figure::FigureError> for CliError {
    fn from(error: crate::figure::FigureError) -> Self {
        Self::failed("a picture could not be drawn").with_source(error)
    }
}

/// The known name that `given` is most likely a mistyped form of, if any is near enough.
///
/// ```
/// use linkdyn_cli::errors::nearest;
/// assert_eq!(nearest("radua", ["radau", "bdf"]), Some("radau"));
/// assert_eq!(nearest("euler", ["radau", "bdf"]), None);
/// ```
pub fn nearest<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let given = given.to_lowercase();
    known
        .into_iter()
        .map(|name| (strsim::jaro_winkler(&given, &name.to_lowercase()), name))
        .filter(|(likeness, _)| *likeness > 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}

/// Reports an error on standard error and gives the exit code of the process.
pub fn exit(outcome: Result<(), CliError>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Nothing can be told when standard error is closed too; the exit code remains.
            let _ = std::io::stderr().write_all(error.report().as_bytes());
            ExitCode::from(error.failure.code())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exit_codes_are_those_promised() {
        assert_eq!(CliError::failed("").failure().code(), 1);
        assert_eq!(CliError::usage("").failure().code(), 2);
        assert_eq!(CliError::interrupted("").failure().code(), 130);
    }

    #[test]
    fn report_has_every_cause_once_and_the_hint_last() {
        let io = std::io::Error::other("disk full");
        let middle = CliError::failed("row 7 could not be written").with_source(io);
        let error = CliError::failed("the run stopped")
            .with_source(middle)
            .with_hint("free some space");
        assert_eq!(
            error.report(),
            "error: the run stopped\n  caused by: row 7 could not be written\n  caused by: disk full\n  hint: free some space\n"
        );
        let repeats = CliError::failed("cannot write: disk full").with_source(std::io::Error::other("disk full"));
        assert_eq!(repeats.report(), "error: cannot write: disk full\n");
    }

    #[test]
    fn an_interruption_is_not_called_an_error() {
        assert!(
            CliError::interrupted("stopped at t = 1 s")
                .report()
                .starts_with("interrupted: ")
        );
    }

    #[test]
    fn nearest_name_ignores_case_and_refuses_far_ones() {
        assert_eq!(nearest("RSRR", ["rsup", "rsrrr"]), Some("rsrrr"));
        assert_eq!(nearest("", ["rsup"]), None);
        assert_eq!(nearest("x", []), None);
    }

    #[test]
    fn unknown_name_far_from_all_lists_them() {
        let error = CliError::unknown("method", "zzz", ["radau", "bdf"]);
        assert_eq!(error.hint(), Some("known are: radau, bdf"));
        assert_eq!(error.failure(), Failure::Usage);
    }
}

//! Progress bar with estimated time, on standard error and only on a terminal.

use std::fmt;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// A run must take longer than this for its progress to be shown.
const PATIENCE: Duration = Duration::from_millis(500);
/// The bar is redrawn at most this often.
const EVERY: Duration = Duration::from_millis(100);
/// The time that remains is not estimated from less than this.
const ESTIMATE_AFTER: Duration = Duration::from_secs(2);
/// Number of parts of the bar.
const PARTS: f64 = 1e6;

/// Tells how far a simulation has come.
///
/// The bar shows the simulated time, the percentage and the time that remains. It appears only if the run takes longer
/// than half a second and standard error is a terminal, and it goes when the run ends. [`Progress::set`] may be called
/// after every step: it costs no more than reading the clock.
pub struct Progress {
    bar: Option<ProgressBar>,
    begin: f64,
    end: f64,
    started: Instant,
    shown: Option<Instant>,
    patience: Duration,
}

impl Progress {
    /// Progress of a run from time `begin` to time `end`, called `label`. `quiet` (`--quiet`, `--json`) shows nothing.
    #[must_use]
    pub fn new(label: &str, begin: f64, end: f64, quiet: bool) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        Self::on(target, PATIENCE, label, begin, end)
    }

    fn on(target: ProgressDrawTarget, patience: Duration, label: &str, begin: f64, end: f64) -> Self {
        // indicatif hides a target that is no terminal (and one whose TERM is `dumb`).
        let possible = !target.is_hidden() && end > begin && (end - begin).is_finite();
        let bar = possible.then(|| {
            let bar = ProgressBar::with_draw_target(Some(PARTS as u64), target).with_prefix(label.to_owned());
            let style = ProgressStyle::with_template("{prefix} [{bar:30}] {percent:>3} %  {msg}{remaining}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            bar.set_style(style.progress_chars("=> ").with_key("remaining", remaining));
            bar
        });
        Self {
            bar,
            begin,
            end,
            started: Instant::now(),
            shown: None,
            patience,
        }
    }

    /// The simulation has come to time `t`.
    pub fn set(&mut self, t: f64) {
        let Some(bar) = &self.bar else { return };
        let now = Instant::now();
        let due = match self.shown {
            None => now - self.started >= self.patience,
            Some(last) => now - last >= EVERY,
        };
        if due {
            self.shown = Some(now);
            // A NaN becomes part 0.
            let part = ((t - self.begin) / (self.end - self.begin)).clamp(0.0, 1.0);
            bar.set_message(format!("t = {t:.3} of {} s", self.end));
            bar.set_position((part * PARTS) as u64);
        }
    }

    /// Whether the bar has been shown.
    #[must_use]
    pub fn is_shown(&self) -> bool {
        self.shown.is_some()
    }
}

/// The time that remains, where it can be told.
fn remaining(state: &ProgressState, text: &mut dyn fmt::Write) {
    if state.elapsed() >= ESTIMATE_AFTER && state.pos() > 0 {
        // Writing to the bar cannot fail.
        let _ = write!(text, ", about {} left", indicatif::HumanDuration(state.eta()));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl fmt::Debug for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Progress")
            .field("begin", &self.begin)
            .field("end", &self.end)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indicatif::TermLike;
    use std::io;
    use std::sync::{Arc, Mutex};

    /// A terminal that keeps what is written to it.
    #[derive(Clone, Debug, Default)]
    struct Screen(Arc<Mutex<String>>);

    impl Screen {
        fn text(&self) -> String {
            self.0.lock().unwrap().clone()
        }
        fn add(&self, text: &str) -> io::Result<()> {
            self.0.lock().unwrap().push_str(text);
            Ok(())
        }
    }

    impl TermLike for Screen {
        fn width(&self) -> u16 {
            120
        }
        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn write_line(&self, line: &str) -> io::Result<()> {
            self.add(line)
        }
        fn write_str(&self, text: &str) -> io::Result<()> {
            self.add(text)
        }
        fn clear_line(&self) -> io::Result<()> {
            self.add("<clear>")
        }
        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    fn progress(screen: &Screen, patience: Duration, begin: f64, end: f64) -> Progress {
        let target = ProgressDrawTarget::term_like(Box::new(screen.clone()));
        Progress::on(target, patience, "rsrrr", begin, end)
    }

    #[test]
    fn a_long_run_shows_time_and_percentage_and_clears_the_line() {
        let screen = Screen::default();
        let mut progress = progress(&screen, Duration::ZERO, 0.0, 5.0);
        progress.set(1.25);
        let text = screen.text();
        assert!(
            text.contains("rsrrr [") && text.contains("25 %") && text.contains("t = 1.250 of 5 s"),
            "{text}"
        );
        assert!(progress.is_shown());
        drop(progress);
        assert!(screen.text().ends_with("<clear>") || screen.text().contains("<clear>"));
    }

    #[test]
    fn a_short_run_shows_nothing() {
        let screen = Screen::default();
        let mut progress = progress(&screen, Duration::from_secs(1000), 0.0, 5.0);
        for i in 0..1000 {
            progress.set(f64::from(i) * 0.005);
        }
        assert!(!progress.is_shown());
        drop(progress);
        assert!(!screen.text().contains("rsrrr"), "{:?}", screen.text());
    }

    #[test]
    fn strange_times_do_no_harm() {
        let screen = Screen::default();
        for (begin, end) in [(0.0, 0.0), (1.0, 0.0), (0.0, f64::INFINITY), (f64::NAN, 1.0)] {
            let mut progress = progress(&screen, Duration::ZERO, begin, end);
            progress.set(0.5);
            assert!(!progress.is_shown());
        }
        for t in [f64::NAN, -1.0, 7.0] {
            let mut progress = progress(&screen, Duration::ZERO, 0.0, 1.0);
            progress.set(t);
        }
    }

    #[test]
    fn quiet_and_redirected_runs_are_silent() {
        let mut progress = Progress::new("x", 0.0, 1.0, true);
        progress.set(0.5);
        assert!(progress.bar.is_none());
    }

    #[test]
    fn steps_are_cheap() {
        let screen = Screen::default();
        let mut progress = progress(&screen, Duration::ZERO, 0.0, 1.0);
        let started = Instant::now();
        for i in 0..100_000 {
            progress.set(f64::from(i) * 1e-5);
        }
        assert!(started.elapsed() < Duration::from_secs(2));
    }
}

//! The figures of one row.

use linkdyn_mechanisms::integrators::Statistics;

use super::candidates::{Candidate, Way};
use super::measure::Measured;
use super::reference::Known;

/// A row of the report.
pub struct Row {
    /// What was to be measured.
    pub candidate: Candidate,
    /// What came of it.
    pub outcome: Outcome,
}

/// What came of a row.
pub enum Outcome {
    /// Its figures.
    Done(Box<Figures>),
    /// The method or the mechanism could not go on; what and when.
    Failed(String),
    /// The budget did not allow it.
    NotRun,
}

impl Outcome {
    /// The word for it in files.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Done(_) => "done",
            Self::Failed(_) => "failed",
            Self::NotRun => "not_run",
        }
    }

    /// Its figures, if it has them.
    pub fn figures(&self) -> Option<&Figures> {
        match self {
            Self::Done(figures) => Some(figures),
            _ => None,
        }
    }
}

/// Figures of a run that came to its end.
#[derive(Clone, Debug)]
pub struct Figures {
    /// Largest error of a coordinate \[rad, m\].
    pub positions: Known,
    /// Largest error of a speed \[rad/s, m/s\].
    pub speeds: Known,
    /// Largest error of a multiplier, a joint's reaction or a contact's force \[N, N m\].
    pub forces: Known,
    /// Costs without output; with it where there was no repeat.
    pub statistics: Statistics,
    /// Least and longest time of the repeats \[s\]; of the one run with output where there was none.
    pub wall: (f64, f64),
    /// Number of timed repeats.
    pub repeats: usize,
    /// Largest change of the energy balance \[J\].
    pub energy: f64,
    /// Largest closure residual before a projection \[m, -\].
    pub closures: f64,
}

impl Figures {
    /// Figures of a run with output.
    pub fn new(run: &Measured, [positions, speeds, forces]: [Known; 3]) -> Self {
        Self {
            positions,
            speeds,
            forces,
            statistics: run.statistics,
            wall: (run.wall, run.wall),
            repeats: 0,
            energy: run.energy,
            closures: run.worst.position_drift,
        }
    }

    /// Takes in a run without output, whose costs are those of the method alone.
    pub fn repeat(&mut self, timed: &Measured) {
        self.wall = match self.repeats {
            0 => (timed.wall, timed.wall),
            _ => (self.wall.0.min(timed.wall), self.wall.1.max(timed.wall)),
        };
        self.statistics = timed.statistics;
        self.repeats += 1;
    }

    /// Evaluations and time in units of another row's.
    pub fn ratios(&self, other: &Self) -> (f64, f64) {
        let evaluations = self.statistics.evaluations as f64 / other.statistics.evaluations.max(1) as f64;
        (evaluations, self.wall.0 / other.wall.0.max(f64::MIN_POSITIVE))
    }
}

/// The row of the paper's way at the paper's own step, if it was run.
pub fn papers(rows: &[Row]) -> Option<&Figures> {
    rows.iter()
        .find(|row| row.candidate.way == Way::Published)?
        .outcome
        .figures()
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::run::methods::Plan;
    use linkdyn_mechanisms::Worst;

    /// A run that took this long.
    fn run(wall: f64, evaluations: u64) -> Measured {
        let mut statistics = Statistics::default();
        statistics.evaluations = evaluations;
        Measured {
            path: Vec::new(),
            statistics,
            worst: Worst::default(),
            energy: 1e-9,
            wall,
            halt: None,
        }
    }

    /// A finished row.
    pub fn row(method: &str, way: Way, error: Known, evaluations: u64) -> Row {
        let plan = Plan {
            method: method.to_owned(),
            rtol: Some(1e-6),
            atol: Some(1e-6),
            step: None,
            iterations: None,
            switching: linkdyn_mechanisms::Switching::Located,
        };
        let figures = Figures::new(&run(1e-6 * evaluations as f64, evaluations), [error; 3]);
        Row {
            candidate: Candidate { plan, way },
            outcome: Outcome::Done(Box::new(figures)),
        }
    }

    #[test]
    fn the_least_time_counts_and_output_does_not() {
        let mut figures = Figures::new(&run(9.0, 900), [Known::Value(1.0); 3]);
        for wall in [2.0, 1.0, 3.0] {
            figures.repeat(&run(wall, 100));
        }
        assert_eq!(
            (figures.wall, figures.repeats, figures.statistics.evaluations),
            ((1.0, 3.0), 3, 100)
        );
        let other = Figures::new(&run(4.0, 200), [Known::Value(1.0); 3]);
        assert_eq!(figures.ratios(&other), (0.5, 0.25));
    }

    #[test]
    fn the_papers_row_is_that_of_its_own_step() {
        let mut rows = vec![
            row("rk4", Way::Papers, Known::Value(1e-3), 10),
            row("rk4", Way::Published, Known::Value(1e-5), 20),
            row("rk4", Way::Own, Known::Value(1e-6), 50),
        ];
        assert_eq!(papers(&rows).map(|f| f.statistics.evaluations), Some(20));
        rows[1].outcome = Outcome::NotRun;
        assert!(papers(&rows).is_none());
    }
}

//! What the methods have cost, and which of them shall go on. For the origin of the numbers see the method's own file.

/// Part of its own cost rate below which the other method must be expected to stay to be worth a trial.
const WORTH: f64 = 0.8;

/// A failed trial may cost so much of all evaluations.
const SHARE: f64 = 0.1;

/// A trial may fall behind by so many times what the method needs to get going.
const PATIENCE: f64 = 2.0;

/// Books of the evaluations that each unit of time has cost.
///
/// There is no model of what a method costs: the other one is tried, on the run itself. While it is on trial its evaluations are set against those
/// that the first would have needed at its last known rate; it stays as soon as it is ahead, start included, and goes when it is too
/// far behind. Trials are so rare that those which fail cost a small share of the run, and rarer the more of them have failed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Account {
    /// Evaluations after which an observation counts for e⁻¹.
    memory: f64,
    /// Evaluations and time of the method that runs, old ones fading.
    evaluations: f64,
    time: f64,
    trial: Option<Trial>,
    /// Evaluations until the next trial may begin.
    wait: f64,
    failures: u32,
}

/// A method on trial.
#[derive(Debug, Clone, Copy)]
struct Trial {
    /// Evaluations per time of the method that ran before.
    rate: f64,
    /// Evaluations more than that method would have needed.
    behind: f64,
    /// How far it may be behind.
    limit: f64,
}

/// What the books say after a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Judgement {
    GoOn,
    /// The trial has failed.
    GoBack,
}

impl Account {
    pub(super) fn new(memory: f64) -> Self {
        Self {
            memory,
            evaluations: 0.0,
            time: 0.0,
            trial: None,
            wait: 0.0,
            failures: 0,
        }
    }

    /// Evaluations per time of the method that runs.
    pub(super) fn rate(&self) -> f64 {
        self.evaluations / self.time
    }

    /// Books a step of length `h` > 0.
    pub(super) fn book(&mut self, evaluations: f64, h: f64) -> Judgement {
        let fading = self.memory / (self.memory + evaluations);
        self.evaluations = fading * self.evaluations + evaluations;
        self.time = fading * self.time + h;
        self.wait -= evaluations;
        let Some(trial) = &mut self.trial else {
            return Judgement::GoOn;
        };
        trial.behind += evaluations - trial.rate * h;
        if trial.behind <= 0.0 {
            (self.trial, self.failures) = (None, 0);
        } else if trial.behind > trial.limit {
            return Judgement::GoBack;
        }
        Judgement::GoOn
    }

    /// Whether a method that will need at least `rate` evaluations per time should be tried.
    pub(super) fn is_worth_trying(&self, rate: f64) -> bool {
        self.trial.is_none() && self.wait <= 0.0 && rate < WORTH * self.rate()
    }

    /// The other method begins, which needs `start` evaluations to get going.
    pub(super) fn try_other(&mut self, start: f64) {
        self.trial = Some(Trial {
            rate: self.rate(),
            behind: 0.0,
            limit: PATIENCE * start,
        });
        (self.evaluations, self.time) = (0.0, 0.0);
    }

    /// The method on trial has failed, the one before goes on.
    pub(super) fn go_back(&mut self) {
        let Some(trial) = self.trial.take() else { return };
        self.wait = 2f64.powi(self.failures.min(20) as i32) * trial.limit / SHARE;
        self.failures += 1;
        (self.evaluations, self.time) = (0.0, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Books steps of length 1 until the trial is over; what it says at last and how many steps it took.
    fn trial(account: &mut Account, evaluations: f64) -> (Judgement, u32) {
        for step in 1..1000 {
            let judgement = account.book(evaluations, 1.0);
            if account.trial.is_none() || judgement == Judgement::GoBack {
                return (judgement, step);
            }
        }
        panic!("no decision");
    }

    fn account_with_rate(rate: f64) -> Account {
        let mut account = Account::new(100.0);
        for _ in 0..1000 {
            assert_eq!(account.book(rate, 1.0), Judgement::GoOn);
        }
        assert!((account.rate() / rate - 1.0).abs() < 1e-3);
        account
    }

    #[test]
    fn the_cheaper_method_stays() {
        let mut account = account_with_rate(10.0);
        assert!(account.is_worth_trying(7.9) && !account.is_worth_trying(8.1));
        account.try_other(20.0);
        assert_eq!(account.book(30.0, 1.0), Judgement::GoOn);
        // 20 behind, 5 caught up by each step.
        assert_eq!(trial(&mut account, 5.0), (Judgement::GoOn, 4));
        assert!(account.is_worth_trying(0.0));
    }

    #[test]
    fn the_dearer_one_goes_and_trials_get_rare() {
        let mut account = account_with_rate(10.0);
        let mut waited = 0.0;
        for _ in 0..4 {
            account.try_other(20.0);
            assert_eq!(trial(&mut account, 30.0), (Judgement::GoBack, 3));
            account.go_back();
            let mut wait = 0.0;
            while !account.is_worth_trying(0.0) {
                account.book(10.0, 1.0);
                wait += 10.0;
            }
            // What the trial lost, 60 at most, is a tenth of this.
            assert!(wait >= 400.0 && wait >= 1.9 * waited, "{wait} after {waited}");
            waited = wait;
        }
    }
}

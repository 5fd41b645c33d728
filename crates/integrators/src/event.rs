//! What the driver remembers of root functions, and when they may fire.

/// Part of the slopes in the step before an event below which a slope at the event counts as rest.
const AT_REST: f64 = 1e-9;

/// How far ahead of rounding two roots are still at one time.
const AT_ONCE: f64 = 4.0;

/// Memory of the root functions. All vectors are empty if there are none.
#[derive(Debug, Default)]
pub(crate) struct Events {
    /// Functions that fire when they cross zero.
    pub(crate) armed: Vec<bool>,
    /// Those that met zero at the last event, if the last step led to one.
    pub(crate) fired: Vec<bool>,
    /// The functions at the state reached, and at the end of the attempt.
    pub(crate) reached: Functions,
    pub(crate) trial: Functions,
    /// Largest slopes in the step that led to the last event.
    pub(crate) scales: Vec<f64>,
    /// Trial values and the trial state that they belong to.
    pub(crate) values: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// The state at the last event before it was changed, and the end of the method's own step close to it.
    pub(crate) y_before: Vec<f64>,
    pub(crate) y_end: Vec<f64>,
    pub(crate) t_end: f64,
    /// Whether the last step led to an event.
    pub(crate) at_event: bool,
    /// What the functions at the state reached must be compared with before the next step.
    pub(crate) since: Since,
    /// Time of the last event, and how many before it were at the same time.
    pub(crate) last: f64,
    pub(crate) repeats: u64,
    /// Length of time, with sign, over which slopes are measured at the state reached.
    pub(crate) probe: f64,
    /// An event at the time of a stop; the stop is told of next.
    pub(crate) stop_pending: bool,
}

/// Values and slopes of all functions at one state.
#[derive(Debug, Default, Clone)]
pub(crate) struct Functions {
    pub(crate) values: Vec<f64>,
    /// By time, along the solution.
    pub(crate) slopes: Vec<f64>,
}

impl Functions {
    fn new(count: usize) -> Self {
        Self {
            values: vec![0.0; count],
            slopes: vec![0.0; count],
        }
    }
}

/// What has happened at the state reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Since {
    /// The run starts here.
    #[default]
    Start,
    /// A step has ended here; the problem may have been changed by its owner.
    Stop,
    /// An event.
    Event,
    /// Nothing.
    Step,
}

/// May a function fire?
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Readiness {
    /// Not before it has been positive.
    Silent,
    /// When it crosses zero.
    Armed,
    /// At once.
    Fires,
}

/// Value and slope (in the direction of the integration) of one function at one state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Seen {
    pub(crate) value: f64,
    pub(crate) slope: f64,
}

impl Seen {
    /// Whether the function falls through zero here; `resolution` is the spacing of times that can be told apart.
    pub(crate) fn falls_through(self, resolution: f64) -> bool {
        self.slope < 0.0 && self.value <= AT_ONCE * resolution * -self.slope
    }
}

impl Events {
    pub(crate) fn new(count: usize, dim: usize) -> Self {
        if count == 0 {
            return Self::default();
        }
        Self {
            armed: vec![false; count],
            fired: vec![false; count],
            reached: Functions::new(count),
            trial: Functions::new(count),
            scales: vec![0.0; count],
            values: vec![0.0; count],
            y: vec![0.0; dim],
            y_before: vec![0.0; dim],
            y_end: vec![0.0; dim],
            ..Self::default()
        }
    }

    /// Whether the problem has no root functions.
    #[inline]
    pub(crate) fn none(&self) -> bool {
        self.armed.is_empty()
    }

    /// The run starts anew.
    pub(crate) fn start(&mut self) {
        self.armed.fill(false);
        self.fired.fill(false);
        (self.since, self.at_event, self.stop_pending) = (Since::Start, false, false);
    }

    /// The method has started anew, f and the functions may be others.
    pub(crate) fn restart(&mut self) {
        if self.since == Since::Step {
            self.since = Since::Stop;
        }
    }

    /// Makes the end of the attempt the state reached, where functions that are positive are armed.
    pub(crate) fn step(&mut self) {
        std::mem::swap(&mut self.reached, &mut self.trial);
        for (armed, value) in self.armed.iter_mut().zip(&self.reached.values) {
            *armed |= *value > 0.0;
        }
        self.since = Since::Step;
    }

    /// Compares the functions at the state reached, before (`reached`) and now (`trial`), after what has happened `since`: arms
    /// them, and tells whether some fire at once, which are then marked.
    pub(crate) fn compare(&mut self, direction: f64, resolution: f64) -> bool {
        let seen = |functions: &Functions, k: usize| Seen {
            value: functions.values[k],
            slope: direction * functions.slopes[k],
        };
        let mut any = false;
        for k in 0..self.armed.len() {
            let (before, now) = (seen(&self.reached, k), seen(&self.trial, k));
            let readiness = if self.since == Since::Event && self.fired[k] {
                after_own_event(before, now, self.scales[k], resolution)
            } else {
                after_change(self.armed[k], now, resolution)
            };
            self.armed[k] = readiness != Readiness::Silent;
            self.fired[k] = readiness == Readiness::Fires;
            any |= self.fired[k];
        }
        std::mem::swap(&mut self.reached, &mut self.trial);
        self.since = Since::Step;
        any
    }

    /// The time, with sign, to the first root at or before the end of the attempt, by values and slopes there: of `function`, and of
    /// those that are no longer positive.
    pub(crate) fn time_left(&self, function: usize, direction: f64) -> Option<f64> {
        let Functions { values, slopes } = &self.trial;
        let falls = |&k: &usize| direction * slopes[k] < 0.0 && (k == function || (self.armed[k] && values[k] <= 0.0));
        let times = (0..values.len()).filter(falls).map(|k| -values[k] / slopes[k]);
        times.min_by(|a, b| (direction * a).total_cmp(&(direction * b)))
    }

    /// Whether a function that may fire is no longer positive at the end of the attempt.
    pub(crate) fn any_passed(&self, function: usize) -> bool {
        let mut all = self.trial.values.iter().enumerate();
        all.any(|(k, value)| *value <= 0.0 && (self.armed[k] || k == function))
    }

    /// Marks the armed functions that fall through zero at the end of the attempt, or where it began: of those that were looked
    /// for, `wanted` at least.
    pub(crate) fn mark(&mut self, at_start: bool, wanted: usize, direction: f64, resolution: f64) {
        let functions = if at_start { &self.reached } else { &self.trial };
        let mut any = false;
        for k in 0..self.armed.len() {
            let seen = Seen {
                value: functions.values[k],
                slope: direction * functions.slopes[k],
            };
            self.fired[k] = (self.armed[k] || k == wanted) && seen.falls_through(resolution);
            any |= self.fired[k];
            self.scales[k] = self.reached.slopes[k].abs().max(self.trial.slopes[k].abs());
        }
        self.fired[wanted] |= !any;
    }
}

/// Of a function that has just fired, before and after the event; `scale` is the size of its slopes in the step before.
fn after_own_event(before: Seen, now: Seen, scale: f64, resolution: f64) -> Readiness {
    let zero = AT_ONCE * resolution * before.slope.abs().max(now.slope.abs());
    if before.value < -zero {
        // It had jumped there, and is no news.
        return if now.value > 0.0 {
            Readiness::Armed
        } else {
            Readiness::Silent
        };
    }
    let rounding = zero + AT_ONCE * before.value.abs();
    if now.value > rounding {
        Readiness::Armed
    } else if now.value < -rounding {
        Readiness::Fires
    } else if now.slope >= -AT_REST * scale.max(before.slope.abs()) {
        // It has turned round, or rests.
        Readiness::Armed
    } else if before.slope < 0.0 {
        // It goes on through zero.
        Readiness::Silent
    } else {
        // It is about to become negative although before it was to become positive.
        Readiness::Fires
    }
}

/// Of a function that has not fired, after an event, a stop or a start.
fn after_change(armed: bool, now: Seen, resolution: f64) -> Readiness {
    let at_zero = now.value >= -AT_ONCE * resolution * now.slope.abs();
    if now.value > 0.0 || (at_zero && now.slope > 0.0) || (at_zero && armed && now.slope == 0.0) {
        Readiness::Armed
    } else if armed {
        Readiness::Fires
    } else {
        Readiness::Silent
    }
}

//! Positions, velocities and accelerations over a range of the driven coordinates, along one branch.

use super::balance::{Balance, check, driven, number};
use super::error::AnalysisError;
use crate::mechanism::Mechanism;
use linkdyn_kinematics::Positions;
use linkdyn_kinematics::assembly::{self, Branch, Settings, SingularValues};

/// Largest correction by Newton's method over the predicted step: what is farther away may be another branch.
const CORRECTION: f64 = 0.3;
/// Corrections below this are rounding \[rad, m\].
const ROUNDING: f64 = 1e-9;
/// Share of the range at which a step counts as too short: a limit of motion is then located to this share.
const SHORTEST: f64 = 1e-10;
/// Shares of the range closer to a row than this are on it.
const ON_ROW: f64 = 1e-14;

/// A driven coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Driven {
    /// Its name.
    pub coordinate: String,
    /// Value at the end of the range; the start is that of the position given \[rad, m\].
    pub to: f64,
    /// Speed for which speeds are found \[rad/s, m/s\].
    pub speed: f64,
    /// Its rate for which accelerations are found \[rad/s^2, m/s^2\].
    pub acceleration: f64,
}

/// A range to go through: all driven coordinates go linearly from where they are to their ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Driven coordinates, as many as there are freedoms.
    pub driven: Vec<Driven>,
    /// Equal parts of the range: one row more than these, both ends included.
    pub parts: usize,
    /// Largest predicted step of any coordinate \[rad, m\].
    pub largest_step: f64,
}

impl Sweep {
    /// One driven coordinate to the value `to` in so many parts, at unit speed without acceleration; steps up to 0.1 rad or m.
    pub fn new(coordinate: &str, to: f64, parts: usize) -> Self {
        let driven = Driven {
            coordinate: coordinate.to_owned(),
            to,
            speed: 1.0,
            acceleration: 0.0,
        };
        Self {
            driven: vec![driven],
            parts,
            largest_step: 0.1,
        }
    }
}

/// One position with its velocities and accelerations.
#[derive(Clone, Debug, PartialEq)]
pub struct PositionRow {
    /// Share of the range \[-\].
    pub share: f64,
    /// Coordinates, driven ones as asked for.
    pub q: Vec<f64>,
    /// Speeds.
    pub v: Vec<f64>,
    /// Rates of the speeds.
    pub a: Vec<f64>,
}

/// Where the motion ends: the driven coordinates can go no further on this branch.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Share of the range reached \[-\].
    pub share: f64,
    /// Driven coordinates there, in their order \[rad, m\].
    pub driven: Vec<f64>,
    /// The coordinate that moves most for a given small motion of the driven ones; at the limit it does so without end.
    pub coordinate: String,
    /// Its value there \[rad, m\].
    pub value: f64,
    /// Smallest over largest singular value of the closure gradient in the speeds that are not driven \[-\]: it falls to zero like the
    /// root of the distance to a limit of motion. Where it is of the order of one, Newton's method failed for another reason.
    pub measure: f64,
    /// The last position found.
    pub q: Vec<f64>,
}

/// What a [`Sweep`] found.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Rows at equal parts of the range, as far as it could be gone through.
    pub rows: Vec<PositionRow>,
    /// Where it ended, if it ended early.
    pub limit: Option<Limit>,
    /// Steps made.
    pub steps: usize,
    /// Steps tried and given up for shorter ones.
    pub rejected: usize,
}

/// Goes through a range from the closed position `q`: each step is predicted along the tangent `T` and corrected by Newton's method
/// with the driven coordinates held. A step counts if the correction is small beside it and the sign of the determinant of the loops
/// stays, so that the branch is never left; others are halved.
///
/// Forces do not count, those of contacts included, nor do prescribed motions: the driven coordinates take their place. What clearance adds
/// to a mechanism can move, and must be driven as well.
///
/// Speeds solve `G v = 0`, their rates `G v' + gamma = 0`, with the driven ones given (symbols: `linkdyn_kinematics::notation`).
///
/// # Errors
/// [`AnalysisError`] for names and numbers that do not fit, and where at the start the driven coordinates do not determine the motion.
/// A limit of motion is no error but a result.
pub fn positions(mechanism: &Mechanism, q: &[f64], sweep: &Sweep) -> Result<Path, AnalysisError> {
    check(mechanism, q, None)?;
    let mut follower = Follower::new(mechanism, q, sweep)?;
    follower.balance.choose(q, &follower.speeds)?;
    let mut path = Path {
        rows: Vec::new(),
        limit: None,
        steps: 0,
        rejected: 0,
    };
    let mut step: f64 = 1.0;
    for part in 0..=sweep.parts {
        let target = part as f64 / sweep.parts as f64;
        while target - follower.share > ON_ROW {
            let wanted = step.min(target - follower.share);
            match follower.advance(wanted, target)? {
                Some(gone) => {
                    path.steps += 1;
                    step = 2.0 * gone.max(SHORTEST);
                }
                None => {
                    path.rejected += 1;
                    step = 0.5 * follower.tried;
                }
            }
            if step < SHORTEST {
                path.limit = Some(follower.limit());
                return Ok(path);
            }
        }
        match follower.row(target) {
            Ok(row) => path.rows.push(row),
            // The position itself is singular: there are no velocities.
            Err(AnalysisError::Overdetermined { .. } | AnalysisError::Undetermined { .. }) => {
                path.limit = Some(follower.limit());
                return Ok(path);
            }
            Err(other) => return Err(other),
        }
    }
    Ok(path)
}

/// The position reached on the way through a range.
struct Follower<'a> {
    balance: Balance<'a>,
    mechanism: &'a Mechanism,
    largest_step: f64,
    coordinates: Vec<usize>,
    speeds: Vec<usize>,
    held: Vec<bool>,
    from: Vec<f64>,
    /// Change of the driven coordinates over the range.
    span: Vec<f64>,
    /// Speed and acceleration of the driven coordinates.
    motion: (Vec<f64>, Vec<f64>),
    q: Vec<f64>,
    share: f64,
    branch: Branch,
    /// Share by which the last step tried to advance.
    tried: f64,
}

impl<'a> Follower<'a> {
    fn new(mechanism: &'a Mechanism, q: &[f64], sweep: &Sweep) -> Result<Self, AnalysisError> {
        if sweep.parts == 0 {
            return Err(number("parts", 0.0, "at least 1"));
        }
        if sweep.driven.is_empty() {
            return Err(number("driven coordinates", 0.0, "at least 1"));
        }
        if !(sweep.largest_step.is_finite() && sweep.largest_step > 0.0) {
            return Err(number("largest_step", sweep.largest_step, "a finite positive number"));
        }
        let mut held = vec![false; mechanism.system().tree().speeds()];
        let (mut coordinates, mut speeds) = (Vec::new(), Vec::new());
        for one in &sweep.driven {
            let (coordinate, speed) = driven(mechanism, &one.coordinate)?;
            for (what, value) in [("to", one.to), ("speed", one.speed), ("acceleration", one.acceleration)] {
                if !value.is_finite() {
                    return Err(number(
                        format!("{what} of `{}`", one.coordinate),
                        value,
                        "a finite number",
                    ));
                }
            }
            if std::mem::replace(&mut held[speed], true) {
                return Err(number(format!("times that `{}` is driven", one.coordinate), 2.0, "1"));
            }
            coordinates.push(coordinate);
            speeds.push(speed);
        }
        let from: Vec<f64> = coordinates.iter().map(|&coordinate| q[coordinate]).collect();
        let span = sweep
            .driven
            .iter()
            .zip(&from)
            .map(|(one, from)| one.to - from)
            .collect();
        let motion = sweep.driven.iter().map(|one| (one.speed, one.acceleration)).unzip();
        let mut follower = Self {
            balance: Balance::kinematic(mechanism),
            mechanism,
            largest_step: sweep.largest_step,
            coordinates,
            speeds,
            held,
            from,
            span,
            motion,
            q: q.to_vec(),
            share: 0.0,
            branch: Branch::Undefined,
            tried: 0.0,
        };
        let start = follower.close(q)?;
        (follower.q, follower.branch) = (start.q, start.branch);
        Ok(follower)
    }

    fn close(&self, guess: &[f64]) -> Result<assembly::Assembly, assembly::AssemblyError> {
        let system = self.mechanism.system();
        assembly::assemble(
            system.tree(),
            system.closures(),
            guess,
            &self.held,
            &Settings::default(),
        )
    }

    /// Tries to go on by a share of the range, shorter where that is too far; the share gone, or nothing where a shorter step is needed.
    fn advance(&mut self, wanted: f64, target: f64) -> Result<Option<f64>, AnalysisError> {
        self.tried = wanted;
        match self.balance.choose(&self.q, &self.speeds) {
            Ok(()) => {}
            Err(AnalysisError::Overdetermined { .. } | AnalysisError::Undetermined { .. }) => {
                self.tried = 0.0;
                return Ok(None);
            }
            Err(other) => return Err(other),
        }
        let still = vec![0.0; self.speeds.len()];
        let tangent = self.balance.moving(0.0, &self.q, &self.span, &still)?.v;
        let length = tangent.amax();
        let step = if length * wanted > self.largest_step {
            self.largest_step / length
        } else {
            wanted
        };
        self.tried = step;
        // The last step of a row ends on it, to the last bit.
        let share = if step == target - self.share {
            target
        } else {
            self.share + step
        };
        let mut guess = self.q.clone();
        let predicted = &tangent * step;
        self.mechanism
            .system()
            .tree()
            .displace(&mut guess, predicted.as_slice());
        for (k, &coordinate) in self.coordinates.iter().enumerate() {
            guess[coordinate] = self.from[k] + share * self.span[k];
        }
        let Ok(closed) = self.close(&guess) else {
            return Ok(None);
        };
        let correction = guess
            .iter()
            .zip(&closed.q)
            .fold(0.0, |s, (a, b)| f64::max(s, (a - b).abs()));
        let near = correction <= CORRECTION * predicted.amax() + ROUNDING;
        if !near || closed.branch != self.branch {
            return Ok(None);
        }
        (self.q, self.share) = (closed.q, share);
        Ok(Some(step))
    }

    fn row(&mut self, share: f64) -> Result<PositionRow, AnalysisError> {
        self.balance.choose(&self.q, &self.speeds)?;
        let (rates, second) = &self.motion;
        let moving = self.balance.moving(0.0, &self.q, rates, second)?;
        Ok(PositionRow {
            share,
            q: self.q.clone(),
            v: moving.v.as_slice().to_vec(),
            a: moving.a.as_slice().to_vec(),
        })
    }

    /// Diagnosis of the position reached.
    fn limit(&self) -> Limit {
        let system = self.mechanism.system();
        let tree = system.tree();
        let mut places = Positions::new(tree);
        tree.positions(&self.q, &mut places);
        let free: Vec<usize> = (0..tree.speeds()).filter(|&speed| !self.held[speed]).collect();
        let gradient = assembly::gradient(tree, system.closures(), &places).select_columns(&free);
        let (measure, fastest) = match SingularValues::new(&gradient).weakest() {
            Some((measure, direction)) => (measure, free[direction.iamax()]),
            None => (0.0, free.first().copied().unwrap_or_default()),
        };
        let coordinate = self.mechanism.speeds[fastest].clone();
        let value = self.mechanism.value_of_speed(fastest, &self.q);
        Limit {
            share: self.share,
            driven: self.coordinates.iter().map(|&coordinate| self.q[coordinate]).collect(),
            coordinate,
            value,
            measure,
            q: self.q.clone(),
        }
    }
}

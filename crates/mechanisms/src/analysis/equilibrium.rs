//! Static equilibrium, and whether it is stable.

use super::balance::{Balance, By, check, number};
use super::error::AnalysisError;
use crate::mechanism::{Mechanism, Start, State};
use linkdyn_kinematics::Positions;
use linkdyn_kinematics::assembly;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Forces below this share of all weights times the mechanism's size, and of the forces at the start, are rounding.
const FORCE_TOLERANCE: f64 = 1e-13;
/// Full Newton steps below this are rounding \[rad, m\].
const STEP_TOLERANCE: f64 = 1e-12;
/// Longest step \[rad, m\].
const LONGEST_STEP: f64 = 0.3;
/// Shortest share of a step that is tried.
const SHORTEST_SHARE: f64 = 1e-6;
/// Eigenvalues between minus and plus this share of the largest are zero: rounding of a stiffness from differences.
const INDIFFERENT: f64 = 1e-9;
/// How far an unstable equilibrium is left along its falling direction where a stable one is sought \[rad, m\].
const PUSH: f64 = 0.1;

/// Which equilibrium to look for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Seek {
    /// The stable one to which the mechanism would sink from the start, or one nearby: steps go where forces push.
    #[default]
    Stable,
    /// The one to which plain Newton's method leads, stable or not.
    Nearest,
}

/// How to look.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Which one.
    pub seek: Seek,
    /// Time at which loads are taken \[s\].
    pub time: f64,
    /// Coordinates that stay where they are, whatever force that takes.
    pub held: Vec<String>,
    /// Iterations to try.
    pub iterations: usize,
}

impl Default for Settings {
    /// A stable one, at t = 0, nothing held, in up to 200 iterations.
    fn default() -> Self {
        Self {
            seek: Seek::Stable,
            time: 0.0,
            held: Vec::new(),
            iterations: 200,
        }
    }
}

/// Whether an equilibrium is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// Every small displacement is pushed back.
    Stable,
    /// At least one is pushed further.
    Unstable,
    /// At least one is not pushed at all, to first order, and none further.
    Indifferent,
}

/// A position of rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Coordinates.
    pub q: Vec<f64>,
    /// Multipliers of all loops, then of the prescribed motions: the forces \[N\] or torques \[N m\] that hold their coordinates.
    pub multipliers: Vec<f64>,
    /// Independent speeds, in the order of the stiffness.
    pub independent: Vec<String>,
    /// Reduced stiffness: minus the derivative of the forces on the independent coordinates by these, loops kept
    /// \[N m/rad, N/m\].
    pub stiffness: DMatrix<f64>,
    /// Smallest eigenvalue of the stiffness against the mass \[1/s^2\]: the square of the lowest frequency where positive.
    pub lowest: f64,
    /// Whether it is kept, by the eigenvalues of the symmetric part of the stiffness. With loads that have no potential this is
    /// sufficient and not necessary; [`linearise`](super::linearise()) tells more.
    pub stability: Stability,
    /// Largest force left on an independent coordinate \[N m, N\].
    pub force: f64,
    /// Iterations made.
    pub iterations: usize,
}

/// An equilibrium from the closed position `q`, for speeds zero. Friction in joints acts by speed and is none at rest; springs,
/// weight, drives, forces on points and struts at the time given, and the elements of flexible links count in full. Coordinates with
/// prescribed motion are held where they are at that time, those of which the speed alone is prescribed where they are in `q`.
///
/// The condition is `T^T f(q) = 0` with `T` the tangent of the loops: no virtual power. Newton's method takes
/// `K = - d(T^T f)/dz`, the term of multipliers and second derivatives of the loops included since `T` changes with the position.
/// [`Seek::Stable`] adds a share of the mass to `K` until it is positive, so that every step leads downhill, and takes as much of a step
/// as does not lead far uphill again; [`Seek::Nearest`] shortens steps by the natural monotonicity test \[Deuflhard 2004\].
///
/// # Errors
/// [`AnalysisError::NoEquilibrium`] where none is found; [`AnalysisError::Internals`] for clearance and stops, whose contacts would have
/// to be known; other [`AnalysisError`]s for what does not fit.
pub fn equilibrium(mechanism: &Mechanism, q: &[f64], settings: &Settings) -> Result<Equilibrium, AnalysisError> {
    check(mechanism, q, None)?;
    if !settings.time.is_finite() {
        return Err(number("time", settings.time, "a finite number"));
    }
    let balance = Balance::holding(mechanism, &settings.held)?;
    let held = balance.held_flags();
    let mut rest = Rest {
        balance,
        mechanism,
        time: settings.time,
        q: guided(mechanism, q, settings.time, &held)?,
        held,
        scale: 0.0,
    };
    let mut worst = (0, f64::NAN);
    for iterations in 0..=settings.iterations {
        rest.balance.choose(&rest.q, &[])?;
        let point = rest.point(&rest.q.clone())?;
        let force = &point.force;
        rest.scale = rest.scale.max(weight(mechanism) + force.amax());
        let stiffness = rest.stiffness(&point)?;
        let spectrum = Spectrum::new(&stiffness, &rest.mass()?)?;
        worst = (rest.balance.independent[force.iamax()], force.amax());
        let newton = stiffness.clone().lu().solve(force);
        let tiny = newton.as_ref().is_some_and(|step| step.amax() <= STEP_TOLERANCE);
        if force.amax() <= FORCE_TOLERANCE * rest.scale || (tiny && force.amax() <= 1e4 * FORCE_TOLERANCE * rest.scale)
        {
            if settings.seek == Seek::Stable
                && spectrum.stability() == Stability::Unstable
                && iterations < settings.iterations
            {
                let push = &spectrum.falling * (PUSH / (&point.tangent * &spectrum.falling).amax());
                if rest
                    .go(&point.tangent, &push)
                    .is_ok_and(|q| q.is_some_and(|q| rest.take(q)))
                {
                    continue;
                }
            }
            return rest.result(&point, stiffness, &spectrum, iterations);
        }
        let moved = match settings.seek {
            Seek::Stable => rest.descend(&point, &spectrum)?,
            Seek::Nearest => match newton {
                Some(step) => rest.newton(&point, &stiffness, step)?,
                None => false,
            },
        };
        if !moved {
            return Err(rest.failure(iterations, worst));
        }
    }
    Err(rest.failure(settings.iterations, worst))
}

/// Where a run begins that shall start from rest, or from the speeds of `start`, under the loads that there are: the loops are closed from
/// `start`, the [`equilibrium`] is sought from there, in which flexible links have sagged, and the speeds are those of `start` there.
///
/// # Errors
/// See [`Mechanism::assemble`] and [`equilibrium`]. Where nothing can move besides what is held that is no error: the start is then as
/// assembled.
pub fn settled(mechanism: &Mechanism, start: &Start, settings: &Settings) -> Result<State, AnalysisError> {
    let (begin, _) = mechanism.assemble(start)?;
    let q = match equilibrium(mechanism, &begin.q, settings) {
        Ok(rest) => rest.q,
        Err(AnalysisError::NoFreedom) => return Ok(begin),
        Err(other) => return Err(other),
    };
    let names = mechanism.coordinate_names().map(str::to_owned);
    let there = Start {
        positions: names.zip(q).collect(),
        ..start.clone()
    };
    Ok(mechanism.assemble(&there)?.0)
}

/// The position `q` with prescribed coordinates where they are at time `t`.
fn guided(mechanism: &Mechanism, q: &[f64], t: f64, held: &[bool]) -> Result<Vec<f64>, AnalysisError> {
    let system = mechanism.system();
    let (mut guess, mut held) = (q.to_vec(), held.to_vec());
    mechanism.follow_prescribed(t, &mut guess, &mut held);
    if guess == q {
        return Ok(guess);
    }
    let closed = assembly::assemble(
        system.tree(),
        system.closures(),
        &guess,
        &held,
        &assembly::Settings::default(),
    );
    Ok(closed?.q)
}

/// The search at the position reached.
struct Rest<'a> {
    balance: Balance<'a>,
    mechanism: &'a Mechanism,
    time: f64,
    q: Vec<f64>,
    /// A flag a speed: those of prescribed coordinates and of others that are held.
    held: Vec<bool>,
    /// Size of forces \[N m, N\].
    scale: f64,
}

/// Forces at a position.
struct Point {
    tangent: DMatrix<f64>,
    /// On the independent coordinates, towards positive ones.
    force: DVector<f64>,
}

impl Rest<'_> {
    fn still(&self) -> Vec<f64> {
        vec![0.0; self.balance.independent.len()]
    }

    fn point(&mut self, q: &[f64]) -> Result<Point, AnalysisError> {
        let still = self.still();
        let moving = self.balance.moving(self.time, q, &still, &still)?;
        let force = -self.balance.forces(&moving)?;
        if let Some(value) = force.iter().find(|x| !x.is_finite()) {
            return Err(number("a force", *value, "a finite number"));
        }
        Ok(Point {
            tangent: moving.tangent,
            force,
        })
    }

    fn stiffness(&mut self, point: &Point) -> Result<DMatrix<f64>, AnalysisError> {
        let still = self.still();
        self.balance
            .slopes(By::Position, (self.time, &self.q), (&still, &still), &point.tangent)
    }

    fn mass(&mut self) -> Result<DMatrix<f64>, AnalysisError> {
        let still = self.still();
        self.balance.mass((self.time, &self.q), (&still, &still))
    }

    /// The position after a displacement of the independent coordinates, loops closed again; none where they cannot be.
    fn go(&self, tangent: &DMatrix<f64>, step: &DVector<f64>) -> Result<Option<Vec<f64>>, AnalysisError> {
        let system = self.mechanism.system();
        let (tree, mut q) = (system.tree(), self.q.clone());
        tree.displace(&mut q, (tangent * step).as_slice());
        let settings = assembly::Settings::default();
        let closed = assembly::assemble(tree, system.closures(), &q, &self.held, &settings);
        Ok(closed.ok().map(|closed| closed.q))
    }

    fn take(&mut self, q: Vec<f64>) -> bool {
        self.q = q;
        true
    }

    /// Tries shares of a step until `fine` says that one will do.
    fn search(
        &mut self,
        point: &Point,
        step: &DVector<f64>,
        fine: impl Fn(&Point) -> bool,
    ) -> Result<bool, AnalysisError> {
        let length = (&point.tangent * step).amax();
        let mut share = if length > LONGEST_STEP {
            LONGEST_STEP / length
        } else {
            1.0
        };
        let shortest = share * SHORTEST_SHARE;
        while share >= shortest {
            if let Some(q) = self.go(&point.tangent, &(step * share))?
                && self.point(&q).is_ok_and(|there| fine(&there))
            {
                return Ok(self.take(q));
            }
            share *= 0.5;
        }
        Ok(false)
    }

    /// A step downhill.
    fn descend(&mut self, point: &Point, spectrum: &Spectrum) -> Result<bool, AnalysisError> {
        let step = spectrum.downhill(&point.force);
        let slope = point.force.dot(&step);
        self.search(point, &step, |there| there.force.dot(&step) >= -0.5 * slope)
    }

    /// A Newton step.
    fn newton(&mut self, point: &Point, stiffness: &DMatrix<f64>, step: DVector<f64>) -> Result<bool, AnalysisError> {
        let factors = stiffness.clone().lu();
        let size = step.norm();
        self.search(point, &step, |there| {
            factors.solve(&there.force).is_some_and(|next| next.norm() < size)
        })
    }

    fn result(
        &mut self,
        point: &Point,
        stiffness: DMatrix<f64>,
        spectrum: &Spectrum,
        iterations: usize,
    ) -> Result<Equilibrium, AnalysisError> {
        let still = self.still();
        let moving = self.balance.moving(self.time, &self.q, &still, &still)?;
        let needed = self.balance.needed(&moving)?;
        Ok(Equilibrium {
            q: self.q.clone(),
            multipliers: needed.multipliers.as_slice().to_vec(),
            independent: self.balance.independent_names(),
            stiffness,
            lowest: spectrum.lowest(),
            stability: spectrum.stability(),
            force: point.force.amax(),
            iterations,
        })
    }

    fn failure(&self, iterations: usize, (speed, force): (usize, f64)) -> AnalysisError {
        AnalysisError::NoEquilibrium {
            iterations,
            force,
            coordinate: self.mechanism.speeds[speed].clone(),
            value: self.mechanism.value_of_speed(speed, &self.q),
        }
    }
}

/// Sum of all weights \[N\] times the size of the mechanism, at least 1 m.
fn weight(mechanism: &Mechanism) -> f64 {
    let system = mechanism.system();
    let mass: f64 = system.inertias().iter().map(|inertia| inertia.mass).sum();
    let mut positions = Positions::new(system.tree());
    system.tree().positions(&system.tree().neutral(), &mut positions);
    let size = positions
        .nodes()
        .iter()
        .fold(1.0, |s, node| f64::max(s, node.origin.amax()));
    mass * system.gravity().norm() * size
}

/// Symmetric part of the stiffness against the mass.
struct Spectrum {
    /// Eigenvalues \[1/s^2\].
    values: DVector<f64>,
    /// Displacements, one a column, orthonormal in the mass.
    shapes: DMatrix<f64>,
    /// The one of the smallest eigenvalue.
    falling: DVector<f64>,
}

impl Spectrum {
    fn new(stiffness: &DMatrix<f64>, mass: &DMatrix<f64>) -> Result<Self, AnalysisError> {
        if !stiffness.iter().chain(mass.iter()).all(|x| x.is_finite()) {
            return Err(AnalysisError::Eigenvalues("a derivative of the forces is not finite"));
        }
        let symmetric = |a: &DMatrix<f64>| (a + a.transpose()) * 0.5;
        let lower = symmetric(mass)
            .cholesky()
            .ok_or(AnalysisError::Eigenvalues("a freedom moves no mass"))?
            .l();
        let inverse = lower
            .try_inverse()
            .ok_or(AnalysisError::Eigenvalues("a freedom moves no mass"))?;
        let eigen = SymmetricEigen::new(symmetric(&(&inverse * symmetric(stiffness) * inverse.transpose())));
        let shapes = inverse.transpose() * eigen.eigenvectors;
        let falling = shapes.column(eigen.eigenvalues.imin()).into_owned();
        Ok(Self {
            values: eigen.eigenvalues,
            shapes,
            falling,
        })
    }

    fn lowest(&self) -> f64 {
        self.values.min()
    }

    fn stability(&self) -> Stability {
        let zero = INDIFFERENT * self.values.amax();
        match self.lowest() {
            lowest if lowest < -zero => Stability::Unstable,
            lowest if lowest <= zero => Stability::Indifferent,
            _ => Stability::Stable,
        }
    }

    /// `(K + shift M)^-1 force`, with the shift that makes it positive; none where it is.
    fn downhill(&self, force: &DVector<f64>) -> DVector<f64> {
        let (lowest, largest) = (self.lowest(), self.values.amax());
        let floor = INDIFFERENT * largest;
        let shift = if lowest > floor {
            0.0
        } else {
            2.0 * lowest.abs() + floor.max(f64::MIN_POSITIVE)
        };
        let mut shares = self.shapes.tr_mul(force);
        shares
            .iter_mut()
            .zip(&self.values)
            .for_each(|(share, value)| *share /= value + shift);
        &self.shapes * shares
    }
}

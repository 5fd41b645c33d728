//! Linearisation about a state, in independent coordinates.

use super::balance::{Balance, By, check, number};
use super::error::AnalysisError;
use super::modes::{Mode, general_modes, undamped_modes};
use crate::mechanism::{Mechanism, State};
use linkdyn_dynamics::Workspace;
use nalgebra::DMatrix;

/// Damping below this share of what mass and stiffness amount to, and asymmetry of the stiffness below this share of it, are rounding
/// of differences.
const NEGLIGIBLE: f64 = 1e-9;

/// `M dz'' + D dz' + K dz = 0` for small deviations `dz` from a motion, in independent coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearised {
    /// Names of the independent speeds, in the order of the matrices.
    pub independent: Vec<String>,
    /// `M` \[kg m^2, kg m, kg\].
    pub mass: DMatrix<f64>,
    /// `D`: damping, and gyroscopic terms where the state moves \[N m s/rad, ...\].
    pub damping: DMatrix<f64>,
    /// `K`: stiffness of springs, of weight, and of the multipliers by the second derivatives of the loops \[N m/rad, ...\].
    pub stiffness: DMatrix<f64>,
    /// `T`: all speeds by the independent ones (speeds x independent).
    pub tangent: DMatrix<f64>,
    /// Rates of the speeds at the state: zero at an equilibrium. Elsewhere the matrices are those of one instant.
    pub rates: Vec<f64>,
    /// Whether the state is at rest.
    still: bool,
}

/// Linearises about the closed state at time `t` \[s\]. With `u(z, z', z'')` the forces that a motion needs besides the loads that there
/// are, see [`inverse_dynamics`](super::inverse_dynamics()), loops and friction included,
///
/// `M = du/dz''`, `D = du/dz'`, `K = du/dz`,
///
/// by four-point differences; velocities and accelerations of the dependent joints follow `z`. Since `u = T^T r` and `T` changes with the
/// position, `K` holds the multipliers times the second derivatives of the loops. Coordinates with prescribed motion are held where they
/// are, and the state must then be at rest.
///
/// # Errors
/// [`AnalysisError`] for what does not fit; [`AnalysisError::Quaternion`] where the state moves and an independent speed is that of a
/// ball joint with a quaternion, which is the rate of no coordinate.
pub fn linearise(mechanism: &Mechanism, t: f64, state: &State) -> Result<Linearised, AnalysisError> {
    holding(mechanism, t, state, &[])
}

/// As [`linearise`], with more coordinates held where they are, by name; the state must then be at rest.
///
/// # Errors
/// As there, and for unknown names.
pub fn holding(mechanism: &Mechanism, t: f64, state: &State, held: &[String]) -> Result<Linearised, AnalysisError> {
    check(mechanism, &state.q, Some(&state.v))?;
    if !t.is_finite() {
        return Err(number("t", t, "a finite number"));
    }
    let system = mechanism.system();
    let mut balance = Balance::holding(mechanism, held)?;
    balance.choose(&state.q, &[])?;
    let still = state.v.iter().all(|v| *v == 0.0);
    let tree = system.tree();
    let quaternion = |speed: &&usize| {
        let mut joints = tree.joints().iter().map(|(link, _)| *link);
        joints.any(|link| {
            tree.speed_range(link).contains(speed) && tree.coordinate_range(link).len() != tree.speed_range(link).len()
        })
    };
    if let Some(&speed) = balance.independent.iter().find(quaternion)
        && !still
    {
        return Err(AnalysisError::Quaternion {
            coordinate: mechanism.speeds[speed].clone(),
        });
    }
    let independent = balance.independent.clone();
    let pick = |values: &[f64]| -> Vec<f64> { independent.iter().map(|&speed| values[speed]).collect() };
    let at = (t, state.q.as_slice());
    let accelerations = match balance.first_held() {
        None => {
            let mut work = Workspace::new(system);
            let evaluated = system.evaluate(t, &state.q, &state.v, &mut work);
            evaluated.map_err(|cause| mechanism.explain(cause))?;
            work.rates().to_vec()
        }
        Some(_) if still => balance.let_go(at)?,
        Some(name) => {
            let what = format!("coordinate `{name}` is held or has a prescribed motion, but the state moves");
            return Err(AnalysisError::Internals { what });
        }
    };
    let (rates, second) = (pick(&state.v), pick(&accelerations));
    let motion = (rates.as_slice(), second.as_slice());
    let tangent = balance.moving(t, &state.q, &rates, &second)?.tangent;
    let linearised = Linearised {
        mass: balance.mass(at, motion)?,
        damping: balance.slopes(By::Speed, at, motion, &tangent)?,
        stiffness: balance.slopes(By::Position, at, motion, &tangent)?,
        independent: balance.independent_names(),
        rates: accelerations,
        tangent,
        still,
    };
    let matrices = [&linearised.mass, &linearised.damping, &linearised.stiffness];
    if !matrices.iter().all(|matrix| matrix.iter().all(|x| x.is_finite())) {
        return Err(AnalysisError::Eigenvalues("a derivative of the forces is not finite"));
    }
    Ok(linearised)
}

impl Linearised {
    /// `A` of `x' = A x`, `x = (dz, dz')`.
    ///
    /// # Errors
    /// [`AnalysisError::Eigenvalues`] where the mass is singular.
    pub fn state_matrix(&self) -> Result<DMatrix<f64>, AnalysisError> {
        let n = self.independent.len();
        let factors = self.mass.clone().lu();
        let by_mass = |matrix: &DMatrix<f64>| {
            factors
                .solve(matrix)
                .ok_or(AnalysisError::Eigenvalues("a freedom moves no mass"))
        };
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        a.view_mut((0, n), (n, n)).fill_with_identity();
        a.view_mut((n, 0), (n, n)).copy_from(&-by_mass(&self.stiffness)?);
        a.view_mut((n, n), (n, n)).copy_from(&-by_mass(&self.damping)?);
        Ok(a)
    }

    /// Eigenvalues with their shapes, slowest first; of a complex pair the one with the positive imaginary part. Without damping, at rest
    /// and with a symmetric stiffness they are those of a symmetric matrix, and shapes are orthogonal in the mass.
    ///
    /// # Errors
    /// [`AnalysisError::Eigenvalues`] where the mass is singular or the solver does not converge.
    pub fn modes(&self) -> Result<Vec<Mode>, AnalysisError> {
        let (k, d) = (&self.stiffness, &self.damping);
        let size = (k.amax() * self.mass.amax()).sqrt();
        let symmetric = (k - k.transpose()).amax() <= NEGLIGIBLE * k.amax();
        if self.still && symmetric && d.amax() <= NEGLIGIBLE * size {
            undamped_modes(&self.mass, k, &self.tangent)
        } else {
            general_modes(&self.state_matrix()?, &self.tangent)
        }
    }
}

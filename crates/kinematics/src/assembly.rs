//! Assembly: positions that close the loops and velocities that keep them closed.

mod least_squares;

use crate::closure::Closure;
use crate::motion::{Positions, Velocities};
use crate::tree::Tree;
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

pub use least_squares::SingularValues;

/// What [`assemble`] may do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Largest residual of a closed loop \[m, -\].
    pub tolerance: f64,
    /// Newton steps to try.
    pub iterations: usize,
    /// Whether the result may lie on another branch than the guess; see [`Branch`].
    pub accept_other_branch: bool,
}

impl Default for Settings {
    /// 1e-14, a hundred steps, same branch only.
    fn default() -> Self {
        Self {
            tolerance: 1e-14,
            iterations: 100,
            accept_other_branch: false,
        }
    }
}

/// Assembly branch: the sign of the determinant of the closure gradient in the free speeds. Two positions of the same sign
/// may be joined without passing a singular position; positions of different sign may not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// Positive determinant.
    Positive,
    /// Negative determinant.
    Negative,
    /// The gradient has no full rank: branches meet here.
    Singular,
    /// The determinant does not exist: there are not as many free speeds as equations.
    Undefined,
}

/// A closed position.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// Coordinates.
    pub q: Vec<f64>,
    /// Largest residual left \[m, -\].
    pub residual: f64,
    /// Newton steps made.
    pub iterations: usize,
    /// Rank of the closure gradient in the free speeds.
    pub rank: usize,
    /// Number of closure equations.
    pub equations: usize,
    /// Branch of the closed position.
    pub branch: Branch,
}

/// Why no closed position, or no consistent velocities, were found.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AssemblyError {
    /// A slice has the wrong length.
    #[error("{what} has {found} entries, the tree needs {expected}")]
    Length {
        /// What was given.
        what: &'static str,
        /// Entries given.
        found: usize,
        /// Entries needed.
        expected: usize,
    },
    /// A number given is not finite.
    #[error("{what}[{index}] = {value} is not a finite number")]
    NotFinite {
        /// What was given.
        what: &'static str,
        /// Entry.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Newton's method came no closer: the loops cannot be closed from here with the held coordinates held.
    #[error(
        "loops do not close: residual {residual:e} after {iterations} steps, worst in equation {equation} of closure \
         {closure}; rank {rank} of {equations} equations. Give a better guess, hold less, or check the lengths"
    )]
    NotClosed {
        /// Smallest largest residual reached \[m, -\].
        residual: f64,
        /// Newton steps made.
        iterations: usize,
        /// Closure of the worst equation.
        closure: usize,
        /// Worst equation in that closure.
        equation: usize,
        /// Rank of the gradient there.
        rank: usize,
        /// Number of equations.
        equations: usize,
    },
    /// The closed position found lies on another branch than the guess.
    #[error(
        "the closed position lies on another branch ({found:?}) than the guess ({guess:?}); give a guess nearer to the wanted one or accept other branches"
    )]
    OtherBranch {
        /// Branch of the guess.
        guess: Branch,
        /// Branch found.
        found: Branch,
    },
    /// The held speeds cannot be had with closed loops.
    #[error(
        "held speeds contradict the loops: rate {rate:e} of equation {equation} of closure {closure} cannot be made zero (rank {rank} of {equations})"
    )]
    Velocities {
        /// Largest rate left \[m/s, 1/s\].
        rate: f64,
        /// Closure of the worst equation.
        closure: usize,
        /// Worst equation in that closure.
        equation: usize,
        /// Rank of the gradient.
        rank: usize,
        /// Number of equations.
        equations: usize,
    },
}

/// Longest Newton step \[rad, m\]: keeps a far guess from being thrown onto another branch.
const LONGEST_STEP: f64 = 0.3;

/// Number of equations of all closures.
pub fn equations(closures: &[Closure]) -> usize {
    closures.iter().map(Closure::equations).sum()
}

/// Residuals of all closures, one after the other \[m, -\].
pub fn residuals(closures: &[Closure], positions: &Positions, phi: &mut [f64]) {
    let mut first = 0;
    for closure in closures {
        closure.residual(positions, &mut phi[first..]);
        first += closure.equations();
    }
}

/// Rates of all closures, one after the other \[m/s, 1/s\].
pub fn rates(closures: &[Closure], positions: &Positions, velocities: &Velocities, rates: &mut [f64]) {
    let mut first = 0;
    for closure in closures {
        closure.rate(positions, velocities, &mut rates[first..]);
        first += closure.equations();
    }
}

/// Largest size of residuals or rates, in their unit; not a number if one of them is none.
pub fn largest(values: &[f64]) -> f64 {
    // Not a number is never less, and stays.
    values
        .iter()
        .fold(0.0, |s, x| if x.abs() <= s || s.is_nan() { s } else { x.abs() })
}

/// Gradient `G` of all closures (equations x speeds).
pub fn gradient(tree: &Tree, closures: &[Closure], positions: &Positions) -> DMatrix<f64> {
    let m = equations(closures);
    let mut transposed = vec![0.0; m * tree.speeds()];
    let mut first = 0;
    for closure in closures {
        closure.gradient(positions, |speed, equation, value| {
            transposed[speed * m + first + equation] = value;
        });
        first += closure.equations();
    }
    // Speed-major storage is the column-major form of G.
    DMatrix::from_vec(m, tree.speeds(), transposed)
}

/// Closes the loops by Newton's method from `guess`, moving only speeds that are not `held` (one flag a speed); the
/// shortest step where there are more free speeds than equations. Steps are shortened where they do not lead downhill.
///
/// # Errors
/// See [`AssemblyError`]; the guess is never returned as if it were closed.
pub fn assemble(
    tree: &Tree,
    closures: &[Closure],
    guess: &[f64],
    held: &[bool],
    settings: &Settings,
) -> Result<Assembly, AssemblyError> {
    check("guess", guess, tree.coordinates())?;
    check_length("held", held.len(), tree.speeds())?;
    let free: Vec<usize> = (0..tree.speeds()).filter(|&i| !held[i]).collect();
    let m = equations(closures);
    let mut q = guess.to_vec();
    tree.normalise(&mut q);
    check("guess with unit quaternions", &q, tree.coordinates())?;
    let mut positions = Positions::new(tree);
    let evaluate = |q: &[f64], positions: &mut Positions| {
        tree.positions(q, positions);
        let mut phi = DVector::zeros(m);
        residuals(closures, positions, phi.as_mut_slice());
        phi
    };

    let mut phi = evaluate(&q, &mut positions);
    let start = branch(&free_gradient(tree, closures, &positions, &free));
    let mut iterations = 0;
    let mut length = 1.0;
    while phi.amax() > settings.tolerance && iterations < settings.iterations && length > 1e-6 {
        iterations += 1;
        let step = SingularValues::new(&free_gradient(tree, closures, &positions, &free)).solve(&phi);
        length = (LONGEST_STEP / step.amax()).min(1.0);
        loop {
            let mut displacement = vec![0.0; tree.speeds()];
            for (k, &i) in free.iter().enumerate() {
                displacement[i] = -length * step[k];
            }
            let mut trial = q.clone();
            tree.displace(&mut trial, &displacement);
            let phi_trial = evaluate(&trial, &mut positions);
            // At rounding level the residual may wander: one further full step is taken and kept if it is no worse.
            if phi_trial.norm() < phi.norm() {
                q = trial;
                phi = phi_trial;
                break;
            }
            length *= 0.5;
            if length <= 1e-6 {
                evaluate(&q, &mut positions);
                break;
            }
        }
    }

    let g = free_gradient(tree, closures, &positions, &free);
    let rank = SingularValues::new(&g).rank();
    let residual = if m == 0 { 0.0 } else { phi.amax() };
    // A residual that Newton cannot lower and that is rounding of the lengths involved is closed.
    let rounding = 16.0 * f64::EPSILON * positions.0.iter().map(|n| n.origin.amax()).fold(1.0, f64::max);
    if residual.is_nan() || residual > settings.tolerance.max(rounding) {
        let (closure, equation) = locate(closures, phi.iamax());
        return Err(AssemblyError::NotClosed {
            residual,
            iterations,
            closure,
            equation,
            rank,
            equations: m,
        });
    }
    let found = branch(&g);
    let opposite = matches!(
        (start, found),
        (Branch::Positive, Branch::Negative) | (Branch::Negative, Branch::Positive)
    );
    if opposite && !settings.accept_other_branch {
        return Err(AssemblyError::OtherBranch { guess: start, found });
    }
    Ok(Assembly {
        q,
        residual,
        iterations,
        rank,
        equations: m,
        branch: found,
    })
}

/// Speeds that keep the loops closed, nearest to `guess`, with the `held` speeds as given.
///
/// # Errors
/// [`AssemblyError::Velocities`] when the held speeds contradict the loops.
pub fn consistent_velocities(
    tree: &Tree,
    closures: &[Closure],
    q: &[f64],
    guess: &[f64],
    held: &[bool],
) -> Result<Vec<f64>, AssemblyError> {
    check("q", q, tree.coordinates())?;
    check("v", guess, tree.speeds())?;
    check_length("held", held.len(), tree.speeds())?;
    let free: Vec<usize> = (0..tree.speeds()).filter(|&i| !held[i]).collect();
    let m = equations(closures);
    let mut v = guess.to_vec();
    if m == 0 {
        return Ok(v);
    }
    let mut positions = Positions::new(tree);
    tree.positions(q, &mut positions);
    let g = gradient(tree, closures, &positions);
    let factors = SingularValues::new(&free_gradient(tree, closures, &positions, &free));
    let mut rate = &g * DVector::from_column_slice(&v);
    let scale = v.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
    for _ in 0..2 {
        let step = factors.solve(&rate);
        for (k, &i) in free.iter().enumerate() {
            v[i] -= step[k];
        }
        rate = &g * DVector::from_column_slice(&v);
    }
    if rate.amax().is_nan() || rate.amax() > 1e-12 * scale {
        let (closure, equation) = locate(closures, rate.iamax());
        return Err(AssemblyError::Velocities {
            rate: rate.amax(),
            closure,
            equation,
            rank: factors.rank(),
            equations: m,
        });
    }
    Ok(v)
}

fn check(what: &'static str, values: &[f64], expected: usize) -> Result<(), AssemblyError> {
    check_length(what, values.len(), expected)?;
    match values.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(index) => Err(AssemblyError::NotFinite {
            what,
            index,
            value: values[index],
        }),
    }
}

fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), AssemblyError> {
    if found == expected {
        Ok(())
    } else {
        Err(AssemblyError::Length { what, found, expected })
    }
}

/// Closure and equation in it of an entry of the stacked residual.
fn locate(closures: &[Closure], mut entry: usize) -> (usize, usize) {
    for (k, closure) in closures.iter().enumerate() {
        if entry < closure.equations() {
            return (k, entry);
        }
        entry -= closure.equations();
    }
    (closures.len(), entry)
}

fn free_gradient(tree: &Tree, closures: &[Closure], positions: &Positions, free: &[usize]) -> DMatrix<f64> {
    gradient(tree, closures, positions).select_columns(free)
}

fn branch(g: &DMatrix<f64>) -> Branch {
    if g.nrows() != g.ncols() || g.is_empty() {
        return Branch::Undefined;
    }
    if SingularValues::new(g).rank() < g.nrows() {
        return Branch::Singular;
    }
    if g.determinant() > 0.0 {
        Branch::Positive
    } else {
        Branch::Negative
    }
}

#[cfg(test)]
mod tests {
    use super::largest;

    #[test]
    fn what_is_no_number_is_the_largest() {
        assert_eq!(largest(&[]), 0.0);
        assert_eq!(largest(&[1.0, -3.0, 2.0]), 3.0);
        assert!(largest(&[f64::NAN, 1.0]).is_nan() && largest(&[1.0, f64::NAN]).is_nan());
    }
}

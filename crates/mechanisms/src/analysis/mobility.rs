//! Mobility: how much can move, and which equations of the loops say nothing new.

use super::balance::{check, number};
use super::elimination::Elimination;
use super::error::AnalysisError;
use crate::mechanism::Mechanism;
use linkdyn_kinematics::Positions;
use linkdyn_kinematics::assembly::{self, Settings};
use nalgebra::DMatrix;
use std::fmt;

/// How far a freedom is moved to see whether it lasts \[rad, m\]: far enough that a mechanism which only shakes cannot be closed, near
/// enough for Newton's method.
const EXCURSION: f64 = 0.05;
/// How far all coordinates are displaced, loops left open, for the count that does not know the dimensions \[rad, m\].
const DISPLACEMENT: f64 = 0.3;
/// How many such displacements.
const DISPLACEMENTS: usize = 3;
/// A share in a combination of rows below this is rounding.
const ROUNDING: f64 = 1e-9;

/// An equation of a cut joint by name; it reads `CUT.COMPONENT`, the component being that of the multiplier in result files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoopRow {
    /// The cut joint.
    pub cut: String,
    /// Its component: `fx`, `fy`, `fz`, `f1`... for offsets, `n1`... for angles.
    pub component: String,
}

impl fmt::Display for LoopRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.cut, self.component)
    }
}

/// A row that is a combination of others.
#[derive(Clone, Debug, PartialEq)]
pub struct Redundant {
    /// The row.
    pub row: LoopRow,
    /// Independent rows with their factors; none where nothing moves the row at all.
    pub combination: Vec<(LoopRow, f64)>,
    /// What is left of the row beside the combination, largest entry over the first pivot of the elimination \[-\].
    pub measure: f64,
}

/// What can move at a position, and near it.
#[derive(Clone, Debug, PartialEq)]
pub struct Mobility {
    /// Speeds of the tree.
    pub speeds: usize,
    /// Equations of all loops.
    pub equations: usize,
    /// Independent ones among them at this position.
    pub rank: usize,
    /// Speeds less equations, the count of Grübler and Kutzbach: what would be left if no equation were redundant.
    pub counted: isize,
    /// Speeds less rank: **instantaneous** mobility, the dimension of the velocities that the loops allow here.
    pub freedoms: usize,
    /// **Finite** mobility: the largest instantaneous one at closed positions nearby, reached by moving one independent coordinate
    /// after the other by 0.05 rad or m; zero where none can be reached. It is smaller than `freedoms` at dead centres and where
    /// branches meet, and for a structure that only shakes.
    pub finite: usize,
    /// Speeds less rank with the loops opened by moving all coordinates: what other dimensions of the same joints would have. It is
    /// smaller than `finite` where mobility rests on the dimensions, as with Bennett's and Bricard's loops; a planar loop stays planar.
    pub general: usize,
    /// Prescribed motions.
    pub prescribed: usize,
    /// What is left of `freedoms` to forces while the prescribed motions are followed. Where `freedoms` less `prescribed` is smaller, the
    /// loops tie motions to each other that are all prescribed.
    pub left: usize,
    /// A choice of independent speeds at this position, as many as `freedoms`.
    pub independent: Vec<String>,
    /// Rows that depend on others. Which rows of a dependent set are named is a matter of pivots; the combinations tell the set.
    pub redundant: Vec<Redundant>,
    /// Smallest pivot of the independent rows over the first \[-\]: near zero at a singular position.
    pub weakest: f64,
    /// Largest entry that counts as zero over the first pivot \[-\]: the rank is certain where this is far below `weakest`.
    pub rest: f64,
}

/// Mobility at the closed position `q`. Ranks are those of the closure gradient `G` (equations x speeds) by elimination with complete
/// pivoting, pivots below 1e-9 of the first counting as zero. Joints with clearance count by the equations that they keep.
///
/// # Errors
/// [`AnalysisError`] where `q` does not fit or leaves the loops open.
pub fn mobility(mechanism: &Mechanism, q: &[f64]) -> Result<Mobility, AnalysisError> {
    check(mechanism, q, None)?;
    let system = mechanism.system();
    let (tree, closures) = (system.tree(), system.closures());
    let mut positions = Positions::new(tree);
    let mut gradient = |q: &[f64]| {
        tree.positions(q, &mut positions);
        assembly::gradient(tree, closures, &positions)
    };
    let rank = |g: DMatrix<f64>| Elimination::new(g, |_, _| true).rank();
    let here = gradient(q);
    let (m, n) = here.shape();
    let chosen = Elimination::new(here.clone(), |_, _| true);
    let independent = chosen.free(n);

    let mut finite = 0;
    for &speed in &independent {
        let mut held = vec![false; n];
        held[speed] = true;
        for side in [EXCURSION, -EXCURSION] {
            let mut step = vec![0.0; n];
            step[speed] = side;
            let mut guess = q.to_vec();
            tree.displace(&mut guess, &step);
            let settings = Settings {
                accept_other_branch: true,
                ..Settings::default()
            };
            if let Ok(closed) = assembly::assemble(tree, closures, &guess, &held, &settings) {
                finite = finite.max(n - rank(gradient(&closed.q)));
            }
        }
    }

    let mut most = 0;
    for k in 1..=DISPLACEMENTS {
        // Displacements without any order: multiples of the golden ratio.
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let step: Vec<f64> = (1..=n)
            .map(|i| DISPLACEMENT * (2.0 * ((k * n + i) as f64 * golden).fract() - 1.0))
            .collect();
        let mut opened = q.to_vec();
        tree.displace(&mut opened, &step);
        most = most.max(rank(gradient(&opened)));
    }

    let mut followed = vec![false; n];
    for guided in system.guided() {
        followed[guided.speed] = true;
    }
    let prescribed = system.guided().len();
    // Where speeds are given, their columns say nothing about the others.
    let others = Elimination::new(here.clone(), |_, speed| !followed[speed]).rank();

    let smallest = [chosen.weakest, chosen.rest];
    if let Some(value) = smallest.iter().find(|x| !x.is_finite()) {
        return Err(number("a pivot of the closure gradient", *value, "a finite number"));
    }
    Ok(Mobility {
        speeds: n,
        equations: m,
        rank: chosen.rank(),
        counted: n as isize - m as isize,
        freedoms: n - chosen.rank(),
        finite,
        general: n - most,
        prescribed,
        left: n - prescribed - others,
        independent: independent
            .iter()
            .map(|&speed| mechanism.speeds[speed].clone())
            .collect(),
        redundant: redundant(&here, &chosen, &row_names(mechanism)),
        weakest: chosen.weakest,
        rest: chosen.rest,
    })
}

/// Names of all equations, in their order.
fn row_names(mechanism: &Mechanism) -> Vec<LoopRow> {
    let rows = |cut: &crate::mechanism::NamedLoop| {
        let name = cut.name.clone();
        let components = cut.components.clone().into_iter();
        components.map(move |component| LoopRow {
            cut: name.clone(),
            component,
        })
    };
    mechanism.loops.iter().flat_map(rows).collect()
}

/// The rows without a pivot as combinations of those with one.
fn redundant(gradient: &DMatrix<f64>, chosen: &Elimination, names: &[LoopRow]) -> Vec<Redundant> {
    let kept: Vec<usize> = chosen.pivots.iter().map(|&(row, _)| row).collect();
    let others: Vec<usize> = (0..gradient.nrows()).filter(|row| !kept.contains(row)).collect();
    // Relations between rows are the kernel of the transposed matrix.
    let relations =
        Elimination::new(gradient.transpose(), |_, row| kept.contains(&row)).kernel(gradient.nrows(), &others);
    let one = |(k, &row): (usize, &usize)| {
        let mut left = gradient.row(row).into_owned();
        let mut combination = Vec::new();
        for &other in &kept {
            let factor = -relations[(other, k)];
            left -= gradient.row(other) * factor;
            if factor.abs() > ROUNDING {
                combination.push((names[other].clone(), factor));
            }
        }
        let scale = if chosen.scale > 0.0 { chosen.scale } else { 1.0 };
        Redundant {
            row: names[row].clone(),
            combination,
            measure: left.amax() / scale,
        }
    };
    others.iter().enumerate().map(one).collect()
}

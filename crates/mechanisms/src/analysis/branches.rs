//! Assembly with all branches that a search finds.

use super::balance::number;
use super::error::AnalysisError;
use crate::mechanism::{Mechanism, Start};
use linkdyn_kinematics::assembly::{self, Branch, Settings};
use linkdyn_kinematics::{Closure, Freedom, Joint, Pose, Positions};
use std::f64::consts::PI;

/// Entries of rotation matrices, and lengths over the mechanism's size, closer than this are the same: Newton's method leaves 1e-14,
/// times the condition.
const SAME: f64 = 1e-6;

/// How to search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// Guesses to start from.
    pub guesses: usize,
    /// Shifts the sequence of guesses; equal seeds give equal searches.
    pub seed: u64,
    /// Slides are guessed between minus and plus this \[m\]; none for the sum of all lengths in the mechanism.
    pub reach: Option<f64>,
}

impl Default for Search {
    /// 200 guesses, seed 0.
    fn default() -> Self {
        Self {
            guesses: 200,
            seed: 0,
            reach: None,
        }
    }
}

/// A closed position.
#[derive(Clone, Debug, PartialEq)]
pub struct Closed {
    /// Coordinates; turns that are not held between -pi and pi.
    pub q: Vec<f64>,
    /// Largest residual left \[m, -\].
    pub residual: f64,
    /// Its branch; undefined where equations are redundant.
    pub branch: Branch,
    /// Guesses that led here.
    pub hits: usize,
}

/// What a [`Search`] found.
#[derive(Clone, Debug, PartialEq)]
pub struct Branches {
    /// Different positions, in the order in which they were found. Two are the same where all links lie at the same places, whatever
    /// turns of 2 pi and signs of quaternions their coordinates differ in.
    pub positions: Vec<Closed>,
    /// Guesses from which no closed position was found.
    pub lost: usize,
    /// Guesses that led to positions at which a cut joint is put together the wrong way round: its equations ask for right angles, and are
    /// fulfilled by an axis that points backwards too. These are no positions of the mechanism.
    pub reversed: usize,
    /// Closed positions found only once: where there are many, more guesses would find more.
    pub singles: usize,
}

/// Closes the loops from many guesses, with what `start` holds held at its values, and prescribed coordinates where they are at t = 0; all
/// else in it is ignored. Guesses are a Kronecker
/// sequence with the powers of the root of `x^(d+1) = x + 1` in d dimensions, which fills the box of all turns and slides evenly.
/// A search proves nothing about positions that it did not find.
///
/// # Errors
/// [`AnalysisError::Undetermined`] where the positions found are not isolated because too little is held, and for unknown names.
pub fn branches(mechanism: &Mechanism, start: &Start, search: &Search) -> Result<Branches, AnalysisError> {
    let tree = mechanism.system().tree();
    if search.guesses == 0 {
        return Err(number("guesses", 0.0, "at least 1"));
    }
    if let Some(reach) = search.reach.filter(|reach| !(reach.is_finite() && *reach > 0.0)) {
        return Err(number("reach", reach, "a finite positive number"));
    }
    let mut base = tree.neutral();
    for (name, value) in &start.positions {
        base[mechanism.index(name)?] = *value;
    }
    let mut held = mechanism.held(&start.held)?;
    mechanism.follow_prescribed(0.0, &mut base, &mut held);
    let size = size(mechanism);
    let reach = search.reach.unwrap_or(size);
    let free: Vec<usize> = (0..tree.speeds()).filter(|&speed| !held[speed]).collect();
    let mut sequence = Sequence::new(free.len(), search.seed);
    let settings = Settings {
        accept_other_branch: true,
        ..Settings::default()
    };
    let mut places = Positions::new(tree);
    let mut found: Vec<(Closed, Vec<Pose>)> = Vec::new();
    let (mut lost, mut reversed, mut isolated) = (0, 0, false);
    for _ in 0..search.guesses {
        let guess = guess(mechanism, &base, &held, sequence.next(), reach);
        let Ok(closed) = assembly::assemble(tree, &mechanism.centred, &guess, &held, &settings) else {
            lost += 1;
            continue;
        };
        tree.positions(&closed.q, &mut places);
        if !mechanism.centred.iter().all(|cut| cut.is_upright(&places)) {
            reversed += 1;
            continue;
        }
        isolated |= closed.rank == free.len();
        let poses: Vec<Pose> = tree.joints().iter().map(|(link, _)| places.pose(*link)).collect();
        if let Some((known, _)) = found.iter_mut().find(|(_, known)| same(known, &poses, size)) {
            known.hits += 1;
            continue;
        }
        let mut q = closed.q;
        for &speed in &free {
            if let Some(turn) = turn(mechanism, speed) {
                q[turn] = PI - (PI - q[turn]).rem_euclid(2.0 * PI);
            }
        }
        let closed = Closed {
            q,
            residual: closed.residual,
            branch: closed.branch,
            hits: 1,
        };
        found.push((closed, poses));
    }
    if !found.is_empty() && !isolated {
        let names = |wanted: bool| {
            let speeds = (0..held.len()).filter(|speed| held[*speed] == wanted && !mechanism.loose.contains(speed));
            speeds
                .map(|speed| format!("`{}`", mechanism.speeds[speed]))
                .collect::<Vec<_>>()
                .join(", ")
        };
        let driven = Some(names(true)).filter(|names| !names.is_empty());
        let driven = driven.unwrap_or_else(|| "nothing".to_owned());
        return Err(AnalysisError::Undetermined {
            driven,
            free: names(false),
        });
    }
    let positions: Vec<Closed> = found.into_iter().map(|(closed, _)| closed).collect();
    Ok(Branches {
        singles: positions.iter().filter(|closed| closed.hits == 1).count(),
        positions,
        lost,
        reversed,
    })
}

/// Index of the coordinate of a turn; none for slides and ball joints with quaternions.
fn turn(mechanism: &Mechanism, speed: usize) -> Option<usize> {
    let tree = mechanism.system().tree();
    let turns = |node: &&linkdyn_kinematics::Node| node.freedom != Freedom::None && node.speed == speed;
    let turns = tree.nodes().iter().find(turns)?.freedom == Freedom::Angular;
    (turns && !is_ball(mechanism, speed)).then(|| mechanism.coordinate_of_speed(speed))?
}

fn is_ball(mechanism: &Mechanism, speed: usize) -> bool {
    let tree = mechanism.system().tree();
    let mut joints = tree.joints().iter();
    joints.any(|(link, joint)| *joint == Joint::Spherical && tree.speed_range(*link).contains(&speed))
}

/// A guess from numbers between 0 and 1, one for each free speed.
fn guess(mechanism: &Mechanism, base: &[f64], held: &[bool], numbers: &[f64], reach: f64) -> Vec<f64> {
    let tree = mechanism.system().tree();
    let (mut q, mut step) = (base.to_vec(), vec![0.0; held.len()]);
    let mut numbers = numbers.iter();
    for (speed, free) in held.iter().map(|held| !held).enumerate() {
        let Some(x) = free.then(|| numbers.next()).flatten() else {
            continue;
        };
        let place = mechanism.coordinate_of_speed(speed);
        match (turn(mechanism, speed), place) {
            (Some(turn), _) => q[turn] = PI * (2.0 * x - 1.0),
            // Turns about three axes one after the other reach every orientation; they need not do so evenly.
            _ if is_ball(mechanism, speed) => step[speed] = PI * (2.0 * x - 1.0),
            (None, Some(slide)) => q[slide] = reach * (2.0 * x - 1.0),
            (None, None) => {}
        }
    }
    tree.displace(&mut q, &step);
    q
}

/// Sum of all lengths between joints at zero coordinates \[m\], at least 1e-3.
fn size(mechanism: &Mechanism) -> f64 {
    let tree = mechanism.system().tree();
    let mut positions = Positions::new(tree);
    tree.positions(&tree.neutral(), &mut positions);
    let arms: f64 = positions.nodes().iter().map(|node| node.arm.norm()).sum();
    let ends = |cut: &Closure| cut.predecessor().pose.origin.norm() + cut.successor().pose.origin.norm();
    (arms + mechanism.centred.iter().map(ends).sum::<f64>()).max(1e-3)
}

fn same(a: &[Pose], b: &[Pose], size: f64) -> bool {
    let near = |(a, b): (&Pose, &Pose)| {
        (a.rotation - b.rotation).amax() <= SAME && (a.origin - b.origin).amax() <= SAME * size
    };
    a.iter().zip(b).all(near)
}

/// Points of a Kronecker sequence in the unit box.
struct Sequence {
    steps: Vec<f64>,
    point: Vec<f64>,
}

impl Sequence {
    fn new(dimensions: usize, seed: u64) -> Self {
        let mut root = 1.5_f64;
        for _ in 0..64 {
            root = (1.0 + root).powf(1.0 / (dimensions as f64 + 1.0));
        }
        let steps: Vec<f64> = (1..=dimensions).map(|k| root.powi(-(k as i32)).fract()).collect();
        // Shifts by multiples of the golden ratio, one number for each dimension and seed.
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let shift = |k: usize| (0.5 + golden * (seed % (1 << 32)) as f64 * (k + 1) as f64).fract();
        Self {
            point: (0..dimensions).map(shift).collect(),
            steps,
        }
    }

    fn next(&mut self) -> &[f64] {
        for (x, step) in self.point.iter_mut().zip(&self.steps) {
            *x = (*x + step).fract();
        }
        &self.point
    }
}

//! Inverse dynamics: the drives that a prescribed motion needs, and the reactions that come with it.

use super::balance::{Balance, check, driven, number};
use super::error::AnalysisError;
use crate::mechanism::Mechanism;
use linkdyn_dynamics::Reaction;
use linkdyn_kinematics::Wrench;

/// Motion prescribed for one coordinate at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescribed {
    /// Name of the coordinate.
    pub coordinate: String,
    /// Its speed \[rad/s, m/s\].
    pub speed: f64,
    /// The rate of that \[rad/s^2, m/s^2\].
    pub acceleration: f64,
}

/// What a prescribed motion needs at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Needs {
    /// Torques \[N m\] or forces \[N\] on the driven coordinates, in their order, besides all loads that the mechanism has.
    pub drives: Vec<f64>,
    /// Speeds.
    pub v: Vec<f64>,
    /// Rates of the speeds.
    pub a: Vec<f64>,
    /// Multipliers of all loops, those of smallest norm where equations are redundant, as in forward dynamics; then zero for each
    /// prescribed motion of the mechanism.
    pub multipliers: Vec<f64>,
    /// Friction torques or forces of the joints with friction, with the sign of the speed that they oppose.
    pub friction: Vec<f64>,
    /// Reactions on the successor of each joint at the joint's origin, in axes of the successor link.
    pub reactions: Vec<Reaction>,
    /// Power of the drives \[W\].
    pub power: f64,
}

/// Drives and reactions at time `t` \[s\] and the closed position `q` for a motion of the `prescribed` coordinates, which must be as many
/// as there are freedoms. With the tangent `T` of the loops in these coordinates
///
/// `u = T^T (M v' - f - F tau)`, and `G^T lambda = M v' - f - F tau - E u`:
///
/// the principle of virtual power. Friction `tau` depends on the reactions, these on `lambda`, and `lambda` on friction: that loop is
/// solved by Newton's method.
///
/// Motions that the mechanism itself prescribes are left out: name their coordinates among the `prescribed` ones to have their drives.
///
/// # Errors
/// [`AnalysisError`] for names and numbers that do not fit, where the prescribed coordinates do not determine the motion, and where
/// friction finds no solution.
pub fn inverse_dynamics(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    prescribed: &[Prescribed],
) -> Result<Needs, AnalysisError> {
    check(mechanism, q, None)?;
    if !t.is_finite() {
        return Err(number("t", t, "a finite number"));
    }
    if prescribed.is_empty() {
        return Err(number("prescribed coordinates", 0.0, "at least 1"));
    }
    let mut speeds = Vec::new();
    for one in prescribed {
        for (what, value) in [("speed", one.speed), ("acceleration", one.acceleration)] {
            if !value.is_finite() {
                return Err(number(
                    format!("{what} of `{}`", one.coordinate),
                    value,
                    "a finite number",
                ));
            }
        }
        let (_, speed) = driven(mechanism, &one.coordinate)?;
        if speeds.contains(&speed) {
            return Err(number(
                format!("times that `{}` is prescribed", one.coordinate),
                2.0,
                "1",
            ));
        }
        speeds.push(speed);
    }
    let mut balance = Balance::new(mechanism)?;
    balance.choose(q, &speeds)?;
    let (rates, second): (Vec<f64>, Vec<f64>) = prescribed.iter().map(|one| (one.speed, one.acceleration)).unzip();
    let moving = balance.moving(t, q, &rates, &second)?;
    let needed = balance.needed(&moving)?;
    let (system, work) = (mechanism.system(), &mut balance.work);
    system.reactions_for(moving.a.as_slice(), needed.multipliers.as_slice(), work);
    let reactions = mechanism.joints.iter().map(|joint| {
        let reaction = system.reaction(joint.link, work);
        let to_link = joint.to_link.rotation;
        Wrench {
            torque: to_link.tr_mul(&reaction.torque),
            force: to_link.tr_mul(&reaction.force),
        }
    });
    Ok(Needs {
        reactions: reactions.collect(),
        power: needed
            .forces
            .iter()
            .zip(&rates)
            .map(|(force, speed)| force * speed)
            .sum(),
        drives: needed.forces.as_slice().to_vec(),
        v: moving.v.as_slice().to_vec(),
        a: moving.a.as_slice().to_vec(),
        multipliers: needed.multipliers.as_slice().to_vec(),
        friction: needed.friction.iter().map(|force| -force).collect(),
    })
}

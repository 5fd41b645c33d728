//! Friction of a scene file's joints: its format, and how it is read.

use super::fault::Faults;
use super::format::Kind;
use linkdyn_friction::{
    Bearing, BearingModel, Characteristic, Cubic, Exponential, Friction, HyperbolicTangent, JournalBearing, PadGuide,
    PiecewiseLinear, Stribeck, Sum, Viscous,
};
use schemars::JsonSchema;
use serde::Deserialize;

/// Friction of a revolute or prismatic joint: laws over its speed, which add up, and the bearing that turns its reaction into friction.
/// Speeds are those of the joint \[rad/s, m/s\].
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionItem {
    /// Rises to the full coefficient by `1 - exp(-steepness |v|/reference_speed)`; none of it unless given.
    pub exponential: Option<Exponential>,
    /// Straight through zero up to the reference speed, then full; none of it unless given.
    pub piecewise_linear: Option<PiecewiseLinear>,
    /// `tanh(v/reference_speed)`; none of it unless given.
    pub hyperbolic_tangent: Option<HyperbolicTangent>,
    /// One cubic arc up to the reference speed, then full; none of it unless given.
    pub cubic: Option<Cubic>,
    /// A static peak above the full coefficient; none of it unless given.
    pub stribeck: Option<Stribeck>,
    /// In proportion to the speed; none of it unless given.
    pub viscous: Option<Viscous>,
    /// The bearing, where the joint is revolute: two journals and a face.
    pub journal: Option<JournalBearing>,
    /// The guide, where the joint is prismatic: two pads and a key.
    pub pad_guide: Option<PadGuide>,
}

/// The laws and the bearing of a joint's friction. `kind` is that of the joint, if it is known.
pub(super) fn read(
    name: &str,
    kind: Option<Kind>,
    item: &FrictionItem,
    faults: &mut Faults<'_>,
) -> Option<(Friction, Bearing)> {
    let keys = ["joints", name, "friction"];
    let laws: [(&str, Option<Friction>); 6] = [
        ("exponential", item.exponential.map(Into::into)),
        ("piecewise_linear", item.piecewise_linear.map(Into::into)),
        ("hyperbolic_tangent", item.hyperbolic_tangent.map(Into::into)),
        ("cubic", item.cubic.map(Into::into)),
        ("stribeck", item.stribeck.map(Into::into)),
        ("viscous", item.viscous.map(Into::into)),
    ];
    let given = laws.into_iter().filter_map(|(key, law)| Some((key, law?)));
    let mut sum: Option<Friction> = None;
    for (key, law) in given {
        if let Err(error) = law.validate() {
            faults.add(&[&keys[..], &[key]].concat(), error.to_string());
        }
        sum = Some(match sum {
            None => law,
            Some(first) => Sum { first, second: law }.into(),
        });
    }
    if sum.is_none() {
        let message =
            "needs a law: `exponential`, `piecewise_linear`, `hyperbolic_tangent`, `cubic`, `stribeck` or `viscous`";
        faults.add(&keys, message);
    }
    let bearings: [(&str, Kind, Option<Bearing>); 2] = [
        ("journal", Kind::Revolute, item.journal.map(Into::into)),
        ("pad_guide", Kind::Prismatic, item.pad_guide.map(Into::into)),
    ];
    let mut given = bearings
        .into_iter()
        .filter_map(|(key, kind, bearing)| Some((key, kind, bearing?)));
    let (Some((key, of, bearing)), None) = (given.next(), given.next()) else {
        faults.add(
            &keys,
            "needs one bearing: `journal` for a revolute joint, `pad_guide` for a prismatic one",
        );
        return None;
    };
    let keys = [&keys[..], &[key]].concat();
    if let Err(error) = bearing.validate() {
        faults.add(&keys, error.to_string());
    }
    if kind.is_some_and(|kind| kind != of) {
        faults.add(
            &keys,
            "goes with joints of another kind: `journal` with revolute, `pad_guide` with prismatic ones",
        );
    }
    Some((sum?, bearing))
}

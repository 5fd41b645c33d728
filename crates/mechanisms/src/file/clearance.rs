//! Clearance of a scene file's joints: its format, and how it is read.

use super::contact::ContactItem;
use super::fault::Faults;
use super::format::Kind;
use super::joints::any_of_kind;
use crate::clearance::{Clearance, ClearanceModel, Side};
use crate::outline;
use linkdyn_contact::{Fit, ForcePoint};
use linkdyn_friction::{Bristle, BristleModel, BristleStart, ElastoPlastic, LuGre};
use schemars::JsonSchema;
use serde::Deserialize;

/// Clearance of a revolute joint, a journal (pin) in a larger bearing (hole), or of a ball joint, a ball in a larger socket.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClearanceItem {
    /// Radius of the hole or the socket \[m\].
    pub bearing_radius: f64,
    /// Radius of the pin or the ball \[m\], below that of the hole.
    pub journal_radius: f64,
    /// Which side has the hole; the predecessor unless given.
    #[serde(default = "predecessor")]
    pub bearing: Side,
    /// Length of the bearing of a revolute joint \[m\], in which the pin may then tilt, with contact at both edges. Unless given the axes
    /// stay parallel and nothing moves along them.
    pub length: Option<f64>,
    /// Normal force over penetration and its rate.
    pub contact: ContactItem,
    /// Friction over sliding speed; none unless given.
    pub friction: Option<BristleItem>,
    /// How deflected the bristle is when a contact is made; relaxed unless given.
    #[serde(default)]
    pub bristle_start: BristleStart,
    /// Where the forces act; on both parts at one common point unless given.
    #[serde(default)]
    pub force_point: ForcePoint,
}

fn predecessor() -> Side {
    Side::Predecessor
}

/// A bristle model of friction.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum BristleItem {
    /// LuGre, with or without a guard.
    Lugre(LuGre),
    /// LuGre without drift under loads that do not break away.
    ElastoPlastic(ElastoPlastic),
    /// Dahl: no damping of the bristle, no static peak.
    Dahl {
        /// Coefficient of friction \[-\].
        coefficient: f64,
        /// Bristle stiffness \[1/m\].
        bristle_stiffness: f64,
    },
}

impl ClearanceItem {
    /// How the journal may move in a joint of a kind, if the joint may have clearance.
    pub(super) fn model(&self, kind: Kind) -> Option<ClearanceModel> {
        match (kind, self.length) {
            (Kind::Revolute, None) => Some(ClearanceModel::Planar),
            (Kind::Revolute, Some(length)) => Some(ClearanceModel::Spatial { length }),
            (Kind::Spherical | Kind::SphericalZyx, _) => Some(ClearanceModel::Spherical),
            _ => None,
        }
    }
}

/// The clearance of the joint `name`, whose kind is given if it is known; none where it cannot be.
pub(super) fn read(name: &str, kind: Option<Kind>, item: &ClearanceItem, faults: &mut Faults<'_>) -> Option<Clearance> {
    let key = |key| ["joints", name, "clearance", key];
    let fit = Fit::new(item.bearing_radius, item.journal_radius);
    let fit = fit
        .map_err(|error| faults.add(&key(error.field), error.to_string()))
        .ok();
    // Without a fit, what is wrong with the radii is told already.
    let law = fit.and_then(|fit| {
        let law = item.contact.law(Some(fit));
        law.map_err(|message| faults.add(&key("contact"), message)).ok()
    });
    let friction = item.friction.as_ref().map(|friction| match *friction {
        BristleItem::Lugre(lugre) => lugre.into(),
        BristleItem::ElastoPlastic(model) => model.into(),
        BristleItem::Dahl {
            coefficient,
            bristle_stiffness,
        } => LuGre::dahl(coefficient, bristle_stiffness).into(),
    });
    if let Some(Err(error)) = friction.as_ref().map(Bristle::validate) {
        faults.add(&key("friction"), error.to_string());
    }
    if let Some(length) = item.length.filter(|length| !(length.is_finite() && *length > 0.0)) {
        faults.add(&key("length"), format!("{length} m must be a finite positive number"));
    }
    let kind = kind?;
    let model = item.model(kind);
    match model {
        None => {
            let kind = outline::kind(&any_of_kind(kind));
            let message = format!("goes with `revolute`, `spherical` and `spherical_zyx` joints; this one is {kind}");
            faults.add(&["joints", name, "clearance"], message);
        }
        Some(ClearanceModel::Spherical) if item.length.is_some() => {
            let message = "goes with the bearing of a revolute joint; a ball has none, so leave it out";
            faults.add(&key("length"), message);
        }
        Some(_) => {}
    }
    Some(Clearance {
        fit: fit?,
        bearing: item.bearing,
        model: model?,
        law: law?,
        friction,
        bristle_start: item.bristle_start,
        force_point: item.force_point,
    })
}

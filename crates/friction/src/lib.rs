#![doc = include_str!("../README.md")]

mod bearing;
mod bristle;
mod characteristic;
mod parameter;

pub use bearing::{Bearing, BearingModel, Capacity, JournalBearing, PadGuide, Supports, Surface};
pub use bristle::{
    Bristle, BristleModel, BristlePoint, BristleStart, ElastoPlastic, Guard, LuGre, Partials, PlanarBristlePoint,
};
pub use characteristic::{
    Characteristic, Cubic, Exponential, Friction, HyperbolicTangent, PiecewiseLinear, Stribeck, Sum, Value, Viscous,
};
pub use parameter::{Expected, ParameterError};

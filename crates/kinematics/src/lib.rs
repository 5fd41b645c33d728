#![doc = include_str!("../README.md")]

pub mod assembly;
mod closure;
mod derivatives;
pub mod dh;
mod jacobian;
mod joint;
mod motion;
pub mod notation;
mod pose;
mod spatial;
mod tree;
mod turned;
mod upright;

pub use closure::{Attachment, Closure, Ends, Row};
pub use derivatives::Transforms;
pub use joint::Joint;
pub use motion::{Accelerations, NodePosition, Positions, Velocities};
pub use pose::Pose;
pub use spatial::{Twist, Wrench};
pub use tree::{Freedom, LinkId, Node, Tree, TreeError};

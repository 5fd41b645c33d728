//! Whether a closed cut joint is put together the right way round.

use crate::closure::{Attachment, Closure, Row};
use crate::motion::Positions;
use nalgebra::Vector3;

impl Closure {
    /// Whether the frames of a closed joint stand to each other as its kind means. Its equations do not tell: right angles are right
    /// angles for an axis that points backwards too. Two of them with the same axis of the successor leave it two directions, three
    /// between the axes of both frames eight orientations; at zero coordinates of the joint the frames coincide. Equations of one's own,
    /// [`Closure::with_rows`], are taken at their word: whatever fulfils them is right.
    pub fn is_upright(&self, positions: &Positions) -> bool {
        let frame = |end: &Attachment| positions.pose(end.link).rotation * end.pose.rotation;
        let (one, two) = (frame(self.predecessor()), frame(self.successor()));
        let right = |row: &Row| match row {
            Row::Angle {
                on_predecessor,
                on_successor,
                cosine,
            } if *cosine == 0.0 => Some((*on_predecessor, *on_successor)),
            _ => None,
        };
        let angles: Vec<(Vector3<f64>, Vector3<f64>)> = self.rows().iter().filter_map(right).collect();
        let forward = |a: &Vector3<f64>, b: &Vector3<f64>| (one * a).dot(&(two * b)) > 0.5;
        match angles[..] {
            _ if !self.is_of_a_joint() => true,
            [(a, axis), (b, other)] if axis == other => forward(&a.cross(&b), &axis),
            [(a, _), (b, _), (c, _)] => [a, b, c].iter().all(|axis| forward(axis, axis)),
            _ => true,
        }
    }
}

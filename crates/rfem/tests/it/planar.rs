//! Small motion of a chain in one plane, with the angles of the sdes as coordinates (the modified form).

use linkdyn_rfem::Beam;
use linkdyn_rfem::modes::{Axis, Ends};
use nalgebra::DMatrix;

pub fn about(axis: Axis) -> usize {
    usize::from(axis == Axis::Z)
}

/// Displacement of the centre (even rows) and direction (odd rows) of every element, the start of the beam clamped or, with pinned
/// ends, turned so that the far end stays in place. A column for each sde, for an angle with the elastic energy 1/2.
pub fn motion(beam: &Beam, axis: Axis, ends: Ends) -> DMatrix<f64> {
    let length = length(beam);
    DMatrix::from_fn(2 * beam.elements.len(), beam.springs.len(), |row, s| {
        let (rfe, sde) = (&beam.elements[row / 2], &beam.springs[s]);
        let arm = [rfe.centre(), 1.0][row % 2];
        let carried = match (s < row / 2, row % 2) {
            (false, _) => 0.0,
            (true, 0) => rfe.centre() - sde.position,
            (true, _) => 1.0,
        };
        let base = if ends == Ends::PinnedPinned {
            (sde.position - length) / length
        } else {
            0.0
        };
        (carried + base * arm) / sde.bend[about(axis)].stiffness.sqrt()
    })
}

/// Angular frequencies, lowest first, for small motion about an axis of the section.
///
/// The singular values of the mass-weighted motion are the reciprocals of the frequencies: the lowest frequency is the largest
/// value and comes with all its digits.
pub fn frequencies(beam: &Beam, axis: Axis, ends: Ends) -> Vec<f64> {
    let n = beam.springs.len();
    let weight = |row: usize| {
        let rfe = &beam.elements[row / 2];
        [rfe.mass, rfe.inertia[1 + about(axis)]][row % 2].sqrt()
    };
    let mut b = motion(beam, axis, ends);
    b.row_iter_mut()
        .enumerate()
        .for_each(|(row, mut values)| values *= weight(row));
    let held = match ends {
        Ends::ClampedFree | Ends::PinnedPinned | Ends::FreeFree => 0,
        Ends::ClampedPinned => 1,
        Ends::ClampedClamped => 2,
    };
    if ends == Ends::FreeFree {
        // Less the motion as a rigid body that carries the momenta: nothing holds the beam, so it has none.
        let rigid = DMatrix::from_fn(b.nrows(), 2, |row, k| match (row % 2, k) {
            (0, 0) | (1, 1) => weight(row),
            (0, _) => weight(row) * beam.elements[row / 2].centre(),
            _ => 0.0,
        });
        let q = rigid.qr().q();
        b -= &q * (q.transpose() * &b);
    }
    if held > 0 {
        // What the far end does; it must do nothing.
        let end = DMatrix::from_fn(n, held, |s, k| {
            let sde = &beam.springs[s];
            [length(beam) - sde.position, 1.0][k] / sde.bend[about(axis)].stiffness.sqrt()
        });
        let q = end.qr().q();
        let forbidden = &b * &q * q.transpose();
        b -= forbidden;
    }
    let mut periods: Vec<f64> = b.singular_values().iter().copied().collect();
    periods.sort_by(|a, b| b.total_cmp(a));
    periods.truncate(n - held);
    periods.iter().map(|period| 1.0 / period).collect()
}

/// Sum over the elements of length times product of directions: a compressive force P lowers the energy by P/2 times this form.
pub fn shortening(beam: &Beam, axis: Axis, ends: Ends) -> DMatrix<f64> {
    let mut b = motion(beam, axis, ends);
    for (row, mut values) in b.row_iter_mut().enumerate() {
        values *= [0.0, beam.elements[row / 2].length.sqrt()][row % 2];
    }
    b.transpose() * b
}

fn length(beam: &Beam) -> f64 {
    let last = beam.elements.last().unwrap();
    last.start + last.length
}

//! Small vibrations of a chain in one plane, with the angles of the sdes as coordinates (the modified form).

use linkdyn_rfem::Beam;
use linkdyn_rfem::modes::{Axis, Ends};
use nalgebra::DMatrix;

/// Angular frequencies, lowest first, for small motion about an axis of the section.
///
/// With angles scaled by the roots of the stiffnesses, the singular values of the (mass-weighted) motion are the reciprocals of
/// the frequencies: the lowest frequency is the largest value and comes with all its digits.
pub fn frequencies(beam: &Beam, axis: Axis, ends: Ends) -> Vec<f64> {
    let about = usize::from(axis == Axis::Z);
    let last = beam.elements.last().unwrap();
    let length = last.start + last.length;
    let (rows, n) = (2 * beam.elements.len(), beam.springs.len());
    let root = |s: usize| beam.springs[s].bend[about].stiffness.sqrt();
    let mut b = DMatrix::<f64>::zeros(rows, n);
    let mut rigid = DMatrix::<f64>::zeros(rows, 2);
    for (r, rfe) in beam.elements.iter().enumerate() {
        let (m, i) = (rfe.mass.sqrt(), rfe.inertia[1 + about].sqrt());
        for s in 0..n {
            let x = beam.springs[s].position;
            let (mut y, mut theta) = if s < r { (rfe.centre() - x, 1.0) } else { (0.0, 0.0) };
            if ends == Ends::PinnedPinned {
                let base = -(length - x) / length;
                y += base * rfe.centre();
                theta += base;
            }
            b[(2 * r, s)] = m * y / root(s);
            b[(2 * r + 1, s)] = i * theta / root(s);
        }
        rigid[(2 * r, 0)] = m;
        rigid[(2 * r, 1)] = m * rfe.centre();
        rigid[(2 * r + 1, 1)] = i;
    }
    let held = match ends {
        Ends::ClampedFree | Ends::PinnedPinned | Ends::FreeFree => 0,
        Ends::ClampedPinned => 1,
        Ends::ClampedClamped => 2,
    };
    if ends == Ends::FreeFree {
        let q = rigid.qr().q();
        b -= &q * (q.transpose() * &b);
    }
    if held > 0 {
        // What the far end does, in scaled angles; it must do nothing.
        let end = DMatrix::from_fn(n, held, |s, k| [length - beam.springs[s].position, 1.0][k] / root(s));
        let q = end.qr().q();
        let forbidden = &b * &q * q.transpose();
        b -= forbidden;
    }
    let mut periods: Vec<f64> = b.singular_values().iter().copied().collect();
    periods.sort_by(|a, b| b.total_cmp(a));
    periods.truncate(n - held);
    periods.iter().map(|period| 1.0 / period).collect()
}

//! What two methods agree on: a path, up to which time it is certain, and how accurate it is.

use super::measure::Point;

/// Two references that differ by more than this share of the scene's scale say nothing any more.
const AGREEMENT: f64 = 1e-3;

/// Errors of coordinates \[rad, m\], of speeds \[rad/s, m/s\] and of joint forces \[N, N m\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Largest error of a coordinate.
    pub positions: f64,
    /// Largest error of a speed.
    pub speeds: f64,
    /// Largest error of a multiplier, of a component of a joint's reaction, or of a contact's force.
    pub forces: f64,
}

impl Errors {
    /// Differences of two points.
    fn between(a: &Point, b: &Point) -> Self {
        Self {
            positions: largest(&a.q, &b.q),
            speeds: largest(&a.v, &b.v),
            forces: largest(&a.forces, &b.forces),
        }
    }

    /// The larger of each.
    fn or(self, other: Self) -> Self {
        Self {
            positions: self.positions.max(other.positions),
            speeds: self.speeds.max(other.speeds),
            forces: self.forces.max(other.forces),
        }
    }
}

/// Largest difference of two lists. What is not finite differs without bound.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, |most, d| if d.is_finite() { most.max(d) } else { f64::INFINITY })
}

/// An error as far as it can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// It is this large.
    Value(f64),
    /// It is smaller than what the reference can tell.
    Below(f64),
}

impl Known {
    fn new(error: f64, accuracy: f64) -> Self {
        if error <= accuracy {
            Self::Below(accuracy)
        } else {
            Self::Value(error)
        }
    }

    /// The error, or its bound.
    pub fn bound(self) -> f64 {
        match self {
            Self::Value(x) | Self::Below(x) => x,
        }
    }

    /// With two digits, as the terminal shows it.
    pub fn shown(self) -> String {
        match self {
            Self::Value(x) => format!("{x:.1e}"),
            Self::Below(x) => format!("< {x:.1e}"),
        }
    }
}

/// A certified path.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The path up to the horizon.
    path: Vec<Point>,
    /// Time up to which both references reach and agree \[s\].
    pub horizon: f64,
    /// Whether that is as far as both of them reached.
    pub whole: bool,
    /// Largest disagreement up to the horizon, never less than rounding.
    pub accuracy: Errors,
    /// Disagreement at all output times, beyond the horizon too.
    pub disagreement: Vec<(f64, Errors)>,
}

impl Reference {
    /// The path `first`, as far as `second` agrees with it to a thousandth of `scale` \[rad, m\]; `None` if they differ from the
    /// start, or have no point after it.
    pub fn new(first: Vec<Point>, second: &[Point], scale: f64) -> Option<Self> {
        let pairs = first.iter().zip(second).take_while(|(a, b)| a.t == b.t);
        let disagreement: Vec<(f64, Errors)> = pairs.map(|(a, b)| (a.t, Errors::between(a, b))).collect();
        let agree = |(_, errors): &&(f64, Errors)| errors.positions <= AGREEMENT * scale && errors.speeds.is_finite();
        let count = disagreement.iter().take_while(agree).count();
        if count < 2 {
            return None;
        }
        let whole = count == disagreement.len();
        let mut path = first;
        path.truncate(count);
        let rounding = path.iter().fold(Errors::default(), |most, point| {
            let rounding = |x: &[f64]| f64::EPSILON * x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            most.or(Errors {
                positions: rounding(&point.q),
                speeds: rounding(&point.v),
                forces: rounding(&point.forces),
            })
        });
        let least = Errors {
            positions: f64::MIN_POSITIVE,
            speeds: f64::MIN_POSITIVE,
            forces: f64::MIN_POSITIVE,
        };
        let worst = disagreement[..count].iter().fold(rounding, |most, (_, e)| most.or(*e));
        Some(Self {
            horizon: path[count - 1].t,
            whole,
            accuracy: worst.or(least),
            path,
            disagreement,
        })
    }

    /// Largest errors of a path up to the horizon, positions, speeds and forces; `None` if it does not reach that.
    pub fn errors(&self, path: &[Point]) -> Option<[Known; 3]> {
        let reached = path.len() >= self.path.len() && self.path.iter().zip(path).all(|(a, b)| a.t == b.t);
        let pairs = self.path.iter().zip(path);
        let worst = pairs.fold(Errors::default(), |most, (a, b)| most.or(Errors::between(a, b)));
        reached.then(|| {
            [
                Known::new(worst.positions, self.accuracy.positions),
                Known::new(worst.speeds, self.accuracy.speeds),
                Known::new(worst.forces, self.accuracy.forces),
            ]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Points at 0, 1, 2, ... s with these coordinates, and speeds ten times them.
    fn path(values: &[f64]) -> Vec<Point> {
        let point = |(i, &x): (usize, &f64)| Point {
            t: i as f64,
            q: vec![1.0, 1.0 + x],
            v: vec![10.0 * x],
            forces: vec![100.0 * x],
        };
        values.iter().enumerate().map(point).collect()
    }

    #[test]
    fn rows_beyond_the_horizon_do_not_count() {
        let second = path(&[0.0, 1e-9, 2e-9, 2e-3, 1e-12]);
        let reference = Reference::new(path(&[0.0; 5]), &second, 1.0).expect("agrees at first");
        assert_eq!((reference.horizon, reference.whole), (2.0, false));
        assert!(
            (reference.accuracy.positions - 2e-9).abs() < 1e-15 && (reference.accuracy.speeds - 2e-8).abs() < 1e-15
        );
        assert_eq!(reference.disagreement.len(), 5);
        // Large errors come after the horizon only.
        let run = path(&[0.0, 1e-6, 0.0, 7.0, 7.0]);
        let [positions, speeds, forces] = reference.errors(&run).expect("reaches the horizon");
        assert!((positions.bound() - 1e-6).abs() < 1e-15 && (speeds.bound() - 1e-5).abs() < 1e-15);
        assert!((forces.bound() - 1e-4).abs() < 1e-15);
        // A smaller scale has an earlier horizon.
        let reference = Reference::new(path(&[0.0; 5]), &second, 1.5e-6).expect("agrees at first");
        assert_eq!(reference.horizon, 1.0);
    }

    #[test]
    fn errors_below_the_accuracy_are_bounds() {
        let reference = Reference::new(path(&[0.0; 3]), &path(&[0.0, 1e-9, 0.0]), 1.0).expect("agrees");
        assert!(reference.whole);
        let [positions, speeds, forces] = reference.errors(&path(&[0.0, 1e-10, 0.0])).expect("whole");
        assert!(matches!(positions, Known::Below(_)) && matches!(speeds, Known::Below(_)));
        assert_eq!(
            (positions.shown(), speeds.shown(), forces.shown()),
            ("< 1.0e-9".into(), "< 1.0e-8".into(), "< 1.0e-7".into())
        );
    }

    #[test]
    fn equal_references_are_as_good_as_rounding() {
        let reference = Reference::new(path(&[0.0; 3]), &path(&[0.0; 3]), 1.0).expect("agrees");
        assert_eq!(reference.accuracy.positions, f64::EPSILON);
        assert!(reference.accuracy.speeds > 0.0);
    }

    #[test]
    fn what_never_agrees_is_no_reference() {
        assert!(Reference::new(path(&[0.0; 3]), &path(&[1.0; 3]), 1.0).is_none());
        assert!(Reference::new(path(&[0.0; 3]), &path(&[f64::NAN; 3]), 1.0).is_none());
        assert!(Reference::new(path(&[0.0, 0.0]), &path(&[0.0, 1.0]), 1.0).is_none());
        assert!(Reference::new(Vec::new(), &[], 1.0).is_none());
    }

    #[test]
    fn a_run_that_ends_before_the_horizon_has_no_error() {
        let reference = Reference::new(path(&[0.0; 3]), &path(&[0.0; 3]), 1.0).expect("agrees");
        assert!(reference.errors(&path(&[0.0; 2])).is_none());
        let [positions, ..] = reference.errors(&path(&[0.0, f64::NAN, 0.0])).expect("has all rows");
        assert_eq!(positions, Known::Value(f64::INFINITY));
    }

    proptest! {
        #[test]
        fn no_error_is_told_below_the_accuracy(
            second in prop::collection::vec(-1e-2..1e-2f64, 2..20), run in prop::collection::vec(-1e-2..1e-2f64, 20),
        ) {
            let first = vec![0.0; second.len()];
            if let Some(reference) = Reference::new(path(&first), &path(&second), 1.0) {
                let count = reference.path.len();
                prop_assert!(second[..count].iter().all(|x| x.abs() <= AGREEMENT * (1.0 + 1e-9)));
                prop_assert_eq!(reference.whole, count == second.len());
                if let Some([positions, speeds, forces]) = reference.errors(&path(&run)) {
                    prop_assert!(positions.bound() >= reference.accuracy.positions);
                    prop_assert!(speeds.bound() >= reference.accuracy.speeds);
                    prop_assert!(forces.bound() >= reference.accuracy.forces);
                }
            }
        }
    }
}

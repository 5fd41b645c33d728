//! The earliest root of a scalar function on an interval in which it may dip below zero and rise again.

/// Value and slope of a function at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    pub(crate) at: f64,
    pub(crate) value: f64,
    pub(crate) slope: f64,
}

/// A dip of the cubic polynomial is looked at more closely if it comes closer to zero than the change over the interval, and once it
/// has been, as long as it comes below this part of the lowest value found.
const PROMISING: f64 = 0.5;

/// Part of an interval over which slopes are measured.
pub(crate) const PROBE: f64 = 1e-4;

/// Part of the value at the end that a function may be below zero after a start at zero, before it rises.
const ROUNDING: f64 = 1e-9;

/// Most times that an interval is divided in search of a dip.
const MOST_DIVISIONS: usize = 12;

/// Most steps of the search for a root; half of them bisections, of which 53 are enough.
const MOST_ITERATIONS: usize = 150;

/// The first place in (`start.at`, `end.at`] where `g`, positive right after the start, is zero or negative; to `least`.
///
/// The sign at the end tells whether there is one. If it is positive, the interval is searched for a dip: where the cubic
/// polynomial through both samples comes close to zero in its lowest point, g itself is asked, and so on in the part in which the
/// lowest point must then lie. What such polynomials do not show is missed: two dips at once, or one much narrower than the
/// interval.
///
/// If the start is zero or negative, the function is taken to rise there. `start.at` is returned if it does not.
pub(crate) fn earliest<E>(
    start: Sample,
    end: Sample,
    least: f64,
    g: &mut impl FnMut(f64) -> Result<f64, E>,
) -> Result<Option<f64>, E> {
    let mut found = None;
    let mut end = end;
    loop {
        let beyond = match dip(start, end, g)? {
            Some(below) => below,
            // Only at the first time the end counts: after that it is the root found.
            None if found.is_none() && crosses(start.value, end.value) => (end.at, end.value),
            None => return Ok(found),
        };
        let Some(bracket) = bracket(start, beyond, least, g)? else {
            // Right after an event of the same function rounding may take it to the wrong side for an instant.
            let by_rounding = end.value > 0.0 && -beyond.1 <= ROUNDING * end.value;
            return Ok(Some(start.at).filter(|_| !by_rounding));
        };
        let at = root(bracket, least, g)?;
        if found.is_some_and(|found| at >= found) {
            return Ok(found);
        }
        found = Some(at);
        let probe = PROBE * (at - start.at);
        let slope = -g(at - probe)? / probe;
        end = Sample { at, value: 0.0, slope };
    }
}

/// A place between the samples where `g`, negative at the start, is positive in a bump, if the polynomials that [`earliest`] uses show
/// one.
pub(crate) fn bump<E>(
    start: Sample,
    end: Sample,
    g: &mut impl FnMut(f64) -> Result<f64, E>,
) -> Result<Option<Sample>, E> {
    let turned = |sample: Sample| Sample {
        at: sample.at,
        value: -sample.value,
        slope: -sample.slope,
    };
    let Some((at, value)) = dip(turned(start), turned(end), &mut |x| g(x).map(|g| -g))? else {
        return Ok(None);
    };
    let probe = PROBE * (end.at - at);
    let (value, ahead) = (-value, g(at + probe)?);
    let slope = (ahead - value) / probe;
    Ok((value > 0.0).then_some(Sample { at, value, slope }))
}

/// Whether a function, positive right after the start of an interval, no longer is at its end: one that rises toward zero from the
/// wrong side, by rounding, has not been positive yet.
pub(crate) fn crosses(start: f64, end: f64) -> bool {
    end <= 0.0 && (start > 0.0 || end < start)
}

/// The lowest point of the cubic Hermite polynomial strictly inside the unit interval, with its value. `m` are slopes times the
/// length of the interval.
fn lowest(a: Sample, b: Sample) -> Option<(f64, f64)> {
    let length = b.at - a.at;
    let (rise, m0, m1) = (b.value - a.value, a.slope * length, b.slope * length);
    let (c3, c2) = (m0 + m1 - 2.0 * rise, 3.0 * rise - 2.0 * m0 - m1);
    let square = c2 * c2 - 3.0 * c3 * m0;
    if square.is_nan() || square < 0.0 {
        return None;
    }
    // Of both forms of the root of m0 + 2 c2 x + 3 c3 x², the one without cancellation.
    let x = if c2 > 0.0 {
        -m0 / (c2 + square.sqrt())
    } else {
        (square.sqrt() - c2) / (3.0 * c3)
    };
    (x > 0.0 && x < 1.0).then_some((x, a.value + x * (m0 + x * (c2 + x * c3))))
}

/// A place strictly between two samples where g is zero or negative in a dip, if it has one there; with its value.
fn dip<E>(mut a: Sample, mut b: Sample, g: &mut impl FnMut(f64) -> Result<f64, E>) -> Result<Option<(f64, f64)>, E> {
    for divisions in 0..MOST_DIVISIONS {
        let length = b.at - a.at;
        let change = (b.value - a.value)
            .abs()
            .max((a.slope * length).abs())
            .max((b.slope * length).abs());
        let Some((x, value)) = lowest(a, b) else {
            return Ok(None);
        };
        if value > change || (divisions > 0 && value > PROMISING * a.value.min(b.value)) {
            return Ok(None);
        }
        let at = a.at + x * length;
        if at <= a.at || at >= b.at {
            return Ok(None);
        }
        let value = g(at)?;
        if value <= 0.0 {
            return Ok(Some((at, value)));
        }
        // Close to the lowest point the sign of the slope is in question, so both sides are asked.
        let probe = PROBE * (b.at - at).min(at - a.at);
        let slope = (g(at + probe)? - g(at - probe)?) / (2.0 * probe);
        let middle = Sample { at, value, slope };
        if slope > 0.0 {
            b = middle;
        } else {
            a = middle;
        }
    }
    Ok(None)
}

/// Two points with g > 0 and g ≤ 0, the second not later than `beyond`; none if no positive value shows after the start.
fn bracket<E>(
    start: Sample,
    mut beyond: (f64, f64),
    least: f64,
    g: &mut impl FnMut(f64) -> Result<f64, E>,
) -> Result<Option<[(f64, f64); 2]>, E> {
    if start.value > 0.0 {
        return Ok(Some([(start.at, start.value), beyond]));
    }
    // A parabola with value and slope of the start is highest half-way to its root.
    let length = beyond.0 - start.at;
    let m0 = (start.slope * length).max(0.0);
    let fall = m0 + start.value - beyond.1;
    let mut x = if fall > 0.0 && m0 > 0.0 { 0.5 * m0 / fall } else { 0.25 };
    while x * length > least {
        let at = start.at + x * length;
        let value = g(at)?;
        if value > 0.0 {
            return Ok(Some([(at, value), beyond]));
        }
        beyond = (at, value);
        x *= 0.25;
    }
    Ok(None)
}

/// Root between a place with g > 0 and one with g ≤ 0, to `least`: the end of the last bracket.
///
/// Regula falsi in the form of Illinois, with a bisection where three steps have not halved the bracket, and then after every step
/// that has not.
fn root<E>([mut a, mut b]: [(f64, f64); 2], least: f64, g: &mut impl FnMut(f64) -> Result<f64, E>) -> Result<f64, E> {
    // Values as the method weighs them: halved where an end stays for the second time.
    let (mut weight_a, mut weight_b) = (a.1, b.1);
    let mut moved = None;
    let (mut goal, mut since, mut patience) = (0.5 * (b.0 - a.0), 0, 3);
    for _ in 0..MOST_ITERATIONS {
        if b.1 == 0.0 || b.0 - a.0 <= least {
            break;
        }
        let secant = b.0 - weight_b * (b.0 - a.0) / (weight_b - weight_a);
        // Not closer to an end than `least`, so that the bracket closes when the root is that close.
        let x = if since < patience && secant.is_finite() {
            secant.max(a.0 + 0.5 * least).min(b.0 - 0.5 * least)
        } else {
            patience = 1;
            0.5 * (a.0 + b.0)
        };
        if x <= a.0 || x >= b.0 {
            break;
        }
        let value = g(x)?;
        let positive = value > 0.0;
        let again = moved.replace(positive) == Some(positive);
        let stays = if positive {
            (a, weight_a) = ((x, value), value);
            &mut weight_b
        } else {
            (b, weight_b) = ((x, value), value);
            &mut weight_a
        };
        if again {
            *stays *= 0.5;
        }
        since += 1;
        if b.0 - a.0 <= goal {
            (goal, since) = (0.5 * (b.0 - a.0), 0);
        }
    }
    Ok(b.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// The earliest root of `g` on the unit interval, by values and slopes at its ends, and the number of calls.
    fn find(g: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64) -> (Option<f64>, u32) {
        let sample = |at| Sample {
            at,
            value: g(at),
            slope: slope(at),
        };
        let mut calls = 0;
        let mut counted = |x| {
            calls += 1;
            Ok::<_, Infallible>(g(x))
        };
        let Ok(found) = earliest(sample(0.0), sample(1.0), f64::EPSILON, &mut counted);
        (found, calls)
    }

    #[test]
    fn one_root() {
        for root in [1e-9, 0.01, 0.3, 0.5, 0.77, 1.0 - 1e-9, 1.0] {
            let check = |g: fn(f64) -> f64, slope: fn(f64) -> f64, most: u32| {
                let (found, calls) = find(|x| g(x - root), |x| slope(x - root));
                let found = found.expect("a change of sign");
                assert!((found - root).abs() < 1e-15, "{found}, not {root}");
                assert!(calls <= most, "{root}: {calls} calls");
            };
            check(|x| -x, |_| -1.0, 5);
            check(|x| -x.exp_m1(), |x| -x.exp(), 15);
            check(|x| -(20.0 * x).atan(), |x| -20.0 / (1.0 + 400.0 * x * x), 25);
            // A triple root, and a jump.
            check(|x| -x * x * x, |x| -3.0 * x * x, 110);
            check(|x| if x < 0.0 { 1.0 } else { -1.0 }, |_| 0.0, 110);
        }
    }

    #[test]
    fn the_earliest_of_several() {
        let roots = |r: [f64; 3]| {
            find(
                |x| (r[0] - x) * (r[1] - x) * (r[2] - x),
                |x| -(r[1] - x) * (r[2] - x) - (r[0] - x) * (r[2] - x) - (r[0] - x) * (r[1] - x),
            )
        };
        for r in [
            [0.1, 0.2, 0.9],
            [0.1, 0.5, 0.6],
            [0.4, 0.41, 0.8],
            [0.3, 0.6, 1.7],
            [0.2, 1.2, 1.3],
        ] {
            let (found, calls) = roots(r);
            assert!((found.expect("three roots") - r[0]).abs() < 1e-15, "{r:?}: {found:?}");
            assert!(calls < 45, "{calls}");
        }
    }

    /// Where no polynomial comes close to zero nothing is asked at all.
    #[test]
    fn no_root_costs_nothing() {
        assert_eq!(find(|x| 1.0 + x, |_| 1.0), (None, 0));
        assert_eq!(find(|x| 2.0 - x, |_| -1.0), (None, 0));
        assert_eq!(find(|x| 3.0 + (x - 0.5).powi(2), |x| 2.0 * x - 1.0), (None, 0));
        let (found, calls) = find(|x| 1e-9 + (x - 0.5).powi(2), |x| 2.0 * x - 1.0);
        assert!(found.is_none() && calls < 10, "{calls}");
    }

    /// From zero upward and back: the root at the start does not count, and none other is left if it goes downward.
    #[test]
    fn after_a_start_at_zero() {
        for height in [0.9, 1e-3, 1e-8] {
            let (found, _) = find(|x| x * (height - x), |x| height - 2.0 * x);
            assert!((found.expect("a root") - height).abs() < 1e-15, "{found:?}");
        }
        assert_eq!(find(|x| -x * x, |x| -2.0 * x).0, Some(0.0));
        // A dip right at the start that rounding may explain, and one that it may not.
        assert_eq!(find(|x| x * (x - 1e-12), |x| 2.0 * x - 1e-12).0, None);
        assert_eq!(find(|x| x * (x - 0.5), |x| 2.0 * x - 0.5).0, Some(0.0));
        // Rising toward zero is not falling through it.
        assert_eq!(find(|x| 0.1 * x - 0.2, |_| 0.1).0, None);
    }

    #[test]
    fn bumps() {
        let sample = |at: f64, g: &dyn Fn(f64) -> f64, slope: f64| Sample {
            at,
            value: g(at),
            slope,
        };
        let find = |height: f64| {
            let g = move |x: f64| height - (x - 0.5) * (x - 0.5);
            let mut call = |x| Ok::<_, Infallible>(g(x));
            let Ok(found) = bump(sample(0.0, &g, 1.0), sample(1.0, &g, -1.0), &mut call);
            found
        };
        let found = find(0.01).expect("a bump");
        assert!(found.value > 0.0 && (found.at - 0.5).abs() < 0.1);
        assert_eq!(find(-0.01), None);
        assert_eq!(find(0.0), None);
    }

    #[test]
    fn errors_pass() {
        let sample = |at, value| Sample { at, value, slope: -2.0 };
        let failure = earliest(sample(0.0, 1.0), sample(1.0, -1.0), 1e-15, &mut |_| Err("no"));
        assert_eq!(failure, Err("no"));
    }
}

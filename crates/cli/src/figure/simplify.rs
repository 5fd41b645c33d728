//! Fewer points for the same picture.

/// A point on the canvas.
pub(super) type Pixel = (i32, i32);

/// Points of a polyline that looks the same: of all points in one column of `width` only the first, the last and the
/// extremes stay, and what lies within `tolerance` of the line between its neighbours goes. First and last point stay.
pub(super) fn simplify(points: &[Pixel], width: i32, tolerance: f64) -> Vec<Pixel> {
    let few = columns(points, width.max(1));
    if few.len() < 3 {
        return few;
    }
    // Ramer-Douglas-Peucker without recursion, so that a long curve cannot overflow the stack.
    let mut keep = vec![false; few.len()];
    keep[0] = true;
    keep[few.len() - 1] = true;
    let mut open = vec![(0, few.len() - 1)];
    while let Some((a, b)) = open.pop() {
        let farthest = (a + 1..b)
            .map(|i| (distance(few[i], few[a], few[b]), i))
            .max_by(|x, y| x.0.total_cmp(&y.0).then(y.1.cmp(&x.1)));
        if let Some((d, i)) = farthest
            && d > tolerance
        {
            keep[i] = true;
            open.push((a, i));
            open.push((i, b));
        }
    }
    few.into_iter().zip(keep).filter_map(|(p, k)| k.then_some(p)).collect()
}

fn columns(points: &[Pixel], width: i32) -> Vec<Pixel> {
    let mut few: Vec<Pixel> = Vec::new();
    for run in points.chunk_by(|a, b| a.0.div_euclid(width) == b.0.div_euclid(width)) {
        let extreme = |sign: i32| (0..run.len()).max_by_key(|i| sign * run[*i].1).unwrap_or(0);
        let mut chosen = [0, extreme(1), extreme(-1), run.len() - 1];
        chosen.sort_unstable();
        for i in chosen {
            if few.last() != Some(&run[i]) {
                few.push(run[i]);
            }
        }
    }
    few
}

/// Distance of `p` from the line segment `a` to `b`.
fn distance(p: Pixel, a: Pixel, b: Pixel) -> f64 {
    let f = |p: Pixel| (f64::from(p.0), f64::from(p.1));
    let ((px, py), (ax, ay), (bx, by)) = (f(p), f(a), f(b));
    let (dx, dy) = (bx - ax, by - ay);
    let length = dx.hypot(dy);
    if length == 0.0 {
        return (px - ax).hypot(py - ay);
    }
    let along = (((px - ax) * dx + (py - ay) * dy) / (length * length)).clamp(0.0, 1.0);
    (px - ax - along * dx).hypot(py - ay - along * dy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_straight_line_needs_two_points() {
        let line: Vec<Pixel> = (0..5000).map(|i| (i, 2 * i)).collect();
        assert_eq!(simplify(&line, 5, 0.5), [(0, 0), (4999, 9998)]);
    }

    #[test]
    fn peaks_stay() {
        let mut noisy: Vec<Pixel> = (0..10_000).map(|i| (i / 10, i % 7)).collect();
        noisy[5003].1 = 4000;
        noisy[5004].1 = -4000;
        let few = simplify(&noisy, 5, 0.5);
        assert!(few.contains(&(500, 4000)) && few.contains(&(500, -4000)));
        assert!(few.len() < 2000);
    }

    #[test]
    fn nothing_and_single_points_pass() {
        assert!(simplify(&[], 5, 0.5).is_empty());
        assert_eq!(simplify(&[(3, 4)], 5, 0.5), [(3, 4)]);
        assert_eq!(simplify(&[(3, 4), (3, 4)], 0, 0.0), [(3, 4)]);
    }

    #[test]
    fn a_closed_curve_stays_closed_and_round() {
        let circle: Vec<Pixel> = (0..=5000)
            .map(|i| f64::from(i) / 5000.0 * std::f64::consts::TAU)
            .map(|a| ((1000.0 * a.cos()).round() as i32, (1000.0 * a.sin()).round() as i32))
            .collect();
        let few = simplify(&circle, 1, 1.2);
        assert_eq!(few.first(), few.last());
        assert!(few.len() > 50 && few.len() < 600, "{}", few.len());
    }

    proptest! {
        #[test]
        fn dropped_points_are_near_what_stays(ys in prop::collection::vec(-500..500i32, 2..200), tolerance in 0.5..20.0f64) {
            let points: Vec<Pixel> = ys.iter().enumerate().map(|(i, y)| (i as i32, *y)).collect();
            let few = simplify(&points, 1, tolerance);
            prop_assert_eq!(few[0], points[0]);
            prop_assert_eq!(few[few.len() - 1], points[points.len() - 1]);
            for p in points {
                let nearest = few.windows(2).map(|s| distance(p, s[0], s[1])).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest <= tolerance + 1e-9);
            }
        }
    }
}

//! Cost at equal error: between its measured runs, a method's cost is interpolated.

use super::candidates::Way;
use super::figures::{Figures, Row};

/// Runs of one method from the cheapest on: error and cost, each dearer than the one before it and more accurate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve(Vec<(f64, f64)>);

impl Curve {
    /// The runs of `points` (error, cost) that no other run beats in both. An error that is known as a bound only counts as that bound.
    pub fn new(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let sound = |p: &(f64, f64)| p.0 > 0.0 && p.0.is_finite() && p.1 > 0.0 && p.1.is_finite();
        let mut points: Vec<(f64, f64)> = points.into_iter().filter(sound).collect();
        points.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.total_cmp(&b.0)));
        let mut least = f64::INFINITY;
        points.retain(|p| {
            let better = p.0 < least;
            least = least.min(p.0);
            better
        });
        Self(points)
    }

    /// Cost at an error, a power of it between two runs; that of the cheapest run where even that is more accurate, `None` where no run
    /// is as accurate.
    pub fn cost(&self, error: f64) -> Option<f64> {
        let next = self.0.iter().position(|p| p.0 <= error)?;
        let (e, cost) = self.0[next];
        let Some((e0, cost0)) = next.checked_sub(1).map(|i| self.0[i]) else {
            return Some(cost);
        };
        let share = (error / e0).ln() / (e / e0).ln();
        Some(cost0 * (cost / cost0).powf(share))
    }
}

/// The curves of a report's rows, by method.
pub struct Curves {
    /// Names and curves of the program's own methods.
    pub methods: Vec<(String, Curve)>,
    /// The paper's way, at all its steps.
    pub papers: Curve,
}

impl Curves {
    /// The curves of a cost over the error of positions.
    pub fn new(rows: &[Row], cost: fn(&Figures) -> f64) -> Self {
        let of = |wanted: &dyn Fn(&Row) -> bool| {
            let rows = rows.iter().filter(|row| wanted(row));
            Curve::new(rows.filter_map(|row| row.outcome.figures().map(|f| (f.positions.bound(), cost(f)))))
        };
        let mut names: Vec<&str> = Vec::new();
        for row in rows.iter().filter(|row| row.candidate.way == Way::Own) {
            if !names.contains(&row.candidate.plan.method.as_str()) {
                names.push(&row.candidate.plan.method);
            }
        }
        let named = |name: &&str| {
            let curve = of(&|row| row.candidate.way == Way::Own && row.candidate.plan.method == *name);
            ((*name).to_owned(), curve)
        };
        Self {
            methods: names.iter().map(named).collect(),
            papers: of(&|row| row.candidate.way != Way::Own),
        }
    }

    /// The method with the least cost at an error.
    pub fn best(&self, error: f64) -> Option<(&str, f64)> {
        let costs = self
            .methods
            .iter()
            .filter_map(|(name, curve)| Some((name.as_str(), curve.cost(error)?)));
        costs.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Cost of a method at an error.
    pub fn cost(&self, method: &str, error: f64) -> Option<f64> {
        self.methods.iter().find(|(name, _)| name == method)?.1.cost(error)
    }
}

#[cfg(test)]
mod tests {
    use super::super::figures::tests::row;
    use super::super::reference::Known;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn costs_are_interpolated_by_their_logarithms() {
        let curve = Curve::new([(1e-8, 400.0), (1e-4, 100.0), (1e-3, 300.0), (f64::INFINITY, 1.0)]);
        let near = |error: f64, cost: f64| (curve.cost(error).expect("in reach") / cost - 1.0).abs() < 1e-12;
        assert!(near(1e-6, 200.0) && near(1e-8, 400.0) && near(1e-4, 100.0));
        // The cheapest run is as good for any larger error, and nothing is told of smaller ones.
        assert!(near(1.0, 100.0));
        assert_eq!(curve.cost(9e-9), None);
        assert_eq!(Curve::new([]).cost(1.0), None);
    }

    #[test]
    fn the_papers_way_is_a_curve_of_its_own() {
        let rows = [
            row("adams", Way::Own, Known::Value(1e-4), 100),
            row("adams", Way::Own, Known::Below(1e-8), 400),
            row("rk4", Way::Own, Known::Value(1e-5), 50),
            row("rk4", Way::Papers, Known::Value(1e-4), 20),
            row("rk4", Way::Published, Known::Value(1e-6), 2000),
        ];
        let curves = Curves::new(&rows, |f| f.statistics.evaluations as f64);
        assert_eq!(curves.best(1e-4), Some(("rk4", 50.0)));
        assert!(
            curves
                .best(1e-6)
                .is_some_and(|(name, cost)| name == "adams" && (cost - 200.0).abs() < 1e-9)
        );
        assert!(curves.papers.cost(1e-5).is_some_and(|cost| (cost - 200.0).abs() < 1e-9));
        assert_eq!((curves.best(1e-9), curves.cost("auto", 1e-3)), (None, None));
    }

    proptest! {
        #[test]
        fn smaller_errors_never_cost_less(
            points in prop::collection::vec((1e-12..1.0f64, 1.0..1e6f64), 1..20), error in 1e-12..1.0f64, other in 1e-12..1.0f64,
        ) {
            let curve = Curve::new(points.iter().copied());
            let (small, large) = (error.min(other), error.max(other));
            if let (Some(dear), Some(cheap)) = (curve.cost(small), curve.cost(large)) {
                prop_assert!(dear >= cheap * (1.0 - 1e-9));
            }
            // A run that was measured is never dearer than itself.
            for (e, cost) in points {
                prop_assert!(curve.cost(e).is_some_and(|c| c <= cost * (1.0 + 1e-9)));
            }
        }
    }
}

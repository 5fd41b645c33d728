//! Conditions that the coefficients satisfy.

use super::*;

fn sum(row: Row) -> f64 {
    row.iter().map(|&(_, a)| a).sum()
}

/// Nodes are row sums; weights integrate polynomials up to their order; estimates vanish for constants and more.
fn check<T: Tableau>(estimate_order: i32) {
    let tableau = T::COEFFICIENTS;
    let mut nodes = vec![0.0];
    nodes.extend_from_slice(tableau.nodes);
    nodes.push(1.0);
    nodes.extend_from_slice(tableau.dense_nodes);
    for (c, row) in tableau
        .nodes
        .iter()
        .zip(tableau.rows)
        .chain(tableau.dense_nodes.iter().zip(tableau.dense_rows))
    {
        assert!((c - sum(row)).abs() < 1e-13, "node {c}");
    }
    let moment = |row: Row, k: i32| row.iter().map(|&(j, b)| b * nodes[j].powi(k)).sum::<f64>();
    for k in 0..tableau.order as i32 {
        assert!(
            (moment(tableau.weights, k) - 1.0 / f64::from(k + 1)).abs() < 1e-14,
            "weights, degree {k}"
        );
    }
    match tableau.error {
        Estimate::None => {}
        Estimate::WithNewDerivative(row) => {
            (0..estimate_order).for_each(|k| assert!(moment(row, k).abs() < 1e-14, "estimate, degree {k}"));
        }
        Estimate::Pair { fifth, third } => {
            (0..estimate_order).for_each(|k| assert!(moment(fifth, k).abs() < 1e-14, "fifth, degree {k}"));
            (0..3).for_each(|k| assert!(moment(third, k).abs() < 1e-14, "third, degree {k}"));
        }
    }
    // The interpolation is exact for f = tᵏ: the terms beyond the cubic polynomial vanish for k < 3.
    for row in tableau.dense {
        (0..3).for_each(|k| {
            assert!(
                moment(row, k).abs() < 1e-11,
                "interpolation, degree {k}: {}",
                moment(row, k)
            )
        });
    }
}

#[test]
fn classical() {
    check::<ClassicalTableau>(0);
}

#[test]
fn dormand_prince_5() {
    check::<DormandPrince5Tableau>(4);
}

#[test]
fn dop853() {
    check::<Dop853Tableau>(5);
}

//! Coefficients of RODAS5P.

/// Stages.
pub(super) const STAGES: usize = 8;

/// γ on the diagonal.
pub(super) const GAMMA: f64 = 0.211_937_563_194_290_14;

/// aᵢⱼ of the states at the stages 2 to 6; the last three stages differ by the one before: uᵢ₊₁ = uᵢ + kᵢ from i = 6 on.
pub(super) const A: [[f64; 5]; 5] = [
    [3.0, 0.0, 0.0, 0.0, 0.0],
    [2.849394379747939, 0.458_422_422_044_639_23, 0.0, 0.0, 0.0],
    [-6.954028509809101, 2.489845061869568, -10.358996098473584, 0.0, 0.0],
    [
        2.8029986275628964,
        0.5072464736228206,
        -0.3988312541770524,
        -0.047_211_872_304_046_41,
        0.0,
    ],
    [
        -7.502846399306121,
        2.561846144803919,
        -11.627539656261098,
        -0.182_687_676_599_422_56,
        0.030_198_172_008_377_946,
    ],
];

/// cᵢⱼ of the right-hand sides of stages 2 to 8.
pub(super) const C: [[f64; 7]; 7] = [
    [-14.155112264123755, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-17.97296035885952, -2.859693295451294, 0.0, 0.0, 0.0, 0.0, 0.0],
    [
        147.12150275711716,
        -1.41221402718213,
        71.68940251302358,
        0.0,
        0.0,
        0.0,
        0.0,
    ],
    [
        165.43517024871676,
        -0.4592823456491126,
        42.90938336958603,
        -5.961986721573306,
        0.0,
        0.0,
        0.0,
    ],
    [
        24.854864614690072,
        -3.0009227002832186,
        47.4931110020768,
        5.5814197821558125,
        -0.6610691825249471,
        0.0,
        0.0,
    ],
    [
        30.91273214028599,
        -3.1208243349937974,
        77.79954646070892,
        34.28646028294783,
        -19.097331116725623,
        -28.087943162872662,
        0.0,
    ],
    [
        37.80277123390563,
        -3.2571969029072276,
        112.26918849496327,
        66.9347231244047,
        -40.06618937091002,
        -54.66780262877968,
        -9.48861652309627,
    ],
];

/// Times of the stages, in steps.
pub(super) const TIMES: [f64; STAGES] = [
    0.0,
    0.635_812_689_582_870_4,
    0.409_579_839_339_753_5,
    0.976_930_672_506_071_6,
    0.428_840_360_955_866_4,
    1.0,
    1.0,
    1.0,
];

/// Parts of ∂f/∂t in the stages.
pub(super) const D: [f64; STAGES] = [
    0.211_937_563_194_290_14,
    -0.423_875_126_388_580_27,
    -0.3384627126235924,
    1.8046452872882734,
    2.325825639765069,
    0.0,
    0.0,
    0.0,
];

/// Rows of the interpolation: y(θ) = y + θ (y₁ − y) + θ (1 − θ) (K₁ + θ (K₂ + θ K₃)), Kᵣ = Σ Hᵣⱼ kⱼ.
pub(super) const H: [[f64; STAGES]; 3] = [
    [
        25.948786856663858,
        -2.5579724845846235,
        10.433815404888879,
        -2.3679251022685204,
        0.524948541321073,
        1.1241088310450404,
        0.4272876194431874,
        -0.172_022_210_701_554_93,
    ],
    [
        -9.91568850695171,
        -0.9689944594115154,
        3.0438037242978453,
        -24.495224566215796,
        20.176138334709044,
        15.98066361424651,
        -6.789040303419874,
        -6.710236069923372,
    ],
    [
        11.419903575922262,
        2.8879645146136994,
        72.92137995996029,
        80.12511834622643,
        -52.072871366152654,
        -59.78993625266729,
        -0.155_826_842_827_519_13,
        4.883087185713722,
    ],
];

#[cfg(test)]
mod tests {
    use super::*;

    type Matrix = [[f64; STAGES]; STAGES];

    /// A rooted tree by its branches.
    #[derive(Clone)]
    struct Tree(Vec<Tree>);

    impl Tree {
        fn order(&self) -> usize {
            1 + self.0.iter().map(Tree::order).sum::<usize>()
        }

        /// γ(t), the product of the orders of all subtrees.
        fn density(&self) -> f64 {
            self.order() as f64 * self.0.iter().map(Tree::density).product::<f64>()
        }

        /// Φ of each stage: β where there is a single branch, α elsewhere (Hairer, Wanner II, IV.7).
        fn weights(&self, alpha: &Matrix, beta: &Matrix) -> [f64; STAGES] {
            let matrix = if self.0.len() == 1 { beta } else { alpha };
            self.0.iter().fold([1.0; STAGES], |product, branch| {
                let weights = branch.weights(alpha, beta);
                std::array::from_fn(|i| product[i] * dot(&matrix[i], &weights))
            })
        }
    }

    /// All trees of an order.
    fn trees(order: usize) -> Vec<Tree> {
        fn branches(left: usize, smaller: &[Tree]) -> Vec<Vec<Tree>> {
            if left == 0 {
                return vec![Vec::new()];
            }
            let mut all = Vec::new();
            for (i, tree) in smaller.iter().enumerate().filter(|(_, tree)| tree.order() <= left) {
                for mut rest in branches(left - tree.order(), &smaller[..=i]) {
                    rest.push(tree.clone());
                    all.push(rest);
                }
            }
            all
        }
        let smaller: Vec<Tree> = (1..order).flat_map(trees).collect();
        branches(order - 1, &smaller).into_iter().map(Tree).collect()
    }

    fn dot(a: &[f64; STAGES], b: &[f64; STAGES]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    fn product(a: &Matrix, b: &Matrix) -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..STAGES).map(|k| a[i][k] * b[k][j]).sum()))
    }

    /// aᵢⱼ of all stages; a ninth row would be the weights of the result.
    fn states(i: usize) -> [f64; STAGES] {
        std::array::from_fn(|j| match i {
            0 => 0.0,
            1..6 => A[i - 1].get(j).copied().unwrap_or(0.0),
            _ if j < 5 => A[4][j],
            _ => f64::from(u8::from(j < i)),
        })
    }

    /// α, Γ with its diagonal, and b of the untransformed method: kᵢ = Σ γᵢⱼ (untransformed kⱼ), Γ⁻¹ = 1/γ − C.
    fn untransformed() -> (Matrix, Matrix, [f64; STAGES]) {
        let inverse: Matrix = std::array::from_fn(|i| {
            std::array::from_fn(|j| match i.cmp(&j) {
                std::cmp::Ordering::Greater => -C[i - 1][j],
                std::cmp::Ordering::Equal => 1.0 / GAMMA,
                std::cmp::Ordering::Less => 0.0,
            })
        });
        let mut gamma = [[0.0; STAGES]; STAGES];
        for j in 0..STAGES {
            for i in j..STAGES {
                let known: f64 = (j..i).map(|k| inverse[i][k] * gamma[k][j]).sum();
                gamma[i][j] = (f64::from(u8::from(i == j)) - known) * GAMMA;
            }
        }
        let alpha = product(&std::array::from_fn(states), &gamma);
        (alpha, gamma, through(&states(STAGES), &gamma))
    }

    /// Weights of the untransformed stages from those of the kᵢ.
    fn through(m: &[f64; STAGES], gamma: &Matrix) -> [f64; STAGES] {
        std::array::from_fn(|j| (0..STAGES).map(|i| m[i] * gamma[i][j]).sum())
    }

    /// Largest violation of the conditions of one order, by the weights of a result at θ.
    fn violation(order: usize, theta: f64, b: &[f64; STAGES]) -> f64 {
        let (alpha, gamma, _) = untransformed();
        let beta: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| alpha[i][j] + gamma[i][j]));
        let condition = |tree: &Tree| {
            let wanted = theta.powi(order as i32) / tree.density();
            (dot(b, &tree.weights(&alpha, &beta)) - wanted).abs()
        };
        trees(order).iter().map(condition).fold(0.0, f64::max)
    }

    #[test]
    fn conditions_of_order_5_and_of_the_embedded_result_of_order_4() {
        assert_eq!([1, 2, 3, 4, 5].map(|order| trees(order).len()), [1, 1, 2, 4, 9]);
        let (_, gamma, b) = untransformed();
        let mut embedded = states(STAGES);
        embedded[7] = 0.0;
        let embedded = through(&embedded, &gamma);
        for order in 1..=5 {
            let found = violation(order, 1.0, &b);
            assert!(found < 1e-12, "order {order}: {found:e}");
            let found = violation(order, 1.0, &embedded);
            assert!((found < 1e-12) == (order < 5), "embedded, order {order}: {found:e}");
        }
        assert!(violation(6, 1.0, &b) > 1e-5);
    }

    #[test]
    fn conditions_of_the_interpolation_of_order_4() {
        let (_, gamma, _) = untransformed();
        for theta in [0.1, 0.3, 0.5, 0.8, 1.0] {
            let m: [f64; STAGES] = std::array::from_fn(|j| {
                let bend = H[0][j] + theta * (H[1][j] + theta * H[2][j]);
                theta * (states(STAGES)[j] + (1.0 - theta) * bend)
            });
            for order in 1..=4 {
                let found = violation(order, theta, &through(&m, &gamma));
                assert!(found < 1e-12, "{theta}, order {order}: {found:e}");
            }
        }
    }

    #[test]
    fn times_time_derivatives_and_stiff_accuracy() {
        let (alpha, gamma, b) = untransformed();
        for i in 0..STAGES {
            assert!((alpha[i].iter().sum::<f64>() - TIMES[i]).abs() < 1e-13, "{i}");
            assert!((gamma[i].iter().sum::<f64>() - D[i]).abs() < 1e-13, "{i}");
            assert!((alpha[7][i] + gamma[7][i] - b[i]).abs() < 1e-13, "{i}");
        }
    }
}

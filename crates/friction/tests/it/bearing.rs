use crate::fixtures::*;
use linkdyn_friction::*;
use proptest::prelude::*;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn euler_gradient_times_load_is_the_value(bearing in bearing(), (f, n) in load()) {
        let c = bearing.capacity(f, n);
        let euler = dot(c.d_force, f) + dot(c.d_torque, n);
        prop_assert!((euler - c.value).abs() <= 1e-12 * c.value, "{} {euler}", c.value);
    }

    #[test]
    fn homogeneous_of_degree_one(bearing in bearing(), (f, n) in load(), factor in 1e-6..1e6f64) {
        let (one, many) = (bearing.capacity(f, n), bearing.capacity(f.map(|x| factor * x), n.map(|x| factor * x)));
        prop_assert!((many.value - factor * one.value).abs() <= 1e-12 * many.value);
        for i in 0..3 {
            prop_assert!(close(many.d_force[i], one.d_force[i], 1e-9));
            prop_assert!(close(many.d_torque[i], one.d_torque[i], 1e-9));
        }
    }

    #[test]
    fn reversed_load_has_the_same_capacity(bearing in bearing(), (f, n) in load()) {
        let (plus, minus) = (bearing.capacity(f, n), bearing.capacity(f.map(|x| -x), n.map(|x| -x)));
        prop_assert_eq!(plus.value, minus.value);
        prop_assert_eq!(plus.d_force, minus.d_force.map(|x| -x));
        prop_assert_eq!(plus.d_torque, minus.d_torque.map(|x| -x));
    }

    #[test]
    fn gradient_is_that_of_the_value(bearing in bearing(), (f, n) in load()) {
        let (loads, spacing) = match &bearing {
            Bearing::Journal(b) => (b.loads(f, n), b.spacing),
            Bearing::PadGuide(b) => (b.loads(f, n), b.spacing),
            Bearing::Custom(_) => unreachable!(),
        };
        // Steps in proportion to the smaller support force, away from the kinks.
        let scale = 100.0 * loads[0].min(loads[1]).min(100.0);
        prop_assume!(scale > 100.0 && f[2].abs() > 0.02 && n[2].abs() > 0.02);
        let c = bearing.capacity(f, n);
        for i in 0..3 {
            let by_force = difference(|x| { let mut f = f; f[i] = x; bearing.capacity(f, n).value }, f[i], scale);
            let by_torque = difference(|x| { let mut n = n; n[i] = x; bearing.capacity(f, n).value }, n[i], spacing * scale);
            prop_assert!(close(c.d_force[i], by_force, 1e-6), "{} {by_force}", c.d_force[i]);
            prop_assert!(close(c.d_torque[i] * spacing, by_torque * spacing, 1e-6), "{} {by_torque}", c.d_torque[i]);
        }
    }

    #[test]
    fn convex_so_sharing_a_load_never_costs_more(bearing in bearing(), (f, n) in load(), (g, m) in load()) {
        let sum = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        let apart = bearing.capacity(f, n).value + bearing.capacity(g, m).value;
        prop_assert!(bearing.capacity(sum(f, g), sum(n, m)).value <= apart * (1.0 + 1e-14));
    }

    #[test]
    fn turning_the_load_about_the_axis_changes_nothing(bearing in bearing(), (f, n) in load(), angle in -4.0..4.0f64) {
        let (s, c) = angle.sin_cos();
        let turn = |x: [f64; 3]| [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]];
        let (one, other) = (bearing.capacity(f, n).value, bearing.capacity(turn(f), turn(n)).value);
        prop_assert!((one - other).abs() <= 1e-12 * one);
    }

    #[test]
    fn capacity_is_the_sum_over_the_surfaces(b in journal(), (f, n) in load()) {
        let [f_a, f_b, f_c] = b.loads(f, n);
        let [r_a, r_b, r_c] = b.levers();
        let sum = b.surface_a.coefficient * r_a * f_a
            + b.surface_b.coefficient * r_b * f_b
            + b.face.coefficient * r_c * f_c;
        prop_assert!((b.capacity(f, n).value - sum).abs() <= 1e-14 * sum);
    }

    #[test]
    fn capacity_of_the_guide_is_the_sum_over_the_pads(b in guide(), (f, n) in load()) {
        let [n_a, n_b, n_k] = b.loads(f, n);
        let sum = b.pad_a * n_a + b.pad_b * n_b + b.key * n_k;
        prop_assert!((b.capacity(f, n).value - sum).abs() <= 1e-14 * sum);
    }

    #[test]
    fn supports_tell_the_same_capacity(bearing in bearing(), (f, n) in load()) {
        let Supports { across, along: [c, d] } = bearing.supports().expect("all round about the axis");
        let lengths = across.map(|[a, b]| (a * f[0] - b * n[1]).hypot(a * f[1] + b * n[0]));
        let sum = lengths[0] + lengths[1] + (c * f[2] + d * n[2]).abs();
        // The two supports add what they take off each other.
        let parts: f64 = across.iter().map(|[a, b]| (a * f[0].hypot(f[1])).abs() + (b * n[0].hypot(n[1])).abs()).sum();
        prop_assert!((bearing.capacity(f, n).value - sum).abs() <= 1e-15 * (4.0 * parts + sum));
    }

    #[test]
    fn support_forces_balance_force_and_torque(b in journal(), f_a in prop::array::uniform2(-9.0..9.0f64), f_b in prop::array::uniform2(-9.0..9.0f64)) {
        // Forces on A at z = -a/2 and B at z = +a/2, reduced to the origin by r x F.
        let half = 0.5 * b.spacing;
        let f = [f_a[0] + f_b[0], f_a[1] + f_b[1], 0.0];
        let n = [half * (f_a[1] - f_b[1]), half * (f_b[0] - f_a[0]), 0.0];
        let loads = b.loads(f, n);
        prop_assert!(close(loads[0], f_a[0].hypot(f_a[1]), 1e-12));
        prop_assert!(close(loads[1], f_b[0].hypot(f_b[1]), 1e-12));
    }

    #[test]
    fn face_quotient_is_the_printed_one_where_that_exists(b in journal()) {
        let (d_a, d_c) = (b.surface_a.diameter, b.face.diameter);
        prop_assume!(d_c > 1.01 * d_a);
        let printed = (d_c.powi(3) - d_a.powi(3)) / (d_c.powi(2) - d_a.powi(2)) / 3.0;
        prop_assert!(close(b.levers()[2], printed, 1e-12));
    }

    #[test]
    fn scaling_scales_all_coefficients(b in journal(), g in guide(), (f, n) in load(), factor in 0.0..10.0f64) {
        let journal = (b.capacity(f, n), b.scaled(factor).capacity(f, n));
        let guide = (g.capacity(f, n), g.scaled(factor).capacity(f, n));
        for (one, many) in [journal, guide] {
            prop_assert!((many.value - factor * one.value).abs() <= 1e-13 * many.value);
            prop_assert!(close(many.d_force[0], factor * one.d_force[0], 1e-12));
        }
        prop_assert_eq!(b.scaled(factor).levers(), b.levers());
    }
}

#[test]
fn equal_diameters_of_face_and_journal_are_not_zero_by_zero() {
    // Joint (2,1): d_A = d_B = d_C = 28 mm. The face becomes a thin ring at 14 mm.
    let s = Surface {
        diameter: 0.028,
        coefficient: 0.2,
    };
    let b = JournalBearing {
        spacing: 0.03,
        surface_a: s,
        surface_b: s,
        face: s,
    };
    b.validate().unwrap();
    let c = b.capacity([0.0, 0.0, -10.0], [0.0; 3]);
    assert!((c.value - 0.2 * 0.014 * 10.0).abs() < 1e-16);
    assert_eq!(c.d_force, [0.0, 0.0, -c.value / 10.0]);
}

#[test]
fn force_at_surface_a_loads_a_alone() {
    // 10 N along x at z = -a/2: n_y = -a/2 · 10.
    let loads = JOURNAL.loads([10.0, 0.0, 0.0], [0.0, -0.15, 0.0]);
    assert!((loads[0] - 10.0).abs() < 1e-14 && loads[1].abs() < 1e-14, "{loads:?}");
    // 10 N along y there: n_x = +a/2 · 10.
    let loads = JOURNAL.loads([0.0, 10.0, 0.0], [0.15, 0.0, 0.0]);
    assert!((loads[0] - 10.0).abs() < 1e-14 && loads[1].abs() < 1e-14, "{loads:?}");
}

#[test]
fn torque_about_the_axis_loads_no_journal_but_the_key() {
    assert_eq!(JOURNAL.capacity([0.0; 3], [0.0, 0.0, 5.0]), Capacity::default());
    let c = GUIDE.capacity([0.0; 3], [0.0, 0.0, -5.0]);
    assert!((c.value - 50.0).abs() < 1e-13);
    assert!((c.d_torque[2] + 10.0).abs() < 1e-13);
}

#[test]
fn force_along_the_slide_loads_no_pad_but_the_face() {
    assert_eq!(GUIDE.capacity([0.0, 0.0, 9.0], [0.0; 3]), Capacity::default());
    assert!(JOURNAL.capacity([0.0, 0.0, 9.0], [0.0; 3]).value > 0.0);
}

#[test]
fn unloaded_joint_has_a_finite_gradient() {
    assert_eq!(JOURNAL.capacity([0.0; 3], [0.0; 3]), Capacity::default());
    assert_eq!(JOURNAL.capacity([-0.0; 3], [-0.0; 3]), Capacity::default());
    assert_eq!(GUIDE.capacity([0.0; 3], [0.0; 3]), Capacity::default());
}

#[test]
fn one_unloaded_support_contributes_no_gradient() {
    // Surface A carries nothing, B the whole force.
    let c = JOURNAL.capacity([8.0, 0.0, 0.0], [0.0, 4.0 * 0.03, 0.0]);
    assert!((c.value - 0.2 * 0.005 * 8.0).abs() < 1e-16);
    assert!((c.d_force[0] - 0.5 * 0.001).abs() < 1e-18);
}

#[test]
fn first_joint_of_the_linkage_has_no_face_friction() {
    let b = JournalBearing {
        face: Surface {
            diameter: 0.015,
            coefficient: 0.0,
        },
        ..JOURNAL
    };
    assert_eq!(b.capacity([0.0, 0.0, 41.0], [0.0; 3]), Capacity::default());
}

#[test]
fn sliding_speeds_are_in_metres_per_second() {
    let [a, b, c] = JOURNAL.sliding_speeds(-9.0);
    assert_eq!((a, b), (-0.045, -0.045));
    assert!((c + 9.0 * 0.019 / 3.0).abs() < 1e-15);
}

#[test]
fn face_lever_is_the_classical_two_thirds_with_radii() {
    let (r, big): (f64, f64) = (0.005, 0.0075);
    let classical = 2.0 / 3.0 * (big.powi(3) - r.powi(3)) / (big.powi(2) - r.powi(2));
    assert!((JOURNAL.levers()[2] - classical).abs() < 1e-16);
}

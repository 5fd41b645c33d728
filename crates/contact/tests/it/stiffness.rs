use crate::fixtures::*;
use linkdyn_contact::*;

#[test]
fn journal_of_the_rsup_linkage() {
    let steel = Material {
        youngs_modulus: 2.1e11,
        poisson_ratio: 0.3,
    };
    let k = ball_in_socket(0.005, 0.004, 2.0 * steel.compliance().unwrap()).unwrap();
    assert!((k - 2.176e10).abs() < 5e6, "{k}");
}

#[test]
fn journal_of_benchmark_12_clearance_slider_crank() {
    let steel = Material {
        youngs_modulus: 2.07e11,
        poisson_ratio: 0.3,
    };
    let k = ball_in_socket(0.010, 0.0095, 2.0 * steel.compliance().unwrap()).unwrap();
    assert!((k - 6.6102e10).abs() < 5e5 * 1.001, "{k}");
}

#[test]
fn large_sockets_and_balls_are_planes() {
    let plane = ball_on_plane(0.01, 1e-11).unwrap();
    assert!(near(ball_in_socket(1e6, 0.01, 1e-11).unwrap(), plane, 1e-8));
    assert!(near(balls(1e6, 0.01, 1e-11).unwrap(), plane, 1e-8));
    // Two equal balls: R = r/2.
    assert!(near(balls(0.02, 0.02, 1e-11).unwrap(), plane, 1e-15));
    assert!(near(plane, 4.0 / 3.0 * 0.1 / 1e-11, 1e-15));
}

#[test]
fn closer_fits_are_stiffer() {
    let k = |ball| ball_in_socket(0.005, ball, 1e-11).unwrap();
    assert!(k(0.004) < k(0.0049) && k(0.0049) < k(0.005 - 1e-9));
}

#[test]
fn contact_theory_of_hertz_for_two_balls() {
    // Mean pressure p = F/(π a²) with a² = R δ must be (4/3π) E* √(δ/R).
    let (r, s, depth): (f64, f64, f64) = (0.03, 9e-12, 1e-5);
    let force = ball_on_plane(r, s).unwrap() * depth.powf(1.5);
    let mean = force / (std::f64::consts::PI * r * depth);
    assert!(near(
        mean,
        4.0 / (3.0 * std::f64::consts::PI * s) * (depth / r).sqrt(),
        1e-13
    ));
}

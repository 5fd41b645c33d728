//! Numbers of the published formulas (benchmark 11-contact-restitution).

use crate::fixtures::*;
use RestitutionLaw::*;
use linkdyn_contact::*;

fn delivered(law: RestitutionLaw, e: f64) -> f64 {
    impact::restitution(law.damping_factor(e).unwrap())
}

#[test]
fn delivered_restitution_of_all_laws() {
    let nominal = [0.1, 0.3, 0.5, 0.7];
    let table = [
        (HuntCrossley, [0.516, 0.581, 0.663, 0.768], 0.9090),
        (HerbertMcWhannell, [0.491, 0.520, 0.594, 0.723], 0.9009),
        (LeeWang, [0.687, 0.739, 0.799, 0.869], 0.9524),
        (LankaraniNikravesh, [0.665, 0.684, 0.725, 0.796], 0.9132),
        (Gonthier, [0.101, 0.304, 0.488, 0.670], 0.8764),
        (ZhiyingQishao, [0.217, 0.327, 0.483, 0.680], 0.8959),
        (Flores, [0.069, 0.256, 0.470, 0.683], 0.8939),
        (HuGuo, [0.074, 0.271, 0.488, 0.697], 0.8999),
        (CarvalhoMartins, [0.129, 0.304, 0.500, 0.700], 0.9000),
        (Exact, nominal, 0.9),
    ];
    assert_eq!(table.map(|(law, ..)| law), RestitutionLaw::ALL);
    for (law, rows, last) in table {
        for (e, row) in nominal.into_iter().zip(rows) {
            assert!((delivered(law, e) - row).abs() <= 5.001e-4, "{law:?} {e}");
        }
        assert!((delivered(law, 0.9) - last).abs() <= 5.001e-5, "{law:?}");
    }
}

#[test]
fn delivered_restitution_to_eight_digits() {
    let rows = [
        (LankaraniNikravesh, 0.5, 0.72524111),
        (HuntCrossley, 0.5, 0.66296220),
        (Flores, 0.5, 0.47044478),
        (Gonthier, 0.5, 0.48774126),
        (LankaraniNikravesh, 0.9, 0.91317668),
        (HuntCrossley, 0.9, 0.90901574),
        (Flores, 0.9, 0.89392069),
        (Gonthier, 0.9, 0.87643542),
        (LankaraniNikravesh, 0.1, 0.66526541),
    ];
    for (law, e, expected) in rows {
        assert!((delivered(law, e) - expected).abs() <= 5.001e-9, "{law:?} {e}");
    }
    assert!((delivered(LankaraniNikravesh, 0.0) - 0.663).abs() < 5e-4);
}

#[test]
fn exact_damping_factors() {
    for (e, xi) in [
        (0.1, 9.9982),
        (0.3, 3.0871),
        (0.5, 1.4328),
        (0.7, 0.6348),
        (0.9, 0.1665),
    ] {
        assert!((Exact.damping_factor(e).unwrap() - xi).abs() <= 5.001e-5, "{e}");
    }
}

#[test]
fn full_restitution_needs_no_damping() {
    for law in RestitutionLaw::ALL {
        assert_eq!(law.damping_factor(1.0).unwrap(), 0.0, "{law:?}");
    }
}

#[test]
fn valid_ranges_are_what_the_delivered_restitution_says() {
    let lowest = [
        (HuntCrossley, 0.748),
        (HerbertMcWhannell, 0.604),
        (LeeWang, 0.905),
        (LankaraniNikravesh, 0.794),
        (Gonthier, 0.001),
        (ZhiyingQishao, 0.238),
        (Flores, 0.001),
        (HuGuo, 0.001),
        (CarvalhoMartins, 0.029),
        (Exact, 0.001),
    ];
    for (law, expected) in lowest {
        let range = law.valid_range();
        assert_eq!(*range.end(), 1.0);
        let start = *range.start();
        assert_eq!(start, expected, "{law:?}");
        for i in 0..=50 {
            let e = start + f64::from(i) / 50.0 * (1.0 - start);
            assert!(
                (delivered(law, e) - e).abs() <= RestitutionLaw::TOLERANCE + 1e-4,
                "{law:?} {e}"
            );
        }
        if start > 0.001 {
            let below = start - 1e-3;
            assert!(
                (delivered(law, below) - below).abs() > RestitutionLaw::TOLERANCE,
                "{law:?} {start}"
            );
        }
    }
}

#[test]
fn only_exact_delivers_what_is_asked_for() {
    for law in RestitutionLaw::ALL {
        let error = (delivered(law, 0.35) - 0.35).abs();
        assert_eq!(error < 1e-12, law == Exact, "{law:?} {error}");
    }
    assert!(near(delivered(Exact, 1e-6), 1e-6, 1e-12));
}

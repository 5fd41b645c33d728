//! Whatever numbers are given: an answer or a typed error, never a panic, in a bounded number of steps.

use linkdyn_integrators::{Integration, Method, Progress, Radau5, Rk4, Settings};
use proptest::prelude::*;

use crate::methods::adaptive;
use crate::problems::{Counting, Kink, boxed};

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -10.0..10.0,
        proptest::num::f64::ANY,
        Just(0.0),
        Just(-0.0),
        Just(f64::MIN_POSITIVE),
        Just(1e308),
        Just(f64::EPSILON),
    ]
}

fn run<M: Method<Counting<Kink>>>(method: M, t: [f64; 2], y0: [f64; 3], [relative, absolute, first]: [f64; 3]) {
    let settings = Settings {
        first_step: Some(first),
        max_steps: 300,
        ..Settings::tolerances(relative, absolute)
    };
    let Ok(mut run) = Integration::new(Counting::new(Kink), boxed(method), t[0], &y0, settings) else {
        return;
    };
    let mut y = [0.0; 3];
    loop {
        let progress = run.advance(t[1]);
        let (from, to) = run.last_step();
        let _ = run.interpolate(from + 0.5 * (to - from), &mut y);
        assert_eq!(run.statistics().evaluations, run.problem().evaluations);
        match progress {
            Ok(Progress::Done { t: end }) => {
                assert_eq!(end, t[1]);
                assert!(run.state().1.iter().all(|y| y.is_finite()));
                return;
            }
            Ok(_) => {}
            Err(_) => return,
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]
    #[test]
    fn no_panic(t in [number(), number()], y0 in [number(), number(), number()], settings in [number(), number(), number()]) {
        run(Rk4::new(settings[2]), t, y0, settings);
        for (_, method) in adaptive() {
            run(method, t, y0, settings);
        }
        run(Radau5::fixed(settings[2]), t, y0, settings);
    }
}

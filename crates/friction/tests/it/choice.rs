//! The enums give what the structs give, and take laws of the caller's own.

use crate::fixtures::*;
use linkdyn_friction::*;
use std::sync::Arc;

#[derive(Debug)]
struct Constant;

impl Characteristic for Constant {
    fn at(&self, slip: f64) -> Value {
        Value {
            value: slip.signum(),
            slope: 0.0,
        }
    }
}

impl BearingModel for Constant {
    fn capacity(&self, _: [f64; 3], _: [f64; 3]) -> Capacity {
        Capacity {
            value: 2.0,
            ..Capacity::default()
        }
    }
}

/// A spring that never slips.
impl BristleModel for Constant {
    fn at(&self, slip: f64, bristle: f64) -> BristlePoint {
        BristlePoint {
            coefficient: Partials {
                value: bristle,
                d_slip: 0.0,
                d_bristle: 1.0,
            },
            rate: Partials {
                value: slip,
                d_slip: 1.0,
                d_bristle: 0.0,
            },
        }
    }

    fn steady_bristle(&self, slip: f64) -> f64 {
        3.0 * slip
    }

    fn bristle_limit(&self) -> f64 {
        f64::INFINITY
    }

    fn is_passive_at(&self, _: f64) -> bool {
        true
    }
}

#[test]
fn chosen_law_is_the_law() {
    assert_eq!(Friction::from(EXPONENTIAL).at(0.004), EXPONENTIAL.at(0.004));
    assert_eq!(Friction::from(STRIBECK).at(-0.04), STRIBECK.at(-0.04));
    let sum = Sum {
        first: EXPONENTIAL,
        second: Viscous { per_speed: 2.0 },
    };
    assert_eq!(Friction::from(sum).at(0.3), sum.at(0.3));
    let (f, n) = ([1.0, 2.0, 3.0], [0.1, 0.2, 0.3]);
    assert_eq!(Bearing::from(JOURNAL).capacity(f, n), JOURNAL.capacity(f, n));
    assert_eq!(Bearing::from(GUIDE).capacity(f, n), GUIDE.capacity(f, n));
    assert_eq!(Bearing::from(JOURNAL).supports(), JOURNAL.supports());
    assert_eq!(Bearing::from(GUIDE).supports(), GUIDE.supports());
    let elastic = ElastoPlastic {
        lugre: LUGRE,
        elastic_share: 0.5,
    };
    for (choice, model) in [
        (Bristle::from(LUGRE), &LUGRE as &dyn BristleModel),
        (Bristle::from(elastic), &elastic),
    ] {
        assert_eq!(choice.at(0.01, 1e-4), model.at(0.01, 1e-4));
        assert_eq!(choice.steady_coefficient(0.01), model.steady_coefficient(0.01));
        assert_eq!(choice.steady_bristle(0.01), model.steady_bristle(0.01));
        assert_eq!(choice.bristle_limit(), model.bristle_limit());
        assert_eq!(choice.is_passive_at(0.1), model.is_passive_at(0.1));
    }
}

#[test]
fn own_laws_are_taken() {
    let own: Arc<dyn Characteristic> = Arc::new(Constant);
    assert_eq!(Friction::from(own.clone()).at(-3.0).value, -1.0);
    Friction::from(own).validate().unwrap();

    let own: Arc<dyn BearingModel> = Arc::new(Constant);
    assert_eq!(Bearing::from(own.clone()).capacity([0.0; 3], [0.0; 3]).value, 2.0);
    assert_eq!(Bearing::from(own.clone()).supports(), None);
    Bearing::from(own).validate().unwrap();

    let own: Arc<dyn BristleModel> = Arc::new(Constant);
    let own = Bristle::from(own);
    assert_eq!(own.steady_coefficient(2.0), 6.0);
    own.validate().unwrap();
}

#[test]
fn everything_can_be_shared_between_threads() {
    fn shared<T: Send + Sync + Clone + std::fmt::Debug>() {}
    shared::<Friction>();
    shared::<Bristle>();
    shared::<Bearing>();
}

//! Cost of one evaluation of each law: `cargo bench -p linkdyn-friction`.

use criterion::{Criterion, criterion_group, criterion_main};
use linkdyn_friction::{
    Bearing, BearingModel, BristleModel, Characteristic, Cubic, ElastoPlastic, Exponential, Friction, Guard,
    HyperbolicTangent, JournalBearing, LuGre, PadGuide, PiecewiseLinear, Stribeck, Surface,
};
use std::hint::black_box;

const JOURNAL: JournalBearing = JournalBearing {
    spacing: 0.03,
    surface_a: Surface {
        diameter: 0.01,
        coefficient: 0.2,
    },
    surface_b: Surface {
        diameter: 0.01,
        coefficient: 0.2,
    },
    face: Surface {
        diameter: 0.015,
        coefficient: 0.2,
    },
};

const GUIDE: PadGuide = PadGuide {
    spacing: 0.1,
    arm: 0.02,
    pad_a: 0.1,
    pad_b: 0.1,
    key: 0.1,
};

const LUGRE: LuGre = LuGre {
    static_coefficient: 0.2,
    kinetic_coefficient: 0.1,
    stribeck_speed: 0.0175,
    bristle_stiffness: 600.0,
    bristle_damping: 24.49489742783178,
    viscous_coefficient: 0.0,
    guard: Guard::None,
};

fn bearings(c: &mut Criterion) {
    let (f, n) = ([3.0, -20.0, 7.0], [0.3, 0.1, -0.2]);
    let choice = Bearing::from(JOURNAL);
    c.bench_function("bearing/journal", |b| {
        b.iter(|| black_box(JOURNAL).capacity(black_box(f), black_box(n)))
    });
    c.bench_function("bearing/journal by choice", |b| {
        b.iter(|| black_box(&choice).capacity(black_box(f), black_box(n)))
    });
    c.bench_function("bearing/pad guide", |b| {
        b.iter(|| black_box(GUIDE).capacity(black_box(f), black_box(n)))
    });
}

fn characteristics(c: &mut Criterion) {
    let reference_speed = 0.01;
    let exponential = Exponential {
        reference_speed,
        steepness: 3.0,
    };
    let laws: [(&str, Friction); 5] = [
        ("exponential", exponential.into()),
        ("piecewise linear", PiecewiseLinear { reference_speed }.into()),
        ("hyperbolic tangent", HyperbolicTangent { reference_speed }.into()),
        ("cubic", Cubic { reference_speed }.into()),
        (
            "stribeck",
            Stribeck {
                static_ratio: 1.5,
                stribeck_speed: 0.1,
                exponent: 2.0,
                reference_speed,
            }
            .into(),
        ),
    ];
    for (name, law) in &laws {
        c.bench_function(&format!("characteristic/{name}"), |b| {
            b.iter(|| black_box(law).at(black_box(0.004)))
        });
    }
}

fn bristles(c: &mut Criterion) {
    let capped = LuGre {
        guard: Guard::Cap,
        ..LUGRE
    };
    let elastic = ElastoPlastic {
        lugre: LUGRE,
        elastic_share: 0.7,
    };
    let (v, z) = (0.02, 2e-4);
    c.bench_function("bristle/lugre", |b| {
        b.iter(|| black_box(LUGRE).at(black_box(v), black_box(z)))
    });
    c.bench_function("bristle/lugre, capped", |b| {
        b.iter(|| black_box(capped).at(black_box(v), black_box(z)))
    });
    c.bench_function("bristle/elasto-plastic", |b| {
        b.iter(|| black_box(elastic).at(black_box(v), black_box(z)))
    });
    c.bench_function("bristle/exact step", |b| {
        b.iter(|| black_box(LUGRE).step(black_box(v), black_box(z), black_box(1e-4)))
    });
}

criterion_group!(laws, bearings, characteristics, bristles);
criterion_main!(laws);

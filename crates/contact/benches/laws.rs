//! Cost of one force and of one geometry: `cargo bench -p linkdyn-contact`.

use criterion::{Criterion, criterion_group, criterion_main};
use linkdyn_contact::{Centre, ContactLaw, Damping, Fit, ForcePoint, NormalLaw, NormalModel, RestitutionLaw};
use nalgebra::Vector3;
use std::hint::black_box;

fn laws(c: &mut Criterion) {
    let damping = RestitutionLaw::LankaraniNikravesh.with(0.9);
    let law = NormalLaw::new(2.176e10, 1.5, damping).unwrap();
    let general = NormalLaw::new(2.176e10, 1.6, damping).unwrap();
    let material = NormalLaw::new(2.176e10, 1.5, Damping::Material { constant: 0.3 }).unwrap();
    let choice = ContactLaw::from(law);
    let (depth, rate, speed) = (3e-6, -0.02, 0.1);
    let mut run = |name: &str, law: &dyn NormalModel| {
        c.bench_function(name, |b| {
            b.iter(|| law.at(black_box(depth), black_box(rate), black_box(speed)))
        });
    };
    run("law/exponent 1.5", &law);
    run("law/exponent 1.6", &general);
    run("law/material", &material);
    run("law/by choice", &choice);
    c.bench_function("law/restitution delivered", |b| {
        b.iter(|| black_box(law).delivered_restitution(black_box(speed)))
    });
    c.bench_function("law/exact damping factor", |b| {
        b.iter(|| RestitutionLaw::Exact.damping_factor(black_box(0.7)))
    });
}

fn geometry(c: &mut Criterion) {
    let fit = Fit::new(0.005, 0.004).unwrap();
    let bearing = Centre {
        point: Vector3::new(0.1, 0.2, 0.3),
        velocity: Vector3::new(0.3, -0.1, 0.2),
        spin: Vector3::new(1.0, 5.0, -3.0),
        axis: Vector3::z(),
    };
    let journal = Centre {
        point: bearing.point + Vector3::new(0.8e-3, 0.7e-3, 1e-4),
        axis: Vector3::new(0.01, 0.02, 1.0).normalize(),
        ..bearing
    };
    c.bench_function("geometry/gap", |b| {
        b.iter(|| fit.gap(black_box(&bearing), black_box(&journal)))
    });
    c.bench_function("geometry/planar with force", |b| {
        b.iter(|| {
            let touch = fit.planar(black_box(&bearing), black_box(&journal));
            touch.map(|touch| touch.force(10.0, [1.0, 0.0], ForcePoint::Common))
        })
    });
    c.bench_function("geometry/edges", |b| {
        b.iter(|| fit.edges(0.02, black_box(&bearing), black_box(&journal)))
    });
}

criterion_group!(benches, laws, geometry);
criterion_main!(benches);

//! Any text is refused with what is wrong, or read to a linkage that can be built, drawn, closed and evaluated.

#![no_main]

use libfuzzer_sys::fuzz_target;
use linkdyn_mechanisms::{Observation, Simulation, file};

fuzz_target!(|text: &str| {
    let scene = match file::scene("fuzz", text) {
        Ok(scene) => scene,
        Err(error) => {
            let lines = text.matches('\n').count() + 1;
            assert!(!error.0.is_empty() && error.0.iter().all(|fault| (1..=lines).contains(&fault.place.0)));
            return;
        }
    };
    let built = scene.linkage.build();
    assert!(built.is_ok(), "read, but not built: {:?}", built.err());
    assert!(scene.linkage.outline().starts_with("ground\n"));
    let Ok(mechanism) = built else { return };
    // May close or not, and have accelerations or not, but with numbers where it does.
    let Ok((start, _)) = mechanism.assemble(&scene.start) else {
        return;
    };
    let mut simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&start);
    let mut seen = Observation::default();
    if simulation.observe(0.0, &y, &mut seen).is_ok() {
        assert!(seen.a.iter().all(|a| a.is_finite()), "accelerations that are no numbers");
    }
});

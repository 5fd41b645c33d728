//! Any text is refused with what is wrong, or read to a linkage that can be built.

#![no_main]

use libfuzzer_sys::fuzz_target;
use linkdyn_mechanisms::file;

fuzz_target!(|text: &str| {
    match file::scene("fuzz", text) {
        Ok(scene) => {
            let built = scene.linkage.build();
            assert!(built.is_ok(), "read, but not built: {:?}", built.err());
        }
        Err(error) => {
            let lines = text.matches('\n').count() + 1;
            assert!(!error.0.is_empty() && error.0.iter().all(|fault| (1..=lines).contains(&fault.place.0)));
        }
    }
});

//! The built-in scenes.

use linkdyn_mechanisms::Scene;
use linkdyn_mechanisms::catalogue::{Rsrrr, rsrrr};

use crate::args::ScenesArgs;
use crate::errors::CliError;
use crate::output;
use crate::summary::{Cell, Table};

/// What the command line may switch in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    /// Whether the joints have friction.
    pub friction: bool,
    /// Factor on all coefficients of friction.
    pub friction_scale: f64,
}

/// A built-in scene.
pub struct Entry {
    /// Name on the command line.
    pub name: &'static str,
    make: fn(&Variant) -> Scene,
}

/// All built-in scenes.
pub const SCENES: &[Entry] = &[Entry {
    name: "rsrrr",
    make: |variant| {
        rsrrr(&Rsrrr {
            friction: variant.friction,
            friction_scale: variant.friction_scale,
        })
    },
}];

/// The scene of a name.
///
/// # Errors
/// Unknown names, with the nearest known one.
pub fn find(name: &str) -> Result<&'static Entry, CliError> {
    let known = || SCENES.iter().map(|entry| entry.name);
    SCENES
        .iter()
        .find(|entry| entry.name == name)
        .ok_or_else(|| CliError::unknown("scene", name, known()))
}

impl Entry {
    /// The scene with what the command line switched.
    #[must_use]
    pub fn scene(&self, variant: &Variant) -> Scene {
        (self.make)(variant)
    }
}

/// `linkdyn scenes`.
///
/// # Errors
/// Only those of standard output.
pub fn list(args: &ScenesArgs) -> Result<(), CliError> {
    let mut table = Table::new("scenes", &[("scene", ""), ("what it is", ""), ("until", "s")]);
    for entry in SCENES {
        let scene = entry.scene(&Variant {
            friction: false,
            friction_scale: 1.0,
        });
        table.row([
            Cell::text(entry.name),
            Cell::text(scene.summary),
            Cell::number(scene.until),
        ]);
    }
    if args.json {
        output::print(&format!("{:#}\n", table.to_json()))
    } else {
        output::print(&table.to_text())
    }
}

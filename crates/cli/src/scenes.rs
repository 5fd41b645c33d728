//! The built-in scenes and what the command line may switch in them; scene files, those of the user and those that the program carries.

use std::path::{Path, PathBuf};

use linkdyn_mechanisms::Scene;
use linkdyn_mechanisms::catalogue::{ClearanceKind, Rsrrr, Rsup, bristle, rsrrr, rsup};
use linkdyn_mechanisms::dynamics::Baumgarte;
use linkdyn_mechanisms::file;
use linkdyn_mechanisms::friction::{Bristle, BristleStart, ElastoPlastic, Guard, LuGre};

use crate::args::{BristleArg, ClearanceArg, ScenesArgs, VariantArgs};
use crate::errors::CliError;
use crate::output;
use crate::summary::{Cell, Table};

/// What the command line may switch in a scene; `None` leaves it as the scene has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variant {
    /// Whether there is friction.
    pub friction: Option<bool>,
    /// Factor on all coefficients of friction.
    pub friction_scale: Option<f64>,
    /// Clearance of a joint.
    pub clearance: Option<ClearanceArg>,
    /// Its size \[m\].
    pub clearance_size: Option<f64>,
    /// Friction in it.
    pub bristle: Option<BristleArg>,
    /// Number of spring-damping elements.
    pub flexible: Option<u16>,
    /// Whether drift terms take the place of projection.
    pub as_published: bool,
}

impl Variant {
    /// What the command line asks for; `as_published` is asked for apart.
    #[must_use]
    pub fn new(args: &VariantArgs, as_published: bool) -> Self {
        Self {
            friction: (args.friction || args.no_friction).then_some(args.friction),
            friction_scale: args.friction_scale,
            clearance: args.clearance,
            clearance_size: args.clearance_size,
            bristle: args.bristle,
            flexible: args.flexible,
            as_published,
        }
    }

    /// The options given, by name.
    fn given(&self) -> impl Iterator<Item = &'static str> {
        [
            (self.friction_scale.is_some(), "--friction-scale"),
            (self.clearance.is_some(), "--clearance"),
            (self.clearance_size.is_some(), "--clearance-size"),
            (self.bristle.is_some(), "--bristle"),
            (self.flexible.is_some(), "--flexible"),
            (self.as_published, "--as-published"),
        ]
        .into_iter()
        .filter_map(|(given, name)| given.then_some(name))
    }
}

/// A scene: built in, or in a file.
#[derive(Clone)]
pub struct Entry {
    /// Name on the command line; `FILE` for all files.
    pub name: &'static str,
    /// Options of `linkdyn run` that switch something in this scene alone.
    options: &'static [&'static str],
    make: Make,
    /// What the variant is called in pictures and in the name of the folder.
    label: fn(&Variant) -> String,
    /// Simpler or other variants that pictures show beside this one.
    beside: fn(&Variant) -> Vec<Variant>,
}

/// How a scene comes to be.
#[derive(Clone)]
enum Make {
    BuiltIn(fn(&Variant) -> Result<Scene, CliError>),
    /// Text of an example.
    Example(&'static str),
    File(PathBuf),
}

/// The built-in scenes that have variants.
pub const SCENES: &[Entry] = &[
    Entry {
        name: "rsrrr",
        options: &["--friction-scale"],
        make: Make::BuiltIn(|variant| {
            Ok(rsrrr(&Rsrrr {
                friction: variant.friction.unwrap_or(false),
                friction_scale: variant.friction_scale.unwrap_or(1.0),
            }))
        }),
        label: |variant| match variant.friction {
            Some(true) => "joint friction".into(),
            _ => "ideal joints".into(),
        },
        beside: |variant| {
            let friction = Some(!variant.friction.unwrap_or(false));
            vec![Variant { friction, ..*variant }]
        },
    },
    Entry {
        name: "rsup",
        options: &[
            "--clearance",
            "--clearance-size",
            "--bristle",
            "--flexible",
            "--as-published",
        ],
        make: Make::BuiltIn(make_rsup),
        label: |variant| {
            let joint = match (variant.clearance, variant.friction) {
                (None, _) => "ideal joint",
                (Some(ClearanceArg::Planar), Some(false)) => "planar clearance without friction",
                (Some(ClearanceArg::Planar), _) => "planar clearance",
                (Some(ClearanceArg::Spatial), Some(false)) => "spatial clearance without friction",
                (Some(ClearanceArg::Spatial), _) => "spatial clearance",
            };
            match variant.flexible {
                None => joint.into(),
                Some(n) => format!("{joint}, flexible coupler of {n}"),
            }
        },
        beside: |variant| {
            let rigid = Variant {
                flexible: None,
                ..*variant
            };
            let ideal = Variant {
                clearance: None,
                clearance_size: None,
                bristle: None,
                ..rigid
            };
            let mut others = Vec::new();
            if variant.clearance.is_some() {
                others.push(ideal);
            }
            if variant.flexible.is_some() {
                others.push(rigid);
            }
            others
        },
    },
];

fn make_rsup(variant: &Variant) -> Result<Scene, CliError> {
    let default = Rsup::default();
    let scene = rsup(&Rsup {
        clearance: variant.clearance.map(|kind| match kind {
            ClearanceArg::Planar => ClearanceKind::Planar,
            ClearanceArg::Spatial => ClearanceKind::Spatial,
        }),
        clearance_size: variant.clearance_size.unwrap_or(default.clearance_size),
        friction: variant
            .friction
            .unwrap_or(true)
            .then(|| friction(variant.bristle.unwrap_or(BristleArg::Lugre))),
        bristle_start: match variant.bristle {
            Some(BristleArg::Steady) => BristleStart::Steady,
            _ => BristleStart::Relaxed,
        },
        flexible: variant.flexible.map(usize::from),
    });
    let mut scene = scene.map_err(|error| CliError::usage("there is no such scene").with_source(error))?;
    if variant.as_published {
        let (alpha, beta) = (100.0, 50.0);
        scene.linkage.baumgarte = Some(Baumgarte { alpha, beta });
    }
    Ok(scene)
}

/// The published friction of the clearance joint, and its guarded forms.
fn friction(model: BristleArg) -> Bristle {
    let published = bristle();
    let capped = LuGre {
        guard: Guard::Cap,
        ..published
    };
    match model {
        BristleArg::Lugre | BristleArg::Steady => published.into(),
        BristleArg::Cap => capped.into(),
        BristleArg::Decay => LuGre {
            // Beyond the Stribeck speed, where sliding is well under way.
            guard: Guard::Decay {
                speed: published.stribeck_speed,
            },
            ..published
        }
        .into(),
        BristleArg::ElastoPlastic => ElastoPlastic {
            lugre: capped,
            elastic_share: 0.7,
        }
        .into(),
        BristleArg::Dahl => LuGre::dahl(published.kinetic_coefficient, published.bristle_stiffness).into(),
    }
}

/// The scene of a name, or of the path of a scene file: one that ends in `.toml` or leads through folders.
///
/// # Errors
/// Unknown names, with the nearest known one.
pub fn find(name: &str) -> Result<Entry, CliError> {
    if is_file(name) {
        return Ok(as_written("FILE", Make::File(name.into())));
    }
    let known = || all().map(|entry| entry.name);
    let entry = all().find(|entry| entry.name == name);
    entry.ok_or_else(|| CliError::unknown("scene", name, known()))
}

/// All built-in scenes: those with variants, then the examples as their files have them.
fn all() -> impl Iterator<Item = Entry> {
    let is_new = |name: &str| SCENES.iter().all(|entry| entry.name != name);
    let examples = file::EXAMPLES.iter().filter(move |(name, _)| is_new(name));
    let examples = examples.map(|(name, text)| as_written(name, Make::Example(text)));
    SCENES.iter().cloned().chain(examples)
}

/// A scene in which the command line switches nothing.
fn as_written(name: &'static str, make: Make) -> Entry {
    Entry {
        name,
        options: &[],
        make,
        label: |_| "as in the file".into(),
        beside: |_| Vec::new(),
    }
}

/// The text of an example's file.
///
/// # Errors
/// Unknown names, with the nearest known one.
pub fn example(name: &str) -> Result<&'static str, CliError> {
    let example = file::EXAMPLES.iter().find(|(known, _)| *known == name);
    let known = file::EXAMPLES.iter().map(|(known, _)| *known);
    example
        .map(|(_, text)| *text)
        .ok_or_else(|| CliError::unknown("scene", name, known))
}

fn is_file(name: &str) -> bool {
    name.ends_with(".toml") || name.contains(std::path::is_separator)
}

/// Name of a scene without folder and ending.
pub(crate) fn stem(name: &str) -> &str {
    let stem = Path::new(name).file_stem().and_then(|stem| stem.to_str());
    stem.filter(|_| is_file(name)).unwrap_or(name)
}

/// The scene of a file.
///
/// # Errors
/// Files that cannot be read; all that is wrong in one.
pub fn read(path: &Path) -> Result<Scene, CliError> {
    let shown = path.display();
    let text = std::fs::read_to_string(path);
    let text = text.map_err(|error| CliError::usage(format!("cannot read `{shown}`")).with_source(error))?;
    let name = path.to_str().map_or("scene", stem);
    file::scene(name, &text)
        .map_err(|error| CliError::usage(format!("scene file `{shown}` is not right")).with_source(error))
}

impl Entry {
    /// The scene with what the command line switched.
    ///
    /// # Errors
    /// Options that this scene does not have, values that make no sense for it.
    pub fn scene(&self, variant: &Variant) -> Result<Scene, CliError> {
        if let Some(option) = variant.given().find(|option| !self.options.contains(option)) {
            let message = format!("`{option}` does not go with scene `{}`", self.name);
            let others = SCENES.iter().filter(|entry| entry.options.contains(&option));
            let others: Vec<_> = others.map(|entry| entry.name).collect();
            return Err(CliError::usage(message).with_hint(format!("scenes that have it: {}", others.join(", "))));
        }
        let needs_clearance = [
            (variant.clearance_size.is_some(), "--clearance-size"),
            (variant.bristle.is_some(), "--bristle"),
        ];
        if let Some((_, option)) = needs_clearance
            .into_iter()
            .find(|(given, _)| *given && variant.clearance.is_none())
        {
            let message = format!("`{option}` says nothing without `--clearance`");
            return Err(CliError::usage(message).with_hint("add `--clearance planar` or `--clearance spatial`"));
        }
        if variant.bristle.is_some() && variant.friction == Some(false) {
            let message = "`--bristle` says nothing with `--no-friction`";
            return Err(CliError::usage(message).with_hint("leave one of them out"));
        }
        match &self.make {
            Make::BuiltIn(make) => make(variant),
            Make::File(_) if variant.friction.is_some() => {
                let message = "`--friction` and `--no-friction` do not go with scene files";
                Err(CliError::usage(message).with_hint("write or delete `friction` in the file"))
            }
            Make::Example(_) if variant.friction.is_some() => {
                let name = self.name;
                let message = format!("`--friction` and `--no-friction` do not go with scene `{name}`");
                let hint = format!(
                    "`linkdyn new mine.toml --from {name}` writes its file, in which `friction` can be given to joints"
                );
                Err(CliError::usage(message).with_hint(hint))
            }
            Make::Example(text) => file::scene(self.name, text)
                .map_err(|error| CliError::failed(format!("scene `{}` is not right", self.name)).with_source(error)),
            Make::File(path) => read(path),
        }
    }

    /// What a variant is called.
    #[must_use]
    pub fn label(&self, variant: &Variant) -> String {
        (self.label)(variant)
    }

    /// Variants that pictures show beside this one.
    #[must_use]
    pub fn beside(&self, variant: &Variant) -> Vec<Variant> {
        (self.beside)(variant)
    }
}

/// `linkdyn scenes`.
///
/// # Errors
/// Only those of standard output.
pub fn list(args: &ScenesArgs) -> Result<(), CliError> {
    let mut table = Table::new(
        "scenes",
        &[("scene", ""), ("what it is", ""), ("until", "s"), ("options", "")],
    );
    for entry in all() {
        let scene = entry.scene(&Variant::default())?;
        let options = match entry.make {
            Make::BuiltIn(_) => format!("--friction --no-friction {}", entry.options.join(" ")),
            _ => String::new(),
        };
        table.row([
            Cell::text(entry.name),
            Cell::text(scene.summary),
            Cell::number(scene.until),
            Cell::text(options),
        ]);
    }
    if args.json {
        output::print(&format!("{:#}\n", table.to_json()))
    } else {
        output::print(&table.to_text())
    }
}

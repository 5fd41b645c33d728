//! Flexible links of a scene file: their format, and how they are read.

use super::fault::Faults;
use crate::flexible::{Along, FlexibleLink};
use crate::linkage::Linkage;
use linkdyn_rfem::{BeamError, Division, Material, Section, divide};
use schemars::JsonSchema;
use serde::Deserialize;

/// A flexible beam as rigid finite elements with springs between them. It begins at the origin of the link's frame; its end is where a
/// joint sits with `end = true`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BeamItem {
    /// Axis of the link's frame along which it runs; x unless given.
    #[serde(default = "x")]
    pub along: Along,
    /// Length \[m\].
    pub length: f64,
    /// Cross section.
    pub section: SectionItem,
    /// Density \[kg/m^3\].
    pub density: f64,
    /// Young's modulus \[Pa\].
    pub youngs_modulus: f64,
    /// Poisson's ratio \[-\].
    pub poissons_ratio: f64,
    /// Relaxation time \[s\]: every damping is this times its stiffness; zero unless given.
    #[serde(default)]
    pub relaxation_time: f64,
    /// Number of spring-damping elements, 1 to 500, also for all beams together; there is one rigid element more.
    #[schemars(range(min = 1, max = 500))]
    pub elements: u16,
    /// Names of the three turns about z, y and x in each spring-damping element, whose number is put behind with a dot: `NAME.1.psi` and
    /// so on unless given.
    pub coordinates: Option<[String; 3]>,
    /// Whether it is held straight while the loops are closed; yes unless given.
    #[serde(default = "yes")]
    pub straight: bool,
}

fn x() -> Along {
    Along::X
}

fn yes() -> bool {
    true
}

/// A cross section.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum SectionItem {
    /// A full circle.
    Circle {
        /// Diameter \[m\].
        diameter: f64,
    },
    /// A circular tube.
    Tube {
        /// Outer diameter \[m\].
        outer_diameter: f64,
        /// Inner diameter \[m\].
        inner_diameter: f64,
    },
    /// A rectangle.
    Rectangle {
        /// Side along the next axis behind the beam's in the order x, y, z, x \[m\].
        width: f64,
        /// The other side \[m\].
        height: f64,
    },
}

/// Adds the beam `name` with the names of its coordinates; a rigid link without mass where it cannot be.
pub(super) fn add(name: &str, item: &BeamItem, linkage: &mut Linkage, faults: &mut Faults<'_>) -> Option<FlexibleLink> {
    let keys = ["links", name, "beam"];
    let section = section(&item.section).map_err(|error| {
        faults.add(&[&keys[..], &["section"]].concat(), error.to_string());
    });
    let material = Material::isotropic(
        item.density,
        item.youngs_modulus,
        item.poissons_ratio,
        item.relaxation_time,
    );
    let beam = material.and_then(|material| match &section {
        Ok(section) => divide(
            item.length,
            section,
            &material,
            Division::Standard(item.elements.into()),
        )
        .map(Some),
        Err(()) => Ok(None),
    });
    let beam = beam.unwrap_or_else(|error| {
        let key = error.item.rsplit('.').next().unwrap_or_default();
        faults.add(&[&keys[..], &[key]].concat(), error.to_string());
        None
    })?;
    let link = linkage.flexible_link(name, &beam, item.along);
    for (&joint, r) in link.joints.iter().zip(1..) {
        if let Some(names) = &item.coordinates {
            let names = names.each_ref().map(|name| format!("{name}.{r}"));
            linkage.coordinate_names(joint, &names.each_ref().map(String::as_str));
        }
    }
    Some(link)
}

fn section(item: &SectionItem) -> Result<Section, BeamError> {
    match *item {
        SectionItem::Circle { diameter } => Section::circle(diameter),
        SectionItem::Tube {
            outer_diameter,
            inner_diameter,
        } => Section::tube(outer_diameter, inner_diameter),
        SectionItem::Rectangle { width, height } => Section::rectangle(width, height),
    }
}

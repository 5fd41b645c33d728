//! The example linkages that come with the library.

/// The scene files of linkages that people know, as name and text, in the order of their names. Each says where its data come from and
/// what is known about it.
pub const EXAMPLES: &[(&str, &str)] = &[
    ("andrews_squeezer", include_str!("../../scenes/andrews_squeezer.toml")),
    ("bennett", include_str!("../../scenes/bennett.toml")),
    ("bricard", include_str!("../../scenes/bricard.toml")),
    ("cardan_shaft", include_str!("../../scenes/cardan_shaft.toml")),
    ("flyball_governor", include_str!("../../scenes/flyball_governor.toml")),
    ("four_bar", include_str!("../../scenes/four_bar.toml")),
    ("n_four_bar", include_str!("../../scenes/n_four_bar.toml")),
    ("pendulum", include_str!("../../scenes/pendulum.toml")),
    ("rsrrr", include_str!("../../scenes/rsrrr.toml")),
    ("rsrrr_friction", include_str!("../../scenes/rsrrr_friction.toml")),
    ("rssp", include_str!("../../scenes/rssp.toml")),
    ("rssr", include_str!("../../scenes/rssr.toml")),
    ("rsup", include_str!("../../scenes/rsup.toml")),
    ("rsup_clearance", include_str!("../../scenes/rsup_clearance.toml")),
    ("rsup_flexible", include_str!("../../scenes/rsup_flexible.toml")),
    ("slider_crank", include_str!("../../scenes/slider_crank.toml")),
    (
        "spatial_slider_crank",
        include_str!("../../scenes/spatial_slider_crank.toml"),
    ),
    ("stewart_platform", include_str!("../../scenes/stewart_platform.toml")),
];

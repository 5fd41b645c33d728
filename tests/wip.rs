//! wip
#[path = "it/scene_broken.rs"]
mod scene_broken;
#[path = "it/scene_clearance.rs"]
mod scene_clearance;
#[path = "it/scene_faults.rs"]
mod scene_faults;
#[path = "it/scene_files.rs"]
mod scene_files;
#[path = "it/scene_keys.rs"]
mod scene_keys;

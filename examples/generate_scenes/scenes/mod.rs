//! The demo scenes, as files.

mod blocks;
mod courtyard;
mod glb;
mod solid;

/// Every file of `scenes/` that is generated, by name.
pub fn all() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("courtyard.glb", courtyard::glb()),
        ("blocks.obj", blocks::obj().into_bytes()),
        ("blocks.mtl", blocks::MATERIALS.into()),
    ]
}

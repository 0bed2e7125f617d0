//! glTF 2.0, as JSON or as GLB.
//!
//! Each primitive of a mesh becomes one object for each node that shows the mesh, named after the node; the
//! instances of a node are numbered. What a document declares is checked before it is used: [`container`]
//! splits and parses, [`nodes`] checks the tree, [`accessors`] the sizes; [`totals`] counts triangles with all
//! their instances before any is made. Then [`meshes`] reads, poses ([`morphs`], [`skins`]) and places.
//! Positions stay in f64 all the way from the file's numbers to the one rounding in the world.

mod accessors;
mod alpha;
mod animations;
mod buffers;
mod cameras;
mod components;
mod container;
mod extras;
mod findings;
mod images;
mod instancing;
mod lights;
mod materials;
mod meshes;
mod morphs;
mod nodes;
mod primitives;
mod schema;
mod skins;
mod sparse;
mod textures;
mod totals;

use self::accessors::Accessors;
use self::alpha::{Masks, Presence};
use self::animations::Joints;
use self::buffers::Buffers;
use self::container::Parts;
use self::findings::Findings;
use self::meshes::Meshes;
use self::nodes::Placed;
use self::schema::Document;
use super::confined::{self, Room};
use super::limits::MAX_LIGHTS;
use super::scene_name;
use super::text::printable;
use crate::error::{Error, Place, Result};
use crate::memory::MemoryLimit;
use crate::scene::animation::{Hold, Motion, MovingElement, Subject};
use crate::scene::{Animation, SceneBuilder};
use std::path::Path;

/// What the name of a file says about its form.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Container {
    /// JSON text.
    Text,
    /// GLB.
    Binary,
}

/// Reads a glTF file.
///
/// # Errors
/// One line with file and place (a line of the JSON, or an element by index and name) for whatever cannot be
/// read as geometry, camera or light, and for required extensions that are not supported.
pub(super) fn load(path: &Path, named: Container, limit: MemoryLimit) -> Result<Animation> {
    let bytes = confined::read_scene(path)?;
    let Parts { document, binary } = container::open(path, &bytes, named)?;
    let at = |element: String, why: String| Error::input(path, Place::Element(element), why);
    check_asset(&document).map_err(|(element, why)| at(element.into(), why))?;
    let placed = nodes::place_all(&document).map_err(|(index, why)| match index {
        usize::MAX => at("scenes".into(), why),
        _ => at(nodes::describe(&document, index), why),
    })?;
    let needed = totals::check(&document, &placed, limit).map_err(|(element, why)| at(element, why))?;

    let mut builder = SceneBuilder::new(scene_name(path));
    let mut findings = Findings::default();
    let buffers = Buffers::new(&document.buffers, binary, Room::beside(path)?);
    let accessors = Accessors::new(&document, &buffers);
    let mut masks = Masks::new(&document, &buffers, &accessors, limit);
    let mut presences = Vec::new();
    for (index, entry) in document.materials.iter().enumerate() {
        let presence = match needed[index] {
            true => masks.presence(entry, &mut builder),
            // Its image is nobody's business.
            false => Ok(Presence::Solid),
        };
        let presence = presence.map_err(|why| at(materials::describe(entry, index), why))?;
        builder.add_material(materials::convert(entry, index, presence.coverage()));
        findings.note(entry, &presence);
        presences.push(presence);
    }
    let joints = Joints::read(&document, &accessors, &placed, &mut findings, limit)
        .map_err(|(element, why)| at(element, why))?;
    let mut motion = Motion::default();
    let mut meshes = Meshes::new(&document, &accessors, presences, &placed);
    for place in &placed {
        let describe = || nodes::describe(&document, place.index);
        let joint = joints.of(place.index);
        if let Some(index) = place.node.mesh {
            let moving = meshes
                .show(place, index, joint, &mut builder, &mut findings)
                .map_err(|(element, why)| at(element, why))?;
            motion.objects.extend(moving);
            if place.node.skin.is_some_and(|skin| joints.move_skin(&document, skin)) {
                findings.not_drawn("animated joints of skins", describe());
            }
        }
        let hold = Hold { joint, offset: None };
        if let Some(index) = place.node.camera {
            let read = |place: &Placed| cameras::read(&document, place, index);
            match read(place).map_err(|why| at(describe(), why))? {
                Some(camera) => {
                    if joint.is_some()
                        && let Ok(Some(own)) = read(&place.by_itself())
                    {
                        let index = builder.camera_count();
                        let subject = Subject::Still(own);
                        motion.cameras.push(MovingElement { index, subject, hold: hold.clone() });
                    }
                    builder.add_camera(camera);
                }
                None => findings.not_drawn("orthographic cameras", describe()),
            }
        }
        if let Some(light) = &place.node.extensions.light {
            let read = |place: &Placed| {
                lights::read(&document, place, light.light).map_err(|why| at(describe(), why))
            };
            if joint.is_some() {
                let (index, subject) = (builder.light_count(), Subject::Still(read(&place.by_itself())?));
                motion.lights.push(MovingElement { index, subject, hold });
            }
            builder.add_light(read(place)?);
            findings.lights += 1;
            if findings.lights > MAX_LIGHTS {
                return Err(at(describe(), format!("expected at most {MAX_LIGHTS} lights")));
            }
        }
    }
    findings.warn(&document, &mut builder);
    motion.rig = joints.rig;
    Ok(Animation { rest: builder.finish(), motion, rate: None })
}

/// Extensions whose demands are met.
const SUPPORTED: [&str; 6] = [
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Whether an extension concerns the look of surfaces alone: without it the geometry is still right.
fn is_appearance(extension: &str) -> bool {
    ["KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_"]
        .iter()
        .any(|p| extension.starts_with(p))
}

fn check_asset(document: &Document) -> std::result::Result<(), (&'static str, String)> {
    let asset = &document.asset;
    if !asset.version.starts_with("2.") {
        return Err(("asset", format!("expected version 2.0, found `{}`", printable(&asset.version))));
    }
    if let Some(minimum) = asset.min_version.as_deref().filter(|minimum| *minimum != "2.0") {
        return Err(("asset", format!("it needs version `{}`, and 2.0 is supported", printable(minimum))));
    }
    let mut required = document.extensions_required.iter().map(String::as_str);
    match required.find(|name| !SUPPORTED.contains(name) && !is_appearance(name)) {
        Some(name) => Err(("extensionsRequired", format!("`{}` is not supported", printable(name)))),
        None => Ok(()),
    }
}

//! glTF 2.0, as JSON or as GLB.
//!
//! Each primitive of a mesh becomes one object for each node that shows the mesh, named after the node. What
//! a document declares is checked before it is used: [`container`] splits and parses, [`nodes`] checks the
//! tree, [`accessors`] the sizes; triangles are counted with all their instances before any is made.

mod accessors;
mod buffers;
mod cameras;
mod container;
mod lights;
mod materials;
mod nodes;
mod primitives;
mod schema;

use self::buffers::Buffers;
use self::container::Parts;
use self::lights::Shining;
use self::nodes::Placed;
use self::primitives::{Geometry, Mode};
use self::schema::{Document, Mesh, Primitive};
use super::confined::{self, Room};
use super::limits::{MAX_LIGHTS, MAX_OBJECTS, MAX_TRIANGLES};
use super::scene_name;
use super::text::{counted, printable};
use crate::error::{Error, Place, Result};
use crate::scene::{ObjectInput, Scene, SceneBuilder};
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
pub(super) fn load(path: &Path, named: Container) -> Result<Scene> {
    let bytes = confined::read_scene(path)?;
    let Parts { document, binary } = container::open(path, &bytes, named)?;
    let at = |element: String, why: String| Error::input(path, Place::Element(element), why);
    check_asset(&document).map_err(|(element, why)| at(element.into(), why))?;
    let placed = nodes::place_all(&document).map_err(|(index, why)| match index {
        usize::MAX => at("scenes".into(), why),
        _ => at(nodes::describe(&document, index), why),
    })?;
    check_total(&document, &placed).map_err(|(element, why)| at(element, why))?;

    let mut builder = SceneBuilder::new(scene_name(path));
    let mut findings = Findings::default();
    for (index, entry) in document.materials.iter().enumerate() {
        builder.add_material(materials::convert(entry, index));
        findings.materials.note(entry);
    }
    let buffers = Buffers::new(&document.buffers, binary, Room::beside(path)?);
    let mut meshes = Meshes { document: &document, buffers: &buffers, read: Vec::new() };
    for place in &placed {
        let describe = || nodes::describe(&document, place.index);
        if let Some(index) = place.node.mesh {
            meshes
                .show(place, index, &mut builder, &mut findings)
                .map_err(|(element, why)| at(element, why))?;
        }
        if let Some(index) = place.node.camera {
            match cameras::read(&document, place, index).map_err(|why| at(describe(), why))? {
                Some(camera) => builder.add_camera(camera),
                None => findings.not_drawn("orthographic cameras", describe()),
            }
        }
        if let Some(light) = &place.node.extensions.light {
            match lights::read(&document, place, light.light).map_err(|why| at(describe(), why))? {
                Shining::Point(light) => {
                    findings.lights += 1;
                    if findings.lights > MAX_LIGHTS {
                        return Err(at(describe(), format!("expected at most {MAX_LIGHTS} lights")));
                    }
                    builder.add_light(light);
                }
                Shining::Other(kind, name) => {
                    let kinds = if kind == "spot" { "spot lights" } else { "directional lights" };
                    findings.not_drawn(kinds, name);
                }
            }
        }
        if place.node.skin.is_some() {
            findings.not_drawn("skins", describe());
        }
        if place.node.extensions.instancing.is_some() {
            findings.not_drawn("instances of EXT_mesh_gpu_instancing", describe());
        }
    }
    findings.warn(&document, &mut builder);
    Ok(builder.finish())
}

/// Extensions whose demands are met.
const SUPPORTED: [&str; 1] = ["KHR_lights_punctual"];

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

fn mesh_at(document: &Document, index: u64) -> std::result::Result<(usize, &Mesh), String> {
    let position = usize::try_from(index).ok().filter(|&i| i < document.meshes.len());
    let position = position.ok_or_else(|| format!("mesh {index} of {}", document.meshes.len()))?;
    Ok((position, &document.meshes[position]))
}

fn describe_primitive(mesh: usize, primitive: usize) -> String {
    format!("mesh {mesh}, primitive {primitive}")
}

/// Counts objects and triangles with all their instances, before memory is asked for.
fn check_total(document: &Document, placed: &[Placed]) -> std::result::Result<(), (String, String)> {
    let mut of_mesh: Vec<Option<u64>> = vec![None; document.meshes.len()];
    let (mut objects, mut triangles) = (0u64, 0u64);
    for place in placed {
        let Some(index) = place.node.mesh else { continue };
        let (position, mesh) =
            mesh_at(document, index).map_err(|why| (nodes::describe(document, place.index), why))?;
        let own = match of_mesh[position] {
            Some(own) => own,
            None => {
                let mut own = 0u64;
                for (number, primitive) in mesh.primitives.iter().enumerate() {
                    let declared = primitives::declared_triangles(document, primitive);
                    own = own
                        .saturating_add(declared.map_err(|why| (describe_primitive(position, number), why))?);
                }
                *of_mesh[position].insert(own)
            }
        };
        objects = objects.saturating_add(mesh.primitives.len() as u64);
        triangles = triangles.saturating_add(own);
    }
    if objects > MAX_OBJECTS {
        return Err(("nodes".into(), format!("{objects} objects, expected at most {MAX_OBJECTS}")));
    }
    if triangles > MAX_TRIANGLES {
        return Err(("nodes".into(), format!("{triangles} triangles, expected at most {MAX_TRIANGLES}")));
    }
    Ok(())
}

/// Meshes, each read when a node first shows it.
struct Meshes<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    read: Vec<Option<Vec<Option<Geometry>>>>,
}

impl Meshes<'_> {
    /// Adds the objects of a mesh as a node shows it.
    fn show(
        &mut self,
        place: &Placed,
        index: u64,
        builder: &mut SceneBuilder,
        findings: &mut Findings,
    ) -> std::result::Result<(), (String, String)> {
        let node = nodes::describe(self.document, place.index);
        let (position, mesh) = mesh_at(self.document, index).map_err(|why| (node, why))?;
        self.read.resize_with(self.document.meshes.len(), || None);
        if self.read[position].is_none() {
            let mut all = Vec::new();
            for (number, primitive) in mesh.primitives.iter().enumerate() {
                let element = || describe_primitive(position, number);
                all.push(self.read_primitive(primitive, findings).map_err(|why| (element(), why))?);
            }
            self.read[position] = Some(all);
        }
        let given = place.node.name.as_deref().or(mesh.name.as_deref());
        let name = given.map_or_else(|| format!("node {}", place.index), printable);
        let all = self.read[position].iter().flatten();
        for (number, (geometry, primitive)) in all.zip(&mesh.primitives).enumerate() {
            let Some(geometry) = geometry else { continue };
            let instance = geometry.place(&place.world);
            findings.normals_replaced += instance.normals_replaced;
            let input = ObjectInput {
                // The scene's material 0 is the default, the document's own come after it.
                material: primitive.material.map_or(0, |material| material as u32 + 1),
                normals: instance.normals,
                ..ObjectInput::new(name.clone(), instance.positions, instance.triangles)
            };
            builder
                .add_object(input)
                .map_err(|error| (describe_primitive(position, number), error.to_string()))?;
        }
        Ok(())
    }

    /// `None` for points and lines.
    fn read_primitive(
        &self,
        primitive: &Primitive,
        findings: &mut Findings,
    ) -> std::result::Result<Option<Geometry>, String> {
        let materials = self.document.materials.len();
        if let Some(material) = primitive.material.filter(|&material| material >= materials as u64) {
            return Err(format!("material {material} of {materials}"));
        }
        if primitives::mode(primitive)? == Mode::Thin {
            findings.thin += 1;
            return Ok(None);
        }
        findings.morphed += usize::from(!primitive.targets.is_empty());
        findings.coloured += usize::from(primitive.attributes.contains_key("COLOR_0"));
        let geometry = primitives::read(self.document, self.buffers, primitive)?;
        findings.left_over += geometry.left_over;
        Ok(Some(geometry))
    }
}

/// What the document asks for and is not drawn, for one warning a feature.
#[derive(Default)]
struct Findings {
    materials: materials::NotDrawn,
    lights: usize,
    thin: usize,
    morphed: usize,
    coloured: usize,
    left_over: usize,
    normals_replaced: usize,
    /// Features by name, how many there are, and which is the first.
    others: Vec<(&'static str, usize, String)>,
}

impl Findings {
    fn not_drawn(&mut self, feature: &'static str, which: String) {
        match self.others.iter_mut().find(|(name, ..)| *name == feature) {
            Some((_, count, _)) => *count += 1,
            None => self.others.push((feature, 1, which)),
        }
    }

    fn warn(&self, document: &Document, builder: &mut SceneBuilder) {
        for (feature, count, first) in &self.others {
            let which = if *count == 1 { first.clone() } else { format!("{first} and {} more", count - 1) };
            builder.warn(format!("{feature} are not supported yet ({which})"));
        }
        let ignored: Vec<String> = (document.extensions_used.iter())
            .filter(|name| !SUPPORTED.contains(&name.as_str()))
            .map(|name| printable(name))
            .collect();
        if let Some(first) = ignored.first() {
            let more =
                if ignored.len() == 1 { String::new() } else { format!(" and {} more", ignored.len() - 1) };
            builder.warn(format!("extensions that are not supported are passed over ({first}{more})"));
        }
        let materials = &self.materials;
        for (count, what, noun) in [
            (document.scenes.len().saturating_sub(1), "scenes other than the default are not drawn", "scene"),
            (document.animations.len(), "animations are not played", "animation"),
            (self.morphed, "morph targets are not applied", "primitive"),
            (self.thin, "points and lines are not drawn", "primitive"),
            (self.left_over, "corners after the last whole triangle are not drawn", "corner"),
            (self.coloured, "vertex colours are not drawn", "primitive"),
            (
                self.normals_replaced,
                "normals of zero or infinite length are replaced by the face's",
                "corner",
            ),
            (materials.textures, "textures are not drawn", "material"),
            (materials.masked, "alpha masks are drawn opaque", "material"),
            (materials.blended, "transparent materials are drawn opaque", "material"),
            (materials.emissive, "surfaces that glow give no light", "material"),
        ] {
            if count > 0 {
                builder.warn(format!("{what} ({})", counted(count, noun)));
            }
        }
    }
}

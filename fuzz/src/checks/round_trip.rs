//! Scenes that are written and loaded again.

use super::{Desk, refusal};
use lightbuffer::scene::{Material, Pattern, Scene, Texture, formats};

/// The most primitives and texels of a scene that is written again: most runs would be spent on nothing else.
const FEW: usize = 256;

/// Asserts that a scene is the same once it is written and loaded, as far as the format promises; a format that
/// cannot say something must refuse in one line.
pub fn check(desk: &Desk, scene: &Scene) {
    let texels: usize = scene.textures.iter().map(texels).sum();
    if scene.primitive_count() as usize > FEW || texels > FEW {
        return;
    }
    if let Some(again) = written(desk, scene, "again.toml") {
        assert_eq!(again.hash(), scene.hash(), "TOML changes the geometry");
        let [before, after] = [scene, &again].map(whole);
        assert_eq!(before, after);
    }
    if let Some(again) = written(desk, scene, "again.nff") {
        assert_eq!(primitives(&again), primitives(scene), "NFF changes the geometry");
    }
}

fn texels(texture: &Texture) -> usize {
    match &texture.pattern {
        Pattern::Image { image, .. } => image.texels.len(),
        Pattern::Checker { .. } => 0,
    }
}

fn written(desk: &Desk, scene: &Scene, name: &str) -> Option<Scene> {
    let path = desk.path(name);
    match formats::save(scene, &path) {
        Ok(()) => Some(formats::load(&path).unwrap_or_else(|error| panic!("what was written: {error}"))),
        Err(error) => {
            refusal(&path, &error);
            None
        }
    }
}

/// What TOML must give back beside the geometry, which the hash is of. Names of materials are left out: of several that
/// share one, which TOML could not tell apart, all but the first get numbers.
fn whole(scene: &Scene) -> Vec<String> {
    let mut lines = vec![format!("{:?} {:?}", scene.name, scene.background.map(f32::to_bits))];
    lines.extend(scene.objects.iter().map(|object| {
        format!("{:?} {} {:?} {}", object.name, object.polygons, object.shadowing, object.material)
    }));
    let nameless = |material: &Material| Material { name: String::new(), ..material.clone() };
    lines.extend(scene.materials.iter().map(|material| format!("{:?}", nameless(material))));
    lines.extend(scene.textures.iter().map(|texture| format!("{texture:?}")));
    lines.extend(scene.lights.iter().map(|light| format!("{light:?}")));
    lines.extend(scene.cameras.iter().map(|camera| format!("{camera:?}")));
    lines
}

/// The numbers of all primitives, in any order: objects without names may be put together.
fn primitives(scene: &Scene) -> Vec<Vec<u32>> {
    let triangles = (0..scene.triangles.len() as u32).map(|t| scene.corners(t).map(|c| c.to_array()));
    let mut all: Vec<Vec<u32>> =
        triangles.map(|corners| corners.as_flattened().iter().map(|x| x.to_bits()).collect()).collect();
    all.extend(
        scene.curved.iter().map(|curved| curved.shape.numbers().into_iter().map(f32::to_bits).collect()),
    );
    all.sort();
    all
}

//! Scene files: what every scene that comes out of a loader must be.

use super::{Desk, Outcome, assert_printable, refusal, round_trip};
use lightbuffer::memory::MemoryLimit;
use lightbuffer::scene::{
    Camera, Coverage, Emitter, Light, Mapping, Material, Object, Pattern, Scene, formats,
};

/// What a scene may take beyond what its bytes are parsed to, which takes the rest of what the fuzzer allows.
const BESIDE: u64 = 40 << 20;
const A_BYTE: u64 = 16;

/// Loads the first of some files, with the others beside it.
pub fn check(desk: &mut Desk, files: &[(&'static str, &[u8])]) -> Outcome {
    desk.lay(files);
    let path = desk.path(files[0].0);
    let bytes: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
    match formats::load_within(&path, MemoryLimit::bytes(BESIDE + A_BYTE * bytes as u64)) {
        Ok(scene) => {
            assert_whole(&scene);
            round_trip::check(desk, &scene);
            Outcome::Loaded
        }
        Err(error) => Outcome::Refused(refusal(&path, &error)),
    }
}

/// Asserts that a scene is complete, as its documentation promises: every index in range, every number finite.
pub fn assert_whole(scene: &Scene) {
    assert!(scene.primitive_count() > 0);
    assert!(scene.vertices.iter().all(|vertex| vertex.is_finite()));
    for triangle in &scene.triangles {
        assert!(triangle.vertices.iter().all(|&vertex| (vertex as usize) < scene.vertices.len()));
    }
    let (mut triangles, mut curved) = (0, 0);
    for (number, object) in scene.objects.iter().enumerate() {
        assert_eq!((object.first, object.first_curved), (triangles, curved), "primitives without an object");
        triangles += object.count;
        curved += object.curved_count;
        assert_object(scene, number as u32, object);
    }
    assert_eq!([triangles as usize, curved as usize], [scene.triangles.len(), scene.curved.len()]);
    assert!(!scene.materials.is_empty());
    scene.materials.iter().for_each(|material| assert_material(scene, material));
    for texture in &scene.textures {
        if let Pattern::Image { image, .. } = &texture.pattern {
            assert_eq!(image.texels.len() as u64, u64::from(image.width) * u64::from(image.height));
        }
        match texture.mapping {
            Mapping::Solid { origin, size } => assert!(origin.is_finite() && size > 0.0),
            Mapping::Planar { origin, u, v } => assert!(origin.is_finite() && u.is_finite() && v.is_finite()),
            Mapping::Coordinates => {}
        }
    }
    scene.lights.iter().for_each(assert_light);
    scene.cameras.iter().for_each(assert_camera);
    assert!(are_finite(&scene.background));
    assert_printable(&scene.name);
    scene.warnings.iter().for_each(|warning| assert_printable(warning));
    assert!(scene.bounds().is_none_or(|(low, high)| low.is_finite() && high.is_finite()));
    // It looks at everything that shadows depend on, and must not panic.
    _ = scene.hash();
}

fn assert_object(scene: &Scene, number: u32, object: &Object) {
    assert_printable(&object.name);
    assert!((object.material as usize) < scene.materials.len());
    let (first, count) = (object.first as usize, object.count as usize);
    assert!(scene.triangles[first..first + count].iter().all(|triangle| triangle.object == number));
    let (first, curved) = (object.first_curved as usize, object.curved_count as usize);
    for curved in &scene.curved[first..first + curved] {
        assert_eq!(curved.object, number);
        assert!(curved.shape.numbers().iter().all(|number| number.is_finite()));
    }
    if let Some(normals) = &object.normals {
        assert_eq!(normals.corners.len(), count);
        assert!(
            normals.corners.as_flattened().iter().all(|&corner| (corner as usize) < normals.normals.len())
        );
        let mut used = normals.corners.as_flattened().iter().map(|&corner| normals.normals[corner as usize]);
        assert!(used.all(|normal| (normal.length() - 1.0).abs() < 1e-3), "{normals:?}");
    }
    let material = &scene.materials[object.material as usize];
    if let Some(places) = &object.texture_coordinates {
        assert_eq!(places.corners.len(), count);
        let corners = places.corners.as_flattened();
        assert!(corners.iter().all(|&corner| (corner as usize) < places.coordinates.len()));
        assert!(places.coordinates.as_flattened().iter().all(|place| place.is_finite()));
        assert!(material.coverage.mask().is_some() || material.texture.is_some());
    } else {
        assert!(material.coverage.mask().is_none(), "a masked object without texture coordinates");
    }
}

fn assert_material(scene: &Scene, material: &Material) {
    assert_printable(&material.name);
    for colour in [material.diffuse, material.specular, material.mirror] {
        assert!(are_finite(&colour), "{material:?}");
    }
    assert!(material.shininess.is_finite());
    if let Some(transmission) = material.transmission {
        assert!(
            are_finite(&transmission.transmittance) && transmission.refractive_index > 0.0,
            "{material:?}"
        );
    }
    if let Coverage::Masked(mask) = material.coverage {
        let mask = &scene.alpha_masks[mask as usize];
        let texels = u64::from(mask.width) * u64::from(mask.height);
        assert!((1..texels).contains(&mask.opaque_texels()), "a mask without holes or without anything else");
    }
    assert!(material.texture.is_none_or(|texture| (texture as usize) < scene.textures.len()));
}

fn assert_light(light: &Light) {
    assert_printable(&light.name);
    let (xyz, w) = light.position().homogeneous();
    assert!(xyz.is_finite() && w.is_finite(), "{light:?}");
    assert!(are_finite(&light.strength()), "{light:?}");
    if let Emitter::Spot(spot) = &light.emitter {
        let cone = &spot.cone;
        assert!(cone.axis.is_finite() && cone.axis != glam::Vec3::ZERO, "{light:?}");
        assert!(
            cone.cos_outer < cone.cos_inner && cone.cos_outer >= -1.0 && cone.cos_inner <= 1.0,
            "{light:?}"
        );
    }
}

fn assert_camera(camera: &Camera) {
    assert_printable(&camera.name);
    assert!(
        [camera.origin, camera.forward, camera.right, camera.up].iter().all(|v| v.is_finite()),
        "{camera:?}"
    );
    assert!(camera.tan_half_height.is_finite() && camera.tan_half_height > 0.0, "{camera:?}");
    assert!(camera.size.is_none_or(|size| size.width > 0 && size.height > 0));
}

fn are_finite(numbers: &[f32; 3]) -> bool {
    numbers.iter().all(|number| number.is_finite() && *number >= 0.0)
}

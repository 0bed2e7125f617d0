//! Scenes that are written and read back.

use crate::fixtures::Folder;
use crate::gltf_parts::png;
use glam::Vec3;
use lightbuffer::geometry::curved::{Disc, Ellipsoid, InfinitePlane, Quadric, Shape};
use lightbuffer::scene::{
    AlphaMask, Camera, Cone, Coverage, DirectionalLight, Emitter, Falloff, Image, ImageSize, Light, Mapping,
    Material, ObjectInput, Pattern, PointLight, Scene, SceneBuilder, Shadowing, SmoothNormals, SpotLight,
    Texels, Texture, TextureCoordinates, Transmission, Wrap, formats,
};
use proptest::prelude::*;
use std::path::Path;
use std::sync::Arc;

/// What must be the same: everything but how vertices and normals are numbered, in bits where numbers are.
fn content(scene: &Scene) -> Vec<String> {
    let mut lines =
        vec![format!("{} {:?} {:016x}", scene.name, scene.background.map(f32::to_bits), scene.hash())];
    for object in &scene.objects {
        let material = &scene.materials[object.material as usize];
        let (name, polygons, shadowing) = (&object.name, object.polygons, object.shadowing);
        lines.push(format!("object {name} {polygons} {shadowing:?} {}", material.name));
        for t in object.first..object.first + object.count {
            let corners = scene.corners(t).map(|p| p.to_array().map(f32::to_bits));
            let within = (t - object.first) as usize;
            let normals = object.normals.as_ref().map(|given| {
                given.corners[within].map(|c| given.normals[c as usize].to_array().map(f32::to_bits))
            });
            let places = object
                .texture_coordinates
                .as_ref()
                .map(|given| given.corners[within].map(|c| given.coordinates[c as usize].map(f32::to_bits)));
            lines.push(format!("{corners:?} {normals:?} {places:?}"));
        }
        for curved in &scene.curved[object.first_curved as usize..][..object.curved_count as usize] {
            let numbers: Vec<u32> = curved.shape.numbers().into_iter().map(f32::to_bits).collect();
            lines.push(format!("{} {numbers:?}", curved.shape.kind()));
        }
    }
    lines.extend(scene.materials.iter().map(|material| format!("{material:?}")));
    lines.extend(scene.textures.iter().map(|texture| format!("{texture:?}")));
    lines.extend(scene.lights.iter().map(|light| format!("{light:?}")));
    lines.extend(scene.cameras.iter().map(|camera| format!("{camera:?}")));
    lines
}

fn written(scene: &Scene, path: &Path) -> Scene {
    formats::save(scene, path).unwrap();
    formats::load(path).unwrap()
}

#[track_caller]
fn assert_same(scene: &Scene, other: &Scene) {
    for (one, other) in content(scene).iter().zip(content(other)) {
        assert_eq!(*one, other);
    }
    assert_eq!(content(scene).len(), content(other).len());
}

/// Numbers of every size and with all digits, and short ones.
fn number() -> impl Strategy<Value = f32> {
    let any_bits = any::<u32>().prop_map(f32::from_bits);
    prop_oneof![
        3 => any_bits.prop_filter("of a size to compute with", |x| x.is_finite() && x.abs() < 1e12),
        3 => (-1000i16..1000).prop_map(|x| f32::from(x) / 16.0),
        1 => Just(-0.0f32),
    ]
}

fn point() -> impl Strategy<Value = Vec3> {
    [number(), number(), number()].prop_map(Vec3::from)
}

fn share() -> impl Strategy<Value = [f32; 3]> {
    let channel = || prop_oneof![0f32..=1.0, Just(0.0), Just(1.0)];
    prop_oneof![[channel(), channel(), channel()], channel().prop_map(|c| [c; 3])]
}

fn shape() -> impl Strategy<Value = Shape> {
    let points = || [point(), point(), point(), point()];
    let lengths = || [number(), number()].prop_map(|lengths| lengths.map(f32::abs));
    (0..7, points(), lengths()).prop_map(|(kind, [a, b, c, d], [r, s])| match kind {
        0 => Shape::sphere(a, r),
        1 => Shape::Ellipsoid(Ellipsoid { centre: a, axes: [b, c, d] }),
        2 => Shape::cone(a, r, b, s),
        3 => Shape::cylinder(a, b, r),
        4 => Shape::Disc(Disc { centre: a, normal: b, radius: r }),
        5 => Shape::Plane(InfinitePlane { point: a, normal: b }),
        _ => {
            let second = [b.x, b.y, b.z, c.x, c.y, c.z];
            let (low, high) = (d - r.abs() - 1.0, d + s.abs() + 1.0);
            Shape::Quadric(Quadric { reference: a, second, first: d, constant: r, low, high })
        }
    })
}

fn material() -> impl Strategy<Value = Material> {
    let passing = prop::option::of((share(), 0.5f32..3.0));
    ("[a-c \"'\\\\é]{0,3}", share(), share(), share(), passing, 1f32..1e6).prop_map(
        |(name, diffuse, specular, mirror, passing, shininess)| {
            let transmission = passing.filter(|(t, _)| *t != [0.0; 3]);
            let transmission = transmission
                .map(|(transmittance, refractive_index)| Transmission { transmittance, refractive_index });
            Material { name, diffuse, specular, mirror, transmission, shininess, ..Material::default() }
        },
    )
}

/// Triangles, whether they have normals, curved surfaces, the material and two flags.
type Parts = (Vec<[Vec3; 3]>, bool, Vec<Shape>, usize, [bool; 2]);

fn object(materials: usize) -> impl Strategy<Value = Parts> {
    let triangles = prop::collection::vec([point(), point(), point()], 0..4);
    let curved = prop::collection::vec(shape(), 0..4);
    (triangles, any::<bool>(), curved, 0..=materials, any::<[bool; 2]>())
}

fn light() -> impl Strategy<Value = Emitter> {
    let direction = point().prop_filter("a direction", |d| *d != Vec3::ZERO);
    let falloff = prop_oneof![
        Just(Falloff::InverseSquare),
        Just(Falloff::Constant),
        (1e-30f32..1e30).prop_map(Falloff::Range)
    ];
    let cosines = prop_oneof![
        (0.001f32..1.0, 0f32..1.0).prop_map(|(outer, share)| [outer, (outer + (1.0 - outer) * share)]),
        (0.001f32..1.0).prop_map(|outer| [outer, outer]),
        Just([0.0, 1.0]),
    ];
    let strength = [0f32..1e6, 0f32..1.0, 0f32..1e-30];
    (0..3, point(), direction, strength, falloff, cosines).prop_map(
        |(kind, position, axis, intensity, falloff, [cos_outer, inner])| {
            let point = PointLight { position, intensity, falloff };
            let cone = Cone { axis, cos_inner: inner.max(cos_outer.next_up()), cos_outer };
            match kind {
                0 => Emitter::Point(point),
                1 => Emitter::Spot(SpotLight { point, cone }),
                _ => Emitter::Directional(DirectionalLight { towards: axis, irradiance: intensity }),
            }
        },
    )
}

fn camera() -> impl Strategy<Value = Camera> {
    let size = prop::option::of((1u32..4096, 1u32..4096));
    (point(), -1f32..1.0, 0f32..6.0, 1f64..170.0, size).prop_map(|(origin, height, turn, degrees, size)| {
        let ahead = Vec3::new(turn.cos(), height, turn.sin());
        let camera = Camera::look_at("camera", Vec3::ZERO, ahead, Vec3::Y, degrees);
        Camera { origin, size: size.map(|(width, height)| ImageSize { width, height }), ..camera }
    })
}

fn scene() -> impl Strategy<Value = Scene> {
    let materials = prop::collection::vec(material(), 0..3);
    let rest = |materials: Vec<Material>| {
        let objects = prop::collection::vec(object(materials.len()), 1..5);
        let lights = prop::collection::vec(light(), 0..4);
        let cameras = prop::collection::vec(camera(), 0..3);
        (Just(materials), objects, lights, cameras, [0f32..1e30, 0f32..1.0, 0f32..1e-30])
    };
    materials.prop_flat_map(rest).prop_map(|(materials, objects, lights, cameras, background)| {
        let mut builder = SceneBuilder::new("a \"scene\"");
        builder.set_background(background);
        for (index, material) in materials.into_iter().enumerate() {
            builder.add_material(Material { name: format!("{} {index}", material.name), ..material });
        }
        for (index, (triangles, smooth, curved, material, [casts, receives])) in
            objects.into_iter().enumerate()
        {
            let corners: Vec<[u32; 3]> =
                (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
            let normals = smooth.then(|| SmoothNormals {
                normals: vec![Vec3::Z, Vec3::new(0.6, 0.0, 0.8)],
                corners: corners.iter().map(|_| [0, 1, 0]).collect(),
            });
            let input = ObjectInput {
                material: material as u32,
                polygons: (index == 0).then_some(7),
                curved,
                normals: normals.filter(|_| !corners.is_empty()),
                shadowing: Shadowing { casts, receives },
                // Of two objects that share a name each stays by itself.
                ..ObjectInput::new(format!("object {}", index / 2), triangles.concat(), corners)
            };
            builder.add_object(input).unwrap();
        }
        for emitter in lights {
            builder.add_light(Light { name: "light".into(), emitter });
        }
        cameras.into_iter().for_each(|camera| builder.add_camera(camera));
        builder.finish()
    })
}

proptest! {
    #[test]
    fn any_scene_comes_back_from_toml(scene in scene()) {
        prop_assume!(scene.primitive_count() > 0);
        let folder = Folder::new();
        let again = written(&scene, &folder.path("some.toml"));
        // An object that lost all its triangles has lost its normals with them.
        prop_assert_eq!(content(&scene), content(&again));
        prop_assert!(again.warnings.is_empty(), "{:?}", again.warnings);
        prop_assert_eq!(content(&again), content(&written(&again, &folder.path("more.toml"))));
    }
}

#[test]
fn demo_scenes_come_back() {
    let folder = Folder::new();
    for name in ["blocks.obj", "blocks-lights.toml"] {
        let scene = formats::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)).unwrap();
        assert_same(&scene, &written(&scene, &folder.path("some.toml")));
    }
}

/// A triangle and a sphere with all that NFF can say.
fn plain() -> Scene {
    let mut builder = SceneBuilder::new("plain");
    builder.set_background([0.078, 0.361, 0.753]);
    let transmission = Some(Transmission { transmittance: [0.9; 3], refractive_index: 1.1 });
    let material = builder.add_material(Material {
        name: "glass".into(),
        diffuse: [0.1, 0.2, 0.3],
        specular: [0.4; 3],
        mirror: [0.4; 3],
        shininess: 100000.0,
        transmission,
        ..Material::default()
    });
    let corners = vec![[0, 1, 2]];
    let positions = vec![Vec3::ZERO, Vec3::new(0.1, 0.0, 0.0), Vec3::Y];
    let normals = SmoothNormals { normals: vec![Vec3::Z, Vec3::X], corners: vec![[0, 1, 0]] };
    builder
        .add_object(ObjectInput {
            material,
            normals: Some(normals),
            ..ObjectInput::new("a", positions.clone(), corners.clone())
        })
        .unwrap();
    let curved = vec![
        Shape::sphere(Vec3::splat(0.3), 0.7),
        Shape::cone(Vec3::ZERO, 0.1, Vec3::Y, 0.0),
        Shape::cylinder(Vec3::ZERO, Vec3::X, 1e-7),
    ];
    builder.add_object(ObjectInput { curved, ..ObjectInput::new("b", positions, corners) }).unwrap();
    for (position, intensity) in [(Vec3::X, [0.5553603; 3]), (Vec3::Y, [0.1, 0.0, 0.7])] {
        builder.add_light(Light::point("l", PointLight { position, intensity, falloff: Falloff::Constant }));
    }
    let camera = Camera::look_at("view", Vec3::new(2.1, 1.3, 1.7), Vec3::ZERO, Vec3::Z, 45.0);
    builder.add_camera(Camera { size: Some(ImageSize { width: 64, height: 64 }), ..camera });
    builder.finish()
}

#[test]
fn what_nff_can_say_comes_back_from_it() {
    let folder = Folder::new();
    let (scene, again) = (plain(), written(&plain(), &folder.path("some.nff")));
    let bits = |scene: &Scene| -> Vec<_> {
        let corners = (0..scene.triangles.len() as u32).flat_map(|t| scene.corners(t));
        corners.map(|p| p.to_array().map(f32::to_bits)).collect()
    };
    assert_eq!((bits(&scene), &scene.curved), (bits(&again), &again.curved));
    assert_eq!((scene.background, scene.objects.len()), (again.background, again.objects.len()));
    for (one, other) in scene.objects.iter().zip(&again.objects) {
        assert_eq!(
            (one.count, one.curved_count, one.polygons),
            (other.count, other.curved_count, other.polygons)
        );
        let material = |scene: &Scene, index: u32| Material {
            name: String::new(),
            ..scene.materials[index as usize].clone()
        };
        assert_eq!(material(&scene, one.material), material(&again, other.material));
    }
    assert_eq!(again.objects[0].normals.as_ref().unwrap().normals, [Vec3::Z, Vec3::X, Vec3::Z]);
    for (one, other) in scene.lights.iter().zip(&again.lights) {
        assert_eq!(one.position(), other.position());
        let close = |(a, b): (f32, f32)| (a - b).abs() <= a * 1e-6;
        assert!(one.strength().into_iter().zip(other.strength()).all(close), "{one:?} {other:?}");
    }
    let (one, other) = (&scene.cameras[0], &again.cameras[0]);
    assert!(one.forward.abs_diff_eq(other.forward, 1e-6) && one.up.abs_diff_eq(other.up, 1e-6));
    assert_eq!((one.origin, one.size), (other.origin, other.size));
    assert!((one.tan_half_height - other.tan_half_height).abs() < 1e-14);
}

/// Asserts that a scene cannot be written as `name`, with a line that holds the words, and that nothing is.
#[track_caller]
fn refused(scene: &Scene, name: &str, words: &str) {
    let folder = Folder::new();
    let path = folder.path(name);
    let message = formats::save(scene, &path).expect_err("this must be refused").to_string();
    assert!(message.starts_with(&path.display().to_string()) && message.contains(words), "{message}");
    assert!(!path.exists() && !message.contains('\n'), "{message}");
    assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 0);
}

#[test]
fn what_a_format_cannot_say_is_an_error() {
    let changed = |change: &dyn Fn(&mut Scene)| {
        let mut scene = plain();
        change(&mut scene);
        scene
    };
    let nff = |words: &str, change: &dyn Fn(&mut Scene)| refused(&changed(change), "some.nff", words);
    nff("object 1 `a`: its material `glass`: NFF has one white share", &|s| s.materials[1].mirror = [0.0; 3]);
    nff("`glass`: in NFF as much passes of every colour", &|s| {
        s.materials[1].transmission.as_mut().unwrap().transmittance[0] = 0.1;
    });
    nff("object 2 `b`: in NFF everything casts", &|s| s.objects[1].shadowing.casts = false);
    nff("object 2 `b`: NFF has no disc", &|s| {
        s.curved[0].shape = Shape::Disc(Disc { centre: Vec3::ZERO, normal: Vec3::X, radius: 1.0 });
    });
    nff("light `l-2`: NFF has point lights alone", &|s| {
        let sun = DirectionalLight { towards: Vec3::Y, irradiance: [1.0; 3] };
        s.lights[1].emitter = Emitter::Directional(sun);
    });
    nff("camera `view`: it has no image size", &|s| s.cameras[0].size = None);
    let toml = |words: &str, change: &dyn Fn(&mut Scene)| refused(&changed(change), "some.toml", words);
    toml("material `glass`: expected a colour from 0 to 1, found 1.5", &|s| s.materials[1].diffuse[1] = 1.5);
    toml("material `glass`: TOML scenes have no alpha masks", &|s| {
        s.alpha_masks.push(AlphaMask::new(1, 1, [Wrap::Repeat; 2], |_, _| true));
        s.materials[1].coverage = Coverage::Masked(0);
    });
    toml("light `l-2`: expected a colour from 0 to 1e30, found 1e31", &|s| {
        let Emitter::Point(light) = &mut s.lights[1].emitter else { panic!("a point light") };
        light.intensity[0] = 1e31;
    });
    toml("camera `view`: its axes are no unit vectors", &|s| s.cameras[0].up = Vec3::ZERO);
    toml("texture 1: an image in floats", &|s| {
        let image = Arc::new(Image { width: 1, height: 1, texels: Texels::Linear(vec![[0.5; 3]]) });
        let pattern = Pattern::Image { image, wrap: [Wrap::Repeat; 2] };
        s.textures.push(Texture { pattern, mapping: Mapping::Coordinates });
    });
    refused(&plain(), "some.obj", "expected a name that ends in .toml or .nff");
}

#[test]
fn textures_come_back_with_their_images() {
    let mut builder = SceneBuilder::new("painted");
    let image = Arc::new(Image { width: 2, height: 1, texels: Texels::Srgb(vec![[1, 2, 3], [250, 0, 128]]) });
    let pictured = |wrap: [Wrap; 2]| Pattern::Image { image: image.clone(), wrap };
    let planar = Mapping::Planar { origin: Vec3::ONE, u: Vec3::X * 0.1, v: Vec3::new(0.1, 0.2, 0.3) };
    for (pattern, mapping) in [
        (Pattern::Checker { other: [0.1, 0.2, 0.3] }, Mapping::Solid { origin: Vec3::Y, size: 0.1 }),
        (Pattern::Checker { other: [1.0; 3] }, planar),
        (pictured([Wrap::ClampToEdge, Wrap::MirroredRepeat]), planar),
        (pictured([Wrap::Repeat; 2]), Mapping::Coordinates),
    ] {
        let texture = builder.add_texture(Texture { pattern, mapping }).unwrap();
        let name = format!("material {texture}");
        let material = builder.add_material(Material { name, texture: Some(texture), ..Material::default() });
        let corners = vec![[0, 1, 2]];
        let coordinates = vec![[0.1, -7.5], [1.0, 0.0], [-0.0, 1e-30]];
        let texture_coordinates = Some(TextureCoordinates { coordinates, corners: corners.clone() });
        let input = ObjectInput::new("object", vec![Vec3::ZERO, Vec3::X, Vec3::Y], corners);
        builder.add_object(ObjectInput { material, texture_coordinates, ..input }).unwrap();
    }
    let scene = builder.finish();
    let folder = Folder::new();
    assert_same(&scene, &written(&scene, &folder.path("a:b.toml")));
    let names: Vec<_> = std::fs::read_dir(folder.path("")).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert!(names.len() == 2 && folder.path("a_b-texture-1.png").exists(), "{names:?}");
    // What was there under that name is replaced.
    std::fs::write(folder.path("a_b-texture-1.png"), png(1, &[0])).unwrap();
    assert_same(&scene, &written(&scene, &folder.path("a:b.toml")));
}

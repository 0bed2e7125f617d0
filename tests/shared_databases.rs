//! The Standard Procedural Databases as we make them against files of them that are not part of this repository.
//!
//! `make test-scenes SCENES=folder` runs these tests; the folder holds the seven of `spd/` at standard size.
//! Files have six digits, and primitives in another order, so scenes are compared as sets, within rounding.

use lightbuffer::geometry::curved::Shape;
use lightbuffer::scene::procedural;
use lightbuffer::scene::{Material, PrimitiveIndex, Scene, formats};
use std::path::PathBuf;

/// How far numbers may be off that are differences of such as were written with six digits, the largest of
/// which the feature holds too.
fn tolerance(feature: &[f64]) -> f64 {
    let largest = feature.iter().fold(0.0f64, |largest, number| largest.max(number.abs()));
    3e-5 + 1.2e-5 * largest
}

fn from_file(name: &str) -> Scene {
    let help = "run: make test-scenes SCENES=folder";
    let folder = std::env::var_os("SCENES").unwrap_or_else(|| panic!("SCENES is not set; {help}"));
    formats::load(&PathBuf::from(folder).join(format!("spd/{name}.nff"))).unwrap()
}

fn made(name: &str) -> Scene {
    procedural::find(name).unwrap().build(None).unwrap()
}

fn numbers_of(material: &Material) -> Vec<f64> {
    let transmission = material.transmission.map_or([0.0; 4], |t| {
        let [r, g, b] = t.transmittance;
        [r, g, b, t.refractive_index]
    });
    let rest = [material.shininess.min(1000.0) * 1e-3];
    let parts = [&material.diffuse[..], &material.specular, &material.mirror, &rest, &transmission];
    parts.concat().into_iter().map(f64::from).collect()
}

/// What a primitive is, in numbers that do not depend on where it begins: corners of triangles each by
/// itself, so that it does not matter how polygons were cut.
fn features(scene: &Scene, primitive: PrimitiveIndex) -> Vec<Vec<f64>> {
    let material = numbers_of(scene.material(primitive));
    let with_material = |place: Vec<f64>| [place, material.clone()].concat();
    let wide = |v: glam::Vec3| v.as_dvec3().to_array();
    match scene.shape(primitive) {
        None => scene.corners(primitive).map(|corner| with_material(wide(corner).to_vec())).to_vec(),
        Some(Shape::Sphere(s)) => {
            vec![with_material([&wide(s.centre)[..], &[s.radius.into()]].concat())]
        }
        Some(Shape::Cone(c)) => {
            let middle = wide((c.base + c.apex) * 0.5);
            let across = wide((c.base - c.apex).abs());
            let radii = [f64::from(c.base_radius + c.apex_radius)];
            vec![with_material([&middle[..], &across, &radii].concat())]
        }
        Some(other) => panic!("{other:?}"),
    }
}

/// All features of triangles, of spheres and of cones, each once, by their first coordinate.
fn sets(scene: &Scene) -> [Vec<Vec<f64>>; 3] {
    let mut sets = [const { Vec::new() }; 3];
    for primitive in 0..scene.primitive_count() {
        let set = match scene.shape(primitive) {
            None => 0,
            Some(Shape::Sphere(_)) => 1,
            Some(_) => 2,
        };
        sets[set].extend(features(scene, primitive));
    }
    for set in &mut sets {
        set.sort_by(|a, b| {
            a.iter()
                .zip(b)
                .map(|(a, b)| a.total_cmp(b))
                .find(|o| o.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        set.dedup();
    }
    sets
}

/// The first feature of one set that the other lacks.
fn missing<'a>(wanted: &'a [Vec<f64>], there: &[Vec<f64>]) -> Option<&'a Vec<f64>> {
    wanted.iter().find(|feature| {
        let off = tolerance(feature);
        let first = there.partition_point(|other| other[0] < feature[0] - off);
        let near = there[first..].iter().take_while(|other| other[0] <= feature[0] + off);
        let same = |other: &Vec<f64>| feature.iter().zip(other).all(|(a, b)| (a - b).abs() <= off);
        !near.clone().any(same)
    })
}

/// Camera, lights and how many primitives there are.
fn compare_setting(name: &str, ours: &Scene, theirs: &Scene) {
    assert_eq!(ours.triangles.len(), theirs.triangles.len(), "{name}");
    assert_eq!(ours.curved.len(), theirs.curved.len(), "{name}");
    let polygons = |scene: &Scene| scene.objects.iter().map(|object| object.polygons).sum::<u32>();
    assert_eq!(polygons(ours), polygons(theirs), "{name}");
    assert_eq!(ours.background, theirs.background);
    let (our_camera, their_camera) = (&ours.cameras[0], &theirs.cameras[0]);
    assert_eq!(our_camera.size, their_camera.size);
    assert!((our_camera.tan_half_height - their_camera.tan_half_height).abs() < 1e-9, "{name}");
    for (a, b) in [
        (our_camera.origin, their_camera.origin),
        (our_camera.forward, their_camera.forward),
        (our_camera.up, their_camera.up),
    ] {
        assert!((a - b).length() < 1e-5, "{name}: {a} {b}");
    }
    assert_eq!(ours.lights.len(), theirs.lights.len(), "{name}");
    for (a, b) in ours.lights.iter().zip(&theirs.lights) {
        let (a_place, b_place) = (a.position().homogeneous().0, b.position().homogeneous().0);
        assert!((a_place - b_place).length() < 1e-4, "{name}: {a_place} {b_place}");
        let off = a.strength().iter().zip(b.strength()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 1e-5, "{name}: {a:?} {b:?}");
    }
}

fn compare(name: &str) {
    let (ours, theirs) = (made(name), from_file(name));
    compare_setting(name, &ours, &theirs);
    for (kind, (ours, theirs)) in sets(&ours).iter().zip(&sets(&theirs)).enumerate() {
        assert_eq!(missing(theirs, ours), None, "{name}: not in ours, kind {kind}");
        assert_eq!(missing(ours, theirs), None, "{name}: not in theirs, kind {kind}");
    }
}

#[test]
fn the_databases_are_those_of_the_files() {
    for name in ["balls", "gears", "rings", "teapot", "tetra", "tree"] {
        compare(name);
    }
}

#[test]
fn the_mountain_is_as_large_as_the_file_s_and_its_balls_are_the_same() {
    let (ours, theirs) = (made("mount"), from_file("mount"));
    compare_setting("mount", &ours, &theirs);
    let [_, our_balls, _] = sets(&ours);
    let [_, their_balls, _] = sets(&theirs);
    assert_eq!(missing(&their_balls, &our_balls), None);
    let extent = |scene: &Scene| {
        let corners = (0..scene.triangles.len() as u32).flat_map(|triangle| scene.corners(triangle));
        corners.fold([glam::Vec3::INFINITY, glam::Vec3::NEG_INFINITY], |[low, high], p| {
            [low.min(p), high.max(p)]
        })
    };
    let ([low, high], [their_low, their_high]) = (extent(&ours), extent(&theirs));
    assert_eq!((low.truncate(), high.truncate()), (their_low.truncate(), their_high.truncate()));
    let (height, their_height) = (high.z - low.z, their_high.z - their_low.z);
    assert!((0.6..1.6).contains(&(height / their_height)), "{height} against {their_height}");
}

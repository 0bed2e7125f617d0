//! NFF.

use crate::fixtures::Folder;
use crate::{corners, warned};
use glam::Vec3;
use lightbuffer::geometry::curved::Shape;
use lightbuffer::scene::{Emitter, Falloff, ImageSize, Scene, Transmission, formats};
use std::f32::consts::PI;

fn load(text: &str) -> Scene {
    let folder = Folder::new();
    formats::load(&folder.write("test.nff", text)).unwrap()
}

const TRIANGLE: &str = "p 3\n0 0 0\n1 0 0\n0 1 0\n";
const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

#[test]
fn a_whole_file_is_read() {
    let text = "# a remark\nb 0.1 0.2 0.3\nv\nfrom 1 2 3\nat 1 2 0\nup 0 5 1\nangle 45\nhither 0.5\n\
                resolution 64 64\nl 4 3 2\nf 1 0.5 0.25 0.5 0.125 20 0 1\np 3 # a triangle\n0 0 0\n1 0 0\n\n0 1 0\n";
    let scene = load(text);
    assert_eq!(scene.name, "test.nff");
    assert_eq!(corners(&scene), [CORNERS]);
    assert_eq!(scene.objects[0].name, "fill-1");
    let material = scene.material(0);
    assert_eq!(material.name, "fill-1");
    assert_eq!((material.diffuse, material.specular), ([0.5, 0.25, 0.125], [0.125; 3]));
    assert_eq!((material.shininess, material.mirror, material.transmission), (20.0, [0.125; 3], None));
    assert_eq!(scene.background, [0.1, 0.2, 0.3]);
    let [camera] = &scene.cameras[..] else { panic!("one camera") };
    assert_eq!((camera.name.as_str(), camera.origin), ("view", Vec3::new(1.0, 2.0, 3.0)));
    assert_eq!((camera.forward, camera.right, camera.up), (Vec3::NEG_Z, Vec3::X, Vec3::Y));
    assert_eq!(camera.size, Some(ImageSize { width: 64, height: 64 }));
    assert_eq!(camera.tan_half_height, libm::tan(45f64.to_radians() / 2.0) * (64.0 / 63.0));
    assert_eq!(scene.lights.len(), 1);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn lights_share_the_usual_intensity_and_have_their_colours() {
    let text = format!("l 1 2 3\nl 4 5 6 1 0.5 0 # red\nl 0 0 9\nl 0 9 9\n{TRIANGLE}");
    let scene = load(&text);
    let names: Vec<_> = scene.lights.iter().map(|light| light.name.as_str()).collect();
    assert_eq!(names, ["light-1", "light-2", "light-3", "light-4"]);
    let intensity = |i: usize| {
        let Emitter::Point(light) = &scene.lights[i].emitter else { panic!("a point light") };
        assert_eq!(light.falloff, Falloff::Constant);
        light.intensity
    };
    // sqrt(4) / (2 * 4), and the pi that shading divides by.
    assert_eq!(intensity(0), [PI / 4.0; 3]);
    assert_eq!(intensity(1), [PI / 4.0, PI / 8.0, 0.0]);
    assert_eq!(scene.lights[1].position().homogeneous(), (Vec3::new(4.0, 5.0, 6.0), 1.0));
    let one = load(&format!("l 1 2 3\n{TRIANGLE}"));
    assert_eq!(one.lights[0].strength(), [PI / 2.0; 3]);
}

#[test]
fn polygons_between_two_fills_are_one_object() {
    let text = format!(
        "f 1 0 0 1 0 1 0 0\n{TRIANGLE}l 1 2 3\n{TRIANGLE}f 0 1 0 1 0 1 0 0\nf 0 0 1 1 0 1 0 0\n{TRIANGLE}"
    );
    let scene = load(&text);
    let objects: Vec<_> = scene.objects.iter().map(|object| (object.name.as_str(), object.count)).collect();
    assert_eq!(objects, [("fill-1", 2), ("fill-3", 1)]);
    assert_eq!(scene.background, [0.0; 3]);
    assert_eq!(scene.material(0).diffuse, [1.0, 0.0, 0.0]);
    assert_eq!(scene.material(2).diffuse, [0.0, 0.0, 1.0]);
    assert!(scene.warnings.is_empty());
}

#[test]
fn a_concave_polygon_is_filled_and_no_more() {
    let scene = load("f 1 1 1 1 0 1 0 0\np 6\n2 1 1\n2 1 2\n2 0 2\n2 0 0\n2 2 0\n2 2 1\n");
    let area: f32 = (0..scene.triangles.len() as u32)
        .map(|t| {
            let [a, b, c] = scene.corners(t);
            ((b - a).cross(c - a).x * 0.5).abs()
        })
        .sum();
    assert_eq!((scene.triangles.len(), scene.objects[0].polygons, area), (4, 1, 3.0));
}

#[test]
fn patches_have_normals_and_polygons_beside_them_flat_ones() {
    let text =
        format!("f 1 1 1 1 0 1 0 0\n{TRIANGLE}pp 4\n0 0 0 0 0 2\n1 0 0 3 4 0\n1 1 0 0 0 0\n0 1 0 0 1 0\n");
    let scene = load(&text);
    let normals = scene.objects[0].normals.as_ref().unwrap();
    let of = |t: usize| normals.corners[t].map(|corner| normals.normals[corner as usize].to_array());
    let z = [0.0, 0.0, 1.0];
    assert_eq!(of(0), [z; 3]);
    assert_eq!(of(1), [z, [0.6, 0.8, 0.0], z]);
    assert_eq!(of(2), [z, z, [0.0, 1.0, 0.0]]);
    assert_eq!(
        warned(&scene, "normals of zero or infinite length are replaced by the face's (2 corners)"),
        1
    );
}

#[test]
fn what_is_not_drawn_is_said_once() {
    let text = format!(
        "{TRIANGLE}f 2 -1 1 1 2 0.5 0 0\n{TRIANGLE}f 1 1 1 1 0 1 0.5 1.5\nf 1 1 1 1 0 1 1 1.5\n{TRIANGLE}\
         p 2\n0 0 0\n1 1 1\npp 0\np 4\n0 0 0\n1 1 0\n1 0 0\n0 1.5 0\n"
    );
    let scene = load(&text);
    let names: Vec<_> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    assert_eq!(names, ["fill-0", "fill-1", "fill-3"]);
    assert_eq!(scene.material(0).name, "default");
    let clamped = scene.material(1);
    assert_eq!((clamped.diffuse, clamped.specular, clamped.shininess), ([1.0, 0.0, 1.0], [1.0; 3], 1.0));
    warned(&scene, "what comes before the first `f` is drawn grey (1 primitive)");
    warned(&scene, "polygons of fewer than three corners are not drawn (2 polygons)");
    assert_eq!(warned(&scene, "outlines that cross themselves"), 3);
}

#[test]
fn triangles_with_bad_numbers_are_dropped_and_counted() {
    let text = format!(
        "{TRIANGLE}p 3\n0 0 0\n1e99 0 0\n0 1 0\np 4\n0 0 0\n1 0 0\n1 nan 0\n0 1 0\np 3\n0 0 0\n1 0 0\n2 0 0\n"
    );
    let scene = load(&text);
    assert_eq!(corners(&scene), [CORNERS]);
    assert_eq!((scene.dropped.non_finite, scene.dropped.degenerate), (3, 1));
}

#[test]
fn windows_line_ends_remarks_and_broken_lines_are_read() {
    let text = "\u{feff}# r\u{e9}mark\r\n  p 3\r\n0 0\r\n0 1 0 0 # two\r\n0 1 0";
    assert_eq!(corners(&load(text)), [CORNERS]);
}

#[test]
fn viewpoints_are_cameras_in_the_order_of_the_file() {
    let view =
        |y: i32, rows: i32| format!("v\nat 0 0 0\nfrom 0 {y} 0\nresolution 16 {rows}\nup 0 0 -2\nangle 60\n");
    let scene = load(&format!("{}{TRIANGLE}{}{}", view(5, 16), view(7, 1), view(9, 4)));
    let cameras: Vec<_> = scene.cameras.iter().map(|c| (c.name.as_str(), c.origin.y)).collect();
    assert_eq!(cameras, [("view", 5.0), ("view-2", 7.0), ("view-3", 9.0)]);
    let half = libm::tan(60f64.to_radians() * 0.5);
    let tangents: Vec<_> = scene.cameras.iter().map(|c| c.tan_half_height).collect();
    assert_eq!(tangents, [half * (16.0 / 15.0), half, half * (4.0 / 3.0)]);
    assert_eq!(
        warned(&scene, "pixels are square, so that `angle` is the vertical field alone (2 viewpoints)"),
        2
    );
}

#[test]
fn numbers_are_rounded_once() {
    let scene = load("p 3\n1.00000005960464477539063 0 0\n2 1 0\n2 0 0\n");
    assert_eq!(scene.vertices[0].x, 1.0f32.next_up());
}

#[test]
fn spheres_and_cones_are_curved_primitives_of_their_fills() {
    let text = format!(
        "f 1 0 0 1 0 1 0 0\ns 1 2 3 0.5\n{TRIANGLE}c\n0 0 0 1\n0 0 1 1\n\
         f 0 1 0 1 0 1 0 0\nc 0 0 0 0.25 0 0 1 0\np 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
    );
    let scene = load(&text);
    let shapes: Vec<Shape> = scene.curved.iter().map(|primitive| primitive.shape).collect();
    let expected = [
        Shape::sphere(Vec3::new(1.0, 2.0, 3.0), 0.5),
        Shape::cylinder(Vec3::ZERO, Vec3::Z, 1.0),
        Shape::cone(Vec3::ZERO, 0.25, Vec3::Z, 0.0),
    ];
    assert_eq!(shapes, expected);
    let counts: Vec<_> =
        scene.objects.iter().map(|o| (o.polygons, o.count, o.first_curved, o.curved_count)).collect();
    assert_eq!(counts, [(1, 1, 0, 2), (1, 2, 2, 1)]);
    assert_eq!(scene.primitive_count(), 6);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn a_scene_of_spheres_alone_is_one() {
    let scene = load("s 0 0 0 1\n");
    assert_eq!((scene.triangles.len(), scene.curved.len(), scene.objects[0].name.as_str()), (0, 1, "fill-0"));
    assert_eq!(scene.bounds().unwrap().0.x, (-1.0f32).next_down());
    assert_eq!(warned(&scene, "what comes before the first `f` is drawn grey (1 primitive)"), 1);
}

#[test]
fn negative_radii_ask_for_the_inside_and_both_sides_are_drawn_anyway() {
    let scene = load("s 0 0 0 -2\nc 0 0 0 -1 0 0 1 -0.5\nc 0 0 0 -1 0 0 1 0\nc 0 0 0 0 0 0 1 -3\n");
    let shapes: Vec<Shape> = scene.curved.iter().map(|primitive| primitive.shape).collect();
    let cone = |base: f32, apex: f32| Shape::cone(Vec3::ZERO, base, Vec3::Z, apex);
    assert_eq!(shapes, [Shape::sphere(Vec3::ZERO, 2.0), cone(1.0, 0.5), cone(1.0, 0.0), cone(0.0, 3.0)]);
}

#[test]
fn mirrors_and_transparent_materials() {
    let text = "f 1 1 1 0.1 0.75 100000 0.5 1.5\ns 0 0 0 1\nf 1 1 1 1 7 1 1 1\ns 0 0 0 1\n\
                f 1 1 1 1 0 1 0 -3\ns 0 0 0 1\n";
    let scene = load(text);
    let transmission =
        |t: f32, refractive_index: f32| Some(Transmission { transmittance: [t; 3], refractive_index });
    let of = |i: u32| (scene.material(i).mirror, scene.material(i).transmission);
    assert_eq!(of(0), ([0.75; 3], transmission(0.5, 1.5)));
    assert_eq!(of(1), ([1.0; 3], transmission(1.0, 1.0)));
    assert_eq!(of(2), ([0.0; 3], None));
    assert_eq!(scene.material(0).specular, [0.75; 3]);
}

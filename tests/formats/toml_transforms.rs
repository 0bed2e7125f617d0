//! Where TOML scenes put things, in bits.

use crate::corners;
use crate::fixtures::Folder;
use glam::{DAffine3, DMat3, DVec3, Vec3};
use lightbuffer::scene::{Scene, formats};

/// Numbers without a short form in decimal, and a zero with a sign.
const OBJ: &str = "v 0.1 -0 0.3\nv 1.1 0.7 -0.3\nv -0.2 1.3 0.9\nf 1 2 3\n";
const CORNERS: [[f32; 3]; 3] = [[0.1, -0.0, 0.3], [1.1, 0.7, -0.3], [-0.2, 1.3, 0.9]];

fn load(text: &str) -> Scene {
    let folder = Folder::new();
    folder.write("some.obj", OBJ);
    let inner = "version = 1\n[[include]]\npath = 'some.obj'\ntransform = { translate = [0.1, 0, 0] }\n\
        [[light]]\ntype = 'spot'\nposition = [0, 1, 0]\ndirection = [1, 0, 0]\nintensity = 7\nrange = 5\n\
        [[light]]\ntype = 'directional'\ntowards = [0, 1, 0]\n\
        [[light]]\ntype = 'point'\nposition = [3, 0, 0]\n\
        [[camera]]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nsize = [8, 8]\n";
    folder.write("inner.toml", inner);
    formats::load(&folder.write("test.toml", format!("version = 1\n{text}"))).unwrap()
}

fn bits(corners: &[[[f32; 3]; 3]]) -> Vec<[[u32; 3]; 3]> {
    corners.iter().map(|triangle| triangle.map(|corner| corner.map(f32::to_bits))).collect()
}

/// The triangle where a transform puts it, each coordinate rounded once.
fn moved(transform: DAffine3) -> Vec<[[u32; 3]; 3]> {
    let place =
        |corner: [f32; 3]| transform.transform_point3(Vec3::from(corner).as_dvec3()).as_vec3().to_array();
    bits(&[CORNERS.map(place)])
}

#[track_caller]
fn assert_moved(transform: &str, expected: DAffine3) {
    let scene = load(&format!("[[include]]\npath = 'some.obj'\ntransform = {{ {transform} }}\n"));
    assert_eq!(bits(&corners(&scene)), moved(expected), "{transform}");
    let mesh =
        "[[mesh]]\nvertices = [[0.1, -0.0, 0.3], [1.1, 0.7, -0.3], [-0.2, 1.3, 0.9]]\nfaces = [[0, 1, 2]]";
    let scene = load(&format!("{mesh}\ntransform = {{ {transform} }}\n"));
    assert_eq!(bits(&corners(&scene)), moved(expected), "mesh {transform}");
}

#[test]
fn nothing_said_moves_nothing() {
    for transform in ["", "transform = {}\n"] {
        let scene = load(&format!("[[include]]\npath = 'some.obj'\n{transform}"));
        assert_eq!(bits(&corners(&scene)), bits(&[CORNERS]));
    }
}

#[test]
fn each_part_does_what_it_says() {
    let scaled = |scale: DVec3| DAffine3 { matrix3: DMat3::from_diagonal(scale), translation: DVec3::ZERO };
    assert_moved("scale = 3", scaled(DVec3::splat(3.0)));
    assert_moved("scale = [0.1, 2, 7.5]", scaled(DVec3::new(0.1, 2.0, 7.5)));
    assert_moved("translate = [0.1, 1e6, -3]", DAffine3::from_translation(DVec3::new(0.1, 1e6, -3.0)));
    let quarter = DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X);
    assert_moved(
        "rotate = { axis = [0, 2, 0], degrees = 90 }",
        DAffine3 { matrix3: quarter, translation: DVec3::ZERO },
    );
    // Scale, then rotate, then translate, whatever the order in the file.
    assert_moved(
        "translate = [1, 2, 3], rotate = { axis = [0, 1, 0], degrees = -270 }, scale = [1, 2, 3]",
        DAffine3 {
            matrix3: quarter * DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)),
            translation: DVec3::new(1.0, 2.0, 3.0),
        },
    );
    assert_moved(
        "matrix = [[1, 2, 0, 5], [0, 1, 0, 6], [0, 0.3, 1, 7], [0, 0, 0, 1]]",
        DAffine3 {
            matrix3: DMat3::from_cols(DVec3::X, DVec3::new(2.0, 1.0, 0.3), DVec3::Z),
            translation: DVec3::new(5.0, 6.0, 7.0),
        },
    );
}

#[test]
fn a_mirror_turns_triangles_round() {
    let scene = load("[[include]]\npath = 'some.obj'\ntransform = { scale = [-1, 1, 1] }\n");
    let [a, b, c] = CORNERS.map(|[x, y, z]| [-x, y + 0.0, z]);
    assert_eq!(corners(&scene), [[a, c, b]]);
}

#[test]
fn files_inside_each_other_are_rounded_once() {
    // A tenth and its undoing: with a rounding in between it would not come back.
    let scene = load("[[include]]\npath = 'inner.toml'\ntransform = { translate = [1e8, 0, 0] }\n");
    let there = DVec3::new(1e8, 0.0, 0.0) + DVec3::new(0.1, 0.0, 0.0);
    assert_eq!(bits(&corners(&scene)), moved(DAffine3::from_translation(there)));
    let scene = load("[[include]]\npath = 'inner.toml'\ntransform = { translate = [-0.1, 0, 0] }\n");
    assert_eq!(corners(&scene), [CORNERS]);
}

#[test]
fn lights_and_cameras_go_with_their_file() {
    let scene = load(
        "[[include]]\npath = 'inner.toml'\n\
         transform = { scale = 2, rotate = { axis = [0, 0, 1], degrees = 90 }, translate = [0, 0, 10] }\n",
    );
    let spot = &scene.lights[0];
    assert_eq!(spot.position().homogeneous(), (Vec3::new(-2.0, 0.0, 10.0), 1.0));
    assert_eq!((spot.cone().unwrap().axis, spot.strength()), (Vec3::new(0.0, 2.0, 0.0), [7.0; 3]));
    let (towards, w) = scene.lights[1].position().homogeneous();
    assert_eq!((towards, w), (Vec3::new(-2.0, 0.0, 0.0), 0.0));
    assert_eq!(scene.lights[2].position().homogeneous().0, Vec3::new(0.0, 6.0, 10.0));
    let camera = &scene.cameras[0];
    assert_eq!((camera.origin, camera.forward), (Vec3::new(0.0, 0.0, 20.0), Vec3::NEG_Z));
    assert_eq!((camera.right, camera.up), (Vec3::Y, Vec3::NEG_X));
    assert_eq!(camera.size.unwrap().width, 8);
}

//! OBJ and MTL.

use crate::fixtures::Folder;
use crate::{corners, warned};
use lightbuffer::scene::{Scene, formats};

fn load(text: &str) -> Scene {
    let folder = Folder::new();
    formats::load(&folder.write("test.obj", text)).unwrap()
}

#[test]
fn positions_stay_shared_and_polygons_are_fanned() {
    let scene = load("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 1.5 0\nf 1 2 3 5 4\n");
    assert_eq!(scene.vertices.len(), 5);
    assert_eq!(scene.triangles.len(), 3);
    assert_eq!(scene.name, "test.obj");
    assert_eq!(scene.objects[0].name, "test");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn a_concave_polygon_is_filled_and_no_more() {
    // An L of area 3 in the plane x = 2; a fan from its first corner would cover the notch.
    let scene = load("v 2 1 1\nv 2 1 2\nv 2 0 2\nv 2 0 0\nv 2 2 0\nv 2 2 1\nf 1 2 3 4 5 6\n");
    let area: f32 = (0..4)
        .map(|t| {
            let [a, b, c] = scene.corners(t);
            (b - a).cross(c - a).x * 0.5
        })
        .map(f32::abs)
        .sum();
    assert_eq!(area, 3.0);
}

#[test]
fn indices_may_be_negative_and_carry_other_attributes() {
    let text = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 2\nf -3/1/1 -2//1 -1//-1\nf 2/1 3/1 4/1\n";
    let scene = load(text);
    let expected = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(corners(&scene), [expected, expected]);
    let normals = scene.objects[0].normals.as_ref().unwrap();
    // The second face has no normals of its own and is given its flat one.
    for corner in normals.corners.iter().flatten() {
        assert_eq!(normals.normals[*corner as usize].to_array(), [0.0, 0.0, 1.0]);
    }
}

#[test]
fn objects_and_surfaces_are_numbered_from_one_in_the_order_of_the_file() {
    let scene = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no first\nf 1 2 3\nf 1 2 4\ng second\nf 2 3 4\n");
    let numbers: Vec<_> = (0..3).map(|t| scene.object_and_surface(t)).collect();
    assert_eq!(numbers, [(1, 1), (1, 2), (2, 1)]);
    let names: Vec<_> = scene.objects.iter().map(|o| o.name.as_str()).collect();
    assert_eq!(names, ["first", "second"]);
}

#[test]
fn faces_of_an_object_without_normals_do_not_borrow_those_of_another() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\no a\nf 1//1 2//1 3//1\no b\nf 1 2 3\n";
    let scene = load(text);
    assert!(scene.objects[0].normals.is_some());
    assert!(scene.objects[1].normals.is_none());
}

#[test]
fn materials_come_from_libraries_beside_the_file() {
    let folder = Folder::new();
    folder.write(
        "sub folder/paint.mtl",
        "# remark\nnewmtl red\nKd 1 0.25 0\nKs 0.5 0.5 0.5\nNs 32\nnewmtl matt\nKd 0.5\nKs 1 1 1\nillum 1\n\
         map_Kd no-such-file.png\nnewmtl odd\nKd spectral some.rfl\nd 0.5\n\
         newmtl glass\nKd 1 1 1\nTr 0.25\nNi 1.5\nillum 7\nnewmtl both\nNi 1.5\nd 1\nTr 1\nnewmtl rim\nd -halo 0.1\n",
    );
    let text =
        "mtllib sub folder/paint.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl matt\nf 1 2 3\n";
    let scene = formats::load(&folder.write("test.obj", text)).unwrap();
    let red = scene.material(0);
    assert_eq!((red.name.as_str(), red.diffuse, red.specular), ("red", [1.0, 0.25, 0.0], [0.5; 3]));
    assert_eq!(red.shininess, 32.0);
    let matt = scene.material(1);
    assert_eq!((matt.diffuse, matt.specular), ([0.5; 3], [0.0; 3]));
    warned(&scene, "textures are not drawn (1 material)");
    let passes =
        |index: usize| scene.materials[index].transmission.map(|t| (t.transmittance, t.refractive_index));
    let all: Vec<_> = (0..scene.materials.len()).map(passes).collect();
    assert_eq!(all, [None, None, None, Some(([0.5; 3], 1.0)), Some(([0.25; 3], 1.5)), None, None]);
    assert_eq!((scene.materials[3].diffuse, scene.materials[4].diffuse), ([0.35; 3], [0.75; 3]));
    warned(&scene, "materials that thin out towards the rim are drawn opaque (1 material)");
    assert_eq!(warned(&scene, "spectral"), 3);
}

#[test]
fn one_line_may_name_two_libraries() {
    let folder = Folder::new();
    folder.write("a.mtl", "newmtl a\nKd 1 0 0\n");
    folder.write("b.mtl", "newmtl b\nKd 0 1 0\n");
    let text = "mtllib a.mtl b.mtl\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl b\nf 1 2 3\n";
    let scene = formats::load(&folder.write("test.obj", text)).unwrap();
    assert_eq!(scene.material(0).diffuse, [0.0, 1.0, 0.0]);
    assert_eq!(scene.materials.len(), 3);
}

#[test]
fn what_is_not_drawn_is_said_once() {
    let text = "mtllib none.mtl\nv 0 0 0 1 1 1\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl x\nf 1 2 3\nusemtl y\nf 1 2 4 # remark\n\
                l 1 2 3\np 1\nf 1 2\nsurf 0 1 0 1 1 2\nwhat 1 2\nwhat 3\n";
    let scene = load(text);
    assert_eq!(scene.triangles.len(), 2);
    warned(&scene, "cannot read `none.mtl`");
    warned(&scene, "2 usemtl lines without a known material, drawn grey, the first `x` in line 6");
    warned(&scene, "passed over 2 lines with unknown keywords, the first `what` in line 14");
    warned(&scene, "points, lines and faces of fewer than three corners are not drawn (3 lines)");
    warned(&scene, "free-form");
    assert_eq!(warned(&scene, "vertex colours"), 6);
}

#[test]
fn triangles_with_bad_numbers_are_dropped_and_counted() {
    let text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 1e99 0 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 3 5\nf 1 2 6\n";
    let scene = load(text);
    assert_eq!(scene.triangles.len(), 1);
    assert_eq!((scene.dropped.non_finite, scene.dropped.degenerate), (3, 1));
    warned(&scene, "NaN");
}

#[test]
fn windows_line_ends_remarks_and_continued_lines_are_read() {
    let scene =
        load("\u{feff}v 0 0 0\r\n# r\u{e9}mark\r\nv 1 0 0 # here\r\nv 0 1 \\\r\n0\r\nf 1 2 \\\r\n 3\r\n");
    assert_eq!(corners(&scene), [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]);
    assert!(scene.warnings.is_empty());
}

#[test]
fn numbers_are_rounded_once() {
    // Halfway between two floats but for the last digit: through f64 it would be rounded twice, and down.
    let scene = load("v 1.00000005960464477539063 0 0\nv 2 1 0\nv 2 0 0\nf 1 2 3\n");
    assert_eq!(scene.vertices[0].x, 1.0f32.next_up());
}

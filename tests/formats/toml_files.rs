//! The project's own format.

use crate::fixtures::{Folder, data_uri, triangle};
use crate::gltf_parts::{paint, png};
use crate::{corners, warned};
use glam::Vec3;
use lightbuffer::scene::{Coverage, Emitter, Falloff, ImageSize, Light, Scene, Shadowing, formats};
use serde_json::json;

const OBJ: &str =
    "o first\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no second\nv 0 0 9\nv 1 0 9\nv 0 1 9\nf 4 5 6\n";
const MESH: &str = "[[mesh]]\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n";

/// A scene of a text that may include `some.obj`.
fn load(text: &str) -> Scene {
    let folder = Folder::new();
    folder.write("some.obj", OBJ);
    load_in(&folder, text)
}

fn load_in(folder: &Folder, text: &str) -> Scene {
    formats::load(&folder.write("test.toml", format!("version = 1\n{text}"))).unwrap()
}

fn names(lights: &[Light]) -> Vec<&str> {
    lights.iter().map(|light| light.name.as_str()).collect()
}

#[test]
fn a_mesh_is_an_object_with_all_that_is_said_about_it() {
    let scene = load(
        "name = 'ours'\n[[material]]\nname = 'clay'\ndiffuse = [0.5, 0.25, 0]\nspecular = 0.5\nshininess = 20\n\
         [[mesh]]\nname = 'L'\nmaterial = 'clay'\ncast_shadows = false\n\
         vertices = [[0, 0, 0.1], [2, 0, 0.1], [2, 1, 0.1], [1, 1, 0.1], [1, 2, 0.1], [0, 2, 0.1]]\n\
         faces = [[0, 1, 2, 3, 4, 5]]\n\
         normals = [[0, 0, 2], [0, 0, 1], [0, 3, 4], [0, 0, 1], [0, 0, 1], [0, 0, 1]]\n\
         [[mesh]]\nreceive_shadows = false\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n",
    );
    assert_eq!(scene.name, "ours");
    assert_eq!(
        scene.objects.iter().map(|o| (o.name.as_str(), o.count)).collect::<Vec<_>>(),
        [("L", 4), ("mesh-2", 1)]
    );
    let area: f32 = corners(&scene)[..4]
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(Vec3::from);
            assert!([a, b, c].iter().all(|p| p.z == 0.1));
            (b - a).cross(c - a).z * 0.5
        })
        .sum();
    assert_eq!(area, 3.0);
    let clay = scene.material(0);
    assert_eq!((clay.name.as_str(), clay.diffuse, clay.specular), ("clay", [0.5, 0.25, 0.0], [0.5; 3]));
    assert_eq!((clay.shininess, scene.material(4).name.as_str()), (20.0, "default"));
    assert_eq!(scene.objects[0].shadowing, Shadowing { casts: false, receives: true });
    assert_eq!(scene.objects[1].shadowing, Shadowing { casts: true, receives: false });
    let normals = scene.objects[0].normals.as_ref().unwrap();
    assert!(normals.normals.contains(&Vec3::new(0.0, 0.6, 0.8)) && normals.normals.contains(&Vec3::Z));
    assert!(scene.objects[1].normals.is_none() && scene.warnings.is_empty());
}

#[test]
fn lights_of_every_kind_have_what_is_said() {
    let scene = load(&format!(
        "{MESH}[[light]]\ntype = 'point'\nposition = [1, 2, 3]\n\
         [[light]]\nname = 'far'\ntype = 'point'\nposition = [1, 2, 3]\nintensity = [1, 2, 3.5]\nrange = 9\n\
         [[light]]\ntype = 'spot'\nposition = [0, 5, 0]\ntarget = [0, 2, 1]\nfalloff = 'none'\n\
         [[light]]\ntype = 'spot'\nposition = [0, 5, 0]\ndirection = [0, -7, 0]\ninner_degrees = 60\nouter_degrees = 90\n\
         [[light]]\ntype = 'spot'\nposition = [0, 5, 0]\ndirection = [0, -7, 0]\ninner_degrees = 30\nouter_degrees = 30\n\
         [[light]]\nname = 'far'\ntype = 'directional'\ndirection = [1, -2, 0]\nirradiance = 3\n\
         [[light]]\ntype = 'directional'\ntowards = [0.1, 2, 0]\n"
    ));
    assert_eq!(names(&scene.lights), ["light-1", "far", "light-3", "light-4", "light-5", "far-2", "light-7"]);
    let point = |i: usize| match &scene.lights[i].emitter {
        Emitter::Point(point) => (point.position.to_array(), point.intensity, point.falloff),
        Emitter::Spot(spot) => (spot.point.position.to_array(), spot.point.intensity, spot.point.falloff),
        Emitter::Directional(_) => panic!("light {i}"),
    };
    assert_eq!(point(0), ([1.0, 2.0, 3.0], [1.0; 3], Falloff::InverseSquare));
    assert_eq!(point(1), ([1.0, 2.0, 3.0], [1.0, 2.0, 3.5], Falloff::Range(9.0)));
    assert_eq!(point(2).2, Falloff::Constant);
    let cone = |i: usize| *scene.lights[i].cone().unwrap();
    assert_eq!((cone(2).axis, cone(3).axis), (Vec3::new(0.0, -3.0, 1.0), Vec3::new(0.0, -7.0, 0.0)));
    assert_eq!((cone(2).cos_inner, cone(2).cos_outer), (1.0, libm::cos(45f64.to_radians()) as f32));
    assert_eq!((cone(3).cos_inner, cone(3).cos_outer), (0.5, 0.0));
    assert_eq!(cone(4).cos_inner, cone(4).cos_outer.next_up());
    let sun = |i: usize| match &scene.lights[i].emitter {
        Emitter::Directional(light) => (light.towards.to_array(), light.irradiance),
        _ => panic!("light {i}"),
    };
    assert_eq!(sun(5), ([-1.0, 2.0, -0.0], [3.0; 3]));
    assert_eq!(sun(6), ([0.1, 2.0, 0.0], [1.0; 3]));
}

#[test]
fn cameras_look_from_their_position_at_their_target() {
    let scene = load(&format!(
        "{MESH}[[camera]]\nposition = [1, 2, 3]\ntarget = [1, 2, -7]\nvertical_degrees = 90\nsize = [64, 36]\n\
         [[camera]]\nname = 'down'\nposition = [0, 9, 0]\ntarget = [0, 0, 0]\nup = [0, 0, -3]\n"
    ));
    let [first, down] = &scene.cameras[..] else { panic!("two cameras") };
    assert_eq!((first.name.as_str(), first.origin), ("camera-1", Vec3::new(1.0, 2.0, 3.0)));
    assert_eq!((first.forward, first.right, first.up), (Vec3::NEG_Z, Vec3::X, Vec3::Y));
    assert!((first.tan_half_height - 1.0).abs() < 1e-15);
    assert_eq!(first.size, Some(ImageSize { width: 64, height: 36 }));
    assert_eq!(
        (down.name.as_str(), down.forward, down.up, down.size),
        ("down", Vec3::NEG_Y, Vec3::NEG_Z, None)
    );
    assert_eq!(down.tan_half_height, libm::tan(45f64.to_radians() * 0.5));
}

#[test]
fn what_a_file_holds_comes_before_what_it_includes() {
    let folder = Folder::new();
    folder.write(
        "inner.toml",
        format!(
            "version = 1\n{MESH}[[light]]\nname = 'a'\ntype = 'point'\nposition = [0, 9, 0]\n\
             [[camera]]\nname = 'c'\nposition = [0, 0, 9]\ntarget = [0, 0, 0]\n"
        ),
    );
    let own = "[[mesh]]\nname = 'own'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n\
               [[light]]\nname = 'b'\ntype = 'point'\nposition = [0, 5, 0]\n\
               [[camera]]\nname = 'c'\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\n";
    let include = "[[include]]\npath = 'inner.toml'\n";
    let scene = load_in(&folder, &format!("{include}{own}{include}"));
    assert_eq!(scene.name, "test.toml");
    assert_eq!(
        scene.objects.iter().map(|o| o.name.as_str()).collect::<Vec<_>>(),
        ["own", "mesh-1", "mesh-1"]
    );
    assert_eq!(names(&scene.lights), ["b", "a", "a-2"]);
    assert_eq!(scene.cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["c", "c-2", "c-3"]);
    assert_eq!(scene.cameras[0].origin.z, 5.0);
    let scene = load_in(&folder, &format!("{include}lights = false\n{include}cameras = false\n"));
    assert_eq!((names(&scene.lights), scene.cameras.len()), (vec!["a"], 1));
    // What one leaves out does not come back further in.
    folder.write("middle.toml", format!("version = 1\n{include}lights = true\ncameras = true\n"));
    let scene = load_in(&folder, "[[include]]\npath = 'middle.toml'\nlights = false\ncameras = false\n");
    assert_eq!((scene.lights.len(), scene.cameras.len(), scene.triangles.len()), (0, 0, 1));
}

#[test]
fn includes_decide_about_shadows_and_materials_and_the_outermost_last() {
    let folder = Folder::new();
    folder.write("some.obj", OBJ);
    folder.write(
        "inner.toml",
        "version = 1\n[[material]]\nname = 'red'\ndiffuse = [1, 0, 0]\n\
         [[include]]\npath = 'some.obj'\nmaterial = 'red'\ncast_shadows = false\n",
    );
    let inner = load_in(&folder, "[[include]]\npath = 'inner.toml'\nreceive_shadows = false\n");
    for object in 0..2 {
        assert_eq!(inner.objects[object].shadowing, Shadowing { casts: false, receives: false });
        assert_eq!(inner.material(object as u32).name, "red");
    }
    let outer = load_in(
        &folder,
        "[[material]]\nname = 'red'\ndiffuse = [0, 0, 1]\n\
         [[include]]\npath = 'inner.toml'\nmaterial = 'red'\ncast_shadows = true\n",
    );
    assert_eq!(outer.objects[1].shadowing, Shadowing { casts: true, receives: true });
    assert_eq!(outer.material(1).diffuse, [0.0, 0.0, 1.0]);
    // Read once and its materials kept once.
    let twice = load_in(&folder, &"[[include]]\npath = 'inner.toml'\n".repeat(3));
    assert_eq!((twice.materials.len(), twice.objects.len()), (2, 6));
}

#[test]
fn holes_stay_where_they_are_under_another_material() {
    let folder = Folder::new();
    let mut net = triangle();
    net["materials"][0]["alphaMode"] = json!("MASK");
    paint(&mut net, json!({ "uri": data_uri(&png(2, &[0, 255])) }), [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    folder.write("net.gltf", net.to_string());
    let scene = load_in(
        &folder,
        "[[material]]\nname = 'red'\ndiffuse = [1, 0, 0]\n[[include]]\npath = 'net.gltf'\n\
         [[include]]\npath = 'net.gltf'\nmaterial = 'red'\ntransform = { scale = [-1, 1, 1] }\n",
    );
    assert_eq!((scene.alpha_masks.len(), scene.triangles.len()), (1, 2));
    assert_eq!(scene.material(0).coverage, Coverage::Masked(0));
    assert_eq!(
        (scene.material(1).diffuse, scene.material(1).coverage),
        ([1.0, 0.0, 0.0], Coverage::Masked(0))
    );
    let [own, mirrored] = [0, 1].map(|t| scene.masked(t).unwrap().coordinates);
    assert_eq!(mirrored, [own[0], own[2], own[1]]);
}

#[test]
fn warnings_say_where_they_come_from_and_what_is_dropped_is_counted_for_each_placement() {
    let folder = Folder::new();
    folder.write("sub/some.obj", format!("{OBJ}f 1 1 2\nwhat 1\n"));
    folder.write("sub/inner.toml", "version = 1\n[[include]]\npath = 'some.obj'\n");
    let include = "[[include]]\npath = 'sub/inner.toml'\n";
    let scene = load_in(&folder, &include.repeat(2));
    assert_eq!((scene.triangles.len(), scene.dropped.degenerate), (4, 2));
    warned(&scene, "sub/some.obj: dropped 1 triangles of zero area");
    assert_eq!(warned(&scene, "sub/some.obj: passed over 1 line"), 2);
    // A bow tie of our own, and what no longer has an area where it is put.
    let bow = "[[mesh]]\nvertices = [[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1.5, 0]]\nfaces = [[0, 1, 2, 3]]\n";
    let far = "transform = { scale = 1e-9, translate = [9, 9, 9] }\n";
    let scene = load_in(&folder, &format!("{bow}{MESH}{far}"));
    assert_eq!(scene.dropped.degenerate, 1);
    warned(&scene, "outlines that cross themselves are cut into triangles as far as possible (1 polygon)");
    assert_eq!(warned(&scene, "dropped 1 triangles of zero area"), 2);
}

#[test]
fn a_scene_may_be_lights_for_another() {
    let folder = Folder::new();
    folder.write("lights.toml", "version = 1\n[[light]]\ntype = 'point'\nposition = [1, 2, 3]\n");
    let scene = load_in(&folder, &format!("{MESH}[[include]]\npath = './lights.toml'\n"));
    assert_eq!((scene.lights.len(), scene.triangles.len()), (1, 1));
}

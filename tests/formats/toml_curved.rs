//! Curved surfaces, objects of several parts, materials and textures of the project's own format.

use crate::fixtures::Folder;
use crate::gltf_parts::png;
use glam::{DVec3, Vec3};
use lightbuffer::geometry::curved::{Disc, Ellipsoid, InfinitePlane, Quadric, Shape};
use lightbuffer::scene::{Mapping, Pattern, Scene, Shadowing, Texels, Transmission, Wrap, formats};
use lightbuffer::shading::surface_colour;

const MESH: &str = "vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n";

fn load(text: &str) -> Scene {
    load_in(&Folder::new(), text)
}

fn load_in(folder: &Folder, text: &str) -> Scene {
    formats::load(&folder.write("test.toml", format!("version = 1\n{text}"))).unwrap()
}

fn shapes(scene: &Scene) -> Vec<Shape> {
    scene.curved.iter().map(|primitive| primitive.shape).collect()
}

/// Names and numbers of triangles and curved surfaces of all objects.
fn objects(scene: &Scene) -> Vec<(&str, u32, u32)> {
    scene.objects.iter().map(|o| (o.name.as_str(), o.count, o.curved_count)).collect()
}

#[test]
fn every_kind_of_surface_in_the_order_of_the_file() {
    let scene = load(
        "background = [0.5, 0, 2]\n\
         [[quadric]]\ncentre = [1, 2, 3]\nsquares = [1, 2, 3]\nmixed = [4, 5, 6]\nlinear = [7, 8, 9]\n\
         constant = -0.5\nlow = [-1, -1, -1]\nhigh = [4, 4, 4]\n\
         [[plane]]\npoint = [0, 1, 0]\nnormal = [0, 0, 2]\n\
         [[disc]]\ncentre = [1, 1, 1]\nnormal = [0, 1, 0]\nradius = 0.25\n\
         [[sphere]]\nname = 'ball'\ncentre = [0, 0, 0.1]\nradius = 0.1\n\
         [[cone]]\nbase = [0, 0, 0]\nbase_radius = 1\napex = [0, 2, 0]\n\
         [[cone]]\nbase = [0, 0, 0]\nbase_radius = 0\napex = [0, 2, 0]\napex_radius = 0.5\n\
         [[cylinder]]\nbase = [0, 0, 0]\napex = [0, 2, 0]\nradius = 2\n\
         [[ellipsoid]]\ncentre = [0, 0, 0]\nradii = [1, 2, 3]\n\
         [[ellipsoid]]\ncentre = [0, 0, 0]\naxes = [[1, 0, 0], [1, 1, 0], [0, 0, 1]]\n",
    );
    let ellipsoid =
        |axes: [[f32; 3]; 3]| Shape::Ellipsoid(Ellipsoid { centre: Vec3::ZERO, axes: axes.map(Vec3::from) });
    let expected = [
        Shape::Quadric(Quadric {
            reference: Vec3::new(1.0, 2.0, 3.0),
            second: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            first: Vec3::new(7.0, 8.0, 9.0),
            constant: -0.5,
            low: Vec3::NEG_ONE,
            high: Vec3::splat(4.0),
        }),
        Shape::Plane(InfinitePlane { point: Vec3::Y, normal: Vec3::Z * 2.0 }),
        Shape::Disc(Disc { centre: Vec3::ONE, normal: Vec3::Y, radius: 0.25 }),
        Shape::sphere(Vec3::new(0.0, 0.0, 0.1), 0.1),
        Shape::cone(Vec3::ZERO, 1.0, Vec3::Y * 2.0, 0.0),
        Shape::cone(Vec3::ZERO, 0.0, Vec3::Y * 2.0, 0.5),
        Shape::cylinder(Vec3::ZERO, Vec3::Y * 2.0, 2.0),
        ellipsoid([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]]),
        ellipsoid([[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    ];
    assert_eq!(shapes(&scene), expected);
    let names: Vec<_> = objects(&scene).iter().map(|(name, ..)| name.to_owned()).collect();
    let kinds = [
        "quadric-1",
        "plane-1",
        "disc-1",
        "ball",
        "cone-1",
        "cone-2",
        "cylinder-1",
        "ellipsoid-1",
        "ellipsoid-2",
    ];
    assert_eq!(names, kinds);
    assert_eq!((scene.background, scene.bounds().is_some()), ([0.5, 0.0, 2.0], true));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn parts_of_one_object_share_what_one_of_them_says() {
    let scene = load(&format!(
        "[[material]]\nname = 'clay'\n[[sphere]]\ncentre = [9, 0, 0]\nradius = 1\n\
         [[disc]]\nobject = 'cup'\ncentre = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 1\n\
         [[mesh]]\nname = 'alone'\n{MESH}\
         [[mesh]]\nobject = 'cup'\nname = 'the cup'\ncast_shadows = false\n{MESH}\
         [[cylinder]]\nobject = 'cup'\nmaterial = 'clay'\nbase = [0, 0, 0]\napex = [0, 1, 0]\nradius = 1\n\
         transform = {{ translate = [0, 5, 0] }}\n\
         [[mesh]]\nobject = 'cup'\nmaterial = 'clay'\nnormals = [[1, 0, 0], [1, 0, 0], [1, 0, 0]]\n\
         polygons = 7\ntransform = {{ scale = 2 }}\n{MESH}"
    ));
    assert_eq!(objects(&scene), [("sphere-1", 0, 1), ("the cup", 2, 2), ("alone", 1, 0)]);
    let cup = &scene.objects[1];
    assert_eq!(scene.materials[cup.material as usize].name, "clay");
    assert_eq!((cup.shadowing, cup.polygons), (Shadowing { casts: false, receives: true }, 8));
    assert_eq!(scene.corners(cup.first + 1)[1], Vec3::X * 2.0);
    let moved = Shape::cylinder(Vec3::Y * 5.0, Vec3::Y * 6.0, 1.0);
    assert_eq!(shapes(&scene)[2], moved);
    let normals = cup.normals.as_ref().unwrap();
    let of = |t: usize| normals.corners[t].map(|corner| normals.normals[corner as usize]);
    assert_eq!((of(0), of(1)), ([Vec3::Z; 3], [Vec3::X; 3]));
    assert_eq!(scene.object_and_surface(scene.triangles.len() as u32 + 2), (2, 4));
}

#[test]
fn objects_of_parts_are_placed_whole_by_files_around_them() {
    let folder = Folder::new();
    folder.write(
        "cup.toml",
        "version = 1\nbackground = 0.25\n[[sphere]]\nobject = 'cup'\ncentre = [1, 0, 0]\nradius = 1\n\
         [[sphere]]\nobject = 'cup'\ncentre = [0, 0, 0]\nradius = 1\ntransform = { translate = [0, 1, 0] }\n",
    );
    let include = "[[include]]\npath = 'cup.toml'\n";
    let scene = load_in(&folder, &format!("{include}transform = {{ scale = 2 }}\n{include}"));
    assert_eq!(objects(&scene), [("cup", 0, 2); 2]);
    let sphere = Shape::sphere;
    let (x, y) = (Vec3::X, Vec3::Y);
    assert_eq!(shapes(&scene), [sphere(x * 2.0, 2.0), sphere(y * 2.0, 2.0), sphere(x, 1.0), sphere(y, 1.0)]);
    assert_eq!(scene.background, [0.25; 3]);
    let scene = load_in(&folder, &format!("background = 0\n{include}transform = {{ scale = [1, 2, 1] }}\n"));
    assert_eq!((scene.background, scene.curved[0].shape.kind()), ([0.0; 3], "ellipsoid"));
}

#[test]
fn mirrors_and_transparent_materials() {
    let material = |keys: &str| {
        let scene = load(&format!(
            "[[material]]\nname = 'm'\n{keys}\n[[sphere]]\nmaterial = 'm'\ncentre = [0, 0, 0]\nradius = 1\n"
        ));
        (scene.material(0).mirror, scene.material(0).transmission)
    };
    let glass = |transmittance: [f32; 3], refractive_index: f32| {
        Some(Transmission { transmittance, refractive_index })
    };
    assert_eq!(material("mirror = [1, 0.5, 0]"), ([1.0, 0.5, 0.0], None));
    assert_eq!(material("transmittance = 0.5"), ([0.0; 3], glass([0.5; 3], 1.5)));
    let water = material("transmittance = [0, 1, 0.5]\nrefractive_index = 1.33");
    assert_eq!(water.1, glass([0.0, 1.0, 0.5], 1.33));
    assert_eq!(material("transmittance = 0"), ([0.0; 3], None));
}

#[test]
fn textures_and_what_they_look_like() {
    let folder = Folder::new();
    let mut file = std::io::Cursor::new(Vec::new());
    let image = image::RgbImage::from_raw(2, 1, vec![255, 0, 0, 0, 0, 255]).unwrap();
    image.write_to(&mut file, image::ImageFormat::Png).unwrap();
    folder.write("sub/a.png", file.into_inner());
    let scene = load_in(
        &folder,
        &format!(
            "[[material]]\nname = 'floor'\ntexture = {{ checker = [0, 0, 1], size = 2, origin = [1, 0, 0] }}\n\
             [[material]]\nname = 'board'\n\
             texture = {{ image = 'sub/a.png', u = [2, 0, 0], v = [0, 2, 0], wrap_u = 'clamp', wrap_v = 'mirror' }}\n\
             [[material]]\nname = 'by coordinates'\ndiffuse = 0.5\n\
             texture = {{ image = 'sub\\\\a.png', coordinates = true }}\n\
             [[mesh]]\nmaterial = 'board'\n{MESH}\
             [[mesh]]\nmaterial = 'by coordinates'\ntexture_coordinates = [[0.25, 0], [0.75, 0], [0.25, 1]]\n{MESH}\
             [[sphere]]\nmaterial = 'floor'\ncentre = [0, 0, 0]\nradius = 1\n"
        ),
    );
    assert_eq!(scene.textures.len(), 3);
    assert_eq!(scene.textures[0].mapping, Mapping::Solid { origin: Vec3::X, size: 2.0 });
    let Pattern::Image { image, wrap } = &scene.textures[1].pattern else { panic!("an image") };
    assert_eq!((image.width, image.height, *wrap), (2, 1, [Wrap::ClampToEdge, Wrap::MirroredRepeat]));
    assert_eq!(image.texels, Texels::Srgb(vec![[255, 0, 0], [0, 0, 255]]));
    let colour = |p: u32, place: [f64; 3]| surface_colour(&scene, p, scene.material(p), DVec3::from(place));
    assert_eq!(colour(0, [0.5, 0.5, 0.0]), [1.0, 0.0, 0.0]);
    assert_eq!(colour(0, [1.0, 0.5, 0.0]), [0.5, 0.0, 0.5]);
    assert_eq!(colour(1, [0.0, 0.0, 0.0]), [0.5, 0.0, 0.0]);
    assert_eq!(colour(1, [1.0, 0.0, 0.0]), [0.0, 0.0, 0.5]);
    assert_eq!(colour(2, [0.5, 0.0, 0.0]), [0.0, 0.0, 1.0]);
    assert_eq!(colour(2, [1.5, 0.0, 0.0]), [0.7; 3]);
}

#[test]
fn cameras_by_their_axes_keep_their_bits() {
    let scene = load(&format!(
        "[[mesh]]\n{MESH}[[camera]]\nposition = [1, 2, 3]\nhalf_height = 0.1\n\
         axes = [[1.0000001, 0, 0], [0, 0.99999, 0], [0, 0, -1]]\n"
    ));
    let camera = &scene.cameras[0];
    assert_eq!((camera.right.x, camera.up.y, camera.forward), (1.0000001, 0.99999, Vec3::NEG_Z));
    assert_eq!((camera.tan_half_height, camera.origin), (0.1, Vec3::new(1.0, 2.0, 3.0)));
}

#[test]
fn grey_and_deep_pictures_become_bytes_of_three_channels() {
    let folder = Folder::new();
    folder.write("white.png", png(1, &[0]));
    let mut file = std::io::Cursor::new(Vec::new());
    let deep = image::ImageBuffer::<image::Luma<u16>, _>::from_raw(1, 1, vec![0x8080u16]).unwrap();
    deep.write_to(&mut file, image::ImageFormat::Png).unwrap();
    folder.write("deep.png", file.into_inner());
    for (name, expected) in [("white.png", [255; 3]), ("deep.png", [128; 3])] {
        let scene = load_in(
            &folder,
            &format!(
                "[[material]]\nname = 'm'\ntexture = {{ image = '{name}', size = 1 }}\n[[mesh]]\n{MESH}"
            ),
        );
        let Pattern::Image { image, .. } = &scene.textures[0].pattern else { panic!("an image") };
        assert_eq!(image.texels, Texels::Srgb(vec![expected]), "{name}");
    }
}

//! Small scenes that are hard on shadow testers, and the demo scenes small.

use glam::Vec3;
use lightbuffer::scene::{
    AlphaMask, Camera, Cone, Coverage, DirectionalLight, Emitter, Falloff, Framing, ImageSize, Light,
    Material, ObjectInput, PointLight, Scene, SceneBuilder, Shadowing, SpotLight, TextureCoordinates, Wrap,
    formats, frame,
};
use std::path::Path;

/// A scene, where it is seen from, and its lights.
#[derive(Debug)]
pub struct Case {
    pub name: String,
    pub scene: Scene,
    pub camera: Camera,
    pub size: ImageSize,
    pub lights: Vec<Light>,
}

/// A light at a point.
pub fn lamp(position: Vec3) -> Light {
    Light::point("lamp", PointLight { position, intensity: [1.0; 3], falloff: Falloff::InverseSquare })
}

/// A light infinitely far away.
pub fn sun(towards: Vec3) -> Light {
    let emitter = Emitter::Directional(DirectionalLight { towards, irradiance: [1.0; 3] });
    Light { name: "sun".into(), emitter }
}

/// Builds scenes from boxes, sheets and fans.
#[derive(Default)]
struct Parts(Vec<(Vec<Vec3>, Vec<[u32; 3]>, Shadowing)>);

impl Parts {
    fn mesh(mut self, positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Parts {
        self.0.push((positions, triangles, Shadowing::default()));
        self
    }

    /// The last part neither casts nor receives but as said.
    fn shadowing(mut self, shadowing: Shadowing) -> Parts {
        self.0.last_mut().expect("a part").2 = shadowing;
        self
    }

    /// A torus around a vertical axis.
    fn torus(self, centre: [f32; 3], [outer, inner]: [f32; 2]) -> Parts {
        const AROUND: u32 = 9;
        const ACROSS: u32 = 6;
        let turn = |i: u32, n: u32| 2.0 * std::f32::consts::PI * i as f32 / n as f32;
        let corner = |i: u32, j: u32| {
            let (u, v) = (turn(i, AROUND), turn(j, ACROSS));
            let r = outer + inner * libm::cosf(v);
            let offset = Vec3::new(r * libm::cosf(u), inner * libm::sinf(v), r * libm::sinf(u));
            Vec3::from(centre) + offset
        };
        let positions = (0..AROUND).flat_map(|i| (0..ACROSS).map(move |j| corner(i, j))).collect();
        let at = |i: u32, j: u32| i % AROUND * ACROSS + j % ACROSS;
        let triangles = (0..AROUND)
            .flat_map(|i| (0..ACROSS).map(move |j| (i, j)))
            .flat_map(|(i, j)| {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        self.mesh(positions, triangles)
    }

    /// A square in the plane y = `height`.
    fn floor(self, half: f32, height: f32) -> Parts {
        let corner = |x: f32, z: f32| Vec3::new(x * half, height, z * half);
        let corners = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
        self.mesh(corners, vec![[0, 1, 2], [0, 2, 3]])
    }

    fn cuboid(self, low: [f32; 3], high: [f32; 3]) -> Parts {
        let corner = |i: usize| {
            Vec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { high[axis] } else { low[axis] }))
        };
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        self.mesh((0..8).map(corner).collect(), triangles)
    }

    /// A square of n x n cells in the plane y = `height`, diagonals alternating.
    fn grid(self, n: u32, half: f32, height: f32) -> Parts {
        let at = |i: u32| -half + 2.0 * half * i as f32 / n as f32;
        let positions = (0..=n).flat_map(|z| (0..=n).map(move |x| Vec3::new(at(x), height, at(z)))).collect();
        let mut triangles = Vec::new();
        for (z, x) in (0..n).flat_map(|z| (0..n).map(move |x| (z, x))) {
            let [a, b, c, d] =
                [z * (n + 1) + x, z * (n + 1) + x + 1, (z + 1) * (n + 1) + x, (z + 1) * (n + 1) + x + 1];
            triangles.extend(if (x + z) % 2 == 0 { [[a, b, d], [a, d, c]] } else { [[a, b, c], [b, d, c]] });
        }
        self.mesh(positions, triangles)
    }

    fn scene(self, name: &str, place: impl Fn(Vec3) -> Vec3) -> Scene {
        let mut builder = SceneBuilder::new(name);
        for (i, (positions, triangles, shadowing)) in self.0.into_iter().enumerate() {
            let positions = positions.into_iter().map(&place).collect();
            let mut input = ObjectInput::new(format!("part {i}"), positions, triangles);
            input.shadowing = shadowing;
            builder.add_object(input).unwrap();
        }
        builder.finish()
    }
}

const SIZE: ImageSize = ImageSize { width: 48, height: 32 };

fn case(name: &str, parts: Parts, eye: [f32; 3], lights: &[[f32; 3]]) -> Case {
    placed(name, parts, eye, lights, |p| p)
}

/// A case moved as a whole: vertices, eye and lights.
fn placed(
    name: &str,
    parts: Parts,
    eye: [f32; 3],
    lights: &[[f32; 3]],
    place: impl Fn(Vec3) -> Vec3,
) -> Case {
    let (origin, target) = (place(Vec3::from(eye)), place(Vec3::new(0.0, 0.4, 0.0)));
    Case {
        name: name.into(),
        scene: parts.scene(name, &place),
        camera: Camera::look_at("eye", origin, target, Vec3::Y, 50.0),
        size: SIZE,
        lights: lights.iter().map(|&l| lamp(place(Vec3::from(l)))).collect(),
    }
}

fn boxes() -> Parts {
    Parts::default()
        .floor(4.0, 0.0)
        .cuboid([-1.0, 0.0, -1.0], [0.0, 1.0, 0.0])
        .cuboid([0.5, f32::from_bits(1), -0.5], [1.5, 0.5, 0.5])
        .cuboid([-0.75, 1.0, -0.75], [-0.25, 1.5, -0.25])
}

const EYE: [f32; 3] = [2.3, 2.7, 4.1];
const LIGHT: [f32; 3] = [-2.0, 4.0, 1.5];

/// The case of many polygons of several objects in every cell, interleaved in depth.
pub const CROWDED: &str = "rings through each other and stacked grids";

/// All cases, in a fixed order.
pub fn all() -> Vec<Case> {
    let up = 2f32.powi(40);
    let mut cases = vec![
        case("boxes that touch the floor and each other", boxes(), EYE, &[LIGHT, [3.0, 5.0, 1.0]]),
        case(
            "a light in the plane of faces",
            boxes(),
            EYE,
            &[[-3.0, 1.0, 2.0], [0.0, 3.0, 3.0], [-1.0, 2.5, -1.0]],
        ),
        case(
            "a light straight above the corner of a cell grid",
            boxes(),
            EYE,
            &[[0.0, 3.0, 0.0], [-0.5, 2.0, -0.5]],
        ),
        case(
            "a light on a vertex, an edge and a face",
            boxes(),
            EYE,
            &[[0.0, 1.0, 0.0], [-0.5, 1.0, 0.0], [-0.9, 1.0, -0.1]],
        ),
        case(
            "a light inside a box with a window",
            Parts::default()
                .floor(4.0, 0.0)
                .cuboid([-3.0, -1.0, -3.0], [3.0, 3.0, 3.0])
                .cuboid([-0.3, 0.5, -0.3], [0.3, 1.0, 0.3]),
            [2.0, 1.8, 2.5],
            &[[0.1, 2.5, 0.2], [1.5, 2.9, -1.5]],
        ),
        case(
            "coplanar sheets, twice, and stacked grids",
            Parts::default()
                .grid(6, 3.0, 0.0)
                .grid(6, 3.0, 0.0)
                .grid(3, 1.0, 0.75)
                .grid(4, 0.5, 1.5)
                .floor(2.0, 0.0),
            EYE,
            &[LIGHT, [0.0, 4.0, 0.0]],
        ),
        case(
            "a thousand copies of one box",
            (0..100)
                .fold(Parts::default().floor(3.0, 0.0), |p, _| p.cuboid([-0.5, 0.25, -0.5], [0.5, 0.5, 0.5])),
            EYE,
            &[LIGHT],
        ),
        case(
            "needles and slivers",
            Parts::default().floor(3.0, 0.0).mesh(
                vec![
                    Vec3::new(-2.0, 1.0, 0.0),
                    Vec3::new(2.0, 1.0, 1e-7),
                    Vec3::new(2.0, 1.0, -1e-7),
                    Vec3::new(0.0, 0.3, 2.0),
                    Vec3::new(0.0, 1.7, 2.0),
                ],
                vec![[0, 1, 2], [0, 2, 3], [1, 3, 4], [2, 4, 3]],
            ),
            EYE,
            &[LIGHT],
        ),
        placed("far from the origin", boxes(), EYE, &[LIGHT], |p| {
            p + Vec3::new(148_376.0, 1234.0, -223_423.0)
        }),
        placed("tiny and far away", boxes(), EYE, &[LIGHT], |p| p * 1e-3 + Vec3::splat(1e3)),
        placed("2^40 times as large", boxes(), EYE, &[LIGHT], |p| p * up),
        placed("2^40 times as small", boxes(), EYE, &[LIGHT], |p| p / up),
    ];
    cases.push(file("blocks.obj"));
    cases.extend(under_other_lights());
    cases.extend(with_holes());
    cases.extend(of_solids());
    cases
}

/// Sheets with holes over a floor: texels whose borders run through corners and along edges of the triangles,
/// and images that go on beyond their sides.
fn with_holes() -> Vec<Case> {
    let lights = [lamp(Vec3::from(LIGHT)), lamp(Vec3::new(0.5, 3.0, 0.5)), sun(Vec3::new(-0.5, 1.0, 0.25))];
    let masked = |wrap: Wrap, texture: &dyn Fn(Vec3) -> [f32; 2]| {
        let mut builder = SceneBuilder::new("holes");
        let floor = Parts::default().floor(4.0, 0.0).0.remove(0);
        builder.add_object(ObjectInput::new("floor", floor.0, floor.1)).unwrap();
        let mask = builder.add_alpha_mask(AlphaMask::new(4, 3, [wrap; 2], |x, y| (x + y) % 2 == 0));
        let coverage = Coverage::Masked(mask);
        let material = builder.add_material(Material { coverage, ..Material::default() });
        let sheet = |height: f32| Parts::default().grid(3, 1.5, height).0.remove(0);
        for (positions, triangles, _) in [sheet(1.0), sheet(1.5)] {
            let coordinates = positions.iter().map(|&p| texture(p)).collect();
            let texture_coordinates = Some(TextureCoordinates { coordinates, corners: triangles.clone() });
            let input = ObjectInput::new("leaf", positions, triangles);
            builder.add_object(ObjectInput { material, texture_coordinates, ..input }).unwrap();
        }
        builder.finish()
    };
    let once: &dyn Fn(Vec3) -> [f32; 2] = &|p| [p.x / 3.0 + 0.5, p.z / 3.0 + 0.5];
    let many: &dyn Fn(Vec3) -> [f32; 2] = &|p| [p.x * 2.0 - p.z, p.z + 0.25 * p.x - p.y];
    [
        ("holes of an image once", Wrap::ClampToEdge, once),
        ("holes of a repeated image", Wrap::Repeat, many),
        ("holes of a mirrored image", Wrap::MirroredRepeat, many),
    ]
    .into_iter()
    .map(|(name, wrap, texture)| Case {
        scene: masked(wrap, texture),
        lights: lights.to_vec(),
        ..case(name, Parts::default(), EYE, &[])
    })
    .collect()
}

/// The same shapes under lights that are infinitely far away, or that shine into a cone.
fn under_other_lights() -> Vec<Case> {
    let towards = |x: f32, y: f32, z: f32| sun(Vec3::new(x, y, z));
    let tiny = f32::from_bits(1);
    let suns = [
        towards(-0.5, 1.0, 0.375),
        towards(0.0, 3.0, 0.0),
        towards(1.0, 1.0, 0.0),
        towards(1.0, 1.0, -1.0),
        towards(tiny, 1.0, -tiny),
        towards(-1e-30, 1e-30, 3e-31),
        towards(2e38, 1e38, 0.0),
        towards(0.3, 1e-3, 0.2),
    ];
    let lit_by = |lights: &[Light], case: Case| Case { lights: lights.to_vec(), ..case };
    let spot = |position: [f32; 3], axis: [f32; 3], cos_outer: f32| {
        let point = PointLight {
            position: Vec3::from(position),
            intensity: [1.0; 3],
            falloff: Falloff::InverseSquare,
        };
        let cone = Cone { axis: Vec3::from(axis), cos_inner: 1.0, cos_outer };
        Light { name: "spot".into(), emitter: Emitter::Spot(SpotLight { point, cone }) }
    };
    let up = 2f32.powi(40);
    let place = |p: Vec3| p + Vec3::new(148_376.0, 1234.0, -223_423.0);
    vec![
        lit_by(&suns, case("boxes under suns", boxes(), EYE, &[])),
        lit_by(&suns, placed("far from the origin under suns", boxes(), EYE, &[], place)),
        lit_by(&suns, placed("small under suns", boxes(), EYE, &[], |p| p / up)),
        lit_by(
            &suns[..4],
            case(
                "stacked grids under suns",
                Parts::default().grid(6, 3.0, 0.0).grid(3, 1.0, 0.75).grid(4, 0.5, 1.5),
                EYE,
                &[],
            ),
        ),
        lit_by(
            &[spot(LIGHT, [2.0, -4.0, -1.5], 0.9), spot([0.0, 3.0, 0.0], [0.0, -1.0, 0.0], 0.5)],
            case("boxes under spots", boxes(), EYE, &[]),
        ),
    ]
}

/// Solids that are left out in part, and objects that take half a part in shadows.
fn of_solids() -> Vec<Case> {
    const BLOCKS_ONLY: Shadowing = Shadowing { casts: true, receives: false };
    const RECEIVES_ONLY: Shadowing = Shadowing { casts: false, receives: true };
    let ring = || Parts::default().floor(4.0, 0.0).torus([0.0, 1.0, 0.0], [1.25, 0.5]);
    let with_suns = |mut case: Case| {
        case.lights.extend([sun(Vec3::new(-0.5, 1.0, 0.375)), sun(Vec3::new(0.0, 1.0, 0.0))]);
        case
    };
    vec![
        with_suns(case(
            "a ring through a box, with lights in the hole, on the ring and inside it",
            ring().cuboid([0.75, 0.5, -0.25], [2.0, 1.5, 0.25]),
            EYE,
            &[
                LIGHT,
                [0.0, 1.0, 0.0],
                [0.0, 2.0, 0.0],
                [-1.75, 1.0, 0.0],
                [-1.25, 1.0, 0.125],
                [1.0, 1.0, 0.0],
            ],
        )),
        with_suns(case(
            CROWDED,
            Parts::default()
                .grid(5, 4.0, 0.0)
                .torus([0.0, 1.0, 0.0], [1.25, 0.5])
                .torus([0.75, 1.25, 0.0], [1.0, 0.25])
                .grid(3, 0.75, 1.125)
                .torus([0.0, 2.0, 0.5], [0.75, 0.375])
                .cuboid([-0.25, 0.5, -0.25], [0.25, 2.5, 0.25]),
            EYE,
            &[LIGHT, [0.0, 4.0, 0.0], [0.0, 1.0, 0.5]],
        )),
        with_suns(case(
            "an eye inside a box",
            Parts::default()
                .cuboid([-3.0, -1.0, -3.0], [3.0, 3.0, 5.0])
                .cuboid([-0.5, -0.5, -0.5], [0.5, 1.0, 0.5])
                .torus([0.0, 1.5, 0.0], [1.0, 0.25]),
            EYE,
            &[LIGHT, [-2.0, 2.5, 1.5], [0.0, 7.0, 0.0], [3.0, 1.0, 0.0], [0.25, 0.5, 0.0]],
        )),
        with_suns(case(
            "a floor that casts nothing under one polygon, and a lid that receives nothing",
            Parts::default()
                .floor(4.0, 0.0)
                .shadowing(RECEIVES_ONLY)
                .mesh(
                    vec![Vec3::new(-2.0, 1.0, -1.0), Vec3::new(0.5, 1.25, 1.5), Vec3::new(1.5, 1.0, -1.0)],
                    vec![[0, 1, 2]],
                )
                .floor(0.5, 2.0)
                .shadowing(BLOCKS_ONLY),
            EYE,
            &[LIGHT, [0.0, 4.0, 0.0], [0.0, 1.5, 0.0]],
        )),
        with_suns(case(
            "solids that cast nothing beside solids that receive nothing",
            Parts::default()
                .floor(4.0, 0.0)
                .shadowing(RECEIVES_ONLY)
                .cuboid([-1.0, 0.0, -1.0], [0.0, 1.0, 0.0])
                .shadowing(RECEIVES_ONLY)
                .torus([0.0, 1.5, 0.0], [1.0, 0.25])
                .shadowing(BLOCKS_ONLY)
                .cuboid([0.5, 0.0, -0.5], [1.5, 0.5, 0.5]),
            EYE,
            &[LIGHT, [0.0, 4.0, 0.0], [-0.5, 0.5, -0.5], [1.0, 0.25, 0.0]],
        )),
        with_suns(case(
            "boxes with a face in common, and one in the other turned inside out",
            Parts::default()
                .floor(4.0, 0.0)
                .cuboid([0.0, 0.0, -1.0], [1.0, 1.0, 0.0])
                .cuboid([-1.0, 0.0, -1.0], [0.0, 1.0, 0.0])
                .cuboid([-1.0, 1.0, -1.0], [0.0, 2.0, 0.0])
                // Its corners in descending order: normals point inwards.
                .cuboid([-0.25, 0.75, -0.25], [-0.75, 0.25, -0.75]),
            EYE,
            &[LIGHT, [3.0, 2.0, -0.5], [-0.5, 0.5, -0.5], [-0.1, 0.5, -0.1], [0.5, 0.5, -0.5]],
        )),
    ]
}

/// A demo scene, small.
fn file(name: &str) -> Case {
    let mut scene = formats::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)).unwrap();
    frame(&mut scene, Framing::WithFloor).unwrap();
    let camera = scene.cameras[0].clone();
    let lights = scene.lights.clone();
    Case { name: name.into(), scene, camera, size: SIZE, lights }
}

/// A scene of objects whose triangles share no vertices by index.
pub fn soup(name: &str, objects: impl Iterator<Item = (Vec<[Vec3; 3]>, Shadowing)>) -> Scene {
    let mut builder = SceneBuilder::new(name);
    for (triangles, shadowing) in objects {
        let positions = triangles.iter().flatten().copied().collect();
        let triangles = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mut input = ObjectInput::new("part", positions, triangles);
        input.shadowing = shadowing;
        builder.add_object(input).unwrap();
    }
    builder.finish()
}

/// The same case with its objects, triangles and corners in another order.
pub fn turned(case: &Case) -> Case {
    let scene = &case.scene;
    let mut builder = SceneBuilder::new(&case.name);
    scene.alpha_masks.iter().for_each(|mask| _ = builder.add_alpha_mask(mask.clone()));
    scene.materials[1..].iter().for_each(|material| _ = builder.add_material(material.clone()));
    for object in scene.objects.iter().rev() {
        let triangles: Vec<u32> = (object.first..object.first + object.count).rev().collect();
        let turn = |[a, b, c]: [Vec3; 3]| [b, c, a];
        let positions = triangles.iter().flat_map(|&t| turn(scene.corners(t))).collect();
        let corners: Vec<_> = (0..object.count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let texture_coordinates = object.texture_coordinates.as_ref().map(|_| {
            let coordinates = triangles.iter().flat_map(|&t| {
                let [a, b, c] = scene.masked(t).expect("a masked object").coordinates;
                [b, c, a]
            });
            TextureCoordinates { coordinates: coordinates.collect(), corners: corners.clone() }
        });
        let input = ObjectInput::new(&object.name, positions, corners);
        let material = object.material;
        let shadowing = object.shadowing;
        builder.add_object(ObjectInput { material, shadowing, texture_coordinates, ..input }).unwrap();
    }
    Case {
        name: case.name.clone(),
        scene: builder.finish(),
        camera: case.camera.clone(),
        size: case.size,
        lights: case.lights.clone(),
    }
}

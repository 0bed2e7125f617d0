//! What the scenes of the cases are put together from.

use crate::geometry::curved::{RayStart, Shape};
use crate::scene::{Material, ObjectInput, Scene, SceneBuilder, Transmission};
use crate::visibility::SurfacePoint;
use crate::visibility::hierarchy::{Hierarchy, Ray};
use glam::{DVec3, Vec3};

/// A triangle.
pub type Corners = [Vec3; 3];

/// The smallest number above zero.
pub const TINY: f32 = f32::from_bits(1);

/// A vector, in few letters.
pub const fn v(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}

/// A scene of triangles that share no vertices by index, an object a list.
pub fn soup(objects: &[Vec<Corners>]) -> Scene {
    let mut builder = SceneBuilder::new("hard case");
    objects.iter().for_each(|triangles| add(&mut builder, 0, triangles));
    builder.finish()
}

/// A scene of one object of triangles.
pub fn triangles(triangles: &[Corners]) -> Scene {
    soup(&[triangles.to_vec()])
}

/// A scene of triangles and curved surfaces.
pub fn with_curved(flat: &[Corners], curved: &[Shape]) -> Scene {
    let mut builder = SceneBuilder::new("hard case");
    add(&mut builder, 0, flat);
    let input = ObjectInput { curved: curved.to_vec(), ..ObjectInput::new("curved", Vec::new(), Vec::new()) };
    builder.add_object(input).expect("no index");
    builder.finish()
}

/// A scene of layers that let a share of the light pass, each an object, and of opaque triangles.
pub fn with_glass(layers: &[Vec<Corners>], transmittance: f32, opaque: &[Corners]) -> Scene {
    let mut builder = SceneBuilder::new("hard case");
    let transmission = Transmission { transmittance: [transmittance; 3], refractive_index: 1.0 };
    let glass = Material { name: "glass".into(), transmission: Some(transmission), ..Material::default() };
    let glass = builder.add_material(glass);
    layers.iter().for_each(|layer| add(&mut builder, glass, layer));
    add(&mut builder, 0, opaque);
    builder.finish()
}

fn add(builder: &mut SceneBuilder, material: u32, triangles: &[Corners]) {
    let corners = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let input = ObjectInput::new("part", triangles.iter().flatten().copied().collect(), corners);
    builder.add_object(ObjectInput { material, ..input }).expect("indices in range");
}

/// A square across the y axis, of two triangles.
pub fn square(half: f32, y: f32) -> Vec<Corners> {
    let [a, b, c, d] = [(-half, -half), (-half, half), (half, half), (half, -half)].map(|(x, z)| v(x, y, z));
    vec![[a, b, c], [a, c, d]]
}

/// One triangle across the y axis that holds the square of half this size around the axis.
pub fn lid(half: f32, y: f32) -> Vec<Corners> {
    vec![[v(-3.0 * half, y, -half), v(3.0 * half, y, -half), v(0.0, y, 2.0 * half)]]
}

/// A box along the axes, its triangles counter-clockwise from outside.
pub fn cuboid(low: Vec3, high: Vec3) -> Vec<Corners> {
    let corner = |i: usize| {
        let side = |axis: usize| if i >> axis & 1 == 1 { high[axis] } else { low[axis] };
        v(side(0), side(1), side(2))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let split = |face: [usize; 4]| {
        let [a, b, c, d] = face.map(corner);
        [[a, b, c], [a, c, d]]
    };
    faces.into_iter().flat_map(split).collect()
}

/// A square of n x n cells in the plane y = 0, diagonals alternating, with corners moved as said.
pub fn grid(n: i32, place: impl Fn(i32, i32) -> Vec3) -> Vec<Corners> {
    let cell = |(x, z): (i32, i32)| {
        let [a, b, c, d] = [place(x, z), place(x + 1, z), place(x, z + 1), place(x + 1, z + 1)];
        if (x + z) % 2 == 0 { [[a, b, d], [a, d, c]] } else { [[a, b, c], [b, d, c]] }
    };
    (0..n).flat_map(|x| (0..n).map(move |z| (x, z))).flat_map(cell).collect()
}

/// A closed sphere of triangles, `2 n` around and `n` from pole to pole.
pub fn ball(centre: DVec3, radius: f64, n: u32) -> Vec<Corners> {
    let corner = |i: u32, j: u32| {
        if i == 0 || i == n {
            let up = if i == 0 { radius } else { -radius };
            return (centre + DVec3::Y * up).as_vec3();
        }
        let step = std::f64::consts::PI / f64::from(n);
        let (down, around) = (step * f64::from(i), step * f64::from(j % (2 * n)));
        let (ring, height) = (libm::sin(down), libm::cos(down));
        let direction = DVec3::new(ring * libm::cos(around), height, ring * libm::sin(around));
        (centre + radius * direction).as_vec3()
    };
    let mut triangles = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..2 * n).map(move |j| (i, j))) {
        let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j), corner(i + 1, j + 1)];
        // At the poles one of the two has no area.
        triangles.extend((i > 0).then_some([a, b, d]));
        triangles.extend((i + 1 < n).then_some([a, d, c]));
    }
    triangles
}

/// A box on a floor beside a ball of triangles: what invariance is tried on.
pub fn still_life() -> Vec<Vec<Corners>> {
    vec![
        square(4.0, 0.0),
        cuboid(v(-1.0, 0.0, -1.0), v(0.0, 1.0, 0.0)),
        cuboid(v(0.5, 0.25, -0.5), v(1.5, 0.5, 0.5)),
        ball(DVec3::new(-0.5, 1.5, 0.75), 0.5, 6),
    ]
}

/// Points of a caster's shadow, of its border and around it on the floor of [`still_life`].
pub fn still_points() -> Vec<Vec3> {
    steps(-15, 15).flat_map(|x| steps(-15, 15).map(move |z| v(x * 0.25, 0.0, z * 0.25))).collect()
}

/// Where the light of [`still_life`] is.
pub const STILL_LIGHT: Vec3 = v(-2.0, 4.0, 1.5);

/// Whole numbers as floats, both ends included.
pub fn steps(from: i32, to: i32) -> impl Iterator<Item = f32> + Clone {
    (from..=to).map(|i| i as f32)
}

/// Points on no surface.
pub fn bare(points: impl IntoIterator<Item = Vec3>) -> Vec<SurfacePoint> {
    points.into_iter().filter_map(SurfacePoint::bare).collect()
}

/// What an eye sees of a scene when it looks at these places.
pub fn seen(scene: &Scene, eye: Vec3, targets: impl IntoIterator<Item = Vec3>) -> Vec<SurfacePoint> {
    rays(scene, targets.into_iter().map(|target| (eye, target - eye)))
}

/// What rays see of a scene, each an origin and a direction.
pub fn rays(scene: &Scene, rays: impl IntoIterator<Item = (Vec3, Vec3)>) -> Vec<SurfacePoint> {
    let hierarchy = Hierarchy::new(scene);
    let hit = |(origin, direction): (Vec3, Vec3)| {
        let hit = hierarchy.first_hit(&Ray { origin, direction, start: RayStart::origin() })?;
        Some(SurfacePoint::on_ray(scene, origin, direction, hit.primitive))
    };
    rays.into_iter().filter(|(_, direction)| *direction != Vec3::ZERO).filter_map(hit).collect()
}

/// A point, and that with each coordinate one step up, one down, or as it is: 27 in all.
pub fn neighbours(point: Vec3) -> impl Iterator<Item = Vec3> {
    let around = |x: f32| [x.next_down(), x, x.next_up()];
    let [xs, ys, zs] = point.to_array().map(around);
    xs.into_iter().flat_map(move |x| ys.into_iter().flat_map(move |y| zs.map(|z| v(x, y, z))))
}

/// The point as far behind `through` as the light is before it. Exact where those are small whole multiples of
/// one power of two.
pub fn behind(through: Vec3, light: Vec3) -> Vec3 {
    2.0 * through - light
}

/// Both triangles of each: as it is, and the other way round.
pub fn both_sides(triangles: &[Corners]) -> Vec<Corners> {
    triangles.iter().flat_map(|&[a, b, c]| [[a, b, c], [a, c, b]]).collect()
}

/// All the other way round.
pub fn inverted(triangles: &[Corners]) -> Vec<Corners> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

/// All moved.
pub fn moved(triangles: &[Corners], place: impl Fn(Vec3) -> Vec3) -> Vec<Corners> {
    triangles.iter().map(|corners| corners.map(&place)).collect()
}

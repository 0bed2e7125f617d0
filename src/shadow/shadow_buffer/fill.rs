//! Filling: the first hit of the ray through the centre of every cell, object by object, as a camera's t-buffer
//! is filled (section III E of the 2004 paper).
//!
//! A ray's origin is the light's f32 position, and its direction that of the cell's centre rounded to f32; both
//! are taken as given. What it hits first, holes and equal distances among it, is decided by the routines that
//! decide what a camera sees, so that no order of objects shows. Only opaque objects that cast are in the buffer.

use super::footprint::Footprint;
use super::sphere::{Cell, Sphere};
use crate::float_environment::InStandardFloats;
use crate::geometry::curved::RayStart;
use crate::geometry::ray_triangle::RayTriangle;
use crate::scene::{Object, Primitive, PrimitiveIndex, Scene};
use crate::visibility::{Hit, SurfacePoint, is_there, keep_nearer};
use glam::Vec3;
use rayon::prelude::*;

/// Rows that one task fills.
const BAND_ROWS: usize = 8;

/// Primitives that are prepared at a time.
const CHUNK: usize = 1 << 14;

/// Bytes of a cell while the buffer is filled, beside those that it keeps.
pub(super) const CELL_BYTES: u64 = size_of::<Option<Hit>>() as u64;

/// The object number of a cell whose ray hits nothing.
pub(super) const NOTHING: u32 = u32::MAX;

/// What every cell's centre ray hits first, before anything is dropped.
pub(super) struct Filled {
    hits: Vec<Option<Hit>>,
    /// Rays that were tested against a primitive, once for each.
    pub tests: u64,
}

struct Cast {
    primitive: PrimitiveIndex,
    /// `None` for a curved surface.
    triangle: Option<RayTriangle>,
    footprint: Footprint,
}

impl Cast {
    /// `None` if no ray can hit the primitive.
    fn new(scene: &Scene, sphere: &Sphere, light: Vec3, primitive: PrimitiveIndex) -> Option<Cast> {
        match scene.primitive(primitive) {
            Primitive::Triangle(corners) => {
                let triangle = RayTriangle::new(light, corners)?;
                let footprint = Footprint::of_triangle(sphere, triangle.planes())?;
                Some(Cast { primitive, triangle: Some(triangle), footprint })
            }
            Primitive::Curved(shape) => {
                let footprint = Footprint::of_shape(sphere, light, shape)?;
                Some(Cast { primitive, triangle: None, footprint })
            }
        }
    }

    fn hit(&self, scene: &Scene, light: Vec3, direction: Vec3) -> Option<Hit> {
        match &self.triangle {
            Some(triangle) => triangle
                .hit(direction)
                .filter(|_| is_there(scene, self.primitive, triangle, direction))
                .map(|t| Hit::flat(self.primitive, t)),
            None => Hit::curved(scene, self.primitive, light, direction, &RayStart::origin()),
        }
    }
}

/// Casts everything opaque that casts shadows.
pub(super) fn fill(scene: &Scene, sphere: &Sphere, light: Vec3) -> Filled {
    let azimuths = sphere.azimuths();
    let columns = sphere.columns() as usize;
    let mut hits: Vec<Option<Hit>> = vec![None; sphere.cells() as usize];
    let mut tests = 0;
    for primitives in scene.objects.iter().flat_map(|object| chunks(scene, object)) {
        let casts: Vec<Cast> = primitives
            .into_par_iter()
            .in_standard_floats()
            .filter_map(|p| Cast::new(scene, sphere, light, p))
            .collect();
        let fill_band = |(band, hits): (usize, &mut [Option<Hit>])| {
            let first_row = (band * BAND_ROWS) as u32;
            let mut tests = 0;
            for cast in &casts {
                let [first, last] = cast.footprint.rows();
                let rows = first.max(first_row)..(last + 1).min(first_row + (hits.len() / columns) as u32);
                for row in rows {
                    let line = &mut hits[(row - first_row) as usize * columns..][..columns];
                    let circle = sphere.row_centres(row);
                    for &[left, right] in cast.footprint.spans(sphere, row).iter() {
                        tests += u64::from(right - left + 1);
                        for column in left as usize..=right as usize {
                            let (cosine, sine) = azimuths[column];
                            let direction = circle.at(cosine, sine);
                            if let Some(hit) = cast.hit(scene, light, direction) {
                                keep_nearer(&mut line[column], hit, scene, light, direction);
                            }
                        }
                    }
                }
            }
            tests
        };
        tests += hits
            .par_chunks_mut(BAND_ROWS * columns)
            .enumerate()
            .map(fill_band)
            .in_standard_floats()
            .sum::<u64>();
    }
    Filled { hits, tests }
}

/// The opaque primitives of an object that casts, in portions.
fn chunks(scene: &Scene, object: &Object) -> impl Iterator<Item = std::ops::Range<PrimitiveIndex>> + use<> {
    let is_opaque = scene.materials[object.material as usize].transmission.is_none();
    let casts = object.shadowing.casts && is_opaque;
    let first_curved = scene.triangles.len() as u32 + object.first_curved;
    let flat = object.first..object.first + object.count;
    let curved = first_curved..first_curved + object.curved_count;
    [flat, curved].into_iter().filter(move |_| casts).flat_map(|range| {
        let end = range.end;
        range.step_by(CHUNK).map(move |start| start..end.min(start + CHUNK as u32))
    })
}

impl Filled {
    /// Cells whose ray hits something.
    pub fn hit_cells(&self) -> u64 {
        self.hits.iter().flatten().count() as u64
    }

    /// The object that each cell's ray hits first, or [`NOTHING`].
    pub fn objects(&self, scene: &Scene) -> Vec<u32> {
        let object = |hit: &Option<Hit>| hit.map_or(NOTHING, |hit| scene.object_index(hit.primitive));
        self.hits.par_iter().map(object).collect()
    }

    /// The distance from the light to where each cell's ray hits first, infinite where that is nowhere.
    pub fn distances(&self, scene: &Scene, sphere: &Sphere, light: Vec3) -> Vec<f32> {
        let distance = |(index, hit): (usize, &Option<Hit>)| {
            let Some(hit) = hit else { return f32::INFINITY };
            let columns = sphere.columns() as usize;
            let cell = Cell { row: (index / columns) as u32, column: (index % columns) as u32 };
            let direction = sphere.centre(cell);
            let t = hit.parameter;
            // Where only exact arithmetic decided, the place is known from the point.
            let distance = match t.error <= t.value * 1e-9 {
                true => t.value * direction.as_dvec3().length(),
                false => {
                    let point = SurfacePoint::on_ray(scene, light, direction, hit.primitive);
                    point.position.distance(light.as_dvec3())
                }
            };
            distance as f32
        };
        self.hits.par_iter().enumerate().map(distance).in_standard_floats().collect()
    }

    /// The primitive that each cell's ray hits first.
    #[cfg(test)]
    pub fn primitives(&self) -> Vec<Option<PrimitiveIndex>> {
        self.hits.iter().map(|hit| hit.map(|hit| hit.primitive)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::Shape;
    use crate::geometry::curved::tests as shapes;
    use crate::scene::{ObjectInput, SceneBuilder, Shadowing};
    use crate::visibility::hierarchy::{Hierarchy, Ray};
    use proptest::prelude::*;

    fn scene(triangles: &[[Vec3; 3]], shapes: &[Shape]) -> Scene {
        let mut builder = SceneBuilder::new("test");
        for triangle in triangles {
            builder.add_object(ObjectInput::new("t", triangle.to_vec(), vec![[0, 1, 2]])).unwrap();
        }
        for &shape in shapes {
            let input = ObjectInput { curved: vec![shape], ..ObjectInput::new("s", vec![], vec![]) };
            builder.add_object(input).unwrap();
        }
        builder.finish()
    }

    fn cells(sphere: &Sphere) -> impl Iterator<Item = Cell> {
        let columns = sphere.columns();
        (0..sphere.rows()).flat_map(move |row| (0..columns).map(move |column| Cell { row, column }))
    }

    /// Every cell's centre ray through the hierarchy of boxes.
    fn traced(scene: &Scene, sphere: &Sphere, light: Vec3) -> Vec<Option<PrimitiveIndex>> {
        let hierarchy = Hierarchy::new(scene);
        let ray = |cell| Ray { origin: light, direction: sphere.centre(cell), start: RayStart::origin() };
        cells(sphere).map(|cell| hierarchy.first_hit(&ray(cell)).map(|hit| hit.primitive)).collect()
    }

    /// Every cell's centre ray against every primitive, classically.
    fn classical(scene: &Scene, sphere: &Sphere, light: Vec3) -> Vec<Option<PrimitiveIndex>> {
        let first = |cell| {
            let direction = sphere.centre(cell);
            let mut nearest = None;
            for primitive in 0..scene.primitive_count() {
                let hit = match scene.primitive(primitive) {
                    Primitive::Triangle(corners) => RayTriangle::new(light, corners)
                        .and_then(|triangle| triangle.hit(direction))
                        .map(|t| Hit::flat(primitive, t)),
                    Primitive::Curved(_) => {
                        Hit::curved(scene, primitive, light, direction, &RayStart::origin())
                    }
                };
                if let Some(hit) = hit {
                    keep_nearer(&mut nearest, hit, scene, light, direction);
                }
            }
            nearest.map(|hit: Hit| hit.primitive)
        };
        cells(sphere).map(first).collect()
    }

    fn coordinate() -> impl Strategy<Value = f32> {
        prop_oneof![(-4i32..5).prop_map(|x| x as f32 * 0.5), -3.0f32..3.0]
    }

    fn point() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(coordinate()).prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn every_cell_has_what_its_ray_hits_first(
            triangles in prop::collection::vec(prop::array::uniform3(point()), 0..8),
            mut shapes in prop::collection::vec(shapes::shape(), 0..5),
            light in point(),
            rows in 1u32..24, columns in 1u32..48,
        ) {
            let sphere = Sphere::new(rows, columns).unwrap();
            let forward = scene(&triangles, &shapes);
            let filled = fill(&forward, &sphere, light);
            prop_assert_eq!(&filled.primitives(), &traced(&forward, &sphere, light));
            prop_assert_eq!(&filled.primitives(), &classical(&forward, &sphere, light));
            let all = u64::from(forward.primitive_count()) * sphere.cells();
            prop_assert!(filled.tests <= all);
            shapes.reverse();
            let reversed: Vec<_> = triangles.iter().rev().copied().collect();
            let backward = scene(&reversed, &shapes);
            let again = fill(&backward, &sphere, light);
            for (one, other) in filled.primitives().iter().zip(again.primitives()) {
                prop_assert_eq!(one.map(|p| forward.primitive(p)), other.map(|p| backward.primitive(p)));
            }
            // Distances are those of the points.
            let distances = filled.distances(&forward, &sphere, light);
            for ((cell, primitive), distance) in cells(&sphere).zip(filled.primitives()).zip(distances) {
                let Some(primitive) = primitive else {
                    prop_assert_eq!(distance, f32::INFINITY);
                    continue;
                };
                let point = SurfacePoint::on_ray(&forward, light, sphere.centre(cell), primitive).position;
                prop_assert!((point.distance(light.as_dvec3()) - f64::from(distance)).abs() <= 1e-6 * f64::from(distance));
            }
        }
    }

    #[test]
    fn threads_and_bands_change_nothing() {
        let triangles: Vec<[Vec3; 3]> = (0..40)
            .map(|i| {
                let at = |k: i32| {
                    Vec3::new(
                        (i * 7 + k) as f32 % 5.0 - 2.0,
                        (i + 3 * k) as f32 % 3.0 - 1.0,
                        1.5 - (k * i % 4) as f32,
                    )
                };
                [at(0), at(1), at(2)]
            })
            .collect();
        let scene = scene(&triangles, &[Shape::sphere(Vec3::new(1.0, 2.0, 3.0), 0.5)]);
        let sphere = Sphere::new(37, 61).unwrap();
        let light = Vec3::new(0.1, 0.2, 0.3);
        let fills = [1, 2, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let filled = fill(&scene, &sphere, light);
                let bits: Vec<_> =
                    filled.distances(&scene, &sphere, light).iter().map(|d| d.to_bits()).collect();
                (filled.objects(&scene), bits, filled.tests)
            })
        });
        assert_eq!(fills[0], fills[1]);
        assert_eq!(fills[0], fills[2]);
        assert!(fills[0].0.iter().any(|&object| object != NOTHING));
    }

    #[test]
    fn only_what_casts_is_there() {
        let triangle = vec![Vec3::new(2.0, -1.0, -1.0), Vec3::new(2.0, 1.0, -1.0), Vec3::new(2.0, 0.0, 1.0)];
        let mut builder = SceneBuilder::new("test");
        let near = ObjectInput {
            shadowing: Shadowing { casts: false, receives: true },
            ..ObjectInput::new("near", triangle.iter().map(|&p| p * 0.5).collect(), vec![[0, 1, 2]])
        };
        builder.add_object(near).unwrap();
        builder.add_object(ObjectInput::new("far", triangle, vec![[0, 1, 2]])).unwrap();
        let scene = builder.finish();
        let sphere = Sphere::new(20, 40).unwrap();
        let objects = fill(&scene, &sphere, Vec3::ZERO).objects(&scene);
        assert!(objects.contains(&1) && objects.contains(&NOTHING) && !objects.contains(&0));
    }
}

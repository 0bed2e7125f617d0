//! The t-buffer (Raghuvanshi and Dhande 2004, section II): first hits object by object, with only the
//! rays that an object's projection can cover.
//!
//! Vertices are projected once ([`places`]). The box around a triangle says which rays it may be hit by ([`bins`]);
//! those triangles that are behind everything there are done with ([`band`]). The others become linear functions of the
//! picture ([`cast`]), sixteen pixels at a time. Their bounds hold for all places that a pixel's rounded ray can pass, so
//! that the paper's "bound to hit" is true of all but the rays within that rounding of an edge, and what is nearer is
//! known of all but those where two surfaces are within it of each other. These few get exact signs and the exact order.

mod band;
mod bins;
mod cast;
mod curved_cast;
mod draw;
mod places;
mod portion;
mod view;

use super::classical;
use super::hit::FirstHits;
use crate::float_environment::{InStandardFloats, StandardFloats};
use crate::geometry::batch::InstructionSet;
use crate::scene::{Camera, ImageSize, Scene};
use band::Band;
use portion::Portion;
use rayon::prelude::*;
use view::{BAND_ROWS, View};

/// First hits by filling a t-buffer.
pub fn first_hits(scene: &Scene, camera: &Camera, size: ImageSize) -> FirstHits {
    first_hits_on(InstructionSet::best(), scene, camera, size)
}

/// The same, on an instruction set that this machine has.
pub fn first_hits_on(set: InstructionSet, scene: &Scene, camera: &Camera, size: ImageSize) -> FirstHits {
    let _floats = StandardFloats::new();
    let Some(view) = View::new(scene, camera, size) else {
        return classical::first_hits(scene, camera, size);
    };
    let places = places::places(set, &view);
    let mut portions = Portion::all(set, &view, &places);
    let mut primitives = vec![None; size.pixels()];
    let hits = primitives.par_chunks_mut(BAND_ROWS * size.width as usize).enumerate().in_standard_floats();
    let (first, second) = (portions.next(), portions.next());
    let tests = match (first, second) {
        (None, _) => 0,
        // Band after band in the same place of the cache.
        (Some(only), None) => hits
            .map_init(
                || (Band::new(&view, 0), Vec::new()),
                |(band, sorted), (number, hits)| {
                    band.begin(&view, number);
                    only.draw(set, &view, band, sorted);
                    band.write(hits);
                    band.tests
                },
            )
            .sum(),
        (Some(first), Some(second)) => {
            let number = (size.height as usize).div_ceil(BAND_ROWS);
            let mut bands: Vec<Band> = (0..number).map(|number| Band::new(&view, number)).collect();
            for portion in [first, second].into_iter().chain(portions) {
                let bands = bands.par_iter_mut().in_standard_floats();
                bands.for_each_init(Vec::new, |sorted, band| portion.draw(set, &view, band, sorted));
            }
            hits.for_each(|(number, hits)| bands[number].write(hits));
            bands.iter().map(|band| band.tests).sum()
        }
    };
    FirstHits { size, primitives, tests }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::Shape;
    use crate::geometry::curved::tests as shapes;
    use crate::scene::{ObjectInput, SceneBuilder};
    use glam::Vec3;
    use proptest::prelude::*;

    fn scene(triangles: &[[Vec3; 3]]) -> Scene {
        scene_with(triangles, &[])
    }

    fn scene_with(triangles: &[[Vec3; 3]], shapes: &[Shape]) -> Scene {
        let mut builder = SceneBuilder::new("test");
        for triangle in triangles {
            let input = ObjectInput::new("t", triangle.to_vec(), vec![[0, 1, 2]]);
            builder.add_object(input).unwrap();
        }
        for &shape in shapes {
            let input = ObjectInput { curved: vec![shape], ..ObjectInput::new("s", vec![], vec![]) };
            builder.add_object(input).unwrap();
        }
        builder.finish()
    }

    /// Coordinates on a small grid make shared edges, coplanar faces and triangles behind, beside and
    /// around the camera.
    fn triangle() -> impl Strategy<Value = [Vec3; 3]> {
        let coordinate = || prop_oneof![(-4i32..5).prop_map(|x| x as f32 * 0.5), -3.0f32..3.0];
        prop::array::uniform3(prop::array::uniform3(coordinate()).prop_map(Vec3::from))
    }

    proptest! {
        #[test]
        fn curved_surfaces_are_seen_as_by_classical_ray_tracing(
            triangles in prop::collection::vec(triangle(), 0..3),
            mut shapes in prop::collection::vec(shapes::shape(), 1..6),
            eye in prop::array::uniform3(-3.0f32..3.0),
        ) {
            let camera = Camera::look_at("c", Vec3::from(eye), Vec3::ZERO, Vec3::Y, 70.0);
            let size = ImageSize { width: 37, height: 23 };
            let forward = scene_with(&triangles, &shapes);
            let filled = first_hits(&forward, &camera, size);
            let traced = classical::first_hits(&forward, &camera, size);
            prop_assert_eq!(&filled.primitives, &traced.primitives);
            shapes.reverse();
            let backward = scene_with(&triangles, &shapes);
            let reversed = first_hits(&backward, &camera, size);
            for (one, other) in filled.primitives.iter().zip(&reversed.primitives) {
                prop_assert_eq!(one.map(|p| forward.primitive(p)), other.map(|p| backward.primitive(p)));
            }
        }

        #[test]
        fn equals_classical_ray_tracing_in_any_object_order(
            triangles in prop::collection::vec(triangle(), 1..12),
            eye in prop::array::uniform3(-3.0f32..3.0),
        ) {
            let camera = Camera::look_at("c", Vec3::from(eye), Vec3::ZERO, Vec3::Y, 70.0);
            let size = ImageSize { width: 37, height: 23 };
            let corners = |scene: &Scene, hits: &FirstHits| -> Vec<_> {
                hits.primitives.iter().map(|hit| hit.map(|p| scene.corners(p))).collect()
            };
            let forward = scene(&triangles);
            let traced = classical::first_hits(&forward, &camera, size);
            for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
                let filled = first_hits_on(set, &forward, &camera, size);
                prop_assert_eq!(&filled.primitives, &traced.primitives);
                prop_assert!(filled.tests <= traced.tests);
            }
            let backward = scene(&triangles.iter().rev().copied().collect::<Vec<_>>());
            let reversed = first_hits(&backward, &camera, size);
            prop_assert_eq!(corners(&forward, &traced), corners(&backward, &reversed));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

        /// Several bands, many blocks, edges along pixel centres, and much that is hidden by what was drawn before.
        #[test]
        fn crowds_are_seen_as_by_classical_ray_tracing(
            triangles in prop::collection::vec(triangle(), 1..40),
            sizes in prop::collection::vec(prop_oneof![Just(1.0f32), 0.01f32..0.3], 40),
            narrow in any::<bool>(),
            eye in prop::array::uniform3(-3.0f32..3.0),
        ) {
            let shrunk = triangles.iter().zip(&sizes).map(|(t, &size)| t.map(|p| t[0] + (p - t[0]) * size));
            let scene = scene(&shrunk.collect::<Vec<_>>());
            let camera = Camera::look_at("c", Vec3::from(eye), Vec3::ZERO, Vec3::Y, if narrow { 8.0 } else { 110.0 });
            let size = ImageSize { width: 83, height: 70 };
            let traced = classical::first_hits(&scene, &camera, size);
            for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
                let filled = first_hits_on(set, &scene, &camera, size);
                prop_assert_eq!(&filled.primitives, &traced.primitives, "{:?}", set);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

        /// Corners lie on rays, exactly, so that edges and ties are met by rays that nothing but exact signs decides.
        #[test]
        fn corners_on_rays_are_seen_as_by_classical_ray_tracing(
            corners in prop::collection::vec(prop::array::uniform3((0u32..5, 0u32..5, -1i32..2)), 1..12),
            narrow in any::<bool>(),
        ) {
            let target = Vec3::new(0.3, -0.2, -1.0);
            let camera = Camera::look_at("c", Vec3::ZERO, target, Vec3::Y, if narrow { 9.0 } else { 75.0 });
            let size = ImageSize { width: 41, height: 35 };
            let raster = camera.raster(size);
            // So few rays that triangles share corners and edges.
            let corner = |(x, y, power): (u32, u32, i32)| camera.direction(&raster, 10 * x, 8 * y) * 2f32.powi(power);
            let scene = scene(&corners.into_iter().map(|t| t.map(corner)).collect::<Vec<_>>());
            let traced = classical::first_hits(&scene, &camera, size);
            for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
                let filled = first_hits_on(set, &scene, &camera, size);
                prop_assert_eq!(&filled.primitives, &traced.primitives, "{:?}", set);
            }
        }
    }

    #[test]
    fn coplanar_faces_are_drawn_the_same_in_any_object_order() {
        // Overlapping in one plane: every ray that meets both meets them at the same t.
        let low = [Vec3::new(-2.0, 0.0, -2.0), Vec3::new(2.0, 0.0, -2.0), Vec3::new(0.0, 0.0, 2.0)];
        let high = [Vec3::new(-2.0, 0.0, 2.0), Vec3::new(2.0, 0.0, 2.0), Vec3::new(0.0, 0.0, -2.0)];
        let camera = Camera::look_at("c", Vec3::new(0.3, 3.0, 0.7), Vec3::ZERO, Vec3::Z, 70.0);
        let size = ImageSize { width: 32, height: 32 };
        let corners = |triangles: &[[Vec3; 3]]| -> Vec<_> {
            let scene = scene(triangles);
            let hits = first_hits(&scene, &camera, size).primitives;
            hits.into_iter().map(|hit| hit.map(|p| scene.corners(p))).collect()
        };
        let drawn = corners(&[low, high]);
        assert_eq!(drawn, corners(&[high, low]));
        assert!(drawn.contains(&Some(low)) && drawn.contains(&Some(high)) && drawn.contains(&None));
    }
}

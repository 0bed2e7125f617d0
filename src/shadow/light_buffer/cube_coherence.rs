//! Which sides of the cube a triangle can project on (row 7 of the notes on the 1986 paper, "Cube coherence").
//!
//! The paper casts an object on the side that one of its points is seen through and goes on from there over
//! the edges that clip it. That loses objects of several parts and those around the light, so here each triangle
//! says for each side on its own whether it certainly stays outside of one of the planes that bound it.

use super::cube::Face;
use glam::DVec3;

/// Sides of the cube, a bit each by [`Face::index`].
pub(super) type SideBits = u8;

/// All sides but those that a triangle certainly does not project on; corners are relative to the light.
///
/// A side is left out if all corners are outside of one of its planes by more than 1e-11 of the largest
/// coordinate. That is above all that a [`Footprint`](crate::geometry::footprint::Footprint) on a side's grid
/// widens them by (1.02e-12 for the grid, 2e-14 for rounding), so that it is `None` for every side that is
/// left out, and lists are the same as if nothing were.
pub(super) fn touched_sides(corners: [DVec3; 3]) -> SideBits {
    let margin = corners.iter().map(|u| u.abs().max_element()).fold(0.0, f64::max) * 1e-11;
    let may_touch = |face: &Face| {
        let [a, b, c] = corners.map(|u| face.coordinates(u));
        let outside = |plane: fn([f64; 3]) -> f64| [a, b, c].iter().all(|&u| plane(u) < -margin);
        !(outside(|[_, _, z]| z)
            || outside(|[x, _, z]| z + x)
            || outside(|[x, _, z]| z - x)
            || outside(|[_, y, z]| z + y)
            || outside(|[_, y, z]| z - y))
    };
    Face::ALL.iter().filter(|face| may_touch(face)).fold(0, |sides, face| sides | 1 << face.index())
}

#[cfg(test)]
mod tests {
    use super::super::cells::side_grid;
    use super::*;
    use crate::geometry::footprint::Footprint;
    use crate::geometry::planes::{OrientedPlanes, oriented};
    use glam::Vec3;
    use proptest::prelude::*;

    /// Many lie on the planes between sides.
    fn corner() -> impl Strategy<Value = Vec3> {
        let coordinate = prop_oneof![-1.0f32..1.0, (-3i8..4).prop_map(f32::from)];
        let beside = prop::sample::select(vec![0.0f32, 1e-7, -1e-7, 3e-12, -3e-12, 1e-30]);
        (prop::array::uniform3(coordinate), prop::array::uniform3(beside))
            .prop_map(|(p, q)| Vec3::from(p) + Vec3::from(q))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        #[test]
        fn no_side_is_left_out_that_a_triangle_has_a_footprint_on(
            corners in prop::array::uniform3(corner()),
            scale in prop::sample::select(vec![1.0f32, 1e-20, 1e15]),
            resolution in prop::sample::select(vec![1u32, 7, 64, 4096]),
        ) {
            let corners = corners.map(|p| p * scale);
            let Some(corners) = oriented(Vec3::ZERO, corners) else { return Ok(()) };
            let corners = corners.map(Vec3::as_dvec3);
            let sides = touched_sides(corners);
            let planes = OrientedPlanes::from_apex(DVec3::ZERO, corners);
            for face in Face::ALL.iter().filter(|face| sides >> face.index() & 1 == 0) {
                let footprint = Footprint::new(&side_grid(resolution), &face.frame(), &planes);
                prop_assert!(footprint.is_none(), "{:?}", face);
            }
        }
    }

    #[test]
    fn a_small_triangle_is_on_one_side_and_one_around_the_light_on_five() {
        let small = [DVec3::new(4.0, 1.0, 1.0), DVec3::new(4.0, 2.0, 1.0), DVec3::new(4.0, 1.0, 2.0)];
        assert_eq!(touched_sides(small), 1);
        assert_eq!(touched_sides(small.map(|u| -u)), 1 << 1);
        let floor =
            [DVec3::new(-90.0, -1.0, -90.0), DVec3::new(90.0, -1.0, -90.0), DVec3::new(0.0, -1.0, 90.0)];
        assert_eq!(touched_sides(floor), 0b11_1011, "all but +y");
    }
}

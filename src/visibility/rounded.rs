//! Surface points rounded to f32, coordinate by coordinate: sixteen bytes a point, in the order in which wide registers
//! read them.

use super::SurfacePoint;
use crate::scene::PrimitiveIndex;
use rayon::prelude::*;

/// Points to be lit, rounded. What is exact about them stays with the [`SurfacePoint`]s.
#[derive(Debug, Clone, Default)]
pub struct RoundedPoints {
    /// x, y and z of each position, rounded to the nearest f32 from the nearest f64: wrong by half an ulp and 2^-29 of
    /// that.
    pub coordinates: [Vec<f32>; 3],
    /// The primitive that each lies on, or [`RoundedPoints::NO_PRIMITIVE`].
    pub primitives: Vec<PrimitiveIndex>,
}

/// Points of a task.
const CHUNK: usize = 4096;

impl RoundedPoints {
    /// The primitive of a point that lies on none.
    pub const NO_PRIMITIVE: PrimitiveIndex = PrimitiveIndex::MAX;

    /// Rounds points.
    pub fn new(points: &[SurfacePoint]) -> RoundedPoints {
        let [mut x, mut y, mut z] = [(); 3].map(|()| vec![0.0; points.len()]);
        let mut primitives = vec![0; points.len()];
        (points.par_chunks(CHUNK), x.par_chunks_mut(CHUNK), y.par_chunks_mut(CHUNK), z.par_chunks_mut(CHUNK))
            .into_par_iter()
            .zip(primitives.par_chunks_mut(CHUNK))
            .for_each(|((points, x, y, z), primitives)| {
                for (i, point) in points.iter().enumerate() {
                    let position = point.position.as_vec3();
                    (x[i], y[i], z[i]) = (position.x, position.y, position.z);
                    primitives[i] = point.primitive().unwrap_or(RoundedPoints::NO_PRIMITIVE);
                }
            });
        RoundedPoints { coordinates: [x, y, z], primitives }
    }

    /// The position of a point.
    #[inline(always)]
    pub fn position(&self, point: usize) -> [f32; 3] {
        [0, 1, 2].map(|axis| self.coordinates[axis][point])
    }

    /// Coordinates of so many points from one on, or up to the last.
    pub fn slice(&self, first: usize, count: usize) -> [&[f32]; 3] {
        self.coordinates.each_ref().map(|coordinate| {
            let end = coordinate.len().min(first + count);
            &coordinate[first..end]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn points_keep_their_order_across_chunks() {
        let at = |i: usize| Vec3::new(i as f32, -(i as f32), 0.5 * i as f32);
        let points: Vec<_> = (0..CHUNK + 3).map(|i| SurfacePoint::bare(at(i)).unwrap()).collect();
        let rounded = RoundedPoints::new(&points);
        for i in [0, 1, CHUNK - 1, CHUNK, CHUNK + 2] {
            assert_eq!(rounded.position(i), at(i).to_array());
        }
        assert_eq!(rounded.primitives, vec![RoundedPoints::NO_PRIMITIVE; points.len()]);
        assert_eq!(rounded.slice(CHUNK, CHUNK)[0], [4096.0, 4097.0, 4098.0]);
    }
}

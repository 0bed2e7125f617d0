//! Surface points in the form in which most queries need them: sixteen bytes each, beside what makes them exact.

use super::SurfacePoint;
use crate::scene::PrimitiveIndex;
use glam::Vec3;
use rayon::prelude::*;

/// A surface point rounded to f32, and the primitive that it lies on.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(C, align(16))]
pub struct RoundedPoint {
    /// [`SurfacePoint::position`] rounded to f32: each coordinate is wrong by half an ulp and 2^-29 of that.
    pub position: [f32; 3],
    /// The primitive that the point lies on, or [`RoundedPoint::BARE`].
    primitive: PrimitiveIndex,
}

impl RoundedPoint {
    /// In place of a primitive, for a point on none.
    const BARE: PrimitiveIndex = PrimitiveIndex::MAX;

    /// The primitive that the point lies on, if any.
    #[inline(always)]
    pub fn primitive(&self) -> Option<PrimitiveIndex> {
        (!self.is_bare()).then_some(self.primitive)
    }

    /// The primitive that the point lies on, or a number that is none's.
    #[inline(always)]
    pub(crate) fn primitive_or_most(&self) -> PrimitiveIndex {
        self.primitive
    }

    /// Whether it lies on no primitive.
    #[inline(always)]
    pub fn is_bare(&self) -> bool {
        self.primitive == RoundedPoint::BARE
    }

    /// All points rounded, on all threads.
    pub fn all(points: &[SurfacePoint]) -> Vec<RoundedPoint> {
        points.par_iter().with_min_len(4096).map(RoundedPoint::from).collect()
    }
}

impl From<&SurfacePoint> for RoundedPoint {
    #[inline(always)]
    fn from(point: &SurfacePoint) -> RoundedPoint {
        let Vec3 { x, y, z } = point.position.as_vec3();
        RoundedPoint { position: [x, y, z], primitive: point.primitive().unwrap_or(RoundedPoint::BARE) }
    }
}

/// Points in both forms: what reads all of them reads the small one, and looks into the other where something is close.
#[derive(Debug, Clone, Copy)]
pub struct Points<'a> {
    rounded: &'a [RoundedPoint],
    exact: &'a [SurfacePoint],
}

impl<'a> Points<'a> {
    /// The same points in both forms.
    ///
    /// # Panics
    /// If there are more of one.
    pub fn new(rounded: &'a [RoundedPoint], exact: &'a [SurfacePoint]) -> Points<'a> {
        assert_eq!(rounded.len(), exact.len(), "the same points in both forms");
        Points { rounded, exact }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.exact.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.exact.is_empty()
    }

    /// Rounded to f32.
    pub fn rounded(&self) -> &'a [RoundedPoint] {
        self.rounded
    }

    /// With what makes them exact.
    pub fn exact(&self) -> &'a [SurfacePoint] {
        self.exact
    }

    /// Portions of so many, in order.
    pub fn chunks(self, count: usize) -> impl Iterator<Item = Points<'a>> {
        let pairs = self.rounded.chunks(count).zip(self.exact.chunks(count));
        pairs.map(|(rounded, exact)| Points { rounded, exact })
    }

    /// The same for all threads.
    pub fn par_chunks(self, count: usize) -> impl IndexedParallelIterator<Item = Points<'a>> {
        let pairs = self.rounded.par_chunks(count).zip(self.exact.par_chunks(count));
        pairs.map(|(rounded, exact)| Points { rounded, exact })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::PointSource;
    use glam::DVec3;

    fn points() -> Vec<SurfacePoint> {
        let source = PointSource::Ray { origin: Vec3::ZERO, direction: Vec3::X, primitive: 7 };
        let on = SurfacePoint { position: DVec3::new(1.0 / 3.0, -2.0, 1e-60), source };
        vec![on, SurfacePoint::bare(Vec3::Y).expect("finite"), on]
    }

    #[test]
    fn a_point_is_sixteen_bytes_and_rounded_to_nearest() {
        assert_eq!(size_of::<RoundedPoint>(), 16);
        let rounded = RoundedPoint::all(&points());
        assert_eq!(rounded[0].position, [1.0f32 / 3.0, -2.0, 0.0]);
        assert_eq!(rounded.iter().map(RoundedPoint::primitive).collect::<Vec<_>>(), [Some(7), None, Some(7)]);
    }

    #[test]
    fn portions_hold_the_same_points_in_both_forms() {
        let exact = points();
        let rounded = RoundedPoint::all(&exact);
        let portions: Vec<_> = Points::new(&rounded, &exact).chunks(2).collect();
        assert_eq!(portions.iter().map(Points::len).collect::<Vec<_>>(), [2, 1]);
        for portion in portions {
            assert_eq!(RoundedPoint::all(portion.exact()), portion.rounded());
        }
    }

    #[test]
    #[should_panic(expected = "the same points in both forms")]
    fn as_many_are_wanted_of_both() {
        Points::new(&RoundedPoint::all(&points()[1..]), &points());
    }
}

//! Bounding volumes, boxes and spheres, and whether a light's segment can meet one ("Bounding volumes" of the
//! 1986 paper, row 8 of its notes; the control of its timings, row 22).
//!
//! A test says no only if the segment certainly misses: volumes and segments are closed, and every bound is
//! wider than the rounding on the way. So what stands in a volume may be skipped when the volume is not met,
//! for exact points anywhere and for half-lines, and no answer changes.

use super::{LightPosition, LightSpace, ROUNDOFF};
use glam::{DVec3, Vec3};

/// The open segment between a light and a point, or the half-line if the light is infinitely far away, with
/// the bounds of what is not known of it. In world space.
#[derive(Debug, Clone, Copy)]
pub struct LightSegment {
    /// The light; the rounded point if the light is infinitely far away.
    start: DVec3,
    /// From `start` to the rounded point, or towards the light.
    direction: DVec3,
    /// Squared length of `direction`.
    length_squared: f64,
    end: End,
    /// The smallest box around all of it; infinite where it has no end.
    low: DVec3,
    high: DVec3,
    /// More than the exact point can lie beside the rounded one.
    point_error: DVec3,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    /// At `start + direction`.
    Point,
    /// Nowhere.
    Infinity,
}

/// More than the roundings of any value below, relative to the sum of its absolute terms.
///
/// For a box: the middle is wrong by 3 roundoffs of |low| + |high| + |start|, the half extent by 1, the direction by
/// 1 of |start| and 1 of the point, which is in `point_error`; then a product and a difference. For a sphere: the
/// middle by 1, the place along the segment by 3 of a scalar product over 4 of a squared length, each relative to
/// |middle| / |direction|; the nearest point by 2 more, its distance by 3. That is 15 at most, and 32 are taken.
const ROUNDINGS: f64 = 32.0 * ROUNDOFF;

/// Above the rounding of subnormal numbers, far below what f32 coordinates can differ by.
const TINY: f64 = 1e-60;

impl LightSegment {
    /// The segment between a light and a point whose exact coordinates are within half an ulp of `rounded`.
    pub fn new(space: &LightSpace, rounded: DVec3) -> LightSegment {
        let point_error = rounded.abs() * (2.0 * ROUNDOFF) + DVec3::splat(TINY);
        let (near, far) = (rounded - point_error, rounded + point_error);
        match space.light() {
            LightPosition::At(light) => {
                let start = light.as_dvec3();
                let direction = rounded - start;
                LightSegment {
                    start,
                    direction,
                    length_squared: direction.length_squared(),
                    end: End::Point,
                    low: near.min(start),
                    high: far.max(start),
                    point_error,
                }
            }
            LightPosition::Towards(direction) => {
                let direction = direction.as_dvec3();
                let open = |side: f64, axis: usize| side * direction[axis] > 0.0;
                let axes = [0, 1, 2];
                LightSegment {
                    start: rounded,
                    direction,
                    length_squared: direction.length_squared(),
                    end: End::Infinity,
                    low: DVec3::from_array(
                        axes.map(|i| if open(-1.0, i) { f64::NEG_INFINITY } else { near[i] }),
                    ),
                    high: DVec3::from_array(axes.map(|i| if open(1.0, i) { f64::INFINITY } else { far[i] })),
                    point_error,
                }
            }
        }
    }
}

/// A closed volume that holds all of something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Volume {
    /// A box along the axes.
    Box {
        /// Its lowest corner.
        low: Vec3,
        /// Its highest corner.
        high: Vec3,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        centre: Vec3,
        /// Its radius.
        radius: f32,
    },
}

impl Volume {
    /// The box or the sphere around some points, whichever has the smaller surface: the more seldom it is met
    /// by segments that come from everywhere. `None` if there are no points.
    pub fn around(points: impl Iterator<Item = Vec3> + Clone) -> Option<Volume> {
        let (low, high) = points.clone().map(|p| (p, p)).reduce(join)?;
        let centre = low * 0.5 + high * 0.5;
        let far = |p: Vec3| (p.as_dvec3() - centre.as_dvec3()).length();
        Some(smaller(low, high, centre, points.map(far)))
    }

    /// The same around volumes.
    pub fn around_volumes(volumes: impl Iterator<Item = Volume> + Clone) -> Option<Volume> {
        let (low, high) = volumes.clone().map(Volume::corners).reduce(join)?;
        let centre = low * 0.5 + high * 0.5;
        let from = centre.as_dvec3();
        let far = |volume: Volume| match volume {
            Volume::Box { low, high } => (from - low.as_dvec3()).max(high.as_dvec3() - from).length(),
            Volume::Sphere { centre, radius } => (centre.as_dvec3() - from).length() + f64::from(radius),
        };
        Some(smaller(low, high, centre, volumes.map(far)))
    }

    /// Corners of a box that holds what it holds, which has finite coordinates.
    pub fn corners(self) -> (Vec3, Vec3) {
        match self {
            Volume::Box { low, high } => (low, high),
            Volume::Sphere { centre, radius } => {
                let (middle, reach) = (centre.as_dvec3(), f64::from(radius));
                let low = (middle - reach).to_array().map(|x| (x as f32).next_down().max(f32::MIN));
                let high = (middle + reach).to_array().map(|x| (x as f32).next_up().min(f32::MAX));
                (Vec3::from(low), Vec3::from(high))
            }
        }
    }

    /// Where most of it is, for sorting.
    pub fn centre(&self) -> DVec3 {
        match self {
            Volume::Box { low, high } => (low.as_dvec3() + high.as_dvec3()) * 0.5,
            Volume::Sphere { centre, .. } => centre.as_dvec3(),
        }
    }

    /// The area of its surface, in squared units of the scene.
    pub fn surface(&self) -> f64 {
        match self {
            Volume::Box { low, high } => {
                let d = high.as_dvec3() - low.as_dvec3();
                2.0 * (d.x * d.y + d.y * d.z + d.z * d.x)
            }
            Volume::Sphere { radius, .. } => 4.0 * std::f64::consts::PI * f64::from(*radius).powi(2),
        }
    }

    /// Whether a segment may meet it; if not, it certainly meets nothing of what the volume holds.
    pub fn may_be_met_by(&self, segment: &LightSegment) -> bool {
        match self {
            Volume::Box { low, high } => may_meet_box(low.as_dvec3(), high.as_dvec3(), segment),
            Volume::Sphere { centre, radius } => {
                may_meet_sphere(centre.as_dvec3(), f64::from(*radius), segment)
            }
        }
    }
}

fn join(a: (Vec3, Vec3), b: (Vec3, Vec3)) -> (Vec3, Vec3) {
    (a.0.min(b.0), a.1.max(b.1))
}

fn smaller(low: Vec3, high: Vec3, centre: Vec3, distances: impl Iterator<Item = f64>) -> Volume {
    // The next f32 is above by more than the distances are wrong by; never so small that squares underflow.
    let radius = distances.fold(0.0, f64::max);
    let sphere = Volume::Sphere { centre, radius: (radius as f32).next_up() };
    let around = Volume::Box { low, high };
    if sphere.surface() < around.surface() { sphere } else { around }
}

/// Axes that certainly separate a segment from a box are looked for among those of the box and the cross
/// products of these with the segment, which are all that can.
fn may_meet_box(low: DVec3, high: DVec3, segment: &LightSegment) -> bool {
    if (segment.high.cmplt(low) | segment.low.cmpgt(high)).any() {
        return false;
    }
    let (d, size) = (segment.direction, segment.direction.abs());
    let middle = (low + high) * 0.5 - segment.start;
    let half = half_extent(low, high, middle, segment);
    let misses = |i: usize, j: usize| {
        let value = d[i] * middle[j] - d[j] * middle[i];
        // The roundings of the products and of this sum are in the half extents.
        value.abs() > size[i] * half[j] + size[j] * half[i]
    };
    !(misses(0, 1) || misses(1, 2) || misses(2, 0))
}

/// Half the extent of a box, widened by all that rounding can move it and the segment.
///
/// The exact segment lies within `point_error` of the one between the rounded points; middle and half extent are
/// wrong by two roundings of the coordinates, and the products with them by a few of theirs.
fn half_extent(low: DVec3, high: DVec3, middle: DVec3, segment: &LightSegment) -> DVec3 {
    (high - low) * 0.5
        + segment.point_error
        + ROUNDINGS * (low.abs() + high.abs() + middle.abs() + segment.start.abs())
}

/// The distance of the centre from the nearest point of the segment.
fn may_meet_sphere(centre: DVec3, radius: f64, segment: &LightSegment) -> bool {
    let middle = centre - segment.start;
    let most = match segment.end {
        End::Point => 1.0,
        End::Infinity => f64::INFINITY,
    };
    // The place along the segment is wrong by a few roundings of |middle| / |direction|, and so the distance
    // by as many of |middle|: it changes no faster than the place moves.
    if segment.length_squared < 1e-280 {
        return true;
    }
    let along = (middle.dot(segment.direction) / segment.length_squared).clamp(0.0, most);
    let distance = (middle - segment.direction * along).length();
    distance <= radius + sphere_slack(middle, centre, radius, segment)
}

/// What rounding can move the segment, and the distance of a sphere from it.
fn sphere_slack(middle: DVec3, centre: DVec3, radius: f64, segment: &LightSegment) -> f64 {
    segment.point_error.length()
        + ROUNDINGS * (middle.length() + centre.length() + segment.start.length() + radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ExactPosition;
    use crate::geometry::occlusion::PreciseQuery;
    use proptest::prelude::*;

    fn coordinates() -> impl Strategy<Value = Vec3> {
        let coordinate = prop_oneof![-1.0f32..1.0, (-3i8..4).prop_map(|x| f32::from(x) * 0.5)];
        prop::array::uniform3(coordinate).prop_map(Vec3::from)
    }

    /// Both volumes around some points, and the one that is chosen.
    fn volumes(points: &[Vec3]) -> [Volume; 3] {
        let (low, high) = points.iter().map(|&p| (p, p)).reduce(join).unwrap();
        let chosen = Volume::around(points.iter().copied()).unwrap();
        let centre = low * 0.5 + high * 0.5;
        let far = points.iter().map(|p| (p.as_dvec3() - centre.as_dvec3()).length()).fold(0.0, f64::max);
        let radius = (far as f32).next_up();
        [Volume::Box { low, high }, Volume::Sphere { centre, radius }, chosen]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        /// Points behind corners and edges, where a triangle only just blocks, and volumes that have them on
        /// their surface.
        #[test]
        fn no_volume_is_missed_whose_triangle_blocks(
            light in coordinates(),
            is_far in any::<bool>(),
            corners in prop::array::uniform3(coordinates()),
            others in prop::collection::vec(coordinates(), 0..3),
            along in prop_oneof![Just(0.0f32), 0.0f32..1.0],
            depth in 1.0f32..1.6,
            offset in prop::sample::select(vec![0.0f32, 100.0, 1e5]),
            scale in prop::sample::select(vec![1.0f32, 1e-20, 1e15]),
        ) {
            let place = |p: Vec3| (p + Vec3::splat(offset)) * scale;
            let corners = corners.map(place);
            let on_edge = corners[0] + along * (corners[1] - corners[0]);
            let bounds = corners[1..].iter().fold((corners[0], corners[0]), |b, &c| join(b, (c, c)));
            let (space, point) = if is_far {
                prop_assume!(light != Vec3::ZERO);
                (LightSpace::new(LightPosition::Towards(light), bounds), on_edge - (depth - 1.0) * scale * light)
            } else {
                let light = place(light);
                (LightSpace::from(light), light + depth * (on_edge - light))
            };
            let query = PreciseQuery::new(&space, point.as_dvec3(), || ExactPosition::Bare(point));
            if !query.blocks(corners).0 {
                return Ok(());
            }
            let segment = LightSegment::new(&space, point.as_dvec3());
            let points: Vec<Vec3> = corners.into_iter().chain(others.iter().map(|&p| place(p))).collect();
            for volume in volumes(&points) {
                prop_assert!(volume.may_be_met_by(&segment), "{:?}", volume);
                let elsewhere = Volume::around(others.iter().map(|&p| place(p + Vec3::ONE)));
                let cluster = Volume::around_volumes([Some(volume), elsewhere].into_iter().flatten()).unwrap();
                prop_assert!(cluster.may_be_met_by(&segment), "{:?} in {:?}", volume, cluster);
            }
        }

    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(600))]
        /// What a volume answers is no more than what it must: a segment that stays clear of it by a
        /// thousandth misses.
        #[test]
        fn volumes_that_are_clearly_missed_are_missed(
            start in coordinates(),
            end in coordinates(),
            is_far in any::<bool>(),
            points in prop::collection::vec(coordinates(), 1..5),
        ) {
            prop_assume!(start != end);
            let space = if is_far {
                LightSpace::new(LightPosition::Towards(start - end), (Vec3::splat(-2.0), Vec3::splat(2.0)))
            } else {
                LightSpace::from(start)
            };
            let segment = LightSegment::new(&space, end.as_dvec3());
            let reach = if is_far { 16.0 } else { 1.0 };
            // Half a thousandth from one place to the next at most.
            let steps = ((start - end).length() * reach * 4000.0) as u32 + 1;
            let places = (0..=steps).map(|i| end.lerp(start, reach * i as f32 / steps as f32));
            for volume in volumes(&points) {
                let distance = |p: Vec3| match volume {
                    Volume::Box { low, high } => (p - p.clamp(low, high)).length(),
                    Volume::Sphere { centre, radius } => (p - centre).length() - radius,
                };
                if places.clone().all(|p| distance(p) > 1e-3) && !(is_far && (start - end).length() < 0.4) {
                    prop_assert!(!volume.may_be_met_by(&segment), "{:?}", volume);
                }
            }
        }
    }

    #[test]
    fn the_smaller_surface_is_chosen() {
        let cube = (0..8).map(|i| Vec3::from_array([0, 1, 2].map(|axis| f32::from(i >> axis & 1 == 1))));
        assert!(matches!(Volume::around(cube), Some(Volume::Box { .. })));
        let tips = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|v| [v, -v]);
        assert!(matches!(Volume::around(tips), Some(Volume::Sphere { .. })));
        assert_eq!(Volume::around(std::iter::empty()), None);
    }

    #[test]
    fn a_segment_that_ends_on_a_face_meets_the_box_and_one_that_ends_before_does_not() {
        let volume = Volume::Box { low: Vec3::ZERO, high: Vec3::ONE };
        let segment =
            |y: f32| LightSegment::new(&Vec3::new(0.5, 3.0, 0.5).into(), Vec3::new(0.5, y, 0.5).into());
        assert!(volume.may_be_met_by(&segment(1.0)));
        assert!(!volume.may_be_met_by(&segment(1.0f32.next_up())));
    }

    #[test]
    fn a_half_line_has_an_end_only_at_its_point() {
        let volume = Volume::Sphere { centre: Vec3::new(0.0, 1e6, 0.0), radius: 1.0 };
        let bounds = (Vec3::splat(-1.0), Vec3::splat(1.0));
        let towards = |y: f32| {
            let space = LightSpace::new(LightPosition::Towards(Vec3::new(0.0, y, 0.0)), bounds);
            LightSegment::new(&space, DVec3::ZERO)
        };
        assert!(volume.may_be_met_by(&towards(1e-3)) && !volume.may_be_met_by(&towards(-1e-3)));
    }

    #[test]
    fn volumes_are_as_large_as_they_must_be() {
        let offset = Vec3::new(8.0, 16.0, 32.0);
        let tips = || [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|v| [v, -v]).map(|v| v + offset);
        let ball = Volume::Sphere { centre: offset, radius: 1.0_f32.next_up() };
        assert_eq!(Volume::around(tips()), Some(ball));
        let points = tips().map(|p| Volume::Box { low: p, high: p });
        assert_eq!(Volume::around_volumes(points), Some(ball));
        let balls = tips().map(|centre| Volume::Sphere { centre, radius: 0.25 });
        let Some(Volume::Sphere { centre, radius }) = Volume::around_volumes(balls) else {
            panic!("a sphere")
        };
        assert!(centre.distance(offset) < 1e-5 && (radius - 1.25).abs() < 1e-5, "{centre} {radius}");
        let long = Volume::Box { low: offset, high: offset + Vec3::new(1.0, 2.0, 3.0) };
        assert_eq!(Volume::around_volumes([long].into_iter()), Some(long));
        assert_eq!((long.surface(), long.centre()), (22.0, DVec3::new(8.5, 17.0, 33.5)));
        let two = Volume::Sphere { centre: offset, radius: 2.0 };
        assert_eq!((two.surface(), two.centre()), (16.0 * std::f64::consts::PI, offset.as_dvec3()));
    }

    #[test]
    fn volumes_are_widened_by_what_is_derived() {
        // In roundoffs: 2 of the point's coordinates, and 32 of each place.
        let segment = LightSegment::new(&Vec3::new(3.0, 0.0, 0.0).into(), DVec3::new(0.0, 4.0, 0.0));
        let slack = sphere_slack(DVec3::Z * 4.0, DVec3::new(3.0, 0.0, 4.0), 2.0, &segment);
        assert!((slack / ROUNDOFF - (8.0 + 32.0 * (4.0 + 5.0 + 3.0 + 2.0))).abs() < 1e-6);
        let segment = LightSegment::new(&Vec3::new(-7.0, 1.0, 0.0).into(), DVec3::new(5.0, 0.0, -2.0));
        let (low, high) = (DVec3::ONE, DVec3::new(3.0, 5.0, 9.0));
        let half = half_extent(low, high, (low + high) * 0.5 - segment.start, &segment);
        let more = (half - DVec3::new(1.0, 2.0, 4.0)) / ROUNDOFF;
        let expected = DVec3::new(10.0, 0.0, 4.0)
            + 32.0 * DVec3::new(1.0 + 3.0 + 9.0 + 7.0, 1.0 + 5.0 + 2.0 + 1.0, 1.0 + 9.0 + 5.0);
        assert!((more - expected).abs().max_element() <= 8.0, "{more} and {expected}");
    }

    #[test]
    fn a_segment_whose_squares_underflow_may_meet_everything() {
        let segment = LightSegment::new(&Vec3::ZERO.into(), DVec3::splat(1e-150));
        let far = Volume::Sphere { centre: Vec3::ONE, radius: 0.5 };
        assert!(far.may_be_met_by(&segment));
    }

    #[test]
    fn a_surface_is_that_of_all_sides() {
        let low = Vec3::new(1.0, 2.0, -3.0);
        assert_eq!(Volume::Box { low, high: low + Vec3::new(2.0, 3.0, 5.0) }.surface(), 62.0);
    }

    #[test]
    fn what_a_segment_only_touches_is_met() {
        let sphere = Volume::Sphere { centre: Vec3::Y, radius: 1.0 };
        let cube = Volume::Box { low: Vec3::new(-1.0, 0.0, 0.0), high: Vec3::new(1.0, 2.0, 1.0) };
        let along_x = LightSegment::new(&LightSpace::from(Vec3::X * -9.0), DVec3::X * 9.0);
        let diagonal =
            LightSegment::new(&LightSpace::from(Vec3::new(-2.0, 1.0, 0.5)), DVec3::new(0.0, -1.0, 0.5));
        assert!(
            sphere.may_be_met_by(&along_x) && cube.may_be_met_by(&along_x) && cube.may_be_met_by(&diagonal)
        );
        let point = LightSegment::new(&LightSpace::from(Vec3::ZERO), DVec3::ZERO);
        assert!(sphere.may_be_met_by(&point) && cube.may_be_met_by(&point));
    }
}

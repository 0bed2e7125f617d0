//! Polyhedra that enclose curved surfaces, to be projected in their place (row 18 of the notes on the 1986
//! paper).
//!
//! A hull is a closed convex mesh around everything between the points of the surface. It is wider than it
//! would have to be by a millionth of its size and 2^-40 of its distance from the origin. That is far above
//! the rounding of corners and projections, so that triangles of the hull which are seen too nearly edge-on to
//! be projected can be left out: their neighbours reach over what they would cover.

use super::shape::{Cone, Disc, Ellipsoid, Shape, Sphere};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Triangles of a hull, by their corners in world space.
pub(crate) type Hull = Vec<[DVec3; 3]>;

/// Corners of the polygon around a circle.
const SIDES: usize = 10;

/// How much wider hulls are than they would have to be, relative to their size.
const MARGIN: f64 = 1e-6;

/// A mesh that encloses a surface; `None` for a plane without end.
pub(crate) fn outer(shape: &Shape) -> Option<Hull> {
    match shape {
        Shape::Sphere(Sphere { centre, radius }) => {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * f64::from(*radius));
            Some(around_ball(shape, *centre, axes))
        }
        Shape::Ellipsoid(Ellipsoid { centre, axes }) => {
            Some(around_ball(shape, *centre, axes.map(Vec3::as_dvec3)))
        }
        Shape::Cone(cone) => Some(around_cone(cone)),
        Shape::Disc(disc) => Some(around_disc(disc)),
        Shape::Plane(_) => None,
        Shape::Quadric(quadric) => Some(box_between(quadric.low, quadric.high)),
    }
}

/// What a hull near a point is widened by at least.
fn allowance(p: Vec3) -> f64 {
    p.as_dvec3().abs().max_element() * 2f64.powi(-40) + f64::MIN_POSITIVE
}

/// The corners of a regular icosahedron, and its faces by their corners.
static ICOSAHEDRON: LazyLock<([DVec3; 12], Vec<[usize; 3]>)> = LazyLock::new(|| {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let corners: [DVec3; 12] = std::array::from_fn(|i| {
        let (one, long) = (if i & 1 == 0 { 1.0 } else { -1.0 }, if i & 2 == 0 { golden } else { -golden });
        let mut corner = [0.0, one, long];
        corner.rotate_right(i / 4);
        DVec3::from_array(corner)
    });
    // Edges have length 2, everything else is farther apart.
    let near = |i: usize, j: usize| corners[i].distance_squared(corners[j]) < 5.0;
    let faces = (0..12).flat_map(|i| (i + 1..12).flat_map(move |j| (j + 1..12).map(move |k| [i, j, k])));
    let faces = faces.filter(|&[i, j, k]| near(i, j) && near(j, k) && near(k, i)).collect();
    (corners, faces)
});

/// The image of an icosahedron around the unit sphere under an affine map.
fn around_ball(shape: &Shape, centre: Vec3, axes: [DVec3; 3]) -> Hull {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    // The faces of the icosahedron are golden^2 / sqrt 3 away from its middle.
    let unit = 3f64.sqrt() / (golden * golden);
    // What rounding moves a corner by counts most across a flat ellipsoid.
    let longest = axes.iter().map(|axis| axis.length()).fold(0.0, f64::max);
    let thinnest = axes[0].dot(axes[1].cross(axes[2])).abs() / (longest * longest);
    let scale = unit * (1.0 + MARGIN + (allowance(centre) + longest * 2f64.powi(-40)) / thinnest);
    if scale.is_nan() || scale >= 4.0 {
        let (low, high) = shape.bounds().expect("a ball has an end");
        return box_between(low, high);
    }
    icosahedron(centre.as_dvec3(), axes.map(|axis| axis * scale))
}

/// The image of a regular icosahedron around the origin, of edges of length 2.
fn icosahedron(centre: DVec3, axes: [DVec3; 3]) -> Hull {
    let (corners, faces) = &*ICOSAHEDRON;
    let place = |p: DVec3| centre + axes[0] * p.x + axes[1] * p.y + axes[2] * p.z;
    faces.iter().map(|face| face.map(|i| place(corners[i]))).collect()
}

/// A prism or a frustum of a pyramid around two circles.
fn around_cone(cone: &Cone) -> Hull {
    let (base, apex) = (cone.base.as_dvec3(), cone.apex.as_dvec3());
    let axis = apex - base;
    let size = axis.length() + f64::from(cone.base_radius.max(cone.apex_radius));
    let wider = size * MARGIN + allowance(cone.base).max(allowance(cone.apex));
    let along = axis.normalize();
    let radii = [cone.base_radius, cone.apex_radius].map(f64::from);
    // These circles are farther apart than the ends, so that a wall between them would rise less than the
    // surface. They are larger by what that rises over the distance; or, where that is more, by the larger
    // radius: then either has room for all of it.
    let steepness = (radii[1] - radii[0]).abs() / axis.length();
    let across = wider + (wider * steepness).min(radii[0].max(radii[1]));
    around_circles([base - along * wider, apex + along * wider], along, radii.map(|radius| radius + across))
}

/// A flat prism.
fn around_disc(disc: &Disc) -> Hull {
    let along = disc.normal.as_dvec3().normalize();
    let wider = f64::from(disc.radius) * MARGIN + allowance(disc.centre);
    let centre = disc.centre.as_dvec3();
    let radius = f64::from(disc.radius) + wider;
    around_circles([centre - along * wider, centre + along * wider], along, [radius; 2])
}

/// Around two circles across one axis.
fn around_circles(centres: [DVec3; 2], axis: DVec3, radii: [f64; 2]) -> Hull {
    let reach = |end: usize| radii[end] / libm::cos(PI / SIDES as f64) * (1.0 + MARGIN);
    let [low, high] = [0, 1].map(|end| ring(centres[end], axis, reach(end)));
    let mut hull = Hull::new();
    for i in 0..SIDES {
        let j = (i + 1) % SIDES;
        hull.extend([[low[i], low[j], high[j]], [low[i], high[j], high[i]]]);
        hull.extend([[centres[0], low[i], low[j]], [centres[1], high[i], high[j]]]);
    }
    hull
}

/// The corners of a regular polygon across an axis.
fn ring(centre: DVec3, axis: DVec3, reach: f64) -> [DVec3; SIDES] {
    let (u, v) = axis.any_orthonormal_pair();
    std::array::from_fn(|i| {
        let angle = 2.0 * PI * i as f64 / SIDES as f64;
        centre + (u * libm::cos(angle) + v * libm::sin(angle)) * reach
    })
}

/// A box along the axes.
fn box_between(low: Vec3, high: Vec3) -> Hull {
    let size = (high.as_dvec3() - low.as_dvec3()).max_element();
    let wider = DVec3::splat(size * MARGIN + allowance(low).max(allowance(high)));
    let ends = [low.as_dvec3() - wider, high.as_dvec3() + wider];
    let corner = |i: usize| DVec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z);
    let faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let halves = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    halves.map(|triangle: [usize; 3]| triangle.map(corner)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::Quadric;
    use proptest::prelude::*;

    /// Whether a point is inside of all faces, the middle being inside.
    fn encloses(hull: &Hull, middle: DVec3, p: DVec3) -> bool {
        hull.iter().all(|[a, b, c]| {
            let normal = (b - a).cross(c - a);
            normal.dot(p - a) * normal.dot(middle - a) > 0.0
        })
    }

    fn unit_vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1.0f64..1.0)
            .prop_map(DVec3::from)
            .prop_filter("long enough", |v| v.length() > 0.1)
            .prop_map(DVec3::normalize)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn points_of_the_surface_are_inside(
            centre in prop::array::uniform3(-100.0f32..100.0),
            along in prop::array::uniform3(-3.0f32..3.0),
            radii in prop::array::uniform2(0.001f32..2.0),
            direction in unit_vector(),
            share in 0.0f64..1.0,
        ) {
            let (centre, along) = (Vec3::from(centre), Vec3::from(along));
            prop_assume!(along.length() > 0.01);
            let middle = centre.as_dvec3();
            let sphere = outer(&Shape::sphere(centre, radii[0])).unwrap();
            prop_assert_eq!(sphere.len(), 20);
            prop_assert!(encloses(&sphere, middle, middle + direction * f64::from(radii[0])));
            let axes = [along, along.any_orthogonal_vector() * 0.1, Vec3::new(radii[0], 0.3, 0.0)];
            let ellipsoid = Shape::Ellipsoid(Ellipsoid { centre, axes });
            if ellipsoid.defect().is_none() {
                let p = axes.iter().zip(direction.to_array()).fold(middle, |p, (a, x)| p + a.as_dvec3() * x);
                prop_assert!(encloses(&outer(&ellipsoid).unwrap(), middle, p));
            }
            let cone = Shape::cone(centre, radii[0], centre + along, radii[1]);
            let apex = (centre + along).as_dvec3();
            // The cone's own axis, rounded, is not quite parallel to what was added.
            let across = (apex - middle).cross(direction).normalize();
            let radius = f64::from(radii[0]) + share * f64::from(radii[1] - radii[0]);
            let on_wall = middle + (apex - middle) * share + across * radius;
            prop_assert!(encloses(&outer(&cone).unwrap(), (middle + apex) / 2.0, on_wall));
            let disc = Shape::Disc(Disc { centre, normal: along, radius: radii[0] });
            let across = along.as_dvec3().cross(direction).normalize();
            prop_assert!(encloses(&outer(&disc).unwrap(), middle, middle + across * f64::from(radii[0])));
        }
    }

    #[test]
    fn a_quadric_is_inside_its_box() {
        let quadric = Shape::Quadric(Quadric {
            reference: Vec3::ZERO,
            second: [1.0, 1.0, -1.0, 0.0, 0.0, 0.0],
            first: Vec3::ZERO,
            constant: -1.0,
            low: Vec3::new(-2.0, -3.0, -1.0),
            high: Vec3::new(2.0, 3.0, 1.0),
        });
        let hull = outer(&quadric).unwrap();
        for corner in [DVec3::new(-2.0, -3.0, -1.0), DVec3::new(2.0, 3.0, 1.0), DVec3::new(2.0, -3.0, 1.0)] {
            assert!(encloses(&hull, DVec3::ZERO, corner));
        }
        assert!(!encloses(&hull, DVec3::ZERO, DVec3::new(2.1, 0.0, 0.0)));
    }

    #[test]
    fn a_very_flat_ellipsoid_has_a_box() {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z * 1e-20];
        let flat = Shape::Ellipsoid(Ellipsoid { centre: Vec3::splat(100.0), axes });
        assert_eq!(outer(&flat).unwrap().len(), 12);
    }

    /// How far the faces of a hull are from a point inside of it: the nearest and the farthest.
    fn faces(hull: &Hull, middle: DVec3) -> [f64; 2] {
        hull.iter().fold([f64::INFINITY, 0.0], |[low, high], [a, b, c]| {
            let distance = (b - a).cross(c - a).normalize().dot(a - middle).abs();
            [low.min(distance), high.max(distance)]
        })
    }

    fn is_about(found: f64, expected: f64) -> bool {
        (found / expected - 1.0).abs() < 1e-8
    }

    #[test]
    fn hulls_are_wider_by_a_millionth_and_by_their_distance_from_the_origin() {
        // 2^20 * 2^-40.
        let far = 2.0_f64.powi(-20);
        for (x, wider) in [(0.0, 1e-6), (-1_048_576.0, 1e-6 + far)] {
            let centre = Vec3::Z * x;
            let middle = centre.as_dvec3();
            let [low, high] = faces(&outer(&Shape::sphere(centre, 1.0)).unwrap(), middle);
            assert!(is_about(low, 1.0 + wider) && is_about(high, 1.0 + wider), "{low} to {high}");
            // A thin ellipsoid needs more of its own size.
            let axes = [Vec3::X * 4.0, Vec3::Y * 2.0, Vec3::Z * 0.5];
            let thin = outer(&Shape::Ellipsoid(Ellipsoid { centre, axes })).unwrap();
            let thinnest = 4.0 * 2.0 * 0.5 / 16.0;
            let scale = 1.0 + 1e-6 + (wider - 1e-6 + 2.0_f64.powi(-38)) / thinnest;
            let unit: Hull =
                thin.iter().map(|t| t.map(|p| (p - middle) / DVec3::new(4.0, 2.0, 0.5))).collect();
            let [low, high] = faces(&unit, DVec3::ZERO);
            assert!(is_about(low, scale) && is_about(high, scale), "{low} to {high}");
            let disc = outer(&Shape::Disc(Disc { centre, normal: Vec3::Y * 3.0, radius: 2.0 })).unwrap();
            let [low, high] = faces(&disc, middle);
            let wider_disc = 2.0 * 1e-6 + wider - 1e-6;
            assert!((low / wider_disc - 1.0).abs() < 1e-3, "{low}");
            assert!(is_about(high, (2.0 + wider_disc) * (1.0 + 1e-6)), "{high}");
        }
        let cone = Shape::cone(Vec3::X * 1_048_576.0, 2.0, Vec3::new(1_048_576.0, 16.0, 0.0), 2.0);
        let middle = DVec3::new(1_048_576.0, 8.0, 0.0);
        let [near, ends] = faces(&outer(&cone).unwrap(), middle);
        let wider = (16.0 + 2.0) * 1e-6 + far;
        assert!(is_about(near, (2.0 + wider) * (1.0 + 1e-6)) && is_about(ends, 8.0 + wider), "{near} {ends}");
        let frustum = outer(&Shape::cone(Vec3::ZERO, 1.0, Vec3::Y * 4.0, 3.0)).unwrap();
        let widest = |y: f64| {
            let ring = frustum.iter().flatten().filter(|p| (p.y - y).abs() < 0.1).map(|p| p.x.hypot(p.z));
            ring.fold(0.0, f64::max) * (PI / SIDES as f64).cos() / (1.0 + 1e-6)
        };
        // The wall rises by 2 over 4.
        assert!(is_about(widest(0.0), 1.0 + 10.5e-6) && is_about(widest(4.0), 3.0 + 10.5e-6));
    }

    #[test]
    fn walls_that_rise_more_than_they_are_long_are_inside() {
        for (length, radii) in [(0.25, [0.0_f32, 2.0]), (0.01, [3.0, 0.5]), (1e-7, [1.0, 2.0])] {
            let hull = outer(&Shape::cone(Vec3::ZERO, radii[0], Vec3::Y * length, radii[1])).unwrap();
            let [length, low, high] = [length, radii[0], radii[1]].map(f64::from);
            for share in [0.0, 0.1, 0.5, 0.9, 1.0] {
                let radius = low + share * (high - low);
                for i in 0..3600 {
                    let angle = 2.0 * PI * f64::from(i) / 3600.0;
                    let p = DVec3::new(radius * libm::cos(angle), share * length, radius * libm::sin(angle));
                    assert!(encloses(&hull, DVec3::Y * length / 2.0, p), "{length} {radii:?}: {share} {i}");
                }
            }
            // However flat they are, hulls have an end.
            let farthest = hull.iter().flatten().map(|p| p.x.hypot(p.z)).fold(0.0, f64::max);
            assert!(farthest < 2.2 * low.max(high), "{farthest}");
        }
    }

    #[test]
    fn a_box_is_wider_by_a_millionth_of_its_longest_side() {
        let (low, high) = (Vec3::new(-2.0, -3.0, 1_048_576.0), Vec3::new(2.0, 7.0, 1_048_580.0));
        let wider = 10.0 * 1e-6 + 1_048_580.0 * 2.0_f64.powi(-40);
        let hull = box_between(low, high);
        let bounds = hull
            .iter()
            .flatten()
            .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], &p| [a.min(p), b.max(p)]);
        let more = [low.as_dvec3() - bounds[0], bounds[1] - high.as_dvec3()];
        assert!(more.iter().all(|more| (*more - wider).abs().max_element() < 1e-9), "{more:?}");
    }

    #[test]
    fn hulls_of_round_shapes_are_wider_at_both_ends() {
        let ends = |hull: Hull| {
            let along = hull.iter().flatten().map(|p| p.y);
            along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)])
        };
        let [low, high] = ends(outer(&Shape::cone(Vec3::ZERO, 2.0, Vec3::Y * 16.0, 1.0)).unwrap());
        // A millionth of the length and of the larger radius, and next to nothing for where it is.
        assert!((low + 18e-6).abs() < 1e-9 && (high - 16.0 - 18e-6).abs() < 1e-9, "{low} {high}");
        let disc = Shape::Disc(Disc { centre: Vec3::Y * 3.0, normal: Vec3::Y * 7.0, radius: 2.0 });
        let [low, high] = ends(outer(&disc).unwrap());
        assert!((low - 3.0 + 2e-6).abs() < 1e-9 && (high - 3.0 - 2e-6).abs() < 1e-9, "{low} {high}");
    }

    #[test]
    fn flat_ellipsoids_are_widened_for_the_rounding_of_their_longest_axis() {
        // 2^-40 of 1, over 2^-20.
        let thin = Shape::Ellipsoid(Ellipsoid {
            centre: Vec3::ZERO,
            axes: [Vec3::X, Vec3::Y, Vec3::Z * 2.0_f32.powi(-20)],
        });
        let unit: Hull = outer(&thin)
            .unwrap()
            .iter()
            .map(|t| t.map(|p| p * DVec3::new(1.0, 1.0, 2.0_f64.powi(20))))
            .collect();
        let [low, high] = faces(&unit, DVec3::ZERO);
        let scale = 1.0 + 1e-6 + 2.0_f64.powi(-20);
        assert!(is_about(low, scale) && is_about(high, scale), "{low} to {high}");
        assert_eq!(allowance(Vec3::ZERO), f64::MIN_POSITIVE);
    }
}

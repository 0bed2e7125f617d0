//! Flat polygons that stand for curved surfaces where these hide everything behind them (row 18 of the notes
//! on the 1986 paper).
//!
//! Every segment from the light to a point of such a polygon, or through one, passes through the surface: before
//! the polygon for those inside of a body, within [`margin`] of it for a disc. They are smaller than they could be
//! by a millionth, far more than the rounding of their corners; where that might not do, there is no polygon.

use super::shape::{Cone, Disc, Ellipsoid, Shape, Sphere};
use crate::geometry::LightPosition;
use glam::{DMat3, DVec3, Vec3};
use std::f64::consts::TAU;

/// Corners of the polygon in place of a circle.
const SIDES: usize = 12;

/// How much smaller polygons are than they could be.
const SMALLER: f64 = 1.0 - 1e-6;

/// The corners of a convex polygon, in their order; `None` if no such polygon is known.
pub(crate) fn polygon(shape: &Shape, light: LightPosition) -> Option<Vec<DVec3>> {
    match shape {
        Shape::Sphere(Sphere { centre, radius }) => {
            in_ball(*centre, DMat3::from_diagonal(DVec3::splat(f64::from(*radius))), light)
        }
        Shape::Ellipsoid(Ellipsoid { centre, axes }) => {
            let [x, y, z] = axes.map(Vec3::as_dvec3);
            in_ball(*centre, DMat3::from_cols(x, y, z), light)
        }
        Shape::Cone(cone) => in_cone(cone, light),
        Shape::Disc(disc) => in_disc(disc, light),
        Shape::Plane(_) | Shape::Quadric(_) => None,
    }
}

/// How far behind its polygon a surface may be.
pub(crate) fn margin(shape: &Shape) -> f64 {
    match shape {
        Shape::Disc(disc) => {
            1e-6 * (f64::from(disc.radius) + disc.centre.as_dvec3().abs().max_element() * 1e-3)
        }
        _ => 0.0,
    }
}

/// Whether coordinates around a centre are known well enough for shapes of some size.
fn is_precise(centre: Vec3, size: f64) -> bool {
    centre.as_dvec3().abs().max_element() < size * 1e6 && size > 1e-30 && size < 1e30
}

/// Points of a circle around the origin, across a unit vector.
fn circle(axis: DVec3, radius: f64) -> impl Iterator<Item = DVec3> {
    let (u, v) = axis.any_orthonormal_pair();
    (0..SIDES).map(move |i| {
        let angle = TAU * i as f64 / SIDES as f64;
        (u * libm::cos(angle) + v * libm::sin(angle)) * radius
    })
}

/// In the image of the unit ball under a linear map, moved to a centre: where the tangents from the light touch.
fn in_ball(centre: Vec3, map: DMat3, light: LightPosition) -> Option<Vec<DVec3>> {
    let longest = [map.x_axis, map.y_axis, map.z_axis].iter().map(|a| a.length()).fold(0.0, f64::max);
    let thinnest = map.determinant().abs() / (longest * longest);
    if !is_precise(centre, longest) || thinnest.is_nan() || thinnest < longest * 1e-3 {
        return None;
    }
    let inverse = map.inverse();
    let middle = centre.as_dvec3();
    // The light, or the direction to it, seen from the unit ball.
    let (axis, height, radius) = match light {
        LightPosition::At(light) => {
            let towards = inverse * (light.as_dvec3() - middle);
            let distance = towards.length();
            if distance.is_nan() || !(1.0 + 1e-5..1e9).contains(&distance) {
                return None;
            }
            (towards / distance, 1.0 / distance, (1.0 - 1.0 / (distance * distance)).sqrt())
        }
        LightPosition::Towards(direction) => {
            ((inverse * direction.as_dvec3().normalize()).normalize(), 0.0, 1.0)
        }
    };
    let place = |p: DVec3| middle + map * (p + axis * height) * SMALLER;
    Some(circle(axis, radius).map(place).collect())
}

fn in_disc(disc: &Disc, light: LightPosition) -> Option<Vec<DVec3>> {
    let (centre, radius) = (disc.centre.as_dvec3(), f64::from(disc.radius));
    let normal = disc.normal.as_dvec3().normalize();
    let towards = match light {
        LightPosition::At(light) => light.as_dvec3() - centre,
        LightPosition::Towards(direction) => direction.as_dvec3(),
    };
    // Seen too flat, the polygon and the disc are no longer the same within rounding.
    let far = matches!(light, LightPosition::Towards(_)) || towards.length() < radius * 1e6;
    let steep = normal.dot(towards).abs() > 1e-2 * towards.length();
    if !is_precise(disc.centre, radius) || !steep || !far {
        return None;
    }
    Some(circle(normal, radius * SMALLER).map(|p| centre + p).collect())
}

/// A quadrangle between two lines of the wall on the light's side. A segment that goes on from it towards the
/// light stays inside until it leaves through the wall, and not through an open end: it climbs at most as far
/// along the axis as it does on its way across the part of the body before the quadrangle.
fn in_cone(cone: &Cone, light: LightPosition) -> Option<Vec<DVec3>> {
    let base = cone.base.as_dvec3();
    let axis = cone.apex.as_dvec3() - base;
    let length = axis.length();
    let axis = axis / length;
    let (r0, r1) = (f64::from(cone.base_radius), f64::from(cone.apex_radius));
    let widest = r0.max(r1);
    if !is_precise(cone.base, widest.min(length)) || widest > length * 1e4 || length > widest * 1e4 {
        return None;
    }
    let towards = match light {
        LightPosition::At(light) => light.as_dvec3() - base,
        LightPosition::Towards(direction) => direction.as_dvec3().normalize(),
    };
    let climb = towards.dot(axis);
    let across = towards - axis * climb;
    let distance = across.length();
    let side = across / distance;
    // The cosine of half the angle between the two lines: before the tangents.
    let cosine = match light {
        LightPosition::At(_) if distance < 1.05 * widest || distance > 1e6 * widest => return None,
        LightPosition::At(_) => (widest / distance).max(0.3),
        LightPosition::Towards(_) if distance < 1e-2 => return None,
        LightPosition::Towards(_) => 0.3,
    };
    // How far points are before the quadrangle's plane, across the axis: at most `depth` inside of the body.
    let depth = widest * (1.0 - cosine) * 1.01;
    let growth = (r1 - r0) / length;
    let [low, high] = match light {
        LightPosition::At(_) => {
            // The share of the way to the light that is spent inside, at most.
            let share = depth / (distance - (r0 + growth * climb) * cosine);
            if !(0.0..0.9).contains(&share) {
                return None;
            }
            let end = |end: f64| (end - share * climb) / (1.0 - share);
            [end(0.0).max(0.0), end(length).min(length)]
        }
        LightPosition::Towards(_) => {
            let rise = distance - growth * climb * cosine;
            if rise < 1e-2 {
                return None;
            }
            let shift = depth * climb / rise;
            [(-shift).max(0.0), (length - shift).min(length)]
        }
    };
    let (low, high) = (low + length * 1e-5, high - length * 1e-5);
    if low >= high {
        return None;
    }
    let aside = axis.cross(side) * (1.0 - cosine * cosine).sqrt();
    let corner = |along: f64, aside: DVec3| {
        let radius = (r0 + (r1 - r0) * along / length) * SMALLER;
        base + axis * along + (side * cosine + aside) * radius
    };
    Some(vec![corner(low, -aside), corner(low, aside), corner(high, aside), corner(high, -aside)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ExactPosition;
    use crate::geometry::LightSpace;
    use crate::geometry::curved::{Base, tests as shapes};
    use crate::geometry::occlusion::PreciseQuery;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        /// What lies behind a polygon, as the light sees it, is behind the surface.
        #[test]
        fn segments_through_a_polygon_meet_the_surface(
            shape in shapes::shape(),
            light in prop::array::uniform3(-6.0f32..6.0),
            is_far in any::<bool>(),
            weights in prop::array::uniform12(0.0f64..1.0),
            beyond in 1e-4f64..2.0,
        ) {
            let light = Vec3::from(light);
            let light = if is_far { LightPosition::Towards(light) } else { LightPosition::At(light) };
            let Some(polygon) = polygon(&shape, light) else { return Ok(()) };
            let sum: f64 = weights[..polygon.len()].iter().sum();
            prop_assume!(sum > 0.01);
            let inside: DVec3 = polygon.iter().zip(weights).map(|(p, w)| *p * (w / sum)).sum();
            let away = match light {
                LightPosition::At(light) => inside - light.as_dvec3(),
                LightPosition::Towards(direction) => -direction.as_dvec3(),
            };
            let behind = inside + away.normalize() * (beyond + margin(&shape));
            let point = behind.as_vec3();
            let space = LightSpace::new(light, (Vec3::splat(-9.0), Vec3::splat(9.0)));
            let query = PreciseQuery::new(&space, point.as_dvec3(), || ExactPosition::Bare(point));
            prop_assert!(query.meets(&shape, Base::Other).0.any());
        }
    }

    #[test]
    fn polygons_in_balls_lie_where_tangents_touch() {
        let (at, towards) = (|x: f32| LightPosition::At(Vec3::X * x), LightPosition::Towards(Vec3::X * 3.0));
        for (light, height, radius) in
            [(at(2.0), 0.5, 0.75_f64.sqrt()), (at(4.0), 0.25, 0.9375_f64.sqrt()), (towards, 0.0, 1.0)]
        {
            let corners = polygon(&Shape::sphere(Vec3::ZERO, 1.0), light).expect("a polygon");
            assert_eq!(corners.len(), SIDES);
            for (i, p) in corners.iter().enumerate() {
                let p = *p / SMALLER;
                assert!((p.x - height).abs() < 1e-12 && (p.y.hypot(p.z) - radius).abs() < 1e-12, "{p}");
                let next = corners[(i + 1) % SIDES] / SMALLER;
                let side = 2.0 * radius * (std::f64::consts::PI / SIDES as f64).sin();
                assert!((p.distance(next) - side).abs() < 1e-12);
            }
        }
        let axes = [Vec3::X * 4.0, Vec3::Y * 0.5, Vec3::Z * 2.0];
        let (centre, light) = (Vec3::new(1.0, 2.0, 3.0), LightPosition::At(Vec3::new(9.0, 2.0, 3.0)));
        for p in polygon(&Shape::Ellipsoid(Ellipsoid { centre, axes }), light).expect("a polygon") {
            let p = (p - centre.as_dvec3()) / SMALLER;
            assert!(
                (p.x - 2.0).abs() < 1e-12 && ((p.y / 0.5).hypot(p.z / 2.0) - 0.75_f64.sqrt()).abs() < 1e-12
            );
        }
    }

    #[test]
    fn polygons_end_a_millionth_before_the_surface() {
        let lights = [LightPosition::At(Vec3::X * 4.0), LightPosition::Towards(Vec3::X)];
        let shapes = [
            Shape::sphere(Vec3::ZERO, 2.0),
            Shape::Disc(Disc { centre: Vec3::ZERO, normal: Vec3::X, radius: 2.0 }),
            Shape::cylinder(Vec3::NEG_Y, Vec3::Y, 2.0),
        ];
        for shape in shapes {
            let is_round = !matches!(shape, Shape::Cone(_));
            for light in lights {
                for p in polygon(&shape, light).expect("a polygon") {
                    let radius = if is_round { p.length() } else { p.x.hypot(p.z) };
                    assert!((radius - 1.999_998).abs() < 1e-12, "{shape:?}: {radius}");
                }
            }
        }
    }

    #[test]
    fn balls_that_are_seen_too_closely_or_are_too_flat_have_no_polygon() {
        let has = |centre: Vec3, axes: [f32; 3], light: f32| {
            let axes = [Vec3::X * axes[0], Vec3::Y * axes[1], Vec3::Z * axes[2]];
            let light = LightPosition::At(centre + Vec3::X * light);
            polygon(&Shape::Ellipsoid(Ellipsoid { centre, axes }), light).is_some()
        };
        assert!(has(Vec3::ZERO, [1.0; 3], 1.0001) && !has(Vec3::ZERO, [1.0; 3], 1.000_001));
        assert!(has(Vec3::ZERO, [1.0; 3], 0.9e9) && !has(Vec3::ZERO, [1.0; 3], 1.1e9));
        assert!(has(Vec3::ZERO, [1.0, 1.0, 0.0011], 2.0) && !has(Vec3::ZERO, [1.0, 1.0, 0.0009], 2.0));
        assert!(has(Vec3::Y * 0.9e6, [1.0; 3], 2.0) && !has(Vec3::Y * 1.1e6, [1.0; 3], 2.0));
        // However large they are.
        assert!(
            has(Vec3::ZERO, [100.0, 100.0, 0.11], 200.0) && !has(Vec3::ZERO, [100.0, 100.0, 0.09], 200.0)
        );
    }

    #[test]
    fn coordinates_are_precise_up_to_a_millionth_of_the_size() {
        assert!(is_precise(Vec3::NEG_Y * 1.9e6, 2.0) && !is_precise(Vec3::NEG_Y * 2.1e6, 2.0));
        assert!(is_precise(Vec3::ZERO, 1.1e-30) && !is_precise(Vec3::ZERO, 0.9e-30));
        assert!(is_precise(Vec3::ZERO, 0.9e30) && !is_precise(Vec3::ZERO, 1.1e30));
    }

    #[test]
    fn polygons_in_discs_have_their_radius_and_are_not_seen_flat() {
        let disc = |centre: Vec3| Shape::Disc(Disc { centre, normal: Vec3::Y * 5.0, radius: 2.0 });
        let centre = Vec3::new(1.0, 2.0, -3.0);
        for p in polygon(&disc(centre), LightPosition::At(Vec3::new(1.0, 4.0, 0.0))).expect("a polygon") {
            let p = (p - centre.as_dvec3()) / SMALLER;
            assert!(p.y == 0.0 && (p.length() - 2.0).abs() < 1e-12);
        }
        assert!((margin(&disc(centre)) - 1e-6 * (2.0 + 3e-3)).abs() < 1e-18);
        assert_eq!(margin(&Shape::sphere(centre, 2.0)), 0.0);
        let is_seen = |light: LightPosition| polygon(&disc(centre), light).is_some();
        for height in [-1.0_f32, 1.0] {
            let towards = |height: f32| LightPosition::Towards(Vec3::new(3.0, height * 3.0, 0.0));
            let at = |height: f32| LightPosition::At(centre + Vec3::new(0.0, height * 3.0, 3.0));
            assert!(is_seen(towards(0.011 * height)) && !is_seen(towards(0.009 * height)));
            assert!(is_seen(at(0.011 * height)) && !is_seen(at(0.009 * height)));
        }
        let far = |distance: f32| LightPosition::At(centre + Vec3::Y * distance);
        assert!(is_seen(far(1.9e6)) && !is_seen(far(2.1e6)));
    }

    #[test]
    fn polygons_in_cones_end_before_segments_leave_through_an_open_end() {
        let corners = |radii: [f32; 2], light: LightPosition| {
            let cone = Shape::cone(Vec3::ZERO, radii[0], Vec3::Y * 10.0, radii[1]);
            polygon(&cone, light).map(|p| <[DVec3; 4]>::try_from(p).expect("a quadrangle"))
        };
        // The quadrangle is 0.3 of the radius before the axis, and at most 0.7 * 1.01 of the widest inside of the body.
        let aside = 0.91_f64.sqrt();
        let check = |radii: [f32; 2], light: LightPosition, [low, high]: [f64; 2]| {
            let found = corners(radii, light).expect("a polygon");
            // It is a little smaller, and ends a hundred-thousandth of the length before the ends.
            let (low, high) = (low + 1e-4, high - 1e-4);
            let radius = |y: f64| f64::from(radii[0]) + f64::from(radii[1] - radii[0]) * y / 10.0;
            let corner =
                |y: f64, z: f64| DVec3::new(0.3 * SMALLER * radius(y), y, aside * z * SMALLER * radius(y));
            let expected = [corner(low, 1.0), corner(low, -1.0), corner(high, -1.0), corner(high, 1.0)];
            for (p, q) in found.iter().zip(expected) {
                assert!((*p - q).abs().max_element() < 1e-9, "{p} and {q}");
            }
        };
        let (towards, at) = (
            |x: f32, y: f32| LightPosition::Towards(Vec3::new(x, y, 0.0)),
            |x: f32, y: f32| LightPosition::At(Vec3::new(x, y, 0.0)),
        );
        check([1.0; 2], towards(3.0, 0.0), [0.0, 10.0]);
        check([1.0; 2], towards(1.0, 1.0), [0.0, 10.0 - 0.707]);
        check([1.0; 2], towards(1.0, -2.0), [1.414, 10.0]);
        // Across the axis 1 less the growth of 0.1 a unit, times 0.3, for each that it climbs.
        let rise = 1.0 - 0.1 * 0.3;
        check([1.0, 2.0], towards(1.0, 1.0), [0.0, 10.0 - 1.414 / rise]);
        check([1.0; 2], at(4.0, 5.0), [0.0, 10.0]);
        let share = 0.707 / (4.0 - 0.3);
        check([1.0; 2], at(4.0, 20.0), [0.0, (10.0 - share * 20.0) / (1.0 - share)]);
        check([1.0; 2], at(4.0, -6.0), [share * 6.0 / (1.0 - share), 10.0]);
        let share = 1.414 / (8.0 - (2.0 - 0.1 * 15.0) * 0.3);
        check([2.0, 1.0], at(8.0, 15.0), [0.0, (10.0 - share * 15.0) / (1.0 - share)]);
        // From too near, from too far, along the axis, and through an open end alone.
        assert!(corners([1.0; 2], at(1.1, 5.0)).is_some() && corners([1.0; 2], at(1.04, 5.0)).is_none());
        assert!(corners([1.0; 2], at(0.9e6, 5.0)).is_some() && corners([1.0; 2], at(1.1e6, 5.0)).is_none());
        assert!(
            corners([1.0; 2], towards(0.1, 1.0)).is_some()
                && corners([1.0; 2], towards(0.009, 1.0)).is_none()
        );
        assert!(corners([1.0; 2], at(4.0, 80.0)).is_none());
        assert!(corners([1e-4, 0.9e-3], towards(1.0, 0.0)).is_none(), "a needle");
        assert!(corners([2e-3, 1e-3], towards(1.0, 0.0)).is_some());
        assert!(corners([2.0; 2], at(1.9e6, 5.0)).is_some() && corners([2.0; 2], at(2.1e6, 5.0)).is_none());
        // As flat as that it is no longer a body.
        assert!(
            corners([0.9e5; 2], towards(1.0, 0.0)).is_some()
                && corners([1.1e5; 2], towards(1.0, 0.0)).is_none()
        );
    }
}

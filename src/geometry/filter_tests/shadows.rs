//! Whether a triangle blocks a segment: planes, the f32 filter, the f64 stage, the exact one.

use super::cases;
use super::inputs::{Situation, situation};
use super::rational::{self as exact, Rational, is_within, rational, sign};
use crate::geometry::light_triangle::{Filtered, LightPoint, LightTriangle};
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::planes::{OrientedPlanes, orientation, oriented};
use crate::geometry::volume::{LightSegment, Volume};
use crate::geometry::{LightPosition, Sign};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// The exact values of the four planes of a triangle in the order of positive orientation: three edges, and its own.
fn plane_values(situation: &Situation, oriented: [Vec3; 3], p: &exact::Vector) -> [Rational; 4] {
    let light = situation.space.light();
    let [a, b, c] = oriented;
    let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| exact::edge(light, a, b, p));
    [ab, bc, ca, exact::height(&oriented, p)]
}

proptest! {
    #![proptest_config(cases(6000))]

    #[test]
    fn the_side_of_the_light_is_exact(s in situation()) {
        prop_assume!(s.is_finite());
        let of_light = match s.space.light() {
            LightPosition::At(light) => -exact::height(&s.corners, &exact::vector(light)),
            // Towards the light means against the normal that points away from it.
            LightPosition::Towards(direction) => {
                let [a, b, c] = s.corners.map(exact::vector);
                let n = exact::cross(&exact::minus(&b, &a), &exact::minus(&c, &a));
                -exact::dot(&n, &exact::vector(direction))
            }
        };
        prop_assert_eq!(orientation(s.space.light(), s.corners), sign(&of_light));
    }

    #[test]
    fn planes_are_within_their_bounds(s in situation()) {
        prop_assume!(s.is_finite());
        let (Some(p), Some(corners)) = (exact::point(&s.position), oriented(s.space.light(), s.corners)) else {
            return Ok(());
        };
        let query = PreciseQuery::new(&s.space, s.position.rounded(), || s.position);
        let planes = OrientedPlanes::new(&s.space, corners.map(Vec3::as_dvec3));
        let values = plane_values(&s, corners, &p);
        for (i, value) in values[..3].iter().enumerate() {
            let (found, bound) = query.edge_in_f64(corners.map(Vec3::as_dvec3), i);
            prop_assert!(is_within(found, bound, value), "edge {}: {:e} +- {:e}", i, found, bound);
            prop_assert_eq!(query.exact_edge(corners, i).sign(), sign(value));
            let (offset, bound) = planes.offsets[i];
            let of_origin = exact::edge(s.space.light(), corners[i], corners[(i + 1) % 3], &exact::vector(s.space.origin()));
            prop_assert!(is_within(-offset, bound, &of_origin));
        }
        let (found, bound) = query.height_in_f64(corners.map(Vec3::as_dvec3));
        prop_assert!(is_within(found, bound, &values[3]), "own: {:e} +- {:e}", found, bound);
        let (height, bound) = planes.height;
        prop_assert!(is_within(-height, bound, &exact::height(&corners, &exact::vector(s.space.origin()))));
    }

    #[test]
    fn f32_planes_are_within_the_slack_of_the_point(s in situation()) {
        prop_assume!(s.is_finite());
        let (Some(p), Some(corners)) = (exact::point(&s.position), oriented(s.space.light(), s.corners)) else {
            return Ok(());
        };
        let record = LightTriangle::new(&s.space, s.corners).expect("a light off the plane");
        let point = LightPoint::new(&s.space, s.position.rounded());
        let planes = OrientedPlanes::new(&s.space, corners.map(Vec3::as_dvec3));
        let exact = plane_values(&s, corners, &p);
        for (i, (plane, exact)) in planes.edges.iter().chain([&planes.own]).zip(&exact).enumerate() {
            let value = record.values(&point)[i];
            if value > point.slack {
                prop_assert_eq!(sign(exact), Sign::Positive, "plane {}", i);
            }
            if value < -point.slack {
                prop_assert_eq!(sign(exact), Sign::Negative, "plane {}", i);
            }
            // Offsets of planes far from the origin make room of their own, for signs only.
            let largest = plane.normal.abs().max_element();
            if record.offset[i] == 0.0 && value.is_finite() && largest > 0.0 {
                let scaled = exact / rational(largest);
                prop_assert!(is_within(f64::from(value), f64::from(point.slack), &scaled), "plane {}: {:e} +- {:e}", i, value, point.slack);
            }
        }
    }

    #[test]
    fn no_stage_of_a_triangle_contradicts_the_definition(s in situation()) {
        prop_assume!(s.is_finite());
        let Some(p) = exact::point(&s.position) else { return Ok(()) };
        let truth = exact::blocks(s.space.light(), &s.corners, &p);
        let rounded = s.position.rounded();
        let query = PreciseQuery::new(&s.space, rounded, || s.position);
        prop_assert_eq!(query.blocks(s.corners).0, truth);
        match LightTriangle::new(&s.space, s.corners).map(|t| t.classify(&LightPoint::new(&s.space, rounded))) {
            None | Some(Filtered::Clear) => prop_assert!(!truth),
            Some(Filtered::Blocks) => prop_assert!(truth),
            Some(Filtered::Undecided) => {}
        }
        if let Some(corners) = oriented(s.space.light(), s.corners) {
            prop_assert_eq!(query.blocks_exactly(corners), truth);
            if let Some(answer) = query.blocks_in_f64(corners) {
                prop_assert_eq!(answer, truth);
            }
        }
    }

    #[test]
    fn a_segment_through_an_edge_crosses_as_if_it_were_moved(s in situation()) {
        prop_assume!(s.is_finite());
        let Some(p) = exact::point(&s.position) else { return Ok(()) };
        let query = PreciseQuery::new(&s.space, s.position.rounded(), || s.position);
        let truth = oriented(s.space.light(), s.corners).is_some_and(|corners| {
            let [a, b, c] = corners;
            let is_inside = |(a, b): (Vec3, Vec3)| {
                let at = |p: &exact::Vector| exact::edge(s.space.light(), a, b, p);
                // Moved by (e, e^2, e^3): the value there, or the first of the three changes that is not zero.
                let moved = [0, 1, 2].map(|axis| {
                    let mut moved = p.clone();
                    moved[axis] = &moved[axis] + rational(1.0);
                    at(&moved) - at(&p)
                });
                let mut signs = [at(&p)].into_iter().chain(moved).map(|value| sign(&value));
                signs.find(|&sign| sign != Sign::Zero) == Some(Sign::Positive)
            };
            [(a, b), (b, c), (c, a)].into_iter().all(is_inside)
                && sign(&exact::height(&corners, &p)) == Sign::Positive
        });
        prop_assert_eq!(query.crosses(s.corners).0, truth);
    }

    #[test]
    fn points_are_correctly_rounded(s in situation()) {
        prop_assume!(s.is_finite());
        let Some(p) = exact::point(&s.position) else { return Ok(()) };
        let rounded: DVec3 = s.position.rounded();
        for (found, exact) in rounded.to_array().iter().zip(&p) {
            prop_assert!(exact::is_rounded(*found, exact), "{:e}", found);
        }
    }

    #[test]
    fn volumes_around_what_blocks_are_met(s in situation(), other in situation()) {
        prop_assume!(s.is_finite() && other.is_finite());
        let Some(p) = exact::point(&s.position) else { return Ok(()) };
        prop_assume!(exact::blocks(s.space.light(), &s.corners, &p));
        let segment = LightSegment::new(&s.space, s.position.rounded());
        let alone = Volume::around(s.corners.into_iter()).expect("three points");
        let both = Volume::around_volumes([alone, Volume::around(other.corners.into_iter()).expect("three points")].into_iter());
        for volume in [alone, both.expect("two volumes")] {
            prop_assert!(volume.may_be_met_by(&segment), "{:?}", volume);
        }
    }
}

//! What is told of a shape without a ray: names, boxes, balls, images under transforms, and what is no shape.

use super::segment::passes_by;
use super::shape::*;
use super::{Defect, RayStart};
use crate::geometry::ray_triangle::RayParameter;
use crate::geometry::{LightPosition, ROUNDOFF};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use std::f64::consts::FRAC_PI_3;

fn disc(centre: Vec3, normal: Vec3, radius: f32) -> Shape {
    Shape::Disc(Disc { centre, normal, radius })
}

fn quadric(low: Vec3, high: Vec3) -> Quadric {
    let second = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    Quadric { reference: Vec3::ONE, second, first: Vec3::new(7.0, 8.0, 9.0), constant: 10.0, low, high }
}

fn all() -> [Shape; 7] {
    let (p, q) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 2.0, 7.0));
    [
        Shape::sphere(p, 2.0),
        Shape::Ellipsoid(Ellipsoid {
            centre: p,
            axes: [Vec3::new(3.0, 0.0, 0.0), Vec3::new(4.0, 1.0, 0.0), Vec3::Z],
        }),
        Shape::cylinder(p, q, 2.0),
        Shape::cone(p, 2.0, q, 1.0),
        disc(p, Vec3::Z * 5.0, 2.0),
        Shape::Plane(InfinitePlane { point: p, normal: q }),
        Shape::Quadric(quadric(Vec3::NEG_ONE, Vec3::new(1.0, 3.0, 1.0))),
    ]
}

#[test]
fn every_kind_has_a_name_and_its_own_numbers() {
    let names = ["sphere", "ellipsoid", "cylinder", "cone", "disc", "plane", "quadric"];
    assert_eq!(all().map(|shape| shape.kind()), names);
    assert_eq!(all().map(|shape| shape.is_endless()), names.map(|name| name == "plane"));
    assert_eq!(all()[0].numbers(), [0.0, 1.0, 2.0, 3.0, 2.0]);
    assert_eq!(all()[3].numbers(), [2.0, 1.0, 2.0, 3.0, 2.0, 1.0, 2.0, 7.0, 1.0]);
    assert_eq!(all().map(|shape| shape.numbers().len()), [5, 13, 9, 9, 8, 7, 20]);
}

#[test]
fn boxes_and_balls_are_as_large_as_they_must_be() {
    let box_ = |low: [f32; 3], high: [f32; 3]| Some((Vec3::from(low), Vec3::from(high)));
    let expected = [
        box_([-1.0, 0.0, 1.0], [3.0, 4.0, 5.0]),
        // 5 is the root of 3 * 3 + 4 * 4.
        box_([-4.0, 1.0, 2.0], [6.0, 3.0, 4.0]),
        box_([-1.0, 0.0, 3.0], [3.0, 4.0, 7.0]),
        box_([-1.0, 0.0, 3.0], [3.0, 4.0, 7.0]),
        box_([-1.0, 0.0, 3.0], [3.0, 4.0, 3.0]),
        None,
        box_([-1.0, -1.0, -1.0], [1.0, 3.0, 1.0]),
    ];
    for (shape, expected) in all().iter().zip(expected) {
        assert_eq!(shape.bounds().is_some(), expected.is_some());
        if let (Some((low, high)), Some((from, to))) = (shape.bounds(), expected) {
            assert!(low.cmple(from).all() && high.cmpge(to).all(), "{shape:?}: {low} to {high}");
            assert!((low - from).abs().max(high - to).max_element() < 2e-6, "{shape:?}: {low} to {high}");
        }
    }
    // Half the squared edges of the box, and the sum of the squared axes.
    let expected = [
        Some(([1.0, 2.0, 3.0], 2.0)),
        Some(([1.0, 2.0, 3.0], 27.0_f64.sqrt())),
        Some(([1.0, 2.0, 5.0], 4.0)),
        Some(([1.0, 2.0, 5.0], 4.0)),
        Some(([1.0, 2.0, 3.0], 2.0)),
        None,
        Some(([0.0, 1.0, 0.0], 6.0_f64.sqrt())),
    ];
    for (shape, expected) in all().iter().zip(expected) {
        let found = shape.ball();
        assert_eq!(found.map(|(centre, _)| centre.to_array()), expected.map(|(centre, _)| centre));
        if let (Some((_, found)), Some((_, expected))) = (found, expected) {
            assert!((found - expected).abs() < 1e-12, "{shape:?}: {found}");
        }
    }
}

#[test]
fn even_transforms_keep_the_kind_and_uneven_ones_only_where_they_can() {
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, FRAC_PI_3);
    let even = DAffine3 { matrix3: turn * -2.0, translation: DVec3::new(1.0, 0.0, -1.0) };
    for shape in &all()[..6] {
        let image = shape.transformed(&even).unwrap();
        assert_eq!(image.kind(), shape.kind());
    }
    let place = |p: Vec3| even.transform_point3(p.as_dvec3()).as_vec3();
    let Ok(Shape::Cone(cone)) = all()[3].transformed(&even) else { panic!("a cone") };
    assert_eq!((cone.base, cone.apex), (place(Vec3::new(1.0, 2.0, 3.0)), place(Vec3::new(1.0, 2.0, 7.0))));
    assert!((cone.base_radius - 4.0).abs() < 1e-6 && (cone.apex_radius - 2.0).abs() < 1e-6);
    let Ok(Shape::Disc(image)) = all()[4].transformed(&even) else { panic!("a disc") };
    assert!((image.radius - 4.0).abs() < 1e-6);
    assert!((image.normal.as_dvec3() - -(turn * DVec3::Z)).length() < 1e-6);
    let Ok(Shape::Sphere(ball)) = all()[0].transformed(&even) else { panic!("a sphere") };
    assert!((ball.radius - 4.0).abs() < 1e-6);
    // Stretched along one axis, sheared, and flattened.
    let stretched = DMat3::from_diagonal(DVec3::new(1.0, 1.0, 3.0));
    let sheared = DMat3::from_cols(DVec3::X, DVec3::new(0.6, 0.8, 0.0), DVec3::Z);
    for matrix3 in [stretched, sheared, DMat3::ZERO] {
        let uneven = DAffine3 { matrix3, translation: DVec3::ZERO };
        assert!(all()[2..5].iter().all(|shape| shape.transformed(&uneven).is_err()), "{matrix3}");
        assert_eq!(all()[0].transformed(&uneven).unwrap().kind(), "ellipsoid");
    }
    let Ok(Shape::Ellipsoid(image)) =
        all()[0].transformed(&DAffine3 { matrix3: stretched, translation: DVec3::ZERO })
    else {
        panic!("an ellipsoid")
    };
    assert_eq!(image.axes, [Vec3::X * 2.0, Vec3::Y * 2.0, Vec3::Z * 6.0]);
}

#[test]
fn a_quadric_is_scaled_along_the_axes_alone() {
    let shape = Shape::Quadric(quadric(Vec3::NEG_ONE, Vec3::new(1.0, 3.0, 1.0)));
    let by = |scale: DVec3| DAffine3 { matrix3: DMat3::from_diagonal(scale), translation: DVec3::X };
    let Ok(Shape::Quadric(image)) = shape.transformed(&by(DVec3::new(2.0, -4.0, 8.0))) else {
        panic!("a quadric")
    };
    assert_eq!(image.second, [1.0 / 4.0, 2.0 / 16.0, 3.0 / 64.0, 4.0 / -8.0, 5.0 / -32.0, 6.0 / 16.0]);
    assert_eq!((image.first, image.constant), (Vec3::new(3.5, -2.0, 1.125), 10.0));
    assert_eq!((image.low, image.high), (Vec3::new(-1.0, -12.0, -8.0), Vec3::new(3.0, 4.0, 8.0)));
    assert_eq!(image.reference, Vec3::new(3.0, -4.0, 8.0));
    assert!(shape.transformed(&by(DVec3::new(2.0, 0.0, 8.0))).is_err());
    let turned = DAffine3 { matrix3: DMat3::from_rotation_z(0.1), translation: DVec3::ZERO };
    assert!(shape.transformed(&turned).is_err());
}

#[test]
fn what_is_no_surface_is_told_exactly() {
    assert!(all().iter().all(|shape| shape.defect().is_none()));
    let (p, tiny) = (Vec3::ONE, f32::from_bits(1));
    let next = p.with_x(1.0_f32.next_up());
    let degenerate = |shape: Shape| shape.defect() == Some(Defect::Degenerate);
    assert!(degenerate(Shape::sphere(p, 0.0)) && degenerate(Shape::sphere(p, -1.0)));
    assert!(!degenerate(Shape::sphere(p, tiny)));
    let ellipsoid =
        |z: f32| Shape::Ellipsoid(Ellipsoid { centre: p, axes: [Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, z)] });
    assert!(degenerate(ellipsoid(0.0)) && !degenerate(ellipsoid(tiny)) && !degenerate(ellipsoid(-tiny)));
    assert!(degenerate(Shape::cone(p, 1.0, p, 1.0)) && !degenerate(Shape::cone(p, 1.0, next, 1.0)));
    assert!(degenerate(Shape::cone(p, 0.0, next, 0.0)) && !degenerate(Shape::cone(p, 0.0, next, tiny)));
    assert!(degenerate(Shape::cone(p, 1.0, next, -1.0)) && degenerate(Shape::cone(p, -1.0, next, 1.0)));
    assert!(degenerate(disc(p, Vec3::ZERO, 1.0)) && degenerate(disc(p, Vec3::X, 0.0)));
    assert!(!degenerate(disc(p, Vec3::X * tiny, tiny)));
    assert!(degenerate(Shape::Plane(InfinitePlane { point: p, normal: Vec3::ZERO })));
    let flat = quadric(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0));
    assert!(degenerate(Shape::Quadric(flat)));
    let deep = Quadric { high: Vec3::ONE, ..flat };
    let linear = Quadric { second: [0.0; 6], ..deep };
    let even = Quadric { first: Vec3::ZERO, ..deep };
    assert!([deep, linear, even].into_iter().all(|q| !degenerate(Shape::Quadric(q))));
    assert!(degenerate(Shape::Quadric(Quadric { first: Vec3::ZERO, ..linear })));
    for bad in [f32::NAN, f32::INFINITY] {
        assert_eq!(Shape::sphere(p.with_y(bad), 1.0).defect(), Some(Defect::NonFinite));
    }
}

#[test]
fn lines_pass_by_a_ball_beyond_what_rounding_can_move_them() {
    let passes = |centre: f32, light: Vec3, point: DVec3| {
        let centre = Vec3::Z * centre;
        let light = LightPosition::At(light + centre);
        passes_by(&Shape::sphere(centre, 1.0), light, point + centre.as_dvec3())
    };
    // A billionth of the radius.
    let near = |y: f64| passes(0.0, Vec3::new(-2.0, 1.0, 0.0), DVec3::new(2.0, 2.0 * y - 1.0, 0.0));
    assert!(!near(1.0 + 0.9e-9) && near(1.0 + 1.2e-9) && !near(0.0) && near(-2.0));
    // Far away 1e-12 of both places, each 2^20.
    let far =
        |y: f64| passes(1_048_576.0, Vec3::new(-1024.0, 1.0, 0.0), DVec3::new(1024.0, 2.0 * y - 1.0, 0.0));
    let doubt = 2e-12 * 1_048_576.0 + 1e-12 * 1024.0;
    assert!(!far(1.0 + doubt * 0.97) && far(1.0 + doubt * 1.03));
    // The distance of the point from the ball alone.
    let long = |y: f64| passes(0.0, Vec3::new(-1e6, 1.0, 0.0), DVec3::new(1e6, 2.0 * y - 1.0, 0.0));
    let doubt = 1e-9 + 2e-12 * 1e6 + 1e-14 * 1e6 / 2.0;
    assert!(!long(1.0 + doubt * 0.97) && long(1.0 + doubt * 1.03));
    // A light beside the point: 1e-14 of the places, over their distance, at the distance of the ball.
    let step = 2.0_f64.powi(-6);
    let close = |y: f64| {
        let light = LightPosition::At(Vec3::new((8.0 + step) as f32, 0.0, 1_048_576.0));
        // Through this the line passes the middle at y, for all that rounding leaves of it.
        let slope = y / (8.0 + step);
        let point = DVec3::new(8.0, slope * step, 1_048_576.0);
        passes_by(&Shape::sphere(Vec3::Z * 1_048_576.0, 1.0), light, point)
    };
    let doubt = 2e-12 * 1_048_576.0 + 1e-14 * 1_048_576.0 * 8.0 / step;
    // The distance from the middle is y times the cosine of the slope.
    let at = |distance: f64| distance / (1.0 - (distance / (8.0 + step)).powi(2)).sqrt();
    assert!(!close(at(1.0 + doubt * 0.95)) && close(at(1.0 + doubt * 1.05)));
    let towards = LightPosition::Towards(Vec3::X);
    let parallel = |y: f64| passes_by(&Shape::sphere(Vec3::ZERO, 1.0), towards, DVec3::new(3.0, y, 0.0));
    assert!(!parallel(1.0 + 0.9e-9) && parallel(1.0 + 1.2e-9));
    assert!(!passes_by(&all()[5], towards, DVec3::X * 1e9), "a plane has no ball");
}

#[test]
fn a_start_on_a_triangle_is_known_as_well_as_is_derived() {
    // As of a hit: the height 8 within 128 roundoffs, the slope 4 within 4 (12 + 4).
    let corners = [Vec3::new(-1.0, -1.0, 18.0), Vec3::new(1.0, -1.0, 18.0), Vec3::new(0.0, 1.0, 18.0)];
    let RayParameter { value, error } = RayStart::on_triangle(Vec3::Z * 16.0, Vec3::Z, corners).rounded();
    assert_eq!(value, 2.0);
    let expected = ((128.0 + 2.0 * 64.0) / 4.0 + 2.0) * ROUNDOFF;
    assert!((error / expected - 1.0).abs() < 1e-9, "{} roundoffs", error / ROUNDOFF);
}

#[test]
fn boxes_reach_as_far_as_circles_across_any_axis() {
    // Across (3, 4, 0) / 5 a circle of radius 5 reaches 4, 3 and 5.
    let (low, high) = disc(Vec3::ZERO, Vec3::new(3.0, 4.0, 0.0), 5.0).bounds().unwrap();
    let reach = Vec3::new(4.0, 3.0, 5.0);
    assert!(
        (high - reach).abs().max_element() < 1e-5 && (low + reach).abs().max_element() < 1e-5,
        "{low} {high}"
    );
    assert!(high.cmpge(reach).all() && low.cmple(-reach).all());
}

#[test]
fn turns_of_any_size_keep_angles() {
    // Of 1e5 the squares are known within 1e-6: the tolerance grows with them.
    for size in [1e-5, 3.0, 1e5] {
        let turn = DMat3::from_axis_angle(DVec3::new(1.0, -2.0, 3.0).normalize(), 1.0) * size;
        let transform = DAffine3 { matrix3: turn, translation: DVec3::ZERO };
        let Ok(Shape::Disc(image)) = disc(Vec3::ZERO, Vec3::X, 2.0).transformed(&transform) else {
            panic!("{size}")
        };
        assert!((f64::from(image.radius) / (2.0 * size) - 1.0).abs() < 1e-6);
        let stretched =
            DAffine3 { matrix3: turn * DMat3::from_diagonal(DVec3::new(1.0, 1.0, 1.0 + 1e-8)), ..transform };
        assert!(disc(Vec3::ZERO, Vec3::X, 2.0).transformed(&stretched).is_err());
    }
}

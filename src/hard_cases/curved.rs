//! Cases of curved surfaces: touches, rims, and sizes that differ by much or by little.

use super::parts::{bare, behind, cuboid, neighbours, seen, steps, v, with_curved};
use super::{Expected, HardCase, Situation};
use crate::geometry::LightPosition;
use crate::geometry::curved::Shape;
use glam::Vec3;

pub(super) const CASES: &[HardCase] = &[
    HardCase::new(41, "a sphere touched within one ulp", touched_sphere),
    HardCase::new(42, "a radius of 1e-4 from 1e4 away, and one of 1e6 as ground", small_and_large),
    HardCase::new(43, "a ray along a cylinder's wall, and its rim", along_a_wall),
    HardCase::new(44, "a cone's apex, radii that differ by 1e-7 or are zero", cones),
];

fn touched_sphere() -> Vec<Situation> {
    let sun = LightPosition::Towards(Vec3::Y);
    let sphere = with_curved(&[], &[Shape::sphere(v(0.0, 2.0, 0.0), 5.0)]);
    // Whole numbers on the circle that the sun's rays touch.
    let circle = [
        (5.0, 0.0),
        (-5.0, 0.0),
        (0.0, 5.0),
        (0.0, -5.0),
        (3.0, 4.0),
        (-3.0, 4.0),
        (4.0, -3.0),
        (-4.0, -3.0),
    ];
    let (mut points, mut dark) = (Vec::new(), Vec::new());
    for point in circle.into_iter().flat_map(|(x, z)| neighbours(v(x, -6.0, z))) {
        // Squares of 24 bits are exact, and so is what the larger one lacks to 25.
        let [x, z] = [point.x, point.z].map(|c| f64::from(c.abs()));
        points.push(point);
        dark.push(25.0 - x.max(z).powi(2) >= x.min(z).powi(2));
    }
    let lamp = v(5.0, 8.0, 0.0);
    let line = [5.0f32.next_down(), 5.0, 5.0f32.next_up()];
    // A lamp straight above the touched point: the ray touches, or tips over to one side.
    let under: Vec<_> =
        line.iter().flat_map(|&x| [v(x, -4.0, 0.0), v(x, -100.0, 0.0), v(x, 1.0, 0.0)]).collect();
    let tipped = under.iter().map(|p| p.x <= 5.0).collect();
    vec![
        Situation::new("under a sun", sphere.clone(), sun, bare(points), Expected::Known(dark)),
        Situation::new("under a lamp", sphere, lamp, bare(under), Expected::Known(tipped)),
    ]
}

fn small_and_large() -> Vec<Situation> {
    let bead = with_curved(&[], &[Shape::sphere(Vec3::ZERO, 1e-4)]);
    let lamp = v(0.0, 1e4, 0.0);
    // The ray to a point at x passes the bead's middle at half of it.
    let places = [
        (0.0, true),
        (1e-4, true),
        (1.9e-4, true),
        (1.999e-4, true),
        (2.001e-4, false),
        (2.1e-4, false),
        (1e-2, false),
        (30.0, false),
    ];
    let (mut points, mut dark) = (Vec::new(), Vec::new());
    for (x, inside) in places.into_iter().flat_map(|(x, inside)| [(x, inside), (-x, inside)]) {
        points.extend([v(x, -1e4, 0.0), v(0.0, -1e4, x)]);
        dark.extend([inside; 2]);
    }
    let ground = Shape::sphere(v(0.0, -1e6, 0.0), 1e6);
    let places = || steps(-8, 8).flat_map(|x| steps(-8, 8).map(move |z| v(0.3 * x, 0.0, 0.3 * z)));
    let eye = v(1.0, 3.0, 2.0);
    let bald = with_curved(&[], &[ground]);
    let on_bald = seen(&bald, eye, places());
    let far = seen(
        &bald,
        v(0.0, 100.0, 0.0),
        steps(-8, 8).flat_map(|x| steps(-8, 8).map(move |z| v(100.0 * x, 0.0, 90.0 * z))),
    );
    let built = with_curved(
        &cuboid(v(-0.5, -0.25, -0.5), v(0.5, 1.0, 0.5)),
        &[ground, Shape::sphere(v(1.5, 0.75, 0.0), 0.5)],
    );
    let on_built = seen(&built, eye, places());
    vec![
        Situation::new("a bead", bead, lamp, bare(points), Expected::Known(dark)),
        Situation::new("bare ground", bald.clone(), v(0.0, 5.0, 0.0), on_bald, Expected::AllLit),
        Situation::new("bare ground to the horizon", bald, v(-700.0, 1.0, 300.0), far, Expected::AllLit),
        Situation::new("things on the ground", built, v(-2.0, 5.0, 1.5), on_built, Expected::AsTruth),
    ]
}

fn along_a_wall() -> Vec<Situation> {
    let pipe = || with_curved(&[], &[Shape::cylinder(Vec3::ZERO, v(0.0, 2.0, 0.0), 1.0)]);
    let sun = LightPosition::Towards(Vec3::Y);
    // What runs in the wall does not meet it, and the pipe is open at both ends.
    let xs = [-1.0, 1.0, 1.0f32.next_down(), 1.0f32.next_up(), 0.0, 0.5, 2.0];
    let straight = xs.into_iter().flat_map(|x| [v(x, -1.0, 0.0), v(0.0, -1.0, x), v(x, 0.5, 0.0)]);
    // From outside over the rim at (1, 2, 0) and down into the pipe.
    let light = v(2.0, 3.0, 0.0);
    let (mut points, mut dark) = (Vec::new(), Vec::new());
    for y in [-0.5, 0.0f32.next_down(), 0.0, 0.0f32.next_up(), 0.001, 0.5, 1.0f32.next_down(), 1.0] {
        // It passes the wall at a height of (3 + y) / 2, and from y = 1 it just meets the rim.
        points.push(v(0.0, y, 0.0));
        dark.push(f64::from(y) <= 1.0);
    }
    points.extend([1.0f32.next_up(), 1.001, 1.5].map(|y| v(0.0, y, 0.0)));
    dark.extend([false; 3]);
    let inside = steps(-3, 3).flat_map(|x| steps(-3, 3).map(move |z| v(0.2 * x, 1.0, 0.2 * z)));
    let rim = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.6, 0.8), (-0.8, 0.6)];
    let over = rim.into_iter().flat_map(|(x, z)| neighbours(behind(v(x, 2.0, z), v(0.25, 4.0, -0.5))));
    vec![
        Situation::new("along the wall", pipe(), sun, bare(straight), Expected::AllLit),
        Situation::new("over the rim", pipe(), light, bare(points), Expected::Known(dark)),
        Situation::new("inside, from the axis", pipe(), v(0.0, 9.0, 0.0), bare(inside), Expected::AllLit),
        Situation::new("around the rim", pipe(), v(0.25, 4.0, -0.5), bare(over), Expected::AsTruth),
    ]
}

fn cones() -> Vec<Situation> {
    let top = v(0.0, 2.0, 0.0);
    let pointed = || with_curved(&[], &[Shape::cone(Vec3::ZERO, 1.0, top, 0.0)]);
    let light = v(0.5, 4.0, 0.0);
    let at_apex = [0.25, 0.5, 1.0].into_iter().flat_map(|far| {
        let point = top + far * (top - light);
        neighbours(point)
    });
    let wide = v(4.0, 3.0, 0.0);
    // Straight through both walls, well below the apex.
    let through = [0.25, 0.5, 1.0, 1.25].map(|y| behind(v(0.0, y, 0.0), wide)).into_iter();
    let near = 1.0f32 + 1e-7;
    let almost = with_curved(&[], &[Shape::cone(Vec3::ZERO, 1.0, top, near)]);
    let around = steps(-9, 9).flat_map(|x| steps(-4, 4).map(move |z| v(0.25 * x, -0.5, 0.25 * z)));
    let sun = LightPosition::Towards(Vec3::Y);
    let radii = [0.999_999_9, 1.0, 1.000_000_1, 1.000_000_05, 0.5, 2.0];
    let straight = radii.into_iter().flat_map(|x| [v(x, -1.0, 0.0), v(0.0, -1.0, -x)]);
    let none = [
        Shape::sphere(v(0.0, 1.0, 0.0), 0.0),
        Shape::cone(Vec3::ZERO, 0.0, top, 0.0),
        Shape::cylinder(top, top, 1.0),
    ];
    let nothing = with_curved(&[], &none);
    let below = || steps(-4, 4).flat_map(|x| steps(-4, 4).map(move |z| v(0.25 * x, -1.0, 0.25 * z)));
    vec![
        Situation::new("an apex", pointed(), light, bare(at_apex), Expected::AsTruth),
        // Its own double root: a touch.
        Situation::new("the apex itself", pointed(), light, bare([behind(top, light)]), Expected::AllDark),
        Situation::new("through the walls", pointed(), wide, bare(through), Expected::AllDark),
        Situation::new(
            "radii that differ by 1e-7, a lamp",
            almost.clone(),
            light,
            bare(around),
            Expected::AsTruth,
        ),
        Situation::new("radii that differ by 1e-7, a sun", almost, sun, bare(straight), Expected::AsTruth),
        Situation::new("radii of zero", nothing, light, bare(below()), Expected::AllLit),
    ]
}

//! Curved surfaces of random scenes: on the lattice too, so that they touch each other and planes exactly.

use super::place::{Place, direction};
use super::recipe::Part;
use crate::geometry::curved::{Disc, Ellipsoid, InfinitePlane, Quadric, Shape};
use crate::random::Random;
use glam::{DVec3, Vec3};

/// A few surfaces of any kind.
pub fn part(place: &Place, random: &mut Random) -> Part {
    let shapes = (0..1 + random.below(3)).map(|_| shape(place, random));
    Part::curved(shapes.filter(|shape| shape.defect().is_none()).collect())
}

fn shape(place: &Place, random: &mut Random) -> Shape {
    let centre = place.lattice_point(random);
    let radius = |random: &mut Random| place.length(*random.pick(&[0.5, 1.0, 1.0, 2.0]));
    match random.below(8) {
        0..=2 => Shape::sphere(centre, radius(random)),
        3 => Shape::cylinder(centre, place.lattice_point(random), radius(random)),
        4 => {
            let radii = [0.0, 0.5, 1.0, 1.5];
            let [base, apex] = [(); 2].map(|()| place.length(*random.pick(&radii)));
            Shape::cone(centre, base, place.lattice_point(random), apex)
        }
        5 => Shape::Disc(Disc { centre, normal: direction(random).as_vec3(), radius: radius(random) }),
        6 => {
            let scale = place.size();
            let axes = std::array::from_fn(|_| (direction(random) * (0.5 * scale)).as_vec3());
            Shape::Ellipsoid(Ellipsoid { centre, axes })
        }
        _ if random.chance(0.3) => {
            Shape::Plane(InfinitePlane { point: centre, normal: direction(random).as_vec3() })
        }
        _ => quadric(place, random),
    }
}

/// Coefficients are whole numbers before the size comes in, which its squares would take out of range.
fn quadric(place: &Place, random: &mut Random) -> Shape {
    let mut whole = || (random.below(5) as f32) - 2.0;
    let second = std::array::from_fn(|_| whole());
    let first = Vec3::new(whole(), whole(), whole());
    let constant = whole();
    let (a, b) = (place.lattice(random), place.lattice(random));
    let (low, high) = (place.of(a.min(b) - DVec3::splat(0.5)), place.of(a.max(b) + DVec3::splat(0.5)));
    let length = place.length(1.0);
    let reference = place.lattice_point(random);
    Shape::Quadric(Quadric {
        reference,
        second,
        first: first * length,
        constant: constant * length * length,
        low,
        high,
    })
}

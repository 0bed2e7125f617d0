//! Points that rays are aimed at.

use super::super::parts::{Corners, with_curved};
use super::scenes::Stage;
use crate::geometry::Sign;
use crate::geometry::curved::{RayStart, Shape};
use crate::geometry::planes::orientation;
use crate::random::Random;
use crate::scene::Scene;
use crate::visibility::hierarchy::{Hierarchy, Ray};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// A point of an edge.
pub fn on_an_edge([a, b]: [Vec3; 2], random: &mut Random) -> DVec3 {
    let share = if random.unit() < 0.25 { 0.5 } else { random.unit() };
    a.as_dvec3().lerp(b.as_dvec3(), share)
}

/// All edges of triangles.
pub fn edges(triangles: &[Corners]) -> Vec<[Vec3; 2]> {
    triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect()
}

/// A point inside of a triangle, or near its edges.
pub fn inside(&[a, b, c]: &Corners, random: &mut Random) -> DVec3 {
    let (u, v) = (random.unit(), random.unit());
    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
    a.as_dvec3() + (b - a).as_dvec3() * u + (c - a).as_dvec3() * v
}

/// Edges between a triangle that shows the light its front and one that shows its back.
pub fn silhouettes(triangles: &[Corners], light: Vec3) -> Vec<[Vec3; 2]> {
    type Bits = [u32; 3];
    let bits = |p: Vec3| -> Bits { p.to_array().map(|x| (x + 0.0).to_bits()) };
    let mut signs: BTreeMap<[Bits; 2], ([Vec3; 2], Vec<Sign>)> = BTreeMap::new();
    for corners in triangles {
        let sign = orientation(light, *corners);
        for [a, b] in edges(&[*corners]) {
            let mut key = [bits(a), bits(b)];
            key.sort_unstable();
            signs.entry(key).or_insert_with(|| ([a, b], Vec::new())).1.push(sign);
        }
    }
    let turns = |(_, signs): &([Vec3; 2], Vec<Sign>)| signs.iter().any(|sign| *sign != signs[0]);
    signs.into_values().filter(turns).map(|(edge, _)| edge).collect()
}

/// A direction on a border of two cells of a cube of so many along an edge, or a corner of four.
pub fn border_direction(resolution: u32, random: &mut Random) -> DVec3 {
    let cells = f64::from(resolution);
    let border = |random: &mut Random| 2.0 * (random.unit() * (cells + 1.0)).floor() / cells - 1.0;
    let (first, corner) = (border(random), random.unit() < 0.25);
    let second = if corner { border(random) } else { random.signed() };
    turned([first, second, sign(random)], random)
}

/// A direction on a seam of two faces of a cube, or a corner of three.
pub fn seam_direction(random: &mut Random) -> DVec3 {
    let third = if random.unit() < 0.25 { sign(random) } else { random.signed() };
    turned([sign(random), sign(random), third], random)
}

fn sign(random: &mut Random) -> f64 {
    if random.unit() < 0.5 { -1.0 } else { 1.0 }
}

/// The axes in another order.
fn turned(mut coordinates: [f64; 3], random: &mut Random) -> DVec3 {
    coordinates.rotate_left((random.unit() * 3.0) as usize);
    if random.unit() < 0.5 {
        coordinates.swap(0, 1);
    }
    DVec3::from_array(coordinates)
}

/// So far away that it is among what is there, or beyond.
pub fn along(light: Vec3, direction: DVec3, stage: &Stage, random: &mut Random) -> DVec3 {
    light.as_dvec3() + direction * (stage.size() * (0.2 + 6.0 * random.unit()))
}

/// A curved surface alone, to find rays that touch it.
pub struct Alone {
    scene: Scene,
    centre: DVec3,
    reach: f64,
}

impl Alone {
    pub fn new(shape: &Shape) -> Option<Alone> {
        let (low, high) = shape.bounds()?;
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let scene = with_curved(&[], std::slice::from_ref(shape));
        Some(Alone { scene, centre: (low + high) * 0.5, reach: (high - low).length() })
    }

    /// A point on a ray from the light that just meets the surface, where the next ray beside it does not: a tangent,
    /// or one through a rim.
    pub fn tangent(&self, hierarchy: &Hierarchy, light: Vec3, random: &mut Random) -> Option<DVec3> {
        let to_centre = self.centre - light.as_dvec3();
        let aside = to_centre.any_orthogonal_vector().normalize() * random.signed()
            + to_centre.cross(to_centre.any_orthogonal_vector()).normalize() * random.signed();
        let aside = aside.normalize() * (2.0 * self.reach);
        let meets = |share: f64| {
            let direction = (to_centre + aside * share).as_vec3();
            hierarchy.first_hit(&Ray { origin: light, direction, start: RayStart::origin() }).is_some()
        };
        let (mut inside, mut outside) = (0.0, 1.0);
        if !meets(inside) || meets(outside) {
            return None;
        }
        for _ in 0..40 {
            let middle = 0.5 * (inside + outside);
            if meets(middle) { inside = middle } else { outside = middle }
        }
        Some(light.as_dvec3() + to_centre + aside * (0.5 * (inside + outside)))
    }

    pub fn hierarchy(&self) -> Hierarchy<'_> {
        Hierarchy::new(&self.scene)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tangent_is_where_a_ray_just_meets_a_ball() {
        let ball = Alone::new(&Shape::sphere(Vec3::new(0.5, 0.25, -0.5), 0.75)).unwrap();
        let light = Vec3::new(1.0, 3.0, 2.0);
        let hierarchy = ball.hierarchy();
        let mut random = Random::new(1);
        for _ in 0..100 {
            let aim =
                ball.tangent(&hierarchy, light, &mut random).expect("a ball has a tangent on each side");
            let (from, centre) = (light.as_dvec3(), DVec3::new(0.5, 0.25, -0.5));
            let ray = (aim - from).normalize();
            let nearest = from + ray * (centre - from).dot(ray);
            let distance = (centre - nearest).length();
            assert!((distance - 0.75).abs() < 1e-6, "{distance}");
        }
    }
}

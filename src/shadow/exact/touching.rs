//! Touching: does a segment that meets only boundaries slip past them, or do they close around it?
//!
//! Where the segment meets the boundary of a triangle, the triangle fills a wedge of the plane across the
//! segment: half of it at an edge, less at a corner. If the closed wedges at one point of the segment cover
//! the full turn, moving the segment a little still hits: the surface is tight there. Otherwise the segment
//! touches a silhouette or a rim.

use super::integer::{IntegerLight, IntegerVector, Meeting, Scale, cross, dot, meet, minus};
use super::point::{RelativePoint, scale_of};
use super::surd::{Field, Surd};
use crate::geometry::{ExactPosition, LightPosition};
use glam::Vec3;

/// A vector of numbers of one field.
type SurdVector = [Surd; 3];

/// Whether the triangles, all met on their boundaries only, leave a gap at each point where the segment
/// meets them.
pub fn leaves_a_gap(light: LightPosition, position: &ExactPosition, met: &[[Vec3; 3]]) -> bool {
    let scale = met.iter().fold(scale_of(position, light), |s, corners| s.finer(Scale::of(*corners)));
    let integer_light = IntegerLight::new(light, scale);
    let point = RelativePoint::new(position, &integer_light, scale);
    let mut groups: Vec<Place> = Vec::new();
    for &corners in met {
        let Meeting::Boundary(edges) = meet(light, corners, position) else { continue };
        let fraction = fraction_along(&integer_light, corners, &point, scale);
        let wedge = Wedge { edges };
        match groups.iter_mut().find(|place| place.fraction.equals(&fraction, &point.field)) {
            Some(place) => place.wedges.push(wedge),
            None => groups.push(Place { fraction, wedges: vec![wedge] }),
        }
    }
    let axis = match integer_light {
        IntegerLight::At(_) => [0, 1, 2]
            .map(|i| Surd { rational: point.rational[i].clone(), irrational: point.irrational[i].clone() }),
        IntegerLight::Towards(direction) => direction.map(Surd::from),
    };
    let turn = Turn { axis, field: &point.field };
    !groups.iter().any(|place| turn.is_covered_by(&place.wedges))
}

/// A point of the segment and what meets it there.
struct Place {
    fraction: Fraction,
    wedges: Vec<Wedge>,
}

/// numerator / denominator, which is not zero.
struct Fraction {
    numerator: Surd,
    denominator: Surd,
}

impl Fraction {
    fn equals(&self, other: &Fraction, field: &Field) -> bool {
        let one = field.product(&self.numerator, &other.denominator);
        let two = field.product(&other.numerator, &self.denominator);
        field.sign(&(&one - &two)) == 0
    }
}

/// Where the segment meets the plane of a triangle: for a light at a point, its share from there to the
/// point, otherwise how far from the point towards the light; up to a factor common to all planes.
fn fraction_along(light: &IntegerLight, corners: [Vec3; 3], point: &RelativePoint, scale: Scale) -> Fraction {
    let from = light.origin();
    let u = corners.map(|c| minus(&scale.point(c), &from));
    let normal = cross(&minus(&u[1], &u[0]), &minus(&u[2], &u[0]));
    let height = dot(&normal, &u[0]);
    let at_point = point.dot(&normal);
    match light {
        IntegerLight::At(_) => Fraction { numerator: Surd::from(height), denominator: at_point },
        IntegerLight::Towards(direction) => Fraction {
            numerator: &Surd::from(height * &point.w) - &at_point,
            denominator: Surd::from(dot(&normal, direction)),
        },
    }
}

/// The directions across the segment that stay on the triangle: those on the inner side of its edges here.
struct Wedge {
    edges: Vec<IntegerVector>,
}

/// The full turn about a segment.
struct Turn<'f> {
    axis: SurdVector,
    field: &'f Field,
}

impl Turn<'_> {
    /// Whether closed wedges leave no gap.
    fn is_covered_by(&self, wedges: &[Wedge]) -> bool {
        wedges
            .iter()
            .filter_map(|wedge| self.end(wedge))
            .all(|end| wedges.iter().any(|wedge| self.continues(wedge, &end)))
    }

    /// The ray at which a wedge ends in the counter-clockwise sense about the axis.
    fn end(&self, wedge: &Wedge) -> Option<SurdVector> {
        wedge.edges.iter().enumerate().find_map(|(k, edge)| {
            let ray = self.onwards(&edge.clone().map(Surd::from));
            let mut others = wedge.edges.iter().enumerate().filter(|(other, _)| *other != k);
            others.all(|(_, edge)| self.side(edge, &ray) >= 0).then_some(ray)
        })
    }

    /// Whether a wedge holds a ray and what follows it counter-clockwise.
    fn continues(&self, wedge: &Wedge, ray: &SurdVector) -> bool {
        let onwards = self.onwards(ray);
        wedge.edges.iter().all(|edge| match self.side(edge, ray) {
            0 => self.side(edge, &onwards) > 0,
            side => side > 0,
        })
    }

    /// Vector product of the axis and a vector.
    fn onwards(&self, v: &SurdVector) -> SurdVector {
        let product = |i: usize, j: usize| self.field.product(&self.axis[i], &v[j]);
        let minor = |i: usize, j: usize| &product(i, j) - &product(j, i);
        [minor(1, 2), minor(2, 0), minor(0, 1)]
    }

    /// The side of an edge that a ray points to.
    fn side(&self, edge: &IntegerVector, ray: &SurdVector) -> i32 {
        let product = |i: usize| ray[i].times(&edge[i]);
        self.field.sign(&(&(&product(0) + &product(1)) + &product(2)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same for a light above, near or infinitely far away: the points are straight below what they meet.
    fn gap(point: [f32; 3], met: &[[Vec3; 3]]) -> bool {
        let position = Vec3::from(point);
        let above = Vec3::new(position.x, position.y, 8.0);
        let [near, far] = [LightPosition::At(above), LightPosition::Towards(Vec3::Z)]
            .map(|light| leaves_a_gap(light, &ExactPosition::Bare(position), met));
        assert_eq!(near, far);
        near
    }

    #[test]
    fn the_edge_of_one_sheet_leaves_a_gap_and_a_shared_edge_does_not() {
        let left = [Vec3::ZERO, Vec3::Y, Vec3::NEG_X];
        let right = [Vec3::ZERO, Vec3::Y, Vec3::X];
        // Through (0, 1/2, 0), on both triangles' common edge.
        let below = [0.0, 0.5, -8.0];
        assert!(gap(below, &[left]));
        assert!(!gap(below, &[left, right]));
        // Both on the same side: a fold, a silhouette.
        assert!(gap(below, &[left, [Vec3::ZERO, Vec3::Y, Vec3::new(-1.0, 0.0, 1.0)]]));
    }

    #[test]
    fn a_fan_of_four_closes_around_its_hub_and_three_of_them_do_not() {
        let rim = [Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Y];
        let fan: Vec<_> = (0..4).map(|i| [Vec3::ZERO, rim[i], rim[(i + 1) % 4]]).collect();
        assert!(!gap([0.0, 0.0, -1.0], &fan));
        assert!(gap([0.0, 0.0, -1.0], &fan[..3]));
    }

    #[test]
    fn half_sheets_at_different_depths_do_not_close_together() {
        let left = [Vec3::ZERO, Vec3::Y, Vec3::NEG_X];
        let lower = [Vec3::new(0.0, 0.0, -4.0), Vec3::new(0.0, 1.0, -4.0), Vec3::new(1.0, 0.0, -4.0)];
        assert!(gap([0.0, 0.5, -8.0], &[left, lower]));
    }
}

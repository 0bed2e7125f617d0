//! Triangles in intervals: the first stage, which decides most queries.

use super::integer::Meeting;
use super::interval::{self, Box3, Decided, cross, dot, minus};
use super::query::origin_of;
use crate::geometry::LightPosition;
use glam::Vec3;

/// The planes of a triangle in intervals, oriented away from the light.
#[derive(Debug, Clone)]
pub struct IntervalPlanes {
    /// Through the light and an edge, positive inside; `None` if the triangle's plane holds the light or
    /// intervals cannot tell, so that integers decide.
    edges: Option<[Box3; 3]>,
    normal: Box3,
    /// Corners relative to the origin.
    corners: [Box3; 3],
    /// Whether the planes of the edges hold the origin, as they do if that is the light.
    edges_through: EdgesThrough,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum EdgesThrough {
    Origin,
    Corners,
}

impl IntervalPlanes {
    /// The planes of a triangle relative to a light.
    pub fn new(light: LightPosition, corners: [Vec3; 3]) -> IntervalPlanes {
        let from = origin_of(light);
        let corner = corners.map(interval::point);
        let u = corner.map(|c| minus(&c, &from));
        let normal = cross(&minus(&corner[1], &corner[0]), &minus(&corner[2], &corner[0]));
        let (edges, away, edges_through) = match light {
            LightPosition::At(_) => {
                let edges = [cross(&u[0], &u[1]), cross(&u[1], &u[2]), cross(&u[2], &u[0])];
                (edges, dot(&normal, &u[0]), EdgesThrough::Origin)
            }
            LightPosition::Towards(direction) => {
                let direction = interval::point(direction);
                let edge = |i: usize, j: usize| cross(&minus(&corner[j], &corner[i]), &direction);
                ([edge(0, 1), edge(1, 2), edge(2, 0)], -dot(&normal, &direction), EdgesThrough::Corners)
            }
        };
        let turn = |v: Box3| v.map(|x| -x);
        let (edges, normal) = match away.decided() {
            Decided::Above => (Some(edges), normal),
            Decided::Below => (Some(edges.map(turn)), turn(normal)),
            Decided::Open => (None, normal),
        };
        IntervalPlanes { edges, normal, corners: u, edges_through }
    }

    /// How a point relative to the origin meets the triangle, as far as intervals decide; boundaries and
    /// ends are left to integers.
    pub fn meet(&self, point: &Box3) -> Option<Meeting> {
        let mut inside = true;
        for (edge, corner) in self.edges.as_ref()?.iter().zip(&self.corners) {
            let value = match self.edges_through {
                EdgesThrough::Origin => dot(edge, point),
                EdgesThrough::Corners => dot(edge, &minus(point, corner)),
            };
            match value.decided() {
                Decided::Below => return Some(Meeting::Misses),
                Decided::Above => {}
                Decided::Open => inside = false,
            }
        }
        match dot(&self.normal, &minus(point, &self.corners[0])).decided() {
            Decided::Below => Some(Meeting::Misses),
            Decided::Above if inside => Some(Meeting::Interior),
            _ => None,
        }
    }
}

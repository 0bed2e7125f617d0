//! The arbiter: truth about a shadow query, by exact arithmetic and nothing that it judges.
//!
//! It has its own interval arithmetic, its own integers, its own culling and its own first stage; it shares
//! only the definition of a query with the testers. [`plain`] is the same answer without any culling or
//! filter, for checking the arbiter itself.

mod hierarchy;
mod integer;
mod interval;
mod mask;
pub mod plain;
mod touching;
mod traced;

pub use integer::Meeting;
pub use traced::Span;

use super::{Basis, BuildInput, Counters, ShadowTester, TesterEntry};
use crate::error::Result;
use crate::geometry::{ExactPosition, LightPosition};
use crate::scene::{PrimitiveIndex, Scene};
use crate::visibility::{PointSource, SurfacePoint};
use glam::Vec3;
use hierarchy::{Hierarchy, Visit};
use integer::{IntegerLight, LitTriangle, RelativePoint, Scale};
use interval::{Box3, Decided, cross, dot, minus};
use rayon::prelude::*;

/// `exact` in the registry.
pub const ENTRY: TesterEntry = TesterEntry {
    name: "exact",
    basis: Basis::Truth,
    build: &|input| Ok(Box::new(Arbiter::new(input))),
    expected_tests: |_, queries| 100.0 * queries,
};

/// The truth about one query.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Truth {
    /// Whether the light is hidden or seen.
    pub occlusion: Occlusion,
    /// Whether the query is on the edge between the two.
    pub contact: Contact,
}

/// Whether anything blocks the segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Occlusion {
    /// Nothing blocks.
    Lit,
    /// Something does.
    Occluded,
}

/// TRUTH, "Touching".
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contact {
    /// The segment passes through triangles or past them.
    Clear,
    /// It meets only boundaries that do not close around it, or it ends on a triangle outside the
    /// receiver's plane.
    Touching,
}

/// Decides every query of one light.
pub struct Arbiter<'a> {
    scene: &'a Scene,
    light: LightPosition,
    /// What casts.
    triangles: Vec<PrimitiveIndex>,
    hierarchy: Hierarchy,
    planes: Vec<IntervalPlanes>,
    /// Whether the light itself lies on a triangle.
    light_contact: Contact,
}

impl<'a> Arbiter<'a> {
    /// Prepares the hierarchy over all triangles that cast.
    pub fn new(input: &BuildInput<'a>) -> Arbiter<'a> {
        let scene = input.scene;
        let triangles: Vec<_> =
            (0..scene.triangles.len() as u32).filter(|&t| scene.object(t).shadowing.casts).collect();
        let corners: Vec<_> = triangles.iter().map(|&t| scene.corners(t)).collect();
        let hierarchy = Hierarchy::new(&corners);
        let planes = corners.par_iter().map(|&corners| IntervalPlanes::new(input.light, corners)).collect();
        let mut arbiter = Arbiter {
            scene,
            light: input.light,
            triangles,
            hierarchy,
            planes,
            light_contact: Contact::Clear,
        };
        arbiter.light_contact = arbiter.contact_of_light();
        arbiter
    }

    /// A light on a triangle is the end of every segment: seen from any other point it "ends on" it.
    fn contact_of_light(&self) -> Contact {
        let LightPosition::At(light) = self.light else { return Contact::Clear };
        let position = ExactPosition::Bare(light);
        let mut contact = Contact::Clear;
        self.hierarchy.walk(self.light, &interval::point(light), |t| {
            let corners = self.corners(t);
            // A direction off the triangle's plane decides whether the light lies on it.
            let directions = [Vec3::X, Vec3::Y, Vec3::Z].map(LightPosition::Towards);
            if directions.into_iter().any(|eye| integer::meet(eye, corners, &position) == Meeting::EndsOn) {
                contact = Contact::Touching;
            }
            Visit::Continue
        });
        contact
    }

    /// The corners of a triangle that casts.
    fn corners(&self, casting: u32) -> [Vec3; 3] {
        self.scene.corners(self.triangles[casting as usize])
    }

    /// A triangle that is met in a hole of its mask is missed.
    fn unless_a_hole(&self, meeting: Meeting, casting: u32, position: &ExactPosition) -> Meeting {
        let is_through = matches!(meeting, Meeting::Interior | Meeting::Boundary(_));
        let masked = self.scene.masked(self.triangles[casting as usize]).filter(|_| is_through);
        let Some(masked) = masked else { return meeting };
        let corners = self.corners(casting);
        let scale = integer::scale_of(position, self.light).finer(Scale::of(corners));
        let light = IntegerLight::new(self.light, scale);
        let point = RelativePoint::new(position, &light, scale);
        let triangle = LitTriangle::new(&light, corners, scale).expect("a triangle that is met");
        if mask::is_there(&masked, &triangle, &point) { meeting } else { Meeting::Misses }
    }

    /// Every triangle that casts and that the segment of a point meets, but for those in the receiver's own
    /// plane, in the order of their indices.
    pub fn meetings(&self, point: &SurfacePoint) -> Vec<(PrimitiveIndex, Meeting)> {
        let position = point.exact(self.scene);
        let absolute = absolute_box(&relative_box(&position, self.light), self.light);
        let receiver = point.primitive().map(|primitive| self.scene.corners(primitive));
        let mut found = Vec::new();
        self.hierarchy.walk(self.light, &absolute, |t| {
            let corners = self.corners(t);
            let meeting = self.unless_a_hole(integer::meet(self.light, corners, &position), t, &position);
            let is_own_plane = || receiver.is_some_and(|r| integer::is_coplanar(r, corners));
            if meeting != Meeting::Misses && !(meeting == Meeting::EndsOn && is_own_plane()) {
                found.push((self.triangles[t as usize], meeting));
            }
            Visit::Continue
        });
        found.sort_by_key(|(primitive, _)| *primitive);
        found
    }

    /// The truth about one point.
    pub fn decide(&self, point: &SurfacePoint) -> Truth {
        let position = point.exact(self.scene);
        let relative = relative_box(&position, self.light);
        let absolute = absolute_box(&relative, self.light);
        let receiver = match point.source {
            PointSource::Ray { primitive, .. } => Some(primitive),
            PointSource::OnCurved { .. } => todo!("points on curved surfaces"),
            PointSource::Bare => None,
        };
        let receiver_corners = receiver.map(|primitive| self.scene.corners(primitive));
        let mut passes_through = false;
        let mut boundaries = Vec::new();
        let mut ends_on = false;
        self.hierarchy.walk(self.light, &absolute, |t| {
            // The receiver lies in its own plane, where nothing blocks.
            if receiver == Some(self.triangles[t as usize]) {
                return Visit::Continue;
            }
            let corners = self.corners(t);
            let meeting = self.planes[t as usize]
                .meet(&relative)
                .unwrap_or_else(|| integer::meet(self.light, corners, &position));
            let meeting = self.unless_a_hole(meeting, t, &position);
            match meeting {
                Meeting::Misses => {}
                Meeting::Interior => {
                    passes_through = true;
                    return Visit::Stop;
                }
                Meeting::Boundary(_) => boundaries.push(corners),
                Meeting::EndsOn => {
                    ends_on |= !receiver_corners.is_some_and(|r| integer::is_coplanar(r, corners))
                }
            }
            Visit::Continue
        });
        let occluded = passes_through || !boundaries.is_empty();
        let touching = !passes_through
            && (ends_on
                || self.light_contact == Contact::Touching
                || (occluded && touching::leaves_a_gap(self.light, &position, &boundaries)));
        Truth {
            occlusion: if occluded { Occlusion::Occluded } else { Occlusion::Lit },
            contact: if touching { Contact::Touching } else { Contact::Clear },
        }
    }
}

/// What points are taken relative to in intervals: the light, or the origin.
fn origin_of(light: LightPosition) -> Box3 {
    match light {
        LightPosition::At(point) => interval::point(point),
        LightPosition::Towards(_) => interval::point(Vec3::ZERO),
    }
}

/// An interval box around the exact point minus the origin.
fn relative_box(position: &ExactPosition, light: LightPosition) -> Box3 {
    let light = origin_of(light);
    match *position {
        ExactPosition::OnCurved { .. } => todo!("points on curved surfaces"),
        ExactPosition::Bare(p) => minus(&interval::point(p), &light),
        ExactPosition::OnRay { origin, direction, triangle } => {
            let [a, b, c] = triangle.map(interval::point);
            let (o, d) = (interval::point(origin), interval::point(direction));
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            let t = dot(&normal, &minus(&a, &o)).divided_by(dot(&normal, &d));
            let start = minus(&o, &light);
            [0, 1, 2].map(|i| start[i] + t * d[i])
        }
    }
}

fn absolute_box(relative: &Box3, light: LightPosition) -> Box3 {
    let light = origin_of(light);
    [0, 1, 2].map(|i| relative[i] + light[i])
}

/// The planes of a triangle in intervals, oriented away from the light.
#[derive(Debug, Clone)]
struct IntervalPlanes {
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
    fn new(light: LightPosition, corners: [Vec3; 3]) -> IntervalPlanes {
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
    fn meet(&self, point: &Box3) -> Option<Meeting> {
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

impl ShadowTester for Arbiter<'_> {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        for (point, answer) in points.iter().zip(answers) {
            *answer = self.decide(point).occlusion == Occlusion::Occluded;
        }
        Ok(Counters::default())
    }

    fn bytes(&self) -> usize {
        self.planes.len() * size_of::<IntervalPlanes>() + self.hierarchy.bytes()
    }
}

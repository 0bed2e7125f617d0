//! `replay --json`: one query through every tester. Its keys are a contract; new ones may be added.

use crate::geometry::LightPosition;
use crate::scene::{Light, Primitive, Scene};
use crate::shadow::TracedRay;
use crate::verdict::Cause;
use crate::visibility::{PointSource, SurfacePoint};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The whole document. Floats are written so that they read back exactly.
#[derive(Debug, Clone, Serialize)]
pub struct Replay {
    /// The scene's name.
    pub scene: String,
    /// Column and row from the top left.
    pub pixel: [u32; 2],
    /// Image width and height in pixels.
    pub size: [u32; 2],
    /// The light.
    pub light: LightFacts,
    /// What the pixel is to the light; only queries have a truth and testers.
    pub status: Status,
    /// The camera's ray.
    pub ray: RayFacts,
    /// The triangle that it sees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub primitive: Option<PrimitiveFacts>,
    /// The exact surface point, each coordinate correctly rounded to f64.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point: Option<[f64; 3]>,
    /// Whether it is occluded, exactly; null if it is no query.
    pub truth: Option<bool>,
    /// Whether it is on the edge between the two.
    pub touching: bool,
    /// The triangles that its segment meets, exactly, at most [`Replay::MOST_MEETINGS`].
    pub meets: Vec<MeetingFacts>,
    /// Whether each tester says occluded.
    pub testers: BTreeMap<&'static str, bool>,
    /// What testers that trace float rays were asked.
    pub traced: BTreeMap<&'static str, TracedFacts>,
    /// Why Embree is wrong: its oracle, or else the first of its testers that is.
    pub cause: Option<Cause>,
    /// Why each wrong tester that traces float rays is wrong.
    pub causes: BTreeMap<&'static str, Cause>,
}

/// A pixel's part in a light's shadows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// It sees no surface.
    Background,
    /// Dark without a query: the surface faces away.
    FacingAway,
    /// Dark without a query: outside the cone of a spot light.
    OutsideCone,
    /// Lit without a query: the object receives no shadows.
    NotReceiving,
    /// A shadow query.
    Query,
}

/// A light by name and place.
#[derive(Debug, Clone, Serialize)]
pub struct LightFacts {
    /// The name.
    pub name: String,
    /// `point`, `spot` or `directional`.
    pub kind: &'static str,
    /// Position in world space, if it is at one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<[f32; 3]>,
    /// Direction towards it, if it is infinitely far away.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub towards: Option<[f32; 3]>,
}

/// A ray's start and direction.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct RayFacts {
    /// Start in world space.
    pub origin: [f32; 3],
    /// Direction, not normalised.
    pub direction: [f32; 3],
}

/// A primitive in the papers' numbers.
#[derive(Debug, Clone, Serialize)]
pub struct PrimitiveFacts {
    /// Object m, from 1.
    pub object: u32,
    /// Its name.
    pub name: String,
    /// Surface n of the object, from 1.
    pub surface: u32,
    /// `triangle`, or the kind of a curved surface.
    pub kind: &'static str,
    /// The corners of a triangle in world space.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<[f32; 3]>,
    /// What defines a curved surface, in the order of its fields
    /// ([`Shape`](crate::geometry::curved::Shape)).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub numbers: Vec<f32>,
}

/// A primitive that the segment meets.
#[derive(Debug, Clone, Serialize)]
pub struct MeetingFacts {
    /// The primitive.
    #[serde(flatten)]
    pub primitive: PrimitiveFacts,
    /// `interior`, `boundary` (an edge or vertex), or `end` (the point itself lies on it).
    pub at: &'static str,
}

/// A tester's own ray.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct TracedFacts {
    /// Start and direction.
    #[serde(flatten)]
    pub ray: RayFacts,
    /// Where it begins.
    pub t_near: f32,
    /// Where it ends; null is infinity.
    pub t_far: f32,
    /// Whether the triangle of the point is left out.
    pub receiver_excluded: bool,
}

impl LightFacts {
    /// A light of the scene.
    pub fn new(light: &Light) -> LightFacts {
        let (position, towards) = match light.position() {
            LightPosition::At(point) => (Some(point.to_array()), None),
            LightPosition::Towards(direction) => (None, Some(direction.to_array())),
        };
        LightFacts { name: light.name.clone(), kind: light.kind(), position, towards }
    }
}

impl PrimitiveFacts {
    /// A primitive of a scene.
    pub fn new(scene: &Scene, primitive: u32) -> PrimitiveFacts {
        let (object, surface) = scene.object_and_surface(primitive);
        let name = scene.object(primitive).name.clone();
        let (kind, vertices, numbers) = match scene.primitive(primitive) {
            Primitive::Triangle(corners) => {
                ("triangle", corners.iter().map(|corner| corner.to_array()).collect(), Vec::new())
            }
            // The first number tells the kind.
            Primitive::Curved(shape) => (shape.kind(), Vec::new(), shape.numbers()[1..].to_vec()),
        };
        PrimitiveFacts { object, name, surface, kind, vertices, numbers }
    }
}

impl TracedFacts {
    /// A tester's ray.
    pub fn new(ray: &TracedRay) -> TracedFacts {
        TracedFacts {
            ray: RayFacts { origin: ray.origin.to_array(), direction: ray.direction.to_array() },
            t_near: ray.t_near,
            t_far: ray.t_far,
            receiver_excluded: ray.excluded.is_some(),
        }
    }
}

impl RayFacts {
    /// The ray that a point was found with.
    pub fn of(point: &SurfacePoint) -> Option<RayFacts> {
        match point.source {
            PointSource::Ray { origin, direction, .. } | PointSource::OnCurved { origin, direction, .. } => {
                Some(RayFacts { origin: origin.to_array(), direction: direction.to_array() })
            }
            PointSource::Bare => None,
        }
    }
}

impl Replay {
    /// The most triangles that are listed.
    pub const MOST_MEETINGS: usize = 8;

    /// The same for people: every number in decimals that read back exactly, and its bits.
    pub fn text(&self) -> String {
        let mut out = String::new();
        let [x, y] = self.pixel;
        let [width, height] = self.size;
        let _ = writeln!(out, "{}, pixel {x},{y} of {width}x{height}, light {}", self.scene, self.light.name);
        let place = match (self.light.position, self.light.towards) {
            (Some(position), _) => format!("at       {}", vector(position)),
            (None, towards) => format!("towards  {}", vector(towards.unwrap_or_default())),
        };
        let _ = writeln!(out, "  {} light", self.light.kind);
        let _ = writeln!(out, "    {place}");
        let _ = writeln!(out, "  camera ray");
        ray(&mut out, &self.ray);
        if let Some(primitive) = &self.primitive {
            let _ = writeln!(
                out,
                "  sees object {} `{}`, surface {}",
                primitive.object, primitive.name, primitive.surface
            );
            for corner in &primitive.vertices {
                let _ = writeln!(out, "    vertex   {}", vector(*corner));
            }
            if !primitive.numbers.is_empty() {
                let _ = writeln!(out, "    {}   {}", primitive.kind, numbers(&primitive.numbers));
            }
        }
        if let Some(point) = self.point {
            let _ = writeln!(out, "  exact point, rounded to f64");
            for value in point {
                let _ = writeln!(out, "    {value:?} ({:016x})", value.to_bits());
            }
        }
        match self.truth {
            None => {
                let _ = writeln!(out, "  no query: {}", self.status.words());
            }
            Some(truth) => self.verdicts(&mut out, truth),
        }
        out
    }

    fn verdicts(&self, out: &mut String, truth: bool) {
        let touching = if self.touching { ", touching" } else { "" };
        let _ = writeln!(out, "  truth: {}{touching}", answer(truth));
        for meeting in &self.meets {
            let p = &meeting.primitive;
            let place = match meeting.at {
                "interior" => "passes through",
                "boundary" => "passes through an edge or vertex of",
                _ => "begins on",
            };
            let _ = writeln!(
                out,
                "    the segment {place} object {} `{}`, surface {}",
                p.object, p.name, p.surface
            );
        }
        for (name, &occluded) in &self.testers {
            let verdict = match (occluded == truth, self.causes.get(name)) {
                (true, _) => String::new(),
                (false, None) => "   WRONG".into(),
                (false, Some(cause)) => format!("   WRONG by {}", cause.name()),
            };
            let _ = writeln!(out, "  {name:<14} {:<8}{verdict}", answer(occluded));
            if let Some(traced) = self.traced.get(name).filter(|_| occluded != truth) {
                ray(out, &traced.ray);
                let excluded = if traced.receiver_excluded { ", receiver excluded" } else { "" };
                let _ = writeln!(
                    out,
                    "    from t = {} to {}{excluded}",
                    number(traced.t_near),
                    number(traced.t_far)
                );
            }
        }
    }
}

impl Status {
    fn words(self) -> &'static str {
        match self {
            Status::Background => "the pixel sees no surface",
            Status::FacingAway => "the surface faces away from the light, so it is dark",
            Status::OutsideCone => "the point is outside the light's cone, so it is dark",
            Status::NotReceiving => "the object receives no shadows, so it is lit",
            Status::Query => "it was not asked",
        }
    }
}

fn answer(occluded: bool) -> &'static str {
    if occluded { "occluded" } else { "lit" }
}

fn ray(out: &mut String, ray: &RayFacts) {
    let _ = writeln!(out, "    from     {}", vector(ray.origin));
    let _ = writeln!(out, "    along    {}", vector(ray.direction));
}

fn vector(v: [f32; 3]) -> String {
    v.map(number).join("  ")
}

fn numbers(values: &[f32]) -> String {
    values.iter().copied().map(number).collect::<Vec<_>>().join("  ")
}

/// The shortest decimals that read back as the same float, and its bits.
fn number(value: f32) -> String {
    format!("{value:?} ({:08x})", value.to_bits())
}

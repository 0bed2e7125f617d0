//! Debian's Embree as oracle and as rival.
//!
//! It traces a float ray from the rounded point towards the light, as a renderer would, so part of its
//! error is the rounding of its input. `embree` is the oracle: a robust scene, the receiving primitive
//! excluded. `embree-fast` is the rival as renderers run it: a fast scene, no filter, nothing
//! between it and its speed. Every other [`EmbreeMode`] is a tester by its own name ([`MODES`]).
//!
//! The rays are made within the time that is taken, by the same code in the same portions for every mode.
//! Curved surfaces are a user geometry of Embree's, met by the same rays in double precision (`ffi/README.md`).
//! Transparent ones and transparent triangles block no ray.
//!
//! Each tester of the registry has a device and a scene of its own, so that what a mode takes to build is its own too.
//! Where a frame with several lights is timed, one scene serves all of them ([`Hierarchy`]).

mod casters;
mod hierarchy;

pub use hierarchy::{Hierarchy, Prepared};

use super::{
    Basis, Build, BuildInput, BuildOfScene, Counters, Crossings, Lights, SceneTester, ShadowTester,
    TesterEntry, TracedRay,
};
use crate::embree::{Device, EmbreeMode, EmbreeScene, QueryOptions, Receiver, ShadowRay};
use crate::error::Result;
use crate::float_environment::StandardFloats;
use crate::geometry::LightPosition;
use crate::visibility::{Points, RoundedPoint, SurfacePoint};
use casters::Casters;
use glam::Vec3;
use std::iter;
use std::sync::{Arc, LazyLock};

/// `embree` in the registry.
pub const ROBUST: TesterEntry = TesterEntry {
    name: "embree",
    basis: Basis::Measured,
    lights: Lights::All,
    build: &|input| Ok(Box::new(Embree::new(input, EmbreeMode::ORACLE)?)),
    of_scene: Some(&|input| Ok(Box::new(OfScene::new(input, EmbreeMode::ORACLE)?))),
    expected_tests,
};

/// `embree-fast` in the registry.
pub const FAST: TesterEntry = TesterEntry {
    name: "embree-fast",
    basis: Basis::Measured,
    lights: Lights::All,
    build: &|input| Ok(Box::new(Embree::new(input, EmbreeMode::RIVAL)?)),
    of_scene: Some(&|input| Ok(Box::new(OfScene::new(input, EmbreeMode::RIVAL)?))),
    expected_tests,
};

/// A tester for each mode of Embree, by the mode's name, in the order of [`EmbreeMode::all`].
pub static MODES: LazyLock<Vec<TesterEntry>> = LazyLock::new(|| EmbreeMode::all().map(entry).collect());

/// Name and closure are made once and live as long as the program, as those of any other entry do.
fn entry(mode: EmbreeMode) -> TesterEntry {
    let build: Box<Build> = Box::new(move |input| Ok(Box::new(Embree::new(input, mode)?)));
    let of_scene: Box<BuildOfScene> = Box::new(move |input| Ok(Box::new(OfScene::new(input, mode)?)));
    TesterEntry {
        name: mode.to_string().leak(),
        basis: Basis::Measured,
        lights: Lights::All,
        build: Box::leak(build),
        of_scene: Some(Box::leak(of_scene)),
        expected_tests,
    }
}

fn expected_tests(_casters: f64, queries: f64) -> f64 {
    10.0 * queries
}

/// A direction brought near length 1 by a power of two, if it is so long or short that Embree would refuse it
/// or lose it, and what it was divided by.
fn in_range(direction: Vec3) -> (Vec3, f32) {
    let largest = direction.abs().max_element();
    if !(largest > 0.0 && largest.is_finite()) || (1e-15..1e15).contains(&largest) {
        return (direction, 1.0);
    }
    // The exponent alone: a power of two, so that nothing is rounded but what underflows.
    let scale = f64::from_bits(f64::from(largest).to_bits() & 0x7ff0_0000_0000_0000);
    ((direction.as_dvec3() / scale).as_vec3(), scale as f32)
}

/// The epsilon that renderers usually give it, as a share of the segment (pbrt's shadow epsilon). Where the
/// light is infinitely far away, it is a share of the diameter of what casts, and at the near end only.
pub const USUAL_EPSILON: f32 = 1e-4;

/// Rays that are made and asked at a time, in every mode: so few that they stay in the first cache, and a multiple of
/// every packet's width.
const RAYS: usize = 256;

/// An Embree scene, and how its rays are asked under any light.
struct OfScene {
    hierarchy: Hierarchy,
    query: QueryOptions,
    epsilon: f32,
}

impl OfScene {
    fn new(input: &BuildInput, mode: EmbreeMode) -> Result<OfScene> {
        let _floats = StandardFloats::new();
        let device = Device::new(input.embree.threads)?;
        let hierarchy = Hierarchy::new(&device, &Prepared::new(input.scene)?, mode)?;
        Ok(OfScene { hierarchy, query: mode.query, epsilon: input.embree.epsilon })
    }
}

impl SceneTester for OfScene {
    fn under(&self, light: LightPosition) -> Box<dyn ShadowTester> {
        Box::new(self.hierarchy.at(light, self.epsilon, self.query))
    }

    fn bytes(&self) -> usize {
        self.hierarchy.bytes()
    }
}

/// An Embree scene and one light.
pub struct Embree {
    scene: Arc<EmbreeScene>,
    query: QueryOptions,
    light: LightPosition,
    epsilon: f32,
    casters: Arc<Casters>,
    receiver: Receiver,
    /// Length of the segments of a light infinitely far away that the epsilon is a share of.
    diameter: f32,
}

impl Embree {
    /// Builds Embree's hierarchy over everything that casts.
    ///
    /// # Errors
    /// A mode that this Embree lacks, or whatever it reports.
    pub fn new(input: &BuildInput, mode: EmbreeMode) -> Result<Embree> {
        let of_scene = OfScene::new(input, mode)?;
        Ok(of_scene.hierarchy.at(input.light, of_scene.epsilon, mode.query))
    }

    /// The ray for a point: not normalised, so that 1 is the light, unless that would be beyond Embree's range.
    /// `None` for a point whose rounding is the light itself, and for one beyond Embree's range, as planes without
    /// end have: no ray can ask for those.
    fn ray(&self, point: &RoundedPoint) -> Option<TracedRay> {
        let origin = Vec3::from(point.position);
        // Triangles and what ends are in range as a whole.
        if !point.is_bare() && !ShadowRay::is_in_range(point.position) {
            return None;
        }
        let (direction, t_near, t_far, t_light) = match self.light {
            LightPosition::At(light) => {
                let (direction, scale) = in_range(light - origin);
                (direction, self.epsilon * scale, (1.0 - self.epsilon) * scale, scale)
            }
            LightPosition::Towards(direction) => {
                let (direction, _) = in_range(direction);
                let t_near = self.epsilon * self.diameter / direction.length();
                (direction, t_near, f32::INFINITY, f32::INFINITY)
            }
        };
        let excluded = match self.receiver {
            Receiver::Excluded => point.primitive(),
            Receiver::Included => None,
        };
        let is_direction = direction != Vec3::ZERO && direction.is_finite();
        is_direction.then_some(TracedRay { origin, direction, t_near, t_far, t_light, excluded })
    }

    /// The rays for as many points as there is room for at most; an empty one where there is none.
    fn shadow_rays<'a>(
        &self,
        points: impl ExactSizeIterator<Item = RoundedPoint>,
        room: &'a mut [ShadowRay; RAYS],
    ) -> &'a [ShadowRay] {
        let rays = &mut room[..points.len()];
        for (ray, point) in rays.iter_mut().zip(points) {
            *ray = self.shadow_ray(&point).unwrap_or(ShadowRay::EMPTY);
        }
        rays
    }

    /// The same as Embree is told.
    fn shadow_ray(&self, point: &RoundedPoint) -> Option<ShadowRay> {
        let ray = self.ray(point)?;
        Some(ShadowRay {
            origin: ray.origin.to_array(),
            t_near: ray.t_near,
            direction: ray.direction.to_array(),
            t_far: ray.t_far,
            excluded: ray.excluded.map_or(ShadowRay::NO_PRIMITIVE, |p| self.casters.index_of(p)),
        })
    }

    /// Who is occluded, of points in any form that can be rounded.
    fn occluded_some<P>(
        &self,
        points: &[P],
        rounded: impl Fn(&P) -> RoundedPoint + Copy,
        answers: &mut [bool],
    ) -> Result<Counters> {
        let _floats = StandardFloats::new();
        let mut rays = [ShadowRay::EMPTY; RAYS];
        for (points, answers) in points.chunks(RAYS).zip(answers.chunks_mut(RAYS)) {
            let rays = self.shadow_rays(points.iter().map(rounded), &mut rays);
            self.scene.occluded(rays, self.query, answers)?;
        }
        Ok(Counters::default())
    }
}

impl ShadowTester for Embree {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        self.occluded_some(points, |point| point.into(), answers)
    }

    fn occluded_at(&self, points: Points<'_>, answers: &mut [bool]) -> Result<Counters> {
        self.occluded_some(points.rounded(), |&point| point, answers)
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        let _floats = StandardFloats::new();
        let (mut rays, mut found) = ([ShadowRay::EMPTY; RAYS], Vec::new());
        for points in points.chunks(RAYS) {
            let rays = self.shadow_rays(points.iter().map(RoundedPoint::from), &mut rays);
            self.scene.crossed(rays, self.query, &mut found)?;
            let mut rest = found.iter().peekable();
            for ray in 0..rays.len() as u32 {
                let of_ray = iter::from_fn(|| rest.next_if(|crossing| crossing.ray == ray));
                crossings.push(of_ray.flat_map(|crossing| {
                    let primitive = self.casters.primitive(crossing.primitive);
                    iter::repeat_n(primitive, crossing.times as usize)
                }));
            }
        }
        Ok(Counters::default())
    }

    fn bytes(&self) -> usize {
        self.scene.bytes()
    }

    fn traced_ray(&self, point: &SurfacePoint) -> Option<TracedRay> {
        let _floats = StandardFloats::new();
        self.ray(&point.into())
    }
}

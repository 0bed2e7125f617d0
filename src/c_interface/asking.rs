//! What the handles are of: a scene with what is found in it once, and a tester that is asked about points of it.

use super::pool::Pool;
use super::refusal::Refusal;
use super::{NO_TRIANGLE, Ray as GivenRay};
use crate::float_environment::InStandardFloats;
use crate::geometry::LightPosition;
use crate::geometry::curved::RayStart;
use crate::geometry::ray_triangle::hit_beyond;
use crate::measure::{Question, answer};
use crate::memory::MemoryLimit;
use crate::scene::{ObjectInput, PrimitiveIndex, Scene, SceneBuilder};
use crate::shadow::facing::{Facing, Sides};
use crate::shadow::{
    BuildInput, EmbreeSettings, Receivers, Resolution, SceneIndex, ShadowTester, TesterEntry, find,
};
use crate::visibility::SurfacePoint;
use crate::visibility::hierarchy::{Hierarchy, Ray};
use glam::Vec3;
use rayon::prelude::*;
use self_cell::self_cell;
use std::sync::{Arc, OnceLock};

/// A mesh as the caller has it.
pub struct MeshArrays<'a> {
    /// Positions in world space.
    pub vertices: &'a [[f32; 3]],
    /// Indices into them.
    pub triangles: &'a [[u32; 3]],
}

/// How a tester is built.
pub struct Choice {
    /// Its name.
    pub tester: String,
    /// The most that it may need.
    pub memory: MemoryLimit,
    /// Cells along a cube face.
    pub resolution: Resolution,
    /// Threads that build and answer; 0 is one for each processor.
    pub threads: u32,
    /// Where points may be.
    pub receivers: Receivers,
}

impl Default for Choice {
    fn default() -> Choice {
        Choice {
            tester: "auto".into(),
            memory: MemoryLimit::of_this_machine(),
            resolution: Resolution::Auto,
            threads: 0,
            receivers: Receivers::Anywhere,
        }
    }
}

/// What is said of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// Nothing blocks.
    Lit,
    /// Something does.
    Occluded,
    /// Dark without a question.
    FacesAway,
    /// There is no point.
    NoSurface,
}

/// A scene, and the caller's numbers of its triangles.
struct Numbered {
    scene: Scene,
    index: SceneIndex,
    /// The caller's number of each triangle, ascending: those without area are not in the scene.
    numbers: Vec<u32>,
    /// How many the caller has.
    given: u32,
}

/// The tree of boxes that rays go through, made for the first who asks for one.
#[derive(Default)]
struct Sight<'a>(OnceLock<Hierarchy<'a>>);

self_cell! {
    struct Seen {
        owner: Numbered,
        #[not_covariant]
        dependent: Sight,
    }
}

/// What `lightbuffer_scene` is.
pub struct Model(Seen);

impl Model {
    /// Puts meshes into one scene.
    ///
    /// # Errors
    /// [`Refusal::Argument`] for what is out of range or not finite, and for nothing at all.
    pub fn new(meshes: &[MeshArrays]) -> Result<Model, Refusal> {
        let mut builder = SceneBuilder::new("scene");
        let mut given = Vec::new();
        for (i, mesh) in meshes.iter().enumerate() {
            let wrong = |what: String| Refusal::Argument(format!("meshes[{i}]: {what}"));
            if let Some(v) = mesh.vertices.iter().position(|v| !Vec3::from(*v).is_finite()) {
                return Err(wrong(format!("vertex {v} is not finite")));
            }
            let out_of_range = |t: &[u32; 3]| t.iter().copied().find(|&v| v as usize >= mesh.vertices.len());
            let found =
                mesh.triangles.iter().enumerate().find_map(|(t, corners)| Some((t, out_of_range(corners)?)));
            if let Some((t, vertex)) = found {
                let count = mesh.vertices.len();
                return Err(wrong(format!("triangle {t} has vertex {vertex} of {count}")));
            }
            let room = |have: usize, more: usize| have.saturating_add(more) <= SceneBuilder::MAX_ELEMENTS;
            if !room(builder.vertex_count(), mesh.vertices.len()) || !room(given.len(), mesh.triangles.len())
            {
                return Err(wrong(format!("more than {} vertices or triangles", SceneBuilder::MAX_ELEMENTS)));
            }
            let first = builder.vertex_count() as u32;
            given.extend(mesh.triangles.iter().map(|t| t.map(|vertex| first + vertex)));
            let positions = mesh.vertices.iter().map(|&v| v.into()).collect();
            let object = ObjectInput::new(format!("mesh {i}"), positions, mesh.triangles.to_vec());
            builder.add_object(object).map_err(|e| wrong(e.to_string()))?;
        }
        let scene = builder.finish();
        if scene.triangles.is_empty() {
            let why = format!("a scene needs triangles; {} were given, and none has an area", given.len());
            return Err(Refusal::Argument(why));
        }
        // Those that are left are in their order, and two with the same vertices are both left or both gone.
        let mut left = scene.triangles.iter().map(|t| t.vertices).peekable();
        let number = |(number, corners): (u32, &[u32; 3])| left.next_if_eq(corners).map(|_| number);
        let numbers: Vec<u32> = (0..).zip(&given).filter_map(number).collect();
        assert_eq!(numbers.len(), scene.triangles.len(), "every triangle was given");
        let index = SceneIndex::new(&scene);
        let numbered = Numbered { scene, index, numbers, given: given.len() as u32 };
        Ok(Model(Seen::new(numbered, |_| Sight::default())))
    }

    /// Triangles that the caller has and the scene has not.
    pub fn dropped(&self) -> u64 {
        let Numbered { numbers, given, .. } = self.numbered();
        u64::from(*given) - numbers.len() as u64
    }

    /// The caller's numbers of the triangles that rays hit first.
    ///
    /// # Errors
    /// [`Refusal::Argument`] for a ray that is none.
    pub fn first_hits(&self, rays: &[GivenRay]) -> Result<Vec<Option<u32>>, Refusal> {
        check_rays(rays)?;
        let numbers = &self.numbered().numbers;
        let number = |hit: PrimitiveIndex| numbers[hit as usize];
        Ok(self.hits(rays).into_iter().map(|hit| hit.map(number)).collect())
    }

    fn numbered(&self) -> &Numbered {
        self.0.borrow_owner()
    }

    fn hits(&self, rays: &[GivenRay]) -> Vec<Option<PrimitiveIndex>> {
        self.0.with_dependent(|Numbered { scene, .. }, sight| {
            let hierarchy = sight.0.get();
            // Made outside of any lock: a thread that waits for others may come to want the same.
            let hierarchy = hierarchy.unwrap_or_else(|| {
                let made = Hierarchy::new(scene);
                sight.0.get_or_init(|| made)
            });
            let hit = |ray: &GivenRay| {
                let (origin, direction) = (ray.origin.into(), ray.direction.into());
                hierarchy.first_hit(&Ray { origin, direction, start: RayStart::origin() })
            };
            rays.par_iter().in_standard_floats().map(|ray| hit(ray).map(|hit| hit.primitive)).collect()
        })
    }

    /// The triangles of the scene that have these numbers of the caller's; each must be hit by its ray.
    fn given(&self, rays: &[GivenRay], triangles: &[u32]) -> Result<Vec<Option<PrimitiveIndex>>, Refusal> {
        let Numbered { scene, numbers, given, .. } = self.numbered();
        let find = |(i, (ray, &number)): (usize, (&GivenRay, &u32))| {
            if number == NO_TRIANGLE {
                return Ok(None);
            }
            let wrong = |what: String| Refusal::Argument(format!("triangles[{i}] is {number}, and {what}"));
            if number >= *given {
                return Err(wrong(format!("the scene has {given}")));
            }
            let place = numbers.binary_search(&number).map_err(|_| wrong("that has no area".into()))?;
            let primitive = place as PrimitiveIndex;
            let (origin, direction) = (ray.origin.into(), ray.direction.into());
            match hit_beyond(origin, direction, scene.corners(primitive), &RayStart::origin()) {
                Some(_) => Ok(Some(primitive)),
                None => Err(wrong(format!("rays[{i}] does not hit it"))),
            }
        };
        let all = rays.par_iter().zip(triangles).enumerate().in_standard_floats().map(find);
        // The first mistake is the one that is told, whichever thread finds one first.
        all.collect::<Vec<_>>().into_iter().collect()
    }
}

/// A tester, and what is known of each triangle for its light.
struct Built<'a> {
    tester: Box<dyn ShadowTester + 'a>,
    sides: OnceLock<Sides>,
}

self_cell! {
    struct BuiltFor {
        owner: Arc<Model>,
        #[covariant]
        dependent: Built,
    }
}

/// What `lightbuffer_tester` is.
pub struct Asked {
    built: BuiltFor,
    light: LightPosition,
    receivers: Receivers,
    pool: Arc<Pool>,
}

impl Asked {
    /// Builds a tester.
    ///
    /// # Errors
    /// [`Refusal::Argument`] for an unknown name or a light that is none; [`Refusal::Refused`] if it cannot be built.
    pub fn new(model: &Arc<Model>, light: LightPosition, choice: &Choice) -> Result<Asked, Refusal> {
        let entry = find(&choice.tester).map_err(|e| Refusal::Argument(e.to_string()))?;
        check_light(light, entry)?;
        let pool = Pool::of(choice.threads)?;
        let build = || {
            BuiltFor::try_new(Arc::clone(model), |model| {
                let Numbered { scene, index, .. } = model.numbered();
                let input = BuildInput {
                    resolution: choice.resolution,
                    receivers: choice.receivers,
                    memory: choice.memory,
                    embree: EmbreeSettings { threads: choice.threads as usize, ..EmbreeSettings::default() },
                    ..BuildInput::new(scene, index, light)
                };
                let tester = (entry.build)(&input)?;
                Ok(Built { tester, sides: OnceLock::new() })
            })
        };
        let built = pool.install(build).map_err(|e| Refusal::of(&e))?;
        Ok(Asked { built, light, receivers: choice.receivers, pool })
    }

    /// About points where rays hit triangles: those that have these numbers, or those that each ray hits first.
    ///
    /// # Errors
    /// [`Refusal::Argument`] for a ray that is none or does not hit its triangle; [`Refusal::Refused`] if the tester fails.
    pub fn on_rays(&self, rays: &[GivenRay], triangles: Option<&[u32]>) -> Result<Vec<Answer>, Refusal> {
        check_rays(rays)?;
        check_memory(rays.len())?;
        self.pool.install(|| {
            let (model, built) = (self.built.borrow_owner(), self.built.borrow_dependent());
            let hits = match triangles {
                Some(triangles) => model.given(rays, triangles)?,
                None => model.hits(rays),
            };
            let scene = &model.numbered().scene;
            let sides = built.sides.get().unwrap_or_else(|| {
                let found = Sides::of(scene, self.light);
                built.sides.get_or_init(|| found)
            });
            let look = |(ray, hit): (&GivenRay, &Option<PrimitiveIndex>)| match *hit {
                None => Err(Answer::NoSurface),
                Some(hit) => {
                    let point = SurfacePoint::on_ray(scene, ray.origin.into(), ray.direction.into(), hit);
                    match sides.facing(scene, &point) {
                        Facing::Towards => Ok(point),
                        Facing::Away | Facing::EdgeOn => Err(Answer::FacesAway),
                    }
                }
            };
            let looks: Vec<Result<SurfacePoint, Answer>> =
                rays.par_iter().zip(&hits).in_standard_floats().map(look).collect();
            let points: Vec<SurfacePoint> = looks.iter().filter_map(|look| look.ok()).collect();
            let mut asked = self.ask(&points)?.into_iter();
            let answer = |look: Result<_, Answer>| match look {
                Ok(_) => asked.next().expect("an answer for each question"),
                Err(known) => known,
            };
            Ok(looks.into_iter().map(answer).collect())
        })
    }

    /// About points in space.
    ///
    /// # Errors
    /// [`Refusal::Argument`] for one that is not finite; [`Refusal::Refused`] if the tester was built for surfaces, or fails.
    pub fn at_points(&self, points: &[[f32; 3]]) -> Result<Vec<Answer>, Refusal> {
        if self.receivers == Receivers::Surfaces {
            let why = "the tester was built for points on surfaces; build it for LIGHTBUFFER_ANYWHERE";
            return Err(Refusal::Refused(why.into()));
        }
        check_memory(points.len())?;
        let bare = |(i, &point): (usize, &[f32; 3])| {
            let point = SurfacePoint::bare(point.into());
            point.ok_or_else(|| Refusal::Argument(format!("points[{i}] is not finite")))
        };
        let points = points.iter().enumerate().map(bare).collect::<Result<Vec<_>, _>>()?;
        self.pool.install(|| self.ask(&points))
    }

    /// Memory that the tester keeps.
    pub fn bytes(&self) -> u64 {
        self.built.borrow_dependent().tester.bytes() as u64
    }

    fn ask(&self, points: &[SurfacePoint]) -> Result<Vec<Answer>, Refusal> {
        if points.is_empty() {
            return Ok(Vec::new());
        }
        let tester = self.built.borrow_dependent().tester.as_ref();
        let answers = answer(tester, points, Question::Occlusion, &|_| {}).map_err(|e| Refusal::of(&e))?;
        let answer = |occluded| if occluded { Answer::Occluded } else { Answer::Lit };
        Ok(answers.occluded.into_iter().map(answer).collect())
    }
}

fn check_light(light: LightPosition, entry: &TesterEntry) -> Result<(), Refusal> {
    let (vector, _) = light.homogeneous();
    if !vector.is_finite() {
        return Err(Refusal::Argument("light.vector is not finite".into()));
    }
    if matches!(light, LightPosition::Towards(Vec3::ZERO)) {
        return Err(Refusal::Argument("light.vector of a directional light is zero".into()));
    }
    if !entry.lights.has(light) {
        let why = format!("{} has no answer for lights that are infinitely far away", entry.name);
        return Err(Refusal::Refused(why));
    }
    Ok(())
}

fn check_rays(rays: &[GivenRay]) -> Result<(), Refusal> {
    let defect = |ray: &GivenRay| {
        let (origin, direction) = (Vec3::from(ray.origin), Vec3::from(ray.direction));
        match (origin.is_finite() && direction.is_finite(), direction == Vec3::ZERO) {
            (false, _) => Some("is not finite"),
            (true, true) => Some("has no direction"),
            (true, false) => None,
        }
    };
    match rays.iter().enumerate().find_map(|(i, ray)| Some((i, defect(ray)?))) {
        Some((i, defect)) => Err(Refusal::Argument(format!("rays[{i}] {defect}"))),
        None => Ok(()),
    }
}

/// What a point needs on its way, beside what testers make of it.
const POINT_BYTES: usize = 3 * size_of::<SurfacePoint>();

/// Points below which nobody asks for so much memory that there could be too little.
const FEW_POINTS: usize = 1 << 20;

fn check_memory(points: usize) -> Result<(), Refusal> {
    let needed = (points as u64).saturating_mul(POINT_BYTES as u64);
    if points <= FEW_POINTS || needed <= MemoryLimit::of_this_machine().left() {
        return Ok(());
    }
    let why = format!("{points} points would need {} MiB; ask about fewer at once", needed >> 20);
    Err(Refusal::Refused(why))
}

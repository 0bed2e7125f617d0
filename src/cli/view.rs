//! From options to a scene with lights, a camera and its visible points.

use super::options::{LightOptions, ViewOptions};
use super::progress::Messages;
use crate::error::{Error, Place, Result};
use crate::film::grouped;
use crate::memory::MemoryLimit;
use crate::scene::animation::Motion;
use crate::scene::formats::SceneFiles;
use crate::scene::{
    Animation, Camera, Falloff, FrameRate, Framing, ImageSize, Light, PointLight, Scene, formats, frame,
};
use crate::shading::{RayForest, ShadedPoint, TreeRules};
use crate::shadow::{Queries, REGISTRY};
use crate::visibility::{FirstHitMethod, FirstHits, SurfacePoint, VisibleSurfaces};
use glam::Vec3;

/// The size of an image where neither the options nor the camera say one.
const USUAL_SIZE: ImageSize = ImageSize { width: 1280, height: 720 };

/// A scene ready to be looked at.
pub struct View {
    /// The scene at rest, framed if it came without lights or camera.
    pub scene: Scene,
    /// What moves in it.
    pub motion: Motion,
    /// Frames a second, if the scene says so.
    pub rate: Option<FrameRate>,
    /// The camera that was chosen.
    pub camera: Camera,
    /// Of the image: what the options say, else the camera, else [`USUAL_SIZE`].
    pub size: ImageSize,
    /// What it was read from.
    pub files: SceneFiles,
    /// What was added to the scene to make it visible.
    pub added: Vec<String>,
}

impl View {
    /// Loads the scene and applies the options; says what it had to add or leave out.
    ///
    /// # Errors
    /// Whatever the loader finds, more memory than the limit, an unknown camera, or any warning under `--strict`.
    pub fn load(
        options: &ViewOptions,
        lights: &LightOptions,
        limit: MemoryLimit,
        messages: Messages,
    ) -> Result<View> {
        let (animation, files) = formats::load_with_files(&options.scene, limit)?;
        View::of(animation, files, options, lights, messages)
    }

    /// The same of a scene that is there already.
    ///
    /// # Errors
    /// As [`load`](View::load), but for the loader's.
    pub fn of(
        animation: impl Into<Animation>,
        files: SceneFiles,
        options: &ViewOptions,
        lights: &LightOptions,
        messages: Messages,
    ) -> Result<View> {
        let Animation { rest: mut scene, mut motion, rate } = animation.into();
        if let (true, Some(warning)) = (options.strict, scene.warnings.first()) {
            return Err(Error::input(&options.scene, Place::File, format!("{warning} (--strict)")));
        }
        for warning in &scene.warnings {
            messages.warn(warning);
        }
        if scene.primitive_count() == 0 {
            return Err(Error::input(&options.scene, Place::File, "the scene has no primitives to draw"));
        }
        let framing = if options.no_floor { Framing::WithoutFloor } else { Framing::WithFloor };
        let added = frame(&mut scene, framing)?;
        if !added.is_empty() {
            messages.say(&format!("the scene came without: added {}", added.join(", ")));
        }
        if replace_lights(&mut scene, lights)? == Replaced::All {
            motion.lights.clear();
        }
        let (camera, size) = aim(&scene.cameras, options)?;
        Ok(View { scene, motion, rate, camera, size, files, added })
    }

    /// The scene at rest as the camera sees it.
    pub fn shot(&self) -> Shot<'_> {
        let (lights, camera) = (self.scene.lights.clone(), self.camera.clone());
        Shot { scene: &self.scene, lights, camera, size: self.size }
    }

    /// As [`Shot::look`], at rest.
    ///
    /// # Errors
    /// As [`Shot::look`].
    pub fn look(&self, rules: LookRules, limit: MemoryLimit) -> Result<Seen> {
        self.shot().look(rules, limit)
    }
}

/// A size with so many samples a pixel along each side.
///
/// # Errors
/// If the image would have more pixels than one may have.
pub fn subdivided(size: ImageSize, samples: u32) -> Result<ImageSize> {
    let side = |pixels: u32| pixels.saturating_mul(samples);
    let size = ImageSize::checked(side(size.width), side(size.height), MOST_SAMPLES);
    size.map_err(|why| Error::Usage(format!("--subdivide {samples}: {why}")))
}

/// The camera that was chosen among those of a scene, and the size of its image.
///
/// # Errors
/// If there is no such camera.
pub fn aim(cameras: &[Camera], options: &ViewOptions) -> Result<(Camera, ImageSize)> {
    let camera = choose_camera(cameras, options.camera.as_deref())?;
    let size = options.size.or(camera.size).unwrap_or(USUAL_SIZE);
    Ok(if options.corner_rays { camera.through_corners(size) } else { (camera, size) })
}

/// One picture's worth of a scene: objects, which other pictures may share, under lights and before a camera of its own.
pub struct Shot<'s> {
    /// Objects and what they are made of. The lights and cameras that it holds are not looked at.
    pub scene: &'s Scene,
    /// The lights.
    pub lights: Vec<Light>,
    /// The camera.
    pub camera: Camera,
    /// The size of the image.
    pub size: ImageSize,
}

impl Shot<'_> {
    /// A hash of everything that shadows depend on, as [`Scene::hash`] is.
    pub fn hash(&self) -> u64 {
        self.scene.hash_under(&self.lights)
    }

    /// First hits, and the ray trees behind them.
    ///
    /// # Errors
    /// If the scene, the image with the masks of all lights, or the trees would need more memory than the limit.
    pub fn look(&self, rules: LookRules, limit: MemoryLimit) -> Result<Seen> {
        let lights = self.lights.len() as u64;
        let with_lights = if lights == 1 { "a light".into() } else { format!("{} lights", grouped(lights)) };
        let primitives = self.scene.primitive_count() as u64;
        let scene = format!("a scene of {} primitives", grouped(primitives));
        let limit = limit.beside(scene, primitives * PRIMITIVE_BYTES)?;
        let ImageSize { width, height } = self.size;
        let image = format!("an image of {width}x{height} pixels with {with_lights}");
        let pixels = self.size.pixels() as u64;
        let limit =
            limit.beside(image, pixels * PIXEL_BYTES + lights * (pixels * LIGHT_BYTES + BYTES_A_LIGHT))?;
        let trees = |nodes: u64| {
            let what = format!("ray trees of {} points with {with_lights}", grouped(nodes));
            limit.beside(what, nodes.saturating_sub(pixels) * (NODE_BYTES + lights * LIGHT_BYTES))
        };
        let hits = rules.first_hits.first_hits(self.scene, &self.camera, self.size);
        let visible = VisibleSurfaces::new(self.scene, &self.camera, &hits);
        let eye_rays = self.size.pixels() as u64;
        let room = |nodes: u64| trees(nodes).map(drop);
        let forest = RayForest::grow_within(self.scene, visible, eye_rays, rules.trees, &room)?;
        let memory = trees(forest.nodes.points.len() as u64)?;
        Ok(Seen { hits, forest, memory })
    }
}

/// The most samples of a picture: as many pixels as an image may have, sixteen times.
const MOST_SAMPLES: u64 = 1 << 28;

/// Bytes of a primitive: itself, what all lights share of it, the arbiter's hierarchy of it, and that of one tester
/// while it is built.
const PRIMITIVE_BYTES: u64 = 1536;

/// Bytes of a pixel: planes of the picture, its item in the t-buffer, its surface point and shading.
const PIXEL_BYTES: u64 =
    15 * size_of::<f32>() as u64 + 32 + size_of::<SurfacePoint>() as u64 + size_of::<ShadedPoint>() as u64;

/// Bytes of a pixel a light: its query and what arrives there, and a mask and a plane a tester.
const LIGHT_BYTES: u64 = size_of::<SurfacePoint>() as u64 + 4 + 12 + 5 * (REGISTRY.len() as u64 + 2);

/// Bytes of a light whatever the size of the image: its row of the table, and names of its channels.
const BYTES_A_LIGHT: u64 = 8192;

/// Bytes of a point in mirrors and behind glass: its ray before it is traced, itself, its share and its shading.
const NODE_BYTES: u64 = 256 + size_of::<SurfacePoint>() as u64 + size_of::<ShadedPoint>() as u64;

/// How a view is looked at.
#[derive(Debug, Clone, Copy)]
pub struct LookRules {
    /// Who finds first hits.
    pub first_hits: FirstHitMethod,
    /// How ray trees grow.
    pub trees: TreeRules,
}

impl LookRules {
    /// By the t-buffer, with all rays, so many one behind the other.
    pub fn usual(depth: u32) -> LookRules {
        LookRules { first_hits: FirstHitMethod::TBuffer, trees: TreeRules::of_depth(depth) }
    }
}

/// What the camera sees.
pub struct Seen {
    /// The primitive of every pixel.
    pub hits: FirstHits,
    /// The visible points, with those in mirrors and behind glass.
    pub forest: RayForest,
    /// What is left for testers.
    pub memory: MemoryLimit,
}

impl Seen {
    /// The queries of a light, in runs of so many pixels.
    pub fn queries(&self, scene: &Scene, light: &Light, pixels: u32) -> Queries {
        let RayForest { nodes, levels, .. } = &self.forest;
        Queries::new(scene, nodes, light).in_runs(nodes, levels, pixels)
    }
}

fn choose_camera(cameras: &[Camera], name: Option<&str>) -> Result<Camera> {
    let found = match name {
        None => cameras.first(),
        Some(name) => cameras.iter().find(|camera| camera.name == name),
    };
    found.cloned().ok_or_else(|| {
        let names: Vec<_> = cameras.iter().map(|c| c.name.as_str()).collect();
        Error::Usage(format!("no camera `{}`; the scene has: {}", name.unwrap_or(""), names.join(", ")))
    })
}

/// Which lights are there by options.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Replaced {
    /// None: they are the scene's.
    None,
    /// All of them.
    All,
}

/// Replaces the lights of the scene by those of `--light` or `--lights`, all of one strength: together as
/// bright at the scene's centre as the key light of a framed mesh.
fn replace_lights(scene: &mut Scene, options: &LightOptions) -> Result<Replaced> {
    // A scene that nothing in it bounds is looked at around the origin.
    let (low, high) = scene.bounds().unwrap_or((Vec3::NEG_ONE, Vec3::ONE));
    let centre = low * 0.5 + high * 0.5;
    let positions = match options.rig {
        Some(count) => ring(centre, (high - low).length() * 0.5, count),
        None => options.lights.clone(),
    };
    if positions.is_empty() {
        return Ok(Replaced::None);
    }
    let share = 3.0 / positions.len() as f32;
    let light = |(i, &position): (usize, &Vec3)| {
        let strength = (share * (position - centre).length_squared()).max(f32::MIN_POSITIVE);
        let point = PointLight { position, intensity: [strength; 3], falloff: Falloff::InverseSquare };
        Light::point(format!("light-{}", i + 1), point)
    };
    scene.lights = positions.iter().enumerate().map(light).collect();
    let is_finite = |l: &&Light| l.position().homogeneous().0.is_finite() && l.strength()[0].is_finite();
    match scene.lights.iter().find(|l| !is_finite(l)) {
        Some(light) => Err(Error::Usage(format!("{}: too far from the scene for 32-bit floats", light.name))),
        None => Ok(Replaced::All),
    }
}

/// Lights in a circle above the scene, the first one to the left in front.
fn ring(centre: Vec3, radius: f32, count: u32) -> Vec<Vec3> {
    let position = |i: u32| {
        let angle = std::f64::consts::TAU * (f64::from(i) / f64::from(count) + 0.35);
        let (sin, cos) = (libm::sin(angle) as f32, libm::cos(angle) as f32);
        centre + radius * Vec3::new(2.2 * cos, 2.6, 2.2 * sin)
    };
    (0..count).map(position).collect()
}

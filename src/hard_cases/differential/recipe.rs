//! What a random scene is made of, in pieces that can be taken away one by one.

use super::super::parts::Corners;
use crate::geometry::LightPosition;
use crate::geometry::curved::{RayStart, Shape};
use crate::scene::{
    Camera, DirectionalLight, Emitter, Falloff, Light, Material, Object, ObjectInput, PointLight, Scene,
    SceneBuilder, Shadowing, Transmission,
};
use crate::shadow::{
    BuildInput, Culling, EmbreeSettings, ObjectCoherence, Queries, Receivers, Resolution, SceneIndex,
    VolumeThreshold,
};
use crate::visibility::hierarchy::{Hierarchy, Ray};
use crate::visibility::{SurfacePoint, VisibleSurfaces};
use glam::Vec3;

/// A scene, a light, what is asked, and in which settings.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// Its objects.
    pub parts: Vec<Part>,
    /// Its only light.
    pub light: LightPosition,
    /// Who looks at it, for first hits.
    pub camera: Camera,
    /// Who is asked whether it sees the light.
    pub aims: Vec<Aim>,
    /// Each is tried.
    pub settings: Vec<Settings>,
}

/// An object.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its triangles; they share corners by their coordinates.
    pub triangles: Vec<Corners>,
    /// Its curved surfaces.
    pub shapes: Vec<Shape>,
    /// What it is made of.
    pub matter: Matter,
    /// Its part in shadows.
    pub shadowing: Shadowing,
}

/// What an object is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Matter {
    /// It blocks light.
    Opaque,
    /// It lets half of it through.
    Glass,
}

/// A point that is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// One in space.
    At(Vec3),
    /// What a ray hits first, if it hits anything.
    Seen {
        /// Where the ray begins.
        eye: Vec3,
        /// Its direction, not zero.
        direction: Vec3,
    },
}

/// How testers are built and asked. No answer depends on any of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// Cells along an edge of the light buffer.
    pub resolution: Resolution,
    /// What may be left out.
    pub culling: Culling,
    /// When lists of cells get bounding-volume records.
    pub bounding_volumes: VolumeThreshold,
    /// Whether the last occluder is tried first.
    pub object_coherence: ObjectCoherence,
    /// Where testers are told that points may be.
    pub receivers: Receivers,
    /// How many points are asked at a time.
    pub batch: Batch,
    /// Threads that testers may build with.
    pub threads: Threads,
}

/// How many points are asked at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Batch {
    /// All of them.
    All,
    /// Each by itself.
    One,
}

/// Threads that testers may build with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Threads {
    /// The one that asks.
    One,
    /// Two.
    Two,
}

/// A recipe followed.
pub struct Case {
    /// The scene, with the light and the camera in it.
    pub scene: Scene,
    /// The points that are queries: those that face the light, on objects that receive shadows.
    pub points: Vec<SurfacePoint>,
    /// Which of the recipe's aims each point comes from.
    pub aims: Vec<usize>,
}

impl Settings {
    /// Everything as usual, at one resolution, for points anywhere.
    pub fn plain(resolution: u32) -> Settings {
        Settings {
            resolution: Resolution::Cells(resolution),
            culling: Culling::Off,
            bounding_volumes: VolumeThreshold::Off,
            object_coherence: ObjectCoherence::Off,
            receivers: Receivers::Anywhere,
            batch: Batch::All,
            threads: Threads::One,
        }
    }

    /// What testers are built from. Whatever the settings say, points in space are allowed for where there are any.
    pub fn input<'a>(&self, case: &'a Case, index: &'a SceneIndex) -> BuildInput<'a> {
        let on_surfaces = case.points.iter().all(|point| point.primitive().is_some());
        BuildInput {
            resolution: self.resolution,
            culling: self.culling,
            bounding_volumes: self.bounding_volumes,
            object_coherence: self.object_coherence,
            receivers: if on_surfaces { self.receivers } else { Receivers::Anywhere },
            embree: EmbreeSettings { threads: 1, ..EmbreeSettings::default() },
            ..BuildInput::new(&case.scene, index, case.light().position())
        }
    }
}

impl Case {
    /// The light.
    pub fn light(&self) -> &Light {
        &self.scene.lights[0]
    }
}

impl Recipe {
    /// Makes the scene and the queries.
    pub fn case(&self) -> Case {
        let scene = self.scene();
        let hierarchy = Hierarchy::new(&scene);
        let aimed = self.aims.iter().enumerate().filter_map(|(number, aim)| {
            let point = match *aim {
                Aim::At(place) => SurfacePoint::bare(place)?,
                Aim::Seen { eye, direction } => {
                    let ray = Ray { origin: eye, direction, start: RayStart::origin() };
                    let hit = hierarchy.first_hit(&ray)?;
                    SurfacePoint::on_ray(&scene, eye, direction, hit.primitive)
                }
            };
            Some((point, number))
        });
        let (points, aims): (Vec<_>, Vec<_>) = aimed.unzip();
        let visible =
            VisibleSurfaces { seen: points.len(), pixels: (0..points.len() as u32).collect(), points };
        let queries = Queries::new(&scene, &visible, &scene.lights[0]);
        let aims = queries.nodes.iter().map(|&node| aims[node as usize]).collect();
        Case { points: queries.points, aims, scene }
    }

    fn scene(&self) -> Scene {
        let mut builder = SceneBuilder::new("random");
        let glass = self.parts.iter().any(|part| part.matter == Matter::Glass).then(|| {
            let transmission = Transmission { transmittance: [0.5; 3], refractive_index: 1.0 };
            let transmission = Some(transmission);
            builder.add_material(Material { name: "glass".into(), transmission, ..Material::default() })
        });
        for part in &self.parts {
            let corners = (0..part.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let input = ObjectInput::new("part", part.triangles.concat(), corners);
            let material = glass.filter(|_| part.matter == Matter::Glass).unwrap_or(0);
            let (curved, shadowing) = (part.shapes.clone(), part.shadowing);
            builder
                .add_object(ObjectInput { material, curved, shadowing, ..input })
                .expect("corners and materials that are there");
        }
        builder.add_light(lamp(self.light));
        builder.add_camera(self.camera.clone());
        builder.finish()
    }

    /// The recipe of a scene that was made by one, and read from a file. It has a light and a camera.
    pub fn of(scene: &Scene, aims: Vec<Aim>, settings: Settings) -> Option<Recipe> {
        let part = |object: &Object| {
            let triangles = object.first..object.first + object.count;
            let curved = object.first_curved as usize..(object.first_curved + object.curved_count) as usize;
            let passes = scene.materials[object.material as usize].transmission.is_some();
            Part {
                triangles: triangles.map(|triangle| scene.corners(triangle)).collect(),
                shapes: scene.curved[curved].iter().map(|curved| curved.shape).collect(),
                matter: if passes { Matter::Glass } else { Matter::Opaque },
                shadowing: object.shadowing,
            }
        };
        Some(Recipe {
            parts: scene.objects.iter().map(part).collect(),
            light: scene.lights.first()?.position(),
            camera: scene.cameras.first()?.clone(),
            aims,
            settings: vec![settings],
        })
    }

    /// Triangles and curved surfaces.
    pub fn primitives(&self) -> usize {
        self.parts.iter().map(|part| part.triangles.len() + part.shapes.len()).sum()
    }
}

impl Part {
    /// Triangles that block light, and cast and receive shadows.
    pub fn flat(triangles: Vec<Corners>) -> Part {
        Part { triangles, shapes: Vec::new(), matter: Matter::Opaque, shadowing: Shadowing::default() }
    }

    /// The same of curved surfaces.
    pub fn curved(shapes: Vec<Shape>) -> Part {
        Part { shapes, ..Part::flat(Vec::new()) }
    }

    /// The same, made of glass.
    pub fn of_glass(self) -> Part {
        Part { matter: Matter::Glass, ..self }
    }
}

fn lamp(light: LightPosition) -> Light {
    let emitter = match light {
        LightPosition::At(position) => {
            Emitter::Point(PointLight { position, intensity: [1.0; 3], falloff: Falloff::Constant })
        }
        LightPosition::Towards(towards) => {
            Emitter::Directional(DirectionalLight { towards, irradiance: [1.0; 3] })
        }
    };
    Light { name: "light".into(), emitter }
}

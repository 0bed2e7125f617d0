//! Truths that were found by hand, and the arbiter against the plain definition and against f64.

mod crossings;
mod curved;
mod flat;
mod on_curved;
mod random;

use super::plain::PlainTest;
use super::{Arbiter, Contact, Occlusion, Truth};
use crate::geometry::LightPosition;
use crate::geometry::curved::{Crossing, Shape};
use crate::scene::{Material, ObjectInput, PrimitiveIndex, Scene, SceneBuilder, Transmission};
use crate::shadow::{BuildInput, SceneIndex};
use crate::visibility::{PointSource, SurfacePoint};
use glam::{DVec3, Vec3};

const LIT: (Occlusion, Contact) = (Occlusion::Lit, Contact::Clear);
const LIT_TOUCHING: (Occlusion, Contact) = (Occlusion::Lit, Contact::Touching);
const OCCLUDED: (Occlusion, Contact) = (Occlusion::Occluded, Contact::Clear);
const OCCLUDED_TOUCHING: (Occlusion, Contact) = (Occlusion::Occluded, Contact::Touching);

/// Whether light passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Matter {
    Opaque,
    Glass,
}

/// A scene under construction.
struct World(SceneBuilder);

impl World {
    fn new() -> World {
        let mut builder = SceneBuilder::new("test");
        let transmission = Some(Transmission { transmittance: [0.5; 3], refractive_index: 1.0 });
        builder.add_material(Material { transmission, ..Material::default() });
        World(builder)
    }

    fn with(mut self, matter: Matter, triangles: &[[Vec3; 3]], curved: &[Shape]) -> World {
        let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let input = ObjectInput::new("object", triangles.concat(), indices);
        let material = if matter == Matter::Glass { 1 } else { 0 };
        self.0.add_object(ObjectInput { material, curved: curved.to_vec(), ..input }).unwrap();
        self
    }

    fn scene(self) -> Scene {
        let scene = self.0.finish();
        assert_eq!(scene.dropped.curved + scene.dropped.degenerate, 0);
        scene
    }
}

/// A scene of opaque curved surfaces.
fn curved(shapes: &[Shape]) -> Scene {
    World::new().with(Matter::Opaque, &[], shapes).scene()
}

fn bare(x: f32, y: f32, z: f32) -> SurfacePoint {
    SurfacePoint::bare(Vec3::new(x, y, z)).unwrap()
}

fn at(x: f32, y: f32, z: f32) -> LightPosition {
    LightPosition::At(Vec3::new(x, y, z))
}

fn towards(x: f32, y: f32, z: f32) -> LightPosition {
    LightPosition::Towards(Vec3::new(x, y, z))
}

/// A point on a curved surface. Only its source matters here.
fn on(primitive: PrimitiveIndex, origin: Vec3, direction: Vec3, crossing: Crossing) -> SurfacePoint {
    let source = PointSource::OnCurved { origin, direction, primitive, crossing };
    SurfacePoint { position: DVec3::ZERO, source }
}

/// A point on a triangle, straight below an origin.
fn below(primitive: PrimitiveIndex, x: f32, y: f32) -> SurfacePoint {
    let source = PointSource::Ray { origin: Vec3::new(x, y, 9.0), direction: Vec3::NEG_Z, primitive };
    SurfacePoint { position: DVec3::ZERO, source }
}

/// The arbiter's answer and what it says is crossed, after the plain test has said the same.
fn ask(scene: &Scene, light: LightPosition, point: SurfacePoint) -> (Truth, Vec<PrimitiveIndex>) {
    let index = SceneIndex::new(scene);
    let arbiter = Arbiter::new(&BuildInput::new(scene, &index, light));
    let plain = PlainTest::new(scene, light, &[point]);
    let (truth, crossed) = (arbiter.decide(&point), arbiter.crossed(&point));
    assert_eq!(truth.occlusion, plain.decide(&point), "{point:?} {light:?}");
    assert_eq!(crossed, plain.crossed(&point), "{point:?} {light:?}");
    (truth, crossed)
}

fn truth(scene: &Scene, light: LightPosition, point: SurfacePoint) -> (Occlusion, Contact) {
    let (truth, _) = ask(scene, light, point);
    (truth.occlusion, truth.contact)
}

fn crossed(scene: &Scene, light: LightPosition, point: SurfacePoint) -> Vec<PrimitiveIndex> {
    ask(scene, light, point).1
}

//! What belongs to the scene and not to one light, made once for all of them.

use super::Solids;
use super::certified::is_plain;
use super::duplicates::duplicates;
use crate::float_environment::{InStandardFloats, StandardFloats};
use crate::geometry::convexity::{self, Convexity};
use crate::geometry::{LightPosition, LightSpace, LightTriangle};
use crate::scene::{Object, PrimitiveIndex, Scene};
use glam::Vec3;
use rayon::prelude::*;
use std::collections::HashSet;
use std::sync::OnceLock;

/// What is cast, and which objects are convex. Each part is found when it is first asked for, so that nobody waits for what
/// their testers do without. All methods want the scene that the index was made of.
#[derive(Default)]
pub struct SceneIndex {
    casting: OnceLock<Vec<PrimitiveIndex>>,
    /// Curved surfaces that block light, exact duplicates once.
    pub curved: Vec<PrimitiveIndex>,
    /// Primitives of objects that cast which let light through and attenuate it.
    pub transparent: Vec<PrimitiveIndex>,
    bounds: OnceLock<(Vec3, Vec3)>,
    convexity: OnceLock<Vec<Option<Convexity>>>,
    solids: OnceLock<Solids>,
    beside_whole: OnceLock<Option<Box<SceneIndex>>>,
}

impl SceneIndex {
    /// Examines a scene.
    pub fn new(scene: &Scene) -> SceneIndex {
        let _floats = StandardFloats::new();
        let casts = |&p: &PrimitiveIndex| scene.object(p).shadowing.casts;
        let mut seen = HashSet::new();
        let curved: Vec<_> = (scene.triangles.len() as u32..scene.primitive_count())
            .filter(casts)
            .filter(|&p| !scene.is_transparent(p) && seen.insert(numbers(scene, p)))
            .collect();
        let transparent: Vec<_> = match scene.has_transparent_casters() {
            true => (0..scene.primitive_count()).filter(casts).filter(|&p| scene.is_transparent(p)).collect(),
            false => Vec::new(),
        };
        SceneIndex { curved, transparent, ..SceneIndex::default() }
    }

    /// Triangles that block light: of objects that cast, exact duplicates once unless they have holes (TRUTH,
    /// "Surface points and rays").
    pub fn casting(&self, scene: &Scene) -> &[PrimitiveIndex] {
        self.casting.get_or_init(|| {
            let duplicates = duplicates(scene, |t| is_plain(scene, t));
            (0..scene.triangles.len() as u32)
                .filter(|&t| blocks(scene, t) && !duplicates[t as usize])
                .collect()
        })
    }

    /// Lowest and highest corner of a box around all that casts and has an end; both zero if nothing does.
    pub fn bounds(&self, scene: &Scene) -> (Vec3, Vec3) {
        let all = || self.casting(scene).iter().chain(&self.curved).chain(&self.transparent);
        *self.bounds.get_or_init(|| bounds_of(scene, all()))
    }

    /// The space of a light over all that casts.
    pub fn light_space(&self, scene: &Scene, light: LightPosition) -> LightSpace {
        match light {
            LightPosition::At(point) => LightSpace::from(point),
            LightPosition::Towards(_) => LightSpace::new(light, self.bounds(scene)),
        }
    }

    /// For each object its verified convexity; that of objects with curved surfaces is not known.
    pub fn convexity(&self, scene: &Scene) -> &[Option<Convexity>] {
        let verify = |object: &Object| {
            if object.curved_count > 0 {
                return None;
            }
            let triangles = object.first..object.first + object.count;
            convexity::verify(&triangles.map(|t| scene.corners(t)).collect::<Vec<_>>())
        };
        let all = || -> Vec<_> { scene.objects.par_iter().in_standard_floats().map(verify).collect() };
        found::<Vec<_>>(&self.convexity, all)
    }

    /// The closed solids of the scene that this index was made of, found when they are first asked for.
    pub fn solids(&self, scene: &Scene) -> &Solids {
        found(&self.solids, || Solids::new(scene))
    }

    /// The same index without triangles that block light and have no holes; `None` if nothing else is cast.
    pub fn beside_whole_triangles(&self, scene: &Scene) -> Option<&SceneIndex> {
        let make = || {
            let has_holes = |&t: &PrimitiveIndex| blocks(scene, t) && !is_plain(scene, t);
            let casting: Vec<_> = match scene.alpha_masks.is_empty() {
                true => Vec::new(),
                false => (0..scene.triangles.len() as u32).filter(has_holes).collect(),
            };
            let is_empty = casting.is_empty() && self.curved.is_empty() && self.transparent.is_empty();
            let rest = || SceneIndex {
                casting: casting.into(),
                curved: self.curved.clone(),
                transparent: self.transparent.clone(),
                ..SceneIndex::default()
            };
            (!is_empty).then(|| Box::new(rest()))
        };
        self.beside_whole.get_or_init(make).as_deref()
    }
}

/// What is found with the help of other threads. Nobody waits for a lock meanwhile, since a thread that helps may come to ask for
/// the same; if two begin at once, one finds it in vain.
fn found<T>(place: &OnceLock<T>, find: impl FnOnce() -> T) -> &T {
    if let Some(found) = place.get() {
        return found;
    }
    let found = find();
    place.get_or_init(|| found)
}

/// Whether a triangle blocks light, at least where it is there.
fn blocks(scene: &Scene, triangle: PrimitiveIndex) -> bool {
    scene.object(triangle).shadowing.casts && !scene.is_transparent(triangle)
}

/// A box around primitives that have an end.
fn bounds_of<'p>(scene: &Scene, primitives: impl Iterator<Item = &'p PrimitiveIndex>) -> (Vec3, Vec3) {
    let join = |(low, high): (Vec3, Vec3), (l, h): (Vec3, Vec3)| (low.min(l), high.max(h));
    primitives.filter_map(|&p| scene.primitive_bounds(p)).reduce(join).unwrap_or_default()
}

/// The same for equal curved surfaces.
fn numbers(scene: &Scene, curved: PrimitiveIndex) -> Vec<u32> {
    let shape = scene.shape(curved).expect("a curved surface");
    shape.numbers().into_iter().map(|x| (x + 0.0).to_bits()).collect()
}

/// What casts as one light sees it: first triangles, without those whose plane holds the light, then curved
/// surfaces. The float filter leaves tests of the latter undecided, so that they need no path of their own.
pub struct Casters {
    /// Planes of each caster.
    pub planes: Vec<LightTriangle>,
    /// Its primitive in the scene.
    pub primitives: Vec<PrimitiveIndex>,
    /// What the planes are relative to.
    pub space: LightSpace,
}

impl Casters {
    /// All that casts, relative to a light.
    pub fn new(scene: &Scene, index: &SceneIndex, light: LightPosition) -> Casters {
        Casters::some(scene, index, light, index.casting(scene))
    }

    /// Some of the triangles that block, and all curved surfaces that do, relative to a light.
    pub fn some(
        scene: &Scene,
        index: &SceneIndex,
        light: LightPosition,
        casting: &[PrimitiveIndex],
    ) -> Casters {
        Casters::of(scene, index, light, casting, &index.curved)
    }

    /// All transparent primitives that cast, relative to a light.
    pub fn transparent(scene: &Scene, index: &SceneIndex, light: LightPosition) -> Casters {
        let first_curved = index.transparent.partition_point(|&p| !scene.is_curved(p));
        let (triangles, curved) = index.transparent.split_at(first_curved);
        Casters::of(scene, index, light, triangles, curved)
    }

    fn of(
        scene: &Scene,
        index: &SceneIndex,
        light: LightPosition,
        triangles: &[PrimitiveIndex],
        curved: &[PrimitiveIndex],
    ) -> Casters {
        let space = index.light_space(scene, light);
        let (mut planes, mut primitives): (Vec<_>, Vec<_>) = triangles
            .par_iter()
            .in_standard_floats()
            .filter_map(|&primitive| Some((LightTriangle::new(&space, scene.corners(primitive))?, primitive)))
            .unzip();
        planes.resize(planes.len() + curved.len(), LightTriangle::UNDECIDED);
        primitives.extend_from_slice(curved);
        Casters { planes, primitives, space }
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.planes.len() * (size_of::<LightTriangle>() + size_of::<PrimitiveIndex>())
    }
}

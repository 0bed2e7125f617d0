//! The nearest of several hits, by a rule that knows no order of objects.

use crate::geometry::curved::{Crossing, ExactParameter, RayStart};
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::ray_triangle::{self, RayParameter, RayTriangle};
use crate::geometry::{ExactPosition, LightPosition, LightSpace};
use crate::scene::{ImageSize, Primitive, PrimitiveIndex, Scene, Shadowing};
use glam::Vec3;
use std::cmp::Ordering;

/// The first primitive on the ray of every pixel, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstHits {
    /// Width and height of the image.
    pub size: ImageSize,
    /// One entry a pixel; `None` where the ray leaves the scene.
    pub primitives: Vec<Option<PrimitiveIndex>>,
    /// Ray-triangle tests that it took.
    pub tests: u64,
}

/// One buffer item of the 2004 paper: the object and its t.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hit {
    pub primitive: PrimitiveIndex,
    pub parameter: RayParameter,
    /// Of a curved surface, which of its points.
    pub crossing: Option<Crossing>,
}

impl Hit {
    /// Of a triangle.
    pub fn flat(primitive: PrimitiveIndex, parameter: RayParameter) -> Hit {
        Hit { primitive, parameter, crossing: None }
    }

    /// Where a ray hits a primitive, if it is a curved one.
    pub fn curved(
        scene: &Scene,
        primitive: PrimitiveIndex,
        origin: Vec3,
        direction: Vec3,
        start: &RayStart,
    ) -> Option<Hit> {
        let hit = scene.shape(primitive)?.first_hit(origin, direction, start)?;
        Some(Hit { primitive, parameter: hit.parameter, crossing: Some(hit.crossing) })
    }

    /// The place on its ray, exactly.
    fn exact_parameter(&self, scene: &Scene, origin: Vec3, direction: Vec3) -> ExactParameter {
        match scene.primitive(self.primitive) {
            Primitive::Triangle(corners) => ray_triangle::exact_parameter(origin, direction, corners),
            Primitive::Curved(shape) => {
                let crossing = self.crossing.expect("a hit of a curved surface has one");
                shape.exact_parameter(origin, direction, crossing)
            }
        }
    }
}

/// Whether a triangle is there where a ray hits it, and not a hole of its mask.
pub(crate) fn is_there(
    scene: &Scene,
    primitive: PrimitiveIndex,
    triangle: &RayTriangle,
    direction: Vec3,
) -> bool {
    scene.masked(primitive).is_none_or(|masked| {
        masked.is_there(triangle.texels(scene.corners(primitive), direction, &masked.axes()))
    })
}

/// The same for a ray from anywhere on its line.
pub(super) fn is_there_beyond(
    scene: &Scene,
    primitive: PrimitiveIndex,
    origin: Vec3,
    direction: Vec3,
) -> bool {
    scene.masked(primitive).is_none_or(|masked| {
        // The rest of the line towards a light infinitely far away passes through the same texel.
        let space = LightSpace::new(LightPosition::Towards(-direction), (origin, origin));
        let query = PreciseQuery::new(&space, origin.as_dvec3(), || ExactPosition::Bare(origin));
        masked.is_there(query.texels(scene.corners(primitive), &masked.axes()))
    })
}

/// Keeps the nearer of the stored and the new hit in `stored`.
///
/// Equal exact t is decided by the sorted coordinates of the corners, then by the content of the material
/// and the part in shadows (TRUTH, "Surface points and rays"): not by index, so that the picture does not depend
/// on the order of the objects. Where even those are equal the two cannot be told apart, and the first of the
/// scene is taken: a tree meets them in another order than a list does, and both should name the same.
pub(crate) fn keep_nearer(stored: &mut Option<Hit>, new: Hit, scene: &Scene, origin: Vec3, direction: Vec3) {
    let nearer = match stored {
        None => true,
        Some(old) => {
            let order = new.parameter.certain_order(old.parameter).unwrap_or_else(|| {
                let exact = |hit: &Hit| hit.exact_parameter(scene, origin, direction);
                exact(&new).order(&exact(old))
            });
            order.then_with(|| tie_order(scene, new.primitive, old.primitive)) == Ordering::Less
        }
    };
    if nearer {
        *stored = Some(new);
    }
}

fn tie_order(scene: &Scene, a: PrimitiveIndex, b: PrimitiveIndex) -> Ordering {
    // Triangles come first, as in the numbers of primitives.
    let numbers = |primitive| match scene.primitive(primitive) {
        Primitive::Triangle(corners) => {
            let mut corners = corners.map(|p| p.to_array());
            corners.sort_by(|p, q| p.partial_cmp(q).expect("finite"));
            (false, corners.concat())
        }
        Primitive::Curved(shape) => (true, shape.numbers()),
    };
    let material = |primitive| {
        let m = scene.material(primitive);
        (
            m.diffuse,
            m.specular,
            m.shininess,
            m.mirror,
            m.transmission.map(|t| (t.transmittance, t.refractive_index)),
        )
    };
    let shadowing = |primitive| {
        let Shadowing { casts, receives } = scene.object(primitive).shadowing;
        (casts, receives)
    };
    numbers(a)
        .partial_cmp(&numbers(b))
        .expect("finite")
        .then_with(|| material(a).partial_cmp(&material(b)).unwrap_or(Ordering::Equal))
        .then_with(|| shadowing(a).cmp(&shadowing(b)))
        .then_with(|| a.cmp(&b))
}

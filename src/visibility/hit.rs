//! The nearest of several hits, by a rule that knows no order of objects.

use crate::geometry::ray_triangle::{RayParameter, RayTriangle};
use crate::scene::{ImageSize, PrimitiveIndex, Scene};
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
pub(super) type Hit = (PrimitiveIndex, RayParameter);

/// Whether a triangle is there where a ray hits it, and not a hole of its mask.
pub(super) fn is_there(
    scene: &Scene,
    primitive: PrimitiveIndex,
    triangle: &RayTriangle,
    direction: Vec3,
) -> bool {
    scene.masked(primitive).is_none_or(|masked| {
        masked.is_there(triangle.texels(scene.corners(primitive), direction, &masked.axes()))
    })
}

/// Keeps the nearer of the stored and the new hit in `stored`.
///
/// Equal exact t is decided by the sorted coordinates of the corners, then by the content of the material
/// (TRUTH, "Surface points and rays"): never by index, so that the picture does not depend on the order of
/// the objects. Where even those are equal the two cannot be told apart, and the first stays.
pub(super) fn keep_nearer(stored: &mut Option<Hit>, new: Hit, scene: &Scene, origin: Vec3, direction: Vec3) {
    let nearer = match stored {
        None => true,
        Some(old) => {
            let order = new.1.certain_order(old.1).unwrap_or_else(|| {
                let prepare = |primitive| {
                    RayTriangle::new(origin, scene.corners(primitive)).expect("a triangle that was hit")
                };
                RayTriangle::exact_order(direction, &prepare(new.0), &prepare(old.0))
            });
            order.then_with(|| tie_order(scene, new.0, old.0)) == Ordering::Less
        }
    };
    if nearer {
        *stored = Some(new);
    }
}

fn tie_order(scene: &Scene, a: PrimitiveIndex, b: PrimitiveIndex) -> Ordering {
    let sorted = |primitive| {
        let mut corners = scene.corners(primitive).map(|p| p.to_array());
        corners.sort_by(|p, q| p.partial_cmp(q).expect("finite"));
        corners
    };
    let material = |primitive| {
        let m = scene.material(primitive);
        (m.diffuse, m.specular, m.shininess)
    };
    sorted(a)
        .partial_cmp(&sorted(b))
        .expect("finite")
        .then_with(|| material(a).partial_cmp(&material(b)).unwrap_or(Ordering::Equal))
}

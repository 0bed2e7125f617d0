//! One primitive against one segment, behind the float filter: what every exact native tester ends in.

use super::{Counters, Crossings, SceneIndex};
use crate::geometry::curved::Base;
use crate::geometry::occlusion::{PreciseQuery, Stage};
use crate::geometry::{ExactPosition, LightSpace};
use crate::scene::{Primitive, PrimitiveIndex, Scene};
use crate::visibility::SurfacePoint;

/// Whether a primitive blocks the open segment between a point on `base` and the light (TRUTH, "Occluded").
pub fn blocks<F: Fn() -> ExactPosition>(
    scene: &Scene,
    primitive: PrimitiveIndex,
    base: Option<PrimitiveIndex>,
    query: &PreciseQuery<F>,
    counters: &mut Counters,
) -> bool {
    let (blocks, stage) = match scene.primitive(primitive) {
        // A point is never strictly behind the plane that it lies in.
        Primitive::Triangle(corners) => query.blocks(corners),
        Primitive::Curved(shape) => {
            let (meetings, stage) = query.meets(shape, own_or_other(primitive, base));
            (meetings.any(), stage)
        }
    };
    counters.exact += u64::from(stage == Stage::Exact);
    blocks && is_there(scene, primitive, query)
}

/// How often the open segment crosses a transparent primitive, where what is on its edge is decided as for
/// segments that are turned a little (TRUTH, "Transparent").
pub fn crossings_of<F: Fn() -> ExactPosition>(
    scene: &Scene,
    primitive: PrimitiveIndex,
    base: Option<PrimitiveIndex>,
    query: &PreciseQuery<F>,
    counters: &mut Counters,
) -> u8 {
    counters.tests += 1;
    let (crossings, stage) = match scene.primitive(primitive) {
        Primitive::Triangle(_) if base == Some(primitive) => (0, Stage::Double),
        Primitive::Triangle(corners) => {
            let (crosses, stage) = query.crosses(corners);
            (u8::from(crosses && is_there(scene, primitive, query)), stage)
        }
        Primitive::Curved(shape) => {
            let (meetings, stage) = query.meets(shape, own_or_other(primitive, base));
            (meetings.crossings, stage)
        }
    };
    counters.exact += u64::from(stage == Stage::Exact);
    crossings
}

/// The transparent primitives among some that the segment of a point crosses, each as often as it does.
pub fn crossed_among<F: Fn() -> ExactPosition>(
    scene: &Scene,
    primitives: impl IntoIterator<Item = PrimitiveIndex>,
    base: Option<PrimitiveIndex>,
    query: &PreciseQuery<F>,
    counters: &mut Counters,
) -> Vec<PrimitiveIndex> {
    let mut crossed = Vec::new();
    for primitive in primitives {
        let times = crossings_of(scene, primitive, base, query, counters);
        crossed.extend((0..times).map(|_| primitive));
    }
    crossed
}

/// Appends for each point the transparent primitives that its segment crosses: every one of the scene is tested.
pub fn crossed_by_points(
    scene: &Scene,
    index: &SceneIndex,
    space: &LightSpace,
    points: &[SurfacePoint],
    crossings: &mut Crossings,
) -> Counters {
    let mut counters = Counters::default();
    for point in points {
        let query = PreciseQuery::new(space, point.position, || point.exact(scene));
        let all = index.transparent.iter().copied();
        crossings.push(crossed_among(scene, all, point.primitive(), &query, &mut counters));
    }
    counters
}

/// Whether a point lies on a primitive.
fn own_or_other(primitive: PrimitiveIndex, base: Option<PrimitiveIndex>) -> Base {
    if base == Some(primitive) { Base::Own } else { Base::Other }
}

/// Whether a primitive that blocks a segment is there where that passes through it, and not a hole of its
/// mask.
pub fn is_there<F: Fn() -> ExactPosition>(
    scene: &Scene,
    primitive: PrimitiveIndex,
    query: &PreciseQuery<F>,
) -> bool {
    scene
        .masked(primitive)
        .is_none_or(|masked| masked.is_there(query.texels(scene.corners(primitive), &masked.axes())))
}

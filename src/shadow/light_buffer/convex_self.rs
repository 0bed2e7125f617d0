//! A convex object does not shadow itself (row 16 of the notes on the 1986 paper).

use crate::float_environment::InStandardFloats;
use crate::geometry::Sign;
use crate::geometry::planes::orientation;
use crate::scene::PrimitiveIndex;
use crate::shadow::BuildInput;
use rayon::prelude::*;

/// For each triangle its own object, if that is convex and lies wholly on the other side of the triangle's
/// plane than the light: then nothing of it can come between.
///
/// Flat objects are left out, because edges alone tell their triangles apart.
pub(super) struct HarmlessObjects(Vec<Option<u32>>);

impl HarmlessObjects {
    /// Empty for a scene without convex objects.
    pub fn new(input: &BuildInput) -> HarmlessObjects {
        let (scene, convexity) = (input.scene, input.index.convexity(input.scene));
        if convexity.iter().all(Option::is_none) {
            return HarmlessObjects(Vec::new());
        }
        let own_object = |primitive: PrimitiveIndex| {
            let object = scene.triangles[primitive as usize].object;
            let within = primitive - scene.objects[object as usize].first;
            let inner = convexity[object as usize].as_ref()?.inner_side[within as usize];
            let opposite = inner * orientation(input.light, scene.corners(primitive)) == Sign::Negative;
            opposite.then_some(object)
        };
        HarmlessObjects(
            (0..scene.triangles.len() as u32).into_par_iter().map(own_object).in_standard_floats().collect(),
        )
    }

    /// The object that cannot shadow a triangle.
    pub fn of(&self, primitive: PrimitiveIndex) -> Option<u32> {
        self.0.get(primitive as usize).copied().flatten()
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.0.len() * size_of::<Option<u32>>()
    }
}

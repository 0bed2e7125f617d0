//! What is cast, and what takes part because a shadow can fall on it alone (rows 4, 10 and 11 of the notes on
//! the 1986 paper).

use crate::scene::{Object, PrimitiveIndex};
use crate::shadow::{BuildInput, Culling, Receivers};
use std::borrow::Cow;

/// The parts that triangles have in one light's buffer.
pub(super) struct Roles<'a> {
    /// Triangles that are cast.
    pub casting: Cow<'a, [PrimitiveIndex]>,
    /// Primitives that never block, but that may be asked about: the simplifications of a cell's list hold only
    /// if these are seen too. Empty if nothing is simplified.
    pub receiving_only: Vec<PrimitiveIndex>,
    /// What would be cast, were it not on the far sides of solids. Points on it are not answered by lists, so
    /// that it is no receiver in their sense.
    pub culled: Vec<PrimitiveIndex>,
}

impl<'a> Roles<'a> {
    /// Casts all that blocks light, less what the culling leaves out.
    pub fn new(input: &BuildInput<'a>) -> Roles<'a> {
        let (scene, index) = (input.scene, input.index);
        let (casting, culled) = match input.culling {
            Culling::Off => (Cow::Borrowed(index.casting(scene)), Vec::new()),
            Culling::ClosedSolids => {
                let far_sides = index.solids(scene).far_sides(input.light);
                let is_far = |&triangle: &PrimitiveIndex| far_sides.contains(scene, triangle);
                let (far, near): (Vec<_>, Vec<_>) = index.casting(scene).iter().partition(|t| is_far(t));
                (Cow::Owned(near), far)
            }
        };
        let receiving_only = match input.receivers {
            Receivers::Surfaces => {
                let first_curved = scene.triangles.len() as u32;
                let is_other = |object: &&Object| {
                    !object.shadowing.casts
                        || scene.materials[object.material as usize].transmission.is_some()
                };
                let others = scene.objects.iter().filter(is_other);
                let primitives = others.flat_map(|object| {
                    let curved = first_curved + object.first_curved;
                    (object.first..object.first + object.count).chain(curved..curved + object.curved_count)
                });
                let may_be_asked = |&primitive: &PrimitiveIndex| scene.object(primitive).shadowing.receives;
                primitives.filter(may_be_asked).collect()
            }
            Receivers::Anywhere => Vec::new(),
        };
        Roles { casting, receiving_only, culled }
    }
}

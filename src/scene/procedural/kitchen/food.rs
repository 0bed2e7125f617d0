//! A bowl of fruit, lemons, eggs and bread.

use super::{ON_TOP, Set, TOP, egg_shape, funnel};
use crate::error::Result;
use crate::geometry::curved::Shape;
use crate::scene::procedural::shapes::{circle, moved, prism};
use glam::Vec3;

pub(super) fn add(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    let [x, z] = [1.585f32, 0.325f32];
    studio.add("bowl foot", palette.ceramic, funnel([x, ON_TOP, z], [0.065, 0.05], 0.014))?;
    studio.add("bowl", palette.ceramic, funnel([x, ON_TOP + 0.0145, z], [0.06, 0.135], 0.075))?;
    let (low, high) = (f64::from(ON_TOP) + 0.015, f64::from(ON_TOP) + 0.02);
    let bottom = prism(&circle(0.0585, 14, 0.0), low, high);
    studio.add("bowl bottom", palette.ceramic, bottom.placed(&moved(x.into(), 0.0, z.into())))?;
    for (name, material, place, radius) in [
        ("orange 1", palette.orange, [-0.04, 0.068, 0.03], 0.042),
        ("orange 2", palette.orange, [0.045, 0.069, 0.03], 0.043),
        ("orange 3", palette.orange, [0.005, 0.071, -0.048], 0.043),
        ("apple", palette.apple, [0.003, 0.128, 0.006], 0.039),
    ] {
        let [dx, dy, dz] = place;
        let fruit = Shape::sphere(Vec3::new(x + dx, ON_TOP + dy, z + dz), radius);
        studio.add(name, material, fruit)?;
    }
    for (number, [x, z]) in [[1.71, 0.37], [1.765, 0.325], [1.49, 0.445]].into_iter().enumerate() {
        let half = if number == 1 { [0.026, 0.026, 0.036] } else { [0.037, 0.026, 0.026] };
        studio.add(format!("lemon {}", number + 1), palette.lemon, egg_shape([x, TOP + 0.0265, z], half))?;
    }
    for (number, [x, z]) in
        [[1.6, 0.535], [1.652, 0.55], [1.63, 0.497], [1.685, 0.512]].into_iter().enumerate()
    {
        let half = if number % 2 == 0 { [0.028, 0.0215, 0.0215] } else { [0.0215, 0.0215, 0.028] };
        studio.add(format!("egg {}", number + 1), palette.eggs, egg_shape([x, TOP + 0.022, z], half))?;
    }
    let loaf = egg_shape([2.02, ON_TOP + 0.02 + 0.047, 0.45], [0.11, 0.046, 0.055]);
    studio.add("bread", palette.bread, loaf)
}

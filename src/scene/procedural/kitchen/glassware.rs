//! Wine glasses, tumblers, bottles, and spices in jars on their rack.

use super::{ON_TOP, Set, column, funnel};
use crate::error::Result;
use crate::scene::procedural::shapes::{circle, cuboid, moved, prism};

pub(super) fn add(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    for (number, [x, z]) in [[1.32, 0.44], [1.43, 0.5], [1.36, 0.3]].into_iter().enumerate() {
        let name = format!("wine glass {}", number + 1);
        studio.add(format!("{name} foot"), palette.crystal, funnel([x, ON_TOP, z], [0.034, 0.005], 0.012))?;
        studio.add(
            format!("{name} stem"),
            palette.crystal,
            funnel([x, ON_TOP + 0.013, z], [0.005, 0.004], 0.07),
        )?;
        studio.add(
            format!("{name} bowl"),
            palette.crystal,
            funnel([x, ON_TOP + 0.084, z], [0.012, 0.037], 0.085),
        )?;
    }
    for (number, [x, z]) in [[1.74, 0.5], [1.83, 0.46], [1.2, 0.2]].into_iter().enumerate() {
        let tumbler = column([x, ON_TOP, z], 0.034, 0.11);
        studio.add(format!("tumbler {}", number + 1), palette.glass, tumbler)?;
    }
    for (number, [x, z]) in [[1.93, 0.16], [1.81, 0.12]].into_iter().enumerate() {
        let material = [palette.green_glass, palette.glass][number];
        let name = format!("bottle {}", number + 1);
        studio.add(name.clone(), material, column([x, ON_TOP, z], 0.039, 0.17))?;
        studio.add(
            format!("{name} shoulder"),
            material,
            funnel([x, ON_TOP + 0.17, z], [0.039, 0.014], 0.05),
        )?;
        studio.add(format!("{name} neck"), material, column([x, ON_TOP + 0.22, z], 0.014, 0.07))?;
    }
    add_spices(set)
}

fn add_spices(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    const SHELF: f32 = 1.235;
    let shelf = f64::from(SHELF);
    let rack = cuboid([1.44, shelf - 0.012, 0.014], [1.9, shelf, 0.094])
        .with(&cuboid([1.44, shelf + 0.03, 0.088], [1.9, shelf + 0.04, 0.094]))
        .with(&cuboid([1.428, shelf - 0.03, 0.014], [1.439, shelf + 0.14, 0.094]))
        .with(&cuboid([1.901, shelf - 0.03, 0.014], [1.912, shelf + 0.14, 0.094]));
    studio.add("spice rack", palette.wood, rack)?;
    for number in 0..6 {
        let (x, z) = (1.488 + 0.073 * number as f32, 0.053);
        let name = format!("jar {}", number + 1);
        let spice = palette.spices[number % 3];
        let filled = 0.03 + 0.012 * ((number * 2) % 5) as f32;
        studio.add(name.clone(), palette.glass, column([x, SHELF + 0.0005, z], 0.026, 0.085))?;
        studio.add(format!("{name} contents"), spice, column([x, SHELF + 0.001, z], 0.024, filled))?;
        let lid = prism(&circle(0.028, 8, 0.2), shelf + 0.086, shelf + 0.104);
        studio.add(format!("{name} lid"), palette.iron, lid.placed(&moved(x.into(), 0.0, z.into())))?;
    }
    Ok(())
}

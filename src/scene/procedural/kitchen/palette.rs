//! Materials of the kitchen.

use crate::scene::Material;
use crate::scene::procedural::studio::{Studio, glass, glossy, matt, metal, polished};

pub(super) struct Palette {
    pub floor: u32,
    pub plaster: u32,
    pub frame: u32,
    pub tiles: [u32; 2],
    pub granite: u32,
    pub cabinet: u32,
    pub door: u32,
    pub steel: u32,
    pub enamel: u32,
    pub iron: u32,
    pub oven: u32,
    pub glass: u32,
    pub green_glass: u32,
    pub crystal: u32,
    pub ceramic: u32,
    pub blue: u32,
    pub red: u32,
    pub wood: u32,
    pub spices: [u32; 3],
    pub orange: u32,
    pub apple: u32,
    pub lemon: u32,
    pub eggs: u32,
    pub bread: u32,
    pub paper: u32,
}

/// Walls of glass so thin that they bend light only a little.
fn clear(name: &str, transmittance: [f32; 3], mirror: f32) -> Material {
    Material { mirror: [mirror; 3], ..glass(name, transmittance, 1.08) }
}

impl Palette {
    pub fn new(studio: &mut Studio) -> Palette {
        let mut add = |material: Material| studio.material(material);
        Palette {
            floor: add(polished("floor", [0.34, 0.2, 0.13], 0.08)),
            plaster: add(matt("plaster", [0.68, 0.65, 0.56])),
            frame: add(matt("window frame", [0.75, 0.74, 0.7])),
            tiles: [
                add(glossy("white tile", [0.66, 0.67, 0.63], 0.3, 60.0)),
                add(glossy("blue tile", [0.2, 0.33, 0.45], 0.3, 60.0)),
            ],
            granite: add(polished("granite", [0.12, 0.115, 0.12], 0.35)),
            cabinet: add(matt("cabinet", [0.42, 0.3, 0.18])),
            door: add(glossy("oak", [0.52, 0.36, 0.2], 0.2, 30.0)),
            steel: add(metal("steel", [0.22; 3], [0.55, 0.55, 0.57])),
            enamel: add(glossy("white enamel", [0.68; 3], 0.3, 50.0)),
            iron: add(glossy("cast iron", [0.05; 3], 0.3, 25.0)),
            oven: add(polished("oven window", [0.03; 3], 0.25)),
            glass: add(clear("glass", [0.78, 0.83, 0.82], 0.0)),
            green_glass: add(clear("green glass", [0.3, 0.62, 0.32], 0.0)),
            crystal: add(clear("crystal", [0.84, 0.87, 0.87], 0.12)),
            ceramic: add(polished("ceramic", [0.74, 0.72, 0.66], 0.05)),
            blue: add(polished("blue glaze", [0.1, 0.19, 0.42], 0.1)),
            red: add(polished("red enamel", [0.58, 0.06, 0.05], 0.12)),
            wood: add(glossy("maple", [0.62, 0.44, 0.25], 0.15, 20.0)),
            spices: [
                add(matt("paprika", [0.5, 0.12, 0.04])),
                add(matt("curry", [0.62, 0.42, 0.07])),
                add(matt("oregano", [0.2, 0.28, 0.1])),
            ],
            orange: add(glossy("orange", [0.8, 0.35, 0.04], 0.25, 25.0)),
            apple: add(glossy("apple", [0.55, 0.07, 0.06], 0.45, 60.0)),
            lemon: add(glossy("lemon", [0.8, 0.66, 0.1], 0.25, 25.0)),
            eggs: add(glossy("egg", [0.76, 0.62, 0.48], 0.1, 15.0)),
            bread: add(matt("bread", [0.52, 0.3, 0.13])),
            paper: add(matt("paper", [0.75, 0.74, 0.72])),
        }
    }
}

//! Recipes out of two numbers.

use super::aims::Aims;
use super::place::{Place, direction};
use super::recipe::{Batch, Matter, Part, Recipe, Settings, Threads};
use super::{curved, flat, lights};
use crate::random::Random;
use crate::scene::{Camera, Shadowing};
use crate::shadow::{Culling, ObjectCoherence, Receivers, Resolution, VolumeThreshold};
use glam::{DVec3, Vec3};

/// No part is added to a scene of so many triangles.
const ENOUGH: usize = 40;

/// Settings that each scene is tried in.
const SETTINGS: usize = 3;

/// Cells along an edge. Fine buffers take long to build, and most of what is hard is hard at coarse ones.
const RESOLUTIONS: [u32; 16] = [1, 1, 2, 2, 2, 3, 3, 3, 5, 5, 5, 7, 16, 16, 16, 64];

/// The recipe of this number of a seed: the same on every machine, whatever was made before.
pub fn recipe(seed: u64, number: u64) -> Recipe {
    // Two rounds, so that the sequences of neighbouring numbers do not overlap.
    let mixed = Random::new(seed).unit().to_bits() ^ number.wrapping_mul(0xd134_2543_de82_ef95);
    let random = &mut Random::new(Random::new(mixed).unit().to_bits() ^ mixed.rotate_left(32));
    let place = Place::new(random);
    let mut parts = objects(&place, random);
    let triangles: Vec<_> = parts.iter().flat_map(|part| part.triangles.iter().copied()).collect();
    let light = lights::light(&triangles, &place, random);
    if random.chance(0.4) {
        parts.push(lights::seen_badly(light, &place, random));
    }
    if random.chance(0.1) {
        let odd = random.below(parts.len());
        let casts = random.chance(0.5);
        parts[odd].shadowing = Shadowing { casts, receives: !casts };
    }
    let receivers = if random.chance(0.4) { Receivers::Surfaces } else { Receivers::Anywhere };
    let settings = (0..SETTINGS).map(|_| settings(receivers, random)).collect();
    let mut recipe = Recipe { parts, light, camera: camera(&place, random), aims: Vec::new(), settings };
    let aims = Aims::new(&recipe, &place);
    // Half of what is seen faces away.
    let wanted = if receivers == Receivers::Surfaces { 80 } else { 50 };
    recipe.aims = (0..wanted).filter_map(|_| aims.aim(receivers, random)).collect();
    recipe
}

fn objects(place: &Place, random: &mut Random) -> Vec<Part> {
    let mut parts = Vec::new();
    if random.chance(0.4) {
        parts.push(flat::floor(place, random));
    }
    for _ in 0..1 + random.below(5) {
        let mut part = match random.chance(0.12) {
            true => curved::part(place, random),
            false => random.pick(flat::KINDS)(place, random),
        };
        if random.chance(0.1) {
            part.matter = Matter::Glass;
        }
        if random.chance(0.15) {
            let again = flat::doubled(&part, random);
            match random.chance(0.5) {
                true => part.triangles.extend(again),
                false => parts.push(Part::flat(again)),
            }
        }
        parts.push(part);
        if parts.iter().map(|part| part.triangles.len()).sum::<usize>() >= ENOUGH {
            break;
        }
    }
    parts
}

fn settings(receivers: Receivers, random: &mut Random) -> Settings {
    let resolution = match random.below(400) {
        0 => Resolution::Cells(1024),
        1..=4 => Resolution::Cells(256),
        5..=9 => Resolution::Auto,
        _ => Resolution::Cells(*random.pick(&RESOLUTIONS)),
    };
    let coherence = [ObjectCoherence::Off, ObjectCoherence::Off, ObjectCoherence::LastOccluder];
    Settings {
        resolution,
        culling: *random.pick(&[Culling::Off, Culling::ClosedSolids]),
        bounding_volumes: *random.pick(&[
            VolumeThreshold::Off,
            VolumeThreshold::Off,
            VolumeThreshold::MoreThan(0),
            VolumeThreshold::MoreThan(2),
        ]),
        object_coherence: *random.pick(&coherence),
        receivers,
        batch: if random.chance(0.2) { Batch::One } else { Batch::All },
        threads: if random.chance(0.1) { Threads::Two } else { Threads::One },
    }
}

fn camera(place: &Place, random: &mut Random) -> Camera {
    let eye = match random.below(3) {
        0 => place.lattice(random) * 2.0,
        1 => place.anywhere(random) * 2.0,
        _ => direction(random) * 3.0,
    };
    let target = if random.chance(0.5) { DVec3::ZERO } else { place.lattice(random) };
    let degrees = *random.pick(&[20.0, 60.0, 90.0, 150.0]);
    // Where all is small or far away, both may round to one point, and then it looks down an axis.
    let (eye, target): (Vec3, Vec3) = (place.of(eye), place.of(target));
    Camera::look_at("camera", eye, target, Vec3::Y, degrees)
}

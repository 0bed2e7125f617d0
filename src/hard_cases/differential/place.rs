//! Where a random scene is and how large: its numbers are small whole multiples of a power of two before.

use crate::random::Random;
use glam::{DVec3, Vec3};

/// Sizes as powers of two: denormal coordinates, tiny, usual and huge.
const SIZES: [i32; 20] = [0, 0, 0, 0, 0, 0, 0, 0, 0, 3, -4, -4, -20, 20, 40, 60, -60, -120, -140, 100];

/// The steps of the lattice, as shares of the size.
const STEPS: [f64; 4] = [1.0, 1.0, 0.5, 0.125];

/// A place in the world.
pub struct Place {
    centre: DVec3,
    size: f64,
    step: f64,
}

impl Place {
    /// Mostly around the origin; sometimes so far away that ulps are coarse, on whole multiples of the lattice's step
    /// or on none.
    pub fn new(random: &mut Random) -> Place {
        let size = 2f64.powi(*random.pick(&SIZES));
        let step = *random.pick(&STEPS);
        let lattice = triple(random, 4);
        let centre = match random.below(8) {
            0 => lattice * (size * 262_144.0),
            1 => DVec3::new(148_376.3, 1234.7, -223_423.1) * size,
            2 => lattice * (size * 37.0),
            3 => lattice * (1e6 * size),
            _ => DVec3::ZERO,
        };
        Place { centre, size, step }
    }

    /// What lengths are multiples of.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// From the scene's own coordinates to the world's.
    pub fn of(&self, own: DVec3) -> Vec3 {
        (self.centre + own * self.size).as_vec3()
    }

    /// The same without rounding to f32.
    pub fn exact(&self, own: DVec3) -> DVec3 {
        self.centre + own * self.size
    }

    /// A length in the world.
    pub fn length(&self, own: f64) -> f32 {
        (own * self.size) as f32
    }

    /// A point of the lattice in the scene's own coordinates: so few that they often coincide.
    pub fn lattice(&self, random: &mut Random) -> DVec3 {
        triple(random, 4) * self.step
    }

    /// One in the world.
    pub fn lattice_point(&self, random: &mut Random) -> Vec3 {
        let own = self.lattice(random);
        self.of(own)
    }

    /// A step of the lattice that is not none.
    pub fn way(&self, random: &mut Random) -> DVec3 {
        direction(random) * self.step
    }

    /// Any point, on no lattice.
    pub fn anywhere(&self, random: &mut Random) -> DVec3 {
        DVec3::new(random.signed(), random.signed(), random.signed()) * 4.0
    }
}

/// Whole numbers from -`reach` to `reach`.
pub fn triple(random: &mut Random, reach: usize) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| random.below(2 * reach + 1) as f64 - reach as f64))
}

/// A direction of small whole numbers, not zero; along an axis now and then.
pub fn direction(random: &mut Random) -> DVec3 {
    if random.chance(0.25) {
        let axis = *random.pick(&[DVec3::X, DVec3::Y, DVec3::Z]);
        return if random.chance(0.5) { axis } else { -axis };
    }
    loop {
        let way = triple(random, 3);
        if way != DVec3::ZERO {
            return way;
        }
    }
}

//! Heights that look like land: gradient noise in octaves, after Perlin ("An Image Synthesizer", 1985), some of them
//! folded to ridges, after Musgrave (in "Texturing and Modeling", 1994).

use crate::random::Random;
use glam::DVec2;

/// A field of heights over the plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Relief {
    /// Waves of the largest octave in a unit of length.
    pub frequency: f64,
    /// Octaves, each of twice the frequency of the one before.
    pub octaves: u32,
    /// The height of an octave over that of the one before.
    pub gain: f64,
    /// Makes it another one.
    pub seed: u64,
}

/// How much finer each octave is; not quite 2, so that zeros of one do not lie on zeros of the next.
const LACUNARITY: f64 = 1.97;

impl Relief {
    /// About -1 to 1.
    pub fn rolling(&self, place: DVec2) -> f64 {
        self.sum(place, |noise, _| noise)
    }

    /// About 0 to 1: sharp where noise changes its sign, and rougher the higher up.
    pub fn ridged(&self, place: DVec2) -> f64 {
        let mut above = 1.0;
        self.sum(place, |noise, _| {
            let ridge = 1.0 - noise.abs();
            let height = ridge * ridge * above;
            above = (1.6 * height).clamp(0.0, 1.0);
            height
        })
    }

    fn sum(&self, place: DVec2, mut octave: impl FnMut(f64, u32) -> f64) -> f64 {
        let (mut place, mut height, mut total) = (place * self.frequency, 1.0, 0.0);
        let mut sum = 0.0;
        for number in 0..self.octaves {
            sum += height * octave(noise(place, self.seed + u64::from(number)), number);
            total += height;
            height *= self.gain;
            // Turned besides, so that no lattice shows.
            place = LACUNARITY * DVec2::new(0.8 * place.x - 0.6 * place.y, 0.6 * place.x + 0.8 * place.y);
        }
        sum / total
    }
}

/// Gradient noise from -1 to 1, zero at whole numbers.
fn noise(place: DVec2, seed: u64) -> f64 {
    let cell = place.floor();
    let within = place - cell;
    let at = |dx: f64, dy: f64| {
        let corner = cell + DVec2::new(dx, dy);
        gradient(corner, seed).dot(within - DVec2::new(dx, dy))
    };
    let ease = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let [u, v] = [ease(within.x), ease(within.y)];
    std::f64::consts::SQRT_2 * mix(mix(at(0.0, 0.0), at(1.0, 0.0), u), mix(at(0.0, 1.0), at(1.0, 1.0), u), v)
}

/// One of sixteen directions for a place on the lattice.
fn gradient(corner: DVec2, seed: u64) -> DVec2 {
    const S: f64 = std::f64::consts::FRAC_1_SQRT_2;
    // Sine and cosine of an eighth of a right angle's odd multiples, written out: the same everywhere.
    const A: f64 = 0.923_879_532_511_286_7;
    const B: f64 = 0.382_683_432_365_089_8;
    const QUARTER: [[f64; 2]; 4] = [[1.0, 0.0], [A, B], [S, S], [B, A]];
    let [x, y] = corner.to_array().map(|c| c as i64 as u64);
    let mixed = x.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ y.wrapping_mul(0xc2b2_ae3d_27d4_eb4f) ^ (seed << 32);
    let number = Random::new(mixed).below(16);
    let [a, b] = QUARTER[number % 4];
    match number / 4 {
        0 => DVec2::new(a, b),
        1 => DVec2::new(-b, a),
        2 => DVec2::new(-a, -b),
        _ => DVec2::new(b, -a),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_continuous_within_bounds_and_zero_on_the_lattice() {
        assert_eq!(noise(DVec2::new(3.0, -4.0), 7), 0.0);
        let mut largest = 0.0f64;
        for i in 0..10_000 {
            let place = DVec2::new(0.0137, 0.0071) * f64::from(i) - DVec2::splat(20.0);
            let here = noise(place, 1);
            largest = largest.max(here.abs());
            assert!((noise(place + DVec2::splat(1e-6), 1) - here).abs() < 1e-4);
        }
        assert!((0.6..=1.0).contains(&largest), "{largest}");
    }
}

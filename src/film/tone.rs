//! From linear light to the bytes of a picture.

/// Values up to here come through unchanged; what is brighter is bent towards 1.
const SHOULDER: f32 = 0.8;

/// Exposure and the curve of the highlights.
///
/// Up to 0.8 the curve is the identity, so that a PNG shows most of the image exactly as the OpenEXR file
/// holds it. Above, each channel goes on as `0.8 + 0.2 (1 - exp(-(x - 0.8) / 0.2))`, of the same slope where
/// the two meet and never quite 1, instead of being cut. It is `libm`'s exponential, the same everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToneMap {
    gain: f32,
}

impl ToneMap {
    /// Brightens by `stops`: each doubles the light, each negative one halves it; 0 changes nothing.
    pub fn new(stops: f32) -> ToneMap {
        ToneMap { gain: libm::exp2f(stops) }
    }

    /// Linear Rec. 709 to sRGB bytes. Negative values and NaN become 0, infinity 255.
    pub fn apply(self, linear: [f32; 3]) -> [u8; 3] {
        linear.map(|x| linear_to_srgb8(shoulder(x * self.gain)))
    }

    /// Three planes of linear light to RGB bytes, three a pixel.
    ///
    /// # Panics
    /// If the planes differ in length.
    pub fn apply_planes(self, red: &[f32], green: &[f32], blue: &[f32]) -> Vec<u8> {
        assert!(red.len() == green.len() && green.len() == blue.len(), "planes of one length");
        let pixels = red.iter().zip(green).zip(blue);
        pixels.flat_map(|((&r, &g), &b)| self.apply([r, g, b])).collect()
    }
}

fn shoulder(x: f32) -> f32 {
    if x > SHOULDER {
        let room = 1.0 - SHOULDER;
        SHOULDER + room * (1.0 - libm::expf((SHOULDER - x) / room))
    } else {
        x
    }
}

/// The sRGB transfer function of IEC 61966-2-1, exactly piecewise, rounded to the nearest byte. What lies
/// outside [0, 1] is cut; NaN becomes 0.
pub fn linear_to_srgb8(linear: f32) -> u8 {
    // In f64, so that rounding to the byte is the only one that counts.
    let x = f64::from(linear.clamp(0.0, 1.0));
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * libm::pow(x, 1.0 / 2.4) - 0.055 };
    // The cast takes a NaN to 0.
    (encoded * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn known_values_of_srgb() {
        let pairs = [(0.0, 0), (1.0, 255), (0.5, 188), (0.18, 118), (0.002, 7)];
        for (linear, byte) in pairs {
            assert_eq!(linear_to_srgb8(linear), byte, "{linear}");
        }
        assert_eq!([-1.0, 2.0, f32::NAN, f32::INFINITY].map(linear_to_srgb8), [0, 255, 0, 255]);
    }

    #[test]
    fn every_byte_comes_back_from_its_own_linear_value() {
        for byte in 0..=255_u8 {
            let s = f64::from(byte) / 255.0;
            let linear = if s <= 0.040_45 { s / 12.92 } else { libm::pow((s + 0.055) / 1.055, 2.4) };
            assert_eq!(linear_to_srgb8(linear as f32), byte);
        }
    }

    #[test]
    fn the_curve_is_the_identity_then_bends_and_never_falls() {
        assert_eq!(shoulder(0.8), 0.8);
        assert_relative_eq!(shoulder(0.801), 0.801, epsilon = 1e-5);
        let values: Vec<f32> = (0..4000).map(|i| shoulder(i as f32 * 0.001)).collect();
        assert!(values.windows(2).all(|pair| pair[0] <= pair[1]));
        assert_eq!(ToneMap::new(0.0).apply([f32::INFINITY, f32::NAN, -1.0]), [255, 0, 0]);
    }

    #[test]
    fn a_stop_doubles_the_light() {
        let [dark, bright] = [0.0, 1.0].map(ToneMap::new);
        assert_eq!(bright.apply([0.1, 0.2, 0.3]), dark.apply([0.2, 0.4, 0.6]));
        assert_eq!(dark.apply_planes(&[0.1, 1.0], &[0.2, 0.5], &[0.3, 0.0]).len(), 6);
    }
}

//! Colour spaces of FLIP, under illuminant D65.

/// Linear Rec. 709 to XYZ, a row each; white is (1, 1, 1) there. The numbers are those of FLIP's reference code.
const TO_XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// The inverse.
const FROM_XYZ: [[f64; 3]; 3] = [
    [3.241_003_232_976_358, -1.537_398_969_488_785, -0.498_615_881_996_363],
    [-0.969_224_252_202_516, 1.875_929_983_695_176, 0.041_554_226_340_085],
    [0.055_639_419_851_975, -0.204_011_206_123_91, 1.057_148_977_187_533],
];

fn times(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn white() -> [f64; 3] {
    times(&TO_XYZ, [1.0; 3])
}

fn relative_xyz(rgb: [f32; 3]) -> [f64; 3] {
    let (xyz, white) = (times(&TO_XYZ, rgb.map(f64::from)), white());
    [xyz[0] / white[0], xyz[1] / white[1], xyz[2] / white[2]]
}

/// Linear Rec. 709 to YCxCz, a linear opponent space.
pub(super) fn opponent(rgb: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)].map(|v| v as f32)
}

/// And back, cut to what a screen shows.
pub(super) fn shown_of_opponent(ycxcz: [f32; 3]) -> [f32; 3] {
    let [y, cx, cz] = ycxcz.map(f64::from);
    let y = (y + 16.0) / 116.0;
    let (xyz, white) = ([y + cx / 500.0, y, y - cz / 200.0], white());
    let rgb = times(&FROM_XYZ, [xyz[0] * white[0], xyz[1] * white[1], xyz[2] * white[2]]);
    rgb.map(|v| v.clamp(0.0, 1.0) as f32)
}

/// Linear Rec. 709 to CIELAB, its chroma scaled by lightness: colours of what is dark are seen less (Hunt).
pub(super) fn hunt_lab(rgb: [f32; 3]) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let f = |t: f64| match t > DELTA * DELTA * DELTA {
        true => libm::cbrt(t),
        false => t / (3.0 * DELTA * DELTA) + 4.0 / 29.0,
    };
    let [x, y, z] = relative_xyz(rgb).map(f);
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

/// Rec. 709 luminance of linear light.
pub(super) fn luminance([r, g, b]: [f32; 3]) -> f64 {
    0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
}

/// The sRGB transfer function.
pub(super) fn encoded(linear: f64) -> f64 {
    match linear <= 0.003_130_8 {
        true => 12.92 * linear,
        false => 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_white_in_every_space() {
        let [y, cx, cz] = opponent([1.0; 3]);
        assert!((y - 100.0).abs() < 1e-4 && cx.abs() < 1e-4 && cz.abs() < 1e-4);
        let [l, a, b] = hunt_lab([1.0; 3]);
        assert!((l - 100.0).abs() < 1e-9 && a.abs() < 1e-9 && b.abs() < 1e-9);
        assert!((luminance([1.0; 3]) - 1.0).abs() < 1e-12 && (encoded(1.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn colours_come_back() {
        for rgb in [[0.1, 0.5, 0.9], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.3, 0.3, 0.3]] {
            let back = shown_of_opponent(opponent(rgb));
            assert!(rgb.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-5), "{rgb:?} {back:?}");
        }
    }
}

//! Squared errors in linear light, as pbrt's `Image::MSE` and `Image::MRSE` take them.

use super::Picture;
use rayon::prelude::*;

pub(super) struct Errors {
    pub(super) mse: f64,
    pub(super) mrse: f64,
}

/// What keeps black from having no relative error, as in pbrt.
const FLOOR: f64 = 0.01;

pub(super) fn errors(test: &Picture, reference: &Picture) -> Errors {
    let width = test.width();
    let row = |row: usize| {
        let mut sums = [0.0; 2];
        for (test, reference) in test.channels.iter().zip(&reference.channels) {
            for at in row * width..(row + 1) * width {
                let (value, wanted) = (f64::from(test[at]), f64::from(reference[at]));
                let square = (value - wanted) * (value - wanted);
                sums[0] += square;
                let scale = (wanted + FLOOR) * (wanted + FLOOR);
                // Of a reference of exactly -0.01, which no picture has, as pbrt does it.
                sums[1] += if scale > 0.0 { square / scale } else { 0.0 };
            }
        }
        sums
    };
    let rows: Vec<[f64; 2]> = (0..test.size.height as usize).into_par_iter().map(row).collect();
    let samples = 3.0 * test.size.pixels() as f64;
    let sum = |k: usize| rows.iter().map(|row| row[k]).sum::<f64>() / samples;
    Errors { mse: sum(0), mrse: sum(1) }
}

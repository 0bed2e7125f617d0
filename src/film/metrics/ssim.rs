//! Structural similarity (Wang, Bovik, Sheikh and Simoncelli, Image Quality Assessment: From Error Visibility to
//! Structural Similarity, 2004), with the window and the constants of the paper.

use super::Picture;
use super::colour::{encoded, luminance};
use super::filter::Kernel;
use rayon::prelude::*;

/// Pixels from the middle of the window to its border: 11 x 11 in all.
const RADIUS: usize = 5;
/// Of the Gaussian window, in pixels.
const DEVIATION: f64 = 1.5;
/// What keeps quotients of small numbers still, for values in [0, 1].
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// The mean over all windows that lie in the picture; none if it is smaller than one.
pub(super) fn mean_ssim(test: &Picture, reference: &Picture) -> Option<f64> {
    let (width, height) = (test.width(), test.size.height as usize);
    if width <= 2 * RADIUS || height <= 2 * RADIUS {
        return None;
    }
    let kernel = Kernel::of(RADIUS, |x| libm::exp(-x * x / (2.0 * DEVIATION * DEVIATION))).normalised();
    let blurred = |plane: &[f32]| kernel.along_columns(&kernel.along_rows(plane, width), width);
    let [x, y] = [test, reference].map(|picture| {
        let grey = |at: usize| encoded(luminance(picture.shown(at))) as f32;
        (0..picture.size.pixels()).into_par_iter().map(grey).collect::<Vec<f32>>()
    });
    let product = |a: &[f32], b: &[f32]| blurred(&a.iter().zip(b).map(|(a, b)| a * b).collect::<Vec<_>>());
    let [mean_x, mean_y, xx, yy, xy] =
        [blurred(&x), blurred(&y), product(&x, &x), product(&y, &y), product(&x, &y)];
    let value = |at: usize| {
        let [mx, my, xx, yy, xy] = [&mean_x, &mean_y, &xx, &yy, &xy].map(|plane| f64::from(plane[at]));
        let (covariance, variances) = (xy - mx * my, xx - mx * mx + yy - my * my);
        (2.0 * mx * my + C1) * (2.0 * covariance + C2) / ((mx * mx + my * my + C1) * (variances + C2))
    };
    let row = |y: usize| (y * width + RADIUS..(y + 1) * width - RADIUS).map(value).sum::<f64>();
    let rows: Vec<f64> = (RADIUS..height - RADIUS).into_par_iter().map(row).collect();
    Some(rows.iter().sum::<f64>() / ((width - 2 * RADIUS) * (height - 2 * RADIUS)) as f64)
}

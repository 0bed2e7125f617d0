//! How far a picture is from another, in one number: MSE, MRSE and FLIP by the names of pbrt's `imgtool`, PSNR and SSIM by
//! everyone's.
//!
//! MSE, MRSE and PSNR are taken of R, G and B in linear light, as they stand in the file. SSIM and FLIP ask what a
//! person sees: they look at the picture as a screen shows it, cut to [0, 1]. Rows are summed each by itself, so that no
//! number depends on the threads.
//!
//! These are our own: the libraries that there are take 8-bit pictures, or bring a C++ compiler along.

mod colour;
mod errors;
mod filter;
mod flip;
mod ssim;

use super::ImagePlanes;
use crate::error::{Error, Result};
use crate::scene::ImageSize;
use serde::Serialize;

/// A picture against a reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ImageMetrics {
    /// Mean squared error of the channels in linear light.
    pub mse: f64,
    /// Mean relative squared error, also known as relMSE: squares of differences over squares of the reference plus 0.01.
    pub mrse: f64,
    /// Peak signal-to-noise ratio in decibels, for a peak of 1. None, and `null` in JSON, for pictures without a
    /// difference, where it is infinite.
    pub psnr: Option<f64>,
    /// Mean structural similarity of luminances as a screen shows them (Wang and others, 2004): 1 for equal pictures. None
    /// for pictures with a side of less than 11 pixels.
    pub ssim: Option<f64>,
    /// Mean FLIP of low dynamic range (Andersson and others, 2020) at 67 pixels a degree: 0 for equal pictures, at most 1.
    pub flip: f64,
}

impl ImageMetrics {
    /// Of equal pictures.
    pub const SAME: ImageMetrics =
        ImageMetrics { mse: 0.0, mrse: 0.0, psnr: None, ssim: Some(1.0), flip: 0.0 };

    /// Of R, G and B of two images.
    ///
    /// # Errors
    /// [`Error::Usage`] if they differ in size, one has no such channels, or a sample is not finite.
    pub fn new(test: &ImagePlanes, reference: &ImagePlanes) -> Result<ImageMetrics> {
        let (test, reference) = (Picture::new(test)?, Picture::new(reference)?);
        if (test.size.width, test.size.height) != (reference.size.width, reference.size.height) {
            return Err(Error::Usage("pictures of different sizes have no metrics".into()));
        }
        let errors = errors::errors(&test, &reference);
        Ok(ImageMetrics {
            mse: errors.mse,
            mrse: errors.mrse,
            psnr: (errors.mse > 0.0).then(|| -10.0 * libm::log10(errors.mse)),
            ssim: ssim::mean_ssim(&test, &reference),
            flip: flip::mean_flip(&test, &reference),
        })
    }
}

/// R, G and B, finite and of one size.
struct Picture<'a> {
    size: ImageSize,
    channels: [&'a [f32]; 3],
}

impl<'a> Picture<'a> {
    fn new(planes: &'a ImagePlanes) -> Result<Picture<'a>> {
        let channel = |name: &str| {
            let missing = || Error::Usage(format!("a picture without a channel `{name}` has no metrics"));
            let samples = planes.channel(name).ok_or_else(missing)?;
            match samples.iter().all(|sample| sample.is_finite()) {
                true => Ok(samples),
                false => {
                    Err(Error::Usage(format!("channel `{name}` is not finite everywhere: it has no metrics")))
                }
            }
        };
        Ok(Picture { size: planes.size(), channels: [channel("R")?, channel("G")?, channel("B")?] })
    }

    fn width(&self) -> usize {
        self.size.width as usize
    }

    /// Linear Rec. 709, cut to what a screen shows.
    fn shown(&self, at: usize) -> [f32; 3] {
        self.channels.map(|channel| channel[at].clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests;

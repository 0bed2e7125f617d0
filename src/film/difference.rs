//! Two images, sample by sample, by the rules of OpenImageIO's `idiff`: how many pixels differ by more than is allowed.

use super::ImagePlanes;
use serde::Serialize;

/// How much may differ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Allowance {
    /// A pixel counts if a sample differs by more than this.
    pub threshold: f64,
    /// So many of a hundred pixels may count.
    pub percent: f64,
    /// No sample may differ by more than this.
    pub hard: f64,
}

impl Allowance {
    /// That of `idiff` unless something else is said.
    pub const USUAL: Allowance = Allowance { threshold: 1e-6, percent: 0.0, hard: f64::INFINITY };
}

/// Differences of a channel.
#[derive(Debug, Clone, Serialize)]
pub struct ChannelDifference {
    /// The channel.
    pub channel: String,
    /// Samples that are not equal.
    pub differ: u64,
    /// The largest difference of two finite samples.
    pub max: f64,
    /// Column and row of it, from the top left.
    pub max_at: [u32; 2],
    /// The mean of absolute differences of finite samples.
    pub mean: f64,
    /// The square root of the mean of squared ones.
    pub rms: f64,
    /// Samples that are NaN in either image.
    pub nan: u64,
    /// Samples that are infinite in one image and not the same in the other.
    pub infinite: u64,
}

/// Differences of two images.
#[derive(Debug, Clone, Serialize)]
pub struct ImageDifference {
    /// Of each channel, in the order of names.
    pub channels: Vec<ChannelDifference>,
    /// Pixels of either image.
    pub pixels: u64,
    /// Pixels with a sample that differs by more than the threshold for a failure, or is NaN, or infinite in one image
    /// alone.
    pub failing: u64,
    /// The same by the threshold for a warning.
    pub warning: u64,
}

/// How a comparison came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Likeness {
    /// Within both allowances.
    Same,
    /// Beyond that for warnings.
    Warn,
    /// Beyond that for failures.
    Fail,
}

impl ImageDifference {
    /// Of the channels of these names, which both images must have, in one size. NaN is like nothing, not even NaN;
    /// infinities of one sign are alike.
    pub fn new(
        one: &ImagePlanes,
        other: &ImagePlanes,
        names: &[&str],
        fail: Allowance,
        warn: Allowance,
    ) -> ImageDifference {
        let pixels = one.size().pixels();
        let width = one.size().width as usize;
        let mut worst = vec![0.0_f64; pixels];
        let mut channels = Vec::new();
        for &name in names {
            let (a, b) = (one.channel(name).unwrap_or_default(), other.channel(name).unwrap_or_default());
            let mut found = ChannelDifference {
                channel: name.into(),
                differ: 0,
                max: 0.0,
                max_at: [0, 0],
                mean: 0.0,
                rms: 0.0,
                nan: 0,
                infinite: 0,
            };
            let mut finite = 0_u64;
            for (at, (&a, &b)) in a.iter().zip(b).enumerate() {
                found.differ += u64::from(a != b);
                let difference = (f64::from(a) - f64::from(b)).abs();
                if a.is_nan() || b.is_nan() {
                    found.nan += 1;
                    worst[at] = f64::INFINITY;
                } else if difference.is_infinite() {
                    found.infinite += 1;
                    worst[at] = f64::INFINITY;
                } else if a != b || a.is_finite() {
                    finite += 1;
                    found.mean += difference;
                    found.rms += difference * difference;
                    worst[at] = worst[at].max(difference);
                    if difference > found.max {
                        found.max = difference;
                        found.max_at = [(at % width) as u32, (at / width) as u32];
                    }
                }
            }
            let finite = finite.max(1) as f64;
            found.mean /= finite;
            found.rms = (found.rms / finite).sqrt();
            channels.push(found);
        }
        let beyond = |limit: f64| worst.iter().filter(|&&difference| difference > limit).count() as u64;
        ImageDifference {
            channels,
            pixels: pixels as u64,
            failing: beyond(fail.threshold),
            warning: beyond(warn.threshold),
        }
    }

    /// How it comes out by the allowances that it was counted with.
    pub fn likeness(&self, fail: Allowance, warn: Allowance) -> Likeness {
        let max = self.channels.iter().map(|channel| channel.max).fold(0.0, f64::max);
        let not_finite = self.channels.iter().any(|channel| channel.nan + channel.infinite > 0);
        let beyond = |count: u64, allowance: Allowance| {
            count as f64 > allowance.percent / 100.0 * self.pixels as f64 || max > allowance.hard
        };
        match (not_finite || beyond(self.failing, fail), beyond(self.warning, warn)) {
            (true, _) => Likeness::Fail,
            (false, true) => Likeness::Warn,
            (false, false) => Likeness::Same,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::ImageSize;

    fn image(samples: &[f32]) -> ImagePlanes {
        let mut image = ImagePlanes::new(ImageSize { width: 2, height: samples.len() as u32 / 2 });
        image.add_channel("Z", samples.to_vec()).unwrap();
        image
    }

    fn compared(one: &[f32], other: &[f32], fail: Allowance, warn: Allowance) -> (ImageDifference, Likeness) {
        let difference = ImageDifference::new(&image(one), &image(other), &["Z"], fail, warn);
        let likeness = difference.likeness(fail, warn);
        (difference, likeness)
    }

    const USUAL: Allowance = Allowance::USUAL;

    #[test]
    fn differences_are_counted_placed_and_averaged() {
        let (found, likeness) = compared(&[1.0, 2.0, 3.0, 4.0], &[1.0, 2.0, 6.0, 3.0], USUAL, USUAL);
        let z = &found.channels[0];
        assert_eq!((z.differ, z.max, z.max_at, z.mean), (2, 3.0, [0, 1], 1.0));
        assert!((z.rms - 2.5_f64.sqrt()).abs() < 1e-12);
        assert_eq!((found.failing, likeness), (2, Likeness::Fail));
    }

    #[test]
    fn nan_is_like_nothing_and_infinities_are_like_themselves() {
        let infinity = f32::INFINITY;
        let (_, same) = compared(&[infinity, -infinity], &[infinity, -infinity], USUAL, USUAL);
        assert_eq!(same, Likeness::Same);
        let all = Allowance { threshold: 1e30, percent: 100.0, hard: infinity.into() };
        for (one, other) in [(f32::NAN, f32::NAN), (f32::NAN, 0.0), (infinity, 1.0), (infinity, -infinity)] {
            let (found, likeness) = compared(&[one, 0.0], &[other, 0.0], all, all);
            assert_eq!((likeness, found.failing), (Likeness::Fail, 1), "{one} {other}");
        }
    }

    #[test]
    fn allowances_are_those_of_idiff() {
        let (one, other) = ([0.0; 4], [0.0, 0.0, 0.0, 0.5]);
        let allow = |threshold, percent, hard| Allowance { threshold, percent, hard };
        let outcome = |fail, warn| compared(&one, &other, fail, warn).1;
        let none = f64::INFINITY;
        assert_eq!(outcome(allow(0.5, 0.0, none), allow(0.5, 0.0, none)), Likeness::Same);
        assert_eq!(outcome(allow(0.5, 0.0, none), USUAL), Likeness::Warn);
        assert_eq!(outcome(allow(0.1, 25.0, none), allow(0.1, 25.0, none)), Likeness::Same);
        assert_eq!(outcome(allow(0.1, 24.0, none), USUAL), Likeness::Fail);
        assert_eq!(outcome(allow(0.1, 100.0, 0.4), USUAL), Likeness::Fail);
    }
}

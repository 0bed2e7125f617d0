//! What `compare` says of two images: JSON, and a table.

use crate::film::{Allowance, ImageDifference, ImageMetrics, ImagePlanes, Likeness, grouped};
use serde::Serialize;
use std::fmt::Write;

/// The whole document.
#[derive(Debug, Clone, Serialize)]
pub struct Comparison {
    /// How it came out: `same`, `warn`, `fail`, or `mismatch` where nothing could be compared.
    pub result: &'static str,
    /// What the process ends with.
    pub exit_code: u8,
    /// Why nothing could be compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mismatch: Option<String>,
    /// Width and height of the images; of the first one where they differ.
    pub size: [u32; 2],
    /// What fails.
    pub fail: Allowance,
    /// What warns.
    pub warn: Allowance,
    /// What was found.
    #[serde(skip_serializing_if = "Option::is_none", flatten)]
    pub difference: Option<ImageDifference>,
    /// Of R, G and B, the second image being the reference, if both have them and all of it is finite.
    pub metrics: Option<ImageMetrics>,
}

impl Comparison {
    /// Of two images; of these channels alone if there are some, else of all.
    pub fn new(
        one: &ImagePlanes,
        other: &ImagePlanes,
        channels: &[String],
        fail: Allowance,
        warn: Allowance,
    ) -> Comparison {
        let size = one.size();
        let mut comparison = Comparison {
            result: "mismatch",
            exit_code: 3,
            mismatch: mismatch(one, other, channels),
            size: [size.width, size.height],
            fail,
            warn,
            difference: None,
            metrics: None,
        };
        if comparison.mismatch.is_none() {
            let mut names: Vec<&str> = match channels {
                [] => one.channels().iter().map(|channel| channel.name.as_str()).collect(),
                some => some.iter().map(String::as_str).collect(),
            };
            names.sort_unstable();
            names.dedup();
            let difference = ImageDifference::new(one, other, &names, fail, warn);
            (comparison.result, comparison.exit_code) = match difference.likeness(fail, warn) {
                Likeness::Same => ("same", 0),
                Likeness::Warn => ("warn", 1),
                Likeness::Fail => ("fail", 2),
            };
            comparison.difference = Some(difference);
            comparison.metrics = ImageMetrics::new(one, other).ok();
        }
        comparison
    }

    /// For people.
    pub fn table(&self) -> String {
        let mut text = String::new();
        let Some(difference) = &self.difference else {
            let why = self.mismatch.as_deref().unwrap_or_default();
            return format!("mismatch: {why}\n");
        };
        let width = difference.channels.iter().map(|c| c.channel.len()).max().unwrap_or(0).max(7);
        let _ = writeln!(
            text,
            "{:<width$} {:>11} {:>11} {:>11} {:>11} {:>11} {:>8} {:>8}",
            "channel", "differ", "max", "at", "mean", "RMS", "NaN", "infinite"
        );
        for channel in &difference.channels {
            let at = match channel.max > 0.0 {
                true => format!("{},{}", channel.max_at[0], channel.max_at[1]),
                false => String::new(),
            };
            let _ = writeln!(
                text,
                "{:<width$} {:>11} {:>11} {at:>11} {:>11} {:>11} {:>8} {:>8}",
                channel.channel,
                grouped(channel.differ),
                short(channel.max),
                short(channel.mean),
                short(channel.rms),
                grouped(channel.nan),
                grouped(channel.infinite)
            );
        }
        if let Some(metrics) = &self.metrics {
            let psnr = metrics.psnr.map_or("infinite".into(), |psnr| format!("{psnr:.2} dB"));
            let ssim = metrics.ssim.map_or("-".into(), |ssim| format!("{ssim:.6}"));
            let _ = writeln!(
                text,
                "MSE {}   MRSE {}   PSNR {psnr}   SSIM {ssim}   FLIP {}",
                short(metrics.mse),
                short(metrics.mrse),
                short(metrics.flip)
            );
        }
        let (count, threshold) = match self.exit_code {
            1 => (difference.warning, self.warn.threshold),
            _ => (difference.failing, self.fail.threshold),
        };
        let _ = writeln!(
            text,
            "{}: {} of {} pixels differ by more than {threshold:e} in a channel",
            self.result,
            grouped(count),
            grouped(difference.pixels)
        );
        text
    }
}

/// Why two images cannot be compared.
fn mismatch(one: &ImagePlanes, other: &ImagePlanes, channels: &[String]) -> Option<String> {
    let (a, b) = (one.size(), other.size());
    if (a.width, a.height) != (b.width, b.height) {
        return Some(format!("{}x{} pixels against {}x{}", a.width, a.height, b.width, b.height));
    }
    let lacking = |image: &ImagePlanes, name: &str| image.channel(name).is_none();
    for (image, reference, which) in [(one, other, "first"), (other, one, "second")] {
        let wanted = reference.channels().iter().map(|channel| channel.name.as_str());
        let absent = match channels {
            [] => wanted.filter(|name| lacking(image, name)).collect::<Vec<_>>(),
            some => some.iter().map(String::as_str).filter(|name| lacking(image, name)).collect(),
        };
        if let Some(first) = absent.first() {
            let more = match absent.len() {
                1 => String::new(),
                many => format!(" and {} more", many - 1),
            };
            return Some(format!("the {which} image has no channel {first}{more}"));
        }
    }
    None
}

fn short(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.3e}") }
}

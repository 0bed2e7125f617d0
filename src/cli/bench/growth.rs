//! How costs grow: one thing after the other is made larger, and the rest stays.

use super::{Args, USUAL_SIZE, expect_lights, part};
use crate::cli::options::LightOptions;
use crate::cli::progress::Messages;
use crate::cli::view::View;
use crate::error::{Error, Result};
use crate::measure::bench::Order;
use crate::report::bench::document::Document;
use crate::scene::ImageSize;
use crate::scene::formats::{self, SceneFiles};
use crate::scene::procedural::{Builtin, SizeFactor, find};
use clap::ValueEnum;
use std::path::Path;

/// What is made larger.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Growth {
    /// Size factors of a built-in scene
    Triangles,
    /// Lights of the fixed ring, 1 to 64
    Lights,
    /// The image, 0.25 to 8 million pixels
    Pixels,
}

/// Steps of a scene's size factor at most.
const STEPS: u32 = 9;

const LIGHTS: [u32; 7] = [1, 2, 4, 8, 16, 32, 64];

/// Of 16 : 9, up to 8 million pixels.
const SIZES: [[u32; 2]; 6] = [[666, 375], [942, 530], [1333, 750], [1885, 1061], [2666, 1500], [3771, 2121]];

impl Growth {
    /// Files of plots.
    pub const FILES: [&str; 3] = ["growth-triangles.svg", "growth-lights.svg", "growth-pixels.svg"];

    fn name(self) -> &'static str {
        match self {
            Growth::Triangles => "triangles",
            Growth::Lights => "lights",
            Growth::Pixels => "pixels",
        }
    }

    /// Measures all steps of a scene.
    ///
    /// # Errors
    /// Those of the table, and that a scene has no size factor.
    pub fn measure(
        self,
        args: &Args,
        scene: &Path,
        threads: Option<u16>,
        document: &mut Document,
        messages: Messages,
    ) -> Result<()> {
        match self {
            Growth::Triangles => {
                let (builtin, range) = sized(scene)?;
                for factor in factors(range) {
                    let made = builtin.build(Some(factor))?;
                    let options = args.view_options(scene);
                    let view = View::of(made, SceneFiles::default(), &options, &args.lights, messages)?;
                    let triangles = u64::from(view.scene.primitive_count());
                    self.step((args, threads), &view, triangles, document, messages)?;
                }
            }
            Growth::Lights => {
                if args.lights.rig.is_some() || !args.lights.lights.is_empty() {
                    return Err(Error::Usage("--growth lights has lights of its own: 1 to 64".into()));
                }
                for count in LIGHTS {
                    let lights = LightOptions { lights: Vec::new(), rig: Some(count) };
                    let options = args.view_options(scene);
                    let view = View::load(&options, &lights, args.memory_limit(), messages)?;
                    self.step((args, threads), &view, u64::from(count), document, messages)?;
                }
            }
            Growth::Pixels => {
                let largest = args.size.pixels() as u64;
                for [width, height] in SIZES {
                    let size = ImageSize { width, height };
                    // A size that was asked for is the largest.
                    if args.size != USUAL_SIZE && size.pixels() as u64 > largest {
                        break;
                    }
                    let view = View { size, ..args.view(scene, messages)? };
                    self.step((args, threads), &view, size.pixels() as u64, document, messages)?;
                }
            }
        }
        Ok(())
    }

    /// Measures one; one that would need too much memory is left out.
    fn step(
        self,
        (args, threads): (&Args, Option<u16>),
        view: &View,
        at: u64,
        document: &mut Document,
        messages: Messages,
    ) -> Result<()> {
        expect_lights(view)?;
        match part(args, view, threads, &[Order::Tiles], messages) {
            Ok(part) => {
                document.growth.extend(part.growth(self.name(), at));
                Ok(())
            }
            Err(Error::Usage(why)) if why.contains("--memory-limit") => {
                messages.warn(&format!("{at} {} are left out: {why}", self.name()));
                Ok(())
            }
            Err(error) => Err(error),
        }
    }
}

/// A built-in scene that has a size factor.
fn sized(scene: &Path) -> Result<(&'static Builtin, SizeFactor)> {
    let text = scene.to_string_lossy();
    let Some(name) = text.strip_prefix(formats::BUILTIN_PREFIX) else {
        return Err(Error::Usage(format!("{text}: --growth triangles is for built-in scenes")));
    };
    let builtin = find(name)?;
    let no_size =
        || Error::Usage(format!("{text}: the scene has one size, and --growth triangles needs more"));
    Ok((builtin, builtin.size_factor.ok_or_else(no_size)?))
}

/// Size factors from the smallest to the largest, each as much larger as the one before, as far as whole numbers can.
fn factors(range: SizeFactor) -> Vec<u32> {
    let (low, high) = (f64::from(range.smallest), f64::from(range.largest));
    let factor =
        |step: u32| (low * libm::pow(high / low, f64::from(step) / f64::from(STEPS - 1))).round() as u32;
    let mut factors: Vec<u32> = (0..STEPS).map(factor).collect();
    factors.dedup();
    factors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_grow_from_the_smallest_to_the_largest() {
        let range = |smallest, largest| SizeFactor { smallest, standard: smallest, largest };
        assert_eq!(factors(range(1, 5)), [1, 2, 3, 4, 5]);
        let many = factors(range(22, 2200));
        assert_eq!((many[0], many[8], many.len()), (22, 2200, 9));
    }

    #[test]
    fn sizes_are_a_quarter_to_eight_million_pixels() {
        let pixels = SIZES.map(|[width, height]| f64::from(width * height) / 1e6);
        for (found, wanted) in pixels.iter().zip([0.25, 0.5, 1.0, 2.0, 4.0, 8.0]) {
            assert!((found / wanted - 1.0).abs() < 0.01, "{found} {wanted}");
        }
    }
}

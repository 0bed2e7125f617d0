//! OpenEXR files.

use super::{Desk, Outcome, refusal};
use lightbuffer::film::{ImagePlanes, read_exr, write_exr};

/// The most samples of an image that is written again.
const FEW_SAMPLES: usize = 1 << 12;

pub fn check(desk: &mut Desk, input: &[u8]) -> Outcome {
    desk.lay(&[("image.exr", input)]);
    let path = desk.path("image.exr");
    let image = match read_exr(&path) {
        Ok(image) => image,
        Err(error) => return Outcome::Refused(refusal(&path, &error)),
    };
    let pixels = image.size().pixels();
    assert!(pixels > 0 && !image.channels().is_empty());
    if let Some(window) = image.window() {
        let end = u64::from(window.first_row) + u64::from(image.size().height);
        assert!(window.of != image.size() && window.of.width == image.size().width);
        assert!(end <= u64::from(window.of.height));
    }
    assert!(image.channels().iter().all(|plane| plane.samples.len() == pixels));
    if pixels * image.channels().len() <= FEW_SAMPLES {
        let again = desk.path("again.exr");
        match write_exr(&again, &image) {
            Ok(()) => {
                let back = read_exr(&again).expect("what we wrote");
                assert_eq!((bits(&back), back.window()), (bits(&image), image.window()));
            }
            Err(error) => _ = refusal(&again, &error),
        }
    }
    Outcome::Loaded
}

/// An image with samples that can be compared if they are NaN.
#[derive(Debug, PartialEq)]
struct Bits<'a> {
    /// By name.
    channels: Vec<(&'a str, Vec<u32>)>,
    /// By name.
    attributes: Vec<(String, String)>,
}

fn bits(image: &ImagePlanes) -> Bits<'_> {
    let channels = image.channels().iter();
    let channels = channels.map(|c| (c.name.as_str(), c.samples.iter().map(|s| s.to_bits()).collect()));
    let mut bits = Bits { channels: channels.collect(), attributes: image.attributes().to_vec() };
    bits.channels.sort();
    bits.attributes.sort();
    bits
}

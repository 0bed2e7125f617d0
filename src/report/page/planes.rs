//! What is known of each pixel of an image, small enough for a page.
//!
//! A byte a pixel says what the channel `shadow.LIGHT.verdict` says beside who is right, and a bit of another byte what
//! each tester answered: everything that maps show follows from these. Neighbours are alike, so deflate makes a byte of
//! a hundred of them, and base64 makes that text.

use crate::error::{Error, Place, Result};
use crate::film::ImagePlanes;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::Serialize;
use std::io::Write;
use std::path::Path;

/// Of a byte of [`LightPlanes::codes`]: the query is on the very edge between light and shadow.
const TOUCHING: u8 = 16;

/// And how far to the left why Embree is wrong begins.
const CAUSE: u32 = 5;

/// The planes of a light, packed.
#[derive(Debug, Serialize)]
pub(super) struct LightPlanes {
    /// The light's name.
    pub(super) name: String,
    /// A byte a pixel: the code of the verdict from 0 to 8, plus 16 where the query is touching, plus 32 where Embree is
    /// wrong by its epsilon, 64 by the rounding of its input, 96 by its traversal.
    pub(super) codes: String,
    /// A byte a pixel for every eight testers, in their order: bit k says that the k-th of them calls it occluded.
    pub(super) masks: Vec<String>,
}

impl LightPlanes {
    /// From the channels of a light, whose part of their names is `channel`.
    ///
    /// # Errors
    /// If a channel is missing or holds what it never does.
    pub(super) fn read(
        path: &Path,
        image: &ImagePlanes,
        name: &str,
        channel: &str,
        testers: &[String],
    ) -> Result<LightPlanes> {
        let samples = |part: &str| samples(path, image, &format!("shadow.{channel}.{part}"));
        let width = image.size().width as usize;
        let wrong = |part: &str, at: usize, value: f32, expected: &str| {
            let (x, y) = (at % width, at / width);
            let message = format!("expected {expected} at pixel {x},{y}, found {value}");
            Error::input(path, Place::Element(format!("channel shadow.{channel}.{part}")), message)
        };
        let mut codes = Vec::with_capacity(image.size().pixels());
        for (at, &value) in samples("verdict")?.iter().enumerate() {
            let code = packed_code(value);
            codes.push(code.ok_or_else(|| wrong("verdict", at, value, "the code of a verdict"))?);
        }
        let mut masks = Vec::new();
        for group in testers.chunks(8) {
            let mut mask = vec![0_u8; codes.len()];
            for (bit, tester) in group.iter().enumerate() {
                for (at, &value) in samples(tester)?.iter().enumerate() {
                    match value {
                        0.0 => {}
                        1.0 => mask[at] |= 1 << bit,
                        _ => return Err(wrong(tester, at, value, "0 or 1")),
                    }
                }
            }
            masks.push(packed(&mask));
        }
        Ok(LightPlanes { name: name.into(), codes: packed(&codes), masks })
    }
}

/// The testers of a light that have a channel in an image, in the order of `names`.
pub(super) fn with_channels(image: &ImagePlanes, channel: &str, names: &[String]) -> Vec<String> {
    let has = |name: &&String| image.channel(&format!("shadow.{channel}.{name}")).is_some();
    names.iter().filter(has).cloned().collect()
}

/// Numbers of objects, three bytes each: first all lowest ones, then all middle ones, then all highest ones.
///
/// # Errors
/// If a channel is missing or holds what it never does.
pub(super) fn objects(path: &Path, image: &ImagePlanes) -> Result<String> {
    let samples = samples(path, image, "id.object")?;
    let largest = f64::from((1 << 24) - 1);
    if let Some(bad) = samples.iter().find(|&&id| !(0.0..=largest).contains(&f64::from(id))) {
        let place = Place::Element("channel id.object".into());
        return Err(Error::input(path, place, format!("expected numbers of objects, found {bad}")));
    }
    let byte = |shift: u32| samples.iter().map(move |&id| (id as u32 >> shift) as u8);
    Ok(packed(&byte(0).chain(byte(8)).chain(byte(16)).collect::<Vec<_>>()))
}

fn samples<'i>(path: &Path, image: &'i ImagePlanes, name: &str) -> Result<&'i [f32]> {
    let missing = || Error::input(path, Place::File, format!("there is no channel {name}"));
    image.channel(name).ok_or_else(missing)
}

fn packed_code(value: f32) -> Option<u8> {
    if !(0.0..400.0).contains(&value) || value.fract() != 0.0 {
        return None;
    }
    let code = value as u16;
    let (verdict, touching, cause) = (code % 10, code / 10 % 10, code / 100);
    let known = verdict <= 8 && touching <= 1;
    known.then(|| verdict as u8 | (touching as u8 * TOUCHING) | ((cause as u8) << CAUSE))
}

/// Deflated with zlib's header, in base64.
fn packed(bytes: &[u8]) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // Into memory: it cannot fail.
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    STANDARD.encode(written.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::ImageSize;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    fn unpacked(text: &str) -> Vec<u8> {
        let mut bytes = Vec::new();
        ZlibDecoder::new(&STANDARD.decode(text).unwrap()[..]).read_to_end(&mut bytes).unwrap();
        bytes
    }

    fn image(verdict: [f32; 4]) -> ImagePlanes {
        let mut image = ImagePlanes::new(ImageSize { width: 2, height: 2 });
        image.add_channel("shadow.key.verdict", verdict.to_vec()).unwrap();
        image.add_channel("shadow.key.exact", vec![0.0, 1.0, 0.0, 1.0]).unwrap();
        image.add_channel("shadow.key.embree", vec![0.0, 0.0, 1.0, 1.0]).unwrap();
        image.add_channel("id.object", vec![0.0, 1.0, 258.0, 65_536.0]).unwrap();
        image
    }

    #[test]
    fn codes_masks_and_objects_come_back() {
        let testers = ["exact".to_string(), "embree".to_string()];
        let image = image([0.0, 3.0, 12.0, 315.0]);
        let path = Path::new("image.exr");
        let planes = LightPlanes::read(path, &image, "Key", "key", &testers).unwrap();
        assert_eq!(unpacked(&planes.codes), [0, 3, 2 + 16, 5 + 16 + 96]);
        assert_eq!(planes.masks.iter().map(|mask| unpacked(mask)).collect::<Vec<_>>(), [[0, 1, 2, 3]]);
        let ids = unpacked(&objects(path, &image).unwrap());
        assert_eq!(ids, [0, 1, 2, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
        let named = ["exact", "none", "embree"].map(String::from);
        assert_eq!(with_channels(&image, "key", &named), ["exact", "embree"]);
    }

    #[test]
    fn what_no_run_writes_is_refused_with_its_place() {
        let path = Path::new("image.exr");
        for bad in [f32::NAN, -1.0, 2.5, 9.0, 22.0, 400.0, f32::INFINITY] {
            let error = LightPlanes::read(path, &image([0.0, 0.0, 0.0, bad]), "key", "key", &[]).unwrap_err();
            let text = error.to_string();
            assert!(text.starts_with("image.exr: channel shadow.key.verdict: expected"), "{text}");
            assert!(text.contains("at pixel 1,1"), "{text}");
        }
        let missing = LightPlanes::read(path, &image([0.0; 4]), "sun", "sun", &[]).unwrap_err().to_string();
        assert_eq!(missing, "image.exr: there is no channel shadow.sun.verdict");
    }
}

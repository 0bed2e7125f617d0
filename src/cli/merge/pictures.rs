//! Strips of whole rows become the picture.

use super::super::output;
use super::super::render::drawing::{SETTINGS_ATTRIBUTE, SHARD_ATTRIBUTE};
use super::super::render::preview;
use super::super::settings::{Settings, printable};
use crate::error::{Error, Place, Result};
use crate::film::{FileSet, ImagePlanes, add_exr, read_exr};
use crate::scene::{ImageSize, Window};
use std::path::Path;

/// A strip and what it says of itself.
struct Strip<'p> {
    path: &'p Path,
    planes: ImagePlanes,
    window: Window,
    settings: Settings,
}

impl Strip<'_> {
    fn wrong(&self, what: impl Into<String>) -> Error {
        Error::input(self.path, Place::File, what)
    }

    /// The row after its last one.
    fn end(&self) -> u32 {
        self.window.first_row + self.planes.size().height
    }
}

/// Adds the whole picture and its preview.
///
/// # Errors
/// A line about the first file that is no strip, or does not fit those before it, or about rows that are missing or there
/// twice.
pub fn add(files: &mut FileSet, picture: &Path, shards: &[&Path]) -> Result<()> {
    let strips: Vec<Strip> = shards.iter().map(|path| read(path)).collect::<Result<_>>()?;
    let (first, rest) = strips.split_first().expect("a strip");
    rest.iter().try_for_each(|strip| agree(strip, first))?;
    let Some((background, exposure)) = first.settings.preview() else {
        return Err(first.wrong("no shard of render: its settings have no background and exposure"));
    };
    let whole = joined(strips)?;
    add_exr(files, picture, &whole)?;
    output::add_preview(files, &preview(picture), &whole, background, exposure)
}

fn read(path: &Path) -> Result<Strip<'_>> {
    let planes = read_exr(path)?;
    let wrong = |what: &str| Error::input(path, Place::File, what.to_owned());
    let settings =
        planes.attribute(SETTINGS_ATTRIBUTE).filter(|_| planes.attribute(SHARD_ATTRIBUTE).is_some());
    let settings = settings.ok_or_else(|| wrong("no shard of render: expected what --shard wrote"))?;
    let settings = serde_json::from_str(settings)
        .map_err(|_| wrong("no shard of render: its settings cannot be read"))?;
    // The only strip of a picture is all of it.
    let window = planes.window().unwrap_or(Window { of: planes.size(), first_row: 0 });
    Ok(Strip { path, planes, window, settings })
}

/// Attributes without those that name the part, by name.
fn attributes(planes: &ImagePlanes) -> Vec<(&str, &str)> {
    let ours = |name: &str| name == SHARD_ATTRIBUTE || name == SETTINGS_ATTRIBUTE;
    let all = planes.attributes().iter().map(|(name, text)| (name.as_str(), text.as_str()));
    let mut attributes: Vec<_> = all.filter(|(name, _)| !ours(name)).collect();
    attributes.sort_unstable();
    attributes
}

fn channels(planes: &ImagePlanes) -> Vec<&str> {
    let mut names: Vec<_> = planes.channels().iter().map(|plane| plane.name.as_str()).collect();
    names.sort_unstable();
    names
}

/// Whether a strip is of the same picture as the first that was named.
fn agree(strip: &Strip, first: &Strip) -> Result<()> {
    let as_in = first.path.display();
    if let Some(difference) = strip.settings.difference(&first.settings) {
        return Err(strip.wrong(format!("of another picture: {difference} as in {as_in}")));
    }
    let (size, expected) = (strip.window.of, first.window.of);
    if size != expected {
        return Err(strip.wrong(format!(
            "of another picture: {}x{} pixels, expected {}x{} as in {as_in}",
            size.width, size.height, expected.width, expected.height
        )));
    }
    let (found, wanted) = (attributes(&strip.planes), attributes(&first.planes));
    if found != wanted {
        // Attributes are sorted, so the first that is in one list alone is where they part.
        let odd = found.iter().chain(&wanted).find(|pair| !(found.contains(pair) && wanted.contains(pair)));
        let name = odd.map_or("", |(name, _)| name);
        let show = |planes: &ImagePlanes| {
            planes.attribute(name).map_or("nothing".into(), |text| format!("`{}`", printable(text)))
        };
        let (found, wanted) = (show(&strip.planes), show(&first.planes));
        return Err(
            strip.wrong(format!("of another picture: {name} is {found}, expected {wanted} as in {as_in}"))
        );
    }
    let (found, wanted) = (channels(&strip.planes), channels(&first.planes));
    if found != wanted || strip.planes.frame_rate() != first.planes.frame_rate() {
        return Err(
            strip.wrong(format!("of another picture: other channels or frames a second than in {as_in}"))
        );
    }
    Ok(())
}

/// The picture of strips that agree.
fn joined(mut strips: Vec<Strip>) -> Result<ImagePlanes> {
    strips.sort_by_key(|strip| strip.window.first_row);
    let of = strips[0].window.of;
    let mut next = 0;
    let mut before: Option<&Strip> = None;
    for strip in &strips {
        let first = strip.window.first_row;
        match before {
            Some(before) if first < next => {
                let (last, other) = (next.min(strip.end()) - 1, before.path.display());
                return Err(strip.wrong(format!("rows {first} to {last} are in {other} too")));
            }
            _ if first > next => return Err(missing(next, first)),
            _ => (next, before) = (strip.end(), Some(strip)),
        }
    }
    if next < of.height {
        return Err(missing(next, of.height));
    }
    whole(strips, of)
}

fn missing(first: u32, end: u32) -> Error {
    Error::Usage(format!("rows {first} to {} are missing: no shard that was named holds them", end - 1))
}

/// The picture of strips that are all of it, from the top.
fn whole(mut strips: Vec<Strip>, of: ImageSize) -> Result<ImagePlanes> {
    let mut whole = ImagePlanes::new(of);
    let first = &strips[0].planes;
    for (name, text) in attributes(first) {
        whole.add_attribute(name, text)?;
    }
    first.frame_rate().into_iter().for_each(|rate| whole.set_frame_rate(rate));
    let names: Vec<String> = channels(first).into_iter().map(str::to_owned).collect();
    for name in names {
        let mut samples = Vec::with_capacity(of.pixels());
        for strip in &mut strips {
            // Given away, so that the picture is in memory once, and not twice.
            samples.extend(strip.planes.take_channel(&name).unwrap_or_default());
        }
        whole.add_channel(name, samples)?;
    }
    Ok(whole)
}

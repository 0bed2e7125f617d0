//! Maps to look into: what the script is given, and what stands there before it runs.

use super::documents::Validation;
use super::picture::{self, Embedded};
use super::planes::{self, LightPlanes};
use crate::error::{Error, Place, Result};
use crate::film::{RARE_PIXELS, palette, read_exr, unique_safe_names};
use crate::scene::ImageSize;
use askama::Template;
use serde::Serialize;
use std::path::Path;

/// The arbiter: the mask that maps are held against.
const TRUTH: &str = "exact";

/// One scene's maps.
#[derive(Debug, Template)]
#[template(path = "viewer.html")]
pub(super) struct Viewer {
    pub(super) id: String,
    scene: String,
    size: ImageSize,
    picture: Embedded,
    lights: Vec<String>,
    data: String,
    /// What is written in the image about itself.
    pub(super) attributes: Vec<(String, String)>,
}

/// What the script reads.
#[derive(Serialize)]
struct Data<'a> {
    width: u32,
    height: u32,
    /// In the order of the bits of masks.
    testers: &'a [String],
    truth: &'static str,
    /// Whose shadows the picture shows.
    shadow: &'a str,
    lights: Vec<LightPlanes>,
    objects: String,
    /// A command but for its pixel and light.
    replay: String,
    /// Names of the lights as words of a shell.
    quoted: Vec<String>,
    /// So many pixels of a whole image are still rare.
    rare: u64,
    classes: [Class; 13],
    differences: [Class; 7],
}

/// A category of a map; %a and %b in its label are the two testers.
#[derive(Serialize)]
struct Class {
    label: &'static str,
    colour: [u8; 3],
    /// Whether it is to be found whatever it takes.
    wrong: bool,
}

const fn right(label: &'static str, colour: [u8; 3]) -> Class {
    Class { label, colour, wrong: false }
}

const fn wrong(label: &'static str, colour: [u8; 3]) -> Class {
    Class { label, colour, wrong: true }
}

/// The first nine are the codes of verdicts.
const CLASSES: [Class; 13] = [
    right("background", palette::BACKGROUND),
    right("faces away", palette::FACING_AWAY),
    right("lit", palette::LIT),
    right("occluded", palette::SHADOWED),
    wrong("%a wrong", palette::VERMILLION),
    wrong("%b wrong", palette::BLUISH_GREEN),
    wrong("both wrong", palette::REDDISH_PURPLE),
    right("outside the cone", palette::OUTSIDE_CONE),
    right("receives no shadows", palette::NOT_RECEIVING),
    right("touching, all right", palette::YELLOW),
    wrong("%b wrong: epsilon", palette::SKY_BLUE),
    wrong("%b wrong: input rounding", palette::BLUE),
    wrong("%b wrong: traversal", palette::ORANGE),
];

const DIFFERENCES: [Class; 7] = [
    right("background", palette::BACKGROUND),
    right("faces away or outside the cone", palette::FACING_AWAY),
    right("receives no shadows", palette::NOT_RECEIVING),
    right("both lit", palette::LIT),
    right("both occluded", palette::SHADOWED),
    wrong("only %a occluded", palette::VERMILLION),
    wrong("only %b occluded", palette::SKY_BLUE),
];

impl Viewer {
    /// From the images beside a document.
    ///
    /// # Errors
    /// If they are missing, or are not those of the document.
    pub(super) fn read(id: String, document: &Path, validation: &Validation) -> Result<Viewer> {
        let path = document.with_file_name("image.exr");
        let image = read_exr(&path)?;
        let size = ImageSize { width: validation.width, height: validation.height };
        let picture_path = document.with_file_name("image.png");
        let picture = picture::png(&picture_path)?;
        for (path, found) in [(&path, image.size()), (&picture_path, picture.size)] {
            if (found.width, found.height) != (size.width, size.height) {
                let message = format!(
                    "{}x{} pixels, but validate.json says {}x{}",
                    found.width, found.height, size.width, size.height
                );
                return Err(Error::input(path, Place::File, message));
            }
        }
        let names: Vec<String> = validation.lights.iter().map(|light| light.name.clone()).collect();
        let channels = unique_safe_names(&names);
        let mut known: Vec<String> = validation.totals.testers.keys().cloned().collect();
        // The truth first, and whose shadows these are; the rest as they come.
        let shadow = image.attribute("shadow").unwrap_or("light-buffer").to_string();
        known.sort_by_key(|name| (name != TRUTH, *name != shadow));
        // A tester that some light is too far away for has no mask there.
        let everywhere =
            |name: &String| channels.iter().all(|c| image.channel(&format!("shadow.{c}.{name}")).is_some());
        let mut testers: Vec<String> = match channels.first() {
            Some(first) => planes::with_channels(&image, first, &known),
            None => Vec::new(),
        };
        testers.retain(everywhere);
        if !testers.iter().any(|name| name == TRUTH) {
            return Err(Error::input(
                &path,
                Place::File,
                format!("there is no channel shadow.LIGHT.{TRUTH}"),
            ));
        }
        let planes = names
            .iter()
            .zip(&channels)
            .map(|(name, channel)| LightPlanes::read(&path, &image, name, channel, &testers));
        let data = Data {
            width: size.width,
            height: size.height,
            testers: &testers,
            truth: TRUTH,
            shadow: &shadow,
            lights: planes.collect::<Result<_>>()?,
            objects: planes::objects(&path, &image)?,
            replay: replay(validation),
            quoted: names.iter().map(|name| shell_word(name)).collect(),
            rare: RARE_PIXELS,
            classes: CLASSES,
            differences: DIFFERENCES,
        };
        // Within a script element nothing but `<` could end it.
        let data = serde_json::to_string(&data).map_err(|e| Error::Usage(format!("the page: {e}")))?;
        let data = data.replace('<', "\\u003c");
        let attributes = image.attributes().to_vec();
        Ok(Viewer { id, scene: validation.scene.clone(), size, picture, lights: names, data, attributes })
    }
}

/// A command for a shell that asks a pixel of the same view, but for the pixel and the light.
fn replay(validation: &Validation) -> String {
    if !validation.replay.is_empty() {
        return validation.replay.iter().map(|word| shell_word(word)).collect::<Vec<_>>().join(" ");
    }
    let (width, height) = (validation.width, validation.height);
    format!("lightbuffer replay {} --size {width}x{height}", shell_word(&validation.scene))
}

/// A word that a shell takes as it stands.
fn shell_word(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,=+@".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.into(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_go_through_a_shell_unchanged() {
        for word in ["scenes/a.obj", "", "it's", "a b", "$HOME", "`id`", "1,2,-3", "a\\b"] {
            let script = format!("printf %s {}", shell_word(word));
            let output = std::process::Command::new("sh").args(["-c", &script]).output().unwrap();
            assert_eq!(String::from_utf8(output.stdout).unwrap(), word);
        }
        assert_eq!(shell_word("scenes/a.obj"), "scenes/a.obj");
    }
}

//! Images of textures, as files beside a scene.

use super::Complaint;
use crate::atomic::FileSet;
use crate::error::Result;
use crate::scene::formats::limits::MAX_IMAGE_TEXELS;
use crate::scene::{Image, Pattern, Scene, Texels};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

/// The images of a scene's textures, each once.
pub(super) struct Files<'a> {
    /// What the names begin with.
    stem: String,
    images: Vec<&'a Arc<Image>>,
}

impl<'a> Files<'a> {
    /// The images of the textures of a scene that is written to `path`.
    ///
    /// # Errors
    /// If one cannot be written as PNG.
    pub(super) fn of(scene: &'a Scene, path: &Path) -> std::result::Result<Files<'a>, Complaint> {
        // Only what a scene's file may name, on every platform.
        let plain = |c: char| if c.is_alphanumeric() || "-_. ".contains(c) { c } else { '_' };
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().chars().map(plain).collect();
        let mut images: Vec<&Arc<Image>> = Vec::new();
        for (index, texture) in scene.textures.iter().enumerate() {
            let Pattern::Image { image, .. } = &texture.pattern else { continue };
            let texels = u64::from(image.width) * u64::from(image.height);
            let why = match image.texels {
                Texels::Linear(_) => Some("an image in floats, and PNG has none".to_owned()),
                Texels::Srgb(_) if texels > MAX_IMAGE_TEXELS => {
                    Some(format!("{texels} texels, expected at most {MAX_IMAGE_TEXELS}"))
                }
                Texels::Srgb(_) => None,
            };
            if let Some(why) = why {
                return Err((format!("texture {}", index + 1), why));
            }
            if !images.iter().any(|known| Arc::ptr_eq(known, image)) {
                images.push(image);
            }
        }
        Ok(Files { stem, images })
    }

    /// The file of an image of the scene.
    pub(super) fn name(&self, image: &Arc<Image>) -> String {
        let index = self.images.iter().position(|known| Arc::ptr_eq(known, image)).unwrap_or_default();
        format!("{}-texture-{}.png", self.stem, index + 1)
    }

    /// Writes all of them into the folder of the scene's file.
    ///
    /// # Errors
    /// What the operating system refuses.
    pub(super) fn write(&self, scene: &Path, files: &mut FileSet) -> Result<()> {
        for image in &self.images {
            let Texels::Srgb(texels) = &image.texels else { continue };
            files.write(&scene.with_file_name(self.name(image)), |file| {
                let (width, height) = (image.width, image.height);
                let mut buffered = io::BufWriter::new(file);
                let encoder = PngEncoder::new(&mut buffered);
                let written =
                    encoder.write_image(texels.as_flattened(), width, height, ExtendedColorType::Rgb8);
                written.map_err(io::Error::other)?;
                buffered.flush()
            })?;
        }
        Ok(())
    }
}

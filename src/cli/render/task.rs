//! What one process does of a run: which pictures, or which part of each, and where they go.

use super::frame_names::FrameNames;
use super::manifest::Manifest;
use super::shard::{Shard, ShardBy};
use super::{Args, preview};
use crate::error::{Error, Result};
use std::path::PathBuf;

/// The files of a run.
pub struct Task {
    pub pictures: Pictures,
    /// Which part of the run it is.
    pub shard: Option<Shard>,
    /// That, if it is a strip of each picture.
    pub tile: Option<Shard>,
    /// Where it says what is finished. A single picture that nobody goes on with has none.
    pub manifest: Option<PathBuf>,
}

/// Its pictures.
pub enum Pictures {
    One(PathBuf),
    /// These frames, ascending. A part of a short list can have none.
    Frames(Vec<u32>, FrameNames),
}

impl Task {
    /// # Errors
    /// Names that are none for frames, or frames without such.
    pub fn of(args: &Args) -> Result<Task> {
        let usual = if args.frames.is_some() { ShardBy::Frames } else { ShardBy::Tiles };
        let by = args.shard_by.unwrap_or(usual);
        let tile = args.shard.filter(|_| by == ShardBy::Tiles);
        let pictures = match &args.frames {
            None if by == ShardBy::Frames => {
                return Err(Error::Usage(
                    "--shard-by frames: there is no list of frames; say --frames".into(),
                ));
            }
            None => Pictures::One(tile.map_or_else(|| args.output.clone(), |tile| tile.path(&args.output))),
            Some(frames) => {
                let names = FrameNames::of(&args.output).map_err(|why| Error::Usage(format!("-o: {why}")))?;
                let names = tile.map_or(names.clone(), |tile| names.with_suffix(&tile.suffix()));
                let numbers = frames.numbers();
                let numbers = match (args.shard, by) {
                    (Some(shard), ShardBy::Frames) => &numbers[shard.run(numbers.len())],
                    _ => numbers,
                };
                Pictures::Frames(numbers.to_vec(), names)
            }
        };
        let is_recorded = args.frames.is_some() || args.shard.is_some() || args.resume;
        let manifest = is_recorded.then(|| Manifest::path(&args.output, args.shard));
        Ok(Task { pictures, shard: args.shard, tile, manifest })
    }

    /// All files, each picture with its preview.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> + '_ {
        let with_preview = |picture: PathBuf| [picture.clone(), preview(&picture)];
        let (one, frames) = match &self.pictures {
            Pictures::One(picture) => (Some(picture.clone()), None),
            Pictures::Frames(numbers, names) => (None, Some((numbers, names))),
        };
        let frames =
            frames.into_iter().flat_map(|(numbers, names)| numbers.iter().map(|&frame| names.path(frame)));
        one.into_iter().chain(frames).flat_map(with_preview).chain(self.manifest.clone())
    }

    /// One of each kind: all are in one folder.
    pub fn samples(&self) -> impl Iterator<Item = PathBuf> + '_ {
        self.files().take(2).chain(self.manifest.clone())
    }
}

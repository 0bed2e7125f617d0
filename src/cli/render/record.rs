//! What a run records of its pictures, if it records any.

use super::super::Outcome;
use super::super::progress::Messages;
use super::super::settings::{FRAMES, Settings};
use super::manifest::{Beginning, Manifest};
use super::task::Task;
use super::{Args, preview};
use crate::error::Result;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// The manifest of a run that has one, and how the pictures came out that were there already.
pub struct Record {
    manifest: Option<Manifest>,
    outcome: Outcome,
}

impl Record {
    /// Begins it or goes on with it; nothing is written yet. The list of frames may be another than before.
    ///
    /// # Errors
    /// If it cannot be gone on with.
    pub fn begin(task: &Task, args: &Args, settings: &Settings) -> Result<Record> {
        let beginning = if args.resume { Beginning::Resumed } else { Beginning::Anew };
        let begin = |path| {
            let mut settings = settings.clone().without(FRAMES);
            if let Some(shard) = task.tile {
                settings.add("tile", shard.to_string());
            }
            Manifest::begin(path, settings, beginning)
        };
        Ok(Record { manifest: task.manifest.clone().map(begin).transpose()?, outcome: Outcome::Right })
    }

    /// What is recorded of a picture whose files are as they were.
    pub fn finished<T: DeserializeOwned>(&mut self, picture: &Path) -> Option<T> {
        let finished = self.manifest.as_ref()?.finished(picture, &preview(picture))?;
        let facts = serde_json::from_value(finished.facts.clone()).ok()?;
        if !finished.right {
            self.outcome = Outcome::NativeWrong;
        }
        Some(facts)
    }

    /// How those that are finished came out.
    pub fn outcome(&self) -> Outcome {
        self.outcome
    }

    /// Says how many of all are there already.
    pub fn tell(&self, kept: usize, all: usize, messages: Messages) {
        if let (1.., Some(manifest)) = (kept, &self.manifest) {
            let place = manifest.place().display();
            messages
                .say(&format!("{kept} of {all} pictures are finished, says {place}, and not drawn again"));
        }
    }

    /// Writes it as it is, where there is no picture to do that.
    ///
    /// # Errors
    /// If that is not possible.
    pub fn write(&self) -> Result<()> {
        self.manifest.as_ref().map_or(Ok(()), Manifest::write)
    }

    /// Records a picture whose files are there.
    ///
    /// # Errors
    /// If that is not possible.
    pub fn add(&mut self, picture: &Path, outcome: Outcome, facts: &impl Serialize) -> Result<()> {
        let right = outcome == Outcome::Right;
        let add = |manifest: &mut Manifest| manifest.add(picture, &preview(picture), right, facts);
        self.manifest.as_mut().map_or(Ok(()), add)
    }
}

//! A disagreement as two files: the scene, with light and camera, and what is asked of it in which settings.

use super::judge::{Depth, Judge, Kind};
use super::recipe::{Aim, Batch, Recipe, Settings, Threads};
use crate::atomic::write_atomically;
use crate::error::{Error, Place, Result};
use crate::scene::formats;
use crate::shadow::light_buffer::MOST_CELLS;
use crate::shadow::{Culling, ObjectCoherence, Receivers, Resolution, VolumeThreshold};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The longest file that is read as a finding.
const MOST_BYTES: u64 = 1 << 20;

/// A recipe in which two that should agree do not.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What is wrong.
    pub kind: Kind,
    /// Where it was found, before it was made small: scene `number` of `seed`.
    pub seed: u64,
    /// The number of the scene.
    pub number: u64,
    /// The smallest recipe that shows it, in one settings.
    pub recipe: Recipe,
}

/// The file of a finding. Numbers that matter are bits, so that nothing is rounded on the way.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    version: u32,
    scene: String,
    seed: u64,
    number: u64,
    who: String,
    what: super::judge::What,
    settings: SettingsEntry,
    #[serde(default, rename = "point")]
    points: Vec<PointEntry>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SettingsEntry {
    /// Cells along an edge of the light buffer; as many as it takes by itself if that is missing.
    #[serde(default)]
    resolution: Option<u32>,
    #[serde(default)]
    cull_solids: bool,
    #[serde(default)]
    volume_threshold: Option<u32>,
    #[serde(default)]
    object_coherence: bool,
    #[serde(default)]
    surfaces_only: bool,
    #[serde(default)]
    one_by_one: bool,
    #[serde(default)]
    two_threads: bool,
}

/// Either a place, or the first hit of a ray.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, untagged)]
enum PointEntry {
    At { bits: [u32; 3] },
    Seen { eye_bits: [u32; 3], direction_bits: [u32; 3] },
}

impl Finding {
    /// The name of its file: who is wrong in what, and where it was found.
    pub fn name(&self) -> String {
        let what = toml::Value::try_from(self.kind.what).ok();
        let what = what.as_ref().and_then(toml::Value::as_str).unwrap_or("difference").to_owned();
        format!("{}-{what}-{}-{}", self.kind.who, self.seed, self.number)
    }

    /// Writes both files into a folder that is there, and returns the finding's own.
    ///
    /// # Errors
    /// If they cannot be written, or TOML cannot say the scene.
    pub fn save(&self, folder: &Path) -> Result<PathBuf> {
        let name = self.name();
        let scene = format!("{name}.scene.toml");
        formats::save(&self.recipe.case().scene, &folder.join(&scene))?;
        let document = Document {
            version: 1,
            scene,
            seed: self.seed,
            number: self.number,
            who: self.kind.who.clone(),
            what: self.kind.what,
            settings: SettingsEntry::of(&self.recipe.settings[0]),
            points: self.recipe.aims.iter().map(PointEntry::of).collect(),
        };
        let path = folder.join(format!("{name}.toml"));
        let text = toml::to_string(&document).map_err(|error| Error::Usage(error.to_string()))?;
        write_atomically(&path, |file| file.write_all(text.as_bytes()))?;
        Ok(path)
    }

    /// Reads a finding and its scene, which lies beside it.
    ///
    /// # Errors
    /// One line with the file and what is wrong with it.
    pub fn load(path: &Path) -> Result<Finding> {
        let refuse = |why: String| Error::input(path, Place::File, why);
        let read = |source| Error::io(path, "read", source);
        let bytes = path.metadata().map_err(read)?.len();
        if bytes > MOST_BYTES {
            return Err(refuse(format!("{bytes} bytes, expected at most {MOST_BYTES}")));
        }
        let text = std::fs::read_to_string(path).map_err(read)?;
        let document: Document = toml::from_str(&text).map_err(|error| {
            let line = error.span().map(|span| text[..span.start].matches('\n').count() + 1);
            Error::input(path, line.map_or(Place::File, Place::Line), error.message())
        })?;
        if document.version != 1 {
            return Err(refuse(format!("expected version 1, found {}", document.version)));
        }
        if Path::new(&document.scene).file_name() != Some(document.scene.as_ref()) {
            return Err(refuse("expected the name of a scene in the same folder".into()));
        }
        let settings = document.settings.settings().map_err(refuse)?;
        let aims = document.points.iter().map(|point| point.aim().ok_or("a point or ray that is not finite"));
        let aims = aims.collect::<std::result::Result<_, _>>().map_err(|why| refuse(why.into()))?;
        let scene = formats::load(&path.with_file_name(&document.scene))?;
        let recipe = Recipe::of(&scene, aims, settings);
        let recipe = recipe.ok_or_else(|| refuse("expected a scene with a light and a camera".into()))?;
        let kind = Kind { who: document.who, what: document.what };
        Ok(Finding { kind, seed: document.seed, number: document.number, recipe })
    }

    /// Whether the same is still wrong.
    pub fn is_still_there(&self, judge: &Judge) -> bool {
        let judged = judge.judge(&self.recipe, Depth::All);
        judged.disagreements.iter().any(|disagreement| disagreement.kind == self.kind)
    }
}

impl SettingsEntry {
    fn of(settings: &Settings) -> SettingsEntry {
        SettingsEntry {
            resolution: match settings.resolution {
                Resolution::Auto => None,
                Resolution::Cells(cells) => Some(cells),
            },
            cull_solids: settings.culling == Culling::ClosedSolids,
            volume_threshold: match settings.bounding_volumes {
                VolumeThreshold::Off => None,
                VolumeThreshold::MoreThan(most) => Some(most),
            },
            object_coherence: settings.object_coherence == ObjectCoherence::LastOccluder,
            surfaces_only: settings.receivers == Receivers::Surfaces,
            one_by_one: settings.batch == Batch::One,
            two_threads: settings.threads == Threads::Two,
        }
    }

    fn settings(&self) -> std::result::Result<Settings, String> {
        if let Some(cells) = self.resolution
            && !(1..=MOST_CELLS).contains(&cells)
        {
            return Err(format!("expected a resolution from 1 to {MOST_CELLS}, found {cells}"));
        }
        let coherence = [ObjectCoherence::Off, ObjectCoherence::LastOccluder];
        Ok(Settings {
            resolution: self.resolution.map_or(Resolution::Auto, Resolution::Cells),
            culling: [Culling::Off, Culling::ClosedSolids][usize::from(self.cull_solids)],
            bounding_volumes: self.volume_threshold.map_or(VolumeThreshold::Off, VolumeThreshold::MoreThan),
            object_coherence: coherence[usize::from(self.object_coherence)],
            receivers: [Receivers::Anywhere, Receivers::Surfaces][usize::from(self.surfaces_only)],
            batch: [Batch::All, Batch::One][usize::from(self.one_by_one)],
            threads: [Threads::One, Threads::Two][usize::from(self.two_threads)],
        })
    }
}

impl PointEntry {
    fn of(aim: &Aim) -> PointEntry {
        let bits = |vector: Vec3| vector.to_array().map(f32::to_bits);
        match *aim {
            Aim::At(place) => PointEntry::At { bits: bits(place) },
            Aim::Seen { eye, direction } => {
                PointEntry::Seen { eye_bits: bits(eye), direction_bits: bits(direction) }
            }
        }
    }

    fn aim(&self) -> Option<Aim> {
        let vector = |bits: [u32; 3]| Vec3::from_array(bits.map(f32::from_bits));
        match *self {
            PointEntry::At { bits } => vector(bits).is_finite().then_some(Aim::At(vector(bits))),
            PointEntry::Seen { eye_bits, direction_bits } => {
                let (eye, direction) = (vector(eye_bits), vector(direction_bits));
                let sound = eye.is_finite() && direction.is_finite() && direction != Vec3::ZERO;
                sound.then_some(Aim::Seen { eye, direction })
            }
        }
    }
}

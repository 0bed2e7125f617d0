//! Which pictures of a run are finished: a file beside them that is written anew after each, so that a run that was killed
//! goes on where it was.

use super::super::output::add_json;
use super::super::read_json::read_json;
use super::super::settings::Settings;
use super::shard::Shard;
use crate::atomic::FileState;
use crate::error::{Error, Place, Result};
use crate::film::FileSet;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Whether pictures that are there already are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beginning {
    /// All are drawn.
    Anew,
    /// Those are drawn that the manifest does not list, or that are not as it says.
    Resumed,
}

/// The manifest of a run.
#[derive(Debug)]
pub struct Manifest {
    path: PathBuf,
    content: Content,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Content {
    settings: Settings,
    /// By the name of the OpenEXR file.
    pictures: BTreeMap<String, Finished>,
}

/// A picture that is finished.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finished {
    exr: FileState,
    png: FileState,
    /// Whether no native answer was found to be wrong.
    pub right: bool,
    /// What `--json` says about it.
    pub facts: Value,
}

impl Manifest {
    /// The name beside `-o`: with `.manifest.json` in place of the extension, and without the place for the number of a
    /// frame; that of a part says which it is.
    pub fn path(output: &Path, shard: Option<Shard>) -> PathBuf {
        let stem = output.file_stem().unwrap_or_default().to_string_lossy().replace('#', "");
        let stem = stem.trim_end_matches(['.', '_', '-']);
        let stem = if stem.is_empty() { "frames" } else { stem };
        let suffix = shard.map(Shard::suffix).unwrap_or_default();
        output.with_file_name(format!("{stem}{suffix}.manifest.json"))
    }

    /// Where it is.
    pub fn place(&self) -> &Path {
        &self.path
    }

    /// That of a run with these settings. If it goes on, what is recorded at the path is read, if anything is.
    ///
    /// # Errors
    /// A manifest that cannot be read, or one of other settings.
    pub fn begin(path: PathBuf, settings: Settings, beginning: Beginning) -> Result<Manifest> {
        let recorded = match beginning {
            Beginning::Anew => None,
            Beginning::Resumed => read(&path)?,
        };
        let content = match recorded {
            None => Content { settings, pictures: BTreeMap::new() },
            Some(content) => match content.settings.difference(&settings) {
                None => content,
                Some(difference) => {
                    let why = format!("--resume: the settings were others: {difference} by this run");
                    return Err(Error::input(&path, Place::File, why));
                }
            },
        };
        Ok(Manifest { path, content })
    }

    /// What is recorded of a picture, if its files are still as recorded.
    pub fn finished(&self, exr: &Path, png: &Path) -> Option<&Finished> {
        let finished = self.content.pictures.get(&name(exr))?;
        (finished.exr.is_still(exr) && finished.png.is_still(png)).then_some(finished)
    }

    /// Records a picture whose files are there.
    ///
    /// # Errors
    /// If they cannot be read, or the manifest cannot be written.
    pub fn add(&mut self, exr: &Path, png: &Path, right: bool, facts: &impl Serialize) -> Result<()> {
        let facts = serde_json::to_value(facts).map_err(|error| Error::Usage(format!("JSON: {error}")))?;
        let finished = Finished { exr: FileState::of(exr)?, png: FileState::of(png)?, right, facts };
        self.content.pictures.insert(name(exr), finished);
        self.write()
    }

    /// Writes it.
    ///
    /// # Errors
    /// If that is not possible.
    pub fn write(&self) -> Result<()> {
        let mut files = FileSet::new();
        add_json(&mut files, &self.path, &self.content)?;
        files.publish()
    }
}

/// All pictures are in the manifest's folder.
fn name(picture: &Path) -> String {
    picture.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What is at the path, if anything is.
fn read(path: &Path) -> Result<Option<Content>> {
    match File::open(path) {
        Ok(file) => read_json(file, path, "the manifest of a run of render").map(Some),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(Error::io(path, "read", error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(depth: &str) -> Settings {
        let mut settings = Settings::default();
        settings.add("depth", depth);
        settings
    }

    #[test]
    fn it_stands_beside_the_pictures() {
        for (output, path) in [
            ("a/out.exr", "a/out.manifest.json"),
            ("shot.####.exr", "shot.manifest.json"),
            ("x_##.exr", "x.manifest.json"),
            ("####.exr", "frames.manifest.json"),
        ] {
            assert_eq!(Manifest::path(Path::new(output), None), Path::new(path));
        }
        let part = Manifest::path(Path::new("shot.####.exr"), Some(Shard::parse("2/8").unwrap()));
        assert_eq!(part, Path::new("shot.shard-2-of-8.manifest.json"));
    }

    #[test]
    fn it_lists_what_is_finished_and_still_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let (exr, png, path) = (at("x.exr"), at("x.png"), at("x.manifest.json"));
        let begin = |depth, beginning| Manifest::begin(path.clone(), settings(depth), beginning);
        std::fs::write(&exr, "picture").unwrap();
        std::fs::write(&png, "preview").unwrap();
        let mut manifest = begin("4", Beginning::Resumed).unwrap();
        assert!(manifest.finished(&exr, &png).is_none());
        manifest.add(&exr, &png, true, &serde_json::json!({ "frame": 1 })).unwrap();
        let again = begin("4", Beginning::Resumed).unwrap();
        assert_eq!(again.finished(&exr, &png).unwrap().facts["frame"], 1);
        assert!(begin("4", Beginning::Anew).unwrap().finished(&exr, &png).is_none());
        let refused = begin("5", Beginning::Resumed).unwrap_err().to_string();
        assert!(
            refused.ends_with("the settings were others: depth is `4`, expected `5` by this run"),
            "{refused}"
        );
        std::fs::write(&png, "previeW").unwrap();
        assert!(again.finished(&exr, &png).is_none());
    }

    #[test]
    fn what_is_no_manifest_is_refused_in_a_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.json");
        for text in ["", "{", "[]", "{\"settings\": {}}", "{\"settings\": 1, \"pictures\": {}}", "\u{0}\n\n"]
        {
            std::fs::write(&path, text).unwrap();
            let line =
                Manifest::begin(path.clone(), settings("4"), Beginning::Resumed).unwrap_err().to_string();
            assert!(!line.contains(char::is_control), "{line:?}");
        }
    }
}

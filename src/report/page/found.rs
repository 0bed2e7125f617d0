//! Which documents there are in a folder.

use crate::error::{Error, Result};
use std::fs::DirEntry;
use std::path::{Path, PathBuf};

/// Folders one in another that are looked into.
const DEEPEST: usize = 8;

/// More documents than this are no page for a person.
const MOST: usize = 100;

/// Documents by the command that wrote them, each kind sorted by path.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) validations: Vec<PathBuf>,
    pub(super) benches: Vec<PathBuf>,
    pub(super) reproductions: Vec<PathBuf>,
}

impl Found {
    /// Those of a folder and of all folders in it; hidden ones and links are left out.
    ///
    /// # Errors
    /// If a folder cannot be read, or there are none or too many.
    pub(super) fn in_folder(folder: &Path) -> Result<Found> {
        let mut found = Found::default();
        found.look_into(folder, 0)?;
        let path = folder.display();
        match found.count() {
            0 => Err(Error::Usage(format!(
                "{path}: neither validate.json nor bench.json nor reproduce.json is in it or in a folder in it; \
                 `lightbuffer validate SCENE -o {path}` writes one"
            ))),
            1..=MOST => Ok(found),
            many => Err(Error::Usage(format!("{path}: {many} documents, and a page takes {MOST}"))),
        }
    }

    fn count(&self) -> usize {
        self.validations.len() + self.benches.len() + self.reproductions.len()
    }

    fn look_into(&mut self, folder: &Path, depth: usize) -> Result<()> {
        let refused = |source| Error::io(folder, "read the folder", source);
        let entries: std::io::Result<Vec<DirEntry>> = std::fs::read_dir(folder).map_err(refused)?.collect();
        let mut entries = entries.map_err(refused)?;
        entries.sort_by_key(DirEntry::file_name);
        for entry in entries {
            let name = entry.file_name();
            let kind = entry.file_type().map_err(|source| Error::io(&entry.path(), "read", source))?;
            let name = name.to_string_lossy();
            if kind.is_dir() && depth < DEEPEST && !name.starts_with('.') {
                self.look_into(&entry.path(), depth + 1)?;
            }
            let list = match &*name {
                "validate.json" => &mut self.validations,
                "bench.json" => &mut self.benches,
                "reproduce.json" => &mut self.reproductions,
                _ => continue,
            };
            if kind.is_file() {
                list.push(entry.path());
            }
        }
        Ok(())
    }
}

/// What the folder of a document is called within the folder of the page; empty for that itself.
pub(super) fn name_of(folder: &Path, document: &Path) -> String {
    let parent = document.parent().unwrap_or(Path::new(""));
    parent.strip_prefix(folder).unwrap_or(parent).display().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_are_found_in_folders_of_folders_in_order() {
        let folder = tempfile::tempdir().unwrap();
        for place in ["b", "a/deep", ".hidden"] {
            std::fs::create_dir_all(folder.path().join(place)).unwrap();
            std::fs::write(folder.path().join(place).join("validate.json"), "").unwrap();
        }
        std::fs::write(folder.path().join("bench.json"), "").unwrap();
        let found = Found::in_folder(folder.path()).unwrap();
        let names: Vec<_> = found.validations.iter().map(|path| name_of(folder.path(), path)).collect();
        assert_eq!(names, ["a/deep", "b"]);
        assert_eq!(name_of(folder.path(), &found.benches[0]), "");
        assert_eq!((found.benches.len(), found.reproductions.len()), (1, 0));
    }

    #[test]
    fn a_folder_without_documents_says_what_writes_one() {
        let folder = tempfile::tempdir().unwrap();
        let error = Found::in_folder(folder.path()).unwrap_err().to_string();
        assert!(error.contains("lightbuffer validate SCENE"), "{error}");
        let missing = Found::in_folder(&folder.path().join("none")).unwrap_err().to_string();
        assert!(missing.contains("cannot read the folder"), "{missing}");
    }
}

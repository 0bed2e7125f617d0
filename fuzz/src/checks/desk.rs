//! A folder that holds the files of one input after the other.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The folder, with what lies in it. In memory where there is `/dev/shm`: most of a run would be spent in the file
/// system otherwise.
pub struct Desk {
    folder: tempfile::TempDir,
    there: BTreeMap<&'static str, Vec<u8>>,
}

impl Desk {
    pub fn new() -> Desk {
        let memory = Path::new("/dev/shm");
        let parent = if memory.is_dir() { memory.to_path_buf() } else { std::env::temp_dir() };
        let folder = tempfile::Builder::new().prefix("fuzz-").tempdir_in(parent).expect("a folder for files");
        Desk { folder, there: BTreeMap::new() }
    }

    /// The path of a file.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Puts these files and no others on the desk. What is the same as before is not written again.
    pub fn lay(&mut self, files: &[(&'static str, &[u8])]) {
        let gone: Vec<_> = self.there.keys().copied().filter(|k| files.iter().all(|(n, _)| n != k)).collect();
        for name in gone {
            self.there.remove(name);
            std::fs::remove_file(self.path(name)).expect("a file that was laid");
        }
        for &(name, bytes) in files {
            if self.there.get(name).is_none_or(|old| old != bytes) {
                std::fs::write(self.path(name), bytes).expect("room for a file");
                self.there.insert(name, bytes.to_vec());
            }
        }
    }
}

//! What is remembered of a file, to see later whether it is still the same.

use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// Length and checksum of a file: enough to find what was cut off, damaged or replaced, not what somebody forged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileState {
    /// Its length.
    pub bytes: u64,
    /// CRC-32 of its content, that of gzip and PNG.
    pub crc32: u32,
}

impl FileState {
    /// Of the file as it is now.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read.
    pub fn of(path: &Path) -> Result<FileState> {
        let refused = |source| Error::io(path, "read", source);
        let mut file = File::open(path).map_err(refused)?;
        let (mut hasher, mut bytes, mut buffer) = (crc32fast::Hasher::new(), 0, vec![0; 1 << 16]);
        loop {
            match file.read(&mut buffer) {
                Ok(0) => return Ok(FileState { bytes, crc32: hasher.finalize() }),
                Ok(count) => {
                    hasher.update(&buffer[..count]);
                    bytes += count as u64;
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(refused(error)),
            }
        }
    }

    /// Whether the file is there and as it was. One of another length is not read.
    pub fn is_still(self, path: &Path) -> bool {
        path.metadata().is_ok_and(|found| found.is_file() && found.len() == self.bytes)
            && FileState::of(path).is_ok_and(|state| state == self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_content_other_length_and_no_file_are_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, "123456789").unwrap();
        let state = FileState::of(&path).unwrap();
        // The check value of this CRC.
        assert_eq!(state, FileState { bytes: 9, crc32: 0xcbf4_3926 });
        assert!(state.is_still(&path));
        for content in ["123456780", "12345678", ""] {
            std::fs::write(&path, content).unwrap();
            assert!(!state.is_still(&path), "{content}");
        }
        std::fs::remove_file(&path).unwrap();
        assert!(!state.is_still(&path) && !state.is_still(folder.path()));
        assert_eq!(FileState::of(&path).unwrap_err().to_string().lines().count(), 1);
    }
}

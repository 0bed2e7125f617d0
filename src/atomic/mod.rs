//! Files that appear whole or not at all, and those of one run all together.

mod destination;
mod state;
mod temporary;
mod traces;

pub use destination::{Destination, folder_of};
pub use state::FileState;
pub use traces::remove_for_good;

use crate::error::{Error, Result};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, ErrorKind, Seek};
use std::path::{Path, PathBuf};
use temporary::{AFFIXES, Temporary, Written};
use traces::{Kind, Trace};

/// Writes a file without a name or under a temporary one, in the folder of `path`, and gives it its name when
/// `write` has succeeded.
///
/// `write` gets the empty file, open for reading and writing; it may seek. Whoever looks at `path` sees the
/// old file or the new one, complete. On any failure the temporary file is removed and `path` is as it was.
/// Permissions are those of a file newly made by the process. The folder must exist. If `path` is a link, what it
/// leads to is replaced; into a device or a pipe the result is written when it is complete.
///
/// # Errors
/// [`Error::Io`] with `path` if the folder is missing or cannot be written, if `write` fails, or if the
/// file cannot be renamed.
pub fn write_atomically(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> Result<()> {
    let mut files = FileSet::new();
    files.write(path, write)?;
    files.publish()
}

/// Files that are being written, and folders that are made for them. Dropped, it leaves nothing.
#[derive(Debug, Default)]
pub struct FileSet {
    // Dropped before the folders that they are in.
    staged: Vec<Staged>,
    folders: Folders,
    names: BTreeSet<PathBuf>,
}

/// Files of a set that may stay open, and are waited for until the disk has them; a set of thousands of maps would
/// run out of the one and take minutes for the other. Further ones have temporary names.
const MOST_OPEN: usize = 64;

#[derive(Debug)]
struct Staged {
    /// The name that it was asked for by.
    path: PathBuf,
    content: Content,
}

#[derive(Debug)]
enum Content {
    /// Becomes this file.
    File(Written, PathBuf),
    /// Is written into this device or pipe.
    Special(File, PathBuf),
}

/// Folders that were made, the outer ones first.
#[derive(Debug, Default)]
struct Folders(Vec<Trace>);

impl Drop for Folders {
    fn drop(&mut self) {
        while self.0.pop().is_some() {}
    }
}

impl FileSet {
    /// No files yet.
    pub fn new() -> FileSet {
        FileSet::default()
    }

    /// Makes a folder with those that it is in, or finds it there. What was made goes with the set unless that is
    /// published.
    ///
    /// # Errors
    /// If it cannot be made, or something else has the name.
    pub fn folder(&mut self, path: &Path) -> Result<()> {
        let refused = |source| Error::io(path, "create the folder", source);
        let missing: Vec<&Path> = path
            .ancestors()
            .take_while(|folder| !folder.as_os_str().is_empty() && !folder.is_dir())
            .collect();
        for folder in missing.into_iter().rev() {
            let make = || std::fs::create_dir(folder).map(|()| ((), folder.to_path_buf()));
            match Trace::of(Kind::Folder, make) {
                Ok(((), trace)) => self.folders.0.push(trace),
                // Made by another run in the meantime.
                Err(_) if folder.is_dir() => {}
                Err(error) => return Err(refused(error)),
            }
        }
        Ok(())
    }

    /// Adds a file. `write` gets it empty, open for reading and writing; it may seek.
    ///
    /// # Errors
    /// [`Error::Io`] with `path` if its folder is missing or cannot be written, or if `write` fails;
    /// [`Error::Usage`] if the set has a file of that name.
    pub fn write(&mut self, path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> Result<()> {
        let refused = |source| Error::io(path, "write", source);
        let content = match Destination::of(path).map_err(refused)? {
            Destination::File(to) => {
                if !self.names.insert(to.clone()) {
                    return Err(Error::Usage(format!("{}: two results have this name", path.display())));
                }
                let folder = folder_of(&to);
                let temporary = match self.staged.len() < MOST_OPEN {
                    true => Temporary::within(folder),
                    false => Temporary::named(folder),
                };
                let mut temporary = temporary.map_err(refused)?;
                write(temporary.file()).map_err(refused)?;
                Content::File(temporary.written().map_err(refused)?, to)
            }
            Destination::Special(to) => {
                // Elsewhere first, because it cannot be sought in, and may have to wait for a reader.
                let mut file = tempfile::tempfile().map_err(refused)?;
                write(&mut file).map_err(refused)?;
                Content::Special(file, to)
            }
        };
        self.staged.push(Staged { path: path.to_path_buf(), content });
        Ok(())
    }

    /// Fills devices and pipes, and gives the others their names, which no signal comes between.
    ///
    /// # Errors
    /// [`Error::Io`] with the first file that the operating system refuses; names given by then stay.
    pub fn publish(mut self) -> Result<()> {
        for Staged { path, content } in &mut self.staged {
            if let Content::Special(file, to) = content {
                pour(file, to).map_err(|source| Error::io(path, "write", source))?;
            }
        }
        // Given back before the files are dropped, who take it themselves.
        let mut registry = traces::lock();
        for Staged { path, content } in &mut self.staged {
            if let Content::File(written, to) = content {
                written.publish(to, &mut registry).map_err(|source| Error::io(path, "write", source))?;
            }
        }
        self.folders.0.iter().for_each(|folder| registry.settle(folder));
        Ok(())
    }
}

fn pour(file: &mut File, to: &Path) -> io::Result<()> {
    file.rewind()?;
    let mut special = File::options().write(true).open(to)?;
    match io::copy(file, &mut special) {
        // A reader that has gone away has read enough.
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// Finds out whether a file can be made in the folder, and leaves nothing there.
///
/// # Errors
/// What the operating system refuses.
pub fn expect_room_in(folder: &Path) -> io::Result<()> {
    Temporary::within(folder).map(drop)
}

/// How many unfinished files of killed runs, or of runs that are at work, are in a folder.
pub fn unfinished_in(folder: &Path) -> usize {
    let ours = |name: &str| name.starts_with(AFFIXES[0]) && name.ends_with(AFFIXES[1]);
    let entries = folder.read_dir().into_iter().flatten().flatten();
    entries.filter(|entry| entry.file_name().to_str().is_some_and(ours)).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn names(folder: &Path) -> Vec<String> {
        folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_failed_write_keeps_the_old_file_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result");
        write_atomically(&path, |file| file.write_all(b"old")).unwrap();
        let error = write_atomically(&path, |file| {
            file.write_all(b"half of the new")?;
            Err(io::Error::other("the disk is full"))
        })
        .unwrap_err();
        assert_eq!(error.to_string(), format!("{}: cannot write: the disk is full", path.display()));
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["result"]);
    }

    #[test]
    fn a_folder_in_the_way_is_an_error_and_no_temporary_file_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("taken");
        std::fs::create_dir_all(path.join("inside")).unwrap();
        write_atomically(&path, |file| file.write_all(b"new")).unwrap_err();
        assert_eq!(names(folder.path()), ["taken"]);
    }

    #[cfg(unix)]
    #[test]
    fn the_result_has_the_permissions_of_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        write_atomically(&ours, |_| Ok(())).unwrap();
        File::create(&plain).unwrap();
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }

    #[test]
    fn a_set_appears_as_a_whole_and_takes_its_folders_along_when_it_fails() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("a/b");
        let mut files = FileSet::new();
        files.folder(&deep).unwrap();
        files.write(&deep.join("one"), |file| file.write_all(b"1")).unwrap();
        assert_eq!(files.write(&deep.join("one"), |_| Ok(())).unwrap_err().to_string().lines().count(), 1);
        files.write(&deep.join("two"), |_| Err(io::Error::other("no"))).unwrap_err();
        drop(files);
        assert!(names(folder.path()).is_empty());
        let mut files = FileSet::new();
        files.folder(&deep).unwrap();
        // Beyond so many they have temporary names.
        for i in 0..=MOST_OPEN {
            files.write(&deep.join(i.to_string()), |file| file.write_all(b"text")).unwrap();
        }
        assert_eq!((names(&deep).len(), unfinished_in(&deep)), (1, 1));
        files.publish().unwrap();
        assert_eq!((names(&deep).len(), unfinished_in(&deep)), (MOST_OPEN + 1, 0));
        assert!(deep.read_dir().unwrap().all(|file| std::fs::read(file.unwrap().path()).unwrap() == b"text"));
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_and_lead_to_the_result() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::create_dir(path("inner")).unwrap();
        std::fs::write(path("inner/old"), "old").unwrap();
        for (link, target) in [("to-old", "inner/old"), ("to-none", "inner/none"), ("circle", "circle")] {
            symlink(target, path(link)).unwrap();
        }
        write_atomically(&path("to-old"), |file| file.write_all(b"new")).unwrap();
        write_atomically(&path("to-none"), |file| file.write_all(b"new")).unwrap();
        write_atomically(&path("circle"), |_| Ok(())).unwrap_err();
        for name in ["inner/old", "inner/none"] {
            assert_eq!(std::fs::read(path(name)).unwrap(), b"new");
        }
        assert!(path("to-old").is_symlink() && path("to-none").is_symlink());
        assert_eq!(names(&path("inner")).len(), 2);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_are_written_into() {
        write_atomically(Path::new("/dev/null"), |file| file.write_all(b"text")).unwrap();
        assert!(!Path::new("/dev/null").is_file());
        let full = write_atomically(Path::new("/dev/full"), |file| file.write_all(b"text")).unwrap_err();
        assert!(full.to_string().starts_with("/dev/full: cannot write: No space left"), "{full}");
    }
}

//! Files that appear whole or not at all.

use crate::error::{Error, Result};
use std::fs::File;
use std::io;
use std::path::Path;

/// Writes a file under a temporary name in the folder of `path` and renames it when `write` has succeeded.
///
/// `write` gets the empty file, open for reading and writing; it may seek. Whoever looks at `path` sees the
/// old file or the new one, complete. On any failure the temporary file is removed and `path` is as it was.
/// Permissions are those of a file newly made by the process. The folder must exist.
///
/// # Errors
/// [`Error::Io`] with `path` if the folder is missing or cannot be written, if `write` fails, or if the
/// file cannot be renamed.
pub fn write_atomically(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> Result<()> {
    let refused = |source| Error::io(path, "write", source);
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    // Asked first because tempfile's own error would name the temporary file, which means nothing to anybody.
    folder.metadata().map_err(refused)?;
    let mut temporary =
        builder().tempfile_in(folder).map_err(|error| refused(io::Error::from(error.kind())))?;
    write(temporary.as_file_mut()).map_err(refused)?;
    temporary.persist(path).map_err(|error| refused(error.error))?;
    Ok(())
}

fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".lightbuffer-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Temporary files are private by default; this one will be a result, so the umask decides.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder
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
}

//! Files that are being written.
//!
//! Where the system can, such a file has no name until it is complete, so that not even a killed process leaves
//! anything. Elsewhere (network folders, other systems) it has the name `.lightbuffer-*.part` in the folder where the
//! result will be, and is a trace.

use super::traces::{Kind, Registry, Trace};
use std::fs::File;
use std::io;
use std::path::Path;

/// A file that is being written.
#[derive(Debug)]
pub enum Temporary {
    /// It goes by itself.
    #[cfg(target_os = "linux")]
    Unnamed(File),
    /// It goes with the trace.
    Named(File, Trace),
}

impl Temporary {
    /// An empty file, open for reading and writing, that can become one of this folder.
    ///
    /// # Errors
    /// If the folder cannot be written.
    pub fn within(folder: &Path) -> io::Result<Temporary> {
        #[cfg(target_os = "linux")]
        if let Ok(file) = unnamed::within(folder) {
            return Ok(Temporary::Unnamed(file));
        }
        Temporary::named(folder)
    }

    pub(super) fn named(folder: &Path) -> io::Result<Temporary> {
        let make = || with_name(folder)?.keep().map_err(|error| error.error);
        let (file, trace) = Trace::of(Kind::File, make)?;
        Ok(Temporary::Named(file, trace))
    }

    /// The file itself.
    pub fn file(&mut self) -> &mut File {
        match self {
            #[cfg(target_os = "linux")]
            Temporary::Unnamed(file) => file,
            Temporary::Named(file, _) => file,
        }
    }

    /// Makes sure that it has reached the disk, for some file systems say only now that it is full.
    ///
    /// # Errors
    /// If it has not.
    pub fn written(self) -> io::Result<Written> {
        match self {
            #[cfg(target_os = "linux")]
            Temporary::Unnamed(file) => {
                file.sync_all()?;
                Ok(Written::Unnamed(file))
            }
            Temporary::Named(_, trace) => Ok(Written::Named(trace)),
        }
    }
}

/// A complete file that has not its own name yet.
#[derive(Debug)]
pub enum Written {
    /// It goes by itself.
    #[cfg(target_os = "linux")]
    Unnamed(File),
    /// It goes with the trace.
    Named(Trace),
}

impl Written {
    /// Gives it its name, in place of what has it now. Held, the registry keeps signals away meanwhile.
    ///
    /// # Errors
    /// What the operating system refuses; then nothing has changed.
    pub fn publish(&mut self, to: &Path, registry: &mut Registry) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Written::Unnamed(file) => unnamed::publish(file, to),
            Written::Named(trace) => {
                let Some(path) = trace.path(registry) else { return Ok(()) };
                std::fs::rename(path, to)?;
                registry.settle(trace);
                Ok(())
            }
        }
    }
}

/// What the names of unfinished files begin and end with.
pub const AFFIXES: [&str; 2] = [".lightbuffer-", ".part"];

fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(AFFIXES[0]).suffix(AFFIXES[1]);
    builder
}

/// A file with a temporary name. It is opened here, because the error of tempfile itself would name it, which means
/// nothing to anybody, and because tempfile makes private files: this one will be a result, so the umask decides.
fn with_name(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    builder().make_in(folder, |path| File::options().read(true).write(true).create_new(true).open(path))
}

#[cfg(target_os = "linux")]
mod unnamed {
    use super::{builder, with_name};
    use rustix::fs::{AtFlags, CWD, Mode, OFlags, linkat, open};
    use rustix::io::Errno;
    use std::fs::File;
    use std::io::{self, Seek};
    use std::os::fd::AsRawFd;
    use std::path::Path;

    /// A file without a name, where the file system has such and there is a way to name it afterwards.
    pub fn within(folder: &Path) -> io::Result<File> {
        let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
        let file = File::from(open(folder, flags, Mode::from_raw_mode(0o666))?);
        Path::new(&itself(&file)).metadata()?;
        Ok(file)
    }

    fn itself(file: &File) -> String {
        format!("/proc/self/fd/{}", file.as_raw_fd())
    }

    pub fn publish(file: &mut File, to: &Path) -> io::Result<()> {
        let link = |to: &Path| linkat(CWD, itself(file), CWD, to, AtFlags::SYMLINK_FOLLOW);
        match link(to) {
            Ok(()) => return Ok(()),
            Err(Errno::EXIST) => {}
            // Some file systems make unnamed files and then give them no name.
            Err(_) => return copy(file, to),
        }
        // A link replaces nothing, a rename does.
        let folder = to.parent().unwrap_or(Path::new("."));
        let linked = builder().make_in(folder, |path| link(path).map_err(io::Error::from));
        linked?.into_temp_path().persist(to).map_err(|error| error.error)
    }

    fn copy(file: &mut File, to: &Path) -> io::Result<()> {
        let mut copy = with_name(to.parent().unwrap_or(Path::new(".")))?;
        file.rewind()?;
        io::copy(file, &mut copy)?;
        copy.as_file().sync_all()?;
        copy.persist(to).map(drop).map_err(|error| error.error)
    }
}

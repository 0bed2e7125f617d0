//! What is on the disk and must not stay there if the run ends early: unfinished files that have a name, and folders
//! that were made for results that are not there yet.
//!
//! They are known to the process as a whole, because a signal ends all of it.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What a trace is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A file that nobody else knows of.
    File,
    /// A folder, which goes only if it is empty.
    Folder,
}

/// Every trace by its number: later ones have higher numbers, so that a folder goes after what is in it.
#[derive(Debug)]
pub struct Registry {
    traces: BTreeMap<u64, (Kind, PathBuf)>,
    next: u64,
}

static REGISTRY: Mutex<Registry> = Mutex::new(Registry { traces: BTreeMap::new(), next: 0 });

/// While this is held, nothing appears, disappears or gets another name.
pub fn lock() -> MutexGuard<'static, Registry> {
    REGISTRY.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Registry {
    /// What was a trace stays, or has become something else.
    pub fn settle(&mut self, trace: &Trace) {
        self.traces.remove(&trace.0);
    }

    fn remove_all(&mut self) {
        while let Some((_, (kind, path))) = self.traces.pop_last() {
            remove(kind, &path);
        }
    }
}

/// One of them. It goes when this is dropped, unless it was settled.
#[derive(Debug)]
pub struct Trace(u64);

impl Trace {
    /// Makes something that is a trace from its first moment on.
    ///
    /// # Errors
    /// That of `make`.
    pub fn of<T>(kind: Kind, make: impl FnOnce() -> io::Result<(T, PathBuf)>) -> io::Result<(T, Trace)> {
        let mut registry = lock();
        let (made, path) = make()?;
        let number = registry.next;
        registry.next += 1;
        registry.traces.insert(number, (kind, path));
        Ok((made, Trace(number)))
    }

    /// Where it is, if it is not settled.
    pub fn path<'r>(&self, registry: &'r Registry) -> Option<&'r Path> {
        registry.traces.get(&self.0).map(|(_, path)| path.as_path())
    }
}

impl Drop for Trace {
    fn drop(&mut self) {
        if let Some((kind, path)) = lock().traces.remove(&self.0) {
            remove(kind, &path);
        }
    }
}

/// Nothing can be done about a failure: whoever ends the run has something more important to say.
fn remove(kind: Kind, path: &Path) {
    let _ = match kind {
        Kind::File => std::fs::remove_file(path),
        Kind::Folder => std::fs::remove_dir(path),
    };
}

/// Removes all traces, and keeps every thread from making another or publishing a file. For a process that is about
/// to end, whatever its threads are doing.
pub fn remove_for_good() {
    let mut registry = lock();
    registry.remove_all();
    // Never given back: a file that appeared from now on would be there after the process said that it stops.
    std::mem::forget(registry);
}

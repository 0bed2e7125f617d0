//! How much memory a run may ask for. What depends on an input is estimated and checked before it is
//! allocated, so that too large a request is one line and not the end of the process.

mod control_group;

use crate::error::{Error, Result};
use crate::slurm;
use std::fmt::Display;

/// The most bytes that a run may need, and how many of them are spoken for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryLimit {
    most: u64,
    spoken_for: u64,
}

impl MemoryLimit {
    /// No limit but that of the machine.
    pub const NONE: MemoryLimit = MemoryLimit::bytes(u64::MAX);

    /// A limit in bytes.
    pub const fn bytes(bytes: u64) -> MemoryLimit {
        MemoryLimit { most: bytes, spoken_for: 0 }
    }

    /// What the machine has free, what the process's control group or one around it allows, or what Slurm has given the job,
    /// whichever is least; no limit where none of it can be found out.
    pub fn of_this_machine() -> MemoryLimit {
        let free = std::fs::read_to_string("/proc/meminfo").ok().as_deref().and_then(available);
        let least = [free, control_group::limit(), slurm::memory()].into_iter().flatten().min();
        least.map_or(MemoryLimit::NONE, MemoryLimit::bytes)
    }

    /// Whether something fits beside what is spoken for.
    ///
    /// # Errors
    /// [`Error::Usage`] if it needs more.
    pub fn check(self, what: impl Display, needed: u64) -> Result<()> {
        if needed <= self.left() {
            return Ok(());
        }
        let beside = match self.spoken_for {
            0 => String::new(),
            bytes => format!(" beside {} for the rest", in_words(bytes)),
        };
        let (needed, limit) = (in_words(needed), in_words(self.most));
        Err(Error::Usage(format!("{what} would need about {needed}{beside}, and --memory-limit is {limit}")))
    }

    /// The error of something that turned out to need more than is left.
    pub fn exceeded(self, what: impl Display) -> Error {
        let (left, limit) = (in_words(self.left()), in_words(self.most));
        Error::Usage(format!(
            "{what} would need more than the {left} that are left, and --memory-limit is {limit}"
        ))
    }

    /// The bytes that are not spoken for.
    pub fn left(self) -> u64 {
        self.most.saturating_sub(self.spoken_for)
    }

    /// The limit for everything else once something that fits is there.
    ///
    /// # Errors
    /// [`Error::Usage`] if it needs more.
    pub fn beside(self, what: impl Display, needed: u64) -> Result<MemoryLimit> {
        self.check(what, needed)?;
        Ok(MemoryLimit { spoken_for: self.spoken_for.saturating_add(needed), ..self })
    }
}

/// `MemAvailable` of the text of `/proc/meminfo`, in bytes.
fn available(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}

/// Reads `512M`, `16G` or a plain number of bytes; K, M, G and T are powers of 1024.
///
/// # Errors
/// What was expected.
pub fn parse(text: &str) -> std::result::Result<MemoryLimit, String> {
    let text = text.trim();
    let unit = |suffix: char| "KMGT".find(suffix.to_ascii_uppercase()).map(|i| 10 * (i as u32 + 1));
    let (digits, shift) = match text.chars().last().and_then(unit) {
        Some(shift) => (&text[..text.len() - 1], shift),
        None => (text, 0),
    };
    let bytes = digits.parse::<u64>().ok().and_then(|n| n.checked_mul(1 << shift)).filter(|&n| n > 0);
    bytes
        .map(MemoryLimit::bytes)
        .ok_or_else(|| "expected bytes, or a number with K, M, G or T, such as 16G".into())
}

fn in_words(bytes: u64) -> String {
    match bytes {
        0..0x80_0000 => format!("{} KiB", bytes.div_ceil(1 << 10)),
        0x80_0000..0x2_0000_0000 => format!("{} MiB", bytes.div_ceil(1 << 20)),
        _ => format!("{} GiB", bytes.div_ceil(1 << 30)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_in_powers_of_1024() {
        assert_eq!(parse("4096"), Ok(MemoryLimit::bytes(4096)));
        assert_eq!(parse("3k"), Ok(MemoryLimit::bytes(3072)));
        assert_eq!(parse("16G"), Ok(MemoryLimit::bytes(16 << 30)));
        for bad in ["", "G", "0", "-1", "1.5G", "4GB", "99999999999T", "é"] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn the_free_memory_of_linux_is_found() {
        let text = "MemTotal:       24576000 kB\nMemFree:  1 kB\nMemAvailable:   20000000 kB\n";
        assert_eq!(available(text), Some(20_000_000 * 1024));
        assert_eq!(available("MemTotal: 1 kB\n"), None);
    }

    #[test]
    fn what_needs_more_is_named() {
        let limit = MemoryLimit::bytes(1 << 20);
        assert!(limit.check("a thing", 1 << 20).is_ok());
        let line = limit.check("a thing", 3 << 30).unwrap_err().to_string();
        assert_eq!(line, "a thing would need about 3072 MiB, and --memory-limit is 1024 KiB");
        let rest = limit.beside("a thing", 1 << 19).unwrap();
        assert!(rest.check("another", 1 << 19).is_ok());
        let line = rest.beside("another", (1 << 19) + 1).unwrap_err().to_string();
        assert_eq!(
            line,
            "another would need about 513 KiB beside 512 KiB for the rest, and --memory-limit is 1024 KiB"
        );
        assert!(MemoryLimit::NONE.beside("all", u64::MAX).is_ok());
    }
}

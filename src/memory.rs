//! How much memory a run may ask for. What depends on an input is estimated and checked before it is
//! allocated, so that too large a request is one line and not the end of the process.

use crate::error::{Error, Result};
use std::fmt::Display;

/// The most bytes that one thing may need.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct MemoryLimit(u64);

impl MemoryLimit {
    /// No limit but that of the machine.
    pub const NONE: MemoryLimit = MemoryLimit(u64::MAX);

    /// A limit in bytes.
    pub const fn bytes(bytes: u64) -> MemoryLimit {
        MemoryLimit(bytes)
    }

    /// What the machine has free, or the process's control group (version 2) allows, whichever is less; no
    /// limit where neither can be found out.
    pub fn of_this_machine() -> MemoryLimit {
        let free = std::fs::read_to_string("/proc/meminfo").ok().as_deref().and_then(available);
        let group = std::fs::read_to_string("/sys/fs/cgroup/memory.max").ok();
        let group = group.and_then(|text| text.trim().parse().ok());
        free.into_iter().chain(group).min().map_or(MemoryLimit::NONE, MemoryLimit)
    }

    /// # Errors
    /// [`Error::Usage`] if something needs more.
    pub fn check(self, what: impl Display, needed: u64) -> Result<()> {
        if needed <= self.0 {
            return Ok(());
        }
        let (needed, limit) = (in_words(needed), in_words(self.0));
        Err(Error::Usage(format!("{what} would need about {needed}, and --memory-limit is {limit}")))
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
    bytes.map(MemoryLimit).ok_or_else(|| "expected bytes, or a number with K, M, G or T, such as 16G".into())
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
        assert_eq!(parse("4096"), Ok(MemoryLimit(4096)));
        assert_eq!(parse("3k"), Ok(MemoryLimit(3072)));
        assert_eq!(parse("16G"), Ok(MemoryLimit(16 << 30)));
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
    }
}

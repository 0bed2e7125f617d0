//! The part of a run that one process does: `--shard 2/8`.
//!
//! By frames it is a run of the list, by tiles a strip of whole rows of each picture. Neither changes a pixel.

use crate::film::BLOCK_ROWS;
use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The most shards of a run.
const MOST_SHARDS: u32 = 1_000_000;

/// One of so many parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// From 1.
    index: u32,
    of: u32,
}

/// What a run is divided by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ShardBy {
    /// Strips of whole rows of each picture
    Tiles,
    /// Runs of the list of frames
    Frames,
}

/// Whole rows of a picture, none if there are more shards than blocks of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rows {
    /// From 0 at the top.
    pub first: u32,
    /// How many.
    pub count: u32,
}

impl Rows {
    /// The row after the last one.
    pub fn end(self) -> u64 {
        u64::from(self.first) + u64::from(self.count)
    }
}

impl Shard {
    /// Reads `I/N`, with `I` from 1 to `N`.
    ///
    /// # Errors
    /// A line.
    pub fn parse(text: &str) -> Result<Shard, String> {
        let digits =
            |text: &str| text.bytes().all(|digit| digit.is_ascii_digit()).then(|| text.parse().ok())?;
        let terms = text.split_once('/').and_then(|(index, of)| Some((digits(index)?, digits(of)?)));
        match terms {
            Some((index, of)) if (1..=of).contains(&index) && of <= MOST_SHARDS => Ok(Shard { index, of }),
            _ => Err(format!("expected I/N, such as 2/8, with I from 1 to N and N at most {MOST_SHARDS}")),
        }
    }

    /// The number from 1, and how many there are.
    pub fn numbers(self) -> (u32, u32) {
        (self.index, self.of)
    }

    /// Its run of so many things: runs are as even as possible, longer ones first, and all together are all of them.
    pub fn run(self, things: usize) -> Range<usize> {
        let (each, longer) = (things / self.of as usize, things % self.of as usize);
        let begin = |index: usize| each * index + index.min(longer);
        begin(self.index as usize - 1)..begin(self.index as usize)
    }

    /// Its rows of a picture of so many. Borders are multiples of the rows that OpenEXR compresses together.
    pub fn rows(self, height: u32) -> Rows {
        let blocks = self.run(height.div_ceil(BLOCK_ROWS) as usize);
        let row = |block: usize| (block as u32).saturating_mul(BLOCK_ROWS).min(height);
        let (first, end) = (row(blocks.start), row(blocks.end));
        Rows { first, count: end - first }
    }

    /// What it puts into names before the extension.
    pub fn suffix(self) -> String {
        format!(".shard-{}-of-{}", self.index, self.of)
    }

    /// The name of its part of a result: `out.exr` becomes `out.shard-2-of-8.exr`.
    pub fn path(self, whole: &Path) -> PathBuf {
        let mut name = whole.file_stem().unwrap_or_default().to_os_string();
        name.push(self.suffix());
        if let Some(extension) = whole.extension() {
            name.push(".");
            name.push(extension);
        }
        whole.with_file_name(name)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn shards_count_from_1() {
        assert_eq!(Shard::parse("2/8"), Ok(Shard { index: 2, of: 8 }));
        assert_eq!(Shard::parse("1/1").unwrap().to_string(), "1/1");
        for bad in [
            "",
            "2",
            "0/8",
            "9/8",
            "-1/8",
            "+1/8",
            "1/0",
            "1/2/3",
            "a/b",
            "1/",
            "/1",
            "1/1000001",
            "1/99999999999",
        ] {
            assert_eq!(Shard::parse(bad).unwrap_err().lines().count(), 1, "{bad}");
        }
    }

    #[test]
    fn names_say_which_part_it_is() {
        let shard = Shard { index: 2, of: 8 };
        for (whole, part) in
            [("out.exr", "out.shard-2-of-8.exr"), ("a/b.c/shot.0001.EXR", "a/b.c/shot.0001.shard-2-of-8.EXR")]
        {
            assert_eq!(shard.path(Path::new(whole)), Path::new(part));
        }
    }

    #[test]
    fn strips_are_these() {
        let strips = |of, height| {
            let strip = |index| Shard { index, of }.rows(height);
            (1..=of).map(|index| (strip(index).first, strip(index).count)).collect::<Vec<_>>()
        };
        assert_eq!(strips(1, 54), [(0, 54)]);
        assert_eq!(strips(2, 54), [(0, 32), (32, 22)]);
        assert_eq!(strips(3, 54), [(0, 32), (32, 16), (48, 6)]);
        assert_eq!(strips(7, 54), [(0, 16), (16, 16), (32, 16), (48, 6), (54, 0), (54, 0), (54, 0)]);
        assert_eq!(strips(2, 1), [(0, 1), (1, 0)]);
    }

    proptest! {
        #[test]
        fn all_shards_together_are_all_of_it_each_once(of in 1u32..200, height in 1u32..3000, frames in 1usize..3000) {
            let shards = || (1..=of).map(|index| Shard { index, of });
            let (mut row, mut frame) = (0, 0);
            for shard in shards() {
                let (rows, run) = (shard.rows(height), shard.run(frames));
                prop_assert_eq!((rows.first, run.start), (row, frame));
                prop_assert!(rows.first.is_multiple_of(BLOCK_ROWS) || rows.first == height);
                (row, frame) = (row + rows.count, run.end);
            }
            prop_assert_eq!((row, frame), (height, frames));
            let lengths = || shards().map(|shard| shard.run(frames).len());
            prop_assert!(lengths().max().unwrap() - lengths().min().unwrap() <= 1);
        }
    }
}

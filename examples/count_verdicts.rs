//! Counts the verdicts in an image of `validate`, light by light.
//!
//! `cargo run --example count_verdicts -- out/courtyard/image.exr`

use lightbuffer::film::read_exr;
use lightbuffer::{Error, Result};
use std::collections::BTreeMap;
use std::path::Path;

/// The last digit of a code.
const VERDICTS: [&str; 9] = [
    "background",
    "faces away",
    "lit",
    "occluded",
    "tester wrong",
    "Embree wrong",
    "both wrong",
    "outside the cone",
    "receives no shadows",
];

/// Its hundreds.
const CAUSES: [&str; 4] = ["", " by its epsilon", " by the rounding of its input", " by its traversal"];

fn main() -> Result<()> {
    let path = std::env::args().nth(1).ok_or_else(|| Error::Usage("expected image.exr".into()))?;
    let image = read_exr(Path::new(&path))?;
    for channel in image.channels().iter().filter(|channel| channel.name.ends_with(".verdict")) {
        let mut counts = BTreeMap::new();
        for &code in &channel.samples {
            *counts.entry(code as u16).or_insert(0_u64) += 1;
        }
        println!("{}", channel.name);
        for (code, count) in counts {
            let verdict = VERDICTS.get(usize::from(code % 10)).copied().unwrap_or("unknown");
            let cause = CAUSES.get(usize::from(code / 100)).copied().unwrap_or_default();
            let touching = if code / 10 % 10 == 1 { ", touching" } else { "" };
            println!("  {count:>9} {verdict}{cause}{touching}");
        }
    }
    Ok(())
}

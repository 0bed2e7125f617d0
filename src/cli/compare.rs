//! `lightbuffer compare`: two OpenEXR images, channel by channel.

use super::{Outcome, output};
use crate::error::Result;
use crate::film::{Allowance, FileSet, read_exr};
use crate::report::comparison::Comparison;
use std::path::PathBuf;

/// The exit code when an image cannot be read, or the arguments cannot be used, as of `idiff`.
pub const CANNOT_COMPARE: u8 = 4;

const EXIT_CODES: &str = "\
Exit codes are those of OpenImageIO's idiff, and other than those of the other commands:
  0  same: the images are within both allowances
  1  warn: they are beyond the allowance for warnings, and within that for failures
  2  fail: they are beyond the allowance for failures, or a sample is NaN in either image, or infinite in
     one and not the same in the other; infinities of one sign are the same
  3  the images have different sizes or channels, so nothing was compared
  4  an image cannot be read, the arguments cannot be used, or a result cannot be written

An image is beyond an allowance if more than the percentage of its pixels have a sample that differs by more
than the threshold, or if any sample differs by more than the hard limit. (idiff 2.4 does not warn where no
pixel fails; compare does.)

MSE, MRSE (relMSE), PSNR, SSIM and FLIP are of R, G and B, B.exr being the reference: MSE, MRSE and FLIP as
pbrt's imgtool defines them. MSE, MRSE and PSNR (for a peak of 1) are of linear light; SSIM and FLIP (low
dynamic range, 67 pixels a degree) of the picture as a screen shows it, cut to [0, 1]. They decide nothing.";

#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES)]
pub struct Args {
    /// The image in question
    #[arg(value_name = "A.exr")]
    one: PathBuf,
    /// What it is held against
    #[arg(value_name = "B.exr")]
    other: PathBuf,
    /// Channels by name [default: all, and both images must have the same]
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    channels: Vec<String>,
    /// A pixel fails if a sample differs by more than this
    #[arg(long, value_name = "X", default_value_t = 1e-6, value_parser = parse_limit)]
    fail: f64,
    /// So many of a hundred pixels may fail
    #[arg(long, value_name = "P", default_value_t = 0.0, value_parser = parse_percent)]
    failpercent: f64,
    /// A single sample that differs by more than this is a failure [default: none is]
    #[arg(long, value_name = "X", default_value_t = f64::INFINITY, hide_default_value = true, value_parser = parse_limit)]
    hardfail: f64,
    /// A pixel warns if a sample differs by more than this
    #[arg(long, value_name = "X", default_value_t = 1e-6, value_parser = parse_limit)]
    warn: f64,
    /// So many of a hundred pixels may warn
    #[arg(long, value_name = "P", default_value_t = 0.0, value_parser = parse_percent)]
    warnpercent: f64,
    /// A single sample that differs by more than this warns [default: none does]
    #[arg(long, value_name = "X", default_value_t = f64::INFINITY, hide_default_value = true, value_parser = parse_limit)]
    hardwarn: f64,
    /// The same as JSON; - is standard output instead of the table
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// No table: the exit code says it all
    #[arg(short, long)]
    quiet: bool,
}

pub fn run(args: &Args) -> Result<Outcome> {
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    let (one, other) = (read_exr(&args.one)?, read_exr(&args.other)?);
    let fail = Allowance { threshold: args.fail, percent: args.failpercent, hard: args.hardfail };
    let warn = Allowance { threshold: args.warn, percent: args.warnpercent, hard: args.hardwarn };
    let comparison = Comparison::new(&one, &other, &args.channels, fail, warn);
    let mut files = FileSet::new();
    let table = || if args.quiet { String::new() } else { comparison.table() };
    let shown = output::add_copy(&mut files, args.json.as_deref(), &comparison, table)?;
    output::finish(files, &shown)?;
    Ok(Outcome::Compared(comparison.exit_code))
}

fn parse_limit(text: &str) -> std::result::Result<f64, String> {
    match text.parse() {
        Ok(limit) if limit >= 0.0 => Ok(limit),
        _ => Err("expected a number that is not negative".into()),
    }
}

fn parse_percent(text: &str) -> std::result::Result<f64, String> {
    match text.parse() {
        Ok(percent) if (0.0..=100.0).contains(&percent) => Ok(percent),
        _ => Err("expected a number from 0 to 100".into()),
    }
}

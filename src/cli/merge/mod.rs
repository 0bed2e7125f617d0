//! `lightbuffer merge`: parts of one result become what a single process would have written.
//!
//! [`pictures`] puts strips of a picture together, [`documents`] what `--json` said about parts.

mod documents;
mod pictures;

use super::options::thread_pool;
use super::progress::Messages;
use super::{Outcome, output};
use crate::atomic::folder_of;
use crate::error::{Error, Result};
use crate::film::FileSet;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// What parts have written, in any order: strips of one picture with -o, documents with --json
    #[arg(value_name = "SHARD", required = true)]
    shards: Vec<PathBuf>,
    /// The whole picture, from all OpenEXR files that are named: every row must be in one of them, and in one alone. Byte
    /// by byte it is what a single process would have written, and so is the PNG preview beside it
    #[arg(short, long, value_name = "OUT.exr", value_parser = super::render::parse_output, required_unless_present = "json")]
    output: Option<PathBuf>,
    /// One document, from all JSON files that are named: every frame, or every row, must be in one of them alone; - is
    /// standard output
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Threads [default: all]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// No messages but errors
    #[arg(short, long)]
    quiet: bool,
}

pub fn run(args: &Args) -> Result<Outcome> {
    thread_pool(args.threads)?.install(|| merge(args))
}

fn merge(args: &Args) -> Result<Outcome> {
    let messages = Messages::new(args.quiet);
    let (strips, facts) = by_kind(&args.shards)?;
    expect(args.output.as_deref(), &strips, "-o", "OpenEXR")?;
    expect(args.json.as_deref(), &facts, "--json", "JSON")?;
    let results: Vec<PathBuf> = args
        .output
        .iter()
        .flat_map(|picture| [super::render::preview(picture), picture.clone()])
        .chain(args.json.clone())
        .collect();
    results.iter().try_for_each(|result| output::expect_writable(result))?;
    expect_apart(&results, &args.shards)?;
    let mut files = FileSet::new();
    if let Some(picture) = &args.output {
        output::warn_of_remains(folder_of(picture), messages);
        pictures::add(&mut files, picture, &strips)?;
    }
    let shown = match &args.json {
        Some(json) => documents::add(&mut files, json, &facts)?,
        None => String::new(),
    };
    output::finish(files, &shown)?;
    if let Some(picture) = &args.output {
        messages.say(&format!("wrote {}", picture.display()));
    }
    Ok(Outcome::Right)
}

/// OpenEXR files and documents, by their names.
fn by_kind(shards: &[PathBuf]) -> Result<(Vec<&Path>, Vec<&Path>)> {
    let has = |path: &Path, extension: &str| {
        path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension))
    };
    let (mut strips, mut facts) = (Vec::new(), Vec::new());
    for shard in shards {
        match (has(shard, "exr"), has(shard, "json")) {
            (true, _) => strips.push(shard.as_path()),
            (_, true) => facts.push(shard.as_path()),
            _ => {
                let shard = shard.display();
                return Err(Error::Usage(format!("{shard}: expected a name that ends in .exr or .json")));
            }
        }
    }
    Ok((strips, facts))
}

/// Files of a kind are there if and only if there is a result for them.
fn expect(result: Option<&Path>, shards: &[&Path], option: &str, kind: &str) -> Result<()> {
    match (result, shards) {
        (Some(_), []) => Err(Error::Usage(format!("{option}: expected {kind} files of shards"))),
        (None, [shard, ..]) => {
            Err(Error::Usage(format!("{}: there is no {option} for {kind} files", shard.display())))
        }
        _ => Ok(()),
    }
}

/// No result may take the place of another, or of a part.
fn expect_apart(results: &[PathBuf], shards: &[PathBuf]) -> Result<()> {
    let place = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let files = results.iter().filter(|result| !output::is_standard_output(result));
    let mut taken: Vec<PathBuf> = shards.iter().map(|shard| place(shard)).collect();
    for result in files {
        let place = place(result);
        if taken.contains(&place) {
            let result = result.display();
            return Err(Error::Usage(format!("{result}: a result would replace a shard or another result")));
        }
        taken.push(place);
    }
    Ok(())
}

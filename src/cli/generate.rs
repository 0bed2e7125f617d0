//! `lightbuffer generate`: a built-in scene as a file, or a list of them.

use super::{Outcome, output};
use crate::error::Result;
use crate::film::grouped;
use crate::scene::formats;
use crate::scene::procedural::{BUILTIN, find};
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Name of the scene
    #[arg(required_unless_present = "list")]
    name: Option<String>,
    /// How large it is made, if it can be chosen [default: the size of the published statistics]
    #[arg(long, value_name = "N", requires = "name")]
    size_factor: Option<u32>,
    /// The file to write: .toml or .nff
    #[arg(short, long, value_name = "FILE", required_unless_present = "list")]
    output: Option<PathBuf>,
    /// List the scenes with what they hold, and write nothing
    #[arg(long, conflicts_with_all = ["name", "output"])]
    list: bool,
}

pub fn run(args: &Args) -> Result<Outcome> {
    match (&args.name, &args.output) {
        (Some(name), Some(path)) => {
            let scene = find(name)?.build(args.size_factor)?;
            formats::save(&scene, path)?;
        }
        _ => output::print(&list()?)?,
    }
    Ok(Outcome::Right)
}

/// A line for each scene: name, what it holds at its standard size, and what it shows.
fn list() -> Result<String> {
    let mut out = String::new();
    for builtin in BUILTIN {
        let scene = builtin.build(None)?;
        let polygons: u64 = scene.objects.iter().map(|object| u64::from(object.polygons)).sum();
        let _ = writeln!(
            out,
            "{:<18}{:>6} objects {:>6} polygons {:>6} curved {:>2} lights  {}",
            builtin.name,
            grouped(scene.objects.len() as u64),
            grouped(polygons),
            grouped(scene.curved.len() as u64),
            scene.lights.len(),
            builtin.summary
        );
        if let Some(size) = builtin.size_factor {
            let _ = writeln!(
                out,
                "{:<18}size factor {} to {}, standard {}",
                "", size.smallest, size.largest, size.standard
            );
        }
    }
    Ok(out)
}

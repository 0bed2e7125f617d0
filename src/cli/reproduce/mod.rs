//! `lightbuffer reproduce`: what a paper measured, measured again.

mod haines_greenberg;
mod raghuvanshi_dhande;
mod stage;

use super::options::{parse_size, thread_pool};
use super::progress::Messages;
use super::{Outcome, output};
use crate::error::{Error, Result};
use crate::film::FileSet;
use crate::memory::{self, MemoryLimit};
use crate::scene::ImageSize;
use clap::ValueEnum;
use serde::Serialize;
use std::io::Write;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Whose results
    #[arg(value_name = "PAPER")]
    paper: Paper,
    /// Folder for reproduce.json, reproduce.csv, reproduce.txt, plots and pictures; created if need be
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Image size in pixels [default: of the 1986 paper its own, 512x480, and 436x479 for the kitchen; for the
    /// t-buffer paper 640x480 for pictures and 240x180 for times]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<ImageSize>,
    /// The most times that anything is done to time it; what takes a second is done once
    #[arg(long, value_name = "N", default_value_t = 3,
          value_parser = clap::value_parser!(u32).range(1..=100))]
    repetitions: u32,
    /// Copy of reproduce.json; - is standard output instead of the tables
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Threads [default: all]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// The most memory that a buffer may need, such as 16G; others are skipped or refused [default: what the
    /// machine has free]
    #[arg(long, value_name = "BYTES", value_parser = memory::parse)]
    memory_limit: Option<MemoryLimit>,
    /// No progress and no messages but errors
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten, next_help_heading = "Options of haines-greenberg")]
    haines_greenberg: haines_greenberg::TableOptions,
    #[command(flatten, next_help_heading = "Options of raghuvanshi-dhande")]
    raghuvanshi_dhande: raghuvanshi_dhande::FigureOptions,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Paper {
    /// The seven timing tests of The Light Buffer, 1986
    HainesGreenberg,
    /// Figures 9 to 18 of the t-buffer paper, 2004
    RaghuvanshiDhande,
}

pub fn run(args: &Args) -> Result<Outcome> {
    let messages = Messages::new(args.quiet);
    args.refuse_foreign_options()?;
    output::expect_folder(&args.output)?;
    output::warn_of_remains(&args.output, messages);
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    thread_pool(args.threads)?.install(|| match args.paper {
        Paper::HainesGreenberg => haines_greenberg::run(args, messages),
        Paper::RaghuvanshiDhande => raghuvanshi_dhande::run(args, messages),
    })
}

impl Args {
    /// Options of a paper say nothing about another.
    fn refuse_foreign_options(&self) -> Result<()> {
        let (foreign, paper) = match self.paper {
            Paper::HainesGreenberg => (self.raghuvanshi_dhande.given(), "raghuvanshi-dhande"),
            Paper::RaghuvanshiDhande => (self.haines_greenberg.given(), "haines-greenberg"),
        };
        match foreign {
            Some(option) => Err(Error::Usage(format!("{option} is for `reproduce {paper}` alone"))),
            None => Ok(()),
        }
    }

    fn memory_limit(&self) -> MemoryLimit {
        self.memory_limit.unwrap_or_else(MemoryLimit::of_this_machine)
    }

    /// Adds a file of the folder.
    fn write(&self, files: &mut FileSet, name: &str, text: &str) -> Result<()> {
        files.write(&self.output.join(name), |file| file.write_all(text.as_bytes()))
    }

    /// Adds the document in its three forms, writes the one that was asked for to standard output, and lets all files
    /// appear.
    fn finish(&self, mut files: FileSet, document: &impl Serialize, text: &str, csv: &str) -> Result<()> {
        self.write(&mut files, "reproduce.csv", csv)?;
        self.write(&mut files, "reproduce.txt", text)?;
        output::add_json(&mut files, &self.output.join("reproduce.json"), document)?;
        let shown = output::add_copy(&mut files, self.json.as_deref(), document, || text.into())?;
        output::finish(files, &shown)
    }
}

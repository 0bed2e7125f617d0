//! `lightbuffer report`: one page of what other commands left in a folder.

use super::progress::Messages;
use super::{Outcome, output};
use crate::error::Result;
use crate::film::FileSet;
use crate::film::grouped;
use crate::report::page::page;
use std::io::Write;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
#[command(
    after_help = "The page is one file that needs no network: pictures, maps with every pixel's verdict, tables and \
                        plots are all in it. Its size is that of the PNG pictures, and some hundred kilobytes for each \
                        scene of 1280x720. Not read are EXR files beside reproduce.json, and files that no document names."
)]
pub struct Args {
    /// Folder that holds validate.json, bench.json or reproduce.json with their images, itself or in folders in it
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// The page, one HTML file
    #[arg(short, long, value_name = "FILE", default_value = "report.html")]
    output: PathBuf,
    /// No messages but errors
    #[arg(short, long)]
    quiet: bool,
}

pub fn run(args: &Args) -> Result<Outcome> {
    let messages = Messages::new(args.quiet);
    output::expect_writable(&args.output)?;
    let page = page(&args.folder, &|what| messages.say(what))?;
    let shown = match output::is_standard_output(&args.output) {
        true => {
            return output::print(&page.html).map(|()| Outcome::Right);
        }
        false => {
            let [validations, benches, reproductions] = page.documents;
            format!(
                "{}: {} bytes, of {validations} validate.json, {benches} bench.json, {reproductions} reproduce.json\n",
                args.output.display(),
                grouped(page.html.len() as u64)
            )
        }
    };
    let mut files = FileSet::new();
    files.write(&args.output, |file| file.write_all(page.html.as_bytes()))?;
    output::finish(files, &shown)?;
    Ok(Outcome::Right)
}

//! `lightbuffer completions` and `lightbuffer manual`: what a shell and `man` want to know, from the options themselves.

use super::{Cli, Outcome, output};
use crate::error::Result;
use crate::film::FileSet;
use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use std::io::{self, Write};
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct CompletionArgs {
    /// The shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Writes what the shell reads to standard output.
///
/// # Errors
/// If it cannot be written.
pub fn completions(args: &CompletionArgs) -> Result<Outcome> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "lightbuffer", &mut text);
    output::print(&String::from_utf8_lossy(&text))?;
    Ok(Outcome::Right)
}

#[derive(Debug, clap::Args)]
pub struct ManualArgs {
    /// Folder for lightbuffer.1 and a page for each command; created if need be [default: the first alone, to standard
    /// output]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Writes the manual pages.
///
/// # Errors
/// If they cannot be written.
pub fn manual(args: &ManualArgs) -> Result<Outcome> {
    let mut command = Cli::command();
    command.build();
    let Some(folder) = &args.output else {
        let page =
            rendered(&command).map_err(|e| crate::Error::io("standard output".as_ref(), "write", e))?;
        output::print(&String::from_utf8_lossy(&page))?;
        return Ok(Outcome::Right);
    };
    let mut files = FileSet::new();
    files.folder(folder)?;
    let commands = command.get_subcommands().filter(|command| command.get_name() != "help");
    for command in [&command].into_iter().chain(commands) {
        let name = command.get_display_name().unwrap_or(command.get_name()).to_string();
        let path = folder.join(format!("{name}.1"));
        files.write(&path, |file| file.write_all(&rendered(command)?))?;
    }
    output::finish(files, "")?;
    Ok(Outcome::Right)
}

fn rendered(command: &Command) -> io::Result<Vec<u8>> {
    let mut page = Vec::new();
    Man::new(command.clone()).render(&mut page)?;
    Ok(page)
}

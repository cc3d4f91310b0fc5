//! `completions` and `man`: the description of the command line enters; a shell's completions on stdout, or manual pages in a
//! folder, leave. Both are made of what `--help` is made of, so that they cannot differ from it.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;

use super::cli::Cli;
use crate::draft::Draft;
use crate::error::Error;
use crate::output;
use crate::places::can_be_folder;
use crate::verdict::Verdict;

/// The arguments of `completions`.
#[derive(Clone, Copy, Debug, Args)]
pub struct CompletionsArguments {
    /// The shell
    pub shell: Shell,
}

/// The arguments of `man`.
#[derive(Clone, Debug, Args)]
pub struct ManArguments {
    /// Folder for the pages; it is created
    pub folder: PathBuf,
}

/// The end of `completions --help`.
pub const COMPLETIONS_AFTER_HELP: &str = "\
Examples:
  holdover-sim completions bash > ~/.local/share/bash-completion/completions/holdover-sim
  holdover-sim completions zsh > ~/.zfunc/_holdover-sim
  holdover-sim completions fish > ~/.config/fish/completions/holdover-sim.fish";

/// The end of `man --help`.
pub const MAN_AFTER_HELP: &str = "\
Examples:
  holdover-sim man ~/.local/share/man/man1 && man holdover-sim-run";

/// Prints the completions.
///
/// # Errors
/// An output that cannot be written.
pub fn completions(shell: Shell) -> Result<Verdict, Error> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "holdover-sim", &mut text);
    output::print(&String::from_utf8_lossy(&text)).map(|()| Verdict::Pass)
}

/// Writes a page for the program and one for each command.
///
/// # Errors
/// A folder that cannot be made, and pages that cannot be written.
pub fn man(folder: &Path) -> Result<Verdict, Error> {
    can_be_folder("FOLDER", folder, "name a folder that you may write")?;
    fs::create_dir_all(folder).map_err(|error| Error::unwritable(folder, &error))?;
    let mut program = Cli::command().disable_help_subcommand(true);
    program.build();
    let commands: Vec<clap::Command> = program.get_subcommands().cloned().collect();
    for command in std::iter::once(program).chain(commands) {
        // Built, a command is displayed with the program's name before its own: `holdover-sim-run`.
        let name = command.get_display_name().unwrap_or(command.get_name()).to_owned();
        let file = folder.join(format!("{name}.1"));
        let mut page = Vec::new();
        Man::new(command).render(&mut page).map_err(|error| Error::unwritable(&file, &error))?;
        Draft::whole(&file, &String::from_utf8_lossy(&page))?;
    }
    output::say(&format!("manual pages: {}", folder.display()));
    Ok(Verdict::Pass)
}

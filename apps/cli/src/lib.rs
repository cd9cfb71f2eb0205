//! The command line `chordal`: arguments in, exit codes out; everything else is in the library `chordal`.
//!
//! It is a library itself, so that a program in another language can offer the same command line.

mod args;
mod batch;
mod bench;
mod check;
mod compare;
mod convert;
mod device;
mod drawing;
mod exit;
mod guard;
mod info;
mod inputs;
mod mesh;
mod messages;
mod outputs;
mod process;
mod progress;
mod reading;
mod render;
mod render_args;
mod repro;
mod sew;
mod tree;
mod whole_file;

use args::{Cli, Command};
use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};
use exit::{Exit, print, print_bytes, say};
use std::ffi::{OsStr, OsString};
use std::path::Path;

/// Runs the command line with these arguments, of which the first is the name of the program, and returns the
/// exit code. It takes Ctrl-C and the messages of panics for the whole process.
pub fn run(arguments: Vec<OsString>) -> u8 {
    guard::record_panics();
    let work = || guard::guarded(|| run_command(arguments));
    let exit = process::with_deep_stack(work).flatten().unwrap_or_else(|sentence| {
        say(&sentence);
        Exit::Nothing
    });
    exit.code()
}

fn run_command(arguments: Vec<OsString>) -> Exit {
    let cli = match Cli::try_parse_from(with_subcommand(arguments)) {
        Ok(cli) => cli,
        Err(error) => return usage(&error),
    };
    match cli.command {
        Command::Mesh(args) => mesh::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Sew(args) => sew::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Repro(args) => repro::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Completions(args) => {
            let mut script = Vec::new();
            clap_complete::generate(args.shell, &mut Cli::command(), "chordal", &mut script);
            print_bytes(&script);
            Exit::Clean
        }
        Command::Man => manual(),
    }
}

/// The manual page, with the subcommands behind each other.
fn manual() -> Exit {
    let mut page = Vec::new();
    let mut command = Cli::command();
    command.build();
    let shown = command.get_subcommands().filter(|c| !c.is_hide_set() && c.get_name() != "help").cloned();
    let pages = std::iter::once(command.clone()).chain(shown);
    for command in pages {
        if let Err(error) = clap_mangen::Man::new(command).render(&mut page) {
            say(&format!("cannot make the manual page: {error}"));
            return Exit::Nothing;
        }
    }
    print_bytes(&page);
    Exit::Clean
}

/// `chordal part.step` is short for `chordal mesh part.step`.
fn with_subcommand(mut arguments: Vec<OsString>) -> Vec<OsString> {
    if arguments.get(1).is_some_and(|first| is_input(first)) {
        arguments.insert(1, "mesh".into());
    }
    arguments
}

/// A file or folder that exists, standard input, or a name with the extension of a CAD file.
fn is_input(argument: &OsStr) -> bool {
    let is_subcommand = Cli::command().get_subcommands().any(|c| argument == c.get_name());
    let extension = Path::new(argument).extension().and_then(|e| e.to_str()).unwrap_or_default();
    let is_cad = || chordal::InputFormat::of_extension(extension).is_some();
    argument != "help" && !is_subcommand && (argument == "-" || is_cad() || Path::new(argument).exists())
}

/// Help and version as they are; of an error the first paragraph, which is the sentence, and the hint behind
/// it.
fn usage(error: &clap::Error) -> Exit {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            print(&error.render().to_string());
            Exit::Clean
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            eprint!("{}", error.render());
            Exit::Nothing
        }
        _ => {
            let text = error.render().to_string();
            let paragraph: Vec<&str> =
                text.lines().take_while(|line| !line.trim().is_empty()).map(str::trim).collect();
            let tip = text.lines().find_map(|line| line.trim().strip_prefix("tip: "));
            let tip = tip.map_or_else(String::new, |tip| format!(" ({tip})"));
            say(&format!("{}{tip}", paragraph.join(" ").trim_start_matches("error: ")));
            Exit::Nothing
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn an_input_stands_for_mesh() {
        let full = |line: &str| -> Vec<String> {
            let arguments = line.split(' ').map(OsString::from).collect();
            with_subcommand(arguments).into_iter().map(|a| a.to_string_lossy().into_owned()).collect()
        };
        assert_eq!(full("chordal a.STEP -o b.stl")[1], "mesh");
        assert_eq!(full("chordal - -o b.stl")[1], "mesh");
        assert_eq!(full("chordal info a.step")[1], "info");
        assert_eq!(full("chordal --help")[1], "--help");
        assert_eq!(full("chordal frobnicate")[1], "frobnicate");
    }
}

//! The command line `chordal`: arguments in, exit codes out; everything else is the facade's.

mod args;
mod batch;
mod bench;
mod check;
mod compare;
mod convert;
mod device;
mod exit;
mod guard;
mod info;
mod mesh;
mod outputs;
mod progress;
mod render;
mod render_args;
mod sew;

use args::{Cli, Command};
use clap::Parser;
use clap::error::ErrorKind;
use exit::{Exit, say};
use std::process::ExitCode;

/// Meshing is many short-lived lists: this allocator saves a tenth of the time of light files.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    // A face that panics is that face's failure, reported by the library: the hook's own words would be noise.
    guard::silence();
    let exit = guard::guarded(run).unwrap_or_else(|sentence| {
        say(&sentence);
        Exit::Nothing
    });
    exit.code()
}

fn run() -> Exit {
    let cli = match Cli::try_parse() {
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
        Command::Compare(args) => compare::run(&args),
        Command::Bench(args) => bench::run(&args),
    }
}

/// Help and version as they are; of an error the first paragraph, which is the sentence.
fn usage(error: &clap::Error) -> Exit {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            exit::print(&error.render().to_string());
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
            say(paragraph.join(" ").trim_start_matches("error: "));
            Exit::Nothing
        }
    }
}

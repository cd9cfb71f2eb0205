//! `chordal convert`: an exact model from one file into another.

use crate::args::ConvertArgs;
use crate::exit::{Exit, say};
use chordal::ConvertOptions;

pub fn run(args: &ConvertArgs) -> Exit {
    let options = ConvertOptions::default().with_unsewn(args.unsewn);
    match chordal::convert(&args.input, &args.output, &options) {
        Ok(converted) => {
            let lost: Vec<_> = converted.issues.iter().filter(|issue| issue.is_error()).collect();
            lost.iter().for_each(|issue| say(&format!("{}: problem: {issue}", args.input.display())));
            if lost.is_empty() { Exit::Clean } else { Exit::Undone }
        }
        Err(error) => {
            say(&error.to_string());
            Exit::Nothing
        }
    }
}

//! `chordal convert`: an exact model from one file into another.

use crate::args::ConvertArgs;
use crate::exit::{Exit, print, say};
use crate::inputs::Input;
use crate::messages::error_sentence;
use crate::reading::read_model;
use crate::whole_file::write_whole;
use chordal::{Model, ReadOptions, Severity};

/// Runs the command.
pub fn run(args: &ConvertArgs) -> Exit {
    match convert(args) {
        Ok(exit) => exit,
        Err(sentence) => {
            say(&sentence);
            Exit::Nothing
        }
    }
}

fn convert(args: &ConvertArgs) -> Result<Exit, String> {
    let to_stdout = args.output.as_os_str() == "-";
    let extension = args.output.extension().and_then(|e| e.to_str()).unwrap_or_default();
    if !to_stdout && !extension.eq_ignore_ascii_case("json") {
        return Err(format!("{}: the output must be a .json file", args.output.display()));
    }
    if to_stdout && args.json {
        return Err("--json and the model both go to standard output".into());
    }
    let input = Input::of(&args.input);
    let failed = |error: chordal::Error| error_sentence(&input.name(), &error);
    let mut model = read_model(&input, args.input_format, &ReadOptions::default()).map_err(failed)?;
    if args.unsewn {
        model = model.unsewn();
    }
    let text = model.to_json().map_err(failed)?;
    if to_stdout {
        print(&text);
    } else {
        write_whole(&args.output, text.as_bytes())
            .map_err(|e| format!("{}: cannot write the file: {e}", args.output.display()))?;
    }
    if args.json {
        print(&summary(args, &model, text.len()));
    }
    // Faces that could not be read are in the document as such; what was dropped is not.
    let is_lost = |w: &&chordal::Problem| w.severity == Severity::Error && w.part.is_none();
    let problems = model.problems();
    let lost: Vec<_> = problems.iter().filter(is_lost).collect();
    lost.iter().for_each(|problem| say(&format!("{}: problem: {}", input.name(), problem.sentence())));
    Ok(if lost.is_empty() { Exit::Clean } else { Exit::Problems })
}

fn summary(args: &ConvertArgs, model: &Model, bytes: usize) -> String {
    let parts = &model.brep().parts;
    let summary = serde_json::json!({
        "schema": "chordal-convert/1",
        "input": args.input.display().to_string(),
        "output": args.output.display().to_string(),
        "bytes": bytes,
        "parts": parts.len(),
        "faces": parts.iter().map(|part| part.faces.len()).sum::<usize>(),
        "problems": model.problems(),
    });
    format!("{summary:#}\n")
}

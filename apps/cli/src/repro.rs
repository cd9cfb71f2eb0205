//! `chordal repro`: the smallest piece of a model that shows the problem of one face.

use crate::args::ReproArgs;
use crate::exit::{Exit, print, say};
use crate::inputs::Input;
use crate::messages::error_sentence;
use crate::process::thread_pool;
use crate::reading::read_model;
use crate::whole_file::write_whole;
use chordal::Cancel;
use chordal::brep::issue::words::count;
use chordal::repro::{Repro, repro};

/// Runs the command.
pub fn run(args: &ReproArgs) -> Exit {
    match write(args) {
        Ok(exit) => exit,
        Err(sentence) => {
            say(&sentence);
            Exit::Nothing
        }
    }
}

fn write(args: &ReproArgs) -> Result<Exit, String> {
    let to_stdout = args.output.as_os_str() == "-";
    let extension = args.output.extension().and_then(|e| e.to_str()).unwrap_or_default();
    if !to_stdout && !extension.eq_ignore_ascii_case("json") {
        return Err(format!("{}: the output must be a .json file", args.output.display()));
    }
    if to_stdout && args.json {
        return Err("--json and the model both go to standard output".into());
    }
    args.accuracy.check()?;
    let input = Input::of(&args.input);
    let failed = |error: chordal::Error| error_sentence(&input.name(), &error);
    let accuracy = &args.accuracy;
    let found = thread_pool(accuracy.jobs)?.install(|| {
        let model = read_model(&input, accuracy.input_format, &accuracy.read_options()).map_err(failed)?;
        repro(&model, args.face, &accuracy.options(), &Cancel::default()).map_err(failed)
    })?;
    let text = found.model.to_json().map_err(failed)?;
    if to_stdout {
        print(&text);
    } else {
        write_whole(&args.output, text.as_bytes())
            .map_err(|e| format!("{}: cannot write the file: {e}", args.output.display()))?;
    }
    if args.json {
        print(&summary(args, &found));
    }
    say(&format!("{}: {}", args.output.display(), sentence(args, &found)));
    Ok(if found.shows || found.codes.is_empty() { Exit::Clean } else { Exit::Problems })
}

/// What the piece is, and how to see the problem.
fn sentence(args: &ReproArgs, found: &Repro) -> String {
    let faces = count(found.faces, "face", "faces");
    if found.codes.is_empty() {
        return format!("{faces}; face {} has no problem", args.face);
    }
    let codes = found.codes.join(", ");
    if !found.shows {
        return format!(
            "{faces}, the whole part, which alone does not show the problem of the face ({codes})"
        );
    }
    let tolerance = found.tolerance.map_or_else(String::new, |mm| format!(" --tolerance {mm}mm"));
    format!("{faces}; `chordal mesh {}{tolerance}` shows {codes}", args.output.display())
}

fn summary(args: &ReproArgs, found: &Repro) -> String {
    let summary = serde_json::json!({
        "schema": "chordal-repro/1",
        "input": args.input.display().to_string(),
        "output": args.output.display().to_string(),
        "face": args.face.to_string(),
        "faces": found.faces,
        "codes": found.codes,
        "shows": found.shows,
        "tolerance": found.tolerance,
    });
    format!("{summary:#}\n")
}

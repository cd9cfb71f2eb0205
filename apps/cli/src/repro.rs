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
    let is_step = is_step(args)?;
    if to_stdout && args.json {
        return Err("--json and the model both go to standard output".into());
    }
    args.accuracy.check()?;
    let input = Input::of(&args.input);
    let failed = |error: chordal::Error| error_sentence(&input.name(), &error);
    let accuracy = &args.accuracy;
    let (found, text) = thread_pool(accuracy.jobs)?.install(|| {
        let model = read_model(&input, accuracy.input_format, &accuracy.read_options()).map_err(failed)?;
        let (options, cancel) = (accuracy.options(), Cancel::default());
        let mut found = repro(&model, args.face, &options, &cancel).map_err(failed)?;
        if !is_step {
            let text = found.model.to_json().map_err(failed)?;
            return Ok((found, text));
        }
        let file =
            std::fs::read(&args.input).map_err(|e| format!("{}: cannot read the file: {e}", input.name()))?;
        let (text, shows) = found.to_step(&file, &options, &cancel).map_err(failed)?;
        found.shows = shows;
        Ok::<_, String>((found, text))
    })?;
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

/// Whether the output is STEP; else it is JSON.
fn is_step(args: &ReproArgs) -> Result<bool, String> {
    let extension = args.output.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    match extension.as_str() {
        "step" | "stp" if args.input.as_os_str() == "-" => {
            Err("a piece in STEP is cut out of a file: name the file in place of `-`".into())
        }
        "step" | "stp" => Ok(true),
        "json" => Ok(false),
        _ if args.output.as_os_str() == "-" => Ok(false),
        _ => Err(format!("{}: the output must be a .json or .step file", args.output.display())),
    }
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

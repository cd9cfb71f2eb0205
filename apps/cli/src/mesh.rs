//! `chordal mesh`: one job per input.

use crate::args::MeshArgs;
use crate::batch::{Batch, BatchFailure};
use crate::device::Device;
use crate::exit::{Exit, say};
use crate::guard::guarded;
use crate::outputs::{Outputs, plan};
use crate::progress::Bar;
use chordal::brep::Severity;
use chordal::brep::issue::words::{count, length_mm, number};
use chordal::methods::Strategy;
use chordal::{Cancel, Job, Report};
use std::path::Path;

/// At most so many warnings of one input are shown; the report has all.
const WARNINGS_SHOWN: usize = 3;

pub fn run(args: &MeshArgs) -> Exit {
    let cancel = Cancel::default();
    stop_on_ctrl_c(&cancel);
    let ready = check_report_path(args).and_then(|()| check_quads(args)).and_then(|()| Device::open(args));
    let (device, outputs) = match ready.and_then(|device| Ok((device, plan(args)?))) {
        Ok(ready) => ready,
        Err(sentence) => {
            say(&sentence);
            return Exit::Nothing;
        }
    };
    let mut batch = Batch::default();
    for (input, output) in args.inputs.iter().zip(outputs.files()) {
        match mesh_one(args, &device, input, output, &cancel) {
            Ok(report) => batch.reports.push(report),
            Err(error) => {
                say(&error);
                batch.failed.push(BatchFailure { input: input.display().to_string(), error });
            }
        }
        // All or nothing: there is no use in going on.
        if args.strict && !batch.failed.is_empty() {
            break;
        }
    }
    if !args.quiet {
        device.tell();
    }
    finish(args, outputs, &mut batch)
}

/// Settles what was written, and how the program ends.
fn finish(args: &MeshArgs, outputs: Outputs, batch: &mut Batch) -> Exit {
    if batch.reports.is_empty() || (args.strict && !batch.failed.is_empty()) {
        outputs.discard();
        return Exit::Nothing;
    }
    if let Err(sentence) = outputs.settle(batch) {
        say(&sentence);
        return Exit::Nothing;
    }
    let mut exit = if batch.failed.is_empty() && batch.reports.iter().all(|r| r.clean) {
        Exit::Clean
    } else {
        Exit::Undone
    };
    if let Err(sentence) = write_report(args, batch) {
        say(&sentence);
        exit = exit.max(Exit::Undone);
    }
    exit
}

fn mesh_one(
    args: &MeshArgs,
    device: &Device,
    input: &Path,
    output: &Path,
    cancel: &Cancel,
) -> Result<Report, String> {
    let name = input.file_name().map_or_else(|| input.to_string_lossy(), |n| n.to_string_lossy());
    let bar = Bar::new(&name, args.quiet);
    let job = Job::new(input)
        .with_output(output)
        .with_options(args.options().with_bulk(device.bulk()))
        .with_cancel(cancel.clone())
        .with_progress(bar.listener());
    let outcome = guarded(|| chordal::run(&job)).map_err(|e| format!("{}: {e}", input.display()))?;
    drop(bar);
    let report = outcome.map_err(|e| e.to_string())?.report;
    tell(args, &report);
    Ok(report)
}

/// Prints the options, the result and the problems.
fn tell(args: &MeshArgs, report: &Report) {
    let input = &report.input.path;
    if !args.quiet {
        say(&format!("{input}: {}", options_line(report)));
        say(&format!("{input}: {}", result_line(report)));
        let warnings: Vec<_> = report.warnings().filter(|p| p.severity == Severity::Warning).collect();
        for warning in warnings.iter().take(WARNINGS_SHOWN) {
            say(&format!("{input}: warning: {}", warning.sentence()));
        }
        if warnings.len() > WARNINGS_SHOWN {
            let more = count(warnings.len() - WARNINGS_SHOWN, "more warning", "more warnings");
            say(&format!("{input}: {more} (see --report)"));
        }
    }
    for sentence in report.error_sentences() {
        say(&format!("{input}: problem: {sentence}"));
    }
}

/// `tolerance 0.1 % = 0.2 mm, angle 20°, proven bound, 4 threads`.
fn options_line(report: &Report) -> String {
    let options = &report.options;
    let tolerance = match options.tolerance_requested.ends_with('%') {
        true => format!("{} = {}", options.tolerance_requested, length_mm(options.tolerance)),
        false => length_mm(options.tolerance),
    };
    let angle = options.angle.map_or_else(|| "off".into(), |a| format!("{}°", number(a, 4)));
    let max_edge = options.max_edge.map_or_else(String::new, |l| format!(", longest edge {}", length_mm(l)));
    let threads = count(report.threads, "thread", "threads");
    format!("tolerance {tolerance}, angle {angle}{max_edge}, {} bound, {threads}", options.bound)
}

/// `28 faces, 412 triangles, all 28 faces proven within 0.05 mm, gap 0 mm, watertight, 0.02 s`.
fn result_line(report: &Report) -> String {
    format!(
        "{}, {}, {}, gap {}, {}, {:.2} s",
        count(report.faces.total, "face", "faces"),
        count(report.triangles, "triangle", "triangles"),
        report.proof_sentence(),
        length_mm(report.max_edge_gap),
        report.closedness_sentence(),
        report.seconds.total
    )
}

/// Quadrilaterals are one strategy's, and not every format has them.
fn check_quads(args: &MeshArgs) -> Result<(), String> {
    if args.quads && args.accuracy.strategy.strategy != Some(Strategy::Bezier) {
        return Err("--quads needs --strategy bezier: the others make triangles only".into());
    }
    Ok(())
}

fn check_report_path(args: &MeshArgs) -> Result<(), String> {
    let Some(path) = &args.report else { return Ok(()) };
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(format!("{}: there is no such folder to write the report to", path.display()))
        }
        _ if path.is_dir() => {
            Err(format!("{}: the report needs a file name, this is a folder", path.display()))
        }
        _ => Ok(()),
    }
}

/// One report for one input, a batch for several; complete or not at all.
fn write_report(args: &MeshArgs, batch: &Batch) -> Result<(), String> {
    let Some(path) = &args.report else { return Ok(()) };
    let text = match (&batch.reports[..], args.inputs.len()) {
        ([only], 1) => only.to_json(),
        _ => batch.to_json(),
    };
    chordal::write_whole(path, &text).map_err(|e| format!("{}: cannot write the report: {e}", path.display()))
}

/// The first Ctrl-C ends the work at the next face, the second at once; neither leaves a half-written file.
fn stop_on_ctrl_c(cancel: &Cancel) {
    let cancel = cancel.clone();
    let stop = move || {
        if cancel.is_cancelled() {
            std::process::exit(2);
        }
        cancel.cancel();
    };
    if ctrlc::set_handler(stop).is_err() {
        say("Ctrl-C cannot be caught here and ends the program at once");
    }
}

//! `chordal mesh`: every input becomes one mesh.

use crate::args::MeshArgs;
use crate::batch::{Batch, BatchFailure};
use crate::device::Device;
use crate::drawing::write_drawings;
use crate::exit::{Exit, print, say, try_print};
use crate::guard::guarded;
use crate::inputs::{Input, expand};
use crate::messages::{error_sentence, tell};
use crate::outputs::{Outputs, Target, add_output, plan};
use crate::process::{peak_memory, thread_pool};
use crate::progress::Bar;
use crate::reading::read_model;
use crate::whole_file::write_whole;
use chordal::methods::Strategy;
use chordal::write::WriteError;
use chordal::{Cancel, Meshed, Mesher, OutputFormat, Report, RequestError, WriteOptions};
use std::time::Instant;

/// Runs the command.
pub fn run(args: &MeshArgs) -> Exit {
    let cancel = Cancel::default();
    stop_on_ctrl_c(&cancel);
    let ready = prepare(args);
    let (device, inputs, outputs) = match ready {
        Ok(ready) => ready,
        Err(sentence) => {
            say(&sentence);
            return Exit::Nothing;
        }
    };
    let pool = match thread_pool(args.accuracy.jobs) {
        Ok(pool) => pool,
        Err(sentence) => {
            say(&sentence);
            return Exit::Nothing;
        }
    };
    let job = Job { args, device: &device, outputs: &outputs, cancel: &cancel };
    let mut batch = Batch::default();
    for (input, (target, format)) in inputs.iter().zip(outputs.targets()) {
        let result = guarded(|| pool.install(|| job.mesh(input, target, format)));
        match result.map_err(|e| format!("{}: {e}", input.name())).flatten() {
            Ok(report) => batch.reports.push(report),
            Err(error) => {
                say(&error);
                batch.failed.push(BatchFailure { input: input.name(), error });
            }
        }
        // All or nothing: there is no use in going on.
        if (args.strict && !batch.failed.is_empty()) || cancel.is_cancelled() {
            break;
        }
    }
    if !args.quiet {
        device.tell();
    }
    finish(args, outputs, &batch, inputs.len())
}

fn prepare(args: &MeshArgs) -> Result<(Device, Vec<Input>, Outputs), String> {
    check_report_path(args)?;
    let inputs = expand(&args.inputs)?;
    let device = Device::open(args)?;
    let outputs = plan(args, &inputs)?;
    if let Err(sentence) = check_formats(args, &outputs) {
        outputs.discard();
        return Err(sentence);
    }
    Ok((device, inputs, outputs))
}

/// What the inputs of one run share.
struct Job<'a> {
    args: &'a MeshArgs,
    device: &'a Device,
    outputs: &'a Outputs,
    cancel: &'a Cancel,
}

impl Job<'_> {
    /// Reads, meshes and writes one input.
    fn mesh(&self, input: &Input, target: &Target, format: OutputFormat) -> Result<Report, String> {
        let (started, accuracy) = (Instant::now(), &self.args.accuracy);
        let failed = |error: chordal::Error| error_sentence(&input.name(), &error);
        let bar = Bar::new(&input.name(), self.args.quiet);
        bar.phase("reading");
        let model = read_model(input, accuracy.input_format, &accuracy.read_options()).map_err(failed)?;
        if self.cancel.is_cancelled() {
            return Err(failed(chordal::Error::Cancelled));
        }
        let options = self.args.options(format).with_bulk(self.device.bulk());
        let mesher = Mesher::new(options).with_cancel(self.cancel.clone()).with_progress(bar.listener());
        let meshed = mesher.mesh(&model).map_err(failed)?;
        if let Some(folder) = &self.args.debug_svg {
            write_drawings(folder, &meshed).map_err(|e| format!("{}: {e}", folder.display()))?;
        }
        let mut report = meshed.report().clone();
        if self.args.strict && !report.clean {
            return Err(format!("{}: nothing written because of --strict: {}", input.name(), first(&report)));
        }
        bar.phase("writing");
        let clock = Instant::now();
        self.write(&meshed, target, format, &mut report).map_err(failed)?;
        report.seconds.write = clock.elapsed().as_secs_f64();
        report.seconds.total = started.elapsed().as_secs_f64();
        report.peak_memory = peak_memory();
        drop(bar);
        tell(self.args.talk(), &report);
        if let (Target::File(path), None, false) = (target, &self.args.output, self.args.quiet) {
            say(&format!("{}: written to {}", input.name(), path.display()));
        }
        Ok(report)
    }

    fn write(
        &self,
        meshed: &Meshed,
        target: &Target,
        format: OutputFormat,
        report: &mut Report,
    ) -> Result<(), chordal::Error> {
        let mut options = WriteOptions::new(format).with_edge_lines(self.args.edges);
        options.unit = self.args.unit;
        options.up = self.args.up();
        let summary = match target {
            Target::File(path) => meshed.write_with(self.outputs.path_now(path), &options)?,
            Target::Stdout => {
                let encoded = meshed.to_bytes_with(&options)?;
                try_print(&encoded.bytes).map_err(|source| {
                    let (path, source) = ("standard output".into(), WriteError::Io(source));
                    chordal::Error::Request(RequestError::Write { path, source })
                })?;
                encoded.summary
            }
        };
        add_output(report, target, format, &summary);
        Ok(())
    }
}

fn first(report: &Report) -> String {
    match &report.error_sentences()[..] {
        [] => "the mesh has problems".into(),
        [one] => one.clone(),
        [first, rest @ ..] => format!("{first} (and {} more)", rest.len()),
    }
}

/// Settles what was written, and how the program ends.
fn finish(args: &MeshArgs, outputs: Outputs, batch: &Batch, inputs: usize) -> Exit {
    if batch.reports.is_empty() || (args.strict && !batch.failed.is_empty()) {
        outputs.discard();
        return Exit::Nothing;
    }
    if let Err(sentence) = outputs.settle() {
        say(&sentence);
        return Exit::Nothing;
    }
    let all = batch.failed.is_empty() && batch.reports.len() == inputs;
    let mut exit = if all && batch.reports.iter().all(|r| r.clean) { Exit::Clean } else { Exit::Problems };
    let text = || match (&batch.reports[..], inputs) {
        ([only], 1) => only.to_json(),
        _ => batch.to_json(),
    };
    if args.json {
        print(&text());
    }
    if let Some(path) = &args.report
        && let Err(error) = write_whole(path, text().as_bytes())
    {
        say(&format!("{}: cannot write the report: {error}", path.display()));
        exit = exit.max(Exit::Problems);
    }
    exit
}

/// An option that has no effect on a format is refused.
fn check_formats(args: &MeshArgs, outputs: &Outputs) -> Result<(), String> {
    for (target, format) in outputs.targets() {
        use OutputFormat::{Glb, Gltf, Obj, Ply};
        if args.edges && !matches!(format, Glb | Gltf) {
            return Err(format!("--edges needs GLB or glTF as output: {format} has no lines"));
        }
        if args.quads && !matches!(format, Obj | Ply) {
            return Err(format!("--quads needs OBJ or PLY as output: {format} has triangles only"));
        }
        if args.json && *target == Target::Stdout {
            return Err("--json and the mesh both go to standard output; use --report or -o".into());
        }
        if *target == Target::Stdout && args.output.is_none() && crate::exit::stdout_is_terminal() {
            return Err("the mesh of standard input needs an output: use -o".into());
        }
    }
    args.accuracy.check()?;
    if args.quads && args.accuracy.strategy.strategy != Some(Strategy::Bezier) {
        return Err("--quads needs --strategy bezier: other strategies make triangles only".into());
    }
    Ok(())
}

fn check_report_path(args: &MeshArgs) -> Result<(), String> {
    let Some(path) = &args.report else { return Ok(()) };
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(format!("{}: no such folder for the report", folder.display()))
        }
        _ if path.is_dir() => {
            Err(format!("{}: the report needs a file name, this is a folder", path.display()))
        }
        _ => Ok(()),
    }
}

/// The first Ctrl-C cancels at the next face, the second ends the program at once; neither leaves a
/// half-written file.
fn stop_on_ctrl_c(cancel: &Cancel) {
    let cancel = cancel.clone();
    let stop = move || {
        if cancel.is_cancelled() {
            std::process::exit(2);
        }
        cancel.cancel();
    };
    if ctrlc::set_handler(stop).is_err() {
        say("Ctrl-C cannot be handled on this system and ends the program at once");
    }
}

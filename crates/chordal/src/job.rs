//! The whole job, top to bottom:
//!
//! ```text
//! read → sew → resolve → heal parameters → discretise edges → size → place points → trim + triangulate → stitch → audit → write
//!              └ here    └──────────────────── chordal_tessellate, once per part ─────────────────────┘
//! ```

use crate::account::{Findings, Ledger, account};
use crate::area::area;
use crate::auditing::audit_parts;
use crate::drawing::write_drawings;
use crate::meshed_part::mesh_parts;
use crate::process::peak_memory;
use crate::report::InputReport;
use crate::resolve::{Resolved, resolve};
use crate::scene::scene;
use crate::sewing::sew_model;
use crate::{JobError, JobOptions, OnProgress, Progress, Report};
use chordal_brep::{FaceGeometry, Model};
use chordal_mesh::Scene;
use chordal_read::ReadOptions;
use chordal_tessellate::Cancel;
use chordal_write::{Format, WriteOptions, WriteSummary, write_scene};
use std::fmt;
use std::path::{Path, PathBuf};

/// One file to be meshed.
#[derive(Clone)]
pub struct Job {
    pub input: PathBuf,
    /// `None`: nothing is written.
    pub output: Option<PathBuf>,
    pub options: JobOptions,
    pub cancel: Cancel,
    pub on_progress: Option<OnProgress>,
}

impl fmt::Debug for Job {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Job")
            .field("input", &self.input)
            .field("output", &self.output)
            .field("options", &self.options)
            .finish_non_exhaustive()
    }
}

impl Job {
    /// A job with default options that writes nothing.
    pub fn new(input: impl Into<PathBuf>) -> Self {
        Self {
            input: input.into(),
            output: None,
            options: JobOptions::default(),
            cancel: Cancel::default(),
            on_progress: None,
        }
    }
    pub fn with_output(mut self, output: impl Into<PathBuf>) -> Self {
        self.output = Some(output.into());
        self
    }
    pub fn with_options(mut self, options: JobOptions) -> Self {
        self.options = options;
        self
    }
    pub fn with_cancel(mut self, cancel: Cancel) -> Self {
        self.cancel = cancel;
        self
    }
    pub fn with_progress(mut self, on_progress: OnProgress) -> Self {
        self.on_progress = Some(on_progress);
        self
    }
    fn tell(&self, progress: Progress) {
        if let Some(on_progress) = &self.on_progress {
            on_progress(progress);
        }
    }
    fn check_cancelled(&self) -> Result<(), JobError> {
        if self.cancel.is_cancelled() {
            Err(JobError::Cancelled { path: self.input.clone() })
        } else {
            Ok(())
        }
    }
}

/// What a job made.
#[derive(Clone, Debug)]
pub struct Outcome {
    pub model: Model,
    pub scene: Scene,
    pub report: Report,
}

/// Runs the whole job.
///
/// # Errors
/// Where nothing was written; the message is one sentence. A face that fails is no error: the report lists it.
pub fn run(job: &Job) -> Result<Outcome, JobError> {
    thread_pool(job.options.jobs)?.install(|| run_stages(job))
}

fn run_stages(job: &Job) -> Result<Outcome, JobError> {
    let mut ledger = Ledger::start();

    // 1. Read.
    job.tell(Progress::Reading);
    let format = output_format(job)?;
    let mut model = ledger.time(|s| &mut s.read, || read_model_with(&job.input, &job.options.read))?;
    something_to_mesh(&model, &job.input)?;
    job.check_cancelled()?;

    // 2. Sew: faces without neighbours get them by the geometry of their borders.
    job.tell(Progress::Sewing);
    let sewn = ledger.time(|s| &mut s.sew, || sew_model(&mut model, job.options.sew));
    job.check_cancelled()?;

    // 3. Resolve: what the options mean in the units of every part.
    job.tell(Progress::Measuring);
    let resolved =
        ledger.time(|s| &mut s.resolve, || resolve(&model, &job.options, format, &job.input, &job.cancel))?;

    // 4. Mesh every placed part once: heal, discretise edges, size, place, trim and triangulate, stitch.
    let mut parts = mesh_parts(&model, &resolved, &job.cancel, &|progress| job.tell(progress));
    job.check_cancelled()?;

    if let Some(folder) = &job.options.debug_svg {
        write_drawings(folder, &parts)?;
    }

    // 5. Audit: recompute every promise from the model and the meshes.
    job.tell(Progress::Auditing);
    let audits = ledger.time(|s| &mut s.audit, || audit_parts(&model, &resolved, &mut parts));
    job.check_cancelled()?;

    // 6. Account: what was done, what is proven, what went wrong.
    let found = Findings { model: &model, sewn: &sewn, resolved: &resolved, parts: &parts, audits: &audits };
    let mut report = account(input_report(job, &model, &resolved), &job.options, &found);
    // Faces that have no area need no triangles: that is no failure.
    let needs_none = report.error_sentences().is_empty() && report.faces.zero_area > 0;
    if report.triangles == 0 && !needs_none {
        let (faces, first) = (report.faces.total, report.error_sentences().into_iter().next());
        let first = first.unwrap_or_else(|| "they have no area, or are never placed".into());
        return Err(JobError::NothingMeshed { path: job.input.clone(), faces, first });
    }
    if job.options.strict && !report.clean {
        return Err(JobError::Strict { path: job.input.clone(), problems: report.error_sentences() });
    }

    // 7. Write.
    job.tell(Progress::Writing);
    let scene =
        scene(&model, parts.iter().map(|p| p.mesh.clone()).collect(), format.is_some_and(Format::is_gltf));
    report.area = area(&scene);
    if let (Some(output), Some(format)) = (&job.output, format) {
        let summary = ledger
            .time(|s| &mut s.write, || write(&scene, output, format, &job.options, resolved.tolerance))?;
        report.add_output(&output.display().to_string(), format, &summary);
    }
    ledger.close(&mut report);
    report.peak_memory = peak_memory();
    report.threads = rayon::current_num_threads();
    Ok(Outcome { model, scene, report })
}

fn input_report(job: &Job, model: &Model, resolved: &Resolved) -> InputReport {
    InputReport {
        path: job.input.display().to_string(),
        bytes: std::fs::metadata(&job.input).map_or(0, |m| m.len()),
        format: model.schema.clone(),
        unit: model.unit.clone(),
        diagonal: resolved.diagonal,
    }
}

/// Reads a model that holds something to mesh.
///
/// # Errors
/// Where the file cannot be read, or holds neither a face nor a triangle.
pub fn read_model(input: &Path) -> Result<Model, JobError> {
    read_model_with(input, &ReadOptions::default())
}

/// The same by the caller's conventions.
///
/// # Errors
/// As [`read_model`].
pub fn read_model_with(input: &Path, options: &ReadOptions) -> Result<Model, JobError> {
    let model = chordal_read::read_file(input, options)
        .map_err(|source| JobError::Read { path: input.to_owned(), source })?;
    if model.parts.iter().all(|p| p.faces.is_empty() && p.tessellated.is_empty()) {
        let loose = model.parts.iter().map(|p| p.loose.len()).sum();
        return Err(JobError::Empty { path: input.to_owned(), loose });
    }
    Ok(model)
}

/// A model of which nothing can be meshed has no size either: what is wrong with its first face is the reason to give.
fn something_to_mesh(model: &Model, input: &Path) -> Result<(), JobError> {
    let mut first = None;
    for part in &model.parts {
        if !part.tessellated.is_empty() {
            return Ok(());
        }
        for face in &part.faces {
            match &face.geometry {
                FaceGeometry::Surface(_) => return Ok(()),
                FaceGeometry::Failed(issue) => {
                    first.get_or_insert_with(|| {
                        format!("the face at {}: {}", face.source, issue.about(face.source))
                    });
                }
            }
        }
    }
    let faces = model.parts.iter().map(|part| part.faces.len()).sum();
    Err(JobError::NothingMeshed { path: input.to_owned(), faces, first: first.unwrap_or_default() })
}

/// A pool of `threads` threads, or of one per core.
///
/// # Errors
/// Where the system refuses the threads.
pub fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool, JobError> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .stack_size(16 << 20)
        .build()
        .map_err(|e| JobError::Threads { threads: threads.unwrap_or(0), reason: e.to_string() })
}

/// The format that the output will be in; `None` where nothing is written.
fn output_format(job: &Job) -> Result<Option<Format>, JobError> {
    let Some(output) = &job.output else { return Ok(job.options.format) };
    let by_extension = || output.extension().and_then(|e| e.to_str()).and_then(Format::from_extension);
    match job.options.format.or_else(by_extension) {
        Some(format) => Ok(Some(format)),
        None => Err(JobError::Output {
            path: output.clone(),
            reason: "the extension names no format that can be written (stl, ply, obj, glb, gltf, 3mf)"
                .into(),
        }),
    }
}

fn write(
    scene: &Scene,
    output: &Path,
    format: Format,
    options: &JobOptions,
    tolerance: f64,
) -> Result<WriteSummary, JobError> {
    let mut how = WriteOptions::new(format).with_edge_lines(options.edges).with_tolerance_mm(tolerance);
    how.unit = options.unit;
    how.up = options.up;
    write_scene(scene, output, &how).map_err(|source| JobError::Write { path: output.to_owned(), source })
}

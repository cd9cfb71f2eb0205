//! Pictures of models.

use crate::{Job, JobError, JobOptions, OnProgress, Report, run, whole_file};
use chordal_gpu::{
    DeviceChoice, FaceRenderer, FaceScene, Gpu, GpuError, Legend, RenderOptions, Renderer, Style,
    mesh_scenery, trimmed_model,
};
use chordal_tessellate::Cancel;
use std::fmt;
use std::path::{Path, PathBuf};

/// What is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RenderMode {
    /// The triangles of the mesh.
    #[default]
    Mesh,
    /// The exact surfaces, evaluated for the view and trimmed at every sample.
    Nurbs,
}

/// What exact pictures took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Evaluated {
    /// Points evaluated on the device.
    pub points: usize,
    /// Faces drawn from them; the others are beyond the picture or show their backs.
    pub drawn: usize,
    /// Faces without an exact form, drawn as triangles.
    pub meshed: usize,
}

/// A picture to be taken of one file.
#[derive(Clone)]
pub struct RenderJob {
    pub input: PathBuf,
    /// The PNG file.
    pub output: PathBuf,
    /// How the model is meshed.
    pub mesh: JobOptions,
    pub picture: RenderOptions,
    pub mode: RenderMode,
    pub device: DeviceChoice,
    pub cancel: Cancel,
    pub on_progress: Option<OnProgress>,
}

impl fmt::Debug for RenderJob {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RenderJob")
            .field("input", &self.input)
            .field("output", &self.output)
            .field("picture", &self.picture)
            .finish_non_exhaustive()
    }
}

/// What was drawn.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The adapter that drew it.
    pub adapter: String,
    /// What the colours mean, of measured styles.
    pub legend: Option<Legend>,
    /// Of exact pictures.
    pub evaluated: Option<Evaluated>,
    /// How the model was meshed.
    pub report: Report,
}

/// Why there is no picture; each message is one sentence.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    #[error(transparent)]
    Job(#[from] JobError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: std::io::Error },
}

/// Meshes a file and draws it.
///
/// # Errors
/// Where there is no device, where nothing could be meshed, or where the picture cannot be written.
pub fn render(job: &RenderJob) -> Result<Rendered, RenderError> {
    // The device first: without one all else would be in vain.
    let gpu = Gpu::open(job.device)?;
    let meshing = Job {
        input: job.input.clone(),
        output: None,
        options: job.mesh.clone(),
        cancel: job.cancel.clone(),
        on_progress: job.on_progress.clone(),
    };
    let outcome = run(&meshing)?;
    let (scene, model) = (&outcome.scene, &outcome.model);
    let renderer = Renderer::new(&gpu)?;
    // What measures or shows the mesh is drawn from it.
    let of_mesh = matches!(job.picture.style, Style::Wireframe | Style::Curvature | Style::Error);
    let (picture, legend, points) = if job.mode == RenderMode::Mesh || of_mesh {
        let (scenery, legend) = mesh_scenery(scene, model, job.picture.style);
        (renderer.render(&gpu, scene, &scenery, &job.picture)?, legend, None)
    } else {
        let exact = trimmed_model(scene, model);
        let faces = FaceRenderer::new(&gpu)?;
        let meshed = exact.parts.iter().map(|p| p.meshed.len()).sum();
        let mut on_device = FaceScene::new(&gpu, exact, (scene, model), job.picture.style)?;
        let (picture, counts) = renderer.render_faces(&gpu, &faces, &mut on_device, &job.picture)?;
        (picture, None, Some(Evaluated { points: counts.points, drawn: counts.faces, meshed }))
    };
    write(&job.output, &picture.to_png()?)?;
    Ok(Rendered { adapter: gpu.name().to_owned(), legend, evaluated: points, report: outcome.report })
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), RenderError> {
    whole_file::write_bytes(path, bytes)
        .map_err(|source| RenderError::Write { path: path.to_owned(), source })
}

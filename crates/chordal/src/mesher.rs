//! The whole run, top to bottom:
//!
//! ```text
//! sew → resolve → trim → sample edges → size → place points → triangulate + prove → stitch → audit
//!                 └──────────────── chordal_tessellate, once per part ──────────────────┘
//! ```
//!
//! Parts run in parallel on the current rayon pool; the result is the same for any number of threads. Where
//! the platform has no threads or no clock, everything runs on the calling thread and times are zero.

use crate::account::{Findings, Ledger, account};
use crate::area::area;
use crate::auditing::audit_parts;
use crate::bug::guarded;
use crate::error::{Error, FileError};
use crate::meshed::Meshed;
use crate::meshed_part::mesh_parts;
use crate::model::Model;
use crate::options::MeshOptions;
use crate::placement::part_uses;
use crate::progress::{Listener, Phase};
use crate::report::{InputReport, Problem};
use crate::resolve::resolve;
use crate::scene::scene;
use crate::sewing::sew_parts;
use chordal_brep::{FaceGeometry, Severity};
use chordal_tessellate::Cancel;
use std::ops::ControlFlow;

/// Makes meshes of models.
///
/// ```
/// use chordal::{Mesher, MeshOptions, Model, Tolerance};
///
/// let model = Model::open("../../corpus/bracket.step")?;
/// let options = MeshOptions::default().with_tolerance(Tolerance::Millimetres(0.05));
/// let meshed = Mesher::new(options).mesh(&model)?;
/// assert!(meshed.report().clean);
/// # Ok::<(), chordal::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Mesher {
    options: MeshOptions,
    listener: Listener,
}

impl Mesher {
    /// A mesher with these options.
    pub fn new(options: MeshOptions) -> Self {
        Self { options, listener: Listener::default() }
    }

    /// Calls `call` with the phase and the fraction of it that is done, from any thread;
    /// [`ControlFlow::Break`] cancels.
    pub fn with_progress(
        mut self,
        call: impl Fn(Phase, f64) -> ControlFlow<()> + Send + Sync + 'static,
    ) -> Self {
        self.listener.set_call(call);
        self
    }

    /// A flag that cancels from another thread. Work stops at the next face.
    pub fn with_cancel(mut self, cancel: Cancel) -> Self {
        self.listener.set_cancel(cancel);
        self
    }

    /// The options.
    pub fn options(&self) -> &MeshOptions {
        &self.options
    }

    /// Meshes a model and audits the mesh.
    ///
    /// # Errors
    /// [`Error::Request`] where the tolerance is below what the coordinates can represent, [`Error::File`]
    /// where no face could be meshed or a coordinate is out of range, [`Error::Cancelled`], [`Error::Bug`]. A
    /// face that fails is no error: the report lists it.
    pub fn mesh(&self, model: &Model) -> Result<Meshed, Error> {
        guarded(|| self.run_stages(model))
    }

    fn run_stages(&self, model: &Model) -> Result<Meshed, Error> {
        let mut ledger = Ledger::start();
        let run = self.listener.start();
        something_to_mesh(model)?;

        // 1. Sew: faces that share no edges get shared ones by the geometry of their borders.
        run.tell(Phase::Sewing, 0.0);
        let uses = part_uses(model.brep());
        let (exact, sewn) =
            ledger.time(|s| &mut s.sew, || sew_parts(model.shared(), &uses, self.options.sewing()));
        run.check()?;

        // 2. Resolve: what the options mean in the units of every part.
        run.tell(Phase::Measuring, 0.0);
        let resolved = ledger
            .time(|s| &mut s.resolve, || resolve(&exact, &self.options, model.byte_count(), run.cancel()))
            .map_err(|error| error.named(model.name()))?;
        run.check()?;

        // 3. Mesh every placed part once: trim, sample edges, size, place, triangulate, prove, stitch.
        let (mut parts, kept) =
            mesh_parts(&exact, &resolved, run.cancel(), &|done| run.tell(Phase::Meshing, done));
        run.check()?;

        // 4. Audit: check every guarantee again, from the model and the meshes.
        run.tell(Phase::Auditing, 0.0);
        let audits = ledger.time(
            |s| &mut s.audit,
            || {
                let self_intersections = self.options.self_intersections();
                audit_parts(&exact, &resolved, &mut parts, self_intersections, run.cancel())
            },
        );
        run.check()?;

        // 5. Account: what was done, what is proven, what went wrong.
        let found = Findings {
            model: &exact,
            sewn: &sewn,
            resolved: &resolved,
            parts: &parts,
            kept,
            audits: &audits,
        };
        let mut report = account(input_report(model, resolved.diagonal), &self.options, &found);
        // Faces that have no area need no triangles: that is no failure.
        let needs_none = report.clean && report.faces.zero_area > 0;
        if report.triangles == 0 && !needs_none {
            let problems: Vec<Problem> = report.errors().cloned().collect();
            let reason = FileError::NothingMeshed { faces: report.faces.total, problems };
            return Err(Error::file(model.name(), reason));
        }
        let scene = scene(&exact, parts.iter().map(|p| p.mesh.clone()).collect());
        report.area = area(&scene);
        report.threads = rayon::current_num_threads();
        ledger.close(&mut report, model.read_seconds());
        let reports = parts.into_iter().map(|part| part.report).collect();
        Ok(Meshed::new(exact, scene, reports, resolved, report))
    }
}

fn input_report(model: &Model, diagonal: Option<f64>) -> InputReport {
    InputReport {
        path: model.name().to_owned(),
        bytes: model.byte_count(),
        format: model.format().to_owned(),
        unit: model.unit().to_owned(),
        diagonal,
    }
}

/// A model without a readable face has no size either: what is wrong with its faces is the reason to give.
fn something_to_mesh(model: &Model) -> Result<(), Error> {
    let parts = &model.brep().parts;
    let readable = |face: &chordal_brep::Face| matches!(face.geometry, FaceGeometry::Surface(_));
    if parts.iter().any(|part| !part.tessellated.is_empty() || part.faces.iter().any(readable)) {
        return Ok(());
    }
    let problems = model.problems().into_iter().filter(|p| p.severity == Severity::Error).collect();
    let reason =
        FileError::NothingMeshed { faces: parts.iter().map(|part| part.faces.len()).sum(), problems };
    Err(Error::file(model.name(), reason))
}

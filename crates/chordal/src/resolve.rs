//! Converts the request for the whole model to a request for every part, in the units of the part.

use crate::error::{Error, FileError, RequestError};
use crate::options::MeshOptions;
use crate::placement::{PartUse, part_uses};
use crate::quantity::Tolerance;
use crate::tight_box::{edge_box, tight_box_within};
use crate::work_limits::FileLimits;
use chordal_brep::{Model, Source};
use chordal_tessellate::{Cancel, Options};
use chordal_write::Format;

/// Measuring the box of the model may take this part of the time of the file and of a face.
const BOX_SHARE: f64 = 0.25;

/// A tolerance below this many units in the last place of the largest coordinate is refused: evaluating a
/// surface costs some tens of roundings, so nothing finer can be proven.
const FLOOR_ULPS: f64 = 64.0;
/// Roundings of a 64-bit coordinate on its way through placements of a tree of ordinary depth.
const PLACEMENT_ULPS: f64 = 8.0;

/// Coordinates in millimetres beyond this are a mistake of the file (it is 100 light years), and squares of
/// lengths would overflow far above it.
const LARGEST: f64 = 1e21;

/// Everything that the options mean for this model.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// In millimetres, of the mesh as written.
    pub tolerance: f64,
    /// The tolerance of edges, in millimetres; equal to `tolerance` unless another one was requested.
    pub boundary_tolerance: f64,
    /// The diagonal of the tight box in millimetres, if the tolerance was requested in percent.
    pub diagonal: Option<f64>,
    /// The largest error by placing the mesh and rounding its coordinates, in millimetres, which is
    /// subtracted from the tolerance of the parts.
    pub rounding: f64,
    /// How every part is placed.
    pub uses: Vec<PartUse>,
    /// The request for every part, in its own units.
    pub parts: Vec<Options>,
    /// What the faces of the file may take together.
    pub(crate) limits: FileLimits,
}

/// Why the options mean nothing for a model.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ResolveError {
    TooFine { tolerance: f64, minimum: f64 },
    OutOfRange { entity: Source, coordinate: f64 },
}

impl ResolveError {
    /// The error about the model of this name.
    pub fn named(self, name: &str) -> Error {
        match self {
            ResolveError::TooFine { tolerance, minimum } => {
                RequestError::ToleranceTooFine { tolerance, minimum }.into()
            }
            ResolveError::OutOfRange { entity, coordinate } => {
                Error::file(name, FileError::CoordinateOutOfRange { entity, coordinate })
            }
        }
    }
}

/// Resolves `options` for `model`. `bytes` is the size of its file, zero for models that are not from a file.
///
/// # Errors
/// Where the tolerance is below what the coordinates can represent, or a coordinate is out of range.
pub(crate) fn resolve(
    model: &Model,
    options: &MeshOptions,
    bytes: u64,
    cancel: &Cancel,
) -> Result<Resolved, ResolveError> {
    let uses = part_uses(model);
    let edges = edge_box(model, &uses);
    let requested = [Some(options.tolerance()), options.boundary_tolerance()];
    let relative = requested.iter().flatten().any(|t| matches!(t, Tolerance::Percent(_)));
    // A face that takes longer counts by its control points: the box is no reason to spend the face's time
    // twice.
    let limits = FileLimits::new(options.limits(), model, &uses, bytes, 1.0).part_of(BOX_SHARE);
    let size = if relative { tight_box_within(model, &uses, edges, &limits, cancel) } else { edges };
    let diagonal = relative.then(|| size.diagonal());
    let millimetres = |tolerance: Tolerance| match tolerance {
        Tolerance::Millimetres(mm) => mm,
        Tolerance::Percent(percent) => percent / 100.0 * size.diagonal(),
    };
    let tolerance = millimetres(options.tolerance());
    let boundary_tolerance = options.boundary_tolerance().map_or(tolerance, millimetres);
    let largest = size.largest_coordinate();
    if largest.is_nan() || largest >= LARGEST {
        return Err(out_of_range(model));
    }
    let minimum = FLOOR_ULPS * f64::EPSILON * largest;
    for tolerance in [tolerance, boundary_tolerance] {
        if !(tolerance > minimum && tolerance.is_finite()) {
            return Err(ResolveError::TooFine { tolerance, minimum });
        }
    }
    let rounding = rounding(largest, options.output_format());
    // If rounding takes more than half, the report states that the tolerance is not met.
    let of_parts = |tolerance: f64| tolerance - rounding.min(0.5 * tolerance);
    let boundary = options.boundary_tolerance().map(|_| of_parts(boundary_tolerance));
    let parts = uses
        .iter()
        .map(|part_use| {
            let boundary = boundary.map(|length| length / part_use.scale);
            options.of_part(of_parts(tolerance) / part_use.scale, boundary, part_use.scale)
        })
        .collect();
    let fineness = tolerance / size.diagonal();
    let limits = FileLimits::new(options.limits(), model, &uses, bytes, fineness);
    Ok(Resolved { tolerance, boundary_tolerance, diagonal, rounding, uses, parts, limits })
}

/// Names the vertex that lies farthest out.
fn out_of_range(model: &Model) -> ResolveError {
    let reach = |v: &chordal_brep::Vertex| v.point.abs().max_element();
    let vertices = model.parts.iter().flat_map(|p| &p.vertices);
    let farthest = vertices.max_by(|a, b| reach(a).total_cmp(&reach(b)));
    let entity = farthest.map_or_else(Source::default, |v| v.source);
    ResolveError::OutOfRange { entity, coordinate: farthest.map_or(f64::INFINITY, reach) }
}

/// The distance in millimetres by which placing and writing may move a vertex of a model whose coordinates
/// reach `largest`.
fn rounding(largest: f64, format: Option<Format>) -> f64 {
    // The length of a vector is at most √3 times its largest coordinate.
    let reach = largest * 3.0_f64.sqrt();
    let placing = PLACEMENT_ULPS * f64::EPSILON * reach;
    match format {
        // Half a unit in the last place of a 32-bit number; twice for a placement that is rounded as well.
        Some(format) if format.is_single_precision() => placing + reach * f64::from(f32::EPSILON),
        _ => placing,
    }
}

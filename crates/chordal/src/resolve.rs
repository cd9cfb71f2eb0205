//! From what was asked of the whole model to what is asked of every part, in its own units.

use crate::placement::{PartUse, part_uses};
use crate::tight_box::{edge_box, tight_box};
use crate::{JobError, JobOptions, Tolerance};
use chordal_brep::Model;
use chordal_tessellate::{Cancel, Options};
use chordal_write::Format;
use std::path::Path;

/// A tolerance below this many units in the last place of the largest coordinate is refused: evaluating a surface
/// costs some tens of roundings, so nothing finer can be proven.
const FLOOR_ULPS: f64 = 64.0;
/// Roundings of a 64-bit coordinate on its way through placements of a tree of ordinary depth.
const PLACEMENT_ULPS: f64 = 8.0;

/// Coordinates in millimetres beyond this are a mistake of the file (it is 100 light years), and squares of lengths
/// would overflow far above it.
const LARGEST: f64 = 1e21;

/// Everything that the options mean for this model.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// In millimetres, of the mesh as written.
    pub tolerance: f64,
    /// Of the edges, in millimetres; as `tolerance` where nobody asked for another.
    pub boundary_tolerance: f64,
    /// Of the tight box in millimetres, where the tolerance was asked for in percent.
    pub diagonal: Option<f64>,
    /// What placing the mesh and rounding it to the format's numbers may cost, in millimetres: kept back from the
    /// tolerance of the parts.
    pub rounding: f64,
    /// How every part is placed.
    pub uses: Vec<PartUse>,
    /// What is asked of every part, in its own units.
    pub parts: Vec<Options>,
}

/// Resolves `options` for `model`, to be written as `format`.
///
/// # Errors
/// Where the tolerance is below what the coordinates can hold, or the coordinates are absurd.
pub fn resolve(
    model: &Model,
    options: &JobOptions,
    format: Option<Format>,
    input: &Path,
    cancel: &Cancel,
) -> Result<Resolved, JobError> {
    let uses = part_uses(model);
    let edges = edge_box(model, &uses);
    let asked = [Some(options.tolerance), options.boundary_tolerance];
    let relative = asked.iter().flatten().any(|t| matches!(t, Tolerance::Percent(_)));
    let size = if relative { tight_box(model, &uses, edges, options.face_timeout, cancel) } else { edges };
    let diagonal = relative.then(|| size.diagonal());
    let millimetres = |tolerance: Tolerance| match tolerance {
        Tolerance::Millimetres(mm) => mm,
        Tolerance::Percent(percent) => percent / 100.0 * size.diagonal(),
    };
    let tolerance = millimetres(options.tolerance);
    let boundary_tolerance = options.boundary_tolerance.map_or(tolerance, millimetres);
    let largest = size.largest_coordinate();
    if largest.is_nan() || largest >= LARGEST {
        return Err(too_large(model, input));
    }
    let floor = FLOOR_ULPS * f64::EPSILON * largest;
    for tolerance in [tolerance, boundary_tolerance] {
        if !(tolerance > floor && tolerance.is_finite()) {
            return Err(JobError::BelowFloor { path: input.to_owned(), tolerance, floor });
        }
    }
    let rounding = rounding(largest, format);
    // Where rounding eats more than half, the report says that the tolerance was not kept.
    let of_parts = |tolerance: f64| tolerance - rounding.min(0.5 * tolerance);
    let boundary = options.boundary_tolerance.map(|_| of_parts(boundary_tolerance));
    let parts = uses
        .iter()
        .map(|part_use| {
            Options::new(of_parts(tolerance) / part_use.scale)
                .with_boundary_tolerance(boundary.map(|length| length / part_use.scale))
                .with_angle(options.angle)
                .with_max_edge(options.max_edge.map(|length| length / part_use.scale))
                .with_bound(options.bound)
                .with_fill_method(options.fill_method.clone())
                .with_quads(options.quads)
                .with_edge_splitter(options.edge_splitter.clone())
                .with_bulk(options.bulk.clone())
                .with_cells_recorded(options.debug_svg.is_some())
                .with_face_timeout(options.face_timeout)
        })
        .collect();
    Ok(Resolved { tolerance, boundary_tolerance, diagonal, rounding, uses, parts })
}

/// Names the vertex that lies farthest out.
fn too_large(model: &Model, input: &Path) -> JobError {
    let reach = |v: &chordal_brep::Vertex| v.point.abs().max_element();
    let vertices = model.parts.iter().flat_map(|p| &p.vertices);
    let farthest = vertices.max_by(|a, b| reach(a).total_cmp(&reach(b)));
    let at = farthest.map_or_else(|| "the model".into(), |v| v.source.to_string());
    JobError::TooLarge { path: input.to_owned(), at, reach: farthest.map_or(f64::INFINITY, reach) }
}

/// The distance in millimetres by which placing and writing may move a vertex of a model whose coordinates reach
/// `largest`.
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

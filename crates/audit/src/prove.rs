//! The bounds of one face, recomputed: its triangles, its chords, and what lies between the two sides of
//! cuts.

use crate::boundary::Boundary;
use crate::chart::Chart;
use crate::context::Context;
use crate::cuts::{self, Cut};
use crate::fan::{Fan, Side, fan_bound};
use crate::findings::{FaceFindings, Log};
use crate::precision::{AIM, CHUNK};
use crate::simple_bound::{SimpleBound, SimpleScratch};
use chordal_brep::AuditIssue;
use chordal_nurbs::{Facet, Piece, Surface, SurfaceBounds, facet_bound};
use rayon::prelude::*;

/// Two formulas for the same bound differ by less than this share of it.
const SAME: f64 = 1e-9;

/// Enclosures are made over smaller cells this often, for a quarter of the error each time: down to the
/// smallest tolerance at which facets are parted, 1/4096.
const FINER_CELLS: usize = 6;

/// The sides of each triangle, for the bounds; empty on planes.
pub(crate) fn sides(chart: &Chart<'_>, at: &Boundary) -> Vec<[Side; 3]> {
    if matches!(chart.surface, Surface::Plane { .. }) {
        return Vec::new();
    }
    let mut sides = vec![[Side::Inner; 3]; chart.mesh.triangles.len()];
    for chord in &at.chords {
        sides[chord.half.triangle as usize][chord.half.side as usize] = Side::Chord(chord.sag);
    }
    sides
}

pub(crate) fn prove(
    context: &Context<'_>,
    chart: &Chart<'_>,
    at: &Boundary,
    sides: &[[Side; 3]],
    found: &mut FaceFindings,
    log: &mut Log<'_>,
) {
    found.error = f64::NAN;
    found.claimable = f64::NAN;
    let bounds = SurfaceBounds::new(chart.surface, chart.uv_box, AIM * context.options.tolerance);
    if !context.options.proven || !bounds.is_bounded() {
        return;
    }
    let chords = at.chords.iter().fold(0.0f64, |m, chord| m.max(chord.sag));
    let facets = facets_error(context, chart, &bounds, sides, log.index);
    let facets = with_finer_cells(context, chart, sides, facets, log.index);
    let slivers = slivers_error(chart, &bounds, at, facets.error);
    // At poles the mesher goes by other parameters than it writes: claims cannot be compared there.
    found.claimable = facets.plain.max(chords);
    found.error = facets.error.max(chords).max(slivers);
    let total = found.error + context.options.coordinate_rounding;
    let tolerance = context.options.tolerance;
    if total > tolerance * (1.0 + 1e-9) + chart.rounding {
        log.add(AuditIssue::OverTolerance {
            error: context.mm(total),
            tolerance: context.mm(tolerance),
            triangles: context.mm(facets.plain),
            at_poles: context.mm(facets.error),
            chords: context.mm(chords),
            slivers: context.mm(slivers),
        });
    }
}

/// The largest bound of what lies between the sides of cuts; the sides themselves are within `facets` of the
/// mesh.
fn slivers_error(chart: &Chart<'_>, bounds: &SurfaceBounds<'_>, at: &Boundary, facets: f64) -> f64 {
    let mut scratch = Vec::new();
    let error = |cut| match cuts::judge(chart, bounds, cut, &mut scratch) {
        Cut::Seam => 0.0,
        Cut::Sliver { alone, width } => alone.min(facets + width),
    };
    at.cuts.iter().map(error).fold(0.0, f64::max)
}

/// The largest bounds of a face's triangles.
#[derive(Clone, Copy, Debug, Default)]
struct FacetsError {
    /// The bound of all triangles; triangles at poles stand for their sectors.
    error: f64,
    /// The bound of the triangles without a corner on a pole.
    plain: f64,
}

/// The bounds with enclosures over smaller cells, where the claim is below them: where facets were refined
/// until they part, the mesher's enclosures were made for smaller errors than the tolerance.
fn with_finer_cells(
    context: &Context<'_>,
    chart: &Chart<'_>,
    sides: &[[Side; 3]],
    mut facets: FacetsError,
    face: usize,
) -> FacetsError {
    let (_, claimed) = context.enough(face);
    let mut resolution = AIM * context.options.tolerance;
    for _ in 0..FINER_CELLS {
        if facets.plain <= claimed || !matches!(chart.surface, Surface::Nurbs(_)) {
            break;
        }
        resolution *= 0.25;
        let bounds = SurfaceBounds::new(chart.surface, chart.uv_box, resolution);
        let finer = facets_error(context, chart, &bounds, sides, face);
        facets.plain = facets.plain.min(finer.plain);
        facets.error = facets.error.min(finer.error);
    }
    facets
}

fn facets_error(
    context: &Context<'_>,
    chart: &Chart<'_>,
    bounds: &SurfaceBounds<'_>,
    sides: &[[Side; 3]],
    face: usize,
) -> FacetsError {
    if matches!(chart.surface, Surface::Plane { .. }) {
        return FacetsError::default();
    }
    let (enough, claimed) = context.enough(face);
    let simple = SimpleBound::quick(chart.surface);
    let confirmed = context.to_confirm(face);
    let judge = |(triangles, sides): (&[[u32; 3]], &[[Side; 3]])| {
        let (mut scratch, mut of_simple) = (Vec::new(), SimpleScratch::default());
        let mut worst = FacetsError::default();
        for (t, &s) in triangles.iter().zip(sides) {
            let (t, s) = if chart.turned { ([t[0], t[2], t[1]], [s[0], s[2], s[1]]) } else { (*t, s) };
            let uv = t.map(|c| chart.mesh.corners[c as usize].uv);
            let xyz = t.map(|c| chart.xyz[c as usize]);
            let facet = Facet { uv, xyz, sag: s.map(Side::sag) };
            if let Some(i) = chart.fan_corner(&t) {
                let error = sector(chart, bounds, &t, &facet, s, i, enough, &mut scratch);
                worst.error = worst.error.max(error);
                continue;
            }
            let confirms = |&error: &f64| error <= confirmed * (1.0 + SAME);
            let error = simple.as_ref().and_then(|s| s.of(chart, &facet, confirmed, &mut of_simple));
            if let Some(error) = error.filter(confirms) {
                worst.plain = worst.plain.max(error.min(confirmed));
                continue;
            }
            let mut plain = facet_bound(bounds, &facet, enough, &mut scratch).error;
            if plain > claimed {
                // How far a bound is pursued depends on what would be enough.
                plain = plain.min(facet_bound(bounds, &facet, claimed, &mut scratch).error);
            }
            worst.plain = worst.plain.max(plain);
        }
        worst.error = worst.error.max(worst.plain);
        worst
    };
    let chunks = chart.mesh.triangles.par_chunks(CHUNK).zip(sides.par_chunks(CHUNK));
    chunks.map(judge).reduce(FacetsError::default, |a, b| FacetsError {
        error: a.error.max(b.error),
        plain: a.plain.max(b.plain),
    })
}

fn sector(
    chart: &Chart<'_>,
    bounds: &SurfaceBounds<'_>,
    t: &[u32; 3],
    facet: &Facet,
    sides: [Side; 3],
    pole: usize,
    enough: f64,
    scratch: &mut Vec<Piece>,
) -> f64 {
    let order = [(pole + 1) % 3, (pole + 2) % 3, pole];
    let fan = Fan {
        uv: order.map(|i| facet.uv[i]),
        xyz: order.map(|i| facet.xyz[i]),
        sides: order.map(|i| sides[i]),
        axis: chart.pole_axis(t[pole]).expect("the corner is on a pole"),
    };
    fan_bound(bounds, &fan, enough, scratch)
}

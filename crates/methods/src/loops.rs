//! The trimming loops of faces as the paper makes them: each face has its own, and whole loops are
//! simplified.
//!
//! Source: Balázs, Guthe, Klein 2004, Table 2. A mesh shares its edges between faces and keeps the model's
//! vertices; these loops do neither. They measure the cost and the result of the conversions and
//! approximations alone.

use crate::edge::curve::TrimmingCurve;
use crate::edge::simplify::simplified;
use crate::edge::untangle::untangled;
use crate::edge::{CURVE_SHARE, in_plane, in_space};
use crate::edge_method::EdgeMethod;
use chordal_brep::{Coedge, Face, FaceGeometry, Loop, Part};
use chordal_nurbs::{DVec2, DVec3, UvBox};
use chordal_tessellate::Stopwatch;
use chordal_tessellate::method::{EdgePiece, EdgeUse, FaceSurface, resolution};

/// The trimming loops of a part by one method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopRow {
    pub method: EdgeMethod,
    /// Chords of all loops of all faces.
    pub edges: usize,
    /// Seconds from the model to Bézier curves.
    pub conversion: f64,
    /// Seconds from Bézier curves to polylines, simplification and repair included.
    pub approximation: f64,
    /// Vertices that were added where loops cross in the plane of parameters.
    pub crossings: usize,
    /// Coedges without a curve in the plane of parameters; they are not counted.
    pub left_out: usize,
}

/// Converts and approximates every trimming loop of the part by every method, within `tolerance` in the
/// part's units.
pub fn loop_rows(part: &Part, tolerance: f64, methods: &[EdgeMethod]) -> Vec<LoopRow> {
    let resolution = resolution(part, tolerance);
    let row = |&method: &EdgeMethod| {
        let mut row =
            LoopRow { method, edges: 0, conversion: 0.0, approximation: 0.0, crossings: 0, left_out: 0 };
        for face in &part.faces {
            if let FaceGeometry::Surface(surface) = &face.geometry {
                let surface = FaceSurface::new(surface, resolution);
                FaceLoops { part, surface: &surface, tolerance }.book(face, &mut row);
            }
        }
        row
    };
    methods.iter().map(row).collect()
}

/// Loops whose ends are further apart than this share of their box are not closed in this chart.
const CLOSED: f64 = 1e-6;

struct FaceLoops<'a> {
    part: &'a Part,
    surface: &'a FaceSurface<'a>,
    tolerance: f64,
}

/// A polyline in space and, where the surface's parameters are those of its NURBS form, in the plane.
#[derive(Default)]
struct LoopLine {
    xyz: Vec<DVec3>,
    uv: Vec<DVec2>,
    is_flat: bool,
}

impl FaceLoops<'_> {
    fn book(&self, face: &Face, row: &mut LoopRow) {
        let mut flat = Vec::new();
        for a_loop in &face.loops {
            let Loop::Edges { coedges, .. } = a_loop else { continue };
            let mut line = LoopLine { is_flat: true, ..LoopLine::default() };
            for coedge in coedges {
                if self.part.edges[coedge.edge.index()].curve.is_none() {
                    continue;
                }
                if self.append(coedge, row, &mut line).is_none() {
                    row.left_out += 1;
                    line.is_flat = false;
                }
            }
            let clock = Stopwatch::of_thread();
            if let EdgeMethod::Bezier3d { simplified: true, .. } = row.method {
                let kept = simplified(&line.xyz, (1.0 - CURVE_SHARE) * self.tolerance);
                line.uv = if line.is_flat { kept.iter().map(|&i| line.uv[i]).collect() } else { Vec::new() };
                line.xyz = kept.iter().map(|&i| line.xyz[i]).collect();
            }
            row.approximation += clock.seconds();
            row.edges += line.xyz.len().saturating_sub(1);
            if line.is_flat && is_closed(&line.uv) {
                line.uv.pop();
                flat.push(line.uv);
            }
        }
        let clock = Stopwatch::of_thread();
        row.crossings += untangled(&flat).inserted;
        row.approximation += clock.seconds();
    }

    /// Adds one coedge to its loop; `None` where it has no curve in the plane or that cannot be approximated.
    fn append(&self, coedge: &Coedge, row: &mut LoopRow, line: &mut LoopLine) -> Option<()> {
        let edge = &self.part.edges[coedge.edge.index()];
        let curve = edge.curve.as_deref()?;
        let piece = EdgePiece { curve, whole: edge.range, range: edge.range, tolerance: self.tolerance };
        let one = EdgeUse { surface: self.surface, pcurve: coedge.pcurves.first(), reach: 0.0 };
        let clock = Stopwatch::of_thread();
        let trimming = TrimmingCurve::new(&piece, &one)?;
        let (mut points, mut guesses);
        match row.method {
            EdgeMethod::Bezier3d { criterion, cut, simplified } => {
                let lifted = in_space::lifted(&trimming)?;
                row.conversion += clock.seconds();
                let clock = Stopwatch::of_thread();
                let share = if simplified { CURVE_SHARE } else { 1.0 };
                let made = in_space::polyline(&lifted, share * self.tolerance, (criterion, cut, false))?;
                (points, guesses) = (made.points, made.guesses);
                row.approximation += clock.seconds();
            }
            EdgeMethod::Bezier2d => {
                row.conversion += clock.seconds();
                let clock = Stopwatch::of_thread();
                let made = in_plane::stops(&trimming, self.tolerance)?;
                (points, guesses) = (made.points, made.guesses);
                row.approximation += clock.seconds();
            }
        }
        if !coedge.forward {
            points.reverse();
            guesses.reverse();
        }
        let skip = usize::from(!line.xyz.is_empty());
        line.is_flat &= trimming.is_native;
        line.uv.extend(guesses[skip..].iter().map(|&t| trimming.uv_at(t)));
        line.xyz.extend_from_slice(&points[skip..]);
        Some(())
    }
}

fn is_closed(uv: &[DVec2]) -> bool {
    let (Some(&first), Some(&last)) = (uv.first(), uv.last()) else { return false };
    uv.len() > 3 && first.distance(last) <= CLOSED * UvBox::from_points(uv.iter().copied()).size().length()
}

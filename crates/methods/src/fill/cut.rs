//! Cells cut with the loops of the face.
//!
//! Sources: Balázs, Guthe, Klein 2004, section 6; Kahlesz, Balázs, Klein 2001, section 7. There a vertex is
//! added wherever the border of a cell crosses a trimming curve, and the neighbouring face does not have it.
//! Here edges belong to all their faces, so the crossing moves to the nearer end of the chord that is
//! crossed:
//!
//! ```text
//!        o───────o                 o───────o         o  corners of cells inside the face
//!        │       │                 │       │         +  ends of chords
//!   ─────┼─+─────┼────+       ─────│─+_____│____+    a corner so near to a chord that the part beyond would
//!        │       │                 └─┘               be a sliver is replaced by the chord's nearer end, too
//! ```
//!
//! The borders are then forced into the triangulation of the loops ([`super::constrain`]): the inside of the
//! loops is covered exactly once, for all positions of cells and loops. The triangles between borders are
//! constrained Delaunay.

use super::borders::Borders;
use super::constrain::Constrained;
use super::plain::mean_metric;
use super::region::Region;
use chordal_nurbs::{DVec2, UvBox};
use chordal_tessellate::method::{FaceMesh, Location, Metric};

/// A corner nearer to a chord than this share of its cell's extent is replaced by the end of the chord. A
/// smaller share leaves slivers, a larger one distorts the cells.
const SLIVER: f64 = 0.02;

/// What a corner of cells is in the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Anchor {
    Vertex(u32),
    /// Outside of the face.
    None,
}

/// The result of cutting.
pub struct CutFace {
    /// Directed pairs of vertices, smaller first, that triangles of different polygons share.
    pub fixed: rustc_hash::FxHashSet<(u32, u32)>,
    /// Corners of cells that became vertices.
    pub corners: usize,
    /// Crossings of borders with chords.
    pub crossings: usize,
    /// Pieces of borders that could not be kept.
    pub dropped: usize,
}

/// Brings the corners and borders of the cells into `face.mesh()`, which holds the triangulated loops.
pub fn cut(face: &mut FaceMesh<'_, '_>, region: &Region, cells: &[UvBox]) -> CutFace {
    let metric = mean_metric(face.surface(), region.uv_box);
    face.set_metric(metric);
    let borders = Borders::new(cells);
    let inside: Vec<bool> = borders.corners.iter().map(|&p| region.contains(p)).collect();
    let anchors = insert_corners(face, region, &borders, &inside, metric);
    let first = face.chart().points.len() as u32;
    let corners = face.mesh().points.len() - first as usize;
    let mut crossings = 0;
    let mut wanted = Vec::with_capacity(borders.pieces.len());
    for &(a, b) in &borders.pieces {
        let chain = chain(region, &borders, &anchors, (a, b));
        crossings += chain.len() - 2;
        for pair in chain.windows(2) {
            let ((x, from), (y, to)) = (pair[0], pair[1]);
            let (Anchor::Vertex(p), Anchor::Vertex(q)) = (from, to) else { continue };
            // A corner on a chord lies on neither side; the middle of a piece does.
            if p != q && (chain.len() == 2 && p.min(q) >= first || region.contains(x.midpoint(y))) {
                wanted.push((p.min(q), p.max(q)));
            }
        }
    }
    wanted.sort_unstable();
    wanted.dedup();
    let mut constrained = Constrained::new(face.mesh_mut());
    let dropped = wanted.iter().filter(|&&(p, q)| !constrained.force(p, q)).count();
    let fixed = constrained.fixed;
    face.flip_all(&|_, a, b, _| !fixed.contains(&(a.min(b), a.max(b))));
    face.mesh_mut().changed.clear();
    CutFace { fixed, corners, crossings, dropped }
}

fn insert_corners(
    face: &mut FaceMesh<'_, '_>,
    region: &Region,
    borders: &Borders,
    inside: &[bool],
    metric: Metric,
) -> Vec<Anchor> {
    let within = borders.corners.iter().zip(inside).filter(|&(_, &inside)| inside);
    face.foresee(within.map(|(&p, _)| p));
    let mut hint = 0;
    let mut anchors = Vec::with_capacity(inside.len());
    for (i, &p) in borders.corners.iter().enumerate() {
        let anchor = match region.nearest(p, borders.extent[i], SLIVER) {
            Some(chord) => Anchor::Vertex(nearer_end(region, chord, p, borders.extent[i])),
            None if inside[i] => insert(face, p, metric, &mut hint),
            None => Anchor::None,
        };
        anchors.push(anchor);
    }
    face.mesh_mut().changed.clear();
    anchors
}

fn insert(face: &mut FaceMesh<'_, '_>, p: DVec2, metric: Metric, hint: &mut u32) -> Anchor {
    let at = face.mesh().locate(p, *hint);
    let (Location::Inside(t) | Location::OnEdge(t, _)) = at else { return Anchor::None };
    *hint = t;
    face.insert_in_metric(p, at, metric).map_or(Anchor::None, Anchor::Vertex)
}

/// The end of a chord that is nearer to `p`, as an index of the chart.
fn nearer_end(region: &Region, chord: u32, p: DVec2, scale: DVec2) -> u32 {
    let [a, b] = region.ends(chord).map(|q| ((q - p) / scale).length_squared());
    region.vertices(chord)[usize::from(b < a)]
}

/// The corners of a piece of a border, with the places between them where it crosses chords.
fn chain(region: &Region, borders: &Borders, anchors: &[Anchor], (a, b): (u32, u32)) -> Vec<(DVec2, Anchor)> {
    let (p, q) = (borders.corners[a as usize], borders.corners[b as usize]);
    let axis = usize::from(p.x == q.x);
    let scale = borders.extent[a as usize].min(borders.extent[b as usize]);
    let mut chain = vec![(p, anchors[a as usize])];
    for (at, chord) in region.crossings(p, axis, q[axis]) {
        let mut x = p;
        x[axis] = at;
        chain.push((x, Anchor::Vertex(nearer_end(region, chord, x, scale))));
    }
    chain.push((q, anchors[b as usize]));
    chain
}

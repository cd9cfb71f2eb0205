//! The default way to fill a face: better shaped triangles from the boundary, and staggered rows of points
//! where the surface is curved both ways.

use crate::face_mesh::{FaceMesh, Shape};
use crate::metric::Metric;
use crate::rows::Rows;
use crate::triangulate::{Location, NONE};
use chordal_nurbs::DVec2;

/// No point is placed nearer than this to a corner of its triangle, in allowed chords. Rows lie 3/4 apart or
/// more; a point nearer than this makes triangles much smaller than allowed.
const CORNER_DISTANCE: f64 = 0.45;

/// The same for the distance from an edge of the boundary, which is a height of a triangle.
const BOUNDARY_DISTANCE: f64 = 0.3;

/// A flip may widen the turn of its triangles by this share: rounding.
const SAME_WIDTH: f64 = 1e-9;

/// Fills a face whose loops are triangulated.
pub(crate) fn fill_by_rows(face: &mut FaceMesh<'_, '_>) {
    improve_boundary(face);
    if face.shape() == Shape::Doubly {
        place_rows(face);
    }
    face.count("boundary sweep", face.chart().loops.len());
    face.count("points in rows", face.mesh().points.len() - face.chart().points.len());
}

/// Better shaped triangles from the boundary alone.
fn improve_boundary(face: &mut FaceMesh<'_, '_>) {
    match face.shape() {
        Shape::Flat | Shape::Doubly => face.flip_all(&|_, _, _, _| true),
        Shape::Singly { axis } => {
            // A flip must not widen the turn of its triangles.
            let points = face.mesh().points.clone();
            let width = |t: [u32; 3]| {
                let x = t.map(|v| points[v as usize][axis]);
                x[0].max(x[1]).max(x[2]) - x[0].min(x[1]).min(x[2])
            };
            face.flip_all(&|apex, a, b, apex2| {
                let before = width([apex, a, b]).max(width([apex2, b, a]));
                let after = width([apex, a, apex2]).max(width([apex, apex2, b]));
                after <= before * (1.0 + SAME_WIDTH)
            });
        }
    }
    face.mesh_mut().changed.clear();
}

fn place_rows(face: &mut FaceMesh<'_, '_>) {
    let rows = Rows::new(face.surface(), face.chart(), face.limits());
    let points: Vec<DVec2> = rows.insertion_order().iter().map(|&p| face.chart().grid.snap(p)).collect();
    face.foresee(points.iter().copied());
    let mut hint = 0;
    for p in points {
        let at = face.mesh().locate(p, hint);
        let (Location::Inside(t) | Location::OnEdge(t, _)) = at else { continue };
        hint = t;
        if !is_too_near(face, t, p) {
            face.insert(p, at);
        }
    }
    face.mesh_mut().changed.clear();
}

/// True for a point nearer to the corners of its triangle, or to a boundary edge of it, than rows lie apart.
fn is_too_near(face: &FaceMesh<'_, '_>, t: u32, p: DVec2) -> bool {
    let corners = face.mesh().triangles[t as usize];
    let m = Metric::mean(corners.map(|v| face.metric(v)));
    let c = face.mesh().corners(t);
    if c.iter().any(|&c| m.length(p - c) < CORNER_DISTANCE) {
        return true;
    }
    (0..3).filter(|&i| face.mesh().neighbors[t as usize][i] == NONE).any(|i| {
        let (a, b) = (c[(i + 1) % 3], c[(i + 2) % 3]);
        let length = m.length(b - a);
        // Height over the edge in the metric: area in the metric over the length.
        let height = m.determinant().max(0.0).sqrt() * (b - a).perp_dot(p - a).abs() / length.max(1e-300);
        height < BOUNDARY_DISTANCE
    })
}

//! Faces in their planes of parameters, as SVG: what a subdivision and its triangles look like.
//!
//! Cells are grey, triangles thin, the boundary is bold. Each direction is stretched to the face's own
//! extent.

use chordal::Meshed;
use chordal::math::DVec2;
use chordal::mesh::FaceMesh;
use chordal::nurbs::UvBox;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

/// The longer side of a drawing.
const SIZE: f64 = 900.0;

/// Writes one drawing per meshed face into a folder, which is made where it does not exist.
///
/// # Errors
/// Where the folder or a file cannot be written.
pub fn write_drawings(folder: &Path, meshed: &Meshed) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    for face in meshed.faces() {
        if let Some(mesh) = face.mesh().filter(|mesh| !mesh.triangles.is_empty()) {
            let name = format!("part{}_face{}.svg", face.part().index(), mesh.face);
            std::fs::write(folder.join(name), draw(mesh, face.cells()))?;
        }
    }
    Ok(())
}

/// One face. Writing to a string cannot fail, so results of `write!` are dropped.
fn draw(face: &FaceMesh, cells: &[UvBox]) -> String {
    let corners = face.corners.iter().map(|c| c.uv);
    let whole = UvBox::from_points(corners.chain(cells.iter().flat_map(|c| [c.min, c.max])));
    let size = whole.size().max(DVec2::splat(f64::MIN_POSITIVE));
    let place = |p: DVec2| {
        let t = (p - whole.min) / size;
        DVec2::new(20.0 + SIZE * t.x, 20.0 + SIZE * (1.0 - t.y))
    };
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {0}\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <g fill=\"#eee\" stroke=\"#999\" stroke-width=\"2\">\n",
        SIZE + 40.0
    );
    for cell in cells {
        let (a, b) = (place(cell.min), place(cell.max));
        let _ = writeln!(
            out,
            "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\"/>",
            a.x,
            b.y,
            b.x - a.x,
            a.y - b.y
        );
    }
    out.push_str("</g>\n");
    let (inner, boundary) = edges(face);
    for (edges, stroke, width) in [(inner, "#2b6cb0", 0.7), (boundary, "#c00", 2.0)] {
        let _ = write!(out, "<path fill=\"none\" stroke=\"{stroke}\" stroke-width=\"{width}\" d=\"");
        for (a, b) in edges {
            let (p, q) = (place(face.corners[a as usize].uv), place(face.corners[b as usize].uv));
            let _ = write!(out, "M{:.2} {:.2}L{:.2} {:.2}", p.x, p.y, q.x, q.y);
        }
        out.push_str("\"/>\n");
    }
    out.push_str("</svg>\n");
    out
}

/// Pairs of corners.
type Edges = Vec<(u32, u32)>;

/// Edges with two triangles, and with one.
fn edges(face: &FaceMesh) -> (Edges, Edges) {
    let sides = face.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let directed: BTreeSet<(u32, u32)> = sides.collect();
    let (inner, boundary): (Vec<_>, Vec<_>) =
        directed.iter().partition(|&&(a, b)| directed.contains(&(b, a)));
    (inner.into_iter().filter(|(a, b)| a < b).collect(), boundary)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal::math::DVec3;
    use chordal::mesh::Corner;

    #[test]
    fn a_square_has_one_inner_edge_and_four_around() {
        let corner = |u: f64, v: f64| Corner { position: 0, uv: DVec2::new(u, v), normal: DVec3::Z };
        let face = FaceMesh {
            face: 0,
            corners: vec![corner(0., 0.), corner(3., 0.), corner(3., 1.), corner(0., 1.)],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            quads: 0,
        };
        let (inner, boundary) = edges(&face);
        assert_eq!((inner, boundary.len()), (vec![(0, 2)], 4));
        let svg = draw(&face, &[UvBox::new(DVec2::ZERO, DVec2::new(1.5, 1.0))]);
        assert!(svg.contains("<rect x=\"20.00\" y=\"20.00\" width=\"450.00\" height=\"900.00\"/>"), "{svg}");
    }
}

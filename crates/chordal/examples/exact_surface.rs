//! Every vertex of a mesh has parameters on its face: the exact surface can be evaluated there.

use chordal::{Error, Mesher, Model};
use std::path::Path;

fn main() -> Result<(), Error> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/bracket.step");
    let meshed = Mesher::default().mesh(&Model::open(path)?)?;

    let mut farthest: f64 = 0.0;
    for triangle in meshed.triangles() {
        let Some(face) = meshed.faces().find(|f| (f.part(), Some(f.id())) == (triangle.part, triangle.face))
        else {
            continue;
        };
        let (Some(surface), Some(placement)) = (face.surface(), meshed.placement(triangle.placement)) else {
            continue;
        };
        for (uv, position) in triangle.uv.into_iter().zip(triangle.positions) {
            let exact = placement.transform_point3(surface.point(uv));
            farthest = farthest.max(exact.distance(position));
        }
    }
    println!("vertices lie within {farthest:.1e} mm of the exact surfaces");
    assert!(farthest <= meshed.report().max_edge_gap + 1e-9);
    Ok(())
}

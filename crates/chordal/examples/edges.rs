//! The edges of a model as polylines, and its faces with their kinds: what a viewer draws beside the
//! triangles.

use chordal::{Error, MeshOptions, Mesher, Model, Tolerance};
use std::path::Path;

fn main() -> Result<(), Error> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/bracket.step");
    let options = MeshOptions::default()
        .with_tolerance(Tolerance::Millimetres(0.2))
        .with_angle(None)
        .with_max_edge(Some(20.0));
    let meshed = Mesher::new(options).mesh(&Model::open(path)?)?;

    for edge in meshed.edges() {
        let length: f64 = edge.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        println!("edge {:?}: {} points, {length:.3} mm", edge.edge, edge.points.len());
    }
    for face in meshed.faces() {
        let entry = face.entry();
        println!("{} {}: {} triangles", entry.kind, face.source(), entry.triangles);
    }
    Ok(())
}

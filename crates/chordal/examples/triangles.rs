//! From the bytes of a STEP file to triangles with face ids and parameters.

use chordal::{Error, InputFormat, MeshOptions, Mesher, Model, Tolerance};

fn main() -> Result<(), Error> {
    let bytes = include_bytes!("../../../corpus/bracket.step");
    let model = Model::from_bytes(bytes, InputFormat::Step)?;
    let options = MeshOptions::default().with_tolerance(Tolerance::Millimetres(0.1));
    let meshed = Mesher::new(options).mesh(&model)?;
    for triangle in meshed.triangles() {
        println!("face {:?} at {:?}, uv {:?}", triangle.face, triangle.positions, triangle.uv);
    }
    Ok(())
}

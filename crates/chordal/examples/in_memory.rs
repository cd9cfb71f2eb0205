//! From bytes to bytes: a STEP file in memory becomes a GLB file in memory, as a server would do it.

use chordal::{Error, InputFormat, MeshOptions, Mesher, Model, OutputFormat};

fn glb_of_step(step: &[u8]) -> Result<Vec<u8>, Error> {
    let model = Model::from_bytes(step, InputFormat::Step)?;
    let options = MeshOptions::default().with_output_format(Some(OutputFormat::Glb));
    Mesher::new(options).mesh(&model)?.to_bytes(OutputFormat::Glb)
}

fn main() -> Result<(), Error> {
    let glb = glb_of_step(include_bytes!("../../../corpus/bracket.step"))?;
    println!("{} bytes, magic {:?}", glb.len(), std::str::from_utf8(&glb[..4]));

    // What a broken file gives is an error with one sentence, or a mesh whose report lists the problems.
    if let Err(error) = glb_of_step(b"ISO-10303-21;") {
        println!("{error}");
    }
    Ok(())
}

//! Meshes a CAD file and writes a mesh file: `cargo run --example write_file -- part.step part.stl`.

use chordal::{MeshOptions, Mesher, Model, OutputFormat, Tolerance};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let input = arguments.next().unwrap_or_else(|| example("bracket.step"));
    let output = arguments
        .next()
        .unwrap_or_else(|| std::env::temp_dir().join("chordal_example.stl").display().to_string());
    let extension = Path::new(&output).extension().and_then(|e| e.to_str()).unwrap_or_default();

    // Binary STL rounds coordinates to 32 bits: its rounding is kept back from the tolerance.
    let options = MeshOptions::default()
        .with_tolerance(Tolerance::Percent(0.05))
        .with_output_format(OutputFormat::from_extension(extension));
    let meshed = Mesher::new(options).mesh(&Model::open(&input)?)?;
    let summary = meshed.write(&output)?;

    println!("{output}: {} triangles, {} bytes", summary.triangles, summary.bytes);
    println!("{}, {}", meshed.report().proof_sentence(), meshed.report().closedness_sentence());
    Ok(())
}

/// A model of the repository.
fn example(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name).display().to_string()
}

//! Prints the assembly tree of a file: `cargo run --release --example read_tree -- FILE…`

use chordal_brep::{Model, NodeId};
use chordal_nurbs::math;

fn main() {
    for path in std::env::args().skip(1) {
        match chordal_read::read_file(&path, &chordal_read::ReadOptions::default()) {
            Ok(model) => {
                println!("{path}: {} ({})", model.schema, model.unit);
                for &root in &model.roots {
                    print(&model, root, 1);
                }
            }
            Err(error) => eprintln!("{error}"),
        }
    }
}

fn print(model: &Model, id: NodeId, depth: usize) {
    let node = &model.nodes[id.index()];
    let part = node.part.map(|part| &model.parts[part.index()]);
    let faces = part.map_or(0, |part| part.faces.len());
    let name = part.map_or("", |part| &part.name);
    let colored = part.map_or(0, |part| part.faces.iter().filter(|face| face.color.is_some()).count());
    let bodies = part.map_or(0, |part| part.bodies.iter().filter(|body| body.color.is_some()).count());
    let at = node.transform.translation;
    println!(
        "{:indent$}{:?} part {name:?}: {faces} faces, {colored} coloured; {bodies} bodies coloured; at \
         {at}; scale {:.4}",
        "",
        node.name,
        math::cbrt(node.transform.matrix3.determinant()),
        indent = 2 * depth
    );
    for &child in &node.children {
        print(model, child, depth + 1);
    }
}

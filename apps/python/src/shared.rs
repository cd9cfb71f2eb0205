//! What the objects of a model share: the model, and the numbers of its faces and edges.

/// What every object of a model refers to.
#[derive(Debug)]
pub struct Shared {
    pub model: chordal::Model,
    /// The number of the first face of every part, and of the first edge; then the numbers of all.
    pub first_faces: Vec<usize>,
    pub first_edges: Vec<usize>,
}

impl Shared {
    pub fn new(model: chordal::Model) -> Self {
        let firsts = |count: fn(&chordal::brep::Part) -> usize| {
            let mut firsts = vec![0];
            firsts.extend(model.brep().parts.iter().scan(0, |sum, part| {
                *sum += count(part);
                Some(*sum)
            }));
            firsts
        };
        Self { first_faces: firsts(|p| p.faces.len()), first_edges: firsts(|p| p.edges.len()), model }
    }
}

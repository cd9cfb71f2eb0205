//! What the faces and edges of a part gave in one pass, for later passes to which they are the same.
//!
//! A part is meshed again where its loops crossed ([`crate::part`]), and where its facets cut each other
//! ([`crate::parting`]). Most faces and edges are then what they were. A face is meshed by its loops, their
//! edges as they are sampled, and the effort of the round ([`Question`]): where these are the same bits, the
//! result is the same, and is taken from here.
//!
//! Not kept: faces that fail, which have no time left anyway, and results of named methods.

use crate::edges::SampledEdge;
use crate::face_result::FaceResult;
use chordal_brep::{EdgeId, Face, FaceGeometry, Loop, Part};
use rustc_hash::FxHashSet;
use std::sync::Arc;

/// What a face was meshed by, as a number: equal for equal questions, and different for others but for one
/// chance in 2⁶⁴.
pub(crate) type Question = u64;

/// Chords that a face asked to be cut.
type Requests = Vec<(u32, u32)>;

/// What is known of one face.
#[derive(Clone, Debug, Default)]
struct OfFace {
    requests: Vec<(Question, Requests)>,
    mesh: Option<(Question, Box<FaceResult>)>,
}

/// What the faces and edges of a part gave.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memo {
    /// First samples, before faces asked for finer ones; none where an edge has changed since.
    pub edges: Vec<Option<SampledEdge>>,
    faces: Vec<OfFace>,
    /// The part that this is about, where it is not the one of the file.
    part: Option<Arc<Part>>,
}

impl Memo {
    /// The mesh or the requests that the question gave before. A mesh is given back once.
    pub fn recall(&mut self, face: usize, question: Question) -> Option<Result<Box<FaceResult>, Requests>> {
        let known = self.faces.get_mut(face)?;
        if known.mesh.as_ref().is_some_and(|mesh| mesh.0 == question) {
            return known.mesh.take().map(|mesh| Ok(mesh.1));
        }
        let asked = known.requests.iter().find(|asked| asked.0 == question);
        asked.map(|asked| Err(asked.1.clone()))
    }

    pub fn note_requests(&mut self, face: usize, question: Question, chords: &[(u32, u32)]) {
        let known = self.of_face(face);
        if !known.requests.iter().any(|asked| asked.0 == question) {
            known.requests.push((question, chords.to_vec()));
        }
    }

    /// Keeps the mesh of a face as it was before the orientation of the part was settled.
    pub fn keep(&mut self, face: usize, question: Question, mut mesh: Box<FaceResult>) {
        if mesh.turned {
            mesh.turn_over();
        }
        self.of_face(face).mesh = Some((question, mesh));
    }

    fn of_face(&mut self, face: usize) -> &mut OfFace {
        if self.faces.len() <= face {
            self.faces.resize_with(face + 1, OfFace::default);
        }
        &mut self.faces[face]
    }

    /// Forgets what is different in `next`; `file` is the part of the file, `next` none for the same.
    pub fn turn_to(&mut self, file: &Part, next: Option<&Arc<Part>>) {
        let before = std::mem::replace(&mut self.part, next.cloned());
        let (old, new) = (before.as_deref().unwrap_or(file), next.map_or(file, |part| part));
        if std::ptr::eq(old, new) {
            return;
        }
        let mut changed = FxHashSet::default();
        for (index, known) in self.faces.iter_mut().enumerate() {
            if !is_same_face(old, new, index) {
                *known = OfFace::default();
                let both = [old, new].into_iter().filter_map(|part| part.faces.get(index));
                changed.extend(both.flat_map(edges_of).map(EdgeId::index));
            }
        }
        for (index, known) in self.edges.iter_mut().enumerate() {
            if changed.contains(&index) || old.edges.get(index) != new.edges.get(index) {
                *known = None;
            }
        }
    }
}

fn edges_of(face: &Face) -> impl Iterator<Item = EdgeId> + '_ {
    let coedges = face.loops.iter().flat_map(|a_loop| match a_loop {
        Loop::Edges { coedges, .. } => coedges.as_slice(),
        _ => &[],
    });
    coedges.map(|coedge| coedge.edge)
}

/// True for a face with the same surface, loops, edges and vertices in both parts.
fn is_same_face(old: &Part, new: &Part, index: usize) -> bool {
    let (Some(one), Some(other)) = (old.faces.get(index), new.faces.get(index)) else { return false };
    let has_same_surface = match (&one.geometry, &other.geometry) {
        (FaceGeometry::Surface(one), FaceGeometry::Surface(other)) => Arc::ptr_eq(one, other),
        _ => false,
    };
    let is_same_vertex = |v: usize| old.vertices.get(v) == new.vertices.get(v);
    let is_same_edge = |id: EdgeId| match (old.edges.get(id.index()), new.edges.get(id.index())) {
        (Some(one), Some(other)) => {
            one == other && is_same_vertex(one.start.index()) && is_same_vertex(one.end.index())
        }
        _ => false,
    };
    let are_same_corners = |a_loop: &Loop| match a_loop {
        Loop::Edges { .. } => true,
        Loop::Vertex(v) => is_same_vertex(v.index()),
        Loop::Polygon { vertices, .. } => vertices.iter().all(|v| is_same_vertex(v.index())),
    };
    has_same_surface
        && (one.same_sense, one.flipped) == (other.same_sense, other.flipped)
        && one.loops == other.loops
        && one.loops.iter().all(are_same_corners)
        && edges_of(one).all(is_same_edge)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_brep::{Coedge, Edge, Pcurve, Source, Vertex, VertexId};
    use chordal_nurbs::{DVec3, Frame, Range, Surface};

    /// Two faces on one plane, each with an edge of its own from vertex 0 to vertex 1.
    fn part() -> Part {
        let vertex = |x: f64| Vertex { point: DVec3::X * x, source: Source::default() };
        let edge = Edge {
            start: VertexId::from(0),
            end: VertexId::from(1),
            curve: None,
            range: Range::new(0.0, 1.0),
            source: Source::default(),
        };
        let frame = Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X);
        let face = |index: usize| {
            let pcurves: Vec<Pcurve> = Vec::new();
            let coedge = Coedge { edge: EdgeId::from(index), forward: true, pcurves };
            Face {
                geometry: FaceGeometry::Surface(Arc::new(Surface::Plane { frame })),
                same_sense: true,
                flipped: false,
                loops: vec![Loop::Edges { coedges: vec![coedge], outer: true }],
                name: String::new(),
                color: None,
                layer: None,
                source: Source::default(),
            }
        };
        Part {
            vertices: vec![vertex(0.0), vertex(1.0)],
            edges: vec![edge.clone(), edge],
            faces: vec![face(0), face(1)],
            ..Part::default()
        }
    }

    fn memo() -> Memo {
        let mut memo = Memo { edges: vec![Some(SampledEdge::default()); 2], ..Memo::default() };
        for face in 0..2 {
            memo.note_requests(face, 7, &[(3, 4)]);
            memo.keep(face, 9, Box::default());
        }
        memo
    }

    #[test]
    fn a_mesh_is_given_back_once_and_requests_each_time() {
        let mut memo = memo();
        assert!(memo.recall(0, 8).is_none() && memo.recall(5, 9).is_none());
        assert!(matches!(memo.recall(0, 9), Some(Ok(_))) && memo.recall(0, 9).is_none());
        for _ in 0..2 {
            assert!(matches!(memo.recall(0, 7), Some(Err(chords)) if chords == [(3, 4)]));
        }
    }

    #[test]
    fn a_mesh_is_kept_as_it_was_before_it_was_turned_over() {
        let mut mesh = Box::new(FaceResult { triangles: vec![[0, 1, 2]], ..FaceResult::default() });
        mesh.turn_over();
        let mut memo = Memo::default();
        memo.keep(0, 1, mesh);
        assert!(matches!(memo.recall(0, 1), Some(Ok(mesh)) if mesh.triangles == [[0, 1, 2]] && !mesh.turned));
    }

    #[test]
    fn what_is_different_in_another_part_is_forgotten() {
        let file = part();
        let (mut other_edge, mut other_vertex, mut other_loop) = (file.clone(), file.clone(), file.clone());
        other_edge.edges[1].range = Range::new(0.0, 2.0);
        other_vertex.vertices[1].point = DVec3::Y;
        other_loop.faces[1].loops.clear();
        for (next, is_first_kept) in
            [(file.clone(), true), (other_edge, true), (other_loop, true), (other_vertex, false)]
        {
            let is_same = next == file;
            let mut memo = memo();
            memo.turn_to(&file, Some(&Arc::new(next)));
            assert_eq!(memo.recall(0, 9).is_some(), is_first_kept);
            assert_eq!(memo.recall(1, 9).is_some(), is_same);
            assert_eq!(memo.edges[0].is_some(), is_first_kept);
            assert_eq!(memo.edges[1].is_some(), is_same);
        }
    }
}

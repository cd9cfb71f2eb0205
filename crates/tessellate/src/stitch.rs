//! Stitch: vertices of faces become shared positions, by identity and never by distance.

use crate::face_result::FaceResult;
use chordal_brep::Part;
use chordal_chart::{EdgeSamples, Key};
use chordal_mesh::{Corner, FaceMesh, Origin, PartMesh};

const UNSET: u32 = u32::MAX;

struct Stitcher<'a> {
    part: &'a Part,
    edges: &'a [EdgeSamples],
    mesh: PartMesh,
    vertices: Vec<u32>,
    samples: Vec<Vec<u32>>,
}

/// Joins the faces of a part; failed ones are `None`.
pub(crate) fn stitch(part: &Part, edges: &[EdgeSamples], faces: &[Option<&FaceResult>]) -> PartMesh {
    let mut stitcher = Stitcher {
        part,
        edges,
        mesh: PartMesh::default(),
        vertices: vec![UNSET; part.vertices.len()],
        samples: edges.iter().map(|e| vec![UNSET; e.points.len()]).collect(),
    };
    for (index, face) in faces.iter().enumerate() {
        let mesh = match face {
            Some(face) => stitcher.face(index as u32, face),
            None => FaceMesh { face: index as u32, ..FaceMesh::default() },
        };
        stitcher.mesh.faces.push(mesh);
    }
    stitcher.link_edges();
    stitcher.mesh
}

impl Stitcher<'_> {
    fn add(&mut self, p: chordal_nurbs::DVec3, origin: Origin) -> u32 {
        self.mesh.positions.push(p);
        self.mesh.origins.push(origin);
        self.mesh.positions.len() as u32 - 1
    }

    fn face(&mut self, index: u32, face: &FaceResult) -> FaceMesh {
        let mut private = vec![UNSET; face.private.len()];
        let mut corner_of = vec![UNSET; face.keys.len()];
        let mut mesh = FaceMesh { face: index, ..FaceMesh::default() };
        for triangle in &face.triangles {
            let corners = triangle.map(|v| {
                let i = v as usize;
                if corner_of[i] == UNSET {
                    let position = self.position(index, face, face.keys[i], &mut private);
                    corner_of[i] = mesh.corners.len() as u32;
                    mesh.corners.push(Corner { position, uv: face.uv[i], normal: face.normals[i] });
                }
                corner_of[i]
            });
            mesh.triangles.push(corners);
        }
        mesh.quads = face.quads as u32;
        mesh
    }

    fn position(&mut self, index: u32, face: &FaceResult, key: Key, private: &mut [u32]) -> u32 {
        match key {
            Key::Vertex(v) => {
                if self.vertices[v as usize] == UNSET {
                    self.vertices[v as usize] =
                        self.add(self.part.vertices[v as usize].point, Origin::Vertex(v));
                }
                self.vertices[v as usize]
            }
            Key::Edge(edge, i) => {
                let at = (edge as usize, i as usize);
                if self.samples[at.0][at.1] == UNSET {
                    let p = self.edges[at.0].points[at.1];
                    self.samples[at.0][at.1] = self.add(p, Origin::Edge { edge, index: i });
                }
                self.samples[at.0][at.1]
            }
            Key::Private(k) => {
                if private[k as usize] == UNSET {
                    private[k as usize] = self.add(face.private[k as usize], Origin::Face(index));
                }
                private[k as usize]
            }
        }
    }

    /// The polyline of every edge that a face uses.
    fn link_edges(&mut self) {
        for (edge, samples) in self.part.edges.iter().zip(&mut self.samples) {
            let n = samples.len();
            if n >= 2 {
                samples[0] = self.vertices[edge.start.index()];
                samples[n - 1] = self.vertices[edge.end.index()];
            }
            let used = n >= 2 && !samples.contains(&UNSET);
            self.mesh.edges.push(if used { std::mem::take(samples) } else { Vec::new() });
        }
    }
}

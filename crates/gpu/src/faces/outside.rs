//! Which faces lie on a closed shell, so that from outside their backs are never seen.
//!
//! A ray from outside such a shell meets its outside first. Closed means: every side of a triangle is that of
//! one other triangle too, run the other way round; the right way out means: the shell's volume is positive.
//! Shells that are turned inside out in places only, so that they cut through themselves, are not detected.

use chordal_mesh::PartMesh;
use chordal_nurbs::DVec3;
use std::collections::BTreeMap;

/// Per face the sum of its triangles' area vectors, which point outwards; `None` where its back may be seen.
pub fn outside_faces(mesh: &PartMesh) -> Vec<Option<DVec3>> {
    let mut shells = Shells { parents: (0..mesh.faces.len()).collect() };
    let mut sides: BTreeMap<[u32; 2], Vec<(usize, bool)>> = BTreeMap::new();
    let mut measures = Vec::with_capacity(mesh.faces.len());
    for (index, face) in mesh.faces.iter().enumerate() {
        let (mut area, mut volume) = (DVec3::ZERO, 0.0);
        for t in &face.triangles {
            let at = t.map(|c| face.corners[c as usize].position);
            let [a, b, c] = at.map(|i| mesh.positions[i as usize] - mesh.positions[0]);
            area += 0.5 * (b - a).cross(c - a);
            volume += a.dot(b.cross(c)) / 6.0;
            for [p, q] in [[at[0], at[1]], [at[1], at[2]], [at[2], at[0]]] {
                sides.entry([p.min(q), p.max(q)]).or_default().push((index, p < q));
            }
        }
        measures.push((area, volume));
    }
    let mut open = vec![false; mesh.faces.len()];
    for users in sides.values() {
        let paired = users.len() == 2 && users[0].1 != users[1].1;
        for (face, _) in users {
            open[*face] |= !paired;
            shells.join(users[0].0, *face);
        }
    }
    let mut volumes = vec![(0.0, true); mesh.faces.len()];
    for (index, (_, volume)) in measures.iter().enumerate() {
        let of_shell = &mut volumes[shells.root(index)];
        of_shell.0 += volume;
        of_shell.1 &= !open[index];
    }
    let outside = |index: usize| volumes[shells.root(index)].1 && volumes[shells.root(index)].0 > 0.0;
    measures.iter().enumerate().map(|(index, (area, _))| outside(index).then_some(*area)).collect()
}

/// Faces joined to shells, a tree each.
struct Shells {
    parents: Vec<usize>,
}

impl Shells {
    fn root(&self, mut face: usize) -> usize {
        while self.parents[face] != face {
            face = self.parents[face];
        }
        face
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.parents[high] = low;
        // Shorten the path, for sets that are joined often.
        for mut face in [a, b] {
            while self.parents[face] != face {
                face = std::mem::replace(&mut self.parents[face], low);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_mesh::{Corner, FaceMesh};
    use chordal_nurbs::DVec2;

    /// A tetrahedron about `at`, one face a triangle, turned inside out or with a face missing.
    fn tetrahedron(mesh: &mut PartMesh, at: DVec3, inside_out: bool, faces: usize) {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| at + p));
        for mut t in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].into_iter().take(faces) {
            if inside_out {
                t.swap(1, 2);
            }
            let corner = |i: u32| Corner { position: first + i, uv: DVec2::ZERO, normal: DVec3::ZERO };
            mesh.faces.push(FaceMesh {
                corners: t.map(corner).to_vec(),
                triangles: vec![[0, 1, 2]],
                ..Default::default()
            });
        }
    }

    #[test]
    fn closed_shells_of_positive_volume_have_an_outside() {
        let mut mesh = PartMesh::default();
        tetrahedron(&mut mesh, DVec3::splat(5.0), false, 4);
        tetrahedron(&mut mesh, DVec3::splat(-5.0), true, 4);
        tetrahedron(&mut mesh, DVec3::X, false, 3);
        let found = outside_faces(&mesh);
        assert!(found[..4].iter().all(Option::is_some) && found[4..].iter().all(Option::is_none));
        assert!(found[0].unwrap().z < 0.0 && found[2].unwrap().min_element() > 0.0);
    }
}

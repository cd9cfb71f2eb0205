//! Connected shells of the joined mesh: triangles get a common orientation, and open borders are measured.

use super::boundary::{Boundaries, Side, sorted_sides};
use super::closest::nearest_by_border;
use super::join::Joined;
use super::{MeshSewReport, OpenBorder, SewnMesh};
use crate::orient::orient;
use crate::rebuild::Link;

/// Orients the mesh and completes the report.
pub(crate) fn finish(joined: Joined, report: &mut MeshSewReport) -> SewnMesh {
    let mut mesh = joined.mesh;
    let sides = sorted_sides(&mesh.triangles);
    let runs_up = |s: &Side| mesh.triangles[s.triangle as usize][s.side as usize] == s.edge[0];
    let mut links = Vec::new();
    let mut open = vec![false; mesh.triangles.len()];
    for group in sides.chunk_by(|a, b| a.edge == b.edge) {
        match group {
            [one] => open[one.triangle as usize] = true,
            [a, b] => {
                links.push(Link { faces: [a.triangle, b.triangle], same: runs_up(a) == runs_up(b) });
            }
            _ => {}
        }
    }
    let count = mesh.triangles.len();
    let oriented = orient(count, &vec![false; count], &links);
    mesh.shells = oriented.component.clone();
    let mut turn = oriented.turn;
    let mut closed = vec![true; oriented.components];
    let mut changed = vec![false; oriented.components];
    for t in 0..count {
        closed[mesh.shells[t] as usize] &= !open[t];
        changed[mesh.shells[t] as usize] |= turn[t];
    }
    // The sign of the volume of a closed shell gives its orientation.
    let inside_out = volumes(&mesh, &turn, oriented.components);
    for t in 0..count {
        let shell = mesh.shells[t] as usize;
        turn[t] ^= closed[shell] && changed[shell] && inside_out[shell] < 0.0;
        if turn[t] {
            mesh.triangles[t].swap(1, 2);
            report.turned += 1;
        }
    }
    report.shells = oriented.components;
    report.closed_shells = closed.iter().filter(|c| **c).count();
    report.inconsistent = inconsistent(&mesh);
    describe_open(&mesh, report);
    mesh
}

/// Six times the volume of every shell, its triangles reversed where `turn` is set.
fn volumes(mesh: &SewnMesh, turn: &[bool], shells: usize) -> Vec<f64> {
    let mut origin = vec![None; shells];
    let mut six = vec![0.0; shells];
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let shell = mesh.shells[t] as usize;
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
        let o = *origin[shell].get_or_insert(a);
        let v = (a - o).dot((b - o).cross(c - o));
        six[shell] += if turn[t] { -v } else { v };
    }
    six
}

fn inconsistent(mesh: &SewnMesh) -> usize {
    let sides = sorted_sides(&mesh.triangles);
    let up = |s: &Side| mesh.triangles[s.triangle as usize][s.side as usize] == s.edge[0];
    sides
        .chunk_by(|a, b| a.edge == b.edge)
        .filter(|g| g.len() > 1 && 2 * g.iter().filter(|s| up(s)).count() != g.len())
        .count()
}

/// The borders that stay open, the longest first.
fn describe_open(mesh: &SewnMesh, report: &mut MeshSewReport) {
    let left = Boundaries::new(&mesh.positions, &mesh.triangles);
    report.open_after = left.edges();
    let nearest = nearest_by_border(&left);
    for (boundary, near) in left.all.iter().zip(&nearest) {
        let middles = near.iter().filter_map(|n| n[1]);
        let range = middles.fold(None, |r: Option<[f64; 2]>, d| {
            Some(r.map_or([d, d], |[low, high]| [low.min(d), high.max(d)]))
        });
        report.open.push(OpenBorder {
            edges: boundary.sides.len(),
            length: boundary.length(),
            nearest: range,
            at: left.point(boundary.vertices[0]),
        });
    }
    report.open.sort_by(|a, b| b.length.total_cmp(&a.length));
}

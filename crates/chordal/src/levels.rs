//! A chain of coarser meshes, each with half the triangles of the one before, by the decimator of the crate
//! `meshopt`.
//!
//! That crate is built from C++, so it is behind the feature `levels`. It collapses edges by quadric errors
//! (Garland and Heckbert 1997) and keeps what is connected connected; borders that are open stay as they are.
//! Its error is an estimate.

use chordal_sew::SewnMesh;

/// A coarser mesh.
#[derive(Clone, Debug, Default)]
pub(crate) struct Level {
    pub mesh: SewnMesh,
    /// About how far it is from the mesh it was made of.
    pub error: f64,
}

/// True where this build can decimate.
pub(crate) const AVAILABLE: bool = cfg!(feature = "levels");

/// No levels: this build has no decimator.
#[cfg(not(feature = "levels"))]
pub(crate) fn levels(_mesh: &SewnMesh, _count: usize) -> Vec<Level> {
    Vec::new()
}

/// At most `count` levels; fewer where no triangle can be taken away any more.
#[cfg(feature = "levels")]
pub(crate) fn levels(mesh: &SewnMesh, count: usize) -> Vec<Level> {
    let indices: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    // Single precision, about the middle so that no digit is lost to the place.
    let (low, high) = mesh
        .positions
        .iter()
        .fold((glam::DVec3::INFINITY, glam::DVec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    let middle = 0.5 * (low + high);
    let local: Vec<[f32; 3]> = mesh.positions.iter().map(|p| (*p - middle).as_vec3().to_array()).collect();
    let scale = f64::from(meshopt::simplify_scale_decoder(&local));
    let mut shell_of = vec![0; mesh.positions.len()];
    let mut source_of = std::collections::BTreeMap::new();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        triangle.iter().for_each(|&v| shell_of[v as usize] = mesh.shells[t]);
        source_of.entry(mesh.shells[t]).or_insert(mesh.sources[t]);
    }
    let mut found: Vec<Level> = Vec::new();
    let mut last = indices.len();
    for k in 1..=count {
        let target = indices.len() / 3 / (1 << k.min(31)) * 3;
        let mut error = 0.0_f32;
        let options = meshopt::SimplifyOptions::LockBorder;
        let coarse = meshopt::simplify_decoder(&indices, &local, target, f32::MAX, options, Some(&mut error));
        if coarse.len() >= last || coarse.is_empty() {
            break;
        }
        last = coarse.len();
        let triangles: Vec<[u32; 3]> = coarse.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
        let shells: Vec<u32> = triangles.iter().map(|t| shell_of[t[0] as usize]).collect();
        let sources = shells.iter().map(|s| source_of[s]).collect();
        let mesh = SewnMesh { positions: mesh.positions.clone(), triangles, sources, shells };
        found.push(Level { mesh, error: f64::from(error) * scale });
    }
    found
}

#[cfg(all(test, feature = "levels"))]
mod tests {
    use super::*;
    use chordal_nurbs::math;
    use chordal_sew::{SewTolerance, sew_mesh};
    use glam::DVec3;

    /// A sewn ball of two hemispheres: every level is closed, has about half the triangles, and keeps its
    /// shape.
    #[test]
    fn levels_of_a_closed_mesh_are_closed() {
        let (m, n) = (40_u32, 80_u32);
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for side in [1.0, -1.0] {
            let first = positions.len() as u32;
            for i in 0..=m {
                for j in 0..n {
                    let (a, b) = (
                        f64::from(i) / f64::from(m) * 1.5,
                        f64::from(j) / f64::from(n) * std::f64::consts::TAU,
                    );
                    positions.push(DVec3::new(
                        math::cos(a) * math::cos(b),
                        math::cos(a) * math::sin(b),
                        side * math::sin(a),
                    ));
                }
            }
            positions.push(DVec3::Z * side);
            let top = positions.len() as u32 - 1;
            let at = |i: u32, j: u32| first + i * n + j % n;
            for j in 0..n {
                for i in 0..m {
                    let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                    triangles.extend([[a, b, c], [a, c, d]]);
                }
                triangles.push([at(m, j), at(m, j + 1), top]);
            }
        }
        let (mesh, report) = sew_mesh(&positions, &triangles, SewTolerance::Length(1e-6), None);
        assert_eq!((report.open_after, report.closed_shells), (0, 1));
        let found = levels(&mesh, 4);
        assert_eq!(found.len(), 4);
        let mut before = mesh.triangles.len();
        for level in &found {
            let count = level.mesh.triangles.len();
            assert!(count <= before * 6 / 10 && count * 3 > before, "{count} of {before}");
            before = count;
            let edges = crate::edge_count::EdgeCount::of(level.mesh.triangles.iter().copied());
            assert_eq!((edges.open, edges.inconsistent), (0, 0));
            assert!(level.error < 0.05, "{}", level.error);
        }
    }
}

//! Faces whose facets lie one beside the other, seen along a coordinate axis.
//!
//! Where all facets run the same way round in this view, the number of them over a place is the winding
//! number of their boundary around it (as in [`crate::overlap`]). Where the boundary does not touch itself
//! and winds once around a place beside each of its chains, that number is 1 everywhere inside: no facet is
//! over another one, and none cuts another. Coordinates are as they are and signs are exact, so this proves
//! it; otherwise, pairs of facets are compared.

use crate::boundary_tree::{BoundaryTree, Chains, Side};
use crate::halves::Halves;
use crate::triangle_pair::turn2;
use chordal_mesh::{FaceMesh, PartMesh};
use chordal_nurbs::{DVec2, DVec3};

/// True where the facets of a face are known not to cut each other.
pub(crate) fn is_graph(mesh: &PartMesh, of_face: &FaceMesh) -> bool {
    let at = |corner: u32| mesh.positions[of_face.corners[corner as usize].position as usize];
    let normal = |t: &[u32; 3]| {
        let [a, b, c] = t.map(at);
        (b - a).cross(c - a)
    };
    let sum: DVec3 = of_face.triangles.iter().map(normal).sum();
    let up = sum.abs().max_position();
    // The view from above, so that facets run counter-clockwise.
    let axes = if sum[up] > 0.0 { [(up + 1) % 3, (up + 2) % 3] } else { [(up + 2) % 3, (up + 1) % 3] };
    let seen = |corner: u32| {
        let p = at(corner);
        DVec2::new(p[axes[0]], p[axes[1]])
    };
    let turns_left = |t: &[u32; 3]| {
        let [a, b, c] = t.map(seen);
        turn2(a, b, c) > 0.0
    };
    of_face.triangles.iter().all(turns_left) && is_simple(of_face, &seen)
}

/// True where the boundary of a face in a view does not touch itself and winds once around each place beside
/// it.
fn is_simple(of_face: &FaceMesh, seen: &impl Fn(u32) -> DVec2) -> bool {
    let halves = Halves::of(&of_face.triangles, of_face.corners.len());
    let chains = Chains::of(&halves.single, of_face.corners.len());
    let tree = BoundaryTree::new(
        chains.halves.iter().map(|h| Side { a: seen(h.a), b: seen(h.b), is_loose: false }).collect(),
    );
    let mut touching = false;
    tree.own_pairs(&mut |s, t| touching |= touch(s, t));
    let inside = |range: &std::ops::Range<usize>| {
        let triangle = chains.halves[range.start].triangle;
        of_face.triangles[triangle as usize].map(seen).iter().sum::<DVec2>() / 3.0
    };
    !touching && chains.ranges.iter().all(|range| tree.winding(inside(range)) == 1)
}

/// True where two sides have a point in common other than the end of one at which the other one starts.
fn touch(s: &Side, t: &Side) -> bool {
    if s.b == t.a && s.a == t.b {
        return true;
    }
    if s.b == t.a || s.a == t.b {
        // Collinear and in opposite directions, one lies on the other.
        let (a, b, c) = if s.b == t.a { (s.a, s.b, t.b) } else { (t.a, t.b, s.b) };
        return turn2(a, b, c) == 0.0 && (b - a).dot(c - b) <= 0.0;
    }
    let apart = |line: &Side, other: &Side| {
        let (c, d) = (turn2(line.a, line.b, other.a), turn2(line.a, line.b, other.b));
        (c > 0.0 && d > 0.0) || (c < 0.0 && d < 0.0)
    };
    !apart(s, t) && !apart(t, s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_mesh::Corner;
    use chordal_nurbs::math;

    /// A face with a vertex of its own at every point.
    fn mesh(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> (PartMesh, FaceMesh) {
        let corner = |i: u32| Corner { position: i, uv: DVec2::ZERO, normal: DVec3::ZERO };
        let of_face = FaceMesh {
            corners: (0..points.len() as u32).map(corner).collect(),
            triangles: triangles.to_vec(),
            ..FaceMesh::default()
        };
        let positions = points.iter().map(|&p| DVec3::from(p)).collect();
        (PartMesh { positions, ..PartMesh::default() }, of_face)
    }

    fn is(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> bool {
        let (mesh, of_face) = mesh(points, triangles);
        is_graph(&mesh, &of_face)
    }

    #[test]
    fn a_tent_is_a_graph_from_either_side() {
        let points = [[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.], [1., 1., 1.]];
        let fan = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        assert!(is(&points, &fan));
        assert!(is(&points, &fan.map(|[a, b, c]| [a, c, b])));
    }

    #[test]
    fn a_strip_that_comes_back_over_itself_is_none() {
        // A helical strip of one turn and a quarter about the z axis, seen from above.
        let at = |i: usize, r: f64| {
            let angle = i as f64 * 0.25 * std::f64::consts::FRAC_PI_2;
            [r * math::cos(angle), r * math::sin(angle), 0.01 * i as f64]
        };
        let strip = |steps: usize| {
            let points: Vec<[f64; 3]> = (0..=steps).flat_map(|i| [at(i, 1.0), at(i, 2.0)]).collect();
            let quads = (0..steps as u32).map(|i| 2 * i);
            let triangles: Vec<[u32; 3]> =
                quads.flat_map(|i| [[i, i + 1, i + 3], [i, i + 3, i + 2]]).collect();
            is(&points, &triangles)
        };
        assert!(strip(14));
        assert!(!strip(20));
    }

    #[test]
    fn a_flap_that_touches_and_a_fold_are_none() {
        // Two triangles that have a point in common, but no vertex.
        let points = [[0., 0., 0.], [2., 0., 0.], [0., 2., 0.], [1., 1., 0.], [3., 1., 0.], [1., 3., 0.]];
        assert!(!is(&points, &[[0, 1, 2], [3, 4, 5]]));
        let fold = [[0., 0., 0.], [2., 0., 0.], [0., 2., 0.], [0.5, 0.5, 0.1]];
        assert!(!is(&fold, &[[0, 1, 2], [1, 0, 3]]));
    }
}

//! Closed shells whose facets cut each other.
//!
//! A solid whose mesh cuts itself has no inside that a mesher of volumes, a slicer or a Boolean could use,
//! although it is closed and every facet is within its tolerance: thin walls, fillets that are nearly
//! tangent, loose edges.
//!
//! 1. A tree over the boxes of the faces gives pairs of faces that may meet.
//! 2. Pairs of which one is clearly beside the plane of the other are left out ([`crate::separation`]).
//! 3. Trees over the boxes of their facets, built when first needed, give pairs of facets.
//! 4. Exact predicates decide ([`crate::triangle_pair`]).
//!
//! Two facets of one face are compared only where the surface can come back to itself, and where no view shows
//! that they lie one beside the other ([`crate::graph`]). The facets of a plane, cylinder, cone, sphere or
//! plain torus lie so because their parameters do not overlap, which is checked in the chart.

use crate::context::Context;
use crate::graph::is_graph;
use crate::report::FaceCrossing;
use crate::separation::PlaneFace;
use crate::triangle_pair::{Facet3, cut_each_other};
use chordal_brep::{FaceGeometry, FaceId};
use chordal_nurbs::{Box3, BoxTree, Surface};
use rayon::prelude::*;
use std::sync::OnceLock;

/// Facets of each of two faces that are compared in order: of more, trees find pairs more quickly.
const MOST_IN_ORDER: usize = 1024;

/// The facets of one face of a shell.
struct FacetsOfFace {
    face: u32,
    facets: Vec<Facet3>,
    bounds: Box3,
    tree: OnceLock<BoxTree>,
}

/// The pairs of faces of a shell whose facets cut each other, in the order of the faces.
pub(crate) fn self_intersections(context: &Context<'_>, faces: &[FaceId]) -> Vec<FaceCrossing> {
    let all: Vec<FacetsOfFace> =
        faces.par_iter().map(|face| FacetsOfFace::new(context, face.index())).collect();
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    BoxTree::new(all.iter().map(|f| f.bounds)).own_pairs(&mut |i, j| pairs.push((i, j)));
    leave_out_separate(context, &all, &mut pairs);
    pairs.extend(
        (0..all.len()).filter(|&i| may_meet_itself(context, all[i].face)).map(|i| (i as u32, i as u32)),
    );
    let count = |&(i, j): &(u32, u32)| {
        let (a, b) = (&all[i as usize], &all[j as usize]);
        let cuts = if i == j { a.cuts_of_its_own() } else { a.cuts_with(b) };
        (cuts > 0)
            .then(|| FaceCrossing { faces: [a.face.min(b.face), a.face.max(b.face)], facet_pairs: cuts })
    };
    let mut found: Vec<FaceCrossing> = pairs.par_iter().filter_map(count).collect();
    found.sort_unstable_by_key(|crossing| crossing.faces);
    found
}

/// Leaves out the pairs of which one face is clearly beside the plane of the other.
fn leave_out_separate(context: &Context<'_>, all: &[FacetsOfFace], pairs: &mut Vec<(u32, u32)>) {
    let Context { part, mesh, .. } = context;
    let planes: Vec<Option<PlaneFace>> =
        all.iter().map(|f| PlaneFace::new(part, mesh, f.face as usize)).collect();
    let is_beside = |plane: u32, other: u32| {
        let other = &all[other as usize];
        let is_beside =
            |p: &PlaneFace| p.is_beside(&mesh.faces[other.face as usize], &other.bounds, &mesh.positions);
        planes[plane as usize].as_ref().is_some_and(is_beside)
    };
    pairs.retain(|&(i, j)| !is_beside(i, j) && !is_beside(j, i));
}

/// False for surfaces on which points with different parameters are different points, and where a view shows
/// that no facet is over another one.
fn may_meet_itself(context: &Context<'_>, face: u32) -> bool {
    match &context.part.faces[face as usize].geometry {
        FaceGeometry::Failed(_) => false,
        FaceGeometry::Surface(surface) => match surface.as_ref() {
            Surface::Plane { .. }
            | Surface::Cylinder { .. }
            | Surface::Cone { .. }
            | Surface::Sphere { .. } => false,
            Surface::Torus { major, minor, .. } => major.abs() < minor.abs(),
            _ => !is_graph(context.mesh, &context.mesh.faces[face as usize]),
        },
    }
}

impl FacetsOfFace {
    fn new(context: &Context<'_>, face: usize) -> Self {
        let mesh = &context.mesh.faces[face];
        let facet = |t: &[u32; 3]| {
            let corners = t.map(|c| mesh.corners[c as usize].position);
            Facet3::new(corners, corners.map(|p| context.mesh.positions[p as usize]))
        };
        let facets: Vec<Facet3> = mesh.triangles.iter().map(facet).collect();
        let bounds = facets.iter().fold(Box3::EMPTY, |all, f| all.union(f.bounds()));
        Self { face: face as u32, facets, bounds, tree: OnceLock::new() }
    }

    fn tree(&self) -> &BoxTree {
        self.tree.get_or_init(|| BoxTree::new(self.facets.iter().map(Facet3::bounds)))
    }

    /// The facets that meet a box, each with its own box.
    fn within(&self, region: &Box3) -> Vec<(Box3, u32)> {
        let all = self.facets.iter().map(Facet3::bounds).zip(0..);
        all.filter(|(bounds, _)| bounds.meets(region)).collect()
    }

    fn cuts_with(&self, other: &Self) -> usize {
        let mut cuts = 0;
        pairs_between(self, other, &mut |i, j| {
            cuts += usize::from(cut_each_other(&self.facets[i as usize], &other.facets[j as usize]));
        });
        cuts
    }

    fn cuts_of_its_own(&self) -> usize {
        let mut cuts = 0;
        self.tree().own_pairs(&mut |i, j| {
            cuts += usize::from(cut_each_other(&self.facets[i as usize], &self.facets[j as usize]));
        });
        cuts
    }
}

/// Calls `visit` for every facet of one face and facet of another whose boxes meet. Of neighbours only the
/// facets in what their boxes have in common are looked at: in order along its longest side, or in trees where
/// they are many.
fn pairs_between(a: &FacetsOfFace, b: &FacetsOfFace, visit: &mut impl FnMut(u32, u32)) {
    let common = Box3 { min: a.bounds.min.max(b.bounds.min), max: a.bounds.max.min(b.bounds.max) };
    let (mut of_a, mut of_b) = (a.within(&common), b.within(&common));
    if of_a.len().min(of_b.len()) > MOST_IN_ORDER {
        let tree = |all: &[(Box3, u32)]| BoxTree::new(all.iter().map(|item| item.0));
        tree(&of_a).pairs_with(&tree(&of_b), &mut |i, j| visit(of_a[i as usize].1, of_b[j as usize].1));
        return;
    }
    let axis = (common.max - common.min).max_position();
    for list in [&mut of_a, &mut of_b] {
        list.sort_unstable_by(|s, t| s.0.min[axis].total_cmp(&t.0.min[axis]));
    }
    let (mut i, mut j) = (0, 0);
    while i < of_a.len() && j < of_b.len() {
        let ((one, s), (other, t)) = (of_a[i], of_b[j]);
        if one.min[axis] <= other.min[axis] {
            follow(&one, &of_b[j..], axis, &mut |t| visit(s, t));
            i += 1;
        } else {
            follow(&other, &of_a[i..], axis, &mut |s| visit(s, t));
            j += 1;
        }
    }
}

/// Calls `visit` for the items whose boxes meet `one`; they are in order along an axis.
fn follow(one: &Box3, items: &[(Box3, u32)], axis: usize, visit: &mut impl FnMut(u32)) {
    let reached = items.iter().take_while(|item| item.0.min[axis] <= one.max[axis]);
    reached.filter(|item| item.0.meets(one)).for_each(|item| visit(item.1));
}

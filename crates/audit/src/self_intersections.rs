//! Closed shells whose facets cut each other.
//!
//! A solid whose mesh cuts itself has no inside that a mesher of volumes, a slicer or a Boolean could use,
//! although it is closed and every facet is within its tolerance: thin walls, fillets that are nearly
//! tangent, loose edges.
//!
//! 1. A tree over the boxes of the faces gives pairs of faces that may meet.
//! 2. Trees over the boxes of their facets, built when first needed, give pairs of facets.
//! 3. Exact predicates decide ([`crate::triangle_pair`]).
//!
//! Two facets of one face are compared only where the surface can come back to itself. The facets of a plane,
//! cylinder, cone, sphere or plain torus lie one beside the other because their parameters do not overlap,
//! which is checked in the chart.

use crate::box_tree::BoxTree;
use crate::context::Context;
use crate::report::FaceCrossing;
use crate::triangle_pair::{Facet3, cut_each_other};
use chordal_brep::{FaceGeometry, FaceId};
use chordal_nurbs::{Box3, Surface};
use rayon::prelude::*;
use std::sync::OnceLock;

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

/// False for surfaces on which points with different parameters are different points.
fn may_meet_itself(context: &Context<'_>, face: u32) -> bool {
    match &context.part.faces[face as usize].geometry {
        FaceGeometry::Failed(_) => false,
        FaceGeometry::Surface(surface) => match surface.as_ref() {
            Surface::Plane { .. }
            | Surface::Cylinder { .. }
            | Surface::Cone { .. }
            | Surface::Sphere { .. } => false,
            Surface::Torus { major, minor, .. } => major.abs() < minor.abs(),
            _ => true,
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

    fn cuts_with(&self, other: &Self) -> usize {
        let mut cuts = 0;
        self.tree().pairs_with(other.tree(), &mut |i, j| {
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

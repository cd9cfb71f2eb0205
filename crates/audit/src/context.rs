//! The data that all stages of the audit of a part share, computed before faces and shells are checked.

use crate::edges::EdgeAudit;
use crate::precision::{AIM, CHARGED};
use crate::report::{AuditOptions, Claim};
use chordal_brep::{FaceGeometry, Part};
use chordal_mesh::PartMesh;

/// The data that all faces of a part share.
pub(crate) struct Context<'a> {
    pub part: &'a Part,
    pub mesh: &'a PartMesh,
    pub options: &'a AuditOptions,
    pub claims: Option<&'a [Claim]>,
    /// The largest coordinate of the mesh.
    pub scale: f64,
    /// Points nearer together may be one vertex: the end rows of a surface at a pole.
    pub same_point: f64,
    /// The position of each vertex of the part, where it has one.
    pub vertex_at: Vec<Option<u32>>,
    pub edges: Vec<EdgeAudit>,
}

impl Context<'_> {
    /// A point may be off by this much and is charged for it; by more, and it is misplaced.
    pub fn allowed(&self) -> f64 {
        CHARGED * self.options.tolerance + self.options.coordinate_rounding
    }

    /// Bounds of a facet that need not be tightened further: a little under the tolerance, and the claimed
    /// error of the face.
    pub fn enough(&self, face: usize) -> (f64, f64) {
        let tolerance = self.options.tolerance;
        let claimed = self.claim(face).map_or(tolerance, |c| c.proven_error);
        let claimed =
            if claimed.is_finite() { claimed.clamp(0.01 * tolerance, tolerance) } else { tolerance };
        (AIM * tolerance, claimed)
    }

    /// The error that a simple bound must confirm: the one claimed for the face, else the tolerance.
    pub fn to_confirm(&self, face: usize) -> f64 {
        let tolerance = self.options.tolerance;
        let claimed = self.claim(face).map(|c| c.proven_error).filter(|e| e.is_finite());
        claimed.map_or(AIM * tolerance, |claimed| claimed.min(tolerance))
    }

    pub fn claim(&self, face: usize) -> Option<Claim> {
        self.claims.and_then(|claims| claims.get(face)).copied()
    }

    /// The file or the mesher reports that this face has no triangles.
    pub fn known_missing(&self, face: usize) -> bool {
        matches!(self.part.faces[face].geometry, FaceGeometry::Failed(_))
            || self.claim(face).is_some_and(|c| c.missing)
    }

    /// A length of the part in millimetres, as issues state them.
    pub fn mm(&self, length: f64) -> f64 {
        length * self.options.millimetres
    }
}

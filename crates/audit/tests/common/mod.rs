//! Corpus models, read and meshed.

#![allow(dead_code, clippy::unwrap_used)]

use chordal_audit::{AuditOptions, Claim, PartAudit, audit_part};
use chordal_brep::{FaceGeometry, Model, Part};
use chordal_mesh::PartMesh;
use chordal_nurbs::{Box3, DVec2};
use chordal_tessellate::{Cancel, Options, PartReport, tessellate_part};
use std::path::{Path, PathBuf};

pub fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus")
}

/// The names of all models of the corpus that are meant to be read, sorted.
pub fn names() -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(corpus())
        .unwrap()
        .filter_map(|entry| {
            let name = entry.unwrap().file_name().into_string().unwrap();
            name.strip_suffix(".step").map(str::to_owned)
        })
        .collect();
    names.sort();
    assert!(names.len() > 50, "the corpus is not complete");
    names
}

pub fn load(name: &str) -> Model {
    chordal_read::read_file(corpus().join(format!("{name}.step")), &chordal_read::ReadOptions::default())
        .unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// The diagonal of the box of a part's edges, or of its surfaces where they have no edges.
pub fn diagonal(part: &Part) -> f64 {
    let mut found = Box3::EMPTY;
    for edge in &part.edges {
        if let Some(curve) = &edge.curve {
            found = found.union(curve.bbox(edge.range));
        }
    }
    found = part.vertices.iter().fold(found, |b, v| b.including(v.point));
    for face in &part.faces {
        let FaceGeometry::Surface(surface) = &face.geometry else { continue };
        let domain = surface.domain();
        if domain.is_finite() && face.loops.is_empty() {
            for i in 0..9 {
                for j in 0..9 {
                    let at = DVec2::new(f64::from(i) / 8.0, f64::from(j) / 8.0);
                    found = found.including(surface.point(domain.min + domain.size() * at));
                }
            }
        }
    }
    found.diagonal()
}

pub fn mesh(part: &Part, tolerance: f64, angle: Option<f64>) -> (PartMesh, PartReport) {
    let options =
        Options::new(tolerance).with_angle(angle).with_face_timeout(Some(std::time::Duration::from_secs(60)));
    tessellate_part(part, &options, &Cancel::default(), &|_| {})
}

pub fn claims(report: &PartReport) -> Vec<Claim> {
    let claim = |f: &chordal_tessellate::FaceReport| Claim {
        proven_error: f.proven_error,
        gap: f.gap,
        missing: f.failed.is_some() || f.zero_area,
        needless: f.zero_area,
    };
    report.faces.iter().map(claim).collect()
}

pub fn audit(part: &Part, mesh: &PartMesh, report: &PartReport, tolerance: f64) -> PartAudit {
    let part = report.healed.as_deref().unwrap_or(part);
    audit_part(part, mesh, &AuditOptions::new(tolerance), Some(&claims(report)))
}

//! Checks a mesh file of any program.

use super::against::{AgainstReport, measure_against};
use crate::edge_count::EdgeCount;
use crate::error::{Error, FileError};
use crate::options::MeshOptions;
use chordal_mesh::{TriangleSoup, import_mesh};
use chordal_write::Unit;
use glam::DVec3;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::Path;

/// The name and version of the schema of [`CheckReport`].
pub const CHECK_SCHEMA: &str = "chordal-check/1";

/// What was found. Points are one where all bits of their coordinates agree, within one object of the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CheckReport {
    /// [`CHECK_SCHEMA`].
    pub schema: String,
    /// The path of the file.
    pub path: String,
    /// How many triangles.
    pub triangles: usize,
    /// How many vertices.
    pub vertices: usize,
    /// No edge has a single triangle.
    pub closed: bool,
    /// The triangles of every edge run in opposite directions, in pairs.
    pub oriented: bool,
    /// Edges with one triangle.
    pub open_edges: usize,
    /// Edges whose triangles do not pair up in opposite directions.
    pub inconsistent_edges: usize,
    /// Triangles with two corners in one place, or with all three on a line.
    pub degenerate_triangles: usize,
    /// Triangles over the same three vertices as an earlier one.
    pub duplicate_triangles: usize,
    /// In cubic millimetres; only of a closed and oriented mesh. Negative: inside out.
    pub volume: Option<f64>,
    /// The comparison with a CAD model, if requested.
    pub against: Option<AgainstReport>,
}

impl CheckReport {
    /// Nothing is wrong.
    pub fn clean(&self) -> bool {
        self.closed
            && self.oriented
            && self.degenerate_triangles == 0
            && self.duplicate_triangles == 0
            && self.volume.is_none_or(|v| v >= 0.0)
    }

    /// As JSON, with a line break at the end.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a report has string keys only") + "\n"
    }
}

/// Checks a mesh file; `unit` is that of its coordinates where it states none or states it wrongly. `against`
/// names a CAD file to compare it with, by a fine mesh with these options.
///
/// # Errors
/// Where a file cannot be read.
pub fn check_mesh(
    path: &Path,
    unit: Option<Unit>,
    against: Option<(&Path, &MeshOptions)>,
) -> Result<CheckReport, Error> {
    let mut soup =
        import_mesh(path).map_err(|e| Error::file(&path.display().to_string(), FileError::Mesh(e)))?;
    soup.unit_mm = unit.map(Unit::millimetres).or(soup.unit_mm);
    let soup = soup.into_millimetres_z_up();
    let edges = EdgeCount::of(soup.triangles.iter().copied());
    let (closed, oriented) = (edges.open == 0, edges.inconsistent == 0);
    Ok(CheckReport {
        schema: CHECK_SCHEMA.into(),
        path: path.display().to_string(),
        triangles: soup.triangles.len(),
        vertices: soup.positions.len(),
        closed,
        oriented,
        open_edges: edges.open,
        inconsistent_edges: edges.inconsistent,
        degenerate_triangles: soup.triangles.iter().filter(|t| is_degenerate(&soup, **t)).count(),
        duplicate_triangles: duplicates(&soup),
        volume: (closed && oriented).then(|| volume(&soup)),
        against: against.map(|(input, options)| measure_against(&soup, input, options)).transpose()?,
    })
}

fn corners(soup: &TriangleSoup, triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|i| soup.positions[i as usize])
}

fn is_degenerate(soup: &TriangleSoup, triangle: [u32; 3]) -> bool {
    let [a, b, c] = corners(soup, triangle);
    (b - a).cross(c - a).length_squared() == 0.0
}

fn duplicates(soup: &TriangleSoup) -> usize {
    let mut seen = BTreeSet::new();
    let sorted = soup.triangles.iter().map(|t| {
        let mut t = *t;
        t.sort_unstable();
        t
    });
    sorted.filter(|t| !seen.insert(*t)).count()
}

fn volume(soup: &TriangleSoup) -> f64 {
    // About a point of the mesh, so that a mesh far from the origin keeps its digits.
    let origin = soup.positions.first().copied().unwrap_or_default();
    let six = |t: &[u32; 3]| {
        let [a, b, c] = corners(soup, *t).map(|p| p - origin);
        a.dot(b.cross(c))
    };
    soup.triangles.iter().map(six).sum::<f64>() / 6.0
}

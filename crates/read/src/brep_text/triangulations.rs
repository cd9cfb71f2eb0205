//! Triangulations: used only for faces that have no surface.

use super::curves::{Parsed, point};
use super::tokens::Tokens;
use chordal_brep::ReadIssue;
use chordal_nurbs::DVec3;

/// Triangles in the coordinates of their face.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Triangulation {
    pub points: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// One per point, or none.
    pub normals: Vec<DVec3>,
}

/// One triangulation.
pub(crate) fn triangulation(tokens: &mut Tokens<'_>, version: u32) -> Parsed<Triangulation> {
    let (nodes, count) = (tokens.count()?, tokens.count()?);
    let has_uv = tokens.flag()?;
    let has_normals = version >= 3 && tokens.flag()?;
    tokens.real()?;
    let mut read = Triangulation::default();
    for _ in 0..nodes {
        read.points.push(point(tokens)?);
    }
    if has_uv {
        for _ in 0..nodes.saturating_mul(2) {
            tokens.real()?;
        }
    }
    let mut bad = None;
    for _ in 0..count {
        let corners = [tokens.integer()?, tokens.integer()?, tokens.integer()?];
        if let Some(corner) = corners.iter().find(|&&c| c < 1 || c as u64 > nodes as u64) {
            bad = Some(ReadIssue::NotFound { what: "corner", number: *corner });
        } else {
            read.triangles.push(corners.map(|c| (c - 1) as u32));
        }
    }
    if has_normals {
        for _ in 0..nodes {
            read.normals.push(point(tokens)?);
        }
    }
    if read.points.iter().chain(&read.normals).any(|p| !p.is_finite()) {
        bad = Some(ReadIssue::NotFinite { what: "point of a triangulation" });
    }
    Ok(bad.map_or(Ok(read), Err))
}

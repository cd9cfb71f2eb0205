//! Meshes: they pass through as they are.

use super::bytes::{ANONYMOUS, Bytes, Res};
use crate::polygons::triangulate;
use crate::trimmed::Look;
use chordal_brep::{ReadIssue, Real, TessellatedItem};
use chordal_nurbs::DVec3;
use flate2::read::ZlibDecoder;
use std::borrow::Cow;
use std::io::Read;

/// Reads the data of a mesh.
pub(super) fn mesh(mut data: Bytes, look: &Look) -> Res<TessellatedItem> {
    let (major, minor) = data.version()?;
    if !matches!(major, 1 | 3) {
        return Err(ReadIssue::UnsupportedVersion {
            what: "a mesh",
            major: major.into(),
            minor: minor.into(),
        });
    }
    let (vertices, faces) = (data.i32()?, data.i32()?);
    // Ranges of textures and of the surface, scales, boxes, whether it is closed.
    data.take(64 + 16 + 64 + 4)?;
    // How it was made, and four statistics of curvature.
    for _ in 0..5 {
        if data.u8()? != 0 {
            data.chunk()?;
        }
    }
    let corners = corners(&mut data, faces)?;
    let size = usize::try_from(vertices).ok().and_then(|count| count.checked_mul(12));
    let size =
        size.ok_or(ReadIssue::BadValue { what: "number of vertices", value: Real(vertices as f64) })?;
    let bytes = if major == 1 {
        let count = data.count(12)?;
        Cow::Borrowed(data.take(12 * count)?)
    } else {
        buffer(&mut data)?
    };
    if bytes.len() != size {
        return Err(ReadIssue::Count { what: "bytes of vertices", found: bytes.len(), expected: size });
    }
    let mut coordinates = Bytes::new(&bytes, data.version);
    let mut points = Vec::with_capacity(size / 12);
    while !coordinates.is_empty() {
        let mut next = || coordinates.f32().map(f64::from);
        points.push(DVec3::new(next()?, next()?, next()?));
    }
    let mut triangles = Vec::new();
    for face in corners.chunks_exact(4) {
        if face.iter().any(|&corner| !points.get(corner as usize).is_some_and(|p| p.is_finite())) {
            return Err(ReadIssue::PolygonsLost { polygons: 1 });
        }
        triangulate(&points, if face[2] == face[3] { &face[..3] } else { face }, &mut triangles);
    }
    let (name, color, source) = (look.name.clone(), look.color, look.source);
    Ok(TessellatedItem { name, points, triangles, normals: Vec::new(), color, source })
}

/// Four corners for each face, the last two equal in triangles; in 1, 2 or 4 bytes each.
fn corners(data: &mut Bytes, faces: i32) -> Res<Vec<u32>> {
    let width = data.i32()?;
    let count = usize::try_from(faces).ok().filter(|&count| count <= data.len() / 4);
    let count =
        4 * count.ok_or(ReadIssue::BadValue { what: "number of faces", value: Real(faces as f64) })?;
    match width {
        1 => (0..count).map(|_| data.u8().map(u32::from)).collect(),
        2 => (0..count).map(|_| data.u16().map(u32::from)).collect(),
        4 => (0..count).map(|_| data.u32()).collect(),
        _ => Err(ReadIssue::BadValue { what: "corner width (bytes)", value: Real(width as f64) }),
    }
}

/// A buffer, compressed or not.
fn buffer<'a>(data: &mut Bytes<'a>) -> Res<Cow<'a, [u8]>> {
    let size = data.u32()? as usize;
    if size == 0 {
        return Ok(Cow::Borrowed(&[]));
    }
    // A checksum.
    data.u32()?;
    match data.u8()? {
        0 => data.take(size).map(Cow::Borrowed),
        1 => {
            let mut packed = data.chunk_of(ANONYMOUS)?;
            let packed = packed.take(packed.len())?;
            let mut unpacked = Vec::new();
            // One byte more than stated shows a buffer that is too long; what is stated too high costs
            // nothing.
            let mut decoder = ZlibDecoder::new(packed).take(size as u64 + 1);
            decoder
                .read_to_end(&mut unpacked)
                .map_err(|e| ReadIssue::TextBroken { reason: e.to_string() })?;
            Ok(Cow::Owned(unpacked))
        }
        method => Err(ReadIssue::BadValue { what: "compression method", value: Real(method as f64) }),
    }
}

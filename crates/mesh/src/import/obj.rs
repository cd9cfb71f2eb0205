//! OBJ: positions, faces and objects. Normals, texture coordinates and materials are skipped; polygons become
//! fans.

use super::bytes::{Cursor, number, text, words};
use super::error::{Fault, ImportFault, ImportPlace};
use super::weld::Builder;
use glam::DVec3;

pub(super) fn read(bytes: &[u8], builder: &mut Builder) -> Result<(), Fault> {
    let mut points: Vec<DVec3> = Vec::new();
    let mut corners: Vec<u32> = Vec::new();
    for (number, line) in logical_lines(bytes) {
        statement(&line, &mut points, &mut corners, builder)
            .map_err(|fault| Fault::from(fault).at(ImportPlace::Line(number)))?;
    }
    Ok(())
}

fn statement(
    line: &[u8],
    points: &mut Vec<DVec3>,
    corners: &mut Vec<u32>,
    builder: &mut Builder,
) -> Result<(), ImportFault> {
    let mut words = words(line);
    match words.next() {
        Some(b"v") => {
            let mut next = || words.next().and_then(number);
            let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
                return Err(ImportFault::Vertex);
            };
            points.push(DVec3::new(x, y, z));
        }
        Some(b"o") => builder.group(&text(&line.trim_ascii_start()[1..])),
        Some(b"f") => {
            corners.clear();
            for word in words {
                let point = vertex(word, points).ok_or_else(|| ImportFault::UnknownVertex {
                    vertex: text(word),
                    vertices: points.len(),
                })?;
                corners.push(builder.point(point)?);
            }
            if corners.len() < 3 {
                return Err(ImportFault::Corners { corners: corners.len() });
            }
            for i in 1..corners.len() - 1 {
                builder.triangle([corners[0], corners[i], corners[i + 1]]);
            }
        }
        _ => {}
    }
    Ok(())
}

/// The point of `v`, `v/vt`, `v//vn` or `v/vt/vn`: counted from 1, or back from the last where negative.
fn vertex(word: &[u8], points: &[DVec3]) -> Option<DVec3> {
    let digits = word.split(|&b| b == b'/').next()?;
    let index: i64 = std::str::from_utf8(digits).ok()?.parse().ok()?;
    let index = if index < 0 { points.len() as i64 + index } else { index - 1 };
    points.get(usize::try_from(index).ok()?).copied()
}

/// Lines with the number of the first of each, counted from 1; those that end in a backslash are joined with
/// the next.
fn logical_lines(bytes: &[u8]) -> impl Iterator<Item = (usize, std::borrow::Cow<'_, [u8]>)> {
    let mut cursor = Cursor { rest: bytes };
    let mut read = 0;
    std::iter::from_fn(move || {
        let line = cursor.line()?;
        read += 1;
        let first = read;
        if !line.ends_with(b"\\") {
            return Some((first, line.into()));
        }
        let mut joined = line[..line.len() - 1].to_vec();
        while let Some(more) = cursor.line() {
            read += 1;
            joined.push(b' ');
            joined.extend_from_slice(more.strip_suffix(b"\\").unwrap_or(more));
            if !more.ends_with(b"\\") {
                break;
            }
        }
        Some((first, joined.into()))
    })
}

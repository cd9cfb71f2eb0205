//! OBJ: positions, faces and objects. Normals, texture coordinates and materials are skipped; polygons become fans.

use super::bytes::{Cursor, number, text, words};
use super::weld::Builder;
use glam::DVec3;

pub(super) fn read(bytes: &[u8], builder: &mut Builder) -> Result<(), String> {
    let mut points: Vec<DVec3> = Vec::new();
    let mut corners: Vec<u32> = Vec::new();
    for (index, line) in logical_lines(bytes).enumerate() {
        let error = |what: &str| format!("statement {}: {what}", index + 1);
        let mut words = words(&line);
        match words.next() {
            Some(b"v") => {
                let mut next = || words.next().and_then(number);
                let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
                    return Err(error("a vertex without three numbers"));
                };
                points.push(DVec3::new(x, y, z));
            }
            Some(b"o") => builder.group(&text(&line.trim_ascii_start()[1..])),
            Some(b"f") => {
                corners.clear();
                for word in words {
                    let point = vertex(word, &points).ok_or_else(|| error("a face refers to no vertex"))?;
                    corners.push(builder.point(point)?);
                }
                if corners.len() < 3 {
                    return Err(error("a face has fewer than three corners"));
                }
                for i in 1..corners.len() - 1 {
                    builder.triangle([corners[0], corners[i], corners[i + 1]]);
                }
            }
            _ => {}
        }
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

/// Lines, those that end in a backslash joined with the next.
fn logical_lines(bytes: &[u8]) -> impl Iterator<Item = std::borrow::Cow<'_, [u8]>> {
    let mut cursor = Cursor { rest: bytes };
    std::iter::from_fn(move || {
        let line = cursor.line()?;
        if !line.ends_with(b"\\") {
            return Some(line.into());
        }
        let mut joined = line[..line.len() - 1].to_vec();
        while let Some(more) = cursor.line() {
            joined.push(b' ');
            joined.extend_from_slice(more.strip_suffix(b"\\").unwrap_or(more));
            if !more.ends_with(b"\\") {
                break;
            }
        }
        Some(joined.into())
    })
}

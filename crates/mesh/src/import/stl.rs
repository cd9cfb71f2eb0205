//! STL, binary and ASCII. Normals are ignored: the order of the corners gives the same direction.

use super::bytes::{Cursor, number, text, words};
use super::error::{Fault, ImportFault, ImportPlace};
use super::weld::Builder;
use glam::DVec3;

/// Header and count before the triangles of a binary file, and one triangle.
const HEADER: usize = 84;
const RECORD: usize = 50;

pub(super) fn read(bytes: &[u8], builder: &mut Builder) -> Result<(), Fault> {
    // Binary files may start with `solid` too, so the length decides where it fits exactly.
    let stated = bytes.get(80..HEADER).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    let exact = stated.is_some_and(|n| n as u64 * RECORD as u64 + HEADER as u64 == bytes.len() as u64);
    let starts_solid = bytes.trim_ascii_start().get(..5).is_some_and(|b| b.eq_ignore_ascii_case(b"solid"));
    match stated {
        _ if starts_solid && !exact => read_ascii(bytes, builder),
        Some(count) => read_binary(&bytes[HEADER..], count, builder),
        None => Err(ImportFault::EndsInside { what: "header" }.into()),
    }
}

fn read_binary(bytes: &[u8], count: u32, builder: &mut Builder) -> Result<(), Fault> {
    let held = bytes.len() / RECORD;
    if count as usize > held {
        return Err(ImportFault::Count {
            what: "triangles".to_owned(),
            stated: count.into(),
            held: Some(held as u64),
        }
        .into());
    }
    for (index, record) in bytes.chunks_exact(RECORD).take(count as usize).enumerate() {
        let coordinate = |i: usize| {
            let bytes = [record[i], record[i + 1], record[i + 2], record[i + 3]];
            f64::from(f32::from_le_bytes(bytes))
        };
        let corner = |i: usize| DVec3::new(coordinate(i), coordinate(i + 4), coordinate(i + 8));
        let mut point = |i: usize| {
            let place = ImportPlace::Byte(HEADER + RECORD * index + i);
            builder.point(corner(i)).map_err(|fault| Fault::from(fault).at(place))
        };
        let corners = [point(12)?, point(24)?, point(36)?];
        builder.triangle(corners);
    }
    Ok(())
}

fn read_ascii(bytes: &[u8], builder: &mut Builder) -> Result<(), Fault> {
    let mut cursor = Cursor { rest: bytes };
    let mut corners: Vec<u32> = Vec::new();
    let mut number = 0;
    while let Some(line) = cursor.line() {
        number += 1;
        statement(line.trim_ascii(), &mut corners, builder)
            .map_err(|fault| Fault::from(fault).at(ImportPlace::Line(number)))?;
    }
    if corners.is_empty() { Ok(()) } else { Err(ImportFault::EndsInside { what: "loop" }.into()) }
}

/// One line of an ASCII file; `corners` are those of the present loop.
fn statement(line: &[u8], corners: &mut Vec<u32>, builder: &mut Builder) -> Result<(), ImportFault> {
    let mut words = words(line);
    match words.next().map(<[u8]>::to_ascii_lowercase).as_deref() {
        Some(b"solid") => builder.group(&text(&line[5..])),
        Some(b"vertex") => {
            let mut next = || words.next().and_then(number);
            let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
                return Err(ImportFault::Vertex);
            };
            corners.push(builder.point(DVec3::new(x, y, z))?);
        }
        Some(b"endloop") => {
            let corners: [u32; 3] = std::mem::take(corners)
                .try_into()
                .map_err(|c: Vec<u32>| ImportFault::Corners { corners: c.len() })?;
            builder.triangle(corners);
        }
        _ => {}
    }
    Ok(())
}

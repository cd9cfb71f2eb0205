//! STL, binary and ASCII. Normals are ignored: the order of the corners says the same.

use super::bytes::{Cursor, number, text, words};
use super::weld::Builder;
use glam::DVec3;

/// Header and count before the triangles of a binary file, and one triangle.
const HEADER: usize = 84;
const RECORD: usize = 50;

pub(super) fn read(bytes: &[u8], builder: &mut Builder) -> Result<(), String> {
    // Binary files may start with `solid` too, so the length decides where it fits exactly.
    let stated = bytes.get(80..HEADER).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    let exact = stated.is_some_and(|n| n as u64 * RECORD as u64 + HEADER as u64 == bytes.len() as u64);
    let starts_solid = bytes.trim_ascii_start().get(..5).is_some_and(|b| b.eq_ignore_ascii_case(b"solid"));
    match stated {
        _ if starts_solid && !exact => read_ascii(bytes, builder),
        Some(count) => read_binary(&bytes[HEADER..], count, builder),
        None => Err(format!("it has only {} bytes", bytes.len())),
    }
}

fn read_binary(bytes: &[u8], count: u32, builder: &mut Builder) -> Result<(), String> {
    let held = bytes.len() / RECORD;
    if count as usize > held {
        return Err(format!("its header promises {count} triangles but it holds {held}"));
    }
    for record in bytes.chunks_exact(RECORD).take(count as usize) {
        let coordinate = |i: usize| {
            let bytes = [record[i], record[i + 1], record[i + 2], record[i + 3]];
            f64::from(f32::from_le_bytes(bytes))
        };
        let corner = |i: usize| DVec3::new(coordinate(i), coordinate(i + 4), coordinate(i + 8));
        let corners = [builder.point(corner(12))?, builder.point(corner(24))?, builder.point(corner(36))?];
        builder.triangle(corners);
    }
    Ok(())
}

fn read_ascii(bytes: &[u8], builder: &mut Builder) -> Result<(), String> {
    let mut cursor = Cursor { rest: bytes };
    let mut corners: Vec<u32> = Vec::new();
    let mut line_number = 0_usize;
    while let Some(line) = cursor.line() {
        line_number += 1;
        let line = line.trim_ascii();
        let mut words = words(line);
        match words.next().map(<[u8]>::to_ascii_lowercase).as_deref() {
            Some(b"solid") => builder.group(&text(&line[5..])),
            Some(b"vertex") => {
                let mut next = || words.next().and_then(number);
                let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
                    return Err(format!("line {line_number} is no vertex"));
                };
                corners.push(builder.point(DVec3::new(x, y, z))?);
            }
            Some(b"endloop") => {
                let corners: [u32; 3] = std::mem::take(&mut corners).try_into().map_err(|c: Vec<u32>| {
                    format!("the loop that ends in line {line_number} has {} corners", c.len())
                })?;
                builder.triangle(corners);
            }
            _ => {}
        }
    }
    if corners.is_empty() { Ok(()) } else { Err("it ends inside a loop".to_owned()) }
}

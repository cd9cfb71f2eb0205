//! Version 1: objects stand at the top of the file, each a shell or a face of trimmed spline surfaces.
//!
//! A trim has its own curves and knows by number which trims are glued to it. The numbers are not followed:
//! every face becomes an island, and sewing joins what meets.

use super::bytes::{Bytes, Res};
use super::curves::completed;
use super::tables::length_unit;
use crate::Winding;
use crate::assemble::Notes;
use crate::flat::LengthUnit;
use crate::trimmed::{Look, Piece, Role, TrimLoop, add_body, add_faces, add_failed};
use chordal_brep::{BodyKind, FaceId, LooseItem, LooseKind, Part, ReadIssue, Real, Source};
use chordal_nurbs::{Curve2, DVec3, NurbsCurve, NurbsCurve3, NurbsSurface, Surface};
use std::sync::Arc;

const SHELL: u32 = 0x0001_0003;
const FACE: u32 = 0x0001_0004;
const LOOP: u32 = 0x0001_0005;
const TRIM: u32 = 0x0001_0006;
const SURFACE: u32 = 0x0001_0007;
const CURVE: u32 = 0x0001_0008;
const SPLINE: u32 = 0x0001_0009;
/// What the contents of each of these stand in.
const STUFF: u32 = 0x0000_0100;
const POINT: u32 = 0x0010_0001;
const MESH: u32 = 0x0010_0015;
const UNITS: u32 = 0x0200_0010;
/// Objects that other programs wrote with the first toolkit.
const TOOLKIT: std::ops::RangeInclusive<u32> = 0x0002_0008..=0x0002_000b;
const END_OF_FILE: u32 = 0x0000_7fff;

/// Reads all objects of a file into a part; its unit.
pub(super) fn read(mut file: Bytes, whole: &[u8], part: &mut Part, notes: &Notes) -> LengthUnit {
    let mut unit = LengthUnit::unstated();
    while !file.is_empty() {
        let source = Source { entity: file.place_in(whole), line: 0 };
        let look = Look { source, ..Look::default() };
        let chunk = match file.chunk() {
            Ok(chunk) => chunk,
            Err(why) => {
                notes.lose(source, ReadIssue::Damaged { what: "the archive", cause: why.boxed() });
                break;
            }
        };
        match chunk.code {
            END_OF_FILE => break,
            SHELL => shell(chunk.body, part, &look, notes),
            FACE => {
                let faces = face(chunk.body, part, &look, notes);
                add_body(part, faces, BodyKind::Sheet, &look);
            }
            CURVE | SPLINE => loose(part, LooseKind::Wire, source),
            POINT => loose(part, LooseKind::Point, source),
            MESH => notes.lose(source, ReadIssue::Unsupported { what: "mesh of a version 1 file".into() }),
            code if TOOLKIT.contains(&code) => {
                notes.lose(source, ReadIssue::Unsupported { what: "object of the first toolkit".into() });
            }
            UNITS => unit = units(chunk.body).unwrap_or(unit),
            _ => {}
        }
    }
    unit
}

fn loose(part: &mut Part, kind: LooseKind, source: Source) {
    part.loose.push(LooseItem { kind, name: String::new(), source });
}

fn units(mut data: Bytes) -> Res<LengthUnit> {
    data.i32()?;
    Ok(length_unit(data.i32()?, None))
}

/// The contents of an object, which stand in a chunk among others.
fn stuff<'a>(mut body: Bytes<'a>, of: u32) -> Res<Bytes<'a>> {
    while !body.is_empty() {
        let chunk = body.chunk()?;
        if chunk.code == of | STUFF {
            return Ok(chunk.body);
        }
    }
    Err(ReadIssue::Missing { what: "content of an object" })
}

fn shell(body: Bytes, part: &mut Part, look: &Look, notes: &Notes) {
    let faces = stuff(body, SHELL).and_then(|mut data| {
        data.i32()?;
        let count = data.i32()?;
        // A box.
        data.take(48)?;
        let glue = data.count(2)?;
        data.take(2 * glue)?;
        let mut faces = Vec::new();
        for _ in 0..count.max(0) {
            match data.chunk_of(FACE) {
                Ok(body) => faces.extend(face(body, part, look, notes)),
                Err(why) => {
                    notes.lose(
                        look.source,
                        ReadIssue::Damaged { what: "the list of faces", cause: why.boxed() },
                    );
                    break;
                }
            }
        }
        Ok(faces)
    });
    let faces = faces.unwrap_or_else(|why| vec![add_failed(part, why, look)]);
    add_body(part, faces, BodyKind::Sheet, look);
}

fn face(body: Bytes, part: &mut Part, look: &Look, notes: &Notes) -> Vec<FaceId> {
    match trimmed(body) {
        Ok((surface, trims, flipped)) => {
            let trims: Vec<TrimLoop> =
                trims.into_iter().map(|trim| TrimLoop { source: look.source, ..trim }).collect();
            let look = Look { flipped, ..look.clone() };

            add_faces(part, &Arc::new(Surface::Nurbs(surface)), &trims, &look, notes)
        }
        Err(why) => vec![add_failed(part, why, look)],
    }
}

fn trimmed(body: Bytes) -> Res<(NurbsSurface, Vec<TrimLoop>, bool)> {
    let mut data = stuff(body, FACE)?;
    let reversed = data.i32()? != 0;
    data.i32()?;
    let loops = data.i32()? / 2;
    // A box.
    data.take(48)?;
    let seams = data.count(2)?;
    data.take(2 * seams)?;
    let surface = surface(stuff(data.chunk_of(SURFACE)?, SURFACE)?)?;
    let trims = (0..loops).map(|_| boundary(stuff(data.chunk_of(LOOP)?, LOOP)?)).collect::<Res<_>>()?;
    Ok((surface, trims, reversed))
}

fn boundary(mut data: Bytes) -> Res<TrimLoop> {
    let trims = data.i32()?;
    let role = match data.i32()? {
        0 => Role::Outer,
        1 => Role::Hole,
        _ => Role::ByNesting(Winding::Odd),
    };
    // A box of parameter space.
    data.take(32)?;
    let mut pieces = Vec::new();
    for _ in 0..trims.max(0) {
        let mut trim = stuff(data.chunk_of(TRIM)?, TRIM)?;
        // Flags, orientation, continuity, monotony and tolerances.
        trim.take(1 + 12 + 16)?;
        for spline in curve(stuff(trim.chunk_of(CURVE)?, CURVE)?)? {
            pieces.push(Piece::whole(Curve2::Nurbs(spline.mapped(DVec3::truncate))));
        }
    }
    Ok(TrimLoop { pieces, role, source: Source::default() })
}

fn curve(mut data: Bytes) -> Res<Vec<NurbsCurve3>> {
    let dimension = dimension(data.u8()?)?;
    data.u8()?;
    let count = data.u16()?;
    // A box.
    data.take(16 * dimension)?;
    (0..count).map(|_| spline(stuff(data.chunk_of(SPLINE)?, SPLINE)?)).collect()
}

fn dimension(byte: u8) -> Res<usize> {
    if matches!(byte, 2 | 3) {
        Ok(usize::from(byte))
    } else {
        Err(ReadIssue::BadValue { what: "curve dimension", value: Real(f64::from(byte)) })
    }
}

fn spline(mut data: Bytes) -> Res<NurbsCurve3> {
    let dimension = dimension(data.u8()?)?;
    let rational = data.u8()?;
    let order = usize::from(data.u8()?);
    let count = usize::from(data.u16()?);
    // Whether it is closed, and its form; a box.
    data.take(2 + 16 * dimension)?;
    if order < 2 || count < order {
        return Err(ReadIssue::TooFew { what: "control points", found: count, least: order });
    }
    let knots = knots(&mut data, order, count)?;
    let (points, weights) = control_points(&mut data, count, dimension, rational)?;
    NurbsCurve::new(order - 1, completed(knots), points, weights).map_err(ReadIssue::from)
}

/// Knots of which a clamped end is written once.
fn knots(data: &mut Bytes, order: usize, count: usize) -> Res<Vec<f64>> {
    let clamped = if order > 2 { data.u8()? } else { 0 };
    let all = order + count - 2;
    let first = data.f64()?;
    let mut knots = vec![first; if clamped & 1 != 0 { order - 1 } else { 1 }];
    while knots.len() < count {
        knots.push(data.f64()?);
    }
    let last = knots[knots.len() - 1];
    while knots.len() < all {
        knots.push(if clamped & 2 != 0 { last } else { data.f64()? });
    }
    if order == 2 && count == 2 && knots[0] > knots[1] {
        // Lines were once written backwards.
        knots = vec![-knots[0], -knots[1]];
    }
    Ok(knots)
}

/// `rational` is 0 without weights, 1 for plain points, 2 for points multiplied by their weights.
fn control_points(
    data: &mut Bytes,
    count: usize,
    dimension: usize,
    rational: u8,
) -> Res<(Vec<DVec3>, Option<Vec<f64>>)> {
    let mut points = Vec::with_capacity(count.min(data.len() / 16));
    let mut weights = Vec::new();
    for _ in 0..count {
        let p = DVec3::new(data.f64()?, data.f64()?, if dimension == 3 { data.f64()? } else { 0.0 });
        let weight = if rational == 0 { 1.0 } else { data.f64()? };
        weights.push(weight);
        points.push(if rational == 2 { p / weight } else { p });
    }
    Ok((points, (rational != 0).then_some(weights)))
}

fn surface(mut data: Bytes) -> Res<NurbsSurface> {
    let dimension = dimension(data.u8()?)?;
    data.u8()?;
    let degree = [usize::from(data.u8()?), usize::from(data.u8()?)];
    let count = [degree[0] + usize::from(data.u16()?), degree[1] + usize::from(data.u16()?)];
    let rational = [data.u8()?, data.u8()?];
    // Closed, singular; a box.
    data.take(4 + 16 * dimension)?;
    if degree.contains(&0) {
        return Err(ReadIssue::BadValue { what: "degree", value: Real(0.0) });
    }
    let knots_u = completed(data.f64s(degree[0] + count[0] - 1)?);
    let knots_v = completed(data.f64s(degree[1] + count[1] - 1)?);
    let rational = if rational[1] != 0 { rational[1] } else { rational[0] };
    let (points, weights) = control_points(&mut data, count[0] * count[1], dimension, rational)?;
    NurbsSurface::new(degree, knots_u, knots_v, points, weights).map_err(ReadIssue::from)
}

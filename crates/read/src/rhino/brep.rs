//! A boundary representation as the archive holds it: lists that refer to each other by position.

use super::bytes::{ANONYMOUS, Bytes, Res};
use super::curves::{RhinoCurve, bare_polycurve, curve_object};
use super::surfaces::{RhinoSurface, nurbs_surface, surface_object};
use chordal_brep::{Color, ReadIssue};
use chordal_nurbs::{DVec3, Range};

/// Archives of an earlier openNURBS give edges and trims no domain of their own.
const DOMAINS_SINCE: u32 = 200_206_180;

/// A use of a curve: over a part of it, perhaps backwards.
#[derive(Clone, Debug)]
pub(super) struct CurveUse {
    /// `None`: as a whole.
    pub range: Option<Range>,
    pub reversed: bool,
}

#[derive(Clone, Debug)]
pub(super) struct RawEdge {
    pub curve: i32,
    pub proxy: CurveUse,
    pub vertices: [i32; 2],
}

#[derive(Clone, Debug)]
pub(super) struct RawTrim {
    pub curve: i32,
    pub proxy: CurveUse,
    /// Negative: the trim is a single point in space.
    pub edge: i32,
    pub vertices: [i32; 2],
    /// The trim runs against its edge.
    pub against: bool,
}

#[derive(Clone, Debug)]
pub(super) struct RawLoop {
    pub trims: Vec<i32>,
    /// 1 outer, 2 inner, 3 slit; 4 and 5 are curves and points on the face.
    pub kind: i32,
}

#[derive(Clone, Debug)]
pub(super) struct RawFace {
    pub loops: Vec<i32>,
    pub surface: i32,
    pub reversed: bool,
    pub color: Option<Color>,
}

/// The lists of a boundary representation. An invalid curve or surface has an entry with the reason.
#[derive(Clone, Debug, Default)]
pub(super) struct RawBrep {
    pub curves_2d: Vec<Res<RhinoCurve>>,
    pub curves: Vec<Res<RhinoCurve>>,
    pub surfaces: Vec<Res<RhinoSurface>>,
    /// Without vertices (Rhino 2), they follow from the ends of the trims.
    pub vertices: Vec<DVec3>,
    pub edges: Vec<RawEdge>,
    pub trims: Vec<RawTrim>,
    pub loops: Vec<RawLoop>,
    pub faces: Vec<RawFace>,
    /// 0 open, 1 closed with normals outwards, 2 closed with normals inwards.
    pub solid: i32,
}

/// Reads the data of a boundary representation; `opennurbs` is the version of the library that wrote it.
pub(super) fn read(mut data: Bytes, opennurbs: u32) -> Res<RawBrep> {
    let (major, minor) = data.version()?;
    match major {
        2 => read_version_2(&mut data),
        3 => read_version_3(&mut data, minor, opennurbs),
        _ => Err(ReadIssue::UnsupportedVersion {
            what: "a boundary representation",
            major: major.into(),
            minor: minor.into(),
        }),
    }
}

fn read_version_3(data: &mut Bytes, minor: u8, opennurbs: u32) -> Res<RawBrep> {
    let domains = data.version >= 3 && opennurbs >= DOMAINS_SINCE;
    let mut brep = RawBrep {
        curves_2d: objects(data, curve_object)?,
        curves: objects(data, curve_object)?,
        surfaces: objects(data, surface_object)?,
        ..RawBrep::default()
    };
    (brep.vertices, _) = list(data, 40, |item| {
        item.i32()?;
        let point = item.point()?;
        item.i32s()?;
        item.f64()?;
        Ok(point)
    })?;
    (brep.edges, _) = list(data, 44, |item| edge(item, domains))?;
    (brep.trims, _) = list(data, 60, |item| trim(item, domains))?;
    (brep.loops, _) = list(data, 16, |item| {
        item.i32()?;
        let trims = item.i32s()?;
        let kind = item.i32()?;
        item.i32()?;
        Ok(RawLoop { trims, kind })
    })?;
    brep.faces = faces(data)?;
    // What follows only completes the shape: files of which it is damaged are read all the same.
    brep.solid = solid(data, minor).unwrap_or(0);
    if opennurbs < 20_021_002 {
        brep.solid = 0;
    }
    Ok(brep)
}

/// A list of objects that may be missing, in a chunk.
fn objects<T>(data: &mut Bytes, read: impl Fn(&mut Bytes) -> Res<T>) -> Res<Vec<Res<T>>> {
    let mut body = data.chunk_of(ANONYMOUS)?;
    version_1(&mut body)?;
    let count = body.count(4)?;
    let mut all = Vec::with_capacity(count);
    for _ in 0..count {
        if body.i32()? != 1 {
            all.push(Err(ReadIssue::Missing { what: "content in the file" }));
            continue;
        }
        // An invalid one is skipped as a whole.
        let mut inner = body;
        all.push(read(&mut inner));
        body.chunk()?;
    }
    Ok(all)
}

/// A list of records of at least `size` bytes in a chunk, and what follows it there.
fn list<'a, T>(
    data: &mut Bytes<'a>,
    size: usize,
    mut read: impl FnMut(&mut Bytes<'a>) -> Res<T>,
) -> Res<(Vec<T>, (u32, Bytes<'a>))> {
    let mut body = data.chunk_of(ANONYMOUS)?;
    let minor = version_1(&mut body)?;
    let count = body.count(size)?;
    let mut all = Vec::with_capacity(count);
    for _ in 0..count {
        all.push(read(&mut body)?);
    }
    Ok((all, (minor, body)))
}

/// A version of two numbers, which must be 1.x; the x.
fn version_1(body: &mut Bytes) -> Res<u32> {
    let (major, minor) = body.version()?;
    if major == 1 {
        Ok(u32::from(minor))
    } else {
        Err(ReadIssue::UnsupportedVersion { what: "a list", major: major.into(), minor: minor.into() })
    }
}

/// Bounds that say nothing where they are not increasing.
fn bounds(data: &mut Bytes) -> Res<Option<Range>> {
    let range = Range::new(data.f64()?, data.f64()?);
    Ok((range.is_finite() && range.start < range.end).then_some(range))
}

fn edge(data: &mut Bytes, domains: bool) -> Res<RawEdge> {
    data.i32()?;
    let curve = data.i32()?;
    let reversed = data.i32()? != 0;
    let range = bounds(data)?;
    let vertices = [data.i32()?, data.i32()?];
    data.i32s()?;
    data.f64()?;
    if domains {
        data.take(16)?;
    }
    Ok(RawEdge { curve, proxy: CurveUse { range, reversed }, vertices })
}

fn trim(data: &mut Bytes, domains: bool) -> Res<RawTrim> {
    data.i32()?;
    let curve = data.i32()?;
    let range = bounds(data)?;
    let edge = data.i32()?;
    let vertices = [data.i32()?, data.i32()?];
    let against = data.i32()? != 0;
    // Its type, whether it is an isoparametric line, its loop, two tolerances.
    data.take(12 + 16)?;
    let mut reversed = false;
    if domains {
        data.take(16)?;
        reversed = data.u8()? == 1;
        data.take(7 + 24)?;
    } else {
        data.take(48)?;
    }
    data.take(16)?;
    Ok(RawTrim { curve, proxy: CurveUse { range, reversed }, edge, vertices, against })
}

fn faces(data: &mut Bytes) -> Res<Vec<RawFace>> {
    let (mut faces, (minor, mut rest)) = list(data, 20, |item| {
        item.i32()?;
        let loops = item.i32s()?;
        let surface = item.i32()?;
        let reversed = item.i32()? != 0;
        item.i32()?;
        Ok(RawFace { loops, surface, reversed, color: None })
    })?;
    if minor >= 2 && rest.take(16 * faces.len()).is_ok() && rest.u8().is_ok_and(|any| any != 0) {
        for face in &mut faces {
            face.color = super::tables::color(&mut rest)?;
        }
    }
    Ok(faces)
}

/// Past the box and the meshes: whether the shape is closed.
fn solid(data: &mut Bytes, minor: u8) -> Res<i32> {
    data.take(48)?;
    if minor >= 1 {
        data.chunk_of(ANONYMOUS)?;
        data.chunk_of(ANONYMOUS)?;
    }
    if minor >= 2 { data.i32() } else { Ok(0) }
}

/// Rhino 2: trims know their twin instead of an edge; curves and surfaces stand one after the other.
fn read_version_2(data: &mut Bytes) -> Res<RawBrep> {
    let counts = [data.i32()?, data.i32()?, data.i32()?, data.i32()?];
    let [faces, edges, loops, trims] = counts.map(|count| usize::try_from(count).unwrap_or(usize::MAX));
    if [faces, edges, loops, trims].iter().any(|&count| count > data.len() / 8) {
        return Err(ReadIssue::ListTooLong { items: counts.iter().map(|&n| n as u64).max().unwrap_or(0) });
    }
    // A flag and a box.
    data.take(4 + 48)?;
    let mut brep = RawBrep::default();
    for _ in 0..trims {
        brep.curves_2d.push(Ok(bare_polycurve(data)?));
    }
    for i in 0..edges {
        brep.curves.push(Ok(bare_polycurve(data)?));
        let proxy = CurveUse { range: None, reversed: false };
        brep.edges.push(RawEdge { curve: i as i32, proxy, vertices: [-1, -1] });
    }
    for _ in 0..faces {
        brep.surfaces.push(nurbs_surface(data).map(RhinoSurface::plain));
    }
    for surface in 0..faces {
        data.take(8)?;
        let reversed = data.i32()? != 0;
        data.take(4 + 48)?;
        let count = data.count(4)?;
        let mut face = RawFace { loops: Vec::new(), surface: surface as i32, reversed, color: None };
        for _ in 0..count {
            face.loops.push(brep.loops.len() as i32);
            let boundary = loop_of_version_2(data, &mut brep.trims)?;
            brep.loops.push(boundary);
        }
        brep.faces.push(face);
    }
    Ok(brep)
}

fn loop_of_version_2(data: &mut Bytes, trims: &mut Vec<RawTrim>) -> Res<RawLoop> {
    data.i32()?;
    let kind = match data.i32()? {
        0 => 1,
        1 => 2,
        _ => 3,
    };
    data.take(32)?;
    let count = data.count(4)?;
    let mut boundary = RawLoop { trims: Vec::with_capacity(count), kind };
    for _ in 0..count {
        // Its number, its twin, and whether it owns its edge.
        data.take(4 + 4 + 1)?;
        let edge = data.i32()?;
        let against = data.i32()? != 0;
        data.take(4 + 4 + 16)?;
        let curve = trims.len() as i32;
        boundary.trims.push(curve);
        let proxy = CurveUse { range: None, reversed: false };
        trims.push(RawTrim { curve, proxy, edge, vertices: [-1, -1], against });
    }
    Ok(boundary)
}

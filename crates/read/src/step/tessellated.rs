//! Triangles that the file holds already (AP242): passed through as they are.

use super::args::{Args, Kind};
use super::builder::Builder;
use super::document::{Ix, Res};
use super::geometry::Geometry;
use super::keyword::Kw;
use chordal_brep::{ReadIssue, Source, TessellatedItem};
use chordal_nurbs::DVec3;

/// Sets within sets deeper than this refer in a circle.
const MAX_DEPTH: u32 = 8;

impl Geometry<'_> {
    /// COORDINATES_LIST(name, count, points), or a CARTESIAN_POINT_LIST.
    pub(crate) fn coordinates_list(&mut self, ix: Ix) -> Res<Vec<DVec3>> {
        let mut args = self.doc.open(ix)?;
        args.skip(if self.doc.kw(ix) == Kw::CoordinatesList { 2 } else { 1 });
        vectors(&mut args)
    }
}

/// A list of coordinate triples.
fn vectors(args: &mut Args<'_>) -> Res<Vec<DVec3>> {
    let mut list = args.list()?;
    let mut found = Vec::new();
    while list.kind() != Kind::End {
        let mut triple = list.list()?;
        let (x, y) = (triple.real()?, triple.real()?);
        let z = if triple.kind() == Kind::End { 0.0 } else { triple.real()? };
        found.push(DVec3::new(x, y, z));
    }
    Ok(found)
}

impl Builder<'_> {
    /// Adds a tessellated item; false where the entity is none.
    pub(crate) fn tessellated(&mut self, ix: Ix, kw: Kw) -> Res<bool> {
        let is_set = matches!(kw, Kw::TessellatedSolid | Kw::TessellatedShell | Kw::TessellatedGeometricSet);
        if !is_set && !is_faceted(kw) {
            return Ok(false);
        }
        let mut item =
            TessellatedItem { color: self.color(ix), source: self.doc.source(ix), ..Default::default() };
        if is_set {
            let mut args = self.doc.open(ix)?;
            item.name = args.string();
            self.gather(args.references_or_warn(), &mut item, 0);
        } else {
            self.triangles(ix, &mut item)?;
        }
        if item.triangles.is_empty() {
            self.doc.warn(ix, ReadIssue::NoTriangles);
        } else {
            self.build.part.tessellated.push(item);
        }
        Ok(true)
    }

    /// Adds the triangles of all members. Members with a colour of their own become items of their own.
    fn gather(&mut self, members: Vec<Ix>, item: &mut TessellatedItem, depth: u32) {
        for member in members {
            let kw = self.doc.kw(member);
            if kw == Kw::TessellatedShell && depth < MAX_DEPTH {
                if let Ok(mut args) = self.doc.open(member) {
                    args.skip(1);
                    self.gather(args.references_or_warn(), item, depth + 1);
                }
            } else if is_faceted(kw) {
                let color = self.color(member);
                let mut own = TessellatedItem {
                    color,
                    name: item.name.clone(),
                    source: self.doc.source(member),
                    ..Default::default()
                };
                let result = self.triangles(member, &mut own);
                match result {
                    Err(bad) => self.lose_bad(&bad),
                    Ok(()) if color.is_some() && color != item.color => self.build.part.tessellated.push(own),
                    Ok(()) => append(item, own),
                }
            }
        }
    }

    /// TRIANGULATED_FACE and its kin.
    fn triangles(&mut self, ix: Ix, item: &mut TessellatedItem) -> Res<()> {
        let kw = self.doc.kw(ix);
        let mut args = self.doc.open(ix)?;
        item.name = args.string();
        let all = self.geometry.coordinates_list(args.reference()?)?;
        args.skip(1);
        let normals = vectors(&mut args)?;
        if matches!(kw, Kw::TriangulatedFace | Kw::ComplexTriangulatedFace) {
            args.skip(1);
        }
        let picked = args.integers()?;
        item.points = if picked.is_empty() {
            all
        } else {
            picked.iter().map(|&i| pick(&args, &all, i)).collect::<Res<_>>()?
        };
        item.normals = match normals.len() {
            1 => vec![normals[0]; item.points.len()],
            n if n == item.points.len() => normals,
            0 => Vec::new(),
            n => {
                self.doc.warn(ix, ReadIssue::NormalsIgnored { found: n, expected: item.points.len() });
                Vec::new()
            }
        };
        let count = item.points.len();
        if matches!(kw, Kw::TriangulatedFace | Kw::TriangulatedSurfaceSet) {
            each_list(&mut args, |corners| item.triangles.extend(triangle(corners, count)))?;
        } else {
            each_list(&mut args, |strip| {
                for (k, corners) in strip.windows(3).enumerate() {
                    let [a, b, c] = [corners[0], corners[1], corners[2]];
                    item.triangles.extend(triangle(&if k % 2 == 0 { [a, b, c] } else { [a, c, b] }, count));
                }
            })?;
            each_list(&mut args, |fan| {
                for pair in fan.windows(2).skip(1) {
                    item.triangles.extend(triangle(&[fan[0], pair[0], pair[1]], count));
                }
            })?;
        }
        Ok(())
    }
}

fn is_faceted(kw: Kw) -> bool {
    matches!(
        kw,
        Kw::TriangulatedFace
            | Kw::ComplexTriangulatedFace
            | Kw::TriangulatedSurfaceSet
            | Kw::ComplexTriangulatedSurfaceSet
    )
}

fn pick(args: &Args<'_>, points: &[DVec3], index: i64) -> Res<DVec3> {
    let found = usize::try_from(index - 1).ok().and_then(|i| points.get(i));
    found.copied().ok_or_else(|| args.wrong(ReadIssue::NotFound { what: "point", number: index }))
}

/// Corners counted from one; degenerate triangles and those with a corner outside the list are omitted.
fn triangle(corners: &[i64], count: usize) -> Option<[u32; 3]> {
    let &[a, b, c] = corners else { return None };
    let index = |i: i64| u32::try_from(i - 1).ok().filter(|&i| (i as usize) < count);
    let t = [index(a)?, index(b)?, index(c)?];
    (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]).then_some(t)
}

/// Calls `visit` with each list of a list of lists of whole numbers.
fn each_list(args: &mut Args<'_>, mut visit: impl FnMut(&[i64])) -> Res<()> {
    let mut lists = args.list()?;
    while lists.kind() != Kind::End {
        visit(&lists.integers()?);
    }
    Ok(())
}

/// Adds `more` to `item`; normals survive only where both have them.
fn append(item: &mut TessellatedItem, more: TessellatedItem) {
    let first = item.points.len() as u32;
    let had_all = item.normals.len() == item.points.len();
    item.points.extend(&more.points);
    item.triangles.extend(more.triangles.iter().map(|t| t.map(|i| i + first)));
    if had_all && more.normals.len() == more.points.len() {
        item.normals.extend(more.normals);
    } else {
        item.normals.clear();
    }
    if item.source == Source::default() {
        item.source = more.source;
    }
}

//! Connected shells of the sewn faces, and the bodies that they make: a closed shell is a solid.

use crate::flux::{volume, winding};
use crate::orient::Oriented;
use crate::rebuild::Link;
use chordal_brep::{Body, BodyKind, FaceGeometry, FaceId, Loop, Part, Shell, ShellId, Source};
use chordal_nurbs::{Box3, DVec3, Surface};

/// The result for the shells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Shells {
    pub shells: usize,
    pub closed: usize,
}

/// The body of every face; faces without one share the number after the last.
pub(crate) fn body_of_faces(part: &Part) -> Vec<u32> {
    let mut body = vec![part.bodies.len() as u32; part.faces.len()];
    for (b, of_body) in part.bodies.iter().enumerate().rev() {
        for shell in &of_body.shells {
            part.shells[shell.index()].faces.iter().for_each(|f| body[f.index()] = b as u32);
        }
    }
    body
}

/// The faces that belong to shells with a border, or to no shell. Faces of several shells are not changed.
pub(crate) fn affected(part: &Part, has_border: &[bool]) -> Vec<bool> {
    let mut uses = vec![0_u32; part.faces.len()];
    part.shells.iter().flat_map(|s| &s.faces).for_each(|f| uses[f.index()] += 1);
    let mut affected: Vec<bool> = uses.iter().map(|&n| n == 0).collect();
    for shell in &part.shells {
        let touched = shell.faces.iter().any(|f| has_border[f.index()]);
        if touched && shell.faces.iter().all(|f| uses[f.index()] == 1) {
            shell.faces.iter().for_each(|f| affected[f.index()] = true);
        }
    }
    affected
}

/// Replaces the shells of the affected faces by their connected components, and the bodies accordingly.
pub(crate) fn regroup(part: &mut Part, affected: &[bool], oriented: &Oriented, links: &[Link]) -> Shells {
    let body_of = body_of_faces(part);
    let mut members: Vec<Vec<FaceId>> = vec![Vec::new(); oriented.components];
    for f in (0..part.faces.len()).filter(|&f| affected[f]) {
        members[oriented.component[f] as usize].push(FaceId::from(f));
    }
    members.retain(|m| !m.is_empty());
    let closed: Vec<bool> = closed_components(part, &members, links);
    let (shell_source, said_closed) = old_shells(part);
    keep_unaffected(part, affected);
    let first_new = part.shells.len();
    let mut found = Shells::default();
    // Of the body with the lowest number among a component's faces.
    let mut bodies: Vec<(u32, usize)> = Vec::new();
    for (k, faces) in members.iter().enumerate() {
        let body = faces.iter().map(|f| body_of[f.index()]).min().expect("components have faces");
        bodies.push((body, k));
        // A shell that is closed in the file stays so if it is still in one piece.
        let whole = said_closed[faces[0].index()] == Some(faces.len());
        let source = shell_source[faces[0].index()];
        part.shells.push(Shell { faces: faces.clone(), closed: closed[k] || whole, source });
        found.shells += 1;
        found.closed += usize::from(closed[k]);
    }
    bodies.sort_unstable();
    for group in bodies.chunk_by(|a, b| a.0 == b.0) {
        let shells: Vec<(ShellId, bool)> =
            group.iter().map(|&(_, k)| (ShellId::from(first_new + k), closed[k])).collect();
        add_bodies(part, group[0].0 as usize, &shells);
    }
    part.bodies.retain(|b| !b.shells.is_empty());
    turn_outward(part, first_new);
    found
}

/// A volume smaller than this share of the sum of its absolute parts is below the error of the quadrature;
/// its sign is then taken from the mesh.
const SURE: f64 = 1e-3;

/// Turns over the new closed shells whose volume has the wrong sign. The volume of an outer shell is
/// positive, that of a void negative.
fn turn_outward(part: &mut Part, first_new: usize) {
    let mut wrong: Vec<FaceId> = Vec::new();
    for body in part.bodies.iter().filter(|b| b.kind == BodyKind::Solid) {
        for (i, shell) in body.shells.iter().enumerate().filter(|(_, s)| s.index() >= first_new) {
            let faces: Vec<usize> = part.shells[shell.index()].faces.iter().map(|f| f.index()).collect();
            let sign = if i == 0 { 1.0 } else { -1.0 };
            let origin = a_point(part, faces[0]).unwrap_or_default();
            if volume(part, &faces, origin).is_some_and(|(sum, sizes)| sign * sum < -SURE * sizes) {
                wrong.extend(&part.shells[shell.index()].faces);
            }
        }
    }
    wrong.iter().for_each(|f| part.faces[f.index()].flipped ^= true);
}

/// A vertex of a face.
fn a_point(part: &Part, face: usize) -> Option<DVec3> {
    part.faces[face].loops.iter().find_map(|l| match l {
        Loop::Edges { coedges, .. } => {
            let edge = &part.edges[coedges.first()?.edge.index()];
            Some(part.vertices[edge.start.index()].point)
        }
        _ => None,
    })
}

/// Per face: where its shell came from, and, where the file calls that closed, how many faces it has.
fn old_shells(part: &Part) -> (Vec<Source>, Vec<Option<usize>>) {
    let mut source = vec![Source::default(); part.faces.len()];
    let mut closed = vec![None; part.faces.len()];
    for shell in &part.shells {
        for f in &shell.faces {
            source[f.index()] = shell.source;
            closed[f.index()] = shell.closed.then_some(shell.faces.len());
        }
    }
    (source, closed)
}

/// Drops shells of affected faces; bodies keep the others. The order of bodies stays, empty ones included.
fn keep_unaffected(part: &mut Part, affected: &[bool]) {
    let mut number = vec![None; part.shells.len()];
    let mut kept = Vec::new();
    for (s, shell) in std::mem::take(&mut part.shells).into_iter().enumerate() {
        if !shell.faces.iter().any(|f| affected[f.index()]) {
            number[s] = Some(ShellId::from(kept.len()));
            kept.push(shell);
        }
    }
    part.shells = kept;
    for body in &mut part.bodies {
        body.shells = body.shells.iter().filter_map(|s| number[s.index()]).collect();
    }
}

/// Gives new shells to body `old` (or to new ones of its name): every closed one a solid, the open ones a
/// sheet.
fn add_bodies(part: &mut Part, old: usize, shells: &[(ShellId, bool)]) {
    let template = part.bodies.get(old).cloned().unwrap_or_else(|| Body {
        kind: BodyKind::Sheet,
        shells: Vec::new(),
        name: String::new(),
        color: None,
        layer: None,
        source: part.source,
    });
    let closed: Vec<ShellId> = shells.iter().filter(|s| s.1).map(|s| s.0).collect();
    let mut new: Vec<Body> = with_voids(part, &closed)
        .into_iter()
        .map(|shells| Body { kind: BodyKind::Solid, shells, ..template.clone() })
        .collect();
    let open: Vec<ShellId> = shells.iter().filter(|s| !s.1).map(|s| s.0).collect();
    if !open.is_empty() {
        // A solid that did not close keeps the kind that the file states.
        let kind = if new.is_empty() { template.kind } else { BodyKind::Sheet };
        new.push(Body { kind, shells: open, ..template.clone() });
    }
    let mut new = new.into_iter();
    if let Some(body) = part.bodies.get_mut(old).filter(|b| b.shells.is_empty())
        && let Some(first) = new.next()
    {
        *body = first;
    }
    part.bodies.extend(new);
}

/// A component is closed where every side of each of its faces is linked to another one of them.
fn closed_components(part: &Part, members: &[Vec<FaceId>], links: &[Link]) -> Vec<bool> {
    let mut linked = vec![0_usize; part.faces.len()];
    links.iter().flat_map(|l| l.faces).for_each(|f| linked[f as usize] += 1);
    members.iter().map(|faces| faces.iter().all(|f| is_enclosed(part, *f, linked[f.index()]))).collect()
}

fn is_enclosed(part: &Part, face: FaceId, linked: usize) -> bool {
    let face = &part.faces[face.index()];
    let FaceGeometry::Surface(surface) = &face.geometry else { return false };
    let mut sides = 0;
    for a_loop in &face.loops {
        match a_loop {
            Loop::Vertex(_) => {}
            Loop::Polygon { .. } => return false,
            Loop::Edges { coedges, .. } => {
                sides += coedges.iter().filter(|c| part.edges[c.edge.index()].curve.is_some()).count();
            }
        }
    }
    if sides == 0 { is_closed_surface(surface) } else { sides == linked }
}

/// The surface has no side at all: each direction is closed, or ends in poles.
fn is_closed_surface(surface: &Surface) -> bool {
    let poles = surface.poles();
    let closed = |axis: usize| {
        surface.periods()[axis].is_some() || poles.iter().filter(|p| p.axis == axis).count() == 2
    };
    closed(0) && closed(1)
}

/// True where a face is the whole of a closed surface.
pub(crate) fn is_whole(part: &Part, face: FaceId) -> bool {
    is_enclosed(part, face, 0)
}

/// Closed shells of one body as solids: each outer shell with the voids that lie directly in it.
fn with_voids(part: &Part, closed: &[ShellId]) -> Vec<Vec<ShellId>> {
    let faces =
        |s: ShellId| -> Vec<usize> { part.shells[s.index()].faces.iter().map(|f| f.index()).collect() };
    let boxes: Vec<Box3> = closed.iter().map(|s| border_box(part, &faces(*s))).collect();
    let within = |inner: usize, outer: usize| {
        let (i, o) = (boxes[inner], boxes[outer]);
        let nested = inner != outer && !i.is_empty() && o.min.cmple(i.min).all() && o.max.cmpge(i.max).all();
        nested
            && a_point(part, faces(closed[inner])[0])
                .is_some_and(|p| winding(part, &faces(closed[outer]), p).is_some_and(|w| w.abs() > 0.5))
    };
    let n = closed.len();
    let around: Vec<Vec<usize>> = (0..n).map(|i| (0..n).filter(|&o| within(i, o)).collect()).collect();
    let mut solids: Vec<Vec<ShellId>> = Vec::new();
    let mut place = vec![usize::MAX; n];
    // At even depth is material, at odd depth a void of the shell one level up.
    for i in (0..n).filter(|&i| around[i].len().is_multiple_of(2)) {
        place[i] = solids.len();
        solids.push(vec![closed[i]]);
    }
    for i in (0..n).filter(|&i| around[i].len() % 2 == 1) {
        let outer = around[i].iter().find(|&&o| around[o].len() + 1 == around[i].len());
        match outer.map(|&o| place[o]).filter(|&p| p != usize::MAX) {
            Some(p) => solids[p].push(closed[i]),
            None => solids.push(vec![closed[i]]),
        }
    }
    solids
}

/// The box of the edges of faces.
fn border_box(part: &Part, faces: &[usize]) -> Box3 {
    let mut found = Box3::EMPTY;
    for a_loop in faces.iter().flat_map(|&f| &part.faces[f].loops) {
        let Loop::Edges { coedges, .. } = a_loop else { continue };
        for edge in coedges.iter().map(|c| &part.edges[c.edge.index()]) {
            if let Some(curve) = edge.curve.as_deref().filter(|_| edge.range.is_finite()) {
                found = found.union(curve.bbox(edge.range));
            }
        }
    }
    found
}

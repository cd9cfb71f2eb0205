//! Loops that leave the surface are cut at its border.
//!
//! Each such loop is cut where it crosses the border of the domain. What remains of it inside are chords from
//! border to border with the material on their left; from the end of a chord the new outline follows the
//! border, the domain on its left as well, to where the next chord begins (after Weiler and Atherton, for one
//! of the polygons a rectangle).
//!
//! Not guaranteed: loops that cross each other are not recognised as such.

use super::chain::Chain;
use super::polygon::{area, contains};
use super::{Piece, Role, Scale};
use chordal_brep::ReadIssue;
use chordal_nurbs::{BezierCurve, Curve2, DVec2, Range};
use std::sync::Arc;

/// Loops nearer to the border than this share of the domain run along it.
const ON_BORDER: f64 = 1e-6;

/// Chords end on the border within this share of the domain: the accuracy of the bisection.
const AT_BORDER: f64 = 1e-9;

/// Halvings of a span before a root is taken for found: those of 64-bit parameters.
const HALVINGS: u32 = 60;

/// A chain, its outline in the unit square, and whether it is an outer one.
pub(super) struct Outline {
    pub chain: Chain,
    pub polygon: Vec<DVec2>,
    pub outer: bool,
}

/// The same region with no loop beyond the border of the domain; chains come back in the order given, then
/// the new outlines, as outer loops.
///
/// # Errors
/// A sentence, where nothing of the surface remains or a loop cannot be cut.
pub(super) fn to_domain(outlines: Vec<Outline>, scale: &Scale) -> Result<Vec<Chain>, ReadIssue> {
    let clippable = scale.uv.is_finite() && scale.bounded == [true; 2];
    let leaves = |o: &Outline| o.polygon.iter().any(|&p| beyond(p) > ON_BORDER);
    let touches = |o: &Outline| !o.outer && o.polygon.windows(2).any(|pair| along_border(pair[0], pair[1]));
    if !clippable || !outlines.iter().any(|o| leaves(o) || touches(o)) {
        return Ok(outlines.into_iter().map(|o| o.chain).collect());
    }
    let mut kept = Vec::new();
    let mut chords = Vec::new();
    let (mut outer_gone, mut outers) = (false, 0);
    for mut outline in outlines {
        if !leaves(&outline) && !touches(&outline) {
            outers += usize::from(outline.outer);
            kept.push(outline.chain);
            continue;
        }
        if (area(&outline.polygon) > 0.0) != outline.outer {
            outline.chain.reverse();
        }
        let (found, wholly_inside) = chords_of(&outline, scale)?;
        let around = contains(&outline.polygon, DVec2::splat(0.5));
        match (found.is_empty(), outline.outer) {
            _ if wholly_inside => kept.push(outline.chain),
            (false, _) => chords.extend(found),
            // Around the whole domain: no limit.
            (true, true) if around => {
                outers += 1;
                kept.push(border(outline.chain, scale));
            }
            (true, true) => outer_gone = true,
            (true, false) if around => return Err(ReadIssue::NothingTrimmed),
            (true, false) => {}
        }
    }
    if outers > 0 && chords.iter().all(|chord: &Chord| chord.of_hole) {
        // The outer loops lie inside: what is cut off at the border is no part of them.
        chords.clear();
    }
    if chords.is_empty() && outer_gone && outers == 0 {
        return Err(ReadIssue::TrimsBeyond);
    }
    kept.extend(trace(chords, scale)?);
    Ok(kept)
}

/// How far a point of the unit square's plane lies outside of it; negative inside.
fn beyond(p: DVec2) -> f64 {
    (-p.min_element()).max(p.max_element() - 1.0)
}

fn along_border(a: DVec2, b: DVec2) -> bool {
    let middle = (a + b) * 0.5;
    beyond(middle).abs() <= AT_BORDER
        && beyond(a).abs() <= AT_BORDER
        && beyond(b).abs() <= AT_BORDER
        && a != b
}

/// The border of the domain as a loop.
fn border(like: Chain, scale: &Scale) -> Chain {
    let corner = |k: usize| at_border(k as f64, scale);
    let pieces = (0..4).map(|k| Piece::line(corner(k), corner(k + 1))).collect();
    Chain { pieces, role: Role::Outer, winds: false, ..like }
}

/// Pieces from border to border.
struct Chord {
    pieces: Vec<Piece>,
    /// Places along the border, 0 to 4 counter-clockwise from the domain's lower left corner.
    from: f64,
    to: f64,
    like: Chain,
    of_hole: bool,
}

/// The parts of a chain inside the domain, and whether all of it is.
fn chords_of(outline: &Outline, scale: &Scale) -> Result<(Vec<Chord>, bool), ReadIssue> {
    let chain = &outline.chain;
    let mut parts: Vec<(Piece, bool)> = Vec::new();
    for piece in &chain.pieces {
        for part in split(piece, scale)? {
            let inside = [0.3, 0.5, 0.7].iter().any(|&s| beyond(scale.unit(part.at(s))) < -AT_BORDER);
            parts.push((part, inside));
        }
    }
    let Some(first_out) = parts.iter().position(|(_, inside)| !inside) else { return Ok((Vec::new(), true)) };
    parts.rotate_left(first_out);
    let mut chords = Vec::new();
    for run in parts.chunk_by(|a, b| a.1 == b.1).filter(|run| run[0].1) {
        let pieces: Vec<Piece> = run.iter().map(|(piece, _)| piece.clone()).collect();
        let place = |p: DVec2| place_on_border(scale.unit(p)).ok_or(ReadIssue::TrimNotCut);
        let from = place(pieces[0].at(0.0))?;
        let to = place(pieces[pieces.len() - 1].at(1.0))?;
        let like = Chain { pieces: Vec::new(), ..chain.clone() };
        chords.push(Chord { pieces, from, to, like, of_hole: !outline.outer });
    }
    Ok((chords, false))
}

/// The place along the border of a point on it.
fn place_on_border(p: DVec2) -> Option<f64> {
    let near = |a: f64, b: f64| (a - b).abs() <= ON_BORDER;
    let inside = |t: f64| t.clamp(0.0, 1.0);
    if near(p.y, 0.0) {
        Some(inside(p.x))
    } else if near(p.x, 1.0) {
        Some(1.0 + inside(p.y))
    } else if near(p.y, 1.0) {
        Some(3.0 - inside(p.x))
    } else if near(p.x, 0.0) {
        Some(4.0 - inside(p.y))
    } else {
        None
    }
}

/// The point at a place of the border; exactly on it.
fn at_border(place: f64, scale: &Scale) -> DVec2 {
    let (min, max) = (scale.uv.min, scale.uv.max);
    let place = place.rem_euclid(4.0);
    let (side, share) = (place.floor(), place - place.floor());
    let along = |a: f64, b: f64| if share == 0.0 { a } else { a + share * (b - a) };
    match side as u32 {
        0 => DVec2::new(along(min.x, max.x), min.y),
        1 => DVec2::new(max.x, along(min.y, max.y)),
        2 => DVec2::new(along(max.x, min.x), max.y),
        _ => DVec2::new(min.x, along(max.y, min.y)),
    }
}

/// Joins chords along the border.
fn trace(chords: Vec<Chord>, scale: &Scale) -> Result<Vec<Chain>, ReadIssue> {
    let mut used = vec![false; chords.len()];
    let mut outlines = Vec::new();
    for first in 0..chords.len() {
        if used[first] {
            continue;
        }
        let mut pieces = Vec::new();
        let mut at = first;
        loop {
            used[at] = true;
            pieces.extend(chords[at].pieces.iter().cloned());
            let to = chords[at].to;
            let ahead = |k: &usize| {
                let way = (chords[*k].from - to).rem_euclid(4.0);
                if way > 4.0 - AT_BORDER { 0.0 } else { way }
            };
            let next = (0..chords.len()).min_by(|a, b| ahead(a).total_cmp(&ahead(b))).expect("one at least");
            let last = pieces.last().map_or(DVec2::ZERO, |piece: &Piece| piece.at(1.0));
            pieces.extend(along(to, ahead(&next), last, chords[next].pieces[0].at(0.0), scale));
            if next == first {
                break;
            }
            if used[next] {
                return Err(ReadIssue::TrimsCrossBeyond);
            }
            at = next;
        }
        outlines.push(Chain { pieces, role: Role::Outer, winds: false, ..chords[first].like.clone() });
    }
    Ok(outlines)
}

/// Straight pieces along the border from a place, the length `way` of it, between two points.
fn along(from: f64, way: f64, start: DVec2, end: DVec2, scale: &Scale) -> Vec<Piece> {
    if way <= AT_BORDER {
        return Vec::new();
    }
    let mut stops = vec![start];
    let mut corner = from.floor() + 1.0;
    while corner < from + way - AT_BORDER {
        if corner > from + AT_BORDER {
            stops.push(at_border(corner, scale));
        }
        corner += 1.0;
    }
    stops.push(end);
    // The ends that bisection found lie on the border only nearly.
    let snapped = |p: DVec2| place_on_border(scale.unit(p)).map_or(p, |place| at_border(place, scale));
    stops.windows(2).map(|pair| Piece::line(snapped(pair[0]), snapped(pair[1]))).collect()
}

/// The piece, cut where it crosses the lines that bound the domain, in running order.
fn split(piece: &Piece, scale: &Scale) -> Result<Vec<Piece>, ReadIssue> {
    let nurbs = piece.curve.to_nurbs(piece.range).map_err(|_| ReadIssue::TrimNotCut)?;
    let reach = nurbs.points().iter().fold(f64::NEG_INFINITY, |far, &p| far.max(beyond(scale.unit(p))));
    if reach < -AT_BORDER && nurbs.weights().is_none_or(|w| w.iter().all(|w| *w > 0.0)) {
        return Ok(vec![piece.clone()]);
    }
    let mut stops = Vec::new();
    for (span, bezier) in nurbs.bezier_pieces() {
        for (axis, line) in [(0, 0.0), (0, 1.0), (1, 0.0), (1, 1.0)] {
            let height = |i: usize| {
                let weight = bezier.weights.as_ref().map_or(1.0, |w| w[i]);
                weight * (scale.unit(bezier.points[i])[axis] - line)
            };
            let heights =
                BezierCurve { points: (0..bezier.points.len()).map(height).collect(), weights: None };
            let mut found = Vec::new();
            roots(&heights, 0.0, 1.0, HALVINGS, &mut found);
            stops.extend(found.into_iter().map(|s| span.start + s * span.length()));
        }
    }
    let domain = nurbs.domain();
    let tiny = 1e-12 * domain.length();
    stops.retain(|&t| t > domain.start + tiny && t < domain.end - tiny);
    stops.sort_by(f64::total_cmp);
    stops.dedup_by(|b, a| *b - *a <= tiny);
    stops.insert(0, domain.start);
    stops.push(domain.end);
    let curve = Arc::new(Curve2::Nurbs(nurbs));
    let part = |pair: &[f64]| Piece {
        curve: curve.clone(),
        range: Range::new(pair[0], pair[1]),
        forward: piece.forward,
    };
    let mut parts: Vec<Piece> = stops.windows(2).map(part).collect();
    if !piece.forward {
        parts.reverse();
    }
    Ok(parts)
}

/// Where a polynomial in Bernstein form changes its sign (or touches zero), in increasing order; nowhere
/// where it vanishes over a whole interval.
fn roots(f: &BezierCurve<f64>, a: f64, b: f64, left: u32, found: &mut Vec<f64>) {
    let (low, high) =
        f.points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &c| (l.min(c), h.max(c)));
    if low > 0.0 || high < 0.0 {
        return;
    }
    let middle = 0.5 * (a + b);
    if left == 0 || middle <= a || middle >= b || high - low <= f64::EPSILON {
        let along = left == HALVINGS;
        if !along && found.last().is_none_or(|&last| middle - last > 1e-12) {
            found.push(middle);
        }
        return;
    }
    let (head, tail) = f.split(0.5);
    roots(&head, a, middle, left - 1, found);
    roots(&tail, middle, b, left - 1, found);
}

#[cfg(test)]
mod tests;

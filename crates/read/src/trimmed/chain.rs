//! Pieces of parameter curves as a closed chain, cut at its corners.

use super::{Piece, Scale, TrimLoop};
use crate::assemble::Notes;
use chordal_brep::{Percent, ReadIssue};
use chordal_nurbs::{DVec2, Range, math};

/// Ends of pieces nearer together than this share of the domain meet: files of 32-bit numbers round to about
/// this. Wider gaps are bridged, with a warning.
const MEETS: f64 = 1e-6;

/// Pieces turn by more than this (radians, in the unit square) at a corner, which becomes a vertex.
const CORNER: f64 = 0.2;

/// Samples of a smooth piece when its shape is looked at.
const SAMPLES: usize = 16;

/// A chain that is closed, up to whole periods of the surface.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub pieces: Vec<Piece>,
    pub role: super::Role,
    pub source: chordal_brep::Source,
    /// It ends a period of the surface beyond its start.
    pub winds: bool,
    /// It was put together anew: it may meet others, or itself, in its vertices.
    pub touches: bool,
}

impl Chain {
    /// Points along the chain in the unit square, the first not repeated.
    pub(super) fn polygon(&self, scale: &Scale) -> Vec<DVec2> {
        let mut points = Vec::new();
        for piece in &self.pieces {
            let mut stops = vec![piece.range.start];
            stops.extend(piece.curve.all_breaks(piece.range));
            stops.push(piece.range.end);
            let from = points.len();
            for pair in stops.windows(2) {
                let at = |k: usize| pair[0] + (pair[1] - pair[0]) * k as f64 / SAMPLES as f64;
                points.extend((0..SAMPLES).map(|k| scale.unit(piece.curve.point(at(k)))));
            }
            if !piece.forward {
                // The samples lack the end instead of the start.
                points.remove(from);
                points.push(scale.unit(piece.curve.point(piece.range.end)));
                points[from..].reverse();
            }
        }
        points
    }

    pub(super) fn reverse(&mut self) {
        self.pieces.reverse();
        self.pieces.iter_mut().for_each(|piece| piece.forward = !piece.forward);
    }
}

/// Closes a loop; `None` where it has no extent.
///
/// # Errors
/// Where the pieces make no loop.
pub(super) fn closed(
    trim: &TrimLoop,
    index: usize,
    scale: &Scale,
    notes: &Notes,
) -> Result<Option<Chain>, ReadIssue> {
    let number = index + 1;
    let mut given = Vec::with_capacity(trim.pieces.len());
    for piece in &trim.pieces {
        let sound = piece.range.is_finite() && piece.range.length() > 0.0;
        if !sound || !(0..=8).all(|k| piece.at(f64::from(k) / 8.0).is_finite()) {
            return Err(ReadIssue::TrimPieceNotFinite { trim: number });
        }
        let still = (1..=8).all(|k| gap(piece.at(0.0), piece.at(f64::from(k) / 8.0), scale) <= MEETS * 1e-3);
        if !still {
            given.push(piece.clone());
        }
    }
    if given.is_empty() {
        return Ok(None);
    }
    let mut pieces: Vec<Piece> = Vec::with_capacity(given.len());
    let mut winds = false;
    let mut widest = 0.0f64;
    for i in 0..given.len() {
        let last = i + 1 == given.len();
        let (end, start) = (given[i].at(1.0), given[(i + 1) % given.len()].at(0.0));
        pieces.extend(cut_at_corners(&given[i], scale));
        let apart = gap(end, start, scale);
        if apart <= MEETS {
            continue;
        }
        if last && is_a_turn(end - start, scale) {
            winds = true;
            continue;
        }
        widest = widest.max(apart);
        pieces.push(Piece::line(end, start));
    }
    if widest > 0.0 {
        let open = ReadIssue::TrimLoopOpen { trim: number, gap: Percent::of(widest) };
        notes.warn(trim.source, open);
    }
    Ok(Some(Chain { pieces, role: trim.role, source: trim.source, winds, touches: false }))
}

/// The distance of two points as a share of the domain.
fn gap(a: DVec2, b: DVec2, scale: &Scale) -> f64 {
    scale.unit(a).distance(scale.unit(b))
}

/// True for one whole period along one direction.
fn is_a_turn(d_uv: DVec2, scale: &Scale) -> bool {
    (0..2).any(|axis| {
        let other = d_uv[1 - axis].abs() / scale.uv.size()[1 - axis].max(f64::MIN_POSITIVE);
        scale.periods[axis].is_some_and(|p| (d_uv[axis].abs() / p - 1.0).abs() <= MEETS && other <= MEETS)
    })
}

/// The piece, cut where its direction jumps, without the stretches in which it stands still (control points
/// repeated for a corner).
fn cut_at_corners(piece: &Piece, scale: &Scale) -> Vec<Piece> {
    let step = 1e-7 * piece.range.length();
    let direction = |a: f64, b: f64| scale.unit(piece.curve.point(b)) - scale.unit(piece.curve.point(a));
    let corner = |t: f64| {
        let (before, after) = (direction(t - step, t), direction(t, t + step));
        math::atan2(before.perp_dot(after), before.dot(after)).abs() > CORNER
    };
    let still = |a: f64, b: f64| {
        let at = |k: u32| piece.curve.point(a + (b - a) * f64::from(k) / 4.0);
        (1..=4).all(|k| gap(at(0), at(k), scale) <= MEETS * 1e-3)
    };
    let mut stops = vec![piece.range.start];
    stops.extend(piece.curve.all_breaks(piece.range));
    stops.push(piece.range.end);
    let mut cut: Vec<Piece> = Vec::new();
    let mut joined = false;
    for pair in stops.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        if b - a > step && still(a, b) {
            joined = false;
            continue;
        }
        match cut.last_mut() {
            Some(last) if joined && (b - a <= step || last.range.length() <= step || !corner(a)) => {
                last.range.end = b;
            }
            _ => cut.push(Piece { range: Range::new(a, b), ..piece.clone() }),
        }
        joined = true;
    }
    if !piece.forward {
        cut.reverse();
    }
    cut
}

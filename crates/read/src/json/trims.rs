//! geomdl's trims: one curve or several in a container, as loops.

use crate::assemble::Notes;
use crate::trimmed::{Piece, Role, TrimLoop};
use chordal_brep::{ReadIssue, Source};
use chordal_nurbs::{Curve2, DVec2, NurbsCurve2, Surface, UvBox};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// Ends nearer to each other or to the border of the domain than this share of it are there; geomdl's own
/// tolerance is 1e-7 of its unit domain.
const MEETS: f64 = 1e-7;

/// The control points of a curve or surface, and their weights.
#[derive(Deserialize)]
pub(super) struct ControlPoints {
    pub points: Vec<Vec<f64>>,
    pub weights: Option<Vec<f64>>,
}

/// The `reversed` of a trim or a surface: 0, 1, true, false, null or nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Sense {
    #[default]
    Forward,
    Reversed,
}

impl<'de> Deserialize<'de> for Sense {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(deserializer)?;
        let reversed = value.as_bool().unwrap_or_else(|| value.as_f64().is_some_and(|x| x != 0.0));
        Ok(if reversed { Sense::Reversed } else { Sense::Forward })
    }
}

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
enum TrimData {
    Spline {
        degree: usize,
        knotvector: Vec<f64>,
        control_points: ControlPoints,
        #[serde(default)]
        reversed: Sense,
    },
    Freeform {
        points: Vec<Vec<f64>>,
        #[serde(default)]
        reversed: Sense,
    },
    Container {
        data: Vec<Value>,
        reversed: Option<Sense>,
    },
}

/// A trim whose ends may be apart.
#[derive(Debug)]
pub(super) struct Trim {
    pieces: Vec<Piece>,
    sense: Sense,
}

/// Reads one trim.
///
/// # Errors
/// Where the value is invalid.
pub(super) fn trim_loop(data: &Value, source: Source, notes: &Notes) -> Result<Trim, ReadIssue> {
    match TrimData::deserialize(data).map_err(broken)? {
        TrimData::Container { data, reversed } => {
            let mut pieces = Vec::new();
            let mut senses = Vec::new();
            for member in &data {
                let member = TrimData::deserialize(member).map_err(broken)?;
                let (curve, sense) = curve(member)?;
                pieces.push(Piece::whole(curve));
                senses.push(sense);
            }
            if turn_into_chain(&mut pieces) {
                notes.warn(source, ReadIssue::EdgeTurned);
            }
            Ok(Trim { pieces, sense: reversed.or(senses.first().copied()).unwrap_or_default() })
        }
        single => {
            let (curve, sense) = curve(single)?;
            Ok(Trim { pieces: vec![Piece::whole(curve)], sense })
        }
    }
}

fn broken(error: serde_json::Error) -> ReadIssue {
    ReadIssue::TextBroken { reason: error.to_string() }
}

fn curve(data: TrimData) -> Result<(Curve2, Sense), ReadIssue> {
    match data {
        TrimData::Spline { degree, knotvector, control_points, reversed } => {
            let curve =
                NurbsCurve2::new(degree, knotvector, points(&control_points.points)?, control_points.weights);
            Ok((Curve2::Nurbs(curve?), reversed))
        }
        TrimData::Freeform { points: list, reversed } => {
            let list = points(&list)?;
            if list.len() < 2 || !list.iter().all(|p| p.is_finite()) {
                return Err(ReadIssue::TooFew {
                    what: "finite points",
                    found: list.iter().filter(|p| p.is_finite()).count(),
                    least: 2,
                });
            }
            Ok((Curve2::Polyline(list), reversed))
        }
        TrimData::Container { .. } => {
            Err(ReadIssue::Unsupported { what: "a container in a container".into() })
        }
    }
}

fn points(list: &[Vec<f64>]) -> Result<Vec<DVec2>, ReadIssue> {
    let point = |p: &Vec<f64>| match p[..] {
        [u, v, ..] => Ok(DVec2::new(u, v)),
        _ => Err(ReadIssue::TooFew { what: "coordinates of a point", found: p.len(), least: 2 }),
    };
    list.iter().map(point).collect()
}

/// Turns pieces round that begin where the one before them begins, or end where it ends; true where one was
/// turned.
fn turn_into_chain(pieces: &mut [Piece]) -> bool {
    let mut turned = false;
    for i in 1..pieces.len() {
        let ends = |piece: &Piece| [piece.at(0.0), piece.at(1.0)];
        let ([start, end], [s, e]) = (ends(&pieces[i - 1]), ends(&pieces[i]));
        if i == 1 && start.distance(s).min(start.distance(e)) < end.distance(s).min(end.distance(e)) {
            pieces[0].forward = !pieces[0].forward;
            turned = true;
        }
        let end = pieces[i - 1].at(1.0);
        if end.distance(e) < end.distance(s) {
            pieces[i].forward = !pieces[i].forward;
            turned = true;
        }
    }
    turned
}

impl Trim {
    /// The loop. Where its two ends lie on the border of the domain, it is closed along the shorter way round
    /// that.
    pub(super) fn closed(mut self, surface: &Surface, source: Source, notes: &Notes) -> TrimLoop {
        let ends = self.pieces.first().zip(self.pieces.last()).map(|(a, b)| (b.at(1.0), a.at(0.0)));
        if let Some((from, to)) = ends
            && let Some(way) = border_way(surface.domain(), from, to)
        {
            self.pieces.extend(way.windows(2).map(|pair| Piece::line(pair[0], pair[1])));
            notes.warn(source, ReadIssue::TrimClosedAlongBorder);
        }
        let role = match self.sense {
            Sense::Forward => Role::Hole,
            Sense::Reversed => Role::Outer,
        };
        TrimLoop { pieces: self.pieces, role, source }
    }
}

/// The corners passed, with both ends, on the shorter way along the border; `None` where the ends meet or one
/// of them is not on the border.
fn border_way(domain: UvBox, from: DVec2, to: DVec2) -> Option<Vec<DVec2>> {
    let unit = |p: DVec2| (p - domain.min) / domain.size();
    let (a, b) = (unit(from), unit(to));
    if !a.is_finite() || !b.is_finite() || a.distance(b) <= MEETS {
        return None;
    }
    let (a, b) = (place(a)?, place(b)?);
    let ahead = (b - a).rem_euclid(4.0);
    let (start, way, sign) = if ahead <= 2.0 { (a, ahead, 1.0) } else { (a, 4.0 - ahead, -1.0) };
    let (min, max) = (domain.min, domain.max);
    let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
    let mut stops = vec![from];
    let first = if sign > 0.0 { start.floor() + 1.0 } else { start.ceil() - 1.0 };
    for k in 0..4 {
        let corner = first + sign * f64::from(k);
        let passed = (corner - start) * sign;
        if passed > MEETS && passed < way - MEETS {
            stops.push(corners[corner.rem_euclid(4.0) as usize]);
        }
    }
    stops.push(to);
    Some(stops)
}

/// The place along the border of the unit square, counter-clockwise from 0 at its lower left corner.
fn place(p: DVec2) -> Option<f64> {
    let near = |a: f64, b: f64| (a - b).abs() <= MEETS;
    let within = |t: f64| (-MEETS..=1.0 + MEETS).contains(&t);
    match p {
        p if near(p.y, 0.0) && within(p.x) => Some(p.x),
        p if near(p.x, 1.0) && within(p.y) => Some(1.0 + p.y),
        p if near(p.y, 1.0) && within(p.x) => Some(3.0 - p.x),
        p if near(p.x, 0.0) && within(p.y) => Some(4.0 - p.y),
        _ => None,
    }
}

//! Boundaries of trimmed and bounded surfaces: types 142 and 141, curves in space beside curves in parameter
//! space.

use super::curves::{Segment, Segment2, segments, segments2};
use super::document::{Doc, Ix, Res};
use super::surfaces::Patch;
use chordal_brep::{Pcurve, ReadIssue};
use chordal_nurbs::{Curve2, DAffine3, DVec2, DVec3, Range, SurfaceInverter, UvBox};
use std::sync::Arc;

/// A piece of a boundary in space, run backwards unless `forward`.
#[derive(Clone, Debug)]
pub(crate) struct ModelUse {
    pub segment: Segment,
    pub forward: bool,
    /// The same piece in parameter space, start to start.
    pub pcurve: Option<Pcurve>,
    /// Both run at the same pace: equal shares of their ranges are one point.
    pub paced: bool,
}

/// A piece of a boundary in parameter space.
#[derive(Clone, Debug)]
pub(crate) struct ParameterUse {
    pub segment: Segment2,
    pub forward: bool,
}

/// What the writer of the file would rather have used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Preference {
    None,
    Parameters,
    Model,
}

/// One closed boundary; at least one of the lists holds it.
#[derive(Clone, Debug)]
pub(crate) struct Boundary {
    pub model: Vec<ModelUse>,
    pub parameters: Vec<ParameterUse>,
    pub preference: Preference,
    pub ix: Ix,
}

impl ModelUse {
    pub(crate) fn start(&self) -> DVec3 {
        if self.forward { self.segment.start() } else { self.segment.end() }
    }
    pub(crate) fn end(&self) -> DVec3 {
        if self.forward { self.segment.end() } else { self.segment.start() }
    }
}

impl ParameterUse {
    /// The point at `share` (0..=1) in the running direction.
    pub(crate) fn at(&self, share: f64) -> DVec2 {
        self.segment.at(if self.forward { share } else { 1.0 - share })
    }
}

fn preference(code: i64) -> Preference {
    match code {
        1 => Preference::Parameters,
        2 => Preference::Model,
        _ => Preference::None,
    }
}

/// 142: how it was made, surface, curve in parameter space, curve in space, preference.
pub(crate) fn curve_on_surface(doc: &Doc<'_>, ix: Ix, by: &DAffine3, patch: &Patch) -> Res<Boundary> {
    let mut args = doc.open(ix)?;
    args.skip(2);
    let (in_parameters, in_space) = (args.optional_reference()?, args.optional_reference()?);
    let preference = preference(args.optional_real().unwrap_or(0.0) as i64);
    let model = model_curve(doc, in_space, by, true);
    let parameters = parameter_curve(doc, in_parameters, patch);
    either(doc, ix, model, parameters, preference)
}

/// 141: which curves there are, preference, surface, then curves in space, each with its sense and its curves
/// in parameter space.
pub(crate) fn boundary(doc: &Doc<'_>, ix: Ix, by: &DAffine3, patch: &Patch) -> Res<Boundary> {
    let mut args = doc.open(ix)?;
    args.skip(1);
    let preference = preference(args.integer()?);
    args.skip(1);
    let (mut model, mut parameters) = (Ok(Vec::new()), Ok(Vec::new()));
    for _ in 0..args.count()? {
        let curve = args.optional_reference()?;
        let forward = args.integer()? != 2;
        let found = model_curve(doc, curve, by, forward);
        model = model.and_then(|mut all: Vec<ModelUse>| {
            all.extend(found?);
            Ok(all)
        });
        for _ in 0..args.count()? {
            let found = parameter_curve(doc, args.optional_reference()?, patch);
            parameters = parameters.and_then(|mut all: Vec<ParameterUse>| {
                all.extend(found?);
                Ok(all)
            });
        }
    }
    either(doc, ix, model, parameters, preference)
}

/// A boundary from what is usable of its two descriptions.
fn either(
    doc: &Doc<'_>,
    ix: Ix,
    model: Res<Vec<ModelUse>>,
    parameters: Res<Vec<ParameterUse>>,
    preference: Preference,
) -> Res<Boundary> {
    let problem = model.as_ref().err().or(parameters.as_ref().err()).cloned();
    let boundary = Boundary {
        model: model.unwrap_or_default(),
        parameters: parameters.unwrap_or_default(),
        preference,
        ix,
    };
    if boundary.model.is_empty() && boundary.parameters.is_empty() {
        return Err(problem.unwrap_or_else(|| doc.bad(ix, ReadIssue::Missing { what: "usable curve" })));
    }
    if let Some(problem) = problem {
        doc.warn(ix, ReadIssue::CurveIgnored { cause: problem.issue().clone().boxed() });
    }
    Ok(boundary)
}

fn model_curve(doc: &Doc<'_>, curve: Option<Ix>, by: &DAffine3, forward: bool) -> Res<Vec<ModelUse>> {
    let Some(curve) = curve else { return Ok(Vec::new()) };
    let mut all: Vec<ModelUse> = segments(doc, curve, by)?
        .into_iter()
        .map(|segment| ModelUse { segment, forward, pcurve: None, paced: false })
        .collect();
    if !forward {
        all.reverse();
    }
    let finite = |use_: &ModelUse| use_.start().is_finite() && use_.end().is_finite();
    if all.iter().all(finite) { Ok(all) } else { Err(doc.bad(curve, ReadIssue::NotFinite { what: "curve" })) }
}

fn parameter_curve(doc: &Doc<'_>, curve: Option<Ix>, patch: &Patch) -> Res<Vec<ParameterUse>> {
    // Of an elementary surface the parameters are of no use: points tell them.
    let (Some(curve), Some(parameters)) = (curve, patch.parameters) else { return Ok(Vec::new()) };
    let all = segments2(doc, curve, |p_uv| parameters.map(p_uv))?;
    let finite = |segment: &Segment2| segment.at(0.0).is_finite() && segment.at(1.0).is_finite();
    if !all.iter().all(finite) {
        return Err(doc.bad(curve, ReadIssue::NotFinite { what: "curve" }));
    }
    Ok(all.into_iter().map(|segment| ParameterUse { segment, forward: true }).collect())
}

/// Samples of a piece when two descriptions of it are compared.
const PROBES: [f64; 3] = [0.25, 0.5, 0.75];

/// How far apart two descriptions of a boundary may be: as a part of the boundary's size.
pub(crate) const LOOSE: f64 = 0.02;

/// A piece's ends in space and in parameter space belong together within this part of its length.
const SAME_END: f64 = 0.05;

/// Two curves run at the same pace where equal shares are apart by no more than this part of the piece's
/// extent.
const PACE: f64 = 1e-3;

/// Boundaries of more pieces are matched only if they start with the same piece.
const MOST_TURNS: usize = 64;

impl Boundary {
    /// A rough size in space.
    pub(crate) fn size(&self) -> f64 {
        let Some(first) = self.model.first() else { return 0.0 };
        let origin = first.start();
        let far = |use_: &ModelUse| {
            PROBES
                .iter()
                .map(|&s| use_.segment.at(s))
                .chain([use_.start(), use_.end()])
                .fold(0.0, |d: f64, p| d.max(p.distance(origin)))
        };
        self.model.iter().map(far).fold(0.0, f64::max)
    }

    /// Gives each piece in space its curve in parameter space; false, nothing given, where they do not belong
    /// together piece by piece.
    pub(crate) fn match_pieces(&mut self, patch: &Patch, resolution: f64) -> bool {
        let size = self.size();
        let tiny = (1e-7 * size).max(resolution.min(1e-5 * size));
        let lifted = |p_uv| patch.surface.point(p_uv);
        let real: Vec<&ParameterUse> = self
            .parameters
            .iter()
            .filter(|p| (1..=8).any(|k| lifted(p.at(f64::from(k) / 8.0)).distance(lifted(p.at(0.0))) > tiny))
            .collect();
        let kept: Vec<usize> =
            (0..self.model.len()).filter(|&i| self.model[i].segment.extent() > tiny).collect();
        if real.is_empty() || real.len() != kept.len() {
            return false;
        }
        let n = real.len();
        // True where the piece runs the same way, false where it runs against it; none where neither fits.
        let direction = |i: usize, turn: usize| -> Option<bool> {
            let (use_, p) = (&self.model[kept[i]], real[(i + turn) % n]);
            let (a, b) = (lifted(p.at(0.0)), lifted(p.at(1.0)));
            let (start, end) = (use_.start(), use_.end());
            let middle = (use_.segment.at(0.5), lifted(p.at(0.5)));
            let slack = (SAME_END * use_.segment.extent()).max(2.0 * resolution);
            let (along, against) =
                (a.distance(start).max(b.distance(end)), a.distance(end).max(b.distance(start)));
            let near = middle.0.distance(middle.1) <= 0.5 * use_.segment.extent() + slack;
            (along.min(against) <= slack && near).then_some(along <= against)
        };
        let turns = if n <= MOST_TURNS { n } else { 1 };
        let fits = |turn: &usize| (0..n).all(|i| direction(i, *turn).is_some());
        let Some(turn) = (0..turns).find(fits) else { return false };
        let found: Vec<Pcurve> = (0..n)
            .map(|i| {
                let p = real[(i + turn) % n];
                let along_loop = direction(i, turn) == Some(true);
                let same = (along_loop == p.forward) == self.model[kept[i]].forward;
                directed(&p.segment, same)
            })
            .collect();
        for (&i, pcurve) in kept.iter().zip(found) {
            let segment = &self.model[i].segment;
            let t = |share: f64| pcurve.range.start + share * pcurve.range.length();
            let apart = |k: u32| {
                let share = f64::from(k) / 8.0;
                lifted(pcurve.curve.point(t(share))).distance(segment.at(share))
            };
            let slack = (PACE * segment.extent()).max(4.0 * resolution);
            self.model[i].paced = (1..8).all(|k| apart(k) <= slack);
            self.model[i].pcurve = Some(pcurve);
        }
        true
    }

    /// True where all pieces run at the pace of their curves in parameter space.
    pub(crate) fn paced(&self) -> bool {
        self.model.iter().all(|use_| use_.paced || use_.pcurve.is_none())
    }

    /// The farthest that the pieces in space, each with its curve in parameter space, are from the surface.
    pub(crate) fn off_surface(&self, patch: &Patch) -> f64 {
        let mut worst = 0.0f64;
        for use_ in &self.model {
            let Some(pcurve) = &use_.pcurve else { continue };
            for share in PROBES {
                let p = use_.segment.at(share);
                let p_uv = pcurve.curve.point(pcurve.range.start + share * pcurve.range.length());
                let beside = patch.surface.point(p_uv).distance(p);
                // The two curves may run at different paces: what counts is the surface.
                if beside > worst {
                    let nearest = patch.surface.point(patch.surface.invert(p, Some(p_uv))).distance(p);
                    worst = worst.max(beside.min(nearest));
                }
            }
        }
        worst
    }

    /// True where the pieces in space run counter-clockwise in the parameters of `patch`: each point of them
    /// is looked for among the curves in parameter space.
    pub(crate) fn turn(&self, patch: &Patch) -> Option<bool> {
        const STEPS: u32 = 16;
        let steps = || (0..STEPS).map(|k| f64::from(k) / f64::from(STEPS));
        let known: Vec<(DVec2, DVec3)> = self
            .parameters
            .iter()
            .flat_map(|p| steps().map(|share| p.at(share)))
            .map(|p_uv| (p_uv, patch.surface.point(p_uv)))
            .collect();
        let at =
            |use_: &ModelUse, share: f64| use_.segment.at(if use_.forward { share } else { 1.0 - share });
        let points = self.model.iter().flat_map(|use_| steps().map(move |share| at(use_, share)));
        let nearest = |p: DVec3| known.iter().min_by(|a, b| a.1.distance(p).total_cmp(&b.1.distance(p)));
        let polygon: Vec<DVec2> = points.filter_map(nearest).map(|found| found.0).collect();
        let origin = *polygon.first()?;
        let n = polygon.len();
        let area: f64 = (0..n).map(|i| (polygon[i] - origin).perp_dot(polygon[(i + 1) % n] - origin)).sum();
        (area != 0.0).then_some(area > 0.0)
    }

    /// True where the curves in parameter space, closed by a straight line where they are open, run
    /// counter-clockwise; none where they wind round a closed surface.
    pub(crate) fn parameter_turn(&self, patch: &Patch) -> Option<bool> {
        const STEPS: u32 = 16;
        let at = |p: &ParameterUse, k: u32| p.at(f64::from(k) / f64::from(STEPS));
        let polygon: Vec<DVec2> =
            self.parameters.iter().flat_map(|p| (0..STEPS).map(move |k| at(p, k))).collect();
        let (first, last) = (*polygon.first()?, self.parameters.last()?.at(1.0));
        let turns = |axis: usize| {
            let period = patch.surface.periods()[axis];
            period.map_or(0.0, |period| ((last - first)[axis] / period).abs())
        };
        let winds = [0, 1].iter().any(|&axis| turns(axis) > 1.0 - LOOSE);
        let extent = UvBox::from_points(polygon.iter().copied()).size();
        let n = polygon.len();
        let area: f64 = (0..n).map(|i| (polygon[i] - first).perp_dot(polygon[(i + 1) % n] - first)).sum();
        (!winds && area.abs() > LOOSE * extent.x * extent.y).then_some(area > 0.0)
    }

    /// The farthest that the pieces in space are from the surface.
    pub(crate) fn model_off(&self, patch: &Patch) -> f64 {
        let inverter = SurfaceInverter::new(&patch.surface, patch.surface.domain());
        let off = |p: DVec3| inverter.invert(p, None).distance;
        let ends = |use_: &ModelUse| {
            PROBES.map(|share| use_.segment.at(share)).into_iter().map(off).fold(off(use_.start()), f64::max)
        };
        self.model.iter().map(ends).fold(0.0, f64::max)
    }

    /// True where the boundary in parameter space runs near the one in space, or there is only the former.
    pub(crate) fn parameters_fit(&self, patch: &Patch, resolution: f64) -> bool {
        if self.parameters.is_empty() {
            return false;
        }
        const STEPS: u32 = 32;
        let mut chords: Vec<[DVec3; 2]> = Vec::new();
        for use_ in &self.model {
            let at = |k: u32| use_.segment.at(f64::from(k) / f64::from(STEPS));
            chords.extend((0..STEPS).map(|k| [at(k), at(k + 1)]));
        }
        let slack = (LOOSE * self.size()).max(4.0 * resolution);
        let near = |p: DVec3| chords.is_empty() || chords.iter().any(|c| to_chord(p, *c) <= slack);
        self.parameters.iter().all(|p| (0..=4).all(|k| near(patch.surface.point(p.at(f64::from(k) / 4.0)))))
    }
}

pub(super) fn to_chord(p: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let d = b - a;
    let length = d.length_squared();
    let t = if length > 0.0 { ((p - a).dot(d) / length).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + d * t)
}

/// A curve of parameter space, turned round unless it runs the `same` way.
pub(crate) fn directed(segment: &Segment2, same: bool) -> Pcurve {
    if same {
        return Pcurve { curve: Arc::new(segment.curve.clone()), range: segment.range };
    }
    let Range { start, end } = segment.range;
    let curve = Curve2::Composite(vec![(segment.curve.clone(), end, start)]);
    Pcurve { curve: Arc::new(curve), range: Range::new(0.0, 1.0) }
}

/// A closed curve in space as a boundary.
pub(crate) fn in_space(doc: &Doc<'_>, curve: Ix, by: &DAffine3) -> Res<Boundary> {
    let model = model_curve(doc, Some(curve), by, true)?;
    Ok(Boundary { model, parameters: Vec::new(), preference: Preference::Model, ix: curve })
}

//! Surfaces and curves as flat arrays that every kernel reads: knots by span, control points in local
//! coordinates.
//!
//! Precision rests on two changes of coordinates, both made in double precision:
//! - Control points are taken relative to the middle of their box and divided by half its largest side, so
//!   that |x| ≤ 1 whatever the place and the size of the part; weights are divided by the largest.
//! - The knots around a span are those of `s` made 0 and of `s + 1` made 1. Every difference of the recursion
//!   is then one of a number ≤ 0 and one ≥ 0, so that each basis function is exact to a few roundings
//!   **relative to itself**, however short the span and however far from zero its knots.
//!
//! A curve is a surface without degree along v.

use crate::error::GpuError;
use crate::layout::{Direction, Span};
use crate::real::Real;
use chordal_nurbs::{BezierPatch, DVec2, DVec3, NurbsCurve3, NurbsSurface, UvBox};
use std::ops::{Range, RangeInclusive};

/// Where the local coordinates of a surface lie: model = `middle` + `size` · local.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalFrame {
    /// The origin of the local coordinates.
    pub middle: DVec3,
    /// The length of one local unit.
    pub size: f64,
}

/// One surface of a set.
#[derive(Clone, Debug)]
pub struct SurfaceEntry {
    /// Where its local coordinates lie.
    pub frame: LocalFrame,
    /// The degrees along u and v.
    pub degree: [usize; 2],
    /// The largest weight over the smallest, by size: 1 where there are none.
    pub weight_ratio: f64,
    pub(crate) net: u32,
    pub(crate) stride: u32,
    pub(crate) points: u32,
    pub(crate) bezier: u32,
    pub(crate) beziers: u32,
    pub(crate) directions: [DirectionEntry; 2],
}

/// The spans of one direction.
#[derive(Clone, Debug)]
pub(crate) struct DirectionEntry {
    /// The first span, and the index of the first window entry.
    pub span: u32,
    pub window: u32,
    pub windows: u32,
    /// The ends of the spans in increasing order, one more than spans.
    pub breaks: Vec<f64>,
}

impl DirectionEntry {
    /// The span of `t` (clamped to the domain; not-a-number counts as its start) and the place in it, 0..=1.
    pub fn locate(&self, t: f64) -> (u32, f64) {
        let count = self.breaks.len() - 1;
        let t = t.max(self.breaks[0]).min(self.breaks[count]);
        let cell = self.breaks[1..count].partition_point(|&b| b <= t);
        let (start, end) = (self.breaks[cell], self.breaks[cell + 1]);
        (self.span + cell as u32, ((t - start) / (end - start)).clamp(0.0, 1.0))
    }

    /// Its window entries and its spans in the set.
    pub fn windows(&self) -> Range<usize> {
        self.window as usize..(self.window + self.windows) as usize
    }
    pub fn spans(&self) -> Range<usize> {
        self.span as usize..self.span as usize + self.breaks.len() - 1
    }

    /// The spans between two parameters, by their numbers in this direction.
    pub fn cells_between(&self, low: f64, high: f64) -> RangeInclusive<usize> {
        let cell = |t: f64| (self.locate(t).0 - self.span) as usize;
        cell(low)..=cell(high)
    }
}

/// What an edit of a surface changed, and so what has to be uploaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edit {
    /// Control points or weights.
    pub points: bool,
    /// Knots.
    pub knots: bool,
}

/// Any number of surfaces and curves of any degree.
#[derive(Clone, Debug, Default)]
pub struct SurfaceSet<R> {
    pub(crate) entries: Vec<SurfaceEntry>,
    pub(crate) spans: Vec<Span>,
    pub(crate) windows: Vec<R>,
    /// Homogeneous, local: (w x, w y, w z, w).
    pub(crate) net: Vec<[R; 4]>,
    /// The Bézier nets of all cells, the same way; empty unless requested.
    pub(crate) bezier: Vec<[R; 4]>,
    wants_bezier: bool,
}

impl<R: Real> SurfaceSet<R> {
    /// An empty set.
    pub fn new() -> Self {
        Self::default()
    }

    /// An empty set that will hold the Bézier nets of every span too, which the Bernstein kernel needs.
    pub fn with_bezier() -> Self {
        Self { wants_bezier: true, ..Self::default() }
    }

    /// True where the Bernstein kernel can run.
    pub fn has_bezier(&self) -> bool {
        self.wants_bezier
    }

    fn patches(&self, surface: &NurbsSurface) -> Vec<(UvBox, BezierPatch)> {
        let everywhere = UvBox::new(DVec2::NEG_INFINITY, DVec2::INFINITY);
        if self.wants_bezier { surface.bezier_patches(everywhere) } else { Vec::new() }
    }

    /// The number of surfaces.
    pub fn len(&self) -> usize {
        self.entries.len()
    }
    /// Whether there is no surface.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
    /// The surfaces in their order.
    pub fn entries(&self) -> &[SurfaceEntry] {
        &self.entries
    }

    /// The Bézier points (w x, w y, w z, w) of a surface in local coordinates, cell by cell, u slowest; empty
    /// without Bézier nets and for an index out of range.
    pub fn bezier_points(&self, index: usize) -> &[[R; 4]] {
        let range = self.entries.get(index).map_or(0..0, SurfaceEntry::bezier_range);
        self.bezier.get(range).unwrap_or_default()
    }

    /// Adds a surface and returns its index.
    pub fn push_surface(&mut self, surface: &NurbsSurface) -> usize {
        let [p, q] = surface.degree();
        let directions =
            [self.direction(p, surface.knots_u(), None), self.direction(q, surface.knots_v(), None)];
        let patches = self.patches(surface);
        let cells = patches.iter().map(|(_, patch)| (patch.points.as_slice(), patch.weights.as_deref()));
        self.push(
            surface.degree(),
            surface.counts()[1],
            (surface.points(), surface.weights()),
            directions,
            cells,
        )
    }

    /// Adds a curve, as a surface without degree along v, and returns its index.
    pub fn push_curve(&mut self, curve: &NurbsCurve3) -> usize {
        let directions =
            [self.direction(curve.degree(), curve.knots(), None), self.direction(0, &[0.0, 1.0], None)];
        let pieces = if self.wants_bezier { curve.bezier_pieces() } else { Vec::new() };
        let cells = pieces.iter().map(|(_, piece)| (piece.points.as_slice(), piece.weights.as_deref()));
        self.push([curve.degree(), 0], 1, (curve.points(), curve.weights()), directions, cells)
    }

    fn push<'a>(
        &mut self,
        degree: [usize; 2],
        stride: usize,
        net: (&[DVec3], Option<&[f64]>),
        directions: [DirectionEntry; 2],
        cells: impl Iterator<Item = (&'a [DVec3], Option<&'a [f64]>)>,
    ) -> usize {
        let frame = local_frame(net.0);
        let (largest, weight_ratio) = weight_range(net.1);
        let at = self.net.len() as u32;
        self.net.extend(homogeneous::<R>(net, frame, largest));
        let bezier = self.bezier.len() as u32;
        for cell in cells {
            self.bezier.extend(homogeneous::<R>(cell, frame, largest));
        }
        self.entries.push(SurfaceEntry {
            frame,
            degree,
            weight_ratio,
            net: at,
            stride: stride as u32,
            points: net.0.len() as u32,
            bezier,
            beziers: self.bezier.len() as u32 - bezier,
            directions,
        });
        self.entries.len() - 1
    }

    /// Appends the spans of a direction, or writes them `over` those that are there.
    fn direction(&mut self, degree: usize, knots: &[f64], over: Option<&DirectionEntry>) -> DirectionEntry {
        let (mut spans, mut windows, mut breaks) = (Vec::new(), Vec::new(), Vec::new());
        let first_window = over.map_or(self.windows.len() as u32, |d| d.window);
        for s in degree..knots.len() - degree - 1 {
            let (start, length) = (knots[s], knots[s + 1] - knots[s]);
            if length <= 0.0 {
                continue;
            }
            spans.push(Span {
                window: first_window + windows.len() as u32,
                first: (s - degree) as u32,
                degree: degree as u32,
                cell: spans.len() as u32,
            });
            windows.push(R::from_f64(1.0 / length));
            windows
                .extend(knots[s - degree..=s + degree + 1].iter().map(|k| R::from_f64((k - start) / length)));
            breaks.push(start);
        }
        breaks.push(knots[knots.len() - degree - 1]);
        let entry = DirectionEntry {
            span: over.map_or(self.spans.len() as u32, |d| d.span),
            window: first_window,
            windows: windows.len() as u32,
            breaks,
        };
        match over {
            None => {
                self.spans.append(&mut spans);
                self.windows.append(&mut windows);
            }
            Some(d) if d.windows == entry.windows => {
                let at = d.window as usize;
                self.windows[at..at + windows.len()].copy_from_slice(&windows);
                let at = d.span as usize;
                self.spans[at..at + spans.len()].copy_from_slice(&spans);
            }
            Some(_) => {}
        }
        entry
    }

    /// Puts a surface of the same degrees and counts in the place of surface `index`.
    ///
    /// # Errors
    /// [`GpuError::NoSuchSurface`], or [`GpuError::OtherShape`] where a degree, a count or the number of
    /// spans differs.
    pub fn replace(&mut self, index: usize, surface: &NurbsSurface) -> Result<Edit, GpuError> {
        let old = self.entries.get(index).ok_or(GpuError::NoSuchSurface(index))?.clone();
        let spans = [surface.breaks_u().len(), surface.breaks_v().len()];
        let same = old.degree == surface.degree()
            && old.points as usize == surface.points().len()
            && old.stride as usize == surface.counts()[1]
            && [0, 1].iter().all(|&d| old.directions[d].breaks.len() == spans[d]);
        if !same {
            return Err(GpuError::OtherShape { index });
        }
        let (net, knots) = (self.net[old.net_range()].to_vec(), self.knots_of(&old));
        let directions = [
            self.direction(old.degree[0], surface.knots_u(), Some(&old.directions[0])),
            self.direction(old.degree[1], surface.knots_v(), Some(&old.directions[1])),
        ];
        let frame = local_frame(surface.points());
        let (largest, weight_ratio) = weight_range(surface.weights());
        self.net[old.net_range()]
            .iter_mut()
            .zip(homogeneous::<R>((surface.points(), surface.weights()), frame, largest))
            .for_each(|(slot, p)| *slot = p);
        let mut at = old.bezier as usize;
        for (_, patch) in self.patches(surface) {
            let size = patch.points.len();
            let slots = &mut self.bezier[at..at + size];
            slots
                .iter_mut()
                .zip(homogeneous::<R>((&patch.points, patch.weights.as_deref()), frame, largest))
                .for_each(|(slot, p)| *slot = p);
            at += size;
        }
        let entry = SurfaceEntry { frame, weight_ratio, directions, ..old };
        let same = (entry.frame, entry.weight_ratio)
            == (self.entries[index].frame, self.entries[index].weight_ratio);
        let edit = Edit {
            points: !same || net != self.net[entry.net_range()],
            knots: knots != self.knots_of(&entry),
        };
        self.entries[index] = entry;
        Ok(edit)
    }

    /// All that the device knows of the knots of a surface.
    fn knots_of(&self, entry: &SurfaceEntry) -> Vec<(Vec<R>, Vec<Span>)> {
        let of = |d: &DirectionEntry| (self.windows[d.windows()].to_vec(), self.spans[d.spans()].to_vec());
        entry.directions.iter().map(of).collect()
    }

    /// The knots of all directions for the search on the device; direction `2 i + axis` is that of surface i.
    pub(crate) fn search_tables(&self) -> (Vec<Direction>, Vec<R>) {
        let (mut directions, mut breaks) = (Vec::new(), Vec::new());
        for d in self.entries.iter().flat_map(|e| &e.directions) {
            directions.push(Direction {
                breaks: breaks.len() as u32,
                span: d.span,
                count: d.breaks.len() as u32 - 1,
                spare: 0,
            });
            breaks.extend(d.breaks.iter().map(|&b| R::from_f64(b)));
        }
        (directions, breaks)
    }
}

impl SurfaceEntry {
    /// The ends of the knot spans along u and along v, increasing, one more than spans.
    pub fn breaks(&self) -> [&[f64]; 2] {
        [&self.directions[0].breaks, &self.directions[1].breaks]
    }

    /// Its control points in the set.
    pub(crate) fn net_range(&self) -> Range<usize> {
        self.net as usize..(self.net + self.points) as usize
    }

    /// Its Bézier control points in the set.
    pub(crate) fn bezier_range(&self) -> Range<usize> {
        self.bezier as usize..(self.bezier + self.beziers) as usize
    }

    /// How far a point that a kernel finds in precision `R` may lie from the exact one **at the parameters
    /// within the span that the kernel was given**, plus what rounding those costs; in the model's units.
    /// Positive weights.
    ///
    /// Each basis function carries at most 4 roundings a level, each product and sum of the two loops one,
    /// the division three; they are relative because no term is negative, and hit numerator and denominator:
    /// 2 (4 (p + q) + p + q + 8) units. A rounded parameter moves the point by the derivative within the
    /// span, at most 2 p ρ for weights between 1 and ρ, times half a unit; rounded knots count as much again.
    /// What comes before the kernel, in the model's own coordinates and double precision, costs as many of
    /// its units of the surface's distance from the origin: all that is left of a surface that is as small as
    /// those.
    pub fn point_bound<R: Real>(&self) -> f64 {
        let n = (self.degree[0] + self.degree[1]) as f64;
        let units = 10.0 * n + 16.0 + 4.0 * n * self.weight_ratio;
        // Local coordinates reach √3 from the middle.
        let radius = self.frame.size * 3.0_f64.sqrt();
        units * (radius * R::UNIT + (self.frame.middle.length() + radius) * f64::UNIT)
    }
}

/// The middle of the points' box and half its largest side.
fn local_frame(points: &[DVec3]) -> LocalFrame {
    let fold = |f: fn(DVec3, DVec3) -> DVec3| points.iter().copied().reduce(f).unwrap_or(DVec3::ZERO);
    let (low, high) = (fold(DVec3::min), fold(DVec3::max));
    let size = 0.5 * (high - low).max_element();
    LocalFrame { middle: 0.5 * low + 0.5 * high, size: if size > 0.0 { size } else { 1.0 } }
}

/// The largest weight, and its ratio to the smallest, by size.
fn weight_range(weights: Option<&[f64]>) -> (f64, f64) {
    let Some(weights) = weights else { return (1.0, 1.0) };
    let sizes = || weights.iter().map(|w| w.abs());
    let (low, high) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    (high, high / low)
}

fn homogeneous<R: Real>(
    net: (&[DVec3], Option<&[f64]>),
    frame: LocalFrame,
    largest: f64,
) -> impl Iterator<Item = [R; 4]> {
    let (points, weights) = net;
    points.iter().enumerate().map(move |(i, &p)| {
        let w = weights.map_or(1.0, |w| w[i] / largest);
        let p = (p - frame.middle) / frame.size * w;
        [p.x, p.y, p.z, w].map(R::from_f64)
    })
}

//! Where surfaces are evaluated: grids of any size, lists of (u, v), any number of them in one dispatch.

use crate::error::GpuError;
use crate::layout::{Head, Row, Span, Tile};
use crate::real::Real;
use crate::surfaces::SurfaceSet;
use chordal_nurbs::DVec2;

/// A grid or list on one surface of a set.
#[derive(Clone, Debug)]
pub enum Request {
    /// All pairs of these parameters; results run through v fastest.
    Grid {
        /// The surface, by index.
        surface: usize,
        /// The parameters along u.
        us: Vec<f64>,
        /// The parameters along v.
        vs: Vec<f64>,
    },
    /// These points. [`Samples::new`] keeps their order; sorting them by knot span first makes memory access
    /// regular.
    Points {
        /// The surface, by index.
        surface: usize,
        /// The parameters of each point.
        uvs: Vec<DVec2>,
    },
}

impl Request {
    /// A grid of `width` × `height` points spread evenly over the whole domain.
    pub fn even_grid<R: Real>(set: &SurfaceSet<R>, surface: usize, width: usize, height: usize) -> Self {
        let spread = |axis: usize, count: usize| {
            let breaks = &set.entries()[surface].directions[axis].breaks;
            let (start, end) = (breaks[0], breaks[breaks.len() - 1]);
            let step = |i: usize| start + (end - start) * (i as f64 / (count.max(2) - 1) as f64);
            (0..count).map(step).collect()
        };
        Self::Grid { surface, us: spread(0, width), vs: spread(1, height) }
    }

    /// Points of one curve.
    pub fn curve(surface: usize, ts: Vec<f64>) -> Self {
        Self::Grid { surface, us: ts, vs: vec![0.0] }
    }

    fn surface(&self) -> usize {
        match self {
            Self::Grid { surface, .. } | Self::Points { surface, .. } => *surface,
        }
    }
}

/// Points sorted by the span they lie in, and the place of each in the list they came from.
pub fn sorted_by_span<R: Real>(
    set: &SurfaceSet<R>,
    surface: usize,
    uvs: &[DVec2],
) -> (Vec<DVec2>, Vec<usize>) {
    let directions = &set.entries()[surface].directions;
    let key = |i: &usize| (directions[0].locate(uvs[*i].x).0, directions[1].locate(uvs[*i].y).0);
    let mut order: Vec<usize> = (0..uvs.len()).collect();
    order.sort_by_key(key);
    (order.iter().map(|&i| uvs[i]).collect(), order)
}

/// Requests as the kernels read them.
#[derive(Clone, Debug, Default)]
pub struct Samples<R> {
    pub(crate) heads: Vec<Head>,
    pub(crate) tiles: Vec<Tile>,
    /// Span of every parameter value.
    pub(crate) row_spans: Vec<u32>,
    /// Place of every parameter value in its span, 0..=1.
    pub(crate) ts: Vec<R>,
    /// The parameters themselves and the direction (2 surface + axis) of each, for the search on the device.
    pub(crate) parameters: Vec<R>,
    pub(crate) row_directions: Vec<u32>,
    /// Per request: number of its first point, and how many it has.
    ranges: Vec<(usize, usize)>,
    /// Per request: the end of its heads.
    head_ends: Vec<usize>,
    points: usize,
}

/// The most points of one head. Outputs are cut between heads, so that grids of any size can be cut.
pub(crate) const HEAD_POINTS: usize = 1 << 16;

impl<R: Real> Samples<R> {
    /// Prepares requests; spans are found here.
    ///
    /// # Errors
    /// [`GpuError::NoSuchSurface`]; [`GpuError::TooManyPoints`] above 2³² points.
    pub fn new(set: &SurfaceSet<R>, requests: &[Request]) -> Result<Self, GpuError> {
        let mut samples = Self::default();
        for request in requests {
            let first = samples.points;
            let surface = request.surface();
            if surface >= set.len() {
                return Err(GpuError::NoSuchSurface(surface));
            }
            match request {
                Request::Grid { us, vs, .. } => samples.push_grid(set, surface, us, vs),
                Request::Points { uvs, .. } => samples.push_points(set, surface, uvs),
            }
            samples.ranges.push((first, samples.points - first));
            samples.head_ends.push(samples.heads.len());
            if samples.points > u32::MAX as usize {
                return Err(GpuError::TooManyPoints(samples.points));
            }
        }
        Ok(samples)
    }

    /// The number of all points.
    pub fn len(&self) -> usize {
        self.points
    }
    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.points == 0
    }
    /// The points of request `index`: a range of the output, in points.
    pub fn range(&self, index: usize) -> std::ops::Range<usize> {
        let (first, count) = self.ranges[index];
        first..first + count
    }
    /// Bytes that go to the device for every new set of parameters.
    pub fn bytes(&self) -> usize {
        self.heads.len() * size_of::<Head>()
            + self.tiles.len() * size_of::<Tile>()
            + self.ts.len() * (size_of::<Row>() + size_of::<R>())
    }

    fn rows(
        &mut self,
        set: &SurfaceSet<R>,
        surface: usize,
        axis: usize,
        ts: impl Iterator<Item = f64>,
    ) -> u32 {
        let direction = &set.entries[surface].directions[axis];
        let first = self.ts.len() as u32;
        for t in ts {
            let (span, place) = direction.locate(t);
            self.row_spans.push(span);
            self.ts.push(R::from_f64(place));
            self.parameters.push(R::from_f64(t));
            self.row_directions.push((2 * surface + axis) as u32);
        }
        first
    }

    fn head(&self, set: &SurfaceSet<R>, surface: usize) -> Head {
        let entry = &set.entries[surface];
        Head {
            net: entry.net,
            stride: entry.stride,
            bezier: entry.bezier,
            cells_v: entry.directions[1].breaks.len() as u32 - 1,
            first: self.points as u32,
            ..Head::default()
        }
    }

    fn push_grid(&mut self, set: &SurfaceSet<R>, surface: usize, us: &[f64], vs: &[f64]) {
        let row_u = self.rows(set, surface, 0, us.iter().copied());
        let row_v = self.rows(set, surface, 1, vs.iter().copied());
        if vs.is_empty() {
            return;
        }
        let most = (HEAD_POINTS / vs.len()).max(8);
        for start in (0..us.len()).step_by(most) {
            let width = most.min(us.len() - start) as u32;
            let head = Head {
                row_u: row_u + start as u32,
                row_v,
                width,
                height: vs.len() as u32,
                ..self.head(set, surface)
            };
            self.push_head(head);
        }
    }

    fn push_points(&mut self, set: &SurfaceSet<R>, surface: usize, uvs: &[DVec2]) {
        let row_u = self.rows(set, surface, 0, uvs.iter().map(|p| p.x));
        let row_v = self.rows(set, surface, 1, uvs.iter().map(|p| p.y));
        for start in (0..uvs.len()).step_by(HEAD_POINTS) {
            let width = HEAD_POINTS.min(uvs.len() - start) as u32;
            let head = Head {
                row_u: row_u + start as u32,
                row_v: row_v + start as u32,
                width,
                height: 1,
                paired: 1,
                ..self.head(set, surface)
            };
            self.push_head(head);
        }
    }

    /// The heads of each request.
    pub(crate) fn request_heads(&self) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        let starts = std::iter::once(0).chain(self.head_ends.iter().copied());
        starts.zip(&self.head_ends).map(|(start, &end)| start..end)
    }

    /// These heads by themselves, with the rows that they read; the first of their points is number 0.
    pub(crate) fn part(&self, heads: std::ops::Range<usize>) -> Self {
        let mut part = Self::default();
        // The rows along v of a grid that is cut into heads are the same for all of them.
        let mut shared = None;
        for head in &self.heads[heads] {
            let row_u = part.copy_rows(self, head.row_u, head.width);
            let row_v = match shared {
                Some((from, to)) if from == head.row_v && head.paired == 0 => to,
                _ => {
                    let count = if head.paired == 1 { head.width } else { head.height };
                    part.copy_rows(self, head.row_v, count)
                }
            };
            shared = (head.paired == 0).then_some((head.row_v, row_v));
            part.push_head(Head { row_u, row_v, first: part.points as u32, ..*head });
        }
        part
    }

    fn copy_rows(&mut self, from: &Self, first: u32, count: u32) -> u32 {
        let (at, range) = (self.ts.len() as u32, first as usize..(first + count) as usize);
        self.row_spans.extend_from_slice(&from.row_spans[range.clone()]);
        self.ts.extend_from_slice(&from.ts[range.clone()]);
        self.parameters.extend_from_slice(&from.parameters[range.clone()]);
        self.row_directions.extend_from_slice(&from.row_directions[range]);
        at
    }

    fn push_head(&mut self, head: Head) {
        let index = self.heads.len() as u32;
        let tile = |i, j| Tile { head: index, i, j, spare: 0 };
        if head.paired == 1 {
            self.tiles.extend((0..head.width).step_by(64).map(|i| tile(i, 0)));
        } else {
            for i in (0..head.width).step_by(8) {
                self.tiles.extend((0..head.height).step_by(8).map(|j| tile(i, j)));
            }
        }
        self.points += head.points() as usize;
        self.heads.push(head);
    }

    /// Rows without knots of their own.
    pub(crate) fn plain_rows(&self) -> Vec<Row> {
        self.row_spans.iter().map(|&span| Row { span, ..Row::default() }).collect()
    }
}

/// Rows for one of the paper's three layouts of knots, with the knots where rows carry their own.
#[derive(Clone, Debug, Default)]
pub(crate) struct RowTables<R> {
    pub rows: Vec<Row>,
    /// Of the packed layout: one record per four rows.
    pub packs: Vec<Row>,
    /// A parameter and its knots, row by row; of the packed layout four by four.
    pub windows: Vec<R>,
    /// Length of one half of the basis buffer.
    pub half: usize,
    pub levels: u32,
}

impl<R: Real> RowTables<R> {
    /// The knots stay with the spans.
    pub fn indexed(set: &SurfaceSet<R>, samples: &Samples<R>, planes: usize) -> Self {
        let mut tables = Self::default();
        for &index in &samples.row_spans {
            let span = set.spans[index as usize];
            tables.rows.push(Row { span: index, window: span.window, basis: tables.half as u32, step: 1 });
            tables.grow(span, planes);
        }
        tables
    }

    /// Every row has its parameter and a copy of its knots.
    pub fn unpacked(set: &SurfaceSet<R>, samples: &Samples<R>, planes: usize) -> Self {
        let mut tables = Self::default();
        for (&index, &t) in samples.row_spans.iter().zip(&samples.ts) {
            let span = set.spans[index as usize];
            let window = tables.windows.len() as u32;
            tables.windows.push(t);
            tables.windows.extend_from_slice(knots_of(set, span));
            tables.rows.push(Row { span: index, window, basis: tables.half as u32, step: 1 });
            tables.grow(span, planes);
        }
        tables
    }

    /// Four rows of one degree share vectors of four; the last pack of a direction repeats its last row.
    pub fn packed(set: &SurfaceSet<R>, samples: &Samples<R>, planes: usize) -> Self {
        let mut tables = Self::default();
        let all: Vec<usize> = (0..samples.ts.len()).collect();
        let degree = |row: usize| set.spans[samples.row_spans[row] as usize].degree;
        for direction in all.chunk_by(|&a, &b| samples.row_directions[a] == samples.row_directions[b]) {
            for pack in direction.chunks(4) {
                let lanes: [usize; 4] = std::array::from_fn(|lane| pack[lane.min(pack.len() - 1)]);
                let basis = tables.half as u32;
                tables.packs.push(Row {
                    span: degree(pack[0]),
                    window: tables.windows.len() as u32 / 4,
                    basis: basis / 4,
                    step: 1,
                });
                for (lane, &row) in pack.iter().enumerate() {
                    let span = samples.row_spans[row];
                    tables.rows.push(Row { span, window: 0, basis: basis + lane as u32, step: 4 });
                }
                tables.windows.extend(lanes.iter().map(|&row| samples.ts[row]));
                let knots = lanes.map(|row| knots_of(set, set.spans[samples.row_spans[row] as usize]));
                for c in 0..knots[0].len() {
                    tables.windows.extend(knots.iter().map(|k| k[c]));
                }
                let span = set.spans[samples.row_spans[pack[0]] as usize];
                (0..4).for_each(|_| tables.grow(span, planes));
            }
        }
        tables
    }

    fn grow(&mut self, span: Span, planes: usize) {
        self.half += planes * (span.degree as usize + 1);
        self.levels = self.levels.max(span.degree);
    }
}

/// The 2 p + 2 knots around a span, in its own coordinates.
pub(crate) fn knots_of<R>(set: &SurfaceSet<R>, span: Span) -> &[R] {
    let at = span.window as usize + 1;
    &set.windows[at..at + 2 * span.degree as usize + 2]
}

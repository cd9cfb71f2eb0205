//! How much time and memory a file may take: limits for each face and for all together.
//!
//! A file may take its limits per megabyte, and the more the finer its tolerance: the work grows with both.
//! Limits are limits of counted work, so that they give up the same faces on every machine
//! ([`chordal_nurbs::work`]). Where all faces together would take more than the file may, they are meshed
//! anew with an equal share of half as much for each: then a few hostile faces fail, and the others are
//! meshed.

use crate::placement::PartUse;
use chordal_brep::{Issue, Model, Part, ResultIssue, Severity, Source};
use chordal_tessellate::{FileBudget, Options};
use std::time::Duration;

/// Faces and edges of sound files take milliseconds, one of degree 100 takes three seconds; a few hostile
/// ones must not take minutes.
const FACE_TIMEOUT: Duration = Duration::from_secs(4);

/// The methods of the literature take seconds where the default takes a tenth of one.
const METHOD_TIMEOUT: Duration = Duration::from_secs(60);

/// A gigabyte is what small machines have to spare.
const MEMORY: u64 = 1_000_000_000;

/// Memory that a triangle takes while its face is meshed, with its vertices and neighbours.
const BYTES_PER_TRIANGLE: u64 = 250;

/// Files up to this size have the limits as they are; larger ones have more.
const BYTES_OF_SMALL_FILE: f64 = 1e6;

/// Models that are not from a file count as if every face had this many bytes: about the mean of
/// STEP files.
const BYTES_PER_FACE: f64 = 2000.0;

/// Tolerances up to this share of the diagonal have the limits as they are; finer ones have more.
const ORDINARY_TOLERANCE: f64 = 1e-3;

/// What the faces of a file may take.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WorkLimits {
    /// Processor time of one face or edge.
    pub face_timeout: Option<Duration>,
    /// Processor time of all faces and edges together, per megabyte of the file and at 0.1 %.
    pub file_timeout: Option<Duration>,
    /// Bytes that the triangles of the file may take, per megabyte of the file and at 0.1 %.
    pub memory: Option<u64>,
}

/// Limits as far as the caller set them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RequestedLimits {
    pub face_timeout: Option<Option<Duration>>,
    pub file_timeout: Option<Option<Duration>>,
    pub memory: Option<Option<u64>>,
}

impl RequestedLimits {
    /// With defaults for the values that the caller did not set.
    pub fn resolved(&self, has_methods: bool) -> WorkLimits {
        let default = if has_methods { METHOD_TIMEOUT } else { FACE_TIMEOUT };
        let face_timeout = self.face_timeout.unwrap_or(Some(default));
        WorkLimits {
            face_timeout,
            file_timeout: self.file_timeout.unwrap_or(face_timeout),
            memory: self.memory.unwrap_or(Some(MEMORY)),
        }
    }
}

/// The limits of one file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FileLimits {
    limits: WorkLimits,
    /// How many times the limits of a small file it has.
    scale: f64,
    /// Faces and edges that are placed.
    items: usize,
}

/// How the limits of a file were kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Kept {
    /// Seconds of an ordinary core that faces and edges took, by counted work.
    pub work: f64,
    /// Where the file took more than it may.
    pub shares: Option<EqualShares>,
}

/// Each face and edge was given a share of what the file may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EqualShares {
    pub time: Option<Duration>,
    pub triangles: usize,
}

impl EqualShares {
    /// Tells that the file took more than it may.
    pub fn issue(&self) -> Issue {
        let seconds = self.time.map(|time| time.as_secs_f64());
        let shared = ResultIssue::SharedLimits { seconds, triangles: self.triangles };
        Issue::new(Severity::Warning, Source::default(), shared)
    }
}

impl FileLimits {
    /// `bytes`: the size of the file; `fineness`: tolerance over diagonal.
    pub fn new(limits: WorkLimits, model: &Model, uses: &[PartUse], bytes: u64, fineness: f64) -> Self {
        let placed = || model.parts.iter().zip(uses).filter(|(_, u)| u.instances > 0).map(|(part, _)| part);
        let count = |number: fn(&Part) -> usize| placed().map(number).sum::<usize>();
        let (faces, edges) = (count(|p| p.faces.len()), count(|p| p.edges.len()));
        let size = (bytes as f64).max(BYTES_PER_FACE * faces as f64) / BYTES_OF_SMALL_FILE;
        let fine = ORDINARY_TOLERANCE / fineness;
        let scale = size.max(1.0) * if fine.is_finite() { fine.max(1.0) } else { 1.0 };
        Self { limits, scale, items: (faces + edges).max(1) }
    }

    /// This share of the limits, also of those of single faces.
    pub fn part_of(self, share: f64) -> Self {
        let face_timeout = self.limits.face_timeout.map(|time| time.mul_f64(share));
        let limits = WorkLimits { face_timeout, ..self.limits };
        Self { limits, scale: self.scale * share, ..self }
    }

    fn time(&self) -> Option<Duration> {
        self.limits.file_timeout.and_then(|t| Duration::try_from_secs_f64(t.as_secs_f64() * self.scale).ok())
    }

    fn triangles(&self) -> usize {
        let most = |bytes: u64| (bytes / BYTES_PER_TRIANGLE) as f64 * self.scale;
        self.limits.memory.map_or(usize::MAX, |bytes| most(bytes) as usize)
    }

    /// Options with the limits of single faces.
    pub fn face_options(&self, options: Options) -> Options {
        options.with_face_timeout(self.limits.face_timeout)
    }

    /// Meshes with options that carry the limits; where the file takes more, once more with equal shares.
    pub fn keep<T>(&self, options: &[Options], mesh: impl Fn(&[Options]) -> T) -> (T, Kept) {
        let budget = FileBudget::new(self.time(), self.triangles());
        let limited = |one: &Options| {
            let triangles = one.face_triangles.min(self.triangles());
            one.clone().with_file_budget(Some(budget.clone())).with_face_triangles(triangles)
        };
        let meshed = mesh(&options.iter().map(limited).collect::<Vec<_>>());
        if !budget.is_spent() {
            return (meshed, Kept { work: budget.seconds_taken(), shares: None });
        }
        drop(meshed);
        let shares = EqualShares {
            time: self.time().map(|time| time / u32::try_from(2 * self.items).unwrap_or(u32::MAX)),
            triangles: (self.triangles() / (2 * self.items)).max(1),
        };
        let budget = FileBudget::new(None, usize::MAX);
        let shared = |one: &Options| {
            let time = [one.face_timeout, shares.time].into_iter().flatten().min();
            let triangles = one.face_triangles.min(shares.triangles);
            let one = one.clone().with_file_budget(Some(budget.clone()));
            one.with_face_timeout(time).with_face_triangles(triangles)
        };
        let meshed = mesh(&options.iter().map(shared).collect::<Vec<_>>());
        (meshed, Kept { work: budget.seconds_taken(), shares: Some(shares) })
    }
}

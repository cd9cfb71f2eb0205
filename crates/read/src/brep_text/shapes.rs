//! The topological records: what each shape is made of, before anything is built from it.

use super::curves::point;
use super::tokens::{Stop, Tokens};
use chordal_brep::ReadIssue;
use chordal_nurbs::{DVec3, Range};

/// The position of a record in the file.
pub(crate) type Ix = usize;

/// How a shape uses another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Orientation {
    Forward,
    Reversed,
    /// Within the shape rather than on its boundary, or outside it.
    Aside,
}

/// One use of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sub {
    pub shape: Ix,
    pub orientation: Orientation,
    /// The number of the location in the file.
    pub location: i64,
}

/// An edge's curve on a surface; numbers of the file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OnSurface {
    /// For the edge used forward, and on closed surfaces for the edge used backward.
    pub curves: [i64; 2],
    pub surface: i64,
    pub location: i64,
    pub range: Range,
}

/// The geometry of an edge; numbers of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct EdgeData {
    pub degenerated: bool,
    pub tolerance: f64,
    /// Curve, its location, range.
    pub curve: Option<(i64, i64, Range)>,
    pub on_surfaces: Vec<OnSurface>,
}

/// The geometry of a face; numbers of the file, 0 for none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FaceData {
    pub surface: i64,
    pub location: i64,
    pub triangulation: i64,
}

/// What a record is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    Vertex { point: DVec3, tolerance: f64 },
    Edge(EdgeData),
    Wire,
    Face(FaceData),
    Shell,
    Solid,
    CompSolid,
    Compound,
}

/// One record.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    pub kind: Kind,
    pub closed: bool,
    pub subs: Vec<Sub>,
    pub line: u32,
    /// What is wrong with some of what it uses, which is left out.
    pub problem: Option<ReadIssue>,
}

/// Reads the record at position `ix` of `count`; it may use only records before it.
pub(crate) fn shape(
    tokens: &mut Tokens<'_>,
    version: u32,
    ix: Ix,
    count: usize,
) -> Result<Result<Shape, ReadIssue>, Stop> {
    let line = tokens.line();
    let kind = match tokens.word() {
        b"Ve" => vertex(tokens)?,
        b"Ed" => Kind::Edge(edge(tokens, version)?),
        b"Wi" => Kind::Wire,
        b"Fa" => Kind::Face(face(tokens)?),
        b"Sh" => Kind::Shell,
        b"So" => Kind::Solid,
        b"CS" => Kind::CompSolid,
        b"Co" => Kind::Compound,
        word => {
            let word = String::from_utf8_lossy(&word[..word.len().min(20)]).into_owned();
            return Err(Stop {
                line,
                issue: ReadIssue::Expected { expected: "the kind of a shape", found: word },
            });
        }
    };
    let flags = tokens.word();
    if flags.len() != 7 || !flags.iter().all(|b| matches!(b, b'0' | b'1')) {
        return Err(Stop { line, issue: ReadIssue::Missing { what: "seven flags of the shape" } });
    }
    let closed = flags[4] == b'1';
    let mut subs = Vec::new();
    let mut bad = None;
    while let Some((number, orientation, location)) = reference(tokens)? {
        // Records are numbered from the last to the first.
        let target = usize::try_from(number).ok().and_then(|n| count.checked_sub(n)).filter(|&t| t < ix);
        match target {
            Some(shape) => subs.push(Sub { shape, orientation, location }),
            None => bad = Some(ReadIssue::NotFound { what: "earlier shape", number }),
        }
    }
    Ok(match bad {
        Some(message) if matches!(kind, Kind::Vertex { .. } | Kind::Edge(_)) => Err(message),
        problem => Ok(Shape { kind, closed, subs, line, problem }),
    })
}

/// `+12 0`: orientation with number, and location; `None` at the `*` that ends a list.
pub(crate) fn reference(tokens: &mut Tokens<'_>) -> Result<Option<(i64, Orientation, i64)>, Stop> {
    let word = tokens.peek();
    let orientation = match word.first() {
        Some(b'*') => {
            tokens.word();
            return Ok(None);
        }
        Some(b'+') => Orientation::Forward,
        Some(b'-') => Orientation::Reversed,
        Some(b'i' | b'e') => Orientation::Aside,
        _ => return Err(tokens.stop("a reference to a shape")),
    };
    let number = std::str::from_utf8(&word[1..]).ok().and_then(|text| text.parse().ok());
    let Some(number) = number else { return Err(tokens.stop("the number of a shape")) };
    tokens.word();
    Ok(Some((number, orientation, tokens.integer()?)))
}

/// Tolerance, point, and representations on curves and surfaces, which are passed over: the point is what
/// counts.
fn vertex(tokens: &mut Tokens<'_>) -> Result<Kind, Stop> {
    let tolerance = tokens.real()?;
    let point = point(tokens)?;
    loop {
        tokens.real()?;
        match tokens.integer()? {
            0 => return Ok(Kind::Vertex { point, tolerance }),
            1 => {
                tokens.integer()?;
            }
            2 => {
                tokens.integer()?;
                tokens.integer()?;
            }
            3 => {
                tokens.real()?;
                tokens.integer()?;
            }
            _ => return Err(tokens.stop("the kind of a point's representation")),
        }
        tokens.integer()?;
    }
}

fn edge(tokens: &mut Tokens<'_>, version: u32) -> Result<EdgeData, Stop> {
    let tolerance = tokens.real()?;
    // Same parameter and same range promise what the model checks for itself.
    tokens.flag()?;
    tokens.flag()?;
    let mut data = EdgeData { degenerated: tokens.flag()?, tolerance, ..EdgeData::default() };
    loop {
        match tokens.integer()? {
            0 => return Ok(data),
            1 => {
                let (curve, location) = (tokens.integer()?, tokens.integer()?);
                let range = Range::new(tokens.real()?, tokens.real()?);
                if curve != 0 {
                    data.curve = Some((curve, location, range));
                }
            }
            kind @ (2 | 3) => {
                let first = tokens.integer()?;
                let mut curves = [first, first];
                if kind == 3 {
                    curves[1] = tokens.integer()?;
                    tokens.continuity()?;
                }
                let (surface, location) = (tokens.integer()?, tokens.integer()?);
                let range = Range::new(tokens.real()?, tokens.real()?);
                if version == 2 {
                    // The ends of the curve, for readers that do not evaluate it.
                    for _ in 0..4 {
                        tokens.real()?;
                    }
                }
                data.on_surfaces.push(OnSurface { curves, surface, location, range });
            }
            4 => {
                tokens.continuity()?;
                skip_integers(tokens, 4)?;
            }
            5 => skip_integers(tokens, 2)?,
            6 => skip_integers(tokens, 3)?,
            7 => skip_integers(tokens, 4)?,
            _ => return Err(tokens.stop("the kind of an edge's representation")),
        }
    }
}

fn face(tokens: &mut Tokens<'_>) -> Result<FaceData, Stop> {
    let mut data = FaceData::default();
    // Natural restriction; 2 stands there where the face has a triangulation and nothing else.
    if tokens.peek() != b"2" {
        tokens.flag()?;
        tokens.real()?;
        data.surface = tokens.integer()?;
        data.location = tokens.integer()?;
    }
    if tokens.take(b"2") {
        data.triangulation = tokens.integer()?;
    }
    Ok(data)
}

fn skip_integers(tokens: &mut Tokens<'_>, count: usize) -> Result<(), Stop> {
    for _ in 0..count {
        tokens.integer()?;
    }
    Ok(())
}

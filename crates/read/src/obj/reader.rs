//! The statements of a file in their order.

use super::basis::Basis;
use super::element::{Attributes, CurveUse, Element, Kind, LoopUse, homogeneous, homogeneous2};
use super::lines::{Statement, Statements, number, position, text};
use super::polygons::Polygons;
use crate::assemble::Notes;
use crate::trimmed::{Look, add_body, add_faces, add_failed};
use chordal_brep::{BodyKind, FaceId, Issue, LooseItem, LooseKind, Part, ReadIssue, Source};
use chordal_nurbs::{Curve2, DVec2, DVec3, DVec4, UvBox};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// A file's part and what was noted on the way.
pub(super) struct Read {
    /// How many statements there are.
    pub statements: usize,
    pub part: Part,
    pub issues: Vec<Issue>,
}

/// A vertex and its weight; not finite where its statement made no sense.
type Weighted<P> = (P, f64);

#[derive(Debug, Default)]
struct Reader {
    part: Part,
    notes: Notes,
    points: Vec<DVec3>,
    weights: Vec<f64>,
    parameters: Vec<Weighted<DVec2>>,
    attributes: Attributes,
    /// The element whose body is being read.
    open: Option<Element>,
    curves: Vec<Result<Curve2, ReadIssue>>,
    surfaces: usize,
    connections: usize,
    object: String,
    group: String,
    material: String,
    polygons: Polygons,
    /// Faces by object or group, in the order of their first face.
    bodies: Vec<(String, Vec<FaceId>, Source)>,
    body_of: FxHashMap<String, usize>,
    /// Statements that are passed over, by keyword: the first line and how many there are.
    passed: Vec<(String, u32, usize)>,
}

pub(super) fn read(bytes: &[u8]) -> Read {
    let mut reader = Reader::default();
    let mut statements = 0;
    for statement in Statements::new(bytes) {
        statements += 1;
        reader.statement(&statement);
    }
    Read { statements, ..reader.finish() }
}

impl Reader {
    fn statement(&mut self, statement: &Statement) {
        let words: Vec<&[u8]> = statement.words().collect();
        let Some((keyword, rest)) = words.split_first() else { return };
        let source = Source { entity: 0, line: statement.line };
        match *keyword {
            b"v" => self.vertex(rest, source),
            b"vp" => self.parameter_vertex(rest, source),
            b"cstype" | b"deg" | b"step" | b"bmat" => self.attribute(keyword, rest, source),
            b"f" | b"fo" => self.polygon(rest, source),
            b"curv" | b"curv2" | b"surf" => self.element(keyword, rest, source),
            b"parm" | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" => self.body(keyword, rest, source),
            b"p" | b"l" => {
                self.loose(if *keyword == b"p" { LooseKind::Point } else { LooseKind::Wire }, source)
            }
            b"o" | b"g" | b"usemtl" => self.named(keyword, rest),
            b"con" => self.connections += 1,
            // Textures, normals, and what only renderers need.
            b"vt" | b"vn" | b"s" | b"mg" | b"bevel" | b"c_interp" | b"d_interp" | b"lod" | b"mtllib"
            | b"usemap" | b"maplib" | b"shadow_obj" | b"trace_obj" | b"ctech" | b"stech" | b"vw" | b"vc" => {}
            other => self.pass_over(other, statement.line),
        }
    }

    fn vertex(&mut self, words: &[&[u8]], source: Source) {
        let numbers: Option<Vec<f64>> = words.iter().map(|word| number(word)).collect();
        let (point, weight) = match numbers.as_deref() {
            // Some programs write a colour behind the coordinates.
            Some(&[x, y, z] | &[x, y, z, _, _, _] | &[x, y, z, _, _, _, _]) => (DVec3::new(x, y, z), 1.0),
            Some(&[x, y, z, w]) => (DVec3::new(x, y, z), w),
            _ => {
                self.notes.warn(
                    source,
                    ReadIssue::Expected {
                        expected: "three or four numbers of a vertex",
                        found: joined(words),
                    },
                );
                (DVec3::NAN, 1.0)
            }
        };
        self.points.push(point);
        self.weights.push(weight);
    }

    fn parameter_vertex(&mut self, words: &[&[u8]], source: Source) {
        let numbers: Option<Vec<f64>> = words.iter().map(|word| number(word)).collect();
        let vertex = match numbers.as_deref() {
            Some(&[u]) => (DVec2::new(u, 0.0), 1.0),
            Some(&[u, v]) => (DVec2::new(u, v), 1.0),
            Some(&[u, v, w]) => (DVec2::new(u, v), w),
            _ => {
                self.notes.warn(
                    source,
                    ReadIssue::Expected {
                        expected: "one to three numbers of a parameter vertex",
                        found: joined(words),
                    },
                );
                (DVec2::NAN, 1.0)
            }
        };
        self.parameters.push(vertex);
    }

    fn attribute(&mut self, keyword: &[u8], words: &[&[u8]], source: Source) {
        let now = &mut self.attributes;
        let understood = match keyword {
            b"cstype" => {
                let rational = words.first().is_some_and(|word| *word == b"rat");
                now.rational = rational;
                now.basis = match words.get(usize::from(rational)) {
                    Some(&b"bspline") => Some(Basis::Bspline),
                    Some(&b"bezier") => Some(Basis::Bezier),
                    Some(&b"cardinal") => Some(Basis::Cardinal),
                    Some(&b"taylor") => Some(Basis::Taylor),
                    Some(&b"bmatrix") => Some(Basis::Matrix),
                    _ => None,
                };
                now.basis.is_some()
            }
            b"deg" => pair(words, &mut now.degree),
            b"step" => pair(words, &mut now.step),
            _ => {
                let numbers: Option<Arc<[f64]>> = words.iter().skip(1).map(|word| number(word)).collect();
                match (words.first(), numbers) {
                    (Some(&b"u"), Some(numbers)) => now.matrix[0] = numbers,
                    (Some(&b"v"), Some(numbers)) => now.matrix[1] = numbers,
                    _ => now.matrix = [Arc::new([]), Arc::new([])],
                }
                now.matrix.iter().any(|m| !m.is_empty())
            }
        };
        if !understood {
            self.notes.warn(source, ReadIssue::BadStatement { keyword: text(keyword).to_string() });
        }
    }

    fn polygon(&mut self, words: &[&[u8]], source: Source) {
        let corners: Option<Vec<usize>> = words.iter().map(|word| self.point_at(word)).collect();
        match corners {
            Some(corners) if corners.len() > 2 => {
                let name = if self.group.is_empty() { &self.object } else { &self.group };
                self.polygons.add(&corners, &self.points, name, source);
            }
            Some(_) => self
                .notes
                .lose(source, ReadIssue::TooFew { what: "polygon corners", found: words.len(), least: 3 }),
            None => self.notes.lose(source, ReadIssue::PolygonsLost { polygons: 1 }),
        }
    }

    /// The position of the vertex in `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn point_at(&self, word: &[u8]) -> Option<usize> {
        let digits = word.split(|&b| b == b'/').next()?;
        position(digits, self.points.len()).filter(|&at| self.points[at].is_finite())
    }

    fn element(&mut self, keyword: &[u8], words: &[&[u8]], source: Source) {
        if let Some(open) = self.open.take() {
            self.notes.warn(open.source, ReadIssue::Missing { what: "end statement" });
            self.close(open);
        }
        let rational = self.attributes.rational;
        let kind = match keyword {
            b"curv" => Kind::Curve,
            b"curv2" => Kind::Curve2(self.parameter_points(words, rational)),
            _ => {
                let numbers: Vec<f64> = words.iter().take(4).map_while(|word| number(word)).collect();
                let range = match numbers[..] {
                    [u0, u1, v0, v1] => Some(UvBox::new(DVec2::new(u0, v0), DVec2::new(u1, v1))),
                    _ => None,
                };
                let points = words.iter().skip(4).map(|word| self.control_point(word, rational));
                Kind::Surface { range, points: points.collect() }
            }
        };
        let attributes = self.attributes.clone();
        self.open = Some(Element {
            kind,
            attributes,
            parameters: [Vec::new(), Vec::new()],
            loops: Vec::new(),
            source,
        });
    }

    fn parameter_points(&self, words: &[&[u8]], rational: bool) -> Result<Vec<DVec3>, ReadIssue> {
        let point = |word: &&[u8]| {
            let at = position(word, self.parameters.len());
            let (p, w) = at.map(|at| self.parameters[at]).ok_or_else(|| missing("vp", word))?;
            if p.is_finite() { Ok(homogeneous2(p, w, rational)) } else { Err(missing("vp", word)) }
        };
        words.iter().map(point).collect()
    }

    fn control_point(&self, word: &[u8], rational: bool) -> Result<DVec4, ReadIssue> {
        let at = self.point_at(word).ok_or_else(|| missing("v", word))?;
        Ok(homogeneous(self.points[at], self.weights[at], rational))
    }

    fn body(&mut self, keyword: &[u8], words: &[&[u8]], source: Source) {
        let Some(element) = &mut self.open else {
            self.notes.warn(source, ReadIssue::MisplacedStatement { keyword: text(keyword).to_string() });
            return;
        };
        match keyword {
            b"parm" => {
                let numbers: Option<Vec<f64>> = words.iter().skip(1).map(|word| number(word)).collect();
                match (words.first(), numbers) {
                    (Some(&b"u"), Some(numbers)) => element.parameters[0] = numbers,
                    (Some(&b"v"), Some(numbers)) => element.parameters[1] = numbers,
                    _ => self.notes.warn(source, ReadIssue::BadStatement { keyword: "parm".to_owned() }),
                }
            }
            b"trim" | b"hole" => {
                element.loops.push(LoopUse { hole: keyword == b"hole", uses: curve_uses(words), source });
            }
            b"scrv" => self.loose(LooseKind::Wire, source),
            b"sp" => self.loose(LooseKind::Point, source),
            _ => {
                if let Some(element) = self.open.take() {
                    self.close(element);
                }
            }
        }
    }

    /// An element whose body is complete.
    fn close(&mut self, mut element: Element) {
        match element.kind.clone() {
            Kind::Curve => self.loose(LooseKind::Wire, element.source),
            Kind::Curve2(points) => {
                let curve = points.and_then(|points| element.curve2(&points));
                if let Err(why) = &curve {
                    let issue = why.clone().within("parameter curve", self.curves.len() + 1);
                    self.notes.warn(element.source, issue);
                }
                self.curves.push(curve);
            }
            Kind::Surface { range, points } => self.surface(element, range, points),
        }
    }

    fn surface(&mut self, mut element: Element, range: Option<UvBox>, points: Result<Vec<DVec4>, ReadIssue>) {
        self.surfaces += 1;
        let source = element.source;
        let name = if self.group.is_empty() { self.object.clone() } else { self.group.clone() };
        let look = Look { name, layer: layer(&self.material), source, ..Look::default() };
        let mut guessed = Vec::new();
        let mut warn = |issue: ReadIssue| guessed.push(issue);
        let made = points.and_then(|points| element.surface(range, &points, &mut warn));
        let trims: Result<Vec<_>, ReadIssue> =
            element.loops.iter().map(|trim| Element::trim(trim, &self.curves, &mut warn)).collect();
        guessed.into_iter().for_each(|issue| self.notes.warn(source, issue));
        let faces = match (made, trims) {
            (Ok(surface), Ok(trims)) => {
                add_faces(&mut self.part, &Arc::new(surface), &trims, &look, &self.notes)
            }
            (Err(reason), _) | (_, Err(reason)) => vec![add_failed(&mut self.part, reason, &look)],
        };
        let key = if self.object.is_empty() { &self.group } else { &self.object };
        let next = self.bodies.len();
        let body = *self.body_of.entry(key.clone()).or_insert(next);
        if body == next {
            self.bodies.push((key.clone(), Vec::new(), source));
        }
        self.bodies[body].1.extend(faces);
    }

    fn loose(&mut self, kind: LooseKind, source: Source) {
        let name = if self.group.is_empty() { self.object.clone() } else { self.group.clone() };
        self.part.loose.push(LooseItem { kind, name, source });
    }

    /// Objects, groups and materials: polygons of different ones stay apart.
    fn named(&mut self, keyword: &[u8], words: &[&[u8]]) {
        self.part.tessellated.extend(self.polygons.take());
        let name = words.iter().map(|word| text(word)).collect::<Vec<_>>().join(" ");
        match keyword {
            b"o" => self.object = name,
            b"g" => self.group = name,
            _ => self.material = name,
        }
    }

    fn pass_over(&mut self, keyword: &[u8], line: u32) {
        /// More kinds than this are not listed.
        const MOST: usize = 100;
        let keyword = text(&keyword[..keyword.len().min(40)]);
        let known = self.passed.iter().position(|(known, ..)| *known == keyword);
        match known {
            Some(at) => self.passed[at].2 += 1,
            None if self.passed.len() < MOST => self.passed.push((keyword, line, 1)),
            None => {}
        }
    }

    fn finish(mut self) -> Read {
        if let Some(open) = self.open.take() {
            self.notes.warn(open.source, ReadIssue::EntityTruncated);
            self.close(open);
        }
        self.part.tessellated.extend(self.polygons.take());
        for (name, faces, source) in std::mem::take(&mut self.bodies) {
            add_body(&mut self.part, faces, BodyKind::FaceSet, &Look { name, source, ..Look::default() });
        }
        if self.connections > 0 {
            let (keyword, statements) = ("con".to_owned(), self.connections);
            self.notes.warn(Source::default(), ReadIssue::StatementsIgnored { keyword, statements });
        }
        for (keyword, line, count) in std::mem::take(&mut self.passed) {
            let source = Source { entity: 0, line };
            match keyword.as_str() {
                "call" => self.notes.lose(source, ReadIssue::OtherFile { name: String::new() }),
                "csh" => self.notes.warn(source, ReadIssue::ProgramIgnored { what: "csh statements" }),
                "bsp" | "bzp" | "cdc" | "cdp" | "res" => {
                    self.notes.lose(source, ReadIssue::StatementsIgnored { keyword, statements: count });
                }
                _ => self.notes.warn(source, ReadIssue::StatementsIgnored { keyword, statements: count }),
            }
        }
        Read { part: self.part, issues: self.notes.take(), statements: 0 }
    }
}

fn missing(what: &'static str, word: &[u8]) -> ReadIssue {
    ReadIssue::NameNotFound { what, name: text(&word[..word.len().min(40)]).to_string() }
}

/// The words of a statement, for messages.
fn joined(words: &[&[u8]]) -> String {
    words.iter().map(|word| text(word)).collect::<Vec<_>>().join(" ").chars().take(40).collect()
}

fn layer(material: &str) -> Option<String> {
    (!material.is_empty()).then(|| material.to_owned())
}

/// One number for both directions, or one for each.
fn pair(words: &[&[u8]], into: &mut [usize; 2]) -> bool {
    let count = |word: &[u8]| std::str::from_utf8(word).ok()?.parse::<usize>().ok();
    let numbers: Option<Vec<usize>> = words.iter().map(|word| count(word)).collect();
    match numbers.as_deref() {
        Some(&[u]) => *into = [u, u],
        Some(&[u, v]) => *into = [u, v],
        _ => return false,
    }
    true
}

/// Triples of a range and a curve.
fn curve_uses(words: &[&[u8]]) -> Result<Vec<CurveUse>, ReadIssue> {
    let one = |triple: &[&[u8]]| {
        let [start, end, curve] = triple else { return None };
        let curve = std::str::from_utf8(curve).ok()?.parse().ok()?;
        Some(CurveUse { start: number(start)?, end: number(end)?, curve })
    };
    let uses: Option<Vec<CurveUse>> = words.chunks(3).map(one).collect();
    uses.filter(|uses| !uses.is_empty())
        .ok_or(ReadIssue::Missing { what: "list of ranges and curves in the trim" })
}

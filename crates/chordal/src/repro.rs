//! The smallest piece of a model that shows the problem of one face, to be sent with a report of it.
//!
//! Pieces are tried from small to large: the face; the face with its neighbours, of which those are taken out
//! again that the problem does not need; these with their neighbours; the whole part. A piece is written as
//! JSON, read back, and meshed: it will do if the face then has the problems that it has in the model, by
//! their codes.

use crate::error::{Error, FileError, RequestError};
use crate::meshed::Meshed;
use crate::mesher::Mesher;
use crate::model::Model;
use crate::options::MeshOptions;
use crate::quantity::Tolerance;
use crate::report::{Problem, Report};
use chordal_brep::{FaceId, PartId, Severity};
use chordal_tessellate::Cancel;
use glam::DAffine3;
use std::collections::BTreeSet;

/// The most neighbours that are taken out one by one; each costs a mesh.
const MOST_NEIGHBOURS: usize = 32;

/// Which face of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceName {
    /// The number of its entity in the file: `#123`.
    Entity(u64),
    /// Its place in `faces_detail` of the report, for formats without numbers.
    Index(usize),
}

/// A piece of a model.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Repro {
    /// The piece. It has no names and nothing of the header.
    pub model: Model,
    /// How many faces it has.
    pub faces: usize,
    /// Where the face is among them.
    place: usize,
    /// The codes of the problems that the face has in the model, in order.
    pub codes: Vec<String>,
    /// Whether the face has these problems in the piece, too.
    pub shows: bool,
    /// The tolerance at which it does, in millimetres; `None`: at the default one.
    pub tolerance: Option<f64>,
}

/// Finds the smallest piece of the model that shows the problems of a face.
///
/// # Errors
/// [`RequestError::UnknownFace`]; or as [`Mesher::mesh`], but for a model of which no face can be meshed.
pub fn repro(model: &Model, face: FaceName, options: &MeshOptions, cancel: &Cancel) -> Result<Repro, Error> {
    let (part, face) = find(model, face)?;
    let mesher = |options: &MeshOptions| Mesher::new(options.clone()).with_cancel(cancel.clone());
    let whole = outcome(mesher(options).mesh(model))?;
    let codes = codes(&whole.problems, index_of(model, part, face));
    // The same tolerance for pieces, whose boxes are smaller.
    let tolerance = whole.tolerance;
    let fixed = tolerance
        .map_or_else(|| options.clone(), |mm| options.clone().with_tolerance(Tolerance::Millimetres(mm)));
    let search = Search { model, part, face, codes: &codes, mesher: mesher(&fixed) };
    let faces = search.smallest()?;
    let piece = search.piece(&faces)?;
    let shows_with = |mesher: &Mesher| shows(mesher, &piece, place(&faces, face), &codes);
    let by_default = shows_with(&mesher(&MeshOptions::default()))?;
    let shows = by_default || shows_with(&search.mesher)?;
    let tolerance = tolerance.filter(|_| !by_default);
    Ok(Repro { model: piece, faces: faces.len(), place: place(&faces, face), codes, shows, tolerance })
}

impl Repro {
    /// The piece as a STEP file, cut out of the content of the file that the model came from, and whether the
    /// face has the same problems there. Where the piece in JSON does not show them, this may.
    ///
    /// # Errors
    /// [`Error::File`] where the content is not that of a STEP file.
    pub fn to_step(
        &self,
        file: &[u8],
        options: &MeshOptions,
        cancel: &Cancel,
    ) -> Result<(String, bool), Error> {
        let faces = &self.model.brep().parts[0].faces;
        let entities: Vec<u64> = faces.iter().map(|face| face.source.entity).collect();
        let failed = |source: chordal_read::ReadError| Error::file(self.model.name(), source.into());
        let text = chordal_read::step_excerpt(file, &entities).map_err(failed)?;
        let piece = Model::from_bytes(text.as_bytes(), chordal_read::Format::Step)?;
        let (part, face) = find(&piece, FaceName::Entity(entities[self.place]))?;
        let options = match self.tolerance {
            Some(mm) => options.clone().with_tolerance(Tolerance::Millimetres(mm)),
            None => MeshOptions::default(),
        };
        let mesher = Mesher::new(options).with_cancel(cancel.clone());
        let shows = shows(&mesher, &piece, index_of(&piece, part, face), &self.codes)?;
        Ok((text, shows))
    }
}

struct Search<'a> {
    model: &'a Model,
    part: PartId,
    face: FaceId,
    codes: &'a [String],
    mesher: Mesher,
}

impl Search<'_> {
    /// The faces of the smallest piece that shows the problems; where there are none, the face alone; where
    /// no piece shows them, the whole part.
    fn smallest(&self) -> Result<Vec<FaceId>, Error> {
        let part = &self.model.brep().parts[self.part.index()];
        let mut faces = vec![self.face];
        if self.codes.is_empty() || self.shows(&faces)? {
            return Ok(faces);
        }
        loop {
            let larger = part.with_neighbours(&faces);
            if larger.len() == faces.len() {
                return Ok((0..part.faces.len()).map(FaceId::from).collect());
            }
            faces = larger;
            if self.shows(&faces)? {
                return self.thinned(faces);
            }
        }
    }

    /// Without the faces that the problem does not need.
    fn thinned(&self, mut faces: Vec<FaceId>) -> Result<Vec<FaceId>, Error> {
        if faces.len() > MOST_NEIGHBOURS {
            return Ok(faces);
        }
        for candidate in faces.clone().into_iter().filter(|&candidate| candidate != self.face) {
            let fewer: Vec<FaceId> = faces.iter().copied().filter(|&f| f != candidate).collect();
            if self.shows(&fewer)? {
                faces = fewer;
            }
        }
        Ok(faces)
    }

    fn shows(&self, faces: &[FaceId]) -> Result<bool, Error> {
        shows(&self.mesher, &self.piece(faces)?, place(faces, self.face), self.codes)
    }

    /// The piece as it is read back.
    fn piece(&self, faces: &[FaceId]) -> Result<Model, Error> {
        let exact = self.model.brep();
        let placed = exact.placements().into_iter().find(|placement| placement.part == self.part);
        let world = placed.map_or(DAffine3::IDENTITY, |placement| placement.world);
        let piece = Model::from_brep(exact.excerpt(self.part, faces, world), "the piece");
        Model::from_bytes(piece.to_json()?.as_bytes(), chordal_read::Format::Json)
    }
}

/// Where a face is among the faces of a piece.
fn place(faces: &[FaceId], face: FaceId) -> usize {
    faces.iter().position(|&other| other == face).unwrap_or(0)
}

fn shows(mesher: &Mesher, piece: &Model, face: usize, wanted: &[String]) -> Result<bool, Error> {
    let found = codes(&outcome(mesher.mesh(piece))?.problems, face);
    Ok(wanted.iter().all(|code| found.contains(code)))
}

/// The problems of a run, and the tolerance of one that made a mesh.
struct Outcome {
    problems: Vec<Problem>,
    tolerance: Option<f64>,
}

/// A run that could mesh no face has problems, too.
fn outcome(meshed: Result<Meshed, Error>) -> Result<Outcome, Error> {
    match meshed.map(Meshed::into_report) {
        Ok(Report { problems, options, .. }) => Ok(Outcome { problems, tolerance: Some(options.tolerance) }),
        Err(Error::File { reason: FileError::NothingMeshed { problems, .. }, .. }) => {
            Ok(Outcome { problems, tolerance: None })
        }
        Err(error) => Err(error),
    }
}

/// The codes of the problems of a face, each once. Where the problems of faces that could not be read have no
/// index, all are meant: they are those of a model without any other face.
fn codes(problems: &[Problem], face: usize) -> Vec<String> {
    let is_of_face =
        |p: &&Problem| p.face.is_none_or(|of| of == face) && (p.face.is_some() || is_unread(problems));
    let counted = problems.iter().filter(is_of_face).filter(|p| p.severity != Severity::Note);
    let codes: BTreeSet<&str> = counted.map(|p| p.code.as_str()).collect();
    codes.into_iter().map(str::to_owned).collect()
}

fn is_unread(problems: &[Problem]) -> bool {
    problems.iter().all(|p| p.face.is_none())
}

fn find(model: &Model, name: FaceName) -> Result<(PartId, FaceId), Error> {
    let parts = model.brep().parts.iter().enumerate();
    let mut faces =
        parts.flat_map(|(p, part)| part.faces.iter().enumerate().map(move |(f, face)| (p, f, face)));
    let found = match name {
        FaceName::Entity(entity) => faces.find(|(.., face)| face.source.entity == entity),
        FaceName::Index(index) => faces.nth(index),
    };
    let (part, face, _) = found.ok_or(RequestError::UnknownFace { face: name.to_string() })?;
    Ok((PartId::from(part), FaceId::from(face)))
}

/// The place of a face in `faces_detail` of the report.
fn index_of(model: &Model, part: PartId, face: FaceId) -> usize {
    let before = model.brep().parts.iter().take(part.index());
    before.map(|part| part.faces.len()).sum::<usize>() + face.index()
}

impl std::fmt::Display for FaceName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            FaceName::Entity(entity) => write!(f, "#{entity}"),
            FaceName::Index(index) => write!(f, "@{index}"),
        }
    }
}

/// `#123` or `123`: the number of an entity; `@5`: the place in `faces_detail` of the report.
impl std::str::FromStr for FaceName {
    type Err = FaceNameError;

    fn from_str(text: &str) -> Result<Self, FaceNameError> {
        let parsed = match text.strip_prefix('@') {
            Some(index) => index.parse().map(FaceName::Index),
            None => text.trim_start_matches('#').parse().map(FaceName::Entity),
        };
        parsed.map_err(|_| FaceNameError)
    }
}

/// A text that names no face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a face is named #123 (the number of its entity) or @5 (its place in faces_detail)")]
pub struct FaceNameError;

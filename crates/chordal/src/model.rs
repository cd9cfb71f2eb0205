//! A CAD model, read and ready to be meshed.

use crate::bug::guarded;
use crate::error::{Error, FileError};
use crate::info::{Info, info};
use crate::report::Problem;
use chordal_read::{Format as InputFormat, ReadError, ReadOptions};
use chordal_tessellate::Stopwatch;
use std::path::Path;
use std::sync::Arc;

/// A CAD model: what a file holds, exactly.
///
/// Cloning is cheap: the geometry is shared.
///
/// ```
/// let model = chordal::Model::open("../../corpus/bracket.step")?;
/// assert_eq!((model.unit(), model.face_count()), ("mm", 28));
/// # Ok::<(), chordal::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Model {
    exact: Arc<chordal_brep::Model>,
    name: String,
    bytes: u64,
    seconds: f64,
}

impl Model {
    /// Reads a file, which may be compressed; the format is recognised by content.
    ///
    /// # Errors
    /// [`Error::File`] where the file cannot be read or holds neither a face nor a triangle.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::open_with(path, None, &ReadOptions::default())
    }

    /// Reads a file with options; `None` recognises the format by content.
    ///
    /// # Errors
    /// As [`Model::open`].
    pub fn open_with(
        path: impl AsRef<Path>,
        format: Option<InputFormat>,
        options: &ReadOptions,
    ) -> Result<Self, Error> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let bytes = std::fs::metadata(path).map_or(0, |file| file.len());
        Self::read(name, bytes, || match format {
            None => chordal_read::read_file(path, options),
            Some(_) => {
                let failed = |source| ReadError::Io { path: path.to_owned(), source };
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                let options = options.clone().with_name(stem);
                chordal_read::read_bytes(&std::fs::read(path).map_err(failed)?, format, &options)
            }
        })
    }

    /// Reads the content of a file, which may be compressed; `None` recognises the format by content.
    ///
    /// ```
    /// let bytes = std::fs::read("../../corpus/bracket.step")?;
    /// let model = chordal::Model::from_bytes(&bytes, chordal::InputFormat::Step)?;
    /// assert_eq!(model.face_count(), 28);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Model::open`].
    pub fn from_bytes(bytes: &[u8], format: impl Into<Option<InputFormat>>) -> Result<Self, Error> {
        Self::from_bytes_with(bytes, format.into(), &ReadOptions::default().with_name("model"))
    }

    /// Reads the content of a file with options, whose name also names the input in messages and reports.
    ///
    /// # Errors
    /// As [`Model::open`].
    pub fn from_bytes_with(
        bytes: &[u8],
        format: Option<InputFormat>,
        options: &ReadOptions,
    ) -> Result<Self, Error> {
        let read = || chordal_read::read_bytes(bytes, format, options);
        Self::read(options.name.clone(), bytes.len() as u64, read)
    }

    fn read(
        name: String,
        bytes: u64,
        read: impl FnOnce() -> Result<chordal_brep::Model, ReadError>,
    ) -> Result<Self, Error> {
        let clock = Stopwatch::of_wall();
        let exact = guarded(|| read().map_err(|error| Error::file(&name, error.into())))?;
        let seconds = clock.seconds();
        let model = Self { exact: Arc::new(exact), name, bytes, seconds };
        let parts = &model.exact.parts;
        if parts.iter().all(|p| p.faces.is_empty() && p.tessellated.is_empty()) {
            let loose = parts.iter().map(|p| p.loose.len()).sum();
            return Err(Error::file(&model.name, FileError::NoFaces { loose }));
        }
        Ok(model)
    }

    /// A model that the caller built; `name` names it in messages and reports.
    pub fn from_brep(exact: chordal_brep::Model, name: &str) -> Self {
        Self { exact: Arc::new(exact), name: name.to_owned(), bytes: 0, seconds: 0.0 }
    }

    /// The exact geometry and topology.
    pub fn brep(&self) -> &chordal_brep::Model {
        &self.exact
    }

    /// The same, shared.
    pub(crate) fn shared(&self) -> Arc<chordal_brep::Model> {
        self.exact.clone()
    }

    /// The path of the file, or the name that the caller gave.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The size of the file in bytes; 0 where the caller built the model.
    pub fn byte_count(&self) -> u64 {
        self.bytes
    }

    /// How long reading took, in seconds.
    pub(crate) fn read_seconds(&self) -> f64 {
        self.seconds
    }

    /// Format and version as the file states them.
    pub fn format(&self) -> &str {
        &self.exact.schema
    }

    /// The file's unit of length, such as `mm`.
    pub fn unit(&self) -> &str {
        &self.exact.unit
    }

    /// The number of faces, with every instance of a part counted.
    pub fn face_count(&self) -> usize {
        self.exact.placed_faces()
    }

    /// What the reader repaired, guessed or dropped, and the faces that it could not read.
    pub fn problems(&self) -> Vec<Problem> {
        crate::account::model_problems(&self.exact)
    }

    /// A description of the content: tree, parts, faces by kind, gaps, problems.
    pub fn info(&self) -> Info {
        info(&self.exact)
    }

    /// The model with every face an island: no edge or vertex is shared between faces.
    pub fn unsewn(&self) -> Self {
        Self { exact: Arc::new(self.exact.unsewn()), ..self.clone() }
    }

    /// The whole exact model as Chordal's own JSON (docs/model-json.md), without loss.
    ///
    /// # Errors
    /// [`Error::File`] where a number of the model is not finite.
    pub fn to_json(&self) -> Result<String, Error> {
        chordal_document::to_json(&self.exact)
            .map_err(|source| Error::file(&self.name, FileError::Document(source)))
    }
}

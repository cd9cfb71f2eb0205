//! Why nothing could be read at all.

/// A file that yields no model; one clear sentence each.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    #[error("cannot read {path}: {source}")]
    Io { path: String, source: std::io::Error },
    #[error("{name} is empty")]
    Empty { name: String },
    #[error(
        "{name} is of no known format: none of STEP (ISO-10303-21), IGES, BREP (CASCADE Topology), Open Inventor, VRML, X3D, \
         free-form OBJ, 3DM, and JSON of Chordal or geomdl"
    )]
    UnknownFormat { name: String },
    #[error("{name} is {format} that cannot be read: {problem}")]
    Unreadable { name: String, format: &'static str, problem: String },
    #[error("{name} has no DATA section (the file ends at line {line})")]
    NoData { name: String, line: u32 },
    #[error("{name} has no entities in its DATA section (line {line})")]
    NoEntities { name: String, line: u32 },
    #[error("{name} holds no shape in its {entities} entities ({problem})")]
    NothingInIt { name: String, entities: usize, problem: String },
}

//! Why a mesh file could not be read, with the place and the values.

use std::fmt;
use std::io;
use std::path::PathBuf;

/// A mesh format that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ImportFormat {
    /// STL, binary or ASCII.
    Stl,
    /// Wavefront OBJ.
    Obj,
    /// PLY, ASCII or binary.
    Ply,
    /// glTF 2.0 in one binary file.
    Glb,
    /// glTF 2.0 as JSON text.
    Gltf,
    /// 3MF.
    ThreeMf,
}

impl ImportFormat {
    /// The format of a file name's extension in lower case, without its dot.
    pub fn from_extension(extension: &str) -> Option<Self> {
        Some(match extension {
            "stl" => Self::Stl,
            "obj" => Self::Obj,
            "ply" => Self::Ply,
            "glb" => Self::Glb,
            "gltf" => Self::Gltf,
            "3mf" => Self::ThreeMf,
            _ => return None,
        })
    }
}

impl fmt::Display for ImportFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stl => "STL",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Glb => "GLB",
            Self::Gltf => "glTF",
            Self::ThreeMf => "3MF",
        })
    }
}

/// Why a mesh could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportError {
    /// The operating system could not read the file.
    #[error("cannot read the file: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// The cause, as the operating system reports it.
        source: io::Error,
    },
    /// The extension is not that of a mesh format that is read.
    #[error("unknown mesh format `{0}` (supported: stl, obj, ply, glb, gltf, 3mf)")]
    UnknownFormat(String),
    /// The contents are not valid, or use a part of the format that is not supported.
    #[error("not a valid {format} file: {}{fault}", At(place))]
    Invalid {
        /// The format that the file was read as.
        format: ImportFormat,
        /// Where in the file, if known.
        place: Option<ImportPlace>,
        /// What is wrong.
        fault: ImportFault,
    },
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImportPlace {
    /// A line of text, counted from 1.
    Line(usize),
    /// An offset in bytes from the start of the file.
    Byte(usize),
}

struct At<'a>(&'a Option<ImportPlace>);

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(ImportPlace::Line(line)) => write!(f, "line {line}: "),
            Some(ImportPlace::Byte(offset)) => write!(f, "byte {offset}: "),
            None => Ok(()),
        }
    }
}

/// What is wrong with the contents of a mesh file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ImportFault {
    /// The file does not start as its format demands.
    Start {
        /// The bytes that belong there.
        expected: &'static str,
    },
    /// The file has a version that is not read.
    Version {
        /// The version of the file.
        version: u32,
        /// The version that is read.
        supported: u32,
    },
    /// The file ends too early.
    EndsInside {
        /// What it ends in, such as `header` or `loop`.
        what: &'static str,
    },
    /// A header states more items than the file can hold.
    Count {
        /// What is counted.
        what: String,
        /// The number that the header states.
        stated: u64,
        /// The number that the file can hold, if known.
        held: Option<u64>,
    },
    /// A line of a header cannot be understood.
    HeaderLine {
        /// The line.
        text: String,
    },
    /// Something that the format demands is absent.
    Missing {
        /// What is absent, such as `vertex_indices of the faces`.
        what: &'static str,
    },
    /// A vertex does not have three numbers.
    Vertex,
    /// A coordinate is infinite or not a number.
    NotFinite {
        /// The vertex as read.
        point: [f64; 3],
    },
    /// A triangle or face has too few or too many corners.
    Corners {
        /// How many it has.
        corners: usize,
    },
    /// A triangle or face refers to a vertex that does not exist.
    UnknownVertex {
        /// The reference as the file has it.
        vertex: String,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A list has a negative number of items, or one that is not a number.
    ListLength {
        /// The number.
        length: f64,
    },
    /// There are over 2³² vertices.
    TooManyVertices,
    /// Instances multiply the triangles beyond what is read.
    TooManyTriangles {
        /// The limit.
        limit: u64,
    },
    /// The file has no triangles.
    NoTriangles,
    /// The JSON of a glTF file cannot be parsed.
    Json {
        /// The parser's reason, with line and column.
        reason: String,
    },
    /// A glTF file requires an extension that is not read.
    Extension {
        /// The name of the extension.
        name: String,
    },
    /// A glTF or 3MF file refers to something that does not exist.
    Unknown {
        /// What is referred to: `node`, `mesh`, `accessor`, `object`.
        what: &'static str,
        /// Its index or id.
        id: String,
    },
    /// A node of a glTF file has two parents, or contains itself.
    TwoParents {
        /// The node's index.
        node: usize,
    },
    /// An object of a 3MF file contains itself.
    ContainsItself {
        /// The object's id.
        object: u64,
    },
    /// An accessor of a glTF file cannot be used.
    Accessor {
        /// The accessor's index.
        accessor: u64,
        /// What is wrong with it.
        fault: AccessorFault,
    },
    /// The buffer of a glTF file is not embedded in it.
    OtherFile,
    /// The buffer that is embedded in a glTF file is not valid base64.
    Base64 {
        /// The decoder's reason.
        reason: String,
    },
    /// The number of face ids differs from the number of triangles.
    FaceIds {
        /// How many ids there are.
        ids: usize,
        /// How many triangles there are.
        triangles: usize,
    },
    /// The archive of a 3MF file cannot be read.
    Archive {
        /// The member that cannot be read; empty for the archive itself.
        member: String,
        /// The reason of the decompressor.
        reason: String,
    },
    /// A member of the archive unpacks to a multiple of the file that no real text reaches.
    ArchiveRatio {
        /// The member.
        member: String,
        /// The largest ratio that is read.
        limit: u64,
    },
    /// A 3MF file refers to a second model in its archive, which is not read.
    OtherModel,
    /// A transform of a 3MF file does not have twelve numbers.
    Transform {
        /// The attribute's value.
        text: String,
    },
    /// Something inside an object of a 3MF file is wrong.
    InObject {
        /// The object's id.
        object: u64,
        /// What is wrong.
        fault: Box<ImportFault>,
    },
}

/// Why an accessor of a glTF file cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AccessorFault {
    /// It is sparse, which is not read.
    Sparse,
    /// It has a component type that is not read here.
    ComponentType(u64),
    /// It names no buffer view.
    NoView,
    /// Its bytes lie in another file.
    OtherFile,
    /// Its bytes lie beyond the end of the buffer.
    BeyondBuffer,
    /// Positions are not vectors of three 32-bit floats.
    NotPositions,
    /// Indices are not integers.
    NotIntegers,
}

impl fmt::Display for ImportFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start { expected } => write!(f, "it does not start with `{expected}`"),
            Self::Version { version, supported } => {
                write!(f, "version {version}, only {supported} is supported")
            }
            Self::EndsInside { what } => write!(f, "the file ends inside its {what}"),
            Self::Count { what, stated, held: Some(held) } => {
                write!(f, "the header states {stated} {what}, the file holds {held}")
            }
            Self::Count { what, stated, held: None } => {
                write!(f, "the header states {stated} {what}, more than the file can hold")
            }
            Self::HeaderLine { text } => write!(f, "header line `{text}` cannot be read"),
            Self::Missing { what } => write!(f, "{what} missing"),
            Self::Vertex => f.write_str("a vertex needs three numbers"),
            Self::NotFinite { point: [x, y, z] } => write!(f, "vertex ({x}, {y}, {z}) is not finite"),
            Self::Corners { corners: 1 } => f.write_str("a face with 1 corner"),
            Self::Corners { corners } => write!(f, "a face with {corners} corners"),
            Self::UnknownVertex { vertex, vertices } => {
                write!(f, "a face refers to vertex {vertex} of {vertices}")
            }
            Self::ListLength { length } => write!(f, "a list of {length} items"),
            Self::TooManyVertices => f.write_str("over 4294967295 vertices"),
            Self::TooManyTriangles { limit } => {
                write!(f, "its instances place over {limit} triangles or parts")
            }
            Self::NoTriangles => f.write_str("it has no triangles"),
            Self::Json { reason } => write!(f, "its JSON cannot be parsed: {reason}"),
            Self::Extension { name } => write!(f, "it requires the extension {name}, which is not supported"),
            Self::Unknown { what, id } => write!(f, "{what} {id} does not exist"),
            Self::TwoParents { node } => write!(f, "node {node} has two parents"),
            Self::ContainsItself { object } => write!(f, "object {object} contains itself"),
            Self::Accessor { accessor, fault } => write!(f, "accessor {accessor} {fault}"),
            Self::OtherFile => f.write_str("its buffer lies in another file, which is not supported"),
            Self::Base64 { reason } => write!(f, "its embedded buffer is not valid base64: {reason}"),
            Self::FaceIds { ids, triangles } => write!(f, "{ids} face ids for {triangles} triangles"),
            Self::Archive { member, reason } if member.is_empty() => {
                write!(f, "its archive cannot be read: {reason}")
            }
            Self::Archive { member, reason } => {
                write!(f, "`{member}` in its archive cannot be read: {reason}")
            }
            Self::ArchiveRatio { member, limit } => {
                write!(f, "`{member}` in its archive unpacks to over {limit} times the file")
            }
            Self::OtherModel => {
                f.write_str("it refers to a second model in its archive, which is not supported")
            }
            Self::Transform { text } => write!(f, "transform `{text}` does not have twelve numbers"),
            Self::InObject { object, fault } => write!(f, "object {object}: {fault}"),
        }
    }
}

impl fmt::Display for AccessorFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sparse => f.write_str("is sparse, which is not supported"),
            Self::ComponentType(component) => write!(f, "has the unsupported component type {component}"),
            Self::NoView => f.write_str("has no buffer view"),
            Self::OtherFile => f.write_str("lies in another file, which is not supported"),
            Self::BeyondBuffer => f.write_str("reaches beyond the end of its buffer"),
            Self::NotPositions => f.write_str("does not hold vectors of three 32-bit floats"),
            Self::NotIntegers => f.write_str("does not hold integers"),
        }
    }
}

impl std::error::Error for ImportFault {}

/// A fault with its place: what the readers of all formats return.
#[derive(Debug)]
pub(super) struct Fault {
    pub place: Option<ImportPlace>,
    pub kind: ImportFault,
}

impl From<ImportFault> for Fault {
    fn from(kind: ImportFault) -> Self {
        Self { place: None, kind }
    }
}

impl Fault {
    /// The same fault at a place, unless it has one.
    pub fn at(self, place: ImportPlace) -> Self {
        Self { place: self.place.or(Some(place)), ..self }
    }
}

//! The formats that are read.

use std::fmt;

/// A file format that this crate reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Format {
    /// STEP: ISO 10303-21 files of AP203, AP214 and AP242. Feature `step`.
    Step,
    /// IGES in the fixed ASCII form. Feature `iges`.
    Iges,
    /// The text form of OpenCASCADE's shapes (`CASCADE Topology`). Feature `brep`.
    Brep,
    /// Rhino 3DM. Feature `rhino`.
    Rhino,
    /// JSON: Chordal's own exact model, or an export of geomdl. Always read.
    Json,
    /// Open Inventor and VRML 1, text or binary. Feature `scene`.
    Inventor,
    /// VRML97 and X3D, classic or XML. Feature `scene`.
    X3d,
    /// Wavefront OBJ with free-form surfaces. Feature `obj`.
    Obj,
}

impl Format {
    /// The format that the end of a file's name stands for, in any case: `stp`, `step`, `igs`, …
    pub fn of_extension(extension: &str) -> Option<Format> {
        Some(match extension.to_ascii_lowercase().as_str() {
            "stp" | "step" | "p21" | "stpz" => Format::Step,
            "igs" | "iges" => Format::Iges,
            "brep" | "brp" => Format::Brep,
            "3dm" => Format::Rhino,
            "json" => Format::Json,
            "iv" => Format::Inventor,
            "wrl" | "x3d" | "x3dv" => Format::X3d,
            "obj" => Format::Obj,
            _ => return None,
        })
    }

    /// Whether content of this format is text that may be brought into another encoding as a whole. IGES
    /// counts the bytes of its strings, and decodes each of them.
    pub(crate) fn is_text(self, bytes: &[u8]) -> bool {
        let head = &bytes[..bytes.len().min(64)];
        match self {
            Format::Step | Format::Obj | Format::X3d => true,
            Format::Inventor => !head.windows(6).any(|word| word == b"binary"),
            _ => false,
        }
    }

    /// Whether files of this format leave open which trimming loops are holes, so that
    /// [`crate::ReadOptions::winding`] decides.
    pub fn has_winding(self) -> bool {
        matches!(self, Format::Inventor | Format::X3d)
    }

    /// The name that people know.
    pub fn name(self) -> &'static str {
        match self {
            Format::Step => "STEP",
            Format::Iges => "IGES",
            Format::Brep => "BREP",
            Format::Rhino => "3DM",
            Format::Json => "JSON",
            Format::Inventor => "Open Inventor",
            Format::X3d => "X3D",
            Format::Obj => "OBJ",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

//! The formats that can be written, and the unit and axes of a file's coordinates.

use std::fmt;
use std::str::FromStr;

/// A mesh file format.
///
/// ```
/// use chordal_write::Format;
/// assert_eq!(Format::from_extension(".GLB"), Some(Format::Glb));
/// assert!(Format::Glb.is_single_precision());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Format {
    /// Binary STL: 32-bit coordinates, three vertices per triangle, nothing shared.
    StlBinary,
    /// ASCII STL: named solids, coordinates in digits that keep all 64 bits.
    StlAscii,
    /// glTF 2.0 in one binary file: tree, instances, colours, exact normals, face ids, 32-bit coordinates.
    Glb,
    /// glTF 2.0 as JSON text with its buffer embedded; holds the same as [`Format::Glb`].
    Gltf,
    /// Wavefront OBJ: groups per face, exact normals, 64-bit coordinates; colours in a second file.
    Obj,
    /// Binary PLY: 64-bit coordinates, face ids, colours.
    Ply,
    /// 3MF: a compressed archive with instances, colours and a unit, 64-bit coordinates.
    ThreeMf,
}

impl Format {
    /// The format of a file name's extension, with or without its dot, in any case; `stl` means binary STL.
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.trim_start_matches('.').to_ascii_lowercase().as_str() {
            "stl" => Some(Self::StlBinary),
            "glb" => Some(Self::Glb),
            "gltf" => Some(Self::Gltf),
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "3mf" => Some(Self::ThreeMf),
            _ => None,
        }
    }

    /// The usual extension, without a dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::StlBinary | Self::StlAscii => "stl",
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::ThreeMf => "3mf",
        }
    }

    /// Whether coordinates are rounded to 32-bit floats.
    pub fn is_single_precision(self) -> bool {
        self == Self::StlBinary || self.is_gltf()
    }

    /// Whether the format is glTF 2.0, in binary or as text.
    pub fn is_gltf(self) -> bool {
        matches!(self, Self::Glb | Self::Gltf)
    }

    /// The unit written unless the options set another: metres in glTF, as its specification demands, else
    /// millimetres.
    pub fn default_unit(self) -> Unit {
        if self.is_gltf() { Unit::Metre } else { Unit::Millimetre }
    }

    /// The axis that points up unless the options set another: Y in glTF, as its specification demands, else
    /// Z.
    pub fn default_up(self) -> UpAxis {
        if self.is_gltf() { UpAxis::Y } else { UpAxis::Z }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::StlBinary => "binary STL",
            Self::StlAscii => "ASCII STL",
            Self::Glb => "GLB",
            Self::Gltf => "glTF",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::ThreeMf => "3MF",
        })
    }
}

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Unit {
    /// `um`, 0.001 mm.
    Micrometre,
    /// `mm`.
    #[default]
    Millimetre,
    /// `cm`, 10 mm.
    Centimetre,
    /// `m`, 1000 mm.
    Metre,
    /// `in`, 25.4 mm.
    Inch,
    /// `ft`, 304.8 mm.
    Foot,
}

impl Unit {
    /// The length of the unit in millimetres.
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Micrometre => 0.001,
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Inch => 25.4,
            Self::Foot => 304.8,
        }
    }

    /// The symbol that [`Unit::from_str`] reads.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Micrometre => "um",
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::Inch => "in",
            Self::Foot => "ft",
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol())
    }
}

/// A name that is not a unit of length.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown unit of length `{0}` (use um, mm, cm, m, in or ft)")]
pub struct UnknownUnit(pub String);

impl FromStr for Unit {
    type Err = UnknownUnit;

    fn from_str(text: &str) -> Result<Self, UnknownUnit> {
        match text.trim().to_ascii_lowercase().as_str() {
            "um" | "µm" | "μm" | "micron" | "micrometre" | "micrometer" => Ok(Self::Micrometre),
            "mm" | "millimetre" | "millimeter" => Ok(Self::Millimetre),
            "cm" | "centimetre" | "centimeter" => Ok(Self::Centimetre),
            "m" | "metre" | "meter" => Ok(Self::Metre),
            "in" | "inch" | "\"" => Ok(Self::Inch),
            "ft" | "foot" | "'" => Ok(Self::Foot),
            _ => Err(UnknownUnit(text.to_owned())),
        }
    }
}

/// The axis of the file that points up; a model's own is Z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum UpAxis {
    /// The model's (x, y, z) becomes (x, z, −y).
    Y,
    /// As in the model.
    Z,
}

/// What one named solid of an ASCII STL file holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SolidPer {
    /// One placed part.
    #[default]
    Part,
    /// Everything of one colour.
    Color,
    /// One body of one placed part.
    Body,
}

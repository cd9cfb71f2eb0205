//! The formats that can be written, and the unit and axes that a file states its coordinates in.

use std::fmt;
use std::str::FromStr;

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Format {
    StlBinary,
    StlAscii,
    Glb,
    Obj,
    Ply,
    ThreeMf,
}

impl Format {
    /// The format of a file name's extension, with or without its dot, in any case; `stl` means binary STL.
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.trim_start_matches('.').to_ascii_lowercase().as_str() {
            "stl" => Some(Self::StlBinary),
            "glb" => Some(Self::Glb),
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
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::ThreeMf => "3mf",
        }
    }

    /// Whether coordinates are rounded to 32-bit floats.
    pub fn is_single_precision(self) -> bool {
        matches!(self, Self::StlBinary | Self::Glb)
    }

    /// The unit written unless options say otherwise: metres in GLB, as its specification demands, else millimetres.
    pub fn default_unit(self) -> Unit {
        if self == Self::Glb { Unit::Metre } else { Unit::Millimetre }
    }

    /// The axis that points up unless options say otherwise: Y in GLB, as its specification demands, else Z.
    pub fn default_up(self) -> UpAxis {
        if self == Self::Glb { UpAxis::Y } else { UpAxis::Z }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::StlBinary => "binary STL",
            Self::StlAscii => "ASCII STL",
            Self::Glb => "GLB",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::ThreeMf => "3MF",
        })
    }
}

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Unit {
    Micrometre,
    #[default]
    Millimetre,
    Centimetre,
    Metre,
    Inch,
    Foot,
}

impl Unit {
    /// How many millimetres one of it is.
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

/// A name that is no unit of length.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no unit of length; use um, mm, cm, m, in or ft")]
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

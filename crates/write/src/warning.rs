//! Warnings about a written file.

use crate::Format;
use std::fmt;

/// A warning about a written file. The file is complete.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum WriteWarning {
    /// Rounding to 32-bit floats moved a vertex by more than a tenth of the tolerance.
    Rounding {
        /// The format that was written.
        format: Format,
        /// The largest move of a vertex in millimetres.
        rounding_mm: f64,
        /// The tolerance of the mesh in millimetres.
        tolerance_mm: f64,
    },
    /// Triangles have two corners at one place: rounding brought them together, or the mesh has them so.
    Collapsed {
        /// How many triangles, instances counted.
        triangles: u64,
    },
    /// Placements shear their parts, which glTF does not allow; viewers may reject or distort the file.
    Sheared {
        /// How many nodes of the tree.
        placements: usize,
    },
    /// The file has no triangle.
    Empty,
}

impl WriteWarning {
    /// A stable name for programs to match.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Rounding { .. } => "rounding",
            Self::Collapsed { .. } => "collapsed-triangles",
            Self::Sheared { .. } => "sheared-placements",
            Self::Empty => "empty-file",
        }
    }
}

impl fmt::Display for WriteWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Rounding { format, rounding_mm, tolerance_mm } => write!(
                f,
                "rounding to the 32-bit numbers of {format} moves vertices by up to {rounding_mm:.2e} mm, \
                 {:.0} % of the tolerance; PLY, OBJ and 3MF keep 64 bits",
                100.0 * rounding_mm / tolerance_mm
            ),
            Self::Collapsed { triangles: 1 } => f.write_str("1 triangle has two corners at the same place"),
            Self::Collapsed { triangles } => {
                write!(f, "{triangles} triangles have two corners at the same place")
            }
            Self::Sheared { placements: 1 } => {
                f.write_str("1 placement shears its part, which glTF does not allow")
            }
            Self::Sheared { placements } => {
                write!(f, "{placements} placements shear their parts, which glTF does not allow")
            }
            Self::Empty => f.write_str("the file has no triangles"),
        }
    }
}

//! The options of a writer.

use crate::{Format, SolidPer, Unit, UpAxis};

/// How a scene is written.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WriteOptions {
    /// The format of the file.
    pub format: Format,
    /// The unit of the coordinates; the format's default where absent.
    pub unit: Option<Unit>,
    /// The axis that points up; the format's default where absent.
    pub up: Option<UpAxis>,
    /// Whether glTF files (binary or text) also carry the model's edges as lines. Other formats ignore it.
    pub edge_lines: bool,
    /// What one solid of an ASCII STL file holds. Other formats ignore it.
    pub solid_per: SolidPer,
    /// The tolerance of the mesh in millimetres: 32-bit formats warn if rounding moves a vertex by over a
    /// tenth of it. Without it there is no such warning.
    pub tolerance_mm: Option<f64>,
}

impl WriteOptions {
    /// The defaults of a format.
    pub fn new(format: Format) -> Self {
        Self {
            format,
            unit: None,
            up: None,
            edge_lines: false,
            solid_per: SolidPer::Part,
            tolerance_mm: None,
        }
    }

    /// Sets the format.
    pub fn with_format(mut self, format: Format) -> Self {
        self.format = format;
        self
    }

    /// Sets the unit of the coordinates.
    pub fn with_unit(mut self, unit: Unit) -> Self {
        self.unit = Some(unit);
        self
    }

    /// Sets the axis that points up.
    pub fn with_up(mut self, up: UpAxis) -> Self {
        self.up = Some(up);
        self
    }

    /// Sets whether glTF files carry the model's edges as lines.
    pub fn with_edge_lines(mut self, edge_lines: bool) -> Self {
        self.edge_lines = edge_lines;
        self
    }

    /// Sets what one solid of an ASCII STL file holds.
    pub fn with_solid_per(mut self, solid_per: SolidPer) -> Self {
        self.solid_per = solid_per;
        self
    }

    /// Sets the tolerance of the mesh in millimetres, for the warning about rounding.
    pub fn with_tolerance_mm(mut self, tolerance_mm: f64) -> Self {
        self.tolerance_mm = Some(tolerance_mm);
        self
    }

    /// The unit of the file: the one set, else the default of the format.
    pub fn resolved_unit(&self) -> Unit {
        self.unit.unwrap_or(self.format.default_unit())
    }

    /// The axis that points up in the file: the one set, else the default of the format.
    pub fn resolved_up(&self) -> UpAxis {
        self.up.unwrap_or(self.format.default_up())
    }
}

impl Default for WriteOptions {
    /// PLY in millimetres, Z up: nothing is rounded.
    fn default() -> Self {
        Self::new(Format::Ply)
    }
}

//! What a picture shows, and how.

use super::camera::{Camera, Projection, View};
use super::srgb::linear;
use crate::error::OptionError;
use glam::DVec3;

/// How a model is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// Lit faces in the model's colours, with its edges as lines.
    #[default]
    Shaded,
    /// The edges alone; those behind faces are hidden.
    Edges,
    /// The edges of all triangles over pale faces.
    Wireframe,
    /// Mean curvature of the exact surfaces: red where the outside is convex, blue where it is hollow.
    Curvature,
    /// Distance between the mesh and the exact surfaces.
    Error,
}

/// What is behind the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// Linear red, green, blue.
    Color([f64; 3]),
    /// Nothing.
    Transparent,
}

impl Background {
    /// Pale grey.
    pub const LIGHT: Self = Self::Color([0.913, 0.922, 0.939]);
    /// Dark grey.
    pub const DARK: Self = Self::Color([0.0080, 0.0091, 0.0130]);

    /// True where lines must be light to be seen.
    pub(crate) fn is_dark(self) -> bool {
        match self {
            Self::Color([r, g, b]) => 0.21 * r + 0.72 * g + 0.07 * b < 0.18,
            Self::Transparent => false,
        }
    }
}

impl std::str::FromStr for Background {
    type Err = OptionError;

    /// `light`, `dark`, `transparent` or `#rrggbb`.
    fn from_str(text: &str) -> Result<Self, OptionError> {
        match text {
            "light" => return Ok(Self::LIGHT),
            "dark" => return Ok(Self::DARK),
            "transparent" => return Ok(Self::Transparent),
            _ => {}
        }
        let hex =
            text.strip_prefix('#').filter(|h| h.len() == 6).and_then(|h| u32::from_str_radix(h, 16).ok());
        let Some(hex) = hex else { return Err(OptionError::Background) };
        Ok(Self::Color([16, 8, 0].map(|shift| linear((hex >> shift & 255) as f64 / 255.0))))
    }
}

/// A plane that cuts away the points with `normal · p > offset` (millimetres).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionPlane {
    /// The direction of what is cut away.
    pub normal: DVec3,
    /// The distance of the plane from the origin along it.
    pub offset: f64,
}

/// How exact faces are trimmed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trim {
    /// Every sample of a pixel against the curves themselves, at any zoom.
    #[default]
    Exact,
    /// By a texture drawn for the view, in which loops are counted even and odd (Krishnamurthy, Khardekar,
    /// McMains 2009).
    Texture,
}

/// The normals that exact faces are lit by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// Evaluated in every pixel; interpolated at poles, and on surfaces whose Bézier nets the device cannot
    /// bind.
    #[default]
    Exact,
    /// The normals at the samples, interpolated between them.
    Interpolated,
}

/// How a picture is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RenderOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Where the eye is.
    pub view: View,
    /// The projection.
    pub projection: Projection,
    /// Above 1: nearer.
    pub zoom: f64,
    /// Move a camera with a place of its own so that it sees everything; named views always do.
    pub fit: bool,
    /// How the model is drawn.
    pub style: Style,
    /// Draw the lines of the style.
    pub lines: bool,
    /// What is behind the model.
    pub background: Background,
    /// The plane that cuts the model.
    pub section: Option<SectionPlane>,
    /// Of exact faces.
    pub trim: Trim,
    /// Of exact faces.
    pub normals: Normals,
    /// Leave out what the picture cannot show: faces beyond it, and backs of closed shells. Of exact faces.
    pub reject: bool,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            size: [1280, 960],
            view: View::From { direction: DVec3::new(1.0, -1.0, 0.8), up: DVec3::Z },
            projection: Projection::Orthographic,
            zoom: 1.0,
            fit: false,
            style: Style::Shaded,
            lines: true,
            background: Background::LIGHT,
            section: None,
            trim: Trim::Exact,
            normals: Normals::Exact,
            reject: true,
        }
    }
}

impl RenderOptions {
    /// The options with a size in pixels.
    pub fn with_size(self, width: u32, height: u32) -> Self {
        Self { size: [width, height], ..self }
    }
    /// The options with a view.
    pub fn with_view(self, view: View) -> Self {
        Self { view, ..self }
    }
    /// The options with a projection.
    pub fn with_projection(self, projection: Projection) -> Self {
        Self { projection, ..self }
    }
    /// The options with a zoom.
    pub fn with_zoom(self, zoom: f64) -> Self {
        Self { zoom, ..self }
    }
    /// The options with or without moving the camera so that it sees everything.
    pub fn with_fit(self, fit: bool) -> Self {
        Self { fit, ..self }
    }
    /// The options with a style.
    pub fn with_style(self, style: Style) -> Self {
        Self { style, ..self }
    }
    /// The options with or without the lines of the style.
    pub fn with_lines(self, lines: bool) -> Self {
        Self { lines, ..self }
    }
    /// The options with a background.
    pub fn with_background(self, background: Background) -> Self {
        Self { background, ..self }
    }
    /// The options with or without a section.
    pub fn with_section(self, section: Option<SectionPlane>) -> Self {
        Self { section, ..self }
    }
    /// The options with a way to trim exact faces.
    pub fn with_trim(self, trim: Trim) -> Self {
        Self { trim, ..self }
    }
    /// The options with a way to light exact faces.
    pub fn with_normals(self, normals: Normals) -> Self {
        Self { normals, ..self }
    }
    /// The options with or without leaving out what the picture cannot show.
    pub fn with_reject(self, reject: bool) -> Self {
        Self { reject, ..self }
    }

    /// The camera that shows these points.
    pub fn camera(&self, points: &[DVec3]) -> Camera {
        Camera::looking_at(self.view, self.projection, points, self.size, self.zoom, self.fit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn backgrounds_have_names_and_numbers() {
        assert_eq!("dark".parse(), Ok(Background::DARK));
        assert_eq!("#ffffff".parse(), Ok(Background::Color([1.0; 3])));
        assert!("#fff".parse::<Background>().is_err() && "blue".parse::<Background>().is_err());
        assert!(Background::DARK.is_dark() && !Background::LIGHT.is_dark());
    }
}

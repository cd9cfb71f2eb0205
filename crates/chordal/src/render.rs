//! Pictures of meshes and of exact models, drawn by a GPU or a software device.

use crate::meshed::Meshed;
use chordal_gpu::{
    DeviceChoice, FaceRenderer, FaceScene, Gpu, GpuError, Legend, RenderOptions, Renderer, Style,
    mesh_scenery, trimmed_model,
};

/// What is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum RenderMode {
    /// The triangles of the mesh.
    #[default]
    Mesh,
    /// The exact surfaces, evaluated for the view and trimmed at every sample.
    Nurbs,
}

/// How much was evaluated for an exact picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Evaluated {
    /// Points evaluated on the device.
    pub points: usize,
    /// Faces drawn from them; the others are outside the picture or face away.
    pub drawn: usize,
    /// Faces without an exact form, drawn as triangles.
    pub meshed: usize,
}

/// A picture.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Image {
    /// The bytes of a PNG file.
    pub png: Vec<u8>,
    /// What the colours mean, for styles that measure something.
    pub legend: Option<Legend>,
    /// For exact pictures.
    pub evaluated: Option<Evaluated>,
}

/// A device that draws pictures.
#[derive(Debug)]
pub struct ImageRenderer {
    gpu: Gpu,
    renderer: Renderer,
}

impl ImageRenderer {
    /// Opens a device.
    ///
    /// # Errors
    /// Where there is none.
    pub fn open(choice: DeviceChoice) -> Result<Self, GpuError> {
        let gpu = Gpu::open(choice)?;
        let renderer = Renderer::new(&gpu)?;
        Ok(Self { gpu, renderer })
    }

    /// The name of the device.
    pub fn device_name(&self) -> &str {
        self.gpu.name()
    }

    /// Draws a mesh, or the exact model that it was made of. Styles that measure or show the mesh draw the
    /// mesh.
    ///
    /// # Errors
    /// Where the device fails or the model is too large for it.
    pub fn render(
        &self,
        meshed: &Meshed,
        mode: RenderMode,
        options: &RenderOptions,
    ) -> Result<Image, GpuError> {
        let (scene, model) = (meshed.scene(), meshed.brep());
        let of_mesh = matches!(options.style, Style::Wireframe | Style::Curvature | Style::Error);
        if mode == RenderMode::Mesh || of_mesh {
            let (scenery, legend) = mesh_scenery(scene, model, options.style);
            let picture = self.renderer.render(&self.gpu, scene, &scenery, options)?;
            return Ok(Image { png: picture.to_png()?, legend, evaluated: None });
        }
        let exact = trimmed_model(scene, model);
        let faces = FaceRenderer::new(&self.gpu)?;
        let meshed_faces = exact.parts.iter().map(|p| p.meshed.len()).sum();
        let mut on_device = FaceScene::new(&self.gpu, exact, (scene, model), options.style)?;
        let (picture, counts) = self.renderer.render_faces(&self.gpu, &faces, &mut on_device, options)?;
        let evaluated = Evaluated { points: counts.points, drawn: counts.faces, meshed: meshed_faces };
        Ok(Image { png: picture.to_png()?, legend: None, evaluated: Some(evaluated) })
    }
}

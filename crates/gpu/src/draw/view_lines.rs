//! The lines of a model's edges, as fine as the view needs.

use super::mesh_groups::Lines;
use super::mesh_shapes::local;
use super::renderer::Renderer;
use super::shapes::Scenery;
use super::visible::Visible;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::faces::edge_lines;
use chordal_brep::Model;
use chordal_mesh::Scene;
use std::collections::BTreeMap;
use wgpu::Buffer;

/// Lines are made for an error smaller by this, and kept while it is at most so much smaller twice over.
const RESERVE: f64 = 2.0;

/// The lines on the device, and per shape the error that they are made for, in the part's units.
#[derive(Debug)]
pub(crate) struct ViewLines {
    lines: Vec<Lines>,
    errors: Vec<f64>,
}

impl ViewLines {
    pub fn new(shapes: usize) -> Self {
        Self { lines: Vec::new(), errors: vec![0.0; shapes] }
    }

    pub fn get(&self) -> &[Lines] {
        &self.lines
    }

    /// Makes them anew for the visible shapes whose lines do not serve.
    pub fn refine(
        &mut self,
        gpu: &Gpu,
        renderer: &Renderer,
        (scene, model): (&Scene, &Model),
        scenery: &mut Scenery,
        visible: &Visible,
        stage: [&Buffer; 2],
    ) -> Result<(), GpuError> {
        let mut needs: BTreeMap<usize, f64> = BTreeMap::new();
        for level in &visible.levels {
            let error = needs.entry(level.shape).or_insert(f64::INFINITY);
            *error = error.min(0.5 * level.error);
        }
        let mut changed = false;
        for (shape, error) in needs {
            let has = self.errors[shape];
            if has <= error && has * RESERVE * RESERVE >= error {
                continue;
            }
            let made_for = error / RESERVE;
            let lines = edge_lines(&model.parts[shape], &scene.parts[shape].mesh, made_for);
            let middle = scenery.shapes[shape].middle;
            scenery.shapes[shape].segments = lines.iter().map(|e| e.map(|p| local(p, middle))).collect();
            self.errors[shape] = made_for;
            changed = true;
        }
        if changed {
            self.lines = Lines::upload(gpu, &renderer.lines, &scenery.shapes, stage)?;
        }
        Ok(())
    }
}

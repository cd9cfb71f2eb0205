//! Sewing of mesh files along their borders.

use crate::error::{Error, FileError, RequestError};
use crate::meshed::format_of;
use crate::report::GapSurvey;
use crate::sewing::Sewing;
use chordal_mesh::{PassThrough, Scene, SceneNode, ScenePart, TriangleSoup, import_mesh};
use chordal_sew::{MeshSewReport, SewTolerance, SewnMesh, sew_mesh};
use chordal_write::{Format, Unit, WriteOptions, write_scene};
use glam::{DAffine3, DVec3};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The name and version of the schema of [`MeshSewingReport`].
pub const SEW_SCHEMA: &str = "chordal-sew/2";

/// So many open borders are listed, the longest first.
const LISTED: usize = 50;

/// The request for the sewing of a mesh file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshSewing {
    /// The merge tolerance; only `Auto` and `Millimetres` sew.
    pub tolerance: Sewing,
    /// The unit of the file's coordinates, if the file states none or a wrong one.
    pub unit: Option<Unit>,
    /// The format of the output; `None`: by its extension.
    pub format: Option<Format>,
    /// Coarser meshes of the sewn one to write as well, each with half the triangles of the one before.
    pub levels: usize,
}

impl Default for MeshSewing {
    fn default() -> Self {
        Self { tolerance: Sewing::Auto, unit: None, format: None, levels: 0 }
    }
}

impl MeshSewing {
    /// Sets the merge tolerance.
    pub fn with_tolerance(mut self, tolerance: Sewing) -> Self {
        self.tolerance = tolerance;
        self
    }
    /// Sets the unit.
    pub fn with_unit(mut self, unit: Option<Unit>) -> Self {
        self.unit = unit;
        self
    }
    /// Sets the format of the output.
    pub fn with_format(mut self, format: Option<Format>) -> Self {
        self.format = format;
        self
    }
    /// Sets the number of coarser meshes.
    pub fn with_levels(mut self, levels: usize) -> Self {
        self.levels = levels;
        self
    }
}

/// What was done to a mesh file; lengths are millimetres where the unit is known.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MeshSewingReport {
    /// [`SEW_SCHEMA`].
    pub schema: String,
    /// The path of the file.
    pub path: String,
    /// The merge tolerance, and how it was found where it was not given.
    pub tolerance: f64,
    /// How the tolerance was found; `null` where the caller gave it.
    pub auto: Option<GapSurvey>,
    /// Triangles of the file.
    pub triangles_before: usize,
    /// Triangles of the result.
    pub triangles: usize,
    /// Edges with a single triangle, and the borders they form.
    pub open_before: usize,
    /// The borders that they form.
    pub borders: usize,
    /// Stretches along which two borders were sewn, new vertices on borders, and vertices that became others.
    pub joined: usize,
    /// New vertices on borders.
    pub inserted: usize,
    /// Vertices that became another one.
    pub merged: usize,
    /// Correspondences that were rejected, because a vertex would have moved too far or a triangle vanished.
    pub rejected: usize,
    /// Edges with one triangle afterwards.
    pub open_after: usize,
    /// The longest borders that stay open.
    pub open: Vec<OpenBorderEntry>,
    /// The largest distance that a vertex moved.
    pub largest_move: f64,
    /// Triangles without area that were omitted, and those whose normal turned by more than a right angle.
    pub degenerate: usize,
    /// Triangles whose normal turned by more than a right angle.
    pub folded: usize,
    /// Triangles that were turned over, and edges that still contradict.
    pub flipped: usize,
    /// Edges whose triangles still disagree.
    pub inconsistent: usize,
    /// Connected shells, and those without an open edge.
    pub shells: usize,
    /// Those without an open edge.
    pub closed_shells: usize,
    /// The coarser meshes that were written.
    pub levels: Vec<LevelEntry>,
}

/// A border that stays open.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct OpenBorderEntry {
    /// How many edges it has.
    pub edges: usize,
    /// Its length.
    pub length: f64,
    /// The smallest and the largest distance of its edges' middles from another open edge.
    pub nearest: Option<[f64; 2]>,
    /// A point of it.
    pub at: [f64; 3],
}

/// A coarser mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LevelEntry {
    /// The path of the file.
    pub path: String,
    /// Triangles of the result.
    pub triangles: usize,
    /// The decimator's own estimate of the distance from the sewn mesh.
    pub error: f64,
}

impl MeshSewingReport {
    /// As JSON, with a line break at the end.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a report has string keys only") + "\n"
    }
}

/// Sews the mesh in `input` and writes it to `output`; every connected shell becomes an object of its own.
///
/// # Errors
/// Where the file cannot be read or nothing could be written.
pub fn sew_mesh_file(input: &Path, output: &Path, options: &MeshSewing) -> Result<MeshSewingReport, Error> {
    if options.levels > 0 && !crate::levels::AVAILABLE {
        return Err(RequestError::MissingFeature { feature: "levels" }.into());
    }
    let mut soup = import_mesh(input)
        .map_err(|source| Error::file(&input.display().to_string(), FileError::Mesh(source)))?;
    soup.unit_mm = options.unit.map(Unit::millimetres).or(soup.unit_mm);
    let soup = soup.into_millimetres_z_up();
    let format = options.format.map_or_else(|| format_of(output), Ok)?;
    let tolerance = match options.tolerance {
        Sewing::Millimetres(mm) => SewTolerance::Length(mm),
        Sewing::Off => SewTolerance::Length(0.0),
        Sewing::Auto | Sewing::AutoIfUnshared => SewTolerance::Auto,
    };
    let (mesh, found) = sew_mesh(&soup.positions, &soup.triangles, tolerance, resolution(&soup));
    let mut report = MeshSewingReport::new(input, &soup, &mesh, &found);
    write(&mesh, &soup, output, format)?;
    for level in crate::levels::levels(&mesh, options.levels) {
        let path = level_path(output, report.levels.len() + 1);
        write(&level.mesh, &soup, &path, format)?;
        report.levels.push(LevelEntry {
            path: path.display().to_string(),
            triangles: level.mesh.triangles.len(),
            error: level.error,
        });
    }
    Ok(report)
}

/// What 32-bit coordinates of this size can hold, with a margin for one that was computed from others.
fn resolution(soup: &TriangleSoup) -> Option<f64> {
    let largest = soup.positions.iter().fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
    (largest > 0.0).then_some(8.0 * f64::from(f32::EPSILON) * largest)
}

/// `out.stl` → `out.level1.stl`.
fn level_path(output: &Path, level: usize) -> PathBuf {
    let stem = output.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let extension = output.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
    output.with_file_name(format!("{stem}.level{level}{extension}"))
}

fn write(mesh: &SewnMesh, soup: &TriangleSoup, output: &Path, format: Format) -> Result<(), Error> {
    let scene = scene(mesh, soup);
    write_scene(&scene, output, &WriteOptions::new(format))
        .map(|_| ())
        .map_err(|source| RequestError::Write { path: output.to_owned(), source }.into())
}

/// One part for every shell, named after the group that its first triangle came from.
fn scene(mesh: &SewnMesh, soup: &TriangleSoup) -> Scene {
    let count = mesh.shells.iter().max().map_or(0, |&s| s as usize + 1);
    let mut of_shell: Vec<Vec<usize>> = vec![Vec::new(); count];
    mesh.shells.iter().enumerate().for_each(|(t, &s)| of_shell[s as usize].push(t));
    let mut scene = Scene::default();
    let mut local = vec![u32::MAX; mesh.positions.len()];
    for triangles in of_shell.iter().filter(|t| !t.is_empty()) {
        let mut item =
            PassThrough { name: group_name(soup, mesh.sources[triangles[0]]), ..PassThrough::default() };
        for &t in triangles {
            item.triangles.push(
                mesh.triangles[t].map(|v| index(&mut local, v, mesh.positions[v as usize], &mut item.points)),
            );
        }
        triangles.iter().flat_map(|&t| mesh.triangles[t]).for_each(|v| local[v as usize] = u32::MAX);
        let part = scene.parts.len();
        let name = item.name.clone();
        scene.parts.push(ScenePart { name: name.clone(), pass_through: vec![item], ..ScenePart::default() });
        scene.roots.push(scene.nodes.len());
        scene.nodes.push(SceneNode {
            name,
            transform: DAffine3::IDENTITY,
            part: Some(part),
            children: Vec::new(),
            color: None,
        });
    }
    scene
}

fn index(local: &mut [u32], vertex: u32, p: DVec3, points: &mut Vec<DVec3>) -> u32 {
    let known = &mut local[vertex as usize];
    if *known == u32::MAX {
        *known = points.len() as u32;
        points.push(p);
    }
    *known
}

fn group_name(soup: &TriangleSoup, triangle: u32) -> String {
    let holds = |g: &&chordal_mesh::SoupGroup| g.triangles.contains(&(triangle as usize));
    soup.groups.iter().find(holds).map(|g| g.name.clone()).unwrap_or_default()
}

impl MeshSewingReport {
    fn new(input: &Path, soup: &TriangleSoup, mesh: &SewnMesh, found: &MeshSewReport) -> Self {
        let open = found.open.iter().take(LISTED).map(|o| OpenBorderEntry {
            edges: o.edges,
            length: o.length,
            nearest: o.nearest,
            at: o.at.to_array(),
        });
        Self {
            schema: SEW_SCHEMA.into(),
            path: input.display().to_string(),
            tolerance: found.tolerance,
            auto: found.auto.as_ref().map(|a| GapSurvey::new(a, 1.0)),
            triangles_before: soup.triangles.len(),
            triangles: mesh.triangles.len(),
            open_before: found.open_before,
            borders: found.borders,
            joined: found.sewn,
            inserted: found.inserted,
            merged: found.merged,
            rejected: found.refused,
            open_after: found.open_after,
            open: open.collect(),
            largest_move: found.largest_move,
            degenerate: found.degenerate,
            folded: found.folded,
            flipped: found.turned,
            inconsistent: found.inconsistent,
            shells: found.shells,
            closed_shells: found.closed_shells,
            levels: Vec::new(),
        }
    }
}

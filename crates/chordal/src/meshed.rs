//! The mesh of a model, audited.

use crate::analytic::face_surfaces;
use crate::error::{Error, RequestError};
use crate::math::{DAffine3, DMat3, DVec2, DVec3};
use crate::report::{FaceEntry, Report};
use crate::resolve::Resolved;
use chordal_brep::{EdgeId, Face, FaceGeometry, FaceId, Model, PartId, Source};
use chordal_mesh::{FaceMesh, PlacedPart, Scene};
use chordal_nurbs::{Surface, UvBox};
use chordal_tessellate::{FaceReport, PartReport};
use chordal_write::{Encoded, Format, WriteError, WriteOptions, WriteSummary, to_bytes, write_scene};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The mesh of a model, audited, with its report.
///
/// Coordinates are millimetres of the assembled model. A part that is placed several times is meshed once.
///
/// ```
/// let model = chordal::Model::open("../../corpus/bracket.step")?;
/// let meshed = chordal::Mesher::default().mesh(&model)?;
/// for triangle in meshed.triangles().take(3) {
///     println!("{:?} {:?} {:?}", triangle.face, triangle.positions, triangle.uv);
/// }
/// assert_eq!(meshed.triangles().count(), meshed.report().triangles);
/// # Ok::<(), chordal::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Meshed {
    model: Arc<Model>,
    scene: Scene,
    placements: Vec<PlacedPart>,
    parts: Vec<PartReport>,
    resolved: Resolved,
    report: Report,
}

/// One triangle, as placed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Triangle {
    /// The part that it belongs to.
    pub part: PartId,
    /// Index of the placement, below [`Meshed::placement_count`].
    pub placement: usize,
    /// The face of the part; `None` for a triangle that was in the file already.
    pub face: Option<FaceId>,
    /// Millimetres; counter-clockwise seen from outside.
    pub positions: [DVec3; 3],
    /// The exact unit normals of the face there, pointing out of the material.
    pub normals: [DVec3; 3],
    /// Where the corners lie in the parameter space of the face.
    pub uv: [DVec2; 3],
}

/// One edge of the model as a polyline, as placed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Polyline {
    /// The part that it belongs to.
    pub part: PartId,
    /// Index of the placement, below [`Meshed::placement_count`].
    pub placement: usize,
    /// The edge of the part.
    pub edge: EdgeId,
    /// Millimetres; vertices of the triangles of every face that uses the edge.
    pub points: Vec<DVec3>,
}

/// One face with what is known about its mesh, once however often it is placed.
#[derive(Clone, Copy, Debug)]
pub struct MeshedFace<'a> {
    meshed: &'a Meshed,
    part: usize,
    face: usize,
    /// Index into `faces_detail` of the report.
    row: usize,
}

impl Meshed {
    pub(crate) fn new(
        model: Arc<Model>,
        scene: Scene,
        parts: Vec<PartReport>,
        resolved: Resolved,
        report: Report,
    ) -> Self {
        Self { model, placements: scene.placements(), scene, parts, resolved, report }
    }

    /// What was done, what is proven, what went wrong.
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// The report, without the mesh.
    pub fn into_report(self) -> Report {
        self.report
    }

    /// The exact model that was meshed, after sewing.
    pub fn brep(&self) -> &Model {
        &self.model
    }

    /// The meshes with names, colours and placements, as writers take them.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How often parts are placed.
    pub fn placement_count(&self) -> usize {
        self.placements.len()
    }

    /// From the coordinates of a placed part to millimetres of the assembled model.
    pub fn placement(&self, index: usize) -> Option<DAffine3> {
        self.placements.get(index).map(|placed| placed.world)
    }

    /// Every face once, in the order of the parts.
    pub fn faces(&self) -> impl Iterator<Item = MeshedFace<'_>> {
        let rows = self.model.parts.iter().zip(&self.resolved.uses).enumerate();
        // The report has no rows for parts that are never placed.
        let placed = rows.filter(|(_, (_, part_use))| part_use.instances > 0);
        let faces = placed.flat_map(|(part, (of, _))| (0..of.faces.len()).map(move |face| (part, face)));
        faces.enumerate().map(|(row, (part, face))| MeshedFace { meshed: self, part, face, row })
    }

    /// Every triangle as placed: by placement, then by face.
    pub fn triangles(&self) -> impl Iterator<Item = Triangle> + '_ {
        self.places().flat_map(move |place| {
            let part = &self.scene.parts[place.part.index()];
            let exact = part.mesh.faces.iter().flat_map(move |face| {
                let positions = &part.mesh.positions;
                face.triangles.iter().map(move |&triangle| place.triangle(positions, face, triangle))
            });
            let copied = part.pass_through.iter().flat_map(move |item| {
                item.triangles
                    .iter()
                    .map(move |&triangle| place.copied(&item.points, &item.normals, triangle))
            });
            exact.chain(copied)
        })
    }

    /// Every placement, with what it takes to place triangles.
    pub(crate) fn places(&self) -> impl Iterator<Item = Place> + '_ {
        self.placements.iter().enumerate().map(|(index, placed)| Place::new(placed, index))
    }

    /// Every edge of the model that a face uses, as placed.
    pub fn edges(&self) -> impl Iterator<Item = Polyline> + '_ {
        self.placements.iter().enumerate().flat_map(move |(placement, placed)| {
            let mesh = &self.scene.parts[placed.part].mesh;
            let used = mesh.edges.iter().enumerate().filter(|(_, points)| !points.is_empty());
            used.map(move |(edge, points)| Polyline {
                part: PartId(placed.part as u32),
                placement,
                edge: EdgeId(edge as u32),
                points: points
                    .iter()
                    .map(|&i| placed.world.transform_point3(mesh.positions[i as usize]))
                    .collect(),
            })
        })
    }

    /// Writes the mesh in the format of the extension: stl, ply, obj, glb, gltf or 3mf. The file is replaced
    /// only once the new one is complete.
    ///
    /// Binary STL and GLB have 32-bit coordinates. [`MeshOptions::with_output_format`] makes the mesh keep the
    /// tolerance after this rounding, too.
    ///
    /// [`MeshOptions::with_output_format`]: crate::MeshOptions::with_output_format
    ///
    /// # Errors
    /// [`Error::Request`] where the extension is unknown or the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<WriteSummary, Error> {
        let path = path.as_ref();
        self.write_with(path, &WriteOptions::new(format_of(path)?))
    }

    /// Writes the mesh with options.
    ///
    /// # Errors
    /// [`Error::Request`] where the file cannot be written.
    pub fn write_with(&self, path: impl AsRef<Path>, options: &WriteOptions) -> Result<WriteSummary, Error> {
        let path = path.as_ref();
        let options = self.with_tolerance(options);
        write_scene(&self.scene_for(options.format), path, &options).map_err(|source| failed(path, source))
    }

    /// The bytes of a mesh file. An OBJ file with colours refers to a second file, see
    /// [`Meshed::to_bytes_with`].
    ///
    /// # Errors
    /// [`Error::Request`] where the format cannot hold the mesh.
    pub fn to_bytes(&self, format: Format) -> Result<Vec<u8>, Error> {
        self.to_bytes_with(&WriteOptions::new(format)).map(|encoded| encoded.bytes)
    }

    /// A mesh file in memory, with the material library of an OBJ file and a summary.
    ///
    /// # Errors
    /// As [`Meshed::to_bytes`].
    pub fn to_bytes_with(&self, options: &WriteOptions) -> Result<Encoded, Error> {
        let options = self.with_tolerance(options);
        to_bytes(&self.scene_for(options.format), &options).map_err(|source| failed(Path::new(""), source))
    }

    /// Writers warn if rounding takes a large part of the tolerance.
    fn with_tolerance(&self, options: &WriteOptions) -> WriteOptions {
        let tolerance = options.tolerance_mm.unwrap_or(self.resolved.tolerance);
        options.with_tolerance_mm(tolerance)
    }

    /// glTF also carries the elementary surfaces under the faces.
    fn scene_for(&self, format: Format) -> Cow<'_, Scene> {
        if !matches!(format, Format::Glb | Format::Gltf) {
            return Cow::Borrowed(&self.scene);
        }
        let mut scene = self.scene.clone();
        for (part, exact) in scene.parts.iter_mut().zip(&self.model.parts) {
            part.face_surfaces = face_surfaces(exact, &part.mesh);
        }
        Cow::Owned(scene)
    }
}

/// The format that the extension of a path names.
///
/// # Errors
/// [`RequestError::OutputExtension`] where it names none.
pub(crate) fn format_of(path: &Path) -> Result<Format, Error> {
    let extension = path.extension().and_then(|e| e.to_str());
    let supported = "stl, ply, obj, glb, gltf, 3mf";
    extension
        .and_then(Format::from_extension)
        .ok_or_else(|| RequestError::OutputExtension { path: path.to_owned(), supported }.into())
}

fn failed(path: &Path, source: WriteError) -> Error {
    RequestError::Write { path: PathBuf::from(path), source }.into()
}

impl<'a> MeshedFace<'a> {
    /// The part that it belongs to.
    pub fn part(&self) -> PartId {
        PartId(self.part as u32)
    }

    /// Its index in the part.
    pub fn id(&self) -> FaceId {
        FaceId(self.face as u32)
    }

    /// The face of the exact model.
    pub fn exact(&self) -> &'a Face {
        &self.meshed.model.parts[self.part].faces[self.face]
    }

    /// Entity and line in the file.
    pub fn source(&self) -> Source {
        self.exact().source
    }

    /// The exact surface; `None` where the reader did not understand the face.
    pub fn surface(&self) -> Option<&'a Surface> {
        match &self.exact().geometry {
            FaceGeometry::Surface(surface) => Some(surface),
            FaceGeometry::Failed(_) => None,
        }
    }

    /// Its row of the report: status, triangles, proven error, gap.
    pub fn entry(&self) -> &'a FaceEntry {
        &self.meshed.report.faces_detail[self.row]
    }

    /// Its triangles in the coordinates of the part.
    pub fn mesh(&self) -> Option<&'a FaceMesh> {
        self.meshed.scene.parts[self.part].mesh.faces.get(self.face)
    }

    /// The cells of its subdivision, where
    /// [`MeshOptions::with_cells_recorded`](crate::MeshOptions::with_cells_recorded) is on.
    pub fn cells(&self) -> &'a [UvBox] {
        let of_face: Option<&FaceReport> = self.meshed.parts[self.part].faces.get(self.face);
        of_face.map_or(&[], |report| &report.cells)
    }
}

/// One placement of a part, with what it takes to place triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub part: PartId,
    pub placement: usize,
    pub world: DAffine3,
    /// Takes outward normals to outward normals, up to their length.
    normals: DMat3,
    mirrored: bool,
}

impl Place {
    fn new(placed: &PlacedPart, placement: usize) -> Self {
        let m = placed.world.matrix3;
        // The cofactor matrix is det(m)·m⁻ᵀ: it needs no division, so a flattening placement is no special
        // case.
        let cofactor =
            DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
        let mirrored = m.determinant() < 0.0;
        let normals = if mirrored { cofactor * -1.0 } else { cofactor };
        Self { part: PartId(placed.part as u32), placement, world: placed.world, normals, mirrored }
    }

    fn triangle(&self, positions: &[DVec3], face: &FaceMesh, triangle: [u32; 3]) -> Triangle {
        let corners = self.winding(triangle).map(|corner| face.corners[corner as usize]);
        Triangle {
            part: self.part,
            placement: self.placement,
            face: Some(FaceId(face.face)),
            positions: corners.map(|c| self.world.transform_point3(positions[c.position as usize])),
            normals: corners.map(|c| (self.normals * c.normal).normalize_or_zero()),
            uv: corners.map(|c| c.uv),
        }
    }

    /// A triangle of the file: without normals of its own it has that of its plane.
    fn copied(&self, points: &[DVec3], normals: &[DVec3], triangle: [u32; 3]) -> Triangle {
        let corners = self.winding(triangle);
        let positions = corners.map(|i| self.world.transform_point3(points[i as usize]));
        let [a, b, c] = positions;
        let flat = (b - a).cross(c - a).normalize_or_zero();
        let normal =
            |i: u32| normals.get(i as usize).map_or(flat, |&n| (self.normals * n).normalize_or_zero());
        Triangle {
            part: self.part,
            placement: self.placement,
            face: None,
            positions,
            normals: corners.map(normal),
            uv: [DVec2::ZERO; 3],
        }
    }

    pub fn winding(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        if self.mirrored { [a, c, b] } else { [a, b, c] }
    }
}

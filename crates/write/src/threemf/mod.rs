//! 3MF: a zip archive with one XML model, a unit, objects with shared vertices, components that place them.
//!
//! A part becomes one object however often it is placed (one more per colour that an assembly gives it), a
//! node with children an object of components, a root a build item. Numbers are 64-bit in decimal digits.
//!
//! 3MF has no mirroring transforms in practice (consumers disagree about the winding), so a mirror is baked:
//! below a mirroring node everything is expressed in coordinates with x reversed, `R = diag(−1, 1, 1)`, and
//! its transform becomes `T·R`. Every transform written so has a positive determinant.

mod materials;
mod object;

use crate::color::ColorKey;
use crate::frame::Frame;
use crate::number::push_number;
use crate::summary::Tally;
use crate::{Unit, WriteError, WriteOptions, color};
use chordal_mesh::{Rgba, Scene};
use glam::{DAffine3, DMat3, DVec3};
use materials::Materials;
use std::collections::BTreeMap;
use std::io::{BufWriter, Seek, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

const TYPES: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    "\n",
    r#"<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">"#,
    r#"<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>"#,
    r#"<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>"#,
    "</Types>\n",
);

const RELATIONSHIPS: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    "\n",
    r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">"#,
    r#"<Relationship Target="/3D/3dmodel.model" Id="rel0" "#,
    r#"Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>"#,
    "</Relationships>\n",
);

/// More text than this needs the 64-bit fields of the archive.
const LARGE: u64 = 3_000_000_000;

/// An upper estimate of the text of one triangle with its share of vertices.
const BYTES_PER_TRIANGLE: u64 = 160;

pub(crate) fn write<W: Write + Seek>(
    scene: &Scene,
    out: W,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let mut zip = ZipWriter::new(out);
    // A fixed time: the same mesh gives the same bytes.
    let plain = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(3))
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let zip_error = |e: zip::result::ZipError| WriteError::Io(e.into());
    for (name, text) in [("[Content_Types].xml", TYPES), ("_rels/.rels", RELATIONSHIPS)] {
        zip.start_file(name, plain).map_err(zip_error)?;
        zip.write_all(text.as_bytes())?;
    }
    let triangles: usize = scene.parts.iter().map(object::triangle_count).sum();
    let large = triangles as u64 * BYTES_PER_TRIANGLE > LARGE;
    zip.start_file("3D/3dmodel.model", plain.large_file(large)).map_err(zip_error)?;
    let mut text = BufWriter::with_capacity(1 << 16, &mut zip);
    write_model(scene, &mut text, options, tally)?;
    text.flush()?;
    drop(text);
    zip.finish().map_err(zip_error)?.flush()?;
    Ok(())
}

fn write_model(
    scene: &Scene,
    out: &mut impl Write,
    options: &WriteOptions,
    tally: &mut Tally,
) -> Result<(), WriteError> {
    let unit = match options.resolved_unit() {
        Unit::Micrometre => "micron",
        Unit::Millimetre => "millimeter",
        Unit::Centimetre => "centimeter",
        Unit::Metre => "meter",
        Unit::Inch => "inch",
        Unit::Foot => "foot",
    };
    let materials = Materials::new(scene);
    writeln!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{unit}\" xml:lang=\"en-US\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">"
    )?;
    writeln!(out, "<metadata name=\"Application\">Chordal {}</metadata>", env!("CARGO_PKG_VERSION"))?;
    if !scene.name.is_empty() {
        writeln!(out, "<metadata name=\"Title\">{}</metadata>", escape(&scene.name))?;
    }
    writeln!(out, "<resources>")?;
    materials.write(out)?;
    let mut objects = Objects::new(scene, Frame::new(options), options, &materials);
    let placed = Placed::walk(scene, objects.frame);
    // Children before parents: a component may refer only to what stands above it.
    for &node in placed.order.iter().rev() {
        objects.node(node, &placed, out, tally)?;
    }
    writeln!(out, "</resources>\n<build>")?;
    for &root in &scene.roots {
        let Some(object) = objects.object_of[root] else { continue };
        let transform = transform_attribute(placed.transform[root]);
        let name = &scene.nodes[root].name;
        let number =
            if name.is_empty() { String::new() } else { format!(" partnumber=\"{}\"", escape(name)) };
        writeln!(out, "<item objectid=\"{object}\"{transform}{number}/>")?;
    }
    writeln!(out, "</build>\n</model>")?;
    Ok(())
}

/// What the nodes' transforms become once mirrors are baked.
struct Placed {
    /// Parents before children.
    order: Vec<usize>,
    /// To the parent's coordinates in the file, with a positive determinant.
    transform: Vec<DAffine3>,
    /// Whether the node's coordinates have x reversed.
    mirrored: Vec<bool>,
    /// The colour that overrides those below.
    color: Vec<Option<Rgba>>,
}

impl Placed {
    fn walk(scene: &Scene, frame: Frame) -> Self {
        let count = scene.nodes.len();
        let mut placed = Self {
            order: Vec::with_capacity(count),
            transform: vec![DAffine3::IDENTITY; count],
            mirrored: vec![false; count],
            color: vec![None; count],
        };
        let mut stack: Vec<_> = scene.roots.iter().rev().map(|&n| (n, false, None)).collect();
        while let Some((node, mirrored_above, color_above)) = stack.pop() {
            let n = &scene.nodes[node];
            let mirrored = mirrored_above ^ (n.transform.matrix3.determinant() < 0.0);
            let color = color_above.or(n.color);
            placed.order.push(node);
            placed.transform[node] = mirror(mirrored_above) * frame.conjugate(n.transform) * mirror(mirrored);
            placed.mirrored[node] = mirrored;
            placed.color[node] = color;
            stack.extend(n.children.iter().rev().map(|&child| (child, mirrored, color)));
        }
        placed
    }
}

fn mirror(mirrored: bool) -> DAffine3 {
    let sign = if mirrored { -1.0 } else { 1.0 };
    DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(sign, 1.0, 1.0)))
}

/// What makes objects of one part differ: the overriding colour and the mirror.
type Variant = (usize, Option<ColorKey>, bool);

struct Objects<'a> {
    scene: &'a Scene,
    frame: Frame,
    options: &'a WriteOptions,
    materials: &'a Materials,
    variants: BTreeMap<Variant, Option<object::Written>>,
    /// Per node its object, if anything is in it.
    object_of: Vec<Option<u32>>,
    next_id: u32,
}

impl<'a> Objects<'a> {
    fn new(scene: &'a Scene, frame: Frame, options: &'a WriteOptions, materials: &'a Materials) -> Self {
        let object_of = vec![None; scene.nodes.len()];
        let next_id = materials::ID + 1;
        Self { scene, frame, options, materials, variants: BTreeMap::new(), object_of, next_id }
    }

    fn take_id(&mut self) -> u32 {
        self.next_id += 1;
        self.next_id - 1
    }

    fn node(
        &mut self,
        node: usize,
        placed: &Placed,
        out: &mut impl Write,
        tally: &mut Tally,
    ) -> Result<(), WriteError> {
        let scene = self.scene;
        let n = &scene.nodes[node];
        let mesh = match n.part {
            Some(part) => self.part((part, placed.color[node]), placed.mirrored[node], out, tally)?,
            None => None,
        };
        let children = n.children.iter().filter_map(|&c| Some((self.object_of[c]?, placed.transform[c])));
        let mut components: Vec<_> = children.collect();
        if components.is_empty() {
            self.object_of[node] = mesh;
            return Ok(());
        }
        components.extend(mesh.map(|mesh| (mesh, DAffine3::IDENTITY)));
        let id = self.take_id();
        self.object_of[node] = Some(id);
        writeln!(out, "<object id=\"{id}\" type=\"model\"{}>\n<components>", name_attribute(&n.name))?;
        for (object, transform) in components {
            writeln!(out, "<component objectid=\"{object}\"{}/>", transform_attribute(transform))?;
        }
        writeln!(out, "</components>\n</object>")?;
        Ok(())
    }

    /// The object of a part, written unless it was before; none if the part has no triangles.
    fn part(
        &mut self,
        (part, color): (usize, Option<Rgba>),
        mirrored: bool,
        out: &mut impl Write,
        tally: &mut Tally,
    ) -> Result<Option<u32>, WriteError> {
        let key = (part, color.map(color::key), mirrored);
        if !self.variants.contains_key(&key) {
            let id = self.next_id;
            let mesh = object::Mesh::new(&self.scene.parts[part], color, mirrored, self.frame, self.options)?;
            let written = mesh.write(id, self.materials, out)?;
            self.next_id += u32::from(written.is_some());
            tally.vertices += written.as_ref().map_or(0, |w| w.vertices);
            self.variants.insert(key, written);
        }
        let Some(written) = &self.variants[&key] else { return Ok(None) };
        tally.triangles += written.triangles;
        tally.collapsed += written.collapsed;
        Ok(Some(written.id))
    }
}

/// The affine map as 3MF states it: row vectors, four rows of three numbers; nothing for the identity.
fn transform_attribute(t: DAffine3) -> String {
    if t == DAffine3::IDENTITY {
        return String::new();
    }
    let mut text = b" transform=\"".to_vec();
    for (index, value) in t.to_cols_array().into_iter().enumerate() {
        if index > 0 {
            text.push(b' ');
        }
        push_number(&mut text, value);
    }
    text.push(b'"');
    String::from_utf8(text).expect("digits are ASCII")
}

fn name_attribute(name: &str) -> String {
    if name.is_empty() { String::new() } else { format!(" name=\"{}\"", escape(name)) }
}

/// Text for XML: its five special characters escaped, characters that it cannot hold as blanks.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&apos;"),
            c if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

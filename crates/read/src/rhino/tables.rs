//! What an archive holds besides geometry: units, layers, and the attributes of objects.

use super::bytes::{Bytes, Res};
use super::object::{Class, object};
use crate::flat::LengthUnit;
use chordal_brep::{Color, ReadIssue};

const UNITS: u32 = 0x2000_8031;
const LAYER_RECORD: u32 = 0x2000_8050;

/// A layer's name.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    pub index: i32,
    pub name: String,
}

/// What the attributes of an object say.
#[derive(Clone, Debug, Default)]
pub(super) struct Attributes {
    pub id: [u8; 16],
    pub name: String,
    pub layer: i32,
    pub color: Option<Color>,
    /// It belongs to the definition of a block: it is there where the block is placed, not by itself.
    pub in_block: bool,
}

/// The units of a settings table, and its absolute tolerance in them.
pub(super) fn units(mut table: Bytes) -> Option<(LengthUnit, f64)> {
    while let Ok(chunk) = table.chunk() {
        if chunk.code == UNITS {
            return unit(chunk.body).ok();
        }
    }
    None
}

fn unit(mut data: Bytes) -> Res<(LengthUnit, f64)> {
    let version = data.i32()?;
    let code = data.i32()?;
    let tolerance = data.f64()?;
    // Tolerances of angles and of relations.
    data.take(16)?;
    let mut metres = None;
    if version >= 101 {
        // How distances are shown.
        data.take(8)?;
        metres = Some(data.f64()?);
    }
    Ok((length_unit(code, metres), tolerance))
}

/// Rhino's numbers of units; none and those that no model has are taken for millimetres.
pub(super) fn length_unit(code: i32, custom_metres: Option<f64>) -> LengthUnit {
    let (name, millimetres) = match code {
        1 => ("micrometre", 1e-3),
        3 => ("cm", 10.0),
        4 => ("m", 1e3),
        5 => ("km", 1e6),
        6 => ("microinch", 25.4e-6),
        7 => ("mil", 25.4e-3),
        8 => ("inch", 25.4),
        9 => ("foot", 304.8),
        10 => ("mile", 1_609_344.0),
        11 => match custom_metres.filter(|m| m.is_normal() && *m > 0.0) {
            Some(metres) => ("custom", 1e3 * metres),
            None => ("mm", 1.0),
        },
        12 => ("angstrom", 1e-7),
        13 => ("nanometre", 1e-6),
        14 => ("decimetre", 100.0),
        15 => ("dekametre", 1e4),
        16 => ("hectometre", 1e5),
        17 => ("megametre", 1e9),
        19 => ("yard", 914.4),
        20 => ("point", 25.4 / 72.0),
        21 => ("pica", 25.4 / 6.0),
        _ => ("mm", 1.0),
    };
    LengthUnit { name: name.into(), millimetres }
}

/// The layers of a layer table; records that make no sense are passed over.
pub(super) fn layers(mut table: Bytes) -> Vec<Layer> {
    let mut layers = Vec::new();
    while let Ok(chunk) = table.chunk() {
        if chunk.code == LAYER_RECORD
            && let Ok(layer) = layer(chunk.body)
        {
            layers.push(layer);
        }
    }
    layers
}

fn layer(mut record: Bytes) -> Res<Layer> {
    let (class, mut data) = object(&mut record)?;
    if class != Class::Layer {
        return Err(ReadIssue::UnknownKind { found: "entry of the layer table".into(), expected: "a layer" });
    }
    data.version()?;
    data.i32()?;
    let index = data.i32()?;
    // IGES level, material, and one that is obsolete.
    data.take(12)?;
    // The colour of its wires, and an obsolete style of lines.
    data.take(4 + 4 + 16)?;
    Ok(Layer { index, name: data.text()? })
}

/// A colour in sRGB with its transparency; `None` where it is unset.
pub(super) fn color(data: &mut Bytes) -> Res<Option<Color>> {
    let [r, g, b, transparent] = data.u32()?.to_le_bytes();
    let linear = |c: u8| crate::srgb::linear(f64::from(c) / 255.0);
    let opacity = 1.0 - f32::from(transparent) / 255.0;
    let unset = [r, g, b, transparent] == [255; 4];
    Ok((!unset).then(|| Color([linear(r), linear(g), linear(b), opacity])))
}

/// A list of identifiers with its count.
pub(super) fn uuid_list(data: &mut Bytes) -> Res<Vec<[u8; 16]>> {
    let count = data.count(16)?;
    (0..count).map(|_| data.uuid()).collect()
}

/// The source of an object's colour: 1 is the object itself.
const FROM_OBJECT: u8 = 1;
/// The mode of objects that define a block.
const BLOCK_MEMBER: u8 = 3;

/// Reads the attributes of an object that are used.
pub(super) fn attributes(mut data: Bytes) -> Res<Attributes> {
    let (major, _) = data.version()?;
    if major >= 2 { recent_attributes(&mut data) } else { old_attributes(&mut data) }
}

fn old_attributes(data: &mut Bytes) -> Res<Attributes> {
    let id = data.uuid()?;
    let layer = data.i32()?;
    data.i32()?;
    let color = color(data)?;
    // An obsolete style of lines, and the density of wires.
    data.take(4 + 16 + 4)?;
    let mode = data.u8()?;
    let source = data.u8()?;
    data.take(2)?;
    let name = data.text()?;
    let color = color.filter(|_| source == FROM_OBJECT);
    Ok(Attributes { id, name, layer, color, in_block: mode & 15 == BLOCK_MEMBER })
}

/// Since version 5 only what departs from the usual is written, each item behind its number, in increasing
/// order.
fn recent_attributes(data: &mut Bytes) -> Res<Attributes> {
    let id = data.uuid()?;
    let mut found = Attributes { id, layer: data.i32()?, ..Attributes::default() };
    let mut source = 0;
    loop {
        match data.u8()? {
            1 => found.name = data.text()?,
            2 => _ = data.text()?,
            3 | 4 | 10 => _ = data.i32()?,
            5 => _ = data.chunk()?,
            6 => found.color = color(data)?,
            7 => _ = data.u32()?,
            8 => _ = data.f64()?,
            9 | 11 => _ = data.u8()?,
            12 => found.in_block = data.u8()? & 15 == BLOCK_MEMBER,
            13 => source = data.u8()?,
            // The end, or what has no bearing on the shape.
            _ => break,
        }
    }
    found.color = found.color.filter(|_| source == FROM_OBJECT);
    Ok(found)
}

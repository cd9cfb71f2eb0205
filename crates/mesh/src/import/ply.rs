//! PLY: ASCII or binary in either byte order; any scalar type for coordinates and indices; polygons become
//! fans.

use super::bytes::{Cursor, number, text, words};
use super::error::{Fault, ImportFault, ImportPlace};
use super::weld::Builder;
use glam::DVec3;
use std::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn parse(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

#[derive(Debug)]
struct Property {
    name: Vec<u8>,
    /// The type of the count before a list.
    list: Option<Scalar>,
    scalar: Scalar,
}

#[derive(Debug)]
struct Element {
    name: Vec<u8>,
    count: u64,
    properties: Vec<Property>,
}

impl Element {
    /// The fewest bytes that the element can take.
    fn least_size(&self, encoding: Encoding) -> u64 {
        let least = |p: &Property| match encoding {
            Encoding::Ascii => 2,
            _ => p.list.unwrap_or(p.scalar).size() as u64,
        };
        self.properties.iter().map(least).sum::<u64>().saturating_mul(self.count)
    }
}

/// A part that our own writer names in a comment.
#[derive(Debug)]
struct Part {
    triangles: Range<u64>,
    name: String,
}

#[derive(Debug)]
struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
    parts: Vec<Part>,
}

pub(super) fn read(bytes: &[u8], builder: &mut Builder) -> Result<(), Fault> {
    let mut cursor = Cursor { rest: bytes };
    let header = read_header(&mut cursor, builder)?;
    let mut values = Values { cursor, encoding: header.encoding, length: bytes.len() };
    let mut points = Vec::new();
    for element in &header.elements {
        // One byte is forgiven: ASCII files may end without a line's end.
        if element.least_size(header.encoding) > values.cursor.rest.len() as u64 + 1 {
            let what = format!("items of `{}`", text(&element.name));
            return Err(ImportFault::Count { what, stated: element.count, held: None }.into());
        }
        match element.name.as_slice() {
            b"vertex" => points = read_points(&mut values, element)?,
            b"face" => read_faces(&mut values, element, &points, &header.parts, builder)?,
            _ => skip(&mut values, element)?,
        }
    }
    Ok(())
}

fn read_header(cursor: &mut Cursor<'_>, builder: &mut Builder) -> Result<Header, Fault> {
    if cursor.line() != Some(b"ply") {
        return Err(ImportFault::Start { expected: "ply" }.into());
    }
    let mut header = Header { encoding: Encoding::Ascii, elements: Vec::new(), parts: Vec::new() };
    for number in 2.. {
        let line = cursor.line().ok_or(ImportFault::EndsInside { what: "header" })?;
        let words: Vec<_> = words(line).collect();
        let error =
            || Fault::from(ImportFault::HeaderLine { text: text(line) }).at(ImportPlace::Line(number));
        match words.as_slice() {
            [b"format", b"ascii", ..] => header.encoding = Encoding::Ascii,
            [b"format", b"binary_little_endian", ..] => header.encoding = Encoding::Little,
            [b"format", b"binary_big_endian", ..] => header.encoding = Encoding::Big,
            [b"element", name, count] => {
                let count = std::str::from_utf8(count).ok().and_then(|c| c.parse().ok()).ok_or_else(error)?;
                header.elements.push(Element { name: name.to_vec(), count, properties: Vec::new() });
            }
            [b"property", words @ ..] => {
                let property = property(words).ok_or_else(error)?;
                header.elements.last_mut().ok_or_else(error)?.properties.push(property);
            }
            [b"comment", words @ ..] => comment(words, &mut header, builder),
            [b"end_header"] => return Ok(header),
            [b"obj_info", ..] | [] => {}
            _ => return Err(error()),
        }
    }
    Err(ImportFault::EndsInside { what: "header" }.into())
}

fn property(words: &[&[u8]]) -> Option<Property> {
    match *words {
        [b"list", count, item, name] => Some(Property {
            name: name.to_vec(),
            list: Some(Scalar::parse(count)?),
            scalar: Scalar::parse(item)?,
        }),
        [scalar, name] => Some(Property { name: name.to_vec(), list: None, scalar: Scalar::parse(scalar)? }),
        _ => None,
    }
}

/// Our own writer's comments: the unit, the axis and the parts.
fn comment(words: &[&[u8]], header: &mut Header, builder: &mut Builder) {
    let int = |word: &[u8]| std::str::from_utf8(word).ok().and_then(|w| w.parse::<u64>().ok());
    match *words {
        [b"unit", unit] => builder.unit_mm = unit_mm(unit),
        [b"up", up] => builder.y_up = up == b"y",
        [b"part", _, _, first, count, _, _, ref name @ ..] => {
            let (Some(first), Some(count)) = (int(first), int(count)) else { return };
            let triangles = first..first.saturating_add(count);
            header.parts.push(Part { triangles, name: text(&name.join(&b' ')) });
        }
        _ => {}
    }
}

/// The length of a unit by its symbol.
pub(super) fn unit_mm(symbol: &[u8]) -> Option<f64> {
    Some(match symbol {
        b"um" => 0.001,
        b"mm" => 1.0,
        b"cm" => 10.0,
        b"m" => 1000.0,
        b"in" => 25.4,
        b"ft" => 304.8,
        _ => return None,
    })
}

struct Values<'a> {
    cursor: Cursor<'a>,
    encoding: Encoding,
    /// Bytes of the whole file.
    length: usize,
}

impl Values<'_> {
    /// A fault at the next byte to be read.
    fn fault(&self, kind: ImportFault) -> Fault {
        Fault::from(kind).at(ImportPlace::Byte(self.length - self.cursor.rest.len()))
    }

    fn next(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        let value = match self.encoding {
            Encoding::Ascii => self.word().and_then(number),
            encoding => self.binary(scalar, encoding == Encoding::Big),
        };
        value.ok_or_else(|| self.fault(ImportFault::EndsInside { what: "elements" }))
    }

    fn word(&mut self) -> Option<&[u8]> {
        let rest = self.cursor.rest.trim_ascii_start();
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, tail) = rest.split_at(end);
        self.cursor.rest = tail;
        (!word.is_empty()).then_some(word)
    }

    fn binary(&mut self, scalar: Scalar, big: bool) -> Option<f64> {
        let mut bytes = [0_u8; 8];
        let size = scalar.size();
        bytes[..size].copy_from_slice(self.cursor.take(size)?);
        if big {
            bytes[..size].reverse();
        }
        let low4 = [bytes[0], bytes[1], bytes[2], bytes[3]];
        let low2 = [bytes[0], bytes[1]];
        Some(match scalar {
            Scalar::I8 => f64::from(bytes[0] as i8),
            Scalar::U8 => f64::from(bytes[0]),
            Scalar::I16 => f64::from(i16::from_le_bytes(low2)),
            Scalar::U16 => f64::from(u16::from_le_bytes(low2)),
            Scalar::I32 => f64::from(i32::from_le_bytes(low4)),
            Scalar::U32 => f64::from(u32::from_le_bytes(low4)),
            Scalar::F32 => f64::from(f32::from_le_bytes(low4)),
            Scalar::F64 => f64::from_le_bytes(bytes),
        })
    }

    /// A property's value or values, into a buffer that is used again.
    fn property(&mut self, property: &Property, values: &mut Vec<f64>) -> Result<(), Fault> {
        values.clear();
        let count = match property.list {
            Some(count) => self.next(count)?,
            None => 1.0,
        };
        if !(0.0..=u32::MAX.into()).contains(&count) {
            return Err(self.fault(ImportFault::ListLength { length: count }));
        }
        for _ in 0..count as u64 {
            values.push(self.next(property.scalar)?);
        }
        Ok(())
    }
}

fn read_points(values: &mut Values<'_>, element: &Element) -> Result<Vec<DVec3>, Fault> {
    let axis = |p: &Property| [b"x", b"y", b"z"].iter().position(|a| a.as_slice() == p.name);
    let axes: Vec<_> = element.properties.iter().map(axis).collect();
    if (0..3).any(|a| !axes.contains(&Some(a))) {
        return Err(ImportFault::Missing { what: "x, y or z of the vertices" }.into());
    }
    let mut points = Vec::with_capacity(element.count as usize);
    let mut value = Vec::new();
    for _ in 0..element.count {
        let mut point = [0.0; 3];
        for (property, axis) in element.properties.iter().zip(&axes) {
            values.property(property, &mut value)?;
            if let (Some(axis), Some(&value)) = (*axis, value.first()) {
                point[axis] = value;
            }
        }
        points.push(DVec3::from_array(point));
    }
    Ok(points)
}

fn read_faces(
    values: &mut Values<'_>,
    element: &Element,
    points: &[DVec3],
    parts: &[Part],
    builder: &mut Builder,
) -> Result<(), Fault> {
    let is = |name: &[u8]| element.properties.iter().position(|p| p.name == name);
    let indices = is(b"vertex_indices")
        .or(is(b"vertex_index"))
        .ok_or(ImportFault::Missing { what: "vertex_indices of the faces" })?;
    let face_id = is(b"face_id");
    let mut parts = parts.iter().peekable();
    let (mut value, mut corners) = (Vec::new(), Vec::new());
    for triangle in 0..element.count {
        while let Some(part) = parts.next_if(|p| p.triangles.start <= triangle) {
            builder.group(&part.name);
        }
        let mut face = None;
        for (index, property) in element.properties.iter().enumerate() {
            values.property(property, &mut value)?;
            if index == indices {
                corners.clear();
                for &i in &value {
                    let point = usize::try_from(i as i64).ok().and_then(|i| points.get(i));
                    let point = point.ok_or_else(|| {
                        let vertex = i.to_string();
                        values.fault(ImportFault::UnknownVertex { vertex, vertices: points.len() })
                    })?;
                    corners.push(builder.point(*point).map_err(|fault| values.fault(fault))?);
                }
            } else if Some(index) == face_id {
                face = value.first().map(|&id| id as i64);
            }
        }
        for i in 1..corners.len().saturating_sub(1) {
            let corners = [corners[0], corners[i], corners[i + 1]];
            match face {
                Some(face) => builder.face_triangle(corners, face),
                None => builder.triangle(corners),
            }
        }
    }
    Ok(())
}

fn skip(values: &mut Values<'_>, element: &Element) -> Result<(), Fault> {
    if element.properties.is_empty() {
        return Ok(());
    }
    let mut value = Vec::new();
    for _ in 0..element.count {
        for property in &element.properties {
            values.property(property, &mut value)?;
        }
    }
    Ok(())
}

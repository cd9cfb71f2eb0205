//! The binary encoding: the same nodes without braces.
//!
//! All words have four bytes, the first one highest; texts are a length, the bytes, and zeros up to a
//! multiple of four. A node is its type, flags (2.1), the number of its fields, each with a name, value and
//! flags, and for a group the number of its children and these. Nothing says where a node ends, so that a
//! unknown node ends the readable part.

use super::fields::{self, FieldType, Layout};
use crate::scene::graph::{Graph, Node, NodeIx, Value};
use chordal_brep::{ReadIssue, Source};

/// Nodes within nodes deeper than this are not read.
const MAX_DEPTH: u32 = 400;

const IS_GROUP: u32 = 1 << 1;
const NOT_BUILT_IN: u32 = 1 << 15;
const CONNECTED: u32 = 1 << 1;

/// A file that ends or stops making sense; the sentence.
type Res<T> = Result<T, ReadIssue>;

/// The graph of a binary file up to where it can be understood.
pub(super) fn parse(bytes: &[u8], header: &str) -> Graph {
    let start = memchr::memchr(b'\n', bytes).map_or(bytes.len(), |at| at + 1);
    let old = header.contains("V1.0") || header.contains("V2.0");
    let mut reader = Reader { bytes, at: start, old, graph: Graph::default(), depth: 0 };
    while reader.at < bytes.len() {
        match reader.base() {
            Ok(Some(ix)) => reader.graph.roots.push(ix),
            Ok(None) => {}
            Err(reason) => {
                let source = reader.source();
                let at = reader.at;
                reader.graph.notes.lose(source, ReadIssue::AtByte { byte: at as u64, cause: reason.boxed() });
                break;
            }
        }
    }
    reader.graph
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Before version 2.1.
    old: bool,
    graph: Graph,
    depth: u32,
}

impl<'a> Reader<'a> {
    /// The node being read.
    fn source(&self) -> Source {
        Source { entity: self.graph.nodes.len() as u64, line: 0 }
    }

    fn take(&mut self, count: usize) -> Res<&'a [u8]> {
        let end = self.at.checked_add(count).filter(|&end| end <= self.bytes.len());
        let end = end.ok_or(ReadIssue::EntityTruncated)?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    fn word(&mut self) -> Res<u32> {
        let taken = self.take(4)?;
        Ok(u32::from_be_bytes([taken[0], taken[1], taken[2], taken[3]]))
    }

    fn text(&mut self) -> Res<String> {
        let length = self.word()? as usize;
        let text = String::from_utf8_lossy(self.take(length)?).into_owned();
        self.take(length.next_multiple_of(4) - length)?;
        Ok(text)
    }

    fn floats(&mut self, count: usize) -> Res<Vec<f64>> {
        let taken = self.take(count.checked_mul(4).ok_or(ReadIssue::ListTooLong { items: count as u64 })?)?;
        let number = |b: &[u8]| f64::from(f32::from_be_bytes([b[0], b[1], b[2], b[3]]));
        Ok(taken.chunks_exact(4).map(number).collect())
    }

    /// A node, a use of one, or (`None`) none.
    fn base(&mut self) -> Res<Option<NodeIx>> {
        let mut kind = self.text()?;
        let mut name = String::new();
        match kind.as_str() {
            "NULL" => return Ok(None),
            "USE" => {
                let name = self.text()?;
                let known = self.graph.names.get(&name).copied();
                if known.is_none() {
                    let source = self.source();
                    self.graph.notes.lose(source, ReadIssue::NameNotFound { what: "node", name });
                }
                return Ok(known);
            }
            "DEF" => {
                name = self.text()?;
                kind = self.text()?;
            }
            _ => {}
        }
        if !kind.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_') || kind.is_empty() {
            return Err(ReadIssue::Missing { what: "readable name of a node" });
        }
        if self.depth >= MAX_DEPTH {
            return Err(ReadIssue::Recursive { keyword: kind.into(), levels: MAX_DEPTH });
        }
        self.depth += 1;
        let number = self.graph.nodes.len() as u64 + 1;
        let ix = self.graph.add(Node { kind, name: name.clone(), number, ..Node::default() });
        if !name.is_empty() {
            self.graph.names.insert(name, ix);
        }
        let read = self.instance(ix);
        self.depth -= 1;
        read.map(|()| Some(ix))
    }

    /// Fields and children; those read before an error stay with the node.
    fn instance(&mut self, ix: NodeIx) -> Res<()> {
        let kind = self.graph.node(ix).kind.clone();
        let is_group = if self.old { fields::is_group(&kind) } else { self.word()? & IS_GROUP != 0 };
        if !(self.old && fields::has_no_fields(&kind)) {
            self.fields(ix, &kind)?;
        }
        if is_group {
            let count = self.word()?;
            for _ in 0..count {
                if let Some(child) = self.base()? {
                    self.graph.nodes[ix as usize].children.push(child);
                }
            }
        }
        Ok(())
    }

    fn fields(&mut self, ix: NodeIx, kind: &str) -> Res<()> {
        let written = self.word()?;
        let count = written & !NOT_BUILT_IN;
        let mut described: Vec<(String, String)> = Vec::new();
        if written & NOT_BUILT_IN != 0 {
            for _ in 0..count {
                let layout = self.text()?;
                described.push((self.text()?, layout));
            }
        }
        for _ in 0..count {
            let name = self.text()?;
            let told = described.iter().find(|(field, _)| *field == name);
            let layout = match told {
                Some((_, layout)) => fields::named(layout),
                None => fields::of(kind, &name),
            };
            let layout = layout
                .ok_or_else(|| ReadIssue::Unsupported { what: format!("field {name} of {kind}").into() })?;
            let value = self.value(layout)?;
            self.graph.nodes[ix as usize].fields.push((name, value));
            if self.word()? & CONNECTED != 0 {
                self.base()?;
                self.text()?;
            }
        }
        Ok(())
    }

    fn value(&mut self, (layout, many): FieldType) -> Res<Value> {
        let count = if many { self.word()? as usize } else { 1 };
        let too_long = || ReadIssue::ListTooLong { items: count as u64 };
        Ok(match layout {
            Layout::Floats(each) => {
                Value::Numbers(self.floats(count.checked_mul(each).ok_or_else(too_long)?)?)
            }
            Layout::Whole => {
                let taken = self.take(count.checked_mul(4).ok_or_else(too_long)?)?;
                let number = |b: &[u8]| f64::from(i32::from_be_bytes([b[0], b[1], b[2], b[3]]));
                Value::Numbers(taken.chunks_exact(4).map(number).collect())
            }
            Layout::Double => {
                let taken = self.take(count.checked_mul(8).ok_or_else(too_long)?)?;
                let number = |b: &[u8]| f64::from_be_bytes(std::array::from_fn(|i| b[i]));
                Value::Numbers(taken.chunks_exact(8).map(number).collect())
            }
            Layout::Text => Value::Words((0..count).map(|_| self.text()).collect::<Res<_>>()?),
            Layout::Flags => {
                let mut flags = Vec::new();
                loop {
                    match self.text()? {
                        end if end.is_empty() => break,
                        flag => flags.push(flag),
                    }
                }
                Value::Words(flags)
            }
            Layout::Node => {
                let mut nodes = Vec::new();
                for _ in 0..count {
                    nodes.extend(self.base()?);
                }
                Value::Nodes(nodes)
            }
            Layout::Image => {
                let (width, height, each) =
                    (self.word()? as usize, self.word()? as usize, self.word()? as usize);
                let size =
                    width.checked_mul(height).and_then(|n| n.checked_mul(each)).ok_or_else(too_long)?;
                self.take(size.checked_next_multiple_of(4).ok_or_else(too_long)?)?;
                Value::Numbers(Vec::new())
            }
            Layout::Trigger => Value::Numbers(Vec::new()),
        })
    }
}

//! Nodes with named fields, for all encodings of a file.

use crate::Winding;
use crate::assemble::Notes;
use chordal_brep::Source;
use rustc_hash::FxHashMap;
use std::borrow::Cow;

/// The position of a node in its graph.
pub(crate) type NodeIx = u32;

/// The value of a field as the encoding gives it; the reader of the field knows the type.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Numbers(Vec<f64>),
    /// Identifiers, enumerators, TRUE and FALSE.
    Words(Vec<String>),
    Strings(Vec<String>),
    Nodes(Vec<NodeIx>),
    /// An attribute of XML: any of the above.
    Raw(String),
    /// The value of the enclosing prototype's field of this name.
    Is(String),
}

impl Value {
    /// How much it holds.
    pub(crate) fn size(&self) -> usize {
        match self {
            Value::Numbers(numbers) => numbers.len(),
            Value::Raw(text) => text.len() / 2,
            Value::Words(words) | Value::Strings(words) => words.len(),
            Value::Nodes(nodes) => nodes.len(),
            Value::Is(_) => 1,
        }
    }
}

/// A node with its fields in file order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Node {
    pub kind: String,
    /// The name that DEF gives it.
    pub name: String,
    pub fields: Vec<(String, Value)>,
    /// Nodes inside it that belong to no named field, in file order.
    pub children: Vec<NodeIx>,
    /// Its line in a text file; else 0.
    pub line: u32,
    /// Its number in a file without lines, from 1; else 0.
    pub number: u64,
}

impl Node {
    pub(crate) fn field(&self, name: &str) -> Option<&Value> {
        // The last one counts, as for readers that assign while they read.
        self.fields.iter().rev().find(|(found, _)| found == name).map(|(_, value)| value)
    }

    pub(crate) fn source(&self) -> Source {
        Source { entity: self.number, line: self.line }
    }

    /// The numbers of a field; empty where it is absent or holds something else.
    pub(crate) fn numbers(&self, name: &str) -> Cow<'_, [f64]> {
        match self.field(name) {
            Some(Value::Numbers(numbers)) => Cow::Borrowed(numbers),
            Some(Value::Raw(text)) => Cow::Owned(parse_numbers(text)),
            _ => Cow::Borrowed(&[]),
        }
    }

    pub(crate) fn number(&self, name: &str, default: f64) -> f64 {
        self.numbers(name).first().copied().filter(|x| x.is_finite()).unwrap_or(default)
    }

    /// A count; negative ones and those beyond 32 bits are zero.
    pub(crate) fn count(&self, name: &str, default: usize) -> usize {
        match self.numbers(name).first() {
            Some(&x) if x >= 0.0 && x < f64::from(u32::MAX) => x as usize,
            Some(_) => 0,
            None => default,
        }
    }

    pub(crate) fn vector(&self, name: &str, default: [f64; 3]) -> [f64; 3] {
        match *self.numbers(name) {
            [x, y, z, ..] if x.is_finite() && y.is_finite() && z.is_finite() => [x, y, z],
            _ => default,
        }
    }

    /// The first word of a field.
    pub(crate) fn word(&self, name: &str) -> &str {
        match self.field(name) {
            Some(Value::Words(words) | Value::Strings(words)) => words.first().map_or("", String::as_str),
            Some(Value::Raw(text)) => text.trim(),
            _ => "",
        }
    }

    pub(crate) fn words(&self, name: &str) -> Vec<&str> {
        match self.field(name) {
            Some(Value::Words(words) | Value::Strings(words)) => words.iter().map(String::as_str).collect(),
            Some(Value::Raw(text)) => text.split_whitespace().collect(),
            _ => Vec::new(),
        }
    }

    pub(crate) fn flag(&self, name: &str, default: bool) -> bool {
        if let Some(Value::Numbers(numbers)) = self.field(name) {
            return numbers.first().map_or(default, |&x| x != 0.0);
        }
        match self.word(name) {
            "TRUE" | "true" => true,
            "FALSE" | "false" => false,
            _ => default,
        }
    }

    /// The nodes of a field.
    pub(crate) fn nodes(&self, name: &str) -> &[NodeIx] {
        match self.field(name) {
            Some(Value::Nodes(nodes)) => nodes,
            _ => &[],
        }
    }
}

/// The numbers of a text separated by blanks and commas; from the first that is none on, nothing.
pub(crate) fn parse_numbers(text: &str) -> Vec<f64> {
    text.split(|c: char| c.is_ascii_whitespace() || c == ',')
        .filter(|word| !word.is_empty())
        .map_while(parse_number)
        .collect()
}

/// A number as these formats write it; hexadecimal ones are whole.
pub(crate) fn parse_number(word: &str) -> Option<f64> {
    if let Some(hex) = word.strip_prefix("0x").or_else(|| word.strip_prefix("0X")) {
        return u64::from_str_radix(hex, 16).ok().map(|x| x as f64);
    }
    let first = word.trim_start_matches(['+', '-']).bytes().next()?;
    if first.is_ascii_digit() || first == b'.' { word.parse().ok() } else { None }
}

/// A prototype: what an instance of it stands for.
#[derive(Clone, Debug, Default)]
pub(crate) struct Prototype {
    /// The fields with their default values.
    pub defaults: Vec<(String, Value)>,
    pub body: Vec<NodeIx>,
    /// Defined in another file.
    pub external: bool,
}

/// All nodes of a file.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    pub nodes: Vec<Node>,
    pub roots: Vec<NodeIx>,
    /// The node that a name stands for at the moment; at the end of the file, its last one.
    pub names: FxHashMap<String, NodeIx>,
    pub prototypes: FxHashMap<String, Prototype>,
    /// Millimetres of one unit of length.
    pub millimetres: Option<f64>,
    /// Radians of one unit of angle.
    pub radians: Option<f64>,
    pub notes: Notes,
    /// The convention for trimming loops.
    pub winding: Winding,
}

impl Graph {
    pub(crate) fn node(&self, ix: NodeIx) -> &Node {
        &self.nodes[ix as usize]
    }

    pub(crate) fn add(&mut self, node: Node) -> NodeIx {
        let ix = NodeIx::try_from(self.nodes.len()).expect("a file of less than 4 GiB of nodes");
        self.nodes.push(node);
        ix
    }

    /// A UNIT statement: `factor` metres or radians.
    pub(crate) fn unit(&mut self, category: &str, factor: f64) {
        if factor > 0.0 && factor.is_finite() {
            match category {
                "length" => self.millimetres = Some(1000.0 * factor),
                "angle" => self.radians = Some(factor),
                _ => {}
            }
        }
    }

    /// The first node of a field, or among unnamed children and other fields the first of one of these kinds.
    pub(crate) fn child(&self, ix: NodeIx, field: &str, kinds: &[&str]) -> Option<NodeIx> {
        let node = self.node(ix);
        node.nodes(field).first().copied().or_else(|| {
            let named = node.fields.iter().filter_map(|(_, value)| match value {
                Value::Nodes(nodes) => Some(nodes.as_slice()),
                _ => None,
            });
            let mut all = named.flatten().chain(&node.children).copied();
            all.find(|&child| kinds.contains(&self.node(child).kind.as_str()))
        })
    }
}

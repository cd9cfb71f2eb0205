//! The XML encoding of X3D: elements are nodes, attributes fields.

use crate::scene::graph::{Graph, Node, NodeIx, Prototype, Value};
use chordal_brep::{ReadIssue, Source};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// Elements nested deeper than this are ignored.
const MAX_DEPTH: usize = 400;

/// The graph of an XML file, as far as it can be read, and the version that it states.
pub(super) fn parse(bytes: &[u8]) -> (Graph, String) {
    let text = String::from_utf8_lossy(bytes);
    let bytes = text.as_bytes();
    let mut reader = Reader::from_str(&text);
    reader.config_mut().check_end_names = false;
    let mut parser =
        Parser { graph: Graph::default(), open: Vec::new(), schema: "X3D XML".to_owned(), line: 1 };
    let mut counted = 0;
    loop {
        let event = reader.read_event();
        let at = usize::try_from(reader.buffer_position()).unwrap_or(bytes.len()).min(bytes.len());
        match event {
            Ok(Event::Start(element)) => {
                let what = parser.element(&element);
                if parser.open.len() >= MAX_DEPTH {
                    let source = parser.here();
                    parser.graph.notes.lose(
                        source,
                        ReadIssue::Recursive { keyword: "XML".into(), levels: MAX_DEPTH as u32 },
                    );
                    break;
                }
                parser.open.push(what);
            }
            Ok(Event::Empty(element)) => {
                let what = parser.element(&element);
                parser.close(what);
            }
            Ok(Event::End(_)) => {
                if let Some(what) = parser.open.pop() {
                    parser.close(what);
                }
            }
            Ok(Event::Eof) => {
                if !parser.open.is_empty() {
                    let source = parser.here();
                    parser.graph.notes.lose(source, ReadIssue::FileTruncated);
                }
                break;
            }
            Ok(_) => {}
            Err(error) => {
                let source = parser.here();
                parser.graph.notes.lose(source, ReadIssue::TextBroken { reason: error.to_string() });
                break;
            }
        }
        // An element's line is the one on which it ends.
        parser.line += memchr::memchr_iter(b'\n', &bytes[counted..at.max(counted)]).count() as u32;
        counted = at.max(counted);
    }
    while let Some(what) = parser.open.pop() {
        parser.close(what);
    }
    (parser.graph, parser.schema)
}

/// What an open element is.
#[derive(Debug)]
enum Open {
    /// X3D, Scene: nodes in it are the file's.
    Scene,
    Node(NodeIx),
    /// ProtoDeclare with what is known of it.
    Declare(String, Prototype),
    /// ProtoInterface, ProtoBody: what they hold goes to the declaration.
    Interface,
    Body,
    /// A field of an interface, or the value of one of an instance, with nodes.
    Field(String, Vec<NodeIx>),
    Ignored,
}

struct Parser {
    graph: Graph,
    open: Vec<Open>,
    schema: String,
    line: u32,
}

impl Parser {
    fn here(&self) -> Source {
        Source { entity: 0, line: self.line }
    }

    /// What an element begins.
    fn element(&mut self, element: &BytesStart<'_>) -> Open {
        let name = element.local_name().as_ref().to_owned();
        let attributes = attributes(element);
        let get = |wanted: &str| {
            attributes.iter().find(|(key, _)| key == wanted).map_or("", |(_, value)| value.as_str())
        };
        match name.as_str() {
            "X3D" => {
                self.schema = format!("X3D V{} XML", get("version"));
                Open::Scene
            }
            "Scene" => Open::Scene,
            "unit" => {
                if let Ok(factor) = get("conversionFactor").trim().parse() {
                    self.graph.unit(get("category"), factor);
                }
                Open::Ignored
            }
            "ProtoDeclare" => Open::Declare(get("name").to_owned(), Prototype::default()),
            "ExternProtoDeclare" => {
                let prototype = Prototype { external: true, ..Prototype::default() };
                self.graph.prototypes.insert(get("name").to_owned(), prototype);
                Open::Ignored
            }
            "ProtoInterface" => Open::Interface,
            "ProtoBody" => Open::Body,
            "field" | "fieldValue" => {
                let field = get("name").to_owned();
                if attributes.iter().any(|(key, _)| key == "value") {
                    self.field_value(&field, Value::Raw(get("value").to_owned()));
                }
                Open::Field(field, Vec::new())
            }
            "connect" => {
                let (node_field, proto_field) = (get("nodeField").to_owned(), get("protoField").to_owned());
                let node = self
                    .open
                    .iter()
                    .rev()
                    .find_map(|o| if let Open::Node(ix) = o { Some(*ix) } else { None });
                if let Some(ix) = node {
                    self.graph.nodes[ix as usize].fields.push((node_field, Value::Is(proto_field)));
                }
                Open::Ignored
            }
            "head" | "meta" | "component" | "ROUTE" | "IS" | "IMPORT" | "EXPORT" => Open::Ignored,
            _ => self.node(name, attributes),
        }
    }

    fn node(&mut self, name: String, attributes: Vec<(String, String)>) -> Open {
        let line = self.line;
        let mut node = Node { kind: name, line, ..Node::default() };
        let (mut used, mut container) = (None, String::new());
        for (key, value) in attributes {
            match key.as_str() {
                "DEF" => node.name = value,
                "USE" => used = Some(value),
                "containerField" => container = value,
                "name" if node.kind == "ProtoInstance" => node.kind = value,
                _ => node.fields.push((key, Value::Raw(value))),
            }
        }
        if let Some(name) = used {
            match self.graph.names.get(&name).copied() {
                Some(ix) => self.attach(ix, &container),
                None => {
                    let source = self.here();
                    self.graph.notes.lose(source, ReadIssue::NameNotFound { what: "node", name });
                }
            }
            return Open::Ignored;
        }
        let name = node.name.clone();
        let ix = self.graph.add(node);
        if !name.is_empty() {
            self.graph.names.insert(name, ix);
        }
        self.attach(ix, &container);
        Open::Node(ix)
    }

    /// Puts a node into what is open.
    fn attach(&mut self, ix: NodeIx, container: &str) {
        let declares = self.open.iter().rposition(|open| matches!(open, Open::Declare(..)));
        match self.open.last_mut() {
            Some(Open::Node(parent)) => {
                let parent = &mut self.graph.nodes[*parent as usize];
                if container.is_empty() {
                    parent.children.push(ix);
                    return;
                }
                let known = parent.fields.iter_mut().find(|(name, _)| name == container);
                if let Some((_, Value::Nodes(nodes))) = known {
                    nodes.push(ix);
                } else {
                    parent.fields.push((container.to_owned(), Value::Nodes(vec![ix])));
                }
            }
            Some(Open::Field(_, nodes)) => nodes.push(ix),
            Some(Open::Body) => {
                if let Some(at) = declares
                    && let Open::Declare(_, prototype) = &mut self.open[at]
                {
                    prototype.body.push(ix);
                }
            }
            Some(Open::Scene) | None => self.graph.roots.push(ix),
            _ => {}
        }
    }

    /// Sets a field of the declaration, instance or script around it.
    fn field_value(&mut self, field: &str, value: Value) {
        for open in self.open.iter_mut().rev() {
            match open {
                Open::Node(ix) => {
                    self.graph.nodes[*ix as usize].fields.push((field.to_owned(), value));
                    return;
                }
                Open::Declare(_, prototype) => {
                    prototype.defaults.push((field.to_owned(), value));
                    return;
                }
                _ => {}
            }
        }
    }

    fn close(&mut self, what: Open) {
        match what {
            Open::Declare(name, prototype) => {
                self.graph.prototypes.insert(name, prototype);
            }
            Open::Field(name, nodes) if !nodes.is_empty() => self.field_value(&name, Value::Nodes(nodes)),
            _ => {}
        }
    }
}

/// Names and values of an element's attributes; malformed ones are ignored.
fn attributes(element: &BytesStart<'_>) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for attribute in element.attributes().with_checks(false).flatten() {
        let raw = attribute.value;
        let value =
            quick_xml::escape::unescape(&raw).map_or_else(|_| raw.to_string(), |value| value.into_owned());
        found.push((attribute.key.local_name().as_ref().to_owned(), value));
    }
    found
}

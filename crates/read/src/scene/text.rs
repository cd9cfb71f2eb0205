//! The text encodings of Inventor, VRML and X3D as a graph of nodes.
//!
//! Fields and nodes are distinguished by what follows a word: `{` makes it the type of a node. The type of a
//! field's value is what it looks like, so that unknown nodes can be skipped. Names hold from their DEF on,
//! until another one takes them.

use super::graph::{Graph, Node, NodeIx, Prototype, Value};
use super::lexer::{Lexer, Token};
use chordal_brep::{ReadIssue, Source};

/// Nodes nested deeper than this are ignored.
const MAX_DEPTH: u32 = 400;

/// The graph of a text file, as much of it as can be understood.
pub(crate) fn parse(bytes: &[u8]) -> Graph {
    let mut parser = Parser { lexer: Lexer::new(bytes), graph: Graph::default(), depth: 0 };
    while parser.lexer.peek() != Token::End {
        let mut found = Vec::new();
        parser.statement(&mut found);
        parser.graph.roots.extend(found);
    }
    parser.graph
}

struct Parser<'a> {
    lexer: Lexer<'a>,
    graph: Graph,
    depth: u32,
}

impl Parser<'_> {
    fn here(&self) -> Source {
        Source { entity: 0, line: self.lexer.line }
    }

    /// One statement outside of nodes; nodes are added to `found`.
    fn statement(&mut self, found: &mut Vec<NodeIx>) {
        match self.lexer.next() {
            Token::Word("PROFILE" | "COMPONENT" | "META" | "IMPORT" | "EXPORT") => self.lexer.skip_line(),
            Token::Word("ROUTE") => self.skip_route(),
            Token::Word("UNIT") => self.unit(),
            Token::Word("PROTO") => self.prototype(false),
            Token::Word("EXTERNPROTO") => self.prototype(true),
            Token::Word("NULL") => {}
            Token::Word(word) => found.extend(self.node(word)),
            Token::Sign(b'{') => {
                let source = self.here();
                self.graph.notes.warn(source, ReadIssue::StrayBytes);
            }
            _ => {}
        }
    }

    /// ROUTE from TO to: nothing moves here.
    fn skip_route(&mut self) {
        for _ in 0..3 {
            if matches!(self.lexer.peek(), Token::Word(_)) {
                self.lexer.next();
            }
        }
    }

    /// UNIT category name factor.
    fn unit(&mut self) {
        let (category, _name, factor) = (self.lexer.next(), self.lexer.next(), self.lexer.next());
        if let (Token::Word(category), Token::Number(factor)) = (category, factor) {
            self.graph.unit(category, factor);
        }
    }

    /// A node behind its first word: DEF, USE or its type.
    fn node(&mut self, first: &str) -> Option<NodeIx> {
        let line = self.lexer.line;
        match first {
            "USE" => {
                let name = self.name()?;
                let known = self.graph.names.get(&name).copied();
                if known.is_none() {
                    let source = Source { entity: 0, line };
                    self.graph.notes.lose(source, ReadIssue::NameNotFound { what: "node", name });
                }
                known
            }
            "DEF" => {
                let name = self.name()?;
                let Token::Word(kind) = self.lexer.next() else { return None };
                self.body(kind, name, line)
            }
            kind => self.body(kind, String::new(), line),
        }
    }

    /// The name behind DEF or USE, which may look like a number.
    fn name(&mut self) -> Option<String> {
        match self.lexer.next() {
            Token::Word(name) => Some(name.to_owned()),
            Token::Number(number) => Some(number.to_string()),
            Token::Text(name) => Some(name),
            _ => None,
        }
    }

    /// The braces of a node with all they hold.
    fn body(&mut self, kind: &str, name: String, line: u32) -> Option<NodeIx> {
        let source = Source { entity: 0, line };
        if !self.lexer.take(b'{') {
            self.graph.notes.warn(source, ReadIssue::Unsupported { what: kind.to_string().into() });
            return None;
        }
        if self.depth >= MAX_DEPTH {
            self.graph
                .notes
                .lose(source, ReadIssue::Recursive { keyword: kind.to_string().into(), levels: MAX_DEPTH });
            self.skip_braces();
            return None;
        }
        let ix = self.graph.add(Node { kind: kind.to_owned(), name: name.clone(), line, ..Node::default() });
        if !name.is_empty() {
            self.graph.names.insert(name, ix);
        }
        self.depth += 1;
        let mut node = Node::default();
        loop {
            match self.lexer.next() {
                Token::Sign(b'}') => break,
                Token::End => {
                    self.graph.notes.lose(source, ReadIssue::EntityTruncated);
                    break;
                }
                Token::Word(word) => self.member(word, &mut node),
                _ => {}
            }
        }
        self.depth -= 1;
        let target = &mut self.graph.nodes[ix as usize];
        target.fields = node.fields;
        target.children = node.children;
        Some(ix)
    }

    /// A field or child of a node, behind its first word.
    fn member(&mut self, word: &str, node: &mut Node) {
        match word {
            "ROUTE" => self.skip_route(),
            "PROTO" => self.prototype(false),
            "EXTERNPROTO" => self.prototype(true),
            "DEF" | "USE" => node.children.extend(self.node(word)),
            "field" | "exposedField" | "inputOutput" | "initializeOnly" => {
                let (_type, name) = (self.lexer.next(), self.lexer.next());
                let value = self.value();
                if let (Token::Word(name), Some(value)) = (name, value) {
                    node.fields.push((name.to_owned(), value));
                }
            }
            "eventIn" | "eventOut" | "inputOnly" | "outputOnly" => {
                let (_type, _name) = (self.lexer.next(), self.lexer.next());
                self.skip_is();
            }
            _ if self.lexer.peek() == Token::Sign(b'{') => node.children.extend(self.node(word)),
            _ => {
                if let Some(value) = self.value() {
                    node.fields.push((word.to_owned(), value));
                }
            }
        }
    }

    fn skip_is(&mut self) {
        if self.lexer.peek() == Token::Word("IS") {
            self.lexer.next();
            self.lexer.next();
        }
    }

    /// The value of a field; `None` where there is none.
    fn value(&mut self) -> Option<Value> {
        let value = match self.lexer.peek() {
            Token::Sign(b'[') => {
                self.lexer.next();
                Some(self.list(b']'))
            }
            Token::Sign(b'(') => {
                self.lexer.next();
                Some(self.list(b')'))
            }
            Token::Number(_) => {
                let mut numbers = Vec::new();
                while let Token::Number(x) = self.lexer.peek() {
                    self.lexer.next();
                    numbers.push(x);
                }
                Some(Value::Numbers(numbers))
            }
            Token::Text(_) => {
                let mut texts = Vec::new();
                while let Token::Text(text) = self.lexer.peek() {
                    self.lexer.next();
                    texts.push(text);
                }
                Some(Value::Strings(texts))
            }
            Token::Word(_) => self.word_value(),
            Token::Sign(_) | Token::End => None,
        };
        // A field marked as ignored, and the output that it is connected with.
        self.lexer.take(b'~');
        if self.lexer.take(b'=') {
            self.skip_output();
        }
        value
    }

    /// The output of an engine: `USE name.output`, `Engine { … } . output`.
    fn skip_output(&mut self) {
        let Token::Word(word) = self.lexer.next() else { return };
        self.node_or_word(word);
        while let Token::Word(word) = self.lexer.peek()
            && word.starts_with('.')
        {
            self.lexer.next();
            if word == "." {
                self.lexer.next();
            }
        }
    }

    fn word_value(&mut self) -> Option<Value> {
        let Token::Word(word) = self.lexer.next() else { return None };
        match word {
            "NULL" => Some(Value::Nodes(Vec::new())),
            "IS" => self.name().map(Value::Is),
            _ => Some(match self.node_or_word(word) {
                Some(ix) => Value::Nodes(vec![ix]),
                None => Value::Words(vec![word.to_owned()]),
            }),
        }
    }

    /// The node that a word begins, if it begins one.
    fn node_or_word(&mut self, word: &str) -> Option<NodeIx> {
        let begins = matches!(word, "DEF" | "USE") || self.lexer.peek() == Token::Sign(b'{');
        if begins { self.node(word) } else { None }
    }

    /// What stands between brackets.
    fn list(&mut self, end: u8) -> Value {
        let (mut numbers, mut texts, mut words, mut nodes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        loop {
            match self.lexer.next() {
                Token::Number(x) => numbers.push(x),
                Token::Text(text) => texts.push(text),
                Token::Word("NULL") => {}
                Token::Word("ROUTE") => self.skip_route(),
                Token::Word(word) => match self.node_or_word(word) {
                    Some(ix) => nodes.push(ix),
                    None => words.push(word.to_owned()),
                },
                Token::Sign(sign) if sign == end => break,
                Token::End => break,
                // A list without its closing bracket.
                Token::Sign(b'}') => {
                    self.lexer.give_back();
                    break;
                }
                Token::Sign(_) => {}
            }
        }
        if !numbers.is_empty() {
            Value::Numbers(numbers)
        } else if !nodes.is_empty() {
            Value::Nodes(nodes)
        } else if !texts.is_empty() {
            Value::Strings(texts)
        } else {
            Value::Words(words)
        }
    }

    /// PROTO name [ interface ] { body }, or EXTERNPROTO name [ interface ] [ urls ].
    fn prototype(&mut self, external: bool) {
        let Some(name) = self.name() else { return };
        let mut prototype = Prototype { external, ..Prototype::default() };
        if self.lexer.take(b'[') {
            self.interface(&mut prototype, external);
        }
        if external {
            self.value();
        } else if self.lexer.take(b'{') {
            self.depth += 1;
            while !self.lexer.take(b'}') && self.lexer.peek() != Token::End {
                if self.depth >= MAX_DEPTH {
                    self.skip_braces();
                    break;
                }
                let mut found = Vec::new();
                self.statement(&mut found);
                prototype.body.extend(found);
            }
            self.depth -= 1;
        }
        self.graph.prototypes.insert(name, prototype);
    }

    fn interface(&mut self, prototype: &mut Prototype, external: bool) {
        loop {
            let access = match self.lexer.next() {
                Token::Word(access) => access,
                Token::Sign(b']') | Token::End => return,
                _ => continue,
            };
            let (_type, name) = (self.lexer.next(), self.name());
            let has_value = matches!(access, "field" | "exposedField" | "inputOutput" | "initializeOnly");
            if has_value
                && !external
                && let (Some(name), Some(value)) = (name, self.value())
            {
                prototype.defaults.push((name, value));
            }
        }
    }

    /// Skips to the brace that closes the one just opened.
    fn skip_braces(&mut self) {
        let mut open = 1u32;
        while open > 0 {
            match self.lexer.next() {
                Token::Sign(b'{') => open += 1,
                Token::Sign(b'}') => open -= 1,
                Token::End => return,
                _ => {}
            }
        }
    }
}

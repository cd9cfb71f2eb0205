//! Instances of prototypes become what their prototype consists of.

use super::graph::{Graph, NodeIx, Value};
use chordal_brep::ReadIssue;
use rustc_hash::FxHashMap;

/// What may be copied for each node of the file, and for any file: prototypes of prototypes fan out for ever.
const BUDGET_PER_NODE: usize = 50;
const BUDGET: usize = 1_000_000;

/// Replaces every instance by a copy of the first node of its prototype's body, which defines the kind of the
/// instance.
pub(crate) fn expand(graph: &mut Graph) {
    if graph.prototypes.values().all(|p| p.external) {
        return;
    }
    let mut budget = BUDGET + BUDGET_PER_NODE * graph.nodes.len();
    let mut ix = 0;
    while ix < graph.nodes.len() {
        let node = &graph.nodes[ix];
        let (kind, source) = (node.kind.clone(), node.source());
        let body = graph.prototypes.get(&kind).filter(|p| !p.external).map(|p| p.body.clone());
        if let Some(body) = body {
            if body.iter().any(|&b| graph.node(b).kind == "Script") {
                graph.notes.warn(source, ReadIssue::ProgramIgnored { what: "Script of a prototype" });
            }
            let copied = body.first().and_then(|&first| {
                let mut copy = Copy { graph, known: FxHashMap::default(), instance: ix as NodeIx, budget };
                let copied = copy.node(first, 0);
                budget = copy.budget;
                copied
            });
            match copied {
                Some(copied) => {
                    let copied = std::mem::take(&mut graph.nodes[copied as usize]);
                    let target = &mut graph.nodes[ix];
                    (target.kind, target.fields, target.children) =
                        (copied.kind, copied.fields, copied.children);
                    if target.kind == kind {
                        target.kind.clear();
                        graph.notes.lose(source, ReadIssue::UsedInItself { node: kind.to_string() });
                    } else if graph.prototypes.contains_key(&graph.nodes[ix].kind) {
                        continue;
                    }
                }
                None => graph.notes.lose(
                    source,
                    ReadIssue::InNode {
                        node: kind.to_string(),
                        cause: ReadIssue::Missing { what: "usable body of the prototype" }.boxed(),
                    },
                ),
            }
        }
        ix += 1;
    }
}

/// Deeper nodes than this are not copied.
const MAX_DEPTH: u32 = 400;

struct Copy<'a> {
    graph: &'a mut Graph,
    /// Copies by what they are of.
    known: FxHashMap<NodeIx, NodeIx>,
    instance: NodeIx,
    budget: usize,
}

impl Copy<'_> {
    fn node(&mut self, ix: NodeIx, depth: u32) -> Option<NodeIx> {
        if let Some(&known) = self.known.get(&ix) {
            return Some(known);
        }
        let size = 1 + self.graph.node(ix).fields.iter().map(|(_, v)| v.size()).sum::<usize>();
        if depth > MAX_DEPTH || size > self.budget {
            return None;
        }
        self.budget -= size;
        let mut copy = self.graph.node(ix).clone();
        let new = self.graph.add(Default::default());
        self.known.insert(ix, new);
        copy.children = copy.children.iter().filter_map(|&child| self.node(child, depth + 1)).collect();
        let fields = std::mem::take(&mut copy.fields);
        for (name, value) in fields {
            let value = match value {
                Value::Nodes(nodes) => {
                    Some(Value::Nodes(nodes.iter().filter_map(|&n| self.node(n, depth + 1)).collect()))
                }
                Value::Is(field) => self.instance_value(&field),
                value => Some(value),
            };
            if let Some(value) = value {
                copy.fields.push((name, value));
            }
        }
        self.graph.nodes[new as usize] = copy;
        Some(new)
    }

    /// The value of a field of the instance, or the default of its prototype.
    fn instance_value(&mut self, field: &str) -> Option<Value> {
        let instance = self.graph.node(self.instance);
        let value = instance.field(field).cloned().or_else(|| {
            let prototype = self.graph.prototypes.get(&instance.kind)?;
            prototype.defaults.iter().find(|(name, _)| name == field).map(|(_, value)| value.clone())
        })?;
        let size = value.size();
        if size > self.budget {
            return None;
        }
        self.budget -= size;
        Some(value)
    }
}

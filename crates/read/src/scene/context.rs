//! What every reader of nodes needs while a scene graph is walked.

use crate::scene::graph::{Graph, Node};
use crate::scene::stage::Stage;
use chordal_brep::ReadIssue;
use rustc_hash::FxHashSet;

/// The graph that is walked, and where its shapes go.
pub(crate) struct Context<'a> {
    pub graph: &'a Graph,
    pub stage: &'a mut Stage,
    /// Kinds of nodes that have a note already.
    noted: FxHashSet<String>,
}

impl<'a> Context<'a> {
    /// A context without notes.
    pub(crate) fn new(graph: &'a Graph, stage: &'a mut Stage) -> Self {
        Self { graph, stage, noted: FxHashSet::default() }
    }

    /// Adds a note, once for each kind of node.
    pub(crate) fn note(&mut self, node: &Node, what: ReadIssue) {
        if self.noted.insert(node.kind.clone()) {
            let cause = what.boxed();
            self.stage.notes.warn(node.source(), ReadIssue::InNode { node: node.kind.clone(), cause });
        }
    }
}

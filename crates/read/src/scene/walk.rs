//! The walk through a scene graph: every node once for each of its uses. A node that is used more than once,
//! and whose uses differ in their place only, becomes a part that is placed several times.

use super::context::Context;
use super::graph::{Graph, NodeIx};
use super::stage::{self, Placed, Stage};
use chordal_brep::ReadIssue;
use chordal_nurbs::DAffine3;
use rustc_hash::FxHashMap;

/// Uses within uses deeper than this refer in a circle.
const MAX_DEPTH: u32 = 600;

/// What a scene format does with the nodes of a graph.
pub(crate) trait Language: Sized {
    /// What a node inherits besides its place. Two uses of a node under equal ones are the same part.
    type Shared: Clone + PartialEq;

    /// Reads a node: hands its shapes to the stage, changes the state, or walks on to its children. `name` is
    /// that of the nearest named node above.
    fn visit(walk: &mut Walk<'_, Self>, ix: NodeIx, state: &mut State<Self::Shared>, name: &str);

    /// Whether nodes of this kind change nothing for their neighbours, so that they may become a part.
    fn may_be_part(kind: &str) -> bool;

    /// The name of a node as the model keeps it.
    fn readable(name: &str) -> &str {
        name
    }
}

/// What a node inherits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct State<S> {
    pub transform: DAffine3,
    pub shared: S,
}

/// What nodes that are used more than once consist of, by what they inherited.
type Parts<S> = FxHashMap<NodeIx, Vec<(S, Vec<Placed>)>>;

/// A walk in progress.
pub(crate) struct Walk<'a, L: Language> {
    pub context: Context<'a>,
    uses: Vec<u32>,
    parts: Parts<L::Shared>,
    /// Nodes being visited: one that is used inside itself would never end.
    active: Vec<bool>,
    depth: u32,
}

impl<'a, L: Language> Walk<'a, L> {
    /// Fills the stage with the shapes of a graph.
    pub fn run(graph: &'a Graph, stage: &'a mut Stage, shared: L::Shared) {
        let mut walk = Self {
            context: Context::new(graph, stage),
            uses: stage::uses(graph),
            parts: FxHashMap::default(),
            active: vec![false; graph.nodes.len()],
            depth: 0,
        };
        let mut state = State { transform: DAffine3::IDENTITY, shared };
        for &root in &graph.roots {
            walk.node(root, &mut state, "");
        }
    }

    /// Visits a node.
    pub fn node(&mut self, ix: NodeIx, state: &mut State<L::Shared>, name: &str) {
        let graph = self.context.graph;
        let node = graph.node(ix);
        if self.depth >= MAX_DEPTH || !self.context.stage.afford(0, node.source()) {
            return;
        }
        if std::mem::replace(&mut self.active[ix as usize], true) {
            let issue = ReadIssue::UsedInItself { node: node.kind.clone() };
            return self.context.stage.notes.lose(node.source(), issue);
        }
        self.depth += 1;
        let name = if node.name.is_empty() { name } else { L::readable(&node.name) };
        if self.uses[ix as usize] > 1 && L::may_be_part(&node.kind) {
            self.place_part(ix, state, name);
        } else {
            L::visit(self, ix, state, name);
        }
        self.depth -= 1;
        self.active[ix as usize] = false;
    }

    /// Places the part that a node is; makes it at the first use.
    fn place_part(&mut self, ix: NodeIx, state: &State<L::Shared>, name: &str) {
        let source = self.context.graph.node(ix).source();
        let known =
            self.parts.get(&ix).and_then(|all| all.iter().find(|(shared, _)| *shared == state.shared));
        let placed = match known {
            Some((_, placed)) => placed.clone(),
            None => {
                self.context.stage.open_part(name, source);
                let mut inner = State { transform: DAffine3::IDENTITY, shared: state.shared.clone() };
                L::visit(self, ix, &mut inner, name);
                let placed = self.context.stage.close_part();
                self.parts.entry(ix).or_default().push((state.shared.clone(), placed.clone()));
                placed
            }
        };
        self.context.stage.place(&placed, &state.transform, source);
    }
}

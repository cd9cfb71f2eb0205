//! Makes a model from a document: the tree, and the parts that it places.

use crate::load_geometry::{Sound, p3};
use crate::load_issue::{issue, source};
use crate::load_part::part;
use crate::schema::{Document, Node};
use crate::{DocumentError, real::Real};
use chordal_brep as brep;
use chordal_nurbs::{DAffine3, DVec3};

/// The deepest tree that is read. Trees are walked by recursion, so a deeper one could exhaust the stack;
/// real assemblies are far less deep.
const MAX_DEPTH: usize = 1000;

pub(crate) fn model(document: Document) -> Result<brep::Model, DocumentError> {
    let mut issues: Vec<_> = document.warnings.into_iter().map(issue).collect();
    let parts: Vec<_> = document.parts.into_iter().map(|p| part(p, &mut issues)).collect();
    let bad = |node: usize, why: &'static str| DocumentError::Tree { node, why };
    let mut nodes = Vec::with_capacity(document.nodes.len());
    for (i, written) in document.nodes.into_iter().enumerate() {
        if written.part.is_some_and(|p| p as usize >= parts.len()) {
            return Err(bad(i, "places a part that is not there"));
        }
        nodes.push(node(written).map_err(|_| bad(i, "has a transform that is not finite"))?);
    }
    let roots: Vec<_> = document.roots.into_iter().map(brep::NodeId).collect();
    check_tree(&nodes, &roots)?;
    Ok(brep::Model {
        name: document.name,
        schema: document.format,
        unit: document.unit,
        parts,
        nodes,
        roots,
        issues,
    })
}

/// Checks that every node is reached at most once, so that a walk ends.
fn check_tree(nodes: &[brep::Node], roots: &[brep::NodeId]) -> Result<(), DocumentError> {
    let mut reached = vec![false; nodes.len()];
    let mut stack: Vec<_> = roots.iter().map(|&root| (root, 0)).collect();
    while let Some((id, depth)) = stack.pop() {
        let bad = |why| Err(DocumentError::Tree { node: id.index(), why });
        match reached.get_mut(id.index()) {
            None => return bad("is not there"),
            Some(true) => return bad("is used twice"),
            Some(_) if depth >= MAX_DEPTH => return bad("is nested too deeply"),
            Some(once) => *once = true,
        }
        stack.extend(nodes[id.index()].children.iter().map(|&child| (child, depth + 1)));
    }
    Ok(())
}

fn node(node: Node) -> Sound<brep::Node> {
    let [x, y, z, translation]: [DVec3; 4] = {
        let axis = |p: [Real; 3]| p3(p, "transform");
        let [a, b, c, d] = node.transform;
        [axis(a)?, axis(b)?, axis(c)?, axis(d)?]
    };
    Ok(brep::Node {
        name: node.name,
        transform: DAffine3::from_cols(x, y, z, translation),
        part: node.part.map(brep::PartId),
        children: node.children.into_iter().map(brep::NodeId).collect(),
        color: node.color.map(brep::Color),
        source: source(node.source),
    })
}

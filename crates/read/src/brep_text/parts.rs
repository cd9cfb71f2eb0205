//! Parts and where they are placed.
//!
//! What stands at one location becomes one part in its own coordinates, so that solids which share faces go
//! on sharing them; the same shapes at another location are the same part, placed again.

use super::builder::Builder;
use super::document::Document;
use super::locations::{Loc, NOWHERE};
use super::shapes::{Ix, Kind, Orientation, Sub};
use chordal_brep::{Node, NodeId, Part, PartId, ReadIssue, Source};
use chordal_nurbs::DAffine3;
use rustc_hash::FxHashMap;

/// The parts of a file and the tree that places them.
#[derive(Debug, Default)]
pub(crate) struct Placed {
    pub parts: Vec<Part>,
    pub nodes: Vec<Node>,
    pub roots: Vec<NodeId>,
}

/// A solid, shell or face that no shell uses, and whether it is turned over.
type Item = (Ix, bool);

/// The number of uses of shapes that are followed, in addition to one for each byte of the file.
const SPARE_USES: usize = 200_000;

/// Builds all parts.
pub(crate) fn build(doc: &mut Document, name: &str) -> Placed {
    let uses: usize = doc.shapes.iter().flatten().map(|shape| shape.subs.len()).sum();
    let mut budget = 16 * uses + SPARE_USES;
    let groups = groups(doc, &mut budget);
    let mut placed = Placed::default();
    let mut known: FxHashMap<Vec<Item>, Option<PartId>> = FxHashMap::default();
    let mut places: Vec<(PartId, DAffine3)> = Vec::new();
    let several = groups.len() > 1;
    for (loc, items) in groups {
        let part = match known.get(&items) {
            Some(&part) => part,
            None => {
                let number = placed.parts.len() + 1;
                let part_name = if several { format!("{name} {number}") } else { name.to_owned() };
                let built = part(doc, part_name, &items, &mut budget);
                let id = built.map(|built| {
                    placed.parts.push(built);
                    PartId::from(placed.parts.len() - 1)
                });
                known.insert(items, id);
                id
            }
        };
        places.extend(part.map(|part| (part, doc.locations.matrix(loc))));
    }
    place(&mut placed, name, &places);
    placed
}

/// One root: the part itself where there is one place, else a node over all places.
fn place(placed: &mut Placed, name: &str, places: &[(PartId, DAffine3)]) {
    let node = |name: String, transform, part| Node {
        name,
        transform,
        part,
        children: Vec::new(),
        color: None,
        source: Source::default(),
    };
    match places {
        [] => return,
        [(part, transform)] => placed.nodes.push(node(name.to_owned(), *transform, Some(*part))),
        _ => {
            let children = (1..=places.len()).map(NodeId::from).collect();
            placed.nodes.push(Node { children, ..node(name.to_owned(), DAffine3::IDENTITY, None) });
            for &(part, transform) in places {
                let name = placed.parts[part.index()].name.clone();
                placed.nodes.push(node(name, transform, Some(part)));
            }
        }
    }
    placed.roots.push(NodeId::from(0));
}

/// What is neither a compound nor within something else, by location; compounds are taken apart.
fn groups(doc: &mut Document, budget: &mut usize) -> Vec<(Loc, Vec<Item>)> {
    let mut groups: Vec<(Loc, Vec<Item>)> = Vec::new();
    let mut index: FxHashMap<Loc, usize> = FxHashMap::default();
    let mut stack: Vec<(Sub, Loc, bool)> = doc.roots.iter().rev().map(|&sub| (sub, NOWHERE, false)).collect();
    while let Some((sub, outer, turned)) = stack.pop() {
        let source = doc.source(sub.shape);
        if *budget == 0 {
            doc.notes.lose(source, ReadIssue::TooManyReferences);
            break;
        }
        *budget -= 1;
        let Some(inner) = doc.locations.of_file(sub.location) else {
            doc.notes.lose(source, ReadIssue::NotFound { what: "location", number: sub.location });
            continue;
        };
        let at = doc.locations.compose(outer, inner);
        let turned = turned != (sub.orientation == Orientation::Reversed);
        match &doc.shapes[sub.shape] {
            Ok(shape) if matches!(shape.kind, Kind::Compound | Kind::CompSolid) => {
                stack.extend(shape.subs.iter().rev().map(|&sub| (sub, at, turned)));
            }
            Ok(shape) => {
                // A wire or a point is only spoken of: it stands nowhere.
                let is_loose = matches!(shape.kind, Kind::Vertex { .. } | Kind::Edge(_) | Kind::Wire);
                let at = if is_loose { NOWHERE } else { at };
                let group = *index.entry(at).or_insert_with(|| {
                    groups.push((at, Vec::new()));
                    groups.len() - 1
                });
                groups[group].1.push((sub.shape, turned));
            }
            Err(why) => doc.notes.lose(source, why.clone()),
        }
    }
    groups
}

/// The part that some items make; `None` where they hold nothing.
fn part(doc: &mut Document, name: String, items: &[Item], budget: &mut usize) -> Option<Part> {
    let mut builder = Builder::new(doc, name, *budget);
    let mut faces = Vec::new();
    for &(ix, turned) in items {
        faces.extend(builder.item(ix, turned));
    }
    builder.face_set(faces);
    *budget = builder.budget;
    let part = builder.build.finish();
    let holds = !(part.faces.is_empty() && part.loose.is_empty() && part.tessellated.is_empty());
    holds.then_some(part)
}

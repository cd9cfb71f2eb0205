//! An assembly tree as text, with lines as `tree` draws them.

use chordal::{Info, NodeInfo};
use std::fmt::Write;

/// Draws the tree in at most `limit` lines, and counts the nodes that are omitted.
pub fn draw(info: &Info, limit: usize) -> String {
    let mut lines = Vec::new();
    for root in &info.tree {
        lines.push(label(info, root, 1));
        children(info, root, "", &mut lines);
    }
    let mut out = String::new();
    for line in lines.iter().take(limit) {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "  {line}");
    }
    if lines.len() > limit {
        let _ = writeln!(out, "  … {} more lines (--full)", lines.len() - limit);
    }
    out
}

/// The children below a node. Siblings that look the same are drawn once, with their number.
fn children(info: &Info, node: &NodeInfo, indent: &str, lines: &mut Vec<String>) {
    let mut groups: Vec<(&NodeInfo, usize)> = Vec::new();
    for child in &node.children {
        match groups.iter_mut().find(|(first, _)| is_same(first, child)) {
            Some((_, number)) => *number += 1,
            None => groups.push((child, 1)),
        }
    }
    let last = groups.len().saturating_sub(1);
    for (i, (child, number)) in groups.into_iter().enumerate() {
        let (branch, below) = if i == last { ("└─ ", "   ") } else { ("├─ ", "│  ") };
        lines.push(format!("{indent}{branch}{}", label(info, child, number)));
        children(info, child, &format!("{indent}{below}"), lines);
    }
}

/// The same name and part, and the same below.
fn is_same(a: &NodeInfo, b: &NodeInfo) -> bool {
    (&a.name, a.part) == (&b.name, b.part)
        && a.children.len() == b.children.len()
        && a.children.iter().zip(&b.children).all(|(a, b)| is_same(a, b))
}

/// `bolt × 12 (part `bolt M6`, 28 faces)`.
fn label(info: &Info, node: &NodeInfo, number: usize) -> String {
    let part = node.part.and_then(|p| info.parts.get(p));
    let name = match (node.name.is_empty(), part) {
        (false, _) => node.name.as_str(),
        (true, Some(part)) if !part.name.is_empty() => part.name.as_str(),
        (true, _) => "(no name)",
    };
    let times = if number > 1 { format!(" × {number}") } else { String::new() };
    let holds = part.map_or_else(String::new, |part| {
        let other = if part.name.is_empty() || part.name == name { "" } else { part.name.as_str() };
        let faces = chordal::brep::issue::words::count(part.faces, "face", "faces");
        if other.is_empty() { format!("  [{faces}]") } else { format!("  [{other}: {faces}]") }
    });
    format!("{name}{times}{holds}")
}

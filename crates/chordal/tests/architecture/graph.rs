//! A graph of names with an example of each arrow, and its cycles.

use std::collections::{BTreeMap, BTreeSet};

/// Arrows from name to name, each with one place in the sources where it is found.
#[derive(Debug, Default)]
pub struct Graph {
    arrows: BTreeMap<String, BTreeMap<String, String>>,
}

impl Graph {
    /// Adds an arrow; an arrow from a name to itself is none.
    pub fn add(&mut self, from: &str, to: &str, place: &str) {
        if from != to {
            let to_place = self.arrows.entry(from.to_owned()).or_default();
            to_place.entry(to.to_owned()).or_insert_with(|| place.to_owned());
        }
    }

    /// All names that can be reached from one, itself only where a cycle leads back.
    pub fn reachable(&self, from: &str) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        let mut open = vec![from];
        while let Some(name) = open.pop() {
            for next in self.arrows.get(name).into_iter().flat_map(BTreeMap::keys) {
                if found.insert(next.clone()) {
                    open.push(next);
                }
            }
        }
        found
    }

    /// The sets of names that reach each other, each sorted.
    pub fn components(&self) -> Vec<Vec<String>> {
        let reach: BTreeMap<&String, BTreeSet<String>> =
            self.arrows.keys().map(|name| (name, self.reachable(name))).collect();
        let mut done: BTreeSet<&String> = BTreeSet::new();
        let mut components = Vec::new();
        for (&name, reached) in &reach {
            if !reached.contains(name) || done.contains(name) {
                continue;
            }
            let both = |other: &&String| reach[name].contains(*other) && reach[*other].contains(name);
            let component: Vec<&String> = reach.keys().copied().filter(both).collect();
            done.extend(&component);
            components.push(component.into_iter().cloned().collect());
        }
        components
    }

    /// One paragraph for each cycle: its names, then its arrows.
    pub fn cycles(&self) -> Vec<String> {
        let paragraph = |names: &Vec<String>| {
            let mut text = format!("  {} modules in a circle: {}", names.len(), names.join(" "));
            for from in names {
                for (to, place) in self.arrows[from].iter().filter(|(to, _)| names.contains(to)) {
                    text += &format!("\n    {from} → {to} ({place})");
                }
            }
            text
        };
        self.components().iter().map(paragraph).collect()
    }
}

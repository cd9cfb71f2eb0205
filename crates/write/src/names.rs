//! Names for formats in which a name ends at a blank or a line's end, and must be unique.

use chordal_mesh::{Scene, SceneNode};
use rustc_hash::FxHashMap;

/// The name of a placed part: the part's, else its node's, else its number.
pub(crate) fn placed_name(scene: &Scene, node: &SceneNode, part: usize) -> String {
    let part_name = scene.parts[part].name.trim();
    if !part_name.is_empty() {
        return part_name.to_owned();
    }
    let node_name = node.name.trim();
    if node_name.is_empty() { format!("part_{part}") } else { node_name.to_owned() }
}

/// Gives the second and later uses of a name a number.
#[derive(Debug, Default)]
pub(crate) struct Unique {
    used: FxHashMap<String, u32>,
}

impl Unique {
    pub fn name(&mut self, wanted: &str) -> String {
        if !self.used.contains_key(wanted) {
            self.used.insert(wanted.to_owned(), 1);
            return wanted.to_owned();
        }
        loop {
            let count = self.used.get_mut(wanted).expect("inserted above");
            *count += 1;
            let name = format!("{wanted}_{count}");
            if !self.used.contains_key(&name) {
                self.used.insert(name.clone(), 1);
                return name;
            }
        }
    }
}

/// A name as one word: blanks and control characters become `_`.
pub(crate) fn one_word(name: &str) -> String {
    let word: String =
        name.chars().map(|c| if c.is_whitespace() || c.is_control() { '_' } else { c }).collect();
    if word.is_empty() { "_".to_owned() } else { word }
}

/// A name as one line: control characters and line ends become blanks.
pub(crate) fn one_line(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') { ' ' } else { c })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_unique_even_against_their_own_numbers() {
        let mut unique = Unique::default();
        let names: Vec<_> = ["bolt", "bolt_2", "bolt", "bolt"].iter().map(|n| unique.name(n)).collect();
        assert_eq!(names, ["bolt", "bolt_2", "bolt_3", "bolt_4"]);
    }

    #[test]
    fn names_lose_what_would_end_them() {
        assert_eq!(one_word("a b\nc"), "a_b_c");
        assert_eq!(one_word(""), "_");
        assert_eq!(one_line("endsolid\r\nfacet"), "endsolid  facet");
    }
}

//! The base materials: every colour in the order of its first use.

use crate::color::{self, ColorKey};
use crate::flat::groups;
use chordal_mesh::{Rgba, Scene};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};

/// The id of the one group of materials.
pub(super) const ID: u32 = 1;

#[derive(Debug, Default)]
pub(super) struct Materials {
    index: BTreeMap<Option<ColorKey>, usize>,
    colors: Vec<Option<Rgba>>,
}

impl Materials {
    pub fn new(scene: &Scene) -> Self {
        let mut materials = Self::default();
        let mut seen = BTreeSet::new();
        for placed in scene.placements() {
            if !seen.insert((placed.part, placed.color.map(color::key))) {
                continue;
            }
            let patches = groups(&scene.parts[placed.part], placed.color).into_iter().flatten();
            let colors: Vec<_> = patches.filter(|p| !p.triangles.is_empty()).map(|p| p.color).collect();
            // A part without any colour needs no material; one with some needs one for the rest, too.
            if colors.iter().any(Option::is_some) {
                colors.into_iter().for_each(|c| materials.add(c));
            }
        }
        materials
    }

    fn add(&mut self, color: Option<Rgba>) {
        let next = self.colors.len();
        if *self.index.entry(color.map(color::key)).or_insert(next) == next {
            self.colors.push(color);
        }
    }

    /// The index of a colour that a part of the scene has.
    pub fn index(&self, color: Option<Rgba>) -> usize {
        self.index.get(&color.map(color::key)).copied().expect("every colour of the scene was added")
    }

    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        if self.colors.is_empty() {
            return Ok(());
        }
        writeln!(out, "<basematerials id=\"{ID}\">")?;
        for &color in &self.colors {
            let [r, g, b, a] = color::srgb_bytes(color.unwrap_or(color::UNCOLORED));
            let name = color.map_or_else(|| "uncoloured".to_owned(), |c| format!("color_{}", color::hex(c)));
            writeln!(out, "<base name=\"{name}\" displaycolor=\"#{r:02X}{g:02X}{b:02X}{a:02X}\"/>")?;
        }
        writeln!(out, "</basematerials>")
    }
}

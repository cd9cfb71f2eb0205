//! The border of a whole surface as loops.

use super::chain::Chain;
use super::{Piece, Role};
use chordal_brep::Source;
use chordal_nurbs::{BoxSide, NaturalBorder, Surface};

/// The loops of a surface that ends at its domain.
pub(super) fn loops(surface: &Surface) -> Vec<Chain> {
    let piece = |side: &BoxSide| Piece::line(side.from, side.to);
    let chain = |pieces: Vec<Piece>, winds: bool| Chain {
        pieces,
        role: Role::Outer,
        source: Source::default(),
        winds,
        touches: false,
    };
    match surface.natural_border() {
        NaturalBorder::None => Vec::new(),
        NaturalBorder::Loop(sides) => vec![chain(sides.iter().map(piece).collect(), false)],
        NaturalBorder::Rings(sides) => sides.iter().map(|side| chain(vec![piece(side)], true)).collect(),
    }
}

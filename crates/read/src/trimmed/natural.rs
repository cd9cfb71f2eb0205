//! The border of a whole surface as loops.

use super::chain::Chain;
use super::{Piece, Role};
use chordal_brep::Source;
use chordal_nurbs::{DVec2, Surface, UvBox};

/// The loops of a surface that ends at its domain: four sides; where one direction closes, two loops round it, less
/// those that are poles; none where the surface is closed, or unbounded.
pub(super) fn loops(surface: &Surface) -> Vec<Chain> {
    let domain = surface.domain();
    if !domain.is_finite() {
        return Vec::new();
    }
    let UvBox { min, max } = domain;
    let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
    let side = |k: usize| Piece::line(corners[k], corners[(k + 1) % 4]);
    let chain = |pieces: Vec<Piece>, winds: bool| Chain {
        pieces,
        role: Role::Outer,
        source: Source::default(),
        winds,
        touches: false,
    };
    let poles = surface.poles();
    let is_pole = |k: usize| {
        let axis = 1 - k % 2;
        poles.iter().any(|pole| pole.axis == axis && pole.value == corners[k][axis])
    };
    // Sides 0 and 2 run along u, 1 and 3 along v.
    let round = |sides: [usize; 2]| {
        sides.into_iter().filter(|&k| !is_pole(k)).map(|k| chain(vec![side(k)], true)).collect()
    };
    match surface.periods() {
        [None, None] => vec![chain((0..4).map(side).collect(), false)],
        [Some(_), None] => round([0, 2]),
        [None, Some(_)] => round([1, 3]),
        [Some(_), Some(_)] => Vec::new(),
    }
}

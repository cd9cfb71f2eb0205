//! Which loops are outer ones, which are holes, and which holes belong to which outer loop.

use super::chain::Chain;
use super::clip::{self, Outline};
use super::natural;
use super::polygon::{area, contains};
use super::untangle::{Untangled, untangled};
use super::{Role, Scale};
use crate::Winding;
use chordal_brep::{Percent, ReadIssue};
use chordal_nurbs::{DVec2, Surface};

/// Loops that follow the surface's border within this share of the domain are the border.
const ON_BORDER: f64 = 1e-6;

/// Loops that enclose less than this share of the domain run to and fro on one line: they cut nothing off.
const NO_AREA: f64 = 1e-14;

/// Loops may leave the domain by this share of it: beyond, the surface is taken at its border.
const BEYOND: f64 = 1e-3;

/// The faces that chains bound.
pub(super) struct Groups {
    /// The loops of each face: outer ones counter-clockwise, holes clockwise.
    pub faces: Vec<Vec<Chain>>,
    /// Places where loops crossed or touched, where they were built anew for it.
    pub untangled: Option<usize>,
}

/// Tells outer loops and holes apart, and puts them together to faces.
///
/// # Errors
/// Where the loops bound no region of the surface.
pub(super) fn groups(surface: &Surface, chains: Vec<Chain>, scale: &Scale) -> Result<Groups, ReadIssue> {
    let mut chains = chains;
    // By the even convention what no loop goes around belongs to the face.
    let whole = chains.iter().any(is_even) && !by_the_odd_one(&mut chains, scale);
    let given = chains.clone();
    let Untangled { chains, whole: unbounded, rebuilt } = untangled(chains, scale);
    let whole = whole || unbounded;
    if chains.is_empty() && !whole {
        // Loops that run back along themselves: the face has no area, and the mesher gets it unchanged.
        let no_area = |c: &Chain| c.role != Role::Hole && area(&c.polygon(scale)).abs() <= NO_AREA;
        let flat: Vec<Chain> = given.into_iter().filter(no_area).collect();
        if flat.is_empty() {
            return Err(ReadIssue::NothingTrimmed);
        }
        return Ok(Groups { faces: vec![flat], untangled: None });
    }
    let faces = nested(surface, chains, whole, scale)?;
    Ok(Groups { faces, untangled: rebuilt })
}

/// Faces of loops that do not cross.
fn nested(
    surface: &Surface,
    chains: Vec<Chain>,
    whole: bool,
    scale: &Scale,
) -> Result<Vec<Vec<Chain>>, ReadIssue> {
    let (winding, plain): (Vec<Chain>, Vec<Chain>) = chains.into_iter().partition(|chain| chain.winds);
    let plain = clip::to_domain(told_apart(plain, scale), scale)?;
    let mut nested = Vec::with_capacity(plain.len());
    for (i, chain) in plain.into_iter().enumerate() {
        let polygon = chain.polygon(scale);
        let covers = covers_domain(&polygon, scale);
        if !covers {
            let beyond = beyond(&polygon, scale);
            if beyond > BEYOND {
                return Err(ReadIssue::TrimLoopBeyond { trim: i + 1, by: Percent::of(beyond) });
            }
        }
        nested.push(Nested { area: area(&polygon), polygon, chain, covers });
    }
    let flat: Vec<Chain> = nested.extract_if(.., |n| n.area.abs() <= NO_AREA).map(|n| n.chain).collect();
    let roles = roles(&nested);
    let mut outers: Vec<Group> = Vec::new();
    if !winding.is_empty() {
        outers.push(Group { polygon: None, area: f64::INFINITY, chains: winding });
    }
    let mut holes = Vec::new();
    for (mut n, outer) in nested.into_iter().zip(roles) {
        if (n.area > 0.0) != outer {
            n.chain.reverse();
        }
        if outer {
            let chains = if n.covers { natural::loops(surface) } else { vec![n.chain] };
            outers.push(Group { polygon: Some(n.polygon), area: n.area.abs(), chains });
        } else {
            holes.push(n);
        }
    }
    if outers.is_empty() && !whole && flat.iter().any(|chain| chain.role != Role::Hole) {
        // Outer loops that run to and fro bound a face without area, not the whole surface.
        return Ok(vec![flat]);
    }
    if whole || outers.is_empty() {
        // Holes alone are cut into the whole surface.
        outers.push(Group { polygon: None, area: f64::INFINITY, chains: natural::loops(surface) });
    }
    for hole in holes {
        let around = |group: &&mut Group| group.polygon.as_ref().is_none_or(|p| inside(&hole.polygon, p));
        let owner = outers.iter_mut().filter(around).min_by(|a, b| a.area.total_cmp(&b.area));
        // A hole outside of everything cuts nothing off.
        if let Some(owner) = owner {
            owner.chains.push(hole.chain);
        }
    }
    Ok(outers.into_iter().map(|group| group.chains).collect())
}

fn is_even(chain: &Chain) -> bool {
    chain.role == Role::ByNesting(Winding::Even)
}

/// Where the surface's own border is among the loops of the even convention, all others go by the odd one
/// without it.
fn by_the_odd_one(chains: &mut Vec<Chain>, scale: &Scale) -> bool {
    let is_border = |c: &Chain| is_even(c) && !c.winds && covers_domain(&c.polygon(scale), scale);
    let Some(border) = chains.iter().position(is_border) else { return false };
    chains.remove(border);
    chains.iter_mut().filter(|c| is_even(c)).for_each(|c| c.role = Role::ByNesting(Winding::Odd));
    true
}

/// Outer loops and holes, before they are cut off at the border of the domain.
fn told_apart(chains: Vec<Chain>, scale: &Scale) -> Vec<Outline> {
    let polygons: Vec<Vec<DVec2>> = chains.iter().map(|chain| chain.polygon(scale)).collect();
    let nested: Vec<Nested> = chains
        .into_iter()
        .zip(polygons)
        .map(|(chain, polygon)| Nested { area: area(&polygon), polygon, chain, covers: false })
        .collect();
    let roles = roles(&nested);
    let outline = |(n, outer): (Nested, bool)| Outline { chain: n.chain, polygon: n.polygon, outer };
    nested.into_iter().zip(roles).map(outline).collect()
}

/// A plain loop with its shape in the unit square.
struct Nested {
    polygon: Vec<DVec2>,
    area: f64,
    chain: Chain,
    covers: bool,
}

/// An outer loop with its holes.
struct Group {
    /// `None`: all of the surface.
    polygon: Option<Vec<DVec2>>,
    area: f64,
    chains: Vec<Chain>,
}

/// True for outer loops.
fn roles(nested: &[Nested]) -> Vec<bool> {
    let depth = |i: usize| {
        let around = |j: usize| {
            j != i
                && nested[j].area.abs() > nested[i].area.abs()
                && inside(&nested[i].polygon, &nested[j].polygon)
        };
        (0..nested.len()).filter(|&j| around(j)).count()
    };
    nested
        .iter()
        .enumerate()
        .map(|(i, n)| match n.chain.role {
            Role::Outer => true,
            Role::Hole => false,
            Role::ByNesting(Winding::Odd) => depth(i) % 2 == 0,
            Role::ByNesting(Winding::Even) => depth(i) % 2 == 1,
        })
        .collect()
}

/// True where most of the points lie inside the polygon.
fn inside(points: &[DVec2], polygon: &[DVec2]) -> bool {
    // A few points suffice, since loops do not cross.
    let step = points.len().div_ceil(32);
    let seen: Vec<bool> = points.iter().step_by(step).map(|&p| contains(polygon, p)).collect();
    2 * seen.iter().filter(|&&inside| inside).count() > seen.len()
}

/// True where a loop runs along the border of the domain, or outside of it all the way.
fn covers_domain(polygon: &[DVec2], scale: &Scale) -> bool {
    let finite =
        scale.uv.is_finite() && (0..2).all(|axis| scale.bounded[axis] || scale.periods[axis].is_some());
    let strictly_inside = |p: &DVec2| p.min_element() > ON_BORDER && p.max_element() < 1.0 - ON_BORDER;
    finite
        && !polygon.iter().any(strictly_inside)
        && contains(polygon, DVec2::splat(0.5))
        && area(polygon).abs() > 1.0 - 8.0 * ON_BORDER
}

/// How far a loop leaves the domain, as a share of it.
fn beyond(polygon: &[DVec2], scale: &Scale) -> f64 {
    let outside = |p: &DVec2| {
        (0..2)
            .filter(|&axis| scale.bounded[axis])
            .map(|axis| (-p[axis]).max(p[axis] - 1.0))
            .fold(0.0, f64::max)
    };
    polygon.iter().map(outside).fold(0.0, f64::max)
}

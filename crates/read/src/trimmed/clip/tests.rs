use crate::assemble::Notes;
use crate::trimmed::{Piece, Role, Scale, TrimLoop, chain, nest, polygon};
use chordal_brep::{ReadIssue, Source};
use chordal_nurbs::{Curve2, DVec2, DVec3, Frame2, NurbsSurface, Surface};
use proptest::prelude::*;

/// A flat patch over 1..3 × -1..1.
fn patch() -> Surface {
    let points = [(1., -1.), (1., 1.), (3., -1.), (3., 1.)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
    let knots = |a: f64, b: f64| vec![a, a, b, b];
    Surface::Nurbs(NurbsSurface::new([1, 1], knots(1.0, 3.0), knots(-1.0, 1.0), points, None).unwrap())
}

#[derive(Clone, Debug)]
struct Disc {
    center: DVec2,
    radius: f64,
}

impl Disc {
    fn trim(&self, role: Role, backwards: bool) -> TrimLoop {
        let frame = Frame2::new(self.center, DVec2::new(0.6, 0.8));
        let mut piece = Piece::whole(Curve2::Circle { frame, radius: self.radius });
        piece.forward = !backwards;
        TrimLoop { pieces: vec![piece], role, source: Source::default() }
    }
}

/// The area that the loops enclose, holes subtracted, in parameters.
fn enclosed(trims: &[TrimLoop]) -> Result<f64, ReadIssue> {
    let surface = patch();
    let scale = Scale::new(&surface, trims);
    let notes = Notes::default();
    let chains = trims.iter().enumerate().filter_map(|(i, t)| chain::closed(t, i, &scale, &notes).unwrap());
    let groups = nest::groups(&surface, chains.collect(), &scale)?.faces;
    assert!(notes.first().is_none(), "{:?}", notes.take());
    let loops = groups.iter().flatten();
    for c in loops.clone() {
        for (i, piece) in c.pieces.iter().enumerate() {
            let next = &c.pieces[(i + 1) % c.pieces.len()];
            assert!(piece.at(1.0).distance(next.at(0.0)) < 1e-8, "a chain is open");
        }
    }
    let outline = |pieces: &[Piece]| -> Vec<DVec2> {
        pieces.iter().flat_map(|piece| (0..256).map(|k| piece.at(f64::from(k) / 256.0))).collect()
    };
    Ok(loops.map(|c| polygon::area(&outline(&c.pieces))).sum())
}

/// The same by counting points.
fn counted(inside: impl Fn(DVec2) -> bool) -> f64 {
    const STEPS: i32 = 400;
    let at = |k: i32| (f64::from(k) + 0.5) / f64::from(STEPS) * 2.0;
    let all = (0..STEPS * STEPS).map(|k| DVec2::new(1.0 + at(k / STEPS), -1.0 + at(k % STEPS)));
    all.filter(|&p| inside(p)).count() as f64 * 4.0 / f64::from(STEPS * STEPS)
}

/// Discs that may leave the patch and do not touch each other.
fn discs() -> impl Strategy<Value = Vec<Disc>> {
    let disc = (0.5..3.5f64, -1.5..1.5f64, 0.05..0.9f64)
        .prop_map(|(u, v, radius)| Disc { center: DVec2::new(u, v), radius });
    prop::collection::vec(disc, 1..6).prop_map(|all| {
        let mut apart: Vec<Disc> = Vec::new();
        for disc in all {
            if apart.iter().all(|d| d.center.distance(disc.center) > d.radius + disc.radius + 0.01) {
                apart.push(disc);
            }
        }
        apart
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn what_discs_cut_off(discs in discs(), backwards: bool) {
        let trims: Vec<_> = discs.iter().map(|d| d.trim(Role::Hole, backwards)).collect();
        let in_disc = |p: DVec2| discs.iter().any(|d| d.center.distance(p) < d.radius);
        let area = enclosed(&trims).unwrap();
        let expected = counted(|p| !in_disc(p));
        prop_assert!((area - expected).abs() < 0.005, "{area}, expected {expected}");
    }
    #[test]
    fn what_discs_keep(discs in discs(), backwards: bool) {
        let trims: Vec<_> = discs.iter().map(|d| d.trim(Role::Outer, backwards)).collect();
        let expected = counted(|p| discs.iter().any(|d| d.center.distance(p) < d.radius));
        match enclosed(&trims) {
            Ok(area) => prop_assert!((area - expected).abs() < 0.005, "{area}, expected {expected}"),
            Err(why) => prop_assert!(expected < 1e-3 && why == ReadIssue::TrimsBeyond, "{expected}: {why}"),
        }
    }
}

fn polygon(corners: &[[f64; 2]], role: Role) -> TrimLoop {
    let at = |k: usize| DVec2::from(corners[k % corners.len()]);
    let pieces = (0..corners.len()).map(|k| Piece::line(at(k), at(k + 1))).collect();
    TrimLoop { pieces, role, source: Source::default() }
}

#[test]
fn a_hole_with_sides_on_the_border_notches_it() {
    let notch = polygon(&[[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]], Role::Hole);
    assert!((enclosed(&[notch]).unwrap() - 3.0).abs() < 1e-12);
    let band = polygon(&[[1.0, -0.5], [3.0, -0.5], [3.0, 0.5], [1.0, 0.5]], Role::Hole);
    assert!((enclosed(&[band]).unwrap() - 2.0).abs() < 1e-12);
}

#[test]
fn corners_of_the_domain_are_passed() {
    // An L around three corners.
    let big = polygon(&[[2.0, 0.0], [9.0, 0.0], [9.0, 9.0], [2.0, 9.0]], Role::Hole);
    assert!((enclosed(std::slice::from_ref(&big)).unwrap() - 3.0).abs() < 1e-9);
    let kept = TrimLoop { role: Role::Outer, ..big };
    assert!((enclosed(&[kept]).unwrap() - 1.0).abs() < 1e-9);
}

#[test]
fn around_everything() {
    let around = [[0.0, -2.0], [4.0, -2.0], [4.0, 2.0], [0.0, 2.0]];
    assert!((enclosed(&[polygon(&around, Role::Outer)]).unwrap() - 4.0).abs() < 1e-12);
    let said = enclosed(&[polygon(&around, Role::Hole)]).unwrap_err();
    assert_eq!(said, ReadIssue::NothingTrimmed);
}

#[test]
fn holes_at_the_border_leave_outer_loops_inside_alone() {
    let hole = polygon(&[[2.5, 0.5], [3.5, 0.5], [3.5, 1.5], [2.5, 1.5]], Role::Hole);
    let outer = polygon(&[[1.2, -0.8], [2.2, -0.8], [2.2, 0.2], [1.2, 0.2]], Role::Outer);
    assert!((enclosed(&[hole, outer]).unwrap() - 1.0).abs() < 1e-12);
}

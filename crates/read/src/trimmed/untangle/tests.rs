use crate::Winding;
use crate::assemble::Notes;
use crate::trimmed::{Piece, Role, Scale, TrimLoop, chain, meet, nest, polygon};
use chordal_brep::{ReadIssue, Source};
use chordal_nurbs::{Curve2, DVec2, DVec3, Frame2, NurbsSurface, Surface, math};
use proptest::prelude::*;

/// A flat patch over the unit square.
fn patch() -> Surface {
    let points = [(0., 0.), (0., 1.), (1., 0.), (1., 1.)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
    let knots = || vec![0.0, 0.0, 1.0, 1.0];
    Surface::Nurbs(NurbsSurface::new([1, 1], knots(), knots(), points, None).unwrap())
}

fn polygon(corners: &[(f64, f64)], role: Role) -> TrimLoop {
    let at = |k: usize| DVec2::from(corners[k % corners.len()]);
    let pieces = (0..corners.len()).map(|k| Piece::line(at(k), at(k + 1))).collect();
    TrimLoop { pieces, role, source: Source::default() }
}

fn disc(center: (f64, f64), radius: f64, role: Role) -> TrimLoop {
    let frame = Frame2::new(DVec2::from(center), DVec2::new(0.6, 0.8));
    let piece = Piece::whole(Curve2::Circle { frame, radius });
    TrimLoop { pieces: vec![piece], role, source: Source::default() }
}

/// The area of the faces that trims cut out of the patch; no two loops cross.
fn area(trims: &[TrimLoop]) -> f64 {
    let surface = patch();
    let scale = Scale::new(&surface, trims);
    let notes = Notes::default();
    let chains = trims.iter().enumerate().filter_map(|(i, t)| chain::closed(t, i, &scale, &notes).unwrap());
    let faces = match nest::groups(&surface, chains.collect(), &scale) {
        Ok(groups) => groups.faces,
        Err(reason) => {
            assert_eq!(reason, ReadIssue::NothingTrimmed);
            return 0.0;
        }
    };
    let all: Vec<chain::Chain> = faces.into_iter().flatten().collect();
    let flats = meet::flattened(&all, &scale);
    assert_eq!(meet::meetings(&flats, &scale).crossings, 0);
    all.iter().map(|c| polygon::area(&c.polygon(&scale))).sum()
}

/// How many times a loop goes round a point, by the angles seen from there.
fn winding(trim: &TrimLoop, p: DVec2) -> i32 {
    let points: Vec<DVec2> =
        trim.pieces.iter().flat_map(|piece| (0..64).map(|k| piece.at(f64::from(k) / 64.0))).collect();
    let turn = |i: usize| {
        let (a, b) = (points[i] - p, points[(i + 1) % points.len()] - p);
        math::atan2(a.perp_dot(b), a.dot(b))
    };
    ((0..points.len()).map(turn).sum::<f64>() / std::f64::consts::TAU).round() as i32
}

/// The area by counting points.
fn counted(trims: &[TrimLoop], inside: impl Fn(&[bool]) -> bool) -> f64 {
    const STEPS: i32 = 80;
    let at = |k: i32| (f64::from(k) + 0.5) / f64::from(STEPS);
    let all = (0..STEPS * STEPS).map(|k| DVec2::new(at(k / STEPS), at(k % STEPS)));
    let odd = |p: DVec2| trims.iter().map(|t| winding(t, p) % 2 != 0).collect::<Vec<bool>>();
    all.filter(|&p| inside(&odd(p))).count() as f64 / f64::from(STEPS * STEPS)
}

const ODD: Role = Role::ByNesting(Winding::Odd);
const EVEN: Role = Role::ByNesting(Winding::Even);

const A: [(f64, f64); 4] = [(0.1, 0.1), (0.7, 0.1), (0.7, 0.9), (0.1, 0.9)];
const B: [(f64, f64); 4] = [(0.5, 0.3), (0.5, 0.6), (0.9, 0.6), (0.9, 0.3)];
const EIGHT: [(f64, f64); 4] = [(0.1, 0.1), (0.9, 0.9), (0.9, 0.1), (0.1, 0.9)];

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-7, "{a} for {b}");
}

#[test]
fn an_eight_keeps_both_lobes_by_every_convention() {
    near(area(&[polygon(&EIGHT, ODD)]), 0.32);
    near(area(&[polygon(&EIGHT, Role::Outer)]), 0.32);
    near(area(&[polygon(&EIGHT, EVEN)]), 0.68);
    near(area(&[polygon(&EIGHT, Role::Hole)]), 0.68);
    // With a vertex at the crossing already.
    let touching = [(0.1, 0.1), (0.5, 0.5), (0.9, 0.9), (0.9, 0.1), (0.5, 0.5), (0.1, 0.9)];
    near(area(&[polygon(&touching, ODD)]), 0.32);
}

#[test]
fn two_loops_that_cross() {
    // They run opposite ways: what lies on the right of one is cut off. If both run the same way, all that is
    // known is how many go round a place.
    near(area(&[polygon(&A, ODD), polygon(&B, ODD)]), 0.42);
    let back: Vec<(f64, f64)> = B.iter().rev().copied().collect();
    near(area(&[polygon(&A, ODD), polygon(&back, ODD)]), 0.48 + 0.12 - 2.0 * 0.06);
    near(area(&[polygon(&A, EVEN), polygon(&B, EVEN)]), 1.0 - 0.48);
    near(area(&[polygon(&A, Role::Outer), polygon(&B, Role::Hole)]), 0.42);
    near(area(&[polygon(&A, Role::Outer), polygon(&B, Role::Outer)]), 0.54);
    near(area(&[polygon(&A, Role::Hole), polygon(&B, Role::Hole)]), 0.46);
}

#[test]
fn loops_that_run_neither_way_are_no_holes() {
    let to_and_fro = [(0.1, 0.1), (0.1, 0.1), (0.1, 0.7)];
    near(area(&[polygon(&A, ODD), polygon(&to_and_fro, ODD)]), 0.48);
    // The lobes cancel out; the other loop crosses one of them and has no area.
    near(area(&[polygon(&EIGHT, ODD), polygon(&[(0.0, 0.2), (0.5, 0.2)], ODD)]), 0.32);
}

#[test]
fn an_outer_loop_within_a_hole_leaves_nothing() {
    near(
        area(&[
            polygon(&B, Role::Outer),
            polygon(&[(0.4, 0.2), (0.95, 0.2), (0.95, 0.7), (0.4, 0.7)], Role::Hole),
        ]),
        0.0,
    );
}

#[test]
fn a_hole_that_shares_a_side_or_a_corner_with_the_outer_loop() {
    let side = [(0.3, 0.1), (0.3, 0.4), (0.5, 0.4), (0.5, 0.1)];
    near(area(&[polygon(&A, Role::Outer), polygon(&side, Role::Hole)]), 0.48 - 0.06);
    let corner = [(0.7, 0.9), (0.4, 0.8), (0.5, 0.5)];
    let of_corner = 0.5 * (DVec2::new(-0.3, -0.1).perp_dot(DVec2::new(-0.2, -0.4))).abs();
    near(area(&[polygon(&A, Role::Outer), polygon(&corner, Role::Hole)]), 0.48 - of_corner);
}

#[test]
fn a_loop_to_and_fro_does_not_give_the_whole_surface() {
    let spike = [(0.1, 0.1), (0.9, 0.9)];
    near(area(&[polygon(&spike, ODD)]), 0.0);
    near(area(&[polygon(&spike, Role::Outer)]), 0.0);
    near(area(&[polygon(&spike, Role::Hole)]), 1.0);
}

#[test]
fn islands_stay_and_outer_loops_within_outer_loops_are_not_met_twice() {
    let square = |r: f64, role: Role| {
        let (a, b) = (0.5 - r, 0.5 + r);
        polygon(&[(a, a), (b, a), (b, b), (a, b)], role)
    };
    let island = [square(0.4, Role::Outer), square(0.3, Role::Hole), square(0.2, Role::Outer)];
    near(area(&island), 0.64 - 0.36 + 0.16);
    near(area(&[square(0.4, Role::Outer), square(0.2, Role::Outer)]), 0.64);
}

/// Whether it is a disc, corners or the center, radius, whether it is a hole.
type Shape = (bool, Vec<(f64, f64)>, f64, bool);

fn shapes() -> impl Strategy<Value = Vec<Shape>> {
    let corner = (0.02..0.98f64, 0.02..0.98f64);
    let shape =
        (prop::bool::weighted(0.3), prop::collection::vec(corner, 3..9), 0.05..0.4f64, prop::bool::ANY);
    prop::collection::vec(shape, 1..4)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn random_loops_bound_what_their_winding_numbers_say(shapes in shapes(), convention in 0..3u32,
        grid: bool) {
        let place = |v: f64| if grid { (v * 8.0).round().clamp(1.0, 7.0) / 8.0 } else { v };
        let trims: Vec<TrimLoop> = shapes
            .iter()
            .enumerate()
            .map(|(i, (round, corners, radius, hole))| {
                let role = match convention {
                    0 => ODD,
                    1 => EVEN,
                    _ if *hole && i > 0 => Role::Hole,
                    _ => Role::Outer,
                };
                let inside = |v: f64| v.clamp(radius + 0.01, 0.99 - radius);
                if *round {
                    disc((inside(corners[0].0), inside(corners[0].1)), *radius, role)
                } else {
                    let mut corners: Vec<_> = corners.iter().map(|&(x, y)| (place(x), place(y))).collect();
                    // All run the same way: else the direction counts where it is all that there is.
                    let points: Vec<DVec2> = corners.iter().map(|&c| DVec2::from(c)).collect();
                    if polygon::area(&points) < 0.0 {
                        corners.reverse();
                    }
                    polygon(&corners, role)
                }
            })
            .collect();
        let count = |odd: &[bool], role: Role| {
            trims.iter().zip(odd).filter(|(t, odd)| t.role == role && **odd).count()
        };
        let expected = counted(&trims, |odd| match convention {
            0 => count(odd, ODD) % 2 == 1,
            1 => count(odd, EVEN) % 2 == 0,
            _ => count(odd, Role::Outer) > count(odd, Role::Hole),
        });
        let found = area(&trims);
        prop_assert!((found - expected).abs() < 0.03, "{} for {}", found, expected);
    }
}

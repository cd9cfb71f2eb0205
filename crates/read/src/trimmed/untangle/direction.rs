//! Outer loops and holes by the way they run, for loops that cross.
//!
//! Open Inventor, X3D and OpenGL keep what lies on the left of a trimming curve: outer loops run one way,
//! holes the other. Loops that do not cross are classified by nesting, whatever their direction. Of loops
//! that cross, nesting is undefined; then the direction decides, if the loops that do not cross agree with
//! it.

use super::super::chain::Chain;
use super::super::polygon::{area, contains};
use super::super::{Role, Scale};
use super::bounds;
use crate::Winding;
use chordal_nurbs::DVec2;

/// A loop whose signed area is not more than this share of the area that all loops lie in runs neither way:
/// it goes to and fro, or its lobes cancel out.
const NO_DIRECTION: f64 = 1e-9;

/// The role of each chain: by its direction where the chains run both ways and their nesting does not
/// contradict, else as it is.
pub(super) fn roles(chains: &[Chain], scale: &Scale) -> Vec<Role> {
    let given: Vec<Role> = chains.iter().map(|c| c.role).collect();
    if given.iter().any(|role| *role != Role::ByNesting(Winding::Odd)) {
        return given;
    }
    let polygons: Vec<Vec<DVec2>> = chains.iter().map(|chain| chain.polygon(scale)).collect();
    let areas: Vec<f64> = polygons.iter().map(|polygon| area(polygon)).collect();
    if areas.iter().any(|a| a.abs() <= NO_DIRECTION * extent(&polygons)) {
        return given;
    }
    let largest = areas.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
    let is_outer: Vec<bool> = areas.iter().map(|a| a * largest > 0.0).collect();
    let is_contradicted = |i: usize| {
        let mut depth = 0;
        for j in (0..polygons.len()).filter(|&j| j != i) {
            if cross(&polygons[i], &polygons[j]) {
                // Its nesting is undefined.
                return false;
            }
            if polygons[i].iter().all(|&p| contains(&polygons[j], p)) {
                depth += if is_outer[j] { 1 } else { -1 };
            }
        }
        depth != i32::from(!is_outer[i])
    };
    if !is_outer.contains(&false) || (0..chains.len()).any(is_contradicted) {
        return given;
    }
    is_outer.into_iter().map(|outer| if outer { Role::Outer } else { Role::Hole }).collect()
}

/// The area of the box of all polygons.
fn extent(polygons: &[Vec<DVec2>]) -> f64 {
    let [low, high] = bounds(&polygons.concat());
    (high - low).element_product()
}

/// True where sides of two polygons cross.
fn cross(a: &[DVec2], b: &[DVec2]) -> bool {
    let sides = |polygon: &[DVec2]| -> Vec<[DVec2; 2]> {
        let n = polygon.len();
        (0..n).map(|k| [polygon[k], polygon[(k + 1) % n]]).collect()
    };
    let turn = |[p, q]: [DVec2; 2], r: DVec2| (q - p).perp_dot(r - p);
    let others = sides(b);
    let crosses = |s: [DVec2; 2]| {
        // A corner on the side counts to one half plane.
        let parts = |s: [DVec2; 2], t: [DVec2; 2]| (turn(s, t[0]) > 0.0) != (turn(s, t[1]) > 0.0);
        others.iter().any(|&t| parts(s, t) && parts(t, s))
    };
    sides(a).into_iter().any(crosses)
}

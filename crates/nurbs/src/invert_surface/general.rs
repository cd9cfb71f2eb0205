//! Free-form surfaces: samples on a grid, then a damped Newton descent.
//!
//! With r = S(u,v) − p the descent solves H δ = −g, g = (r·Su, r·Sv),
//! H = [Su·Su + r·Suu, Su·Sv + r·Suv; ·, Sv·Sv + r·Svv] + λ diag(Su·Su, Sv·Sv), leaving out the terms in r where H would
//! not be positive (Gauss–Newton), and keeps to the domain by dropping a direction that is against its border. λ
//! grows until the distance falls. Not guaranteed: that the grid sees a valley narrower than its cells.

use super::Inversion;
use crate::{Box3, Surface, SurfaceJet, UvBox};
use glam::{DVec2, DVec3};
use std::sync::OnceLock;

/// Samples along each side of the tiles that are looked into or passed over as a whole.
const TILE: usize = 8;
/// Fewest and most samples of a direction.
const SAMPLES: [usize; 2] = [9, 193];
/// Valleys that are followed down.
const VALLEYS: usize = 4;

/// Points of a surface on a grid.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    us: Vec<f64>,
    vs: Vec<f64>,
    /// u runs slowest.
    points: Vec<DVec3>,
    tiles: Vec<Tile>,
    /// The length of a typical cell's diagonal.
    cell: f64,
}

#[derive(Clone, Debug)]
struct Tile {
    /// First and last row and column.
    rows: [usize; 2],
    columns: [usize; 2],
    bounds: Box3,
}

impl Grid {
    pub fn new(surface: &Surface, uv: UvBox) -> Self {
        let [breaks_u, breaks_v] = surface.all_breaks(uv);
        let degree = match surface {
            Surface::Nurbs(nurbs) => nurbs.degree(),
            _ => [4, 4],
        };
        let us = stations(uv.min.x, uv.max.x, &breaks_u, degree[0]);
        let vs = stations(uv.min.y, uv.max.y, &breaks_v, degree[1]);
        let points: Vec<DVec3> =
            us.iter().flat_map(|&u| vs.iter().map(move |&v| surface.point(DVec2::new(u, v)))).collect();
        let mut tiles = Vec::new();
        for i in (0..us.len()).step_by(TILE) {
            for j in (0..vs.len()).step_by(TILE) {
                let rows = [i, (i + TILE - 1).min(us.len() - 1)];
                let columns = [j, (j + TILE - 1).min(vs.len() - 1)];
                let inside = (rows[0]..=rows[1])
                    .flat_map(|i| (columns[0]..=columns[1]).map(move |j| (i, j)))
                    .map(|(i, j)| points[i * vs.len() + j]);
                tiles.push(Tile { rows, columns, bounds: Box3::from_points(inside) });
            }
        }
        let size = Box3::from_points(points.iter().copied()).diagonal();
        let cell = size / (us.len().min(vs.len()) as f64);
        Self { us, vs, points, tiles, cell }
    }

    /// The best samples of the most promising tiles, the best first.
    fn valleys(&self, p: DVec3) -> Vec<DVec2> {
        let mut order: Vec<(f64, usize)> = self
            .tiles
            .iter()
            .enumerate()
            .map(|(i, tile)| (p.distance(p.max(tile.bounds.min).min(tile.bounds.max)), i))
            .collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut found: Vec<(f64, DVec2)> = Vec::new();
        let mut best = f64::INFINITY;
        for (lower, index) in order {
            if lower > best + self.cell {
                break;
            }
            let (distance, uv) = self.best_of(&self.tiles[index], p);
            best = best.min(distance);
            found.push((distance, uv));
        }
        found.retain(|f| f.0 <= best + self.cell);
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.truncate(VALLEYS);
        found.into_iter().map(|f| f.1).collect()
    }

    fn best_of(&self, tile: &Tile, p: DVec3) -> (f64, DVec2) {
        let mut best = (f64::INFINITY, DVec2::ZERO);
        for i in tile.rows[0]..=tile.rows[1] {
            for j in tile.columns[0]..=tile.columns[1] {
                let distance = self.points[i * self.vs.len() + j].distance_squared(p);
                if distance < best.0 {
                    best = (distance, DVec2::new(self.us[i], self.vs[j]));
                }
            }
        }
        (best.0.sqrt(), best.1)
    }
}

/// Parameters to sample at: the same number to each span, within the limits in all.
fn stations(start: f64, end: f64, breaks: &[f64], degree: usize) -> Vec<f64> {
    let mut stops = vec![start];
    stops.extend_from_slice(breaks);
    stops.push(end);
    let spans = stops.len() - 1;
    if spans >= SAMPLES[1] {
        return (0..SAMPLES[1]).map(|i| start + (end - start) * i as f64 / (SAMPLES[1] - 1) as f64).collect();
    }
    let wanted = (degree + 1).max((SAMPLES[0] - 1).div_ceil(spans));
    let steps = wanted.min((SAMPLES[1] / spans).max(1));
    let mut found = vec![start];
    for pair in stops.windows(2) {
        found.extend((1..steps).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / steps as f64));
        found.push(pair[1]);
    }
    found
}

/// The closest point; a close one in the valley of `near` comes first.
pub(super) fn invert(
    surface: &Surface,
    periods: [Option<f64>; 2],
    uv: UvBox,
    grid: &OnceLock<Grid>,
    p: DVec3,
    near: Option<DVec2>,
) -> DVec2 {
    let domain = surface.domain();
    let local = near.map(|n| descend(surface, periods, domain, p, n));
    if let Some(found) = local {
        if is_close(surface, domain, found.uv, found.distance) {
            return found.uv;
        }
    }
    let grid = grid.get_or_init(|| Grid::new(surface, uv));
    let mut best = local.unwrap_or(Inversion { uv: uv.center(), distance: f64::INFINITY });
    for start in grid.valleys(p) {
        // On the surface, up to rounding: nothing is closer.
        if best.distance <= 1e-10 * grid.cell {
            break;
        }
        let found = descend(surface, periods, domain, p, start);
        // What `near` found stays unless another place is truly closer.
        if found.distance < best.distance * (1.0 - 1e-9) {
            best = found;
        }
    }
    best.uv
}

/// True where a distance is so small beside the surface that no other part of it is likely to be meant.
pub(super) fn is_close(surface: &Surface, domain: UvBox, uv: DVec2, distance: f64) -> bool {
    let (_, du, dv) = surface.jet1(uv);
    let size = domain.size();
    let extent = |d: DVec3, size: f64| if size.is_finite() { d.length() * size } else { f64::INFINITY };
    let least = extent(du, size.x).min(extent(dv, size.y));
    distance <= 1e-5 * if least.is_finite() { least } else { du.length().max(dv.length()) }
}

/// Goes down from `start` inside the domain; closed directions have no border.
pub(super) fn descend(
    surface: &Surface,
    periods: [Option<f64>; 2],
    domain: UvBox,
    p: DVec3,
    start: DVec2,
) -> Inversion {
    let mut open = domain;
    for axis in 0..2 {
        if periods[axis].is_some() {
            open.min[axis] = f64::NEG_INFINITY;
            open.max[axis] = f64::INFINITY;
        }
    }
    let mut uv = open.clamp(start);
    let mut jet = surface.jet(uv);
    let mut height = (jet.p - p).length_squared();
    let mut damping = 0.0;
    for _ in 0..60 {
        let Some((step, full)) = newton_step(&jet, p, damping, uv, open) else { break };
        let next = open.clamp(uv + step);
        if next == uv {
            break;
        }
        let next_jet = surface.jet(next);
        let next_height = (next_jet.p - p).length_squared();
        if next_height < height {
            (uv, jet, height) = (next, next_jet, next_height);
            // After an undamped step this short the next one is all rounding.
            let short = (step / domain.size()).abs().max_element() <= 1e-9;
            if full && damping == 0.0 && short {
                break;
            }
            damping = if damping < 1e-3 { 0.0 } else { damping * 0.1 };
            continue;
        }
        let moved = (jet.du * step.x).length() + (jet.dv * step.y).length();
        // Near the minimum only rounding is left to gain.
        if moved <= 1e-9 * height.sqrt() || moved <= 1e-15 * jet.p.length() || damping > 1e8 {
            break;
        }
        damping = if damping == 0.0 { 1e-2 } else { damping * 10.0 };
    }
    polished(surface, p, open, Inversion { uv, distance: height.sqrt() }, &jet)
}

/// One more Newton step where the point is off the surface: near the foot the distance itself hardly changes, so that
/// the descent ends with half of the digits.
//
// Never inlined: within `descend` the optimiser of rustc 1.95 (vectorisation of straight code, at level 3) returned a
// wrong v for a point exactly on the surface; the inversion tests show it in release builds.
#[inline(never)]
fn polished(surface: &Surface, p: DVec3, open: UvBox, found: Inversion, jet: &SurfaceJet) -> Inversion {
    let Some((step, true)) = newton_step(jet, p, 0.0, found.uv, open) else { return found };
    let moved = (jet.du * step.x).length() + (jet.dv * step.y).length();
    if moved > 1e-5 * found.distance {
        return found;
    }
    let uv = open.clamp(found.uv + step);
    let distance = surface.point(uv).distance(p);
    if distance <= found.distance * (1.0 + 1e-13) { Inversion { uv, distance } } else { found }
}

/// The step, and whether it is a full Newton step, which converges quadratically.
fn newton_step(jet: &SurfaceJet, p: DVec3, damping: f64, uv: DVec2, open: UvBox) -> Option<(DVec2, bool)> {
    let r = jet.p - p;
    let g = DVec2::new(r.dot(jet.du), r.dot(jet.dv));
    let (e, f, h) = (jet.du.length_squared(), jet.du.dot(jet.dv), jet.dv.length_squared());
    let held = |axis: usize| {
        (uv[axis] <= open.min[axis] && g[axis] > 0.0) || (uv[axis] >= open.max[axis] && g[axis] < 0.0)
    };
    let one = |gauss: f64, bend: f64, g: f64| {
        let full = gauss + bend;
        let slope = if full > 0.05 * gauss { full } else { gauss };
        -g / (slope + damping * gauss)
    };
    let mut newton = false;
    let step = match (held(0), held(1)) {
        (true, true) => return None,
        (true, false) => DVec2::new(0.0, one(h, r.dot(jet.dvv), g.y)),
        (false, true) => DVec2::new(one(e, r.dot(jet.duu), g.x), 0.0),
        (false, false) => {
            let full = [e + r.dot(jet.duu), f + r.dot(jet.duv), h + r.dot(jet.dvv)];
            let positive =
                full[0] > 0.0 && full[0] * full[2] - full[1] * full[1] > 1e-3 * (e * h - f * f).max(0.0);
            newton = positive;
            let [a, b, c] = if positive { full } else { [e, f, h] };
            // A collapsed direction stays where it is.
            let (a, c) = (a + damping * e, c + damping * h);
            let tiny = 1e-24 * (a + c) * (a + c);
            let det = a * c - b * b;
            if det > tiny {
                DVec2::new(b * g.y - c * g.x, b * g.x - a * g.y) / det
            } else if a > c {
                DVec2::new(-g.x / a, 0.0)
            } else {
                DVec2::new(0.0, -g.y / c)
            }
        }
    };
    step.is_finite().then_some((step, newton))
}

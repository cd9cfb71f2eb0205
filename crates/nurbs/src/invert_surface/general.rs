//! Free-form surfaces: samples on a grid, then a damped Newton descent.
//!
//! With r = S(u,v) − p the descent solves H δ = −g, g = (r·Su, r·Sv), H = [Su·Su + r·Suu, Su·Sv + r·Suv; ·,
//! Sv·Sv + r·Svv] + λ diag(Su·Su, Sv·Sv), leaving out the terms in r where H would not be positive
//! (Gauss–Newton), and keeps to the domain by dropping a direction that is against its border. λ grows until
//! the distance falls. A descent keeps to one smooth cell; from its border it is tried again in the next
//! cell. Not guaranteed: that the grid sees a valley narrower than its cells.

use super::Inversion;
use super::terrain::Terrain;
use crate::{Box3, Surface, SurfaceJet, UvBox, work};
use glam::{DVec2, DVec3};
use std::sync::OnceLock;

/// Samples along each side of the tiles that are looked into or passed over as a whole.
const TILE: usize = 4;
/// Fewest and most samples of a direction.
const SAMPLES: [usize; 2] = [17, 193];
/// Valleys that are followed down.
const VALLEYS: usize = 12;
/// Further starts where those led nowhere near the point.
const SECOND_TRIES: usize = 24;
/// Creases crossed by one descent.
const CROSSINGS: usize = 8;

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

    /// Samples that are lower than those around them, in the tiles that may hold the lowest, the lowest
    /// first.
    fn valleys(&self, p: DVec3) -> Vec<(f64, DVec2)> {
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
            self.valleys_of(&self.tiles[index], p, &mut found);
            best = found.iter().fold(best, |b, f| b.min(f.0));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.truncate(VALLEYS);
        found
    }

    /// The lowest sample of each tile that may reach below `height`.
    fn tile_starts(&self, p: DVec3, height: f64) -> Vec<DVec2> {
        let mut found: Vec<(f64, DVec2)> = self
            .tiles
            .iter()
            .filter(|t| p.distance(p.max(t.bounds.min).min(t.bounds.max)) <= height + 0.5 * self.cell)
            .map(|tile| {
                let rows = tile.rows[0]..=tile.rows[1];
                let inside = rows.flat_map(|i| (tile.columns[0]..=tile.columns[1]).map(move |j| (i, j)));
                let distances =
                    inside.map(|(i, j)| (self.points[i * self.vs.len() + j].distance_squared(p), i, j));
                let lowest = distances.fold((f64::INFINITY, 0, 0), |a, b| if b.0 < a.0 { b } else { a });
                (lowest.0, DVec2::new(self.us[lowest.1], self.vs[lowest.2]))
            })
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.truncate(SECOND_TRIES);
        found.into_iter().map(|f| f.1).collect()
    }

    fn valleys_of(&self, tile: &Tile, p: DVec3, found: &mut Vec<(f64, DVec2)>) {
        let height = |i: usize, j: usize| self.points[i * self.vs.len() + j].distance_squared(p);
        for i in tile.rows[0]..=tile.rows[1] {
            for j in tile.columns[0]..=tile.columns[1] {
                let here = height(i, j);
                let rows = i.saturating_sub(1)..=(i + 1).min(self.us.len() - 1);
                let columns = j.saturating_sub(1)..=(j + 1).min(self.vs.len() - 1);
                let mut around = rows.flat_map(|k| columns.clone().map(move |l| (k, l)));
                let lowest = around.all(|(k, l)| height(k, l) >= here);
                if lowest {
                    found.push((here.sqrt(), DVec2::new(self.us[i], self.vs[j])));
                }
            }
        }
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
    let wanted = (degree + 2).max((SAMPLES[0] - 1).div_ceil(spans));
    let steps = wanted.min((SAMPLES[1] / spans).max(1));
    let mut found = vec![start];
    for pair in stops.windows(2) {
        found.extend((1..steps).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / steps as f64));
        found.push(pair[1]);
    }
    found
}

/// The closest point; a close one in the valley of `near`, or one not farther than `enough`, comes first.
pub(super) fn invert(
    terrain: &Terrain<'_>,
    uv: UvBox,
    grid: &OnceLock<Grid>,
    p: DVec3,
    near: Option<DVec2>,
    enough: f64,
) -> Inversion {
    let local = near.map(|n| descend(terrain, p, n));
    if let Some(found) = local.filter(|found| found.distance <= enough || found.is_close(terrain)) {
        return found.inversion();
    }
    let grid = grid.get_or_init(|| work::uncounted(|| Grid::new(terrain.surface, uv)));
    let mut best = local.unwrap_or(Foot { uv: uv.center(), distance: f64::INFINITY, speed: DVec2::ZERO });
    for (height, start) in grid.valleys(p) {
        // On the surface, up to rounding, or lower than this valley can be: nothing is closer.
        if best.distance <= 1e-10 * grid.cell || best.distance < height - grid.cell {
            break;
        }
        best = better(best, descend(terrain, p, start));
    }
    // Not on the surface after all: points are expected to be, so that a valley may have hidden between
    // samples.
    if best.distance > 0.02 * grid.cell {
        for start in grid.tile_starts(p, best.distance) {
            best = better(best, descend(terrain, p, start));
        }
    }
    best.inversion()
}

/// Where a descent ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub uv: DVec2,
    pub distance: f64,
    /// The lengths of Su and Sv there.
    speed: DVec2,
}

impl Foot {
    fn inversion(self) -> Inversion {
        Inversion { uv: self.uv, distance: self.distance }
    }

    /// True where the distance is so small beside the surface that no other part of it is likely to be meant.
    fn is_close(&self, terrain: &Terrain<'_>) -> bool {
        is_close_beside(terrain, self.speed, self.distance)
    }
}

/// What was found first stays unless another place is truly closer.
fn better(first: Foot, other: Foot) -> Foot {
    if other.distance < first.distance * (1.0 - 1e-9) { other } else { first }
}

/// As [`Foot::is_close`], of any place.
pub(super) fn is_close(terrain: &Terrain<'_>, uv: DVec2, distance: f64) -> bool {
    let (_, du, dv) = terrain.surface.jet1(terrain.inside(uv));
    is_close_beside(terrain, DVec2::new(du.length(), dv.length()), distance)
}

fn is_close_beside(terrain: &Terrain<'_>, speed: DVec2, distance: f64) -> bool {
    let size = terrain.domain.size();
    let extent = |speed: f64, size: f64| if size.is_finite() { speed * size } else { f64::INFINITY };
    let least = extent(speed.x, size.x).min(extent(speed.y, size.y));
    distance <= 1e-5 * if least.is_finite() { least } else { speed.max_element() }
}

/// Goes down from `start`, over creases where that leads further down.
pub(super) fn descend(terrain: &Terrain<'_>, p: DVec3, start: DVec2) -> Foot {
    let start = terrain.inside(start);
    let mut cell = terrain.cell(start);
    let mut best = descend_within(terrain, cell, p, start);
    for _ in 0..CROSSINGS {
        let next = terrain
            .beyond(best.uv, cell)
            .map(|start| (terrain.cell(start), start))
            .map(|(cell, start)| (cell, descend_within(terrain, cell, p, start)))
            .filter(|(_, found)| found.distance < best.distance * (1.0 - 1e-9))
            .min_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
        let Some(next) = next else { break };
        (cell, best) = next;
    }
    best
}

/// Goes down inside a smooth cell.
fn descend_within(terrain: &Terrain<'_>, open: UvBox, p: DVec3, start: DVec2) -> Foot {
    let mut uv = open.clamp(start);
    let mut jet = terrain.jet(uv);
    let mut height = (jet.p - p).length_squared();
    let mut damping = 0.0;
    for _ in 0..60 {
        let Some((step, full)) = newton_step(&jet, p, damping, uv, open) else { break };
        let next = open.clamp(uv + step);
        if next == uv {
            break;
        }
        let next_jet = terrain.jet(next);
        let next_height = (next_jet.p - p).length_squared();
        if next_height < height {
            (uv, jet, height) = (next, next_jet, next_height);
            // After an undamped step this short the next one, about its square, is all rounding.
            let short = (step / terrain.domain.size()).abs().max_element() <= 1e-7;
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
    let speed = DVec2::new(jet.du.length(), jet.dv.length());
    polished(terrain, p, open, Foot { uv, distance: height.sqrt(), speed }, &jet)
}

/// One more Newton step where the point is off the surface: near the foot the distance itself hardly changes,
/// so that the descent ends with half of the digits.
//
// Never inlined: within `descend` the optimiser of rustc 1.95 (vectorisation of straight code, at level 3)
// returned a wrong v for a point exactly on the surface; the inversion tests show it in release builds.
#[inline(never)]
fn polished(terrain: &Terrain<'_>, p: DVec3, open: UvBox, found: Foot, jet: &SurfaceJet) -> Foot {
    let Some((step, true)) = newton_step(jet, p, 0.0, found.uv, open) else { return found };
    let moved = (jet.du * step.x).length() + (jet.dv * step.y).length();
    if moved > 1e-5 * found.distance {
        return found;
    }
    let uv = open.clamp(found.uv + step);
    let distance = terrain.point(uv).distance(p);
    if distance <= found.distance * (1.0 + 1e-13) { Foot { uv, distance, ..found } } else { found }
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

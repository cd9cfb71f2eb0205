//! Sewing of three and more sheets along one line leaves no slit.
//!
//! Random fans: 3 to 6 sheets around a straight or curved line, each with vertices of its own along it, moved
//! about within the tolerance; some are cut in two along the line (T-ends), some run the other way round.

use chordal_nurbs::math;
use chordal_sew::{MeshSewReport, SewTolerance, SewnMesh, sew_mesh};
use glam::DVec3;
use std::collections::BTreeMap;

/// Numbers between 0 and 1, the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn count(&mut self, low: usize, high: usize) -> usize {
        low + (self.next() * (high - low + 1) as f64) as usize
    }
}

/// Sheets that meet in a line of length 10.
struct Fan {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    tolerance: f64,
    bend: f64,
    /// How far vertices are moved about in each direction.
    noise: f64,
}

impl Fan {
    fn random(seed: u64) -> Self {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        random.next();
        let bend = if seed.is_multiple_of(2) { 0.0 } else { random.between(0.1, 0.3) };
        let least = if bend > 0.0 { 14 } else { 3 };
        let sheets = random.count(3, 6);
        let tolerance = 0.06;
        let mut fan =
            Self { positions: Vec::new(), triangles: Vec::new(), tolerance, bend, noise: tolerance / 6.0 };
        for sheet in 0..sheets {
            let angle = std::f64::consts::TAU * (sheet as f64 + random.between(-0.2, 0.2)) / sheets as f64;
            // Some sheets are two, which meet in a T-end on the others.
            let pieces =
                if random.next() < 0.3 { vec![0.0, random.between(3.0, 7.0), 10.0] } else { vec![0.0, 10.0] };
            for ends in pieces.windows(2) {
                let vertices = random.count(least, least + 7);
                fan.add_sheet([ends[0], ends[1]], vertices, angle, &mut random);
            }
        }
        fan
    }

    /// The line, which is a curve without ever being far from straight.
    fn line(&self, x: f64) -> DVec3 {
        DVec3::new(x, self.bend * math::sin(0.6 * x), self.bend * math::cos(0.4 * x))
    }

    /// A strip of triangles from the line outwards.
    fn add_sheet(&mut self, ends: [f64; 2], inner: usize, angle: f64, random: &mut Random) {
        let away = 5.0 * DVec3::new(0.0, math::cos(angle), math::sin(angle));
        let at = |share: f64| ends[0] + (ends[1] - ends[0]) * share;
        let first = self.positions.len() as u32;
        let mut shares = vec![0.0];
        shares.extend((1..inner).map(|i| (i as f64 + random.between(-0.35, 0.35)) / inner as f64));
        shares.push(1.0);
        for &share in &shares {
            let moved = DVec3::from_array(std::array::from_fn(|_| random.between(-self.noise, self.noise)));
            self.positions.push(self.line(at(share)) + moved);
        }
        let outer = self.positions.len() as u32;
        self.positions.extend([0.0, 0.5, 1.0].map(|share| self.line(at(share)) + away));
        let turned = random.next() < 0.3;
        let mut add = |t: [u32; 3]| self.triangles.push(if turned { [t[0], t[2], t[1]] } else { t });
        let half = shares.iter().position(|&s| s >= 0.5).unwrap_or(1) as u32;
        for i in 0..inner as u32 {
            add([first + i, first + i + 1, if i < half { outer } else { outer + 1 }]);
        }
        add([first + half, outer + 1, outer]);
        add([first + inner as u32, outer + 2, outer + 1]);
    }

    fn sew(&self) -> (SewnMesh, MeshSewReport) {
        sew_mesh(&self.positions, &self.triangles, SewTolerance::Length(self.tolerance), None)
    }
}

/// Edges with one triangle that lie along the line.
fn slits(fan: &Fan, mesh: &SewnMesh) -> usize {
    let mut uses: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for t in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let is_at_line = |v: u32| {
        let p = mesh.positions[v as usize];
        p.distance(fan.line(p.x)) < 0.5
    };
    uses.iter().filter(|(edge, count)| **count == 1 && edge.iter().all(|&v| is_at_line(v))).count()
}

#[test]
fn fans_of_sheets_are_sewn_without_slits() {
    let mut wrong = Vec::new();
    for seed in 0..600 {
        let fan = Fan::random(seed);
        let (mesh, report) = fan.sew();
        assert!(report.largest_move <= fan.tolerance * (1.0 + 1e-12), "fan {seed}: {report:?}");
        let slits = slits(&fan, &mesh);
        if slits > 0 {
            wrong.push(format!("{seed}: {slits}"));
        }
    }
    assert!(wrong.is_empty(), "fans with slits: {}: {}", wrong.len(), wrong.join(", "));
}

//! How finely one face is sampled for a view, and when a choice made before still serves.

use crate::faces::{Cubic, TrimmedFace, errors_served, steps};
use chordal_nurbs::DVec2;

/// The largest distance between what is drawn and the exact surface, pixels.
pub const PIXEL_ERROR: f64 = 0.5;
/// Places along a border piece at most.
const BORDER_STEPS: f64 = 64.0;
/// Texels along a side of the texture of one face's trim, at least and at most.
const TEXELS: [f64; 2] = [8.0, 2048.0];
/// Pieces of a border that together are no longer than this many pixels are one; they serve until they look a
/// pixel long.
const JOINED: f64 = 0.5;
/// How many times as fine as needed samples may be before they are made anew.
const TOO_FINE: f64 = 2.0;
/// How many times as fine as needed they are made where the view moves, so that the next frames need no new
/// ones.
const RESERVE: f64 = 1.25;

/// Samples of one face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Choice {
    /// Along u and v, before kinks are added.
    pub steps: [f64; 2],
    /// Along the most bent piece of its border, continuous.
    pub border: f64,
    /// Of the texture of its trim.
    pub texels: [f64; 2],
    /// The error it is made for, in the part's units.
    pub error: f64,
    /// Some pieces of the border may be joined, so that no error below half is served.
    pub joined: bool,
}

impl Choice {
    /// The samples that an error in the part's units needs.
    pub fn of(face: &TrimmedFace, error: f64) -> Self {
        // A texel is half as large as the pixel that shows it: the error is half a pixel.
        let texels = face.stretch.map(|s| (s / error * (0.5 / PIXEL_ERROR)).clamp(TEXELS[0], TEXELS[1]));
        let joined = face.shortest_piece <= JOINED * error / PIXEL_ERROR;
        Self {
            steps: steps(face, error),
            border: border_steps(face.border_bend, error),
            texels,
            error,
            joined,
        }
    }

    /// The same for samples that have to serve while the view moves.
    pub fn with_reserve(self, face: &TrimmedFace) -> Self {
        // An error goes with the square of a step.
        Self::of(face, self.error / (RESERVE * RESERVE))
    }

    /// True where samples chosen so are fine enough for what is `needed`, and not much finer. Textures count
    /// where there are any.
    pub fn serves(&self, needed: &Self, textured: bool) -> bool {
        let serves = |has: f64, needs: f64| has >= needs && has <= (TOO_FINE * needs).ceil();
        let all = |has: [f64; 2], needs: [f64; 2]| (0..2).all(|axis| serves(has[axis], needs[axis]));
        all(self.steps, needed.steps)
            && serves(self.border, needed.border)
            && (!self.joined || JOINED * self.error <= needed.error)
            && (!textured || all(self.texels, needed.texels))
    }
}

impl Choice {
    /// The smallest and the largest error that samples chosen so serve, in the part's units; nothing between
    /// the two is in doubt.
    pub fn errors_served(&self, face: &TrimmedFace, textured: bool) -> [f64; 2] {
        let [mut low, mut high] = errors_served(face, self.steps);
        let mut narrow = |least: f64, most: f64| (low, high) = (low.max(least), high.min(most));
        if self.border < BORDER_STEPS {
            let least = face.border_bend / (2.0 * self.border * self.border);
            narrow(least, if self.border <= 2.0 { f64::INFINITY } else { 4.0 * least });
        } else {
            narrow(f64::INFINITY, 0.0);
        }
        if self.joined {
            narrow(JOINED * self.error, f64::INFINITY);
        }
        for axis in (0..2).filter(|_| textured) {
            let (has, least) =
                (self.texels[axis], face.stretch[axis] / self.texels[axis] * (0.5 / PIXEL_ERROR));
            match has {
                _ if has >= TEXELS[1] => narrow(f64::INFINITY, 0.0),
                _ if has <= TOO_FINE * TEXELS[0] => narrow(least, f64::INFINITY),
                _ => narrow(least, TOO_FINE * least),
            }
        }
        // Within rounding of the ends it may be either.
        [low * (1.0 + 1e-9), high * (1.0 - 1e-9)]
    }
}

/// Half the error for the surface's bend and the curve's own.
fn border_steps(bend: f64, error: f64) -> f64 {
    (bend / (2.0 * error)).sqrt().clamp(1.0, BORDER_STEPS)
}

impl TrimmedFace {
    /// The pieces of its border: its loops, or its square.
    fn border_pieces(&self) -> Vec<Cubic> {
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        match self.loops.is_empty() {
            true => (0..4).map(|k| Cubic::line(square[k], square[(k + 1) % 4])).collect(),
            false => self.loops.clone(),
        }
    }

    /// Per piece of the border how much its image bends, in the part's units, its parameter running over
    /// 0..=1.
    fn border_bends(&self) -> impl Iterator<Item = f64> {
        let [uu, uv, vv] = self.bends;
        let (size, stretch) = (self.uv.size(), DVec2::from(self.stretch));
        self.border_pieces().into_iter().map(move |piece| {
            let d = piece.length_by_axis() * size;
            let own = piece.second().dot(stretch);
            uu * d.x * d.x + 2.0 * uv * d.x * d.y + vv * d.y * d.y + own
        })
    }

    /// With the samples that the border needs.
    pub(crate) fn with_border(mut self) -> Self {
        self.measure_border();
        self
    }

    /// How much the most bent piece of the border bends, and the length of the shortest, in the part's units.
    pub(crate) fn measure_border(&mut self) {
        self.border_bend = self.border_bends().fold(0.0, f64::max);
        let stretch = DVec2::from(self.stretch);
        let lengths = self.border_pieces().into_iter().map(|p| p.length_by_axis().dot(stretch));
        self.shortest_piece = lengths.fold(f64::INFINITY, f64::min);
    }

    /// Pairs of native parameters, the ends of short pieces of the border. Pieces that are short enough
    /// together are one.
    pub(crate) fn border(&self, error: f64) -> Vec<DVec2> {
        let (size, stretch) = (self.uv.size(), DVec2::from(self.stretch));
        let native = |p: DVec2| self.uv.clamp(self.uv.min + p * size);
        let longest = JOINED * error / PIXEL_ERROR;
        let mut found = Vec::new();
        // Ends of the short pieces gathered, and their length.
        let mut short: Option<([DVec2; 2], f64)> = None;
        for (piece, bend) in self.border_pieces().iter().zip(self.border_bends()) {
            let ([start, end], length) = (piece.ends(), piece.length_by_axis().dot(stretch));
            if let Some((ends, sum)) = &mut short
                && ends[1] == start
                && *sum + length <= longest
            {
                (ends[1], *sum) = (end, *sum + length);
                continue;
            }
            found.extend(short.take().into_iter().flat_map(|(ends, _)| ends.map(native)));
            if length <= longest {
                short = Some(([start, end], length));
                continue;
            }
            let steps = border_steps(bend, error).ceil();
            let at = |k: f64| native(piece.at(k / steps));
            found.extend((0..steps as u32).flat_map(|k| [at(f64::from(k)), at(f64::from(k) + 1.0)]));
        }
        found.extend(short.into_iter().flat_map(|(ends, _)| ends.map(native)));
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::{DVec3, NurbsSurface, math};

    #[test]
    fn choices_serve_while_they_are_fine_enough_and_not_too_fine() {
        let choice = |steps: f64, texels: f64| Choice {
            steps: [steps, 1.0],
            border: 2.0,
            texels: [texels, 8.0],
            error: 1.0,
            joined: false,
        };
        let has = choice(10.0, 100.0);
        assert!(has.serves(&choice(10.0, 100.0), true) && has.serves(&choice(5.0, 60.0), true));
        assert!(!has.serves(&choice(11.0, 100.0), false) && !has.serves(&choice(4.0, 100.0), false));
        assert!(has.serves(&choice(10.0, 300.0), false) && !has.serves(&choice(10.0, 300.0), true));
    }

    /// A border seen from afar takes no more pieces than pixels, and still goes all the way round.
    #[test]
    fn short_pieces_of_borders_are_joined() {
        let net = (0..4).map(|k| DVec3::new(f64::from(k / 2), f64::from(k % 2), 0.0)).collect();
        let knots = vec![0.0, 0.0, 1.0, 1.0];
        let mut face =
            TrimmedFace::whole(NurbsSurface::new([1, 1], knots.clone(), knots, net, None).unwrap());
        let at = |k: u32| {
            DVec2::splat(0.5) + 0.4 * math::direction(std::f64::consts::TAU * f64::from(k % 500) / 500.0)
        };
        face.loops = (0..500).map(|k| Cubic::line(at(k), at(k + 1))).collect();
        face = face.with_border();
        let far = Choice::of(&face, 10.0);
        assert!(far.serves(&Choice::of(&face, 11.0), false) && !far.serves(&Choice::of(&face, 4.9), false));
        for (pixel, most) in [(1e-4, 500), (0.1, 120), (10.0, 1)] {
            let border = face.border(pixel * PIXEL_ERROR);
            assert!(border.len() <= 2 * most && !border.is_empty(), "{} at {pixel}", border.len());
            assert!(border.chunks(2).collect::<Vec<_>>().windows(2).all(|w| w[0][1] == w[1][0]));
            assert_eq!(border[0], border[border.len() - 1]);
        }
    }

    /// A choice serves all errors between those that it reports, and the one it was made for.
    #[test]
    fn errors_served_are_served() {
        let net = |i: usize, j: usize| DVec3::new(i as f64, j as f64, math::sin((i * j) as f64));
        let points = (0..16).map(|k| net(k / 4, k % 4)).collect();
        let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        let surface = NurbsSurface::new([3, 3], knots.clone(), knots, points, None).unwrap();
        let face = TrimmedFace::whole(surface);
        let mut open = 0;
        for step in 0..60 {
            let error = 0.3 * math::powi(0.83, step);
            for made in [Choice::of(&face, error), Choice::of(&face, error).with_reserve(&face)] {
                for textured in [false, true] {
                    let [low, high] = made.errors_served(&face, textured);
                    if !(low < high) {
                        continue;
                    }
                    open += 1;
                    assert!(
                        low <= error * (1.0 + 1e-6) && error <= high * (1.0 + 1e-6),
                        "{low} {error} {high}"
                    );
                    for k in 0..=20 {
                        let at = low * math::pow(high.min(1e3) / low, f64::from(k) / 20.0);
                        assert!(
                            made.serves(&Choice::of(&face, at), textured),
                            "{made:?} at {at}, {textured}"
                        );
                    }
                }
            }
        }
        assert!(open > 100, "{open}");
    }
}

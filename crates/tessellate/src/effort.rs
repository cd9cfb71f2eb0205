//! How hard a face is tried: the ladder of remedies, and what an attempt that fails leads to.
//!
//! An attempt meshes one face with all [`Remedy`]s taken so far. The round decides which remedies a face
//! starts with, since edges become finer from round to round ([`Effort::of_round`]):
//!
//! 1. Rounds 0 to 2: a chord whose bound is far beyond the tolerance is examined in parts. If the parts are
//!    fine, points inside the face are tried before the chord is made finer.
//! 2. From round 3 on such a chord is made finer at once, and with a chord that folds a facet all chords of
//!    its edge that are as coarse ([`Remedy::FinerChords`]).
//! 3. From round 6 on loops that still cross are meshed as they are ([`Remedy::CrossingLoops`]), unless a chord
//!    cuts off an end of the other one.
//! 4. In round 8, the last one, whatever is still too coarse is accepted and reported ([`Remedy::AsItIs`]).
//!
//! Within a round, an attempt that fails by the face's own doing ([`Setback`]) is followed by another
//! ([`Effort::after`]):
//!
//! 5. The loops cross: do not cut the face along the creases of its surface ([`Remedy::UncutCreases`]).
//! 6. A seam is too coarse: cut seams into shorter chords.
//! 7. A triangle cannot be mended: make chords finer at once (2.), and if that is done already, accept it
//!    (4.).
//! 8. Eight attempts did not suffice: let facets fold over seams and creases ([`Remedy::Folds`]), with coarse
//!    seams again.
//! 9. Eight more did not: let edges turn by any angle ([`Remedy::AnyAngle`]), with coarse seams again.
//! 10. Eight more did not: keep to the angle, do not cut along creases, and accept what there is.
//! 11. The face fails.

use chordal_brep::MeshIssue;

/// What an attempt may do beyond the first one, in the order in which it is resorted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Remedy {
    /// Chords with bounds far beyond the tolerance are made finer without trying points inside first, and
    /// chords that fold facets together with those of their edge that are as coarse.
    FinerChords,
    /// The face is not cut along the creases of its surface.
    UncutCreases,
    /// Facets may double back over seams and creases, beyond which the face goes on: it is narrower there
    /// than its tolerance.
    Folds,
    /// Edges may turn by any angle. Where the surface turns at once, no seam is fine enough for a limit of
    /// angle: the tolerance comes first, and the audit reports the angle.
    AnyAngle,
    /// Loops that cross are taken to cross in the model, not by coarse chords: no edge is made finer for it but
    /// chords that cut off an end of another one.
    CrossingLoops,
    /// What cannot be mended is accepted, with the error that it has.
    AsItIs,
}

const REMEDIES: usize = Remedy::AsItIs as usize + 1;

/// The number of rounds in which faces may request finer edges; what is too coarse then is meshed as it is
/// and reported. Chords are up to 2³ · 4⁵ = 8192 times finer by then, and every further round would mesh
/// whole faces again.
pub(crate) const MAX_ROUNDS: usize = 8;

/// Rounds in which points inside are tried before chords with wild bounds are made finer. With more rounds,
/// surfaces that are wild over the chord itself keep asking; with fewer, chords are cut that need not be.
const POINTS_FIRST_ROUNDS: usize = 3;

/// From this round on loops that still cross are taken to cross in the model. Chords are up to 512 times
/// finer by then.
const CROSSING_ROUND: usize = 6;

/// Attempts with one limit of folds and angle. Each makes seams shorter by [`SEAM_STEP`], so seams become up
/// to twelve times finer.
const ATTEMPTS: u32 = 8;

/// Chords of a seam or of a natural border, as a share of the longest that the metric allows: facets need the
/// rest.
const SEAM_CHORD: f64 = 0.9;

/// A seam that proved too coarse is cut into chords shorter by this factor.
const SEAM_STEP: f64 = 0.7;

/// Why an attempt made no triangles that are good enough.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Setback {
    /// Chords (edge, index) of the part's edges are too coarse for this face; the edges must become finer.
    CoarseEdges(Vec<(u32, u32)>),
    /// A seam, which no other face uses, is too coarse.
    CoarseSeam,
    /// The loops cross in truth: they have no inside that could be cut along creases.
    Crossing,
    /// A triangle cannot be mended by any means of this attempt.
    Stuck,
    /// The face is given up.
    Failed(MeshIssue),
}

impl From<MeshIssue> for Setback {
    fn from(issue: MeshIssue) -> Self {
        Setback::Failed(issue)
    }
}

/// The remedies that an attempt uses, and how finely it cuts seams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Effort {
    taken: [bool; REMEDIES],
    seam_steps: u32,
    /// Attempts since folds or angles were last allowed.
    attempts: u32,
    /// There is no attempt after this one.
    is_last: bool,
}

impl Effort {
    /// The effort that a round starts with.
    pub fn of_round(round: usize) -> Self {
        let first = Self { taken: [false; REMEDIES], seam_steps: 0, attempts: 0, is_last: false };
        first
            .set(Remedy::FinerChords, round >= POINTS_FIRST_ROUNDS)
            .set(Remedy::CrossingLoops, round >= CROSSING_ROUND)
            .set(Remedy::AsItIs, round >= MAX_ROUNDS)
    }

    /// The same effort for a face whose edges cannot become finer.
    pub fn with_final_edges(self) -> Self {
        self.with(Remedy::CrossingLoops).with(Remedy::AsItIs)
    }

    /// True where the remedy is used.
    pub fn has(&self, remedy: Remedy) -> bool {
        self.taken[remedy as usize]
    }

    /// The same effort with one more remedy.
    pub fn with(self, remedy: Remedy) -> Self {
        self.set(remedy, true)
    }

    fn set(mut self, remedy: Remedy, is_taken: bool) -> Self {
        self.taken[remedy as usize] = is_taken;
        self
    }

    /// Chords of seams as a share of the longest that the metric allows.
    pub fn seam_chord(&self) -> f64 {
        (0..self.seam_steps).fold(SEAM_CHORD, |chord, _| chord * SEAM_STEP)
    }

    /// The effort of the next attempt in the same round; none after the last one, and none where the setback
    /// is not for the face itself to mend.
    pub fn after(self, setback: &Setback) -> Option<Self> {
        let mut next = match setback {
            Setback::Crossing => self.with(Remedy::UncutCreases),
            Setback::CoarseSeam => Self { seam_steps: self.seam_steps + 1, ..self },
            Setback::Stuck if !self.has(Remedy::FinerChords) => self.with(Remedy::FinerChords),
            Setback::Stuck => self.with(Remedy::AsItIs),
            Setback::CoarseEdges(_) | Setback::Failed(_) => return None,
        };
        if self.is_last {
            return None;
        }
        next.attempts += 1;
        if next.attempts < ATTEMPTS {
            return Some(next);
        }
        next.attempts = 0;
        Some(if !next.has(Remedy::Folds) {
            Self { seam_steps: 0, ..next.with(Remedy::Folds) }
        } else if !next.has(Remedy::AnyAngle) {
            Self { seam_steps: 0, ..next.with(Remedy::AnyAngle) }
        } else {
            let strict = next.set(Remedy::AnyAngle, false).with(Remedy::FinerChords);
            Self { is_last: true, ..strict.with(Remedy::UncutCreases).with(Remedy::AsItIs) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::math;

    #[test]
    fn rounds_add_remedies_in_order() {
        let taken = |round: usize| Effort::of_round(round).taken.iter().filter(|&&t| t).count();
        assert_eq!([0, 2, 3, 5, 6, 7, 8].map(taken), [0, 0, 1, 1, 2, 2, 3]);
    }

    #[test]
    fn a_seam_that_is_always_too_coarse_goes_up_the_whole_ladder() {
        let mut effort = Effort::of_round(0);
        let mut efforts = vec![effort];
        while let Some(next) = effort.after(&Setback::CoarseSeam) {
            effort = next;
            efforts.push(effort);
        }
        assert_eq!(efforts.len(), 3 * ATTEMPTS as usize + 1);
        assert!((efforts[7].seam_chord() - SEAM_CHORD * math::powi(SEAM_STEP, 7)).abs() < 1e-15);
        assert!(efforts[8].has(Remedy::Folds) && efforts[8].seam_chord() == SEAM_CHORD);
        assert!(efforts[16].has(Remedy::AnyAngle) && !efforts[15].has(Remedy::AnyAngle));
        let last = efforts[24];
        assert!(last.has(Remedy::AsItIs) && last.has(Remedy::Folds) && !last.has(Remedy::AnyAngle));
    }

    #[test]
    fn a_stuck_face_tries_finer_chords_and_then_accepts() {
        let second = Effort::of_round(0).after(&Setback::Stuck).expect("there is a second attempt");
        assert!(second.has(Remedy::FinerChords) && !second.has(Remedy::AsItIs));
        let third = second.after(&Setback::Stuck).expect("there is a third attempt");
        assert!(third.has(Remedy::AsItIs) && !third.has(Remedy::Folds));
        assert_eq!(third.after(&Setback::CoarseEdges(Vec::new())), None);
    }
}

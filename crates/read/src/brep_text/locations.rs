//! Locations: products of powers of elementary placements.
//!
//! Two uses of a shape are the same edge where they have the same factors, not where their matrices are
//! nearly equal: every location is kept as its list of factors, and equal lists have one number.

use super::tokens::{Stop, Tokens};
use crate::assemble::placement;
use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::DAffine3;
use rustc_hash::FxHashMap;

/// The number of a location; 0 is none.
pub(crate) type Loc = u32;

/// The identity.
pub(crate) const NOWHERE: Loc = 0;

/// A location with more factors than this becomes a factor of its own: files build chains as deep as their
/// assemblies.
const MOST_FACTORS: usize = 256;
/// Powers are ±1 in all but made-up files.
const MOST_POWER: i64 = 64;

/// All locations of a file and those made by composing them.
#[derive(Debug)]
pub(crate) struct Locations {
    /// Factors (number of an elementary placement, power) and the matrix, by [`Loc`].
    known: Vec<(Vec<(u32, i32)>, DAffine3)>,
    numbers: FxHashMap<Vec<(u32, i32)>, Loc>,
    composed: FxHashMap<(Loc, Loc), Loc>,
    elementary: Vec<DAffine3>,
    /// By the number in the file; `None` where the definition is broken.
    in_file: Vec<Option<Loc>>,
}

impl Locations {
    pub(crate) fn new() -> Self {
        let mut all = Self {
            known: Vec::new(),
            numbers: FxHashMap::default(),
            composed: FxHashMap::default(),
            elementary: Vec::new(),
            in_file: Vec::new(),
        };
        let none = all.intern(Vec::new(), DAffine3::IDENTITY);
        debug_assert_eq!(none, NOWHERE);
        all.in_file.push(Some(none));
        all
    }

    /// The location with a number of the file; 0 is none.
    pub(crate) fn of_file(&self, number: i64) -> Option<Loc> {
        usize::try_from(number).ok().and_then(|i| self.in_file.get(i).copied().flatten())
    }

    pub(crate) fn matrix(&self, loc: Loc) -> DAffine3 {
        self.known[loc as usize].1
    }

    /// First `inner`, then `outer`.
    pub(crate) fn compose(&mut self, outer: Loc, inner: Loc) -> Loc {
        if outer == NOWHERE || inner == NOWHERE {
            return outer.max(inner);
        }
        if let Some(&known) = self.composed.get(&(outer, inner)) {
            return known;
        }
        let mut factors = self.known[outer as usize].0.clone();
        for &(element, power) in &self.known[inner as usize].0 {
            match factors.last_mut() {
                Some(last) if last.0 == element => {
                    last.1 += power;
                    if last.1 == 0 {
                        factors.pop();
                    }
                }
                _ => factors.push((element, power)),
            }
        }
        let matrix = self.matrix(outer) * self.matrix(inner);
        let made = self.intern(factors, matrix);
        self.composed.insert((outer, inner), made);
        made
    }

    fn intern(&mut self, factors: Vec<(u32, i32)>, matrix: DAffine3) -> Loc {
        if let Some(&known) = self.numbers.get(&factors) {
            return known;
        }
        if factors.len() > MOST_FACTORS {
            return self.new_elementary(matrix);
        }
        let loc = self.known.len() as Loc;
        self.numbers.insert(factors.clone(), loc);
        self.known.push((factors, matrix));
        loc
    }

    fn new_elementary(&mut self, matrix: DAffine3) -> Loc {
        let element = self.elementary.len() as u32;
        self.elementary.push(matrix);
        self.intern(vec![(element, 1)], matrix)
    }

    /// One record of the section: `1` and a matrix of 3 × 4, or `2` and pairs of a location and a power,
    /// ended by 0.
    ///
    /// # Errors
    /// Where the text cannot be followed.
    pub(crate) fn read_one(&mut self, tokens: &mut Tokens<'_>) -> Result<Result<(), ReadIssue>, Stop> {
        let made = match tokens.integer()? {
            1 => {
                let mut rows = [[0.0; 4]; 3];
                for value in rows.iter_mut().flatten() {
                    *value = tokens.real()?;
                }
                placement(rows).map(|matrix| self.new_elementary(matrix))
            }
            2 => {
                let mut product = Ok(NOWHERE);
                loop {
                    let number = tokens.integer()?;
                    if number == 0 {
                        break;
                    }
                    let power = tokens.integer()?;
                    product = product.and_then(|product| self.times(product, number, power));
                }
                product
            }
            _ => return Err(tokens.stop("the kind of a location")),
        };
        self.in_file.push(made.as_ref().ok().copied());
        Ok(made.map(|_| ()))
    }

    /// What comes later in the list stands further out.
    fn times(&mut self, product: Loc, number: i64, power: i64) -> Result<Loc, ReadIssue> {
        let factor = self.of_file(number).ok_or(ReadIssue::NotFound { what: "location", number })?;
        if power.abs() > MOST_POWER {
            return Err(ReadIssue::BadValue { what: "power of a location", value: Real(power as f64) });
        }
        let factor = if power < 0 { self.inverse(factor) } else { factor };
        Ok((0..power.abs()).fold(product, |product, _| self.compose(factor, product)))
    }

    fn inverse(&mut self, loc: Loc) -> Loc {
        let (factors, matrix) = &self.known[loc as usize];
        let factors = factors.iter().rev().map(|&(element, power)| (element, -power)).collect();
        let matrix = matrix.inverse();
        self.intern(factors, matrix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::DVec3;

    fn read(text: &str, count: usize) -> Locations {
        let mut all = Locations::new();
        let mut tokens = Tokens::new(text.as_bytes(), 1);
        for _ in 0..count {
            all.read_one(&mut tokens).expect("readable").expect("sound");
        }
        all
    }

    #[test]
    fn a_location_and_its_inverse_cancel() {
        let mut all =
            read("1 1 0 0 5 0 1 0 0 0 0 1 0\n1 0 -1 0 0 1 0 0 0 0 0 1 0\n2 1 1 2 -1 0\n2 2 1 1 -1 0", 4);
        let (a, b) = (all.of_file(3).expect("known"), all.of_file(4).expect("known"));
        assert_eq!(all.compose(a, b), NOWHERE);
        let p = all.matrix(a).transform_point3(DVec3::X);
        assert!(p.distance(DVec3::new(0.0, -6.0, 0.0)) < 1e-15, "{p}");
    }
}

//! Evaluation of many points of one surface at once, by a device if there is one.
//!
//! A method that has its points before it connects them announces them ([`Foreseen::ask`]); an
//! [`BulkEvaluator`] may then compute positions and derivatives of all of them together. Its results place
//! vertices and shape triangles. Proofs never use them: bounds are computed on this thread, in double
//! precision.

use chordal_chart::FaceSurface;
use chordal_nurbs::{BulkEvaluator, DVec2, Surface, SurfaceJet};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// An evaluator, or none.
#[derive(Clone, Debug, Default)]
pub struct Bulk(Option<Arc<dyn BulkEvaluator>>);

impl Bulk {
    pub fn new(evaluator: Arc<dyn BulkEvaluator>) -> Self {
        Self(Some(evaluator))
    }
}

/// True for the same evaluator object; two objects that give the same points differ.
impl PartialEq for Bulk {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }
}

/// Points and derivatives of one face that were evaluated in advance.
#[derive(Debug, Default)]
pub(crate) struct Foreseen {
    bulk: Bulk,
    jets: FxHashMap<[u64; 2], SurfaceJet>,
}

fn key(p_uv: DVec2) -> [u64; 2] {
    [p_uv.x.to_bits(), p_uv.y.to_bits()]
}

impl Foreseen {
    pub fn new(bulk: &Bulk) -> Self {
        Self { bulk: bulk.clone(), jets: FxHashMap::default() }
    }

    /// Announces points of a chart that will be needed.
    pub fn ask(&mut self, surface: &FaceSurface<'_>, points: impl Iterator<Item = DVec2>) {
        let (Some(evaluator), Surface::Nurbs(spline)) = (&self.bulk.0, surface.surface) else { return };
        let domain = spline.domain();
        let wanted = points.map(|uv| (uv, surface.wrapped(uv))).filter(|&(_, at)| domain.contains(at));
        let (charted, at): (Vec<DVec2>, Vec<DVec2>) = wanted.unzip();
        let found = evaluator.jets(spline, &at).filter(|jets| jets.len() == at.len());
        self.jets = charted.into_iter().map(key).zip(found.into_iter().flatten()).collect();
    }

    /// Point and derivatives at a point of the chart.
    pub fn jet(&self, surface: &FaceSurface<'_>, p_uv: DVec2) -> SurfaceJet {
        // Without a device no lookup is needed.
        let known = if self.jets.is_empty() { None } else { self.jets.get(&key(p_uv)) };
        known.copied().unwrap_or_else(|| surface.jet(p_uv))
    }
}

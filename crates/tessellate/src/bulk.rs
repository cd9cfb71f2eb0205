//! Many points of one surface at once, by whoever can: the seam to devices other than this thread.
//!
//! Where a strategy knows its points before it connects them, it says so ([`Foreseen::ask`]), and an [`BulkEvaluator`] may find
//! positions and derivatives of all of them together. What comes back places vertices and sizes triangles; what is proven
//! of them is found here, in double precision, as ever.

use crate::surface::FaceSurface;
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

/// The same evaluator, not one that gives the same points.
impl PartialEq for Bulk {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }
}

/// Jets of one face that are known before they are asked for.
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

    /// Says that these points of a chart will be wanted.
    pub fn ask(&mut self, surface: &FaceSurface<'_>, points: impl Iterator<Item = DVec2>) {
        let (Some(evaluator), Surface::Nurbs(spline)) = (&self.bulk.0, surface.surface) else { return };
        let domain = spline.domain();
        let wanted = points.map(|uv| (uv, surface.wrapped(uv))).filter(|&(_, at)| domain.contains(at));
        let (charted, at): (Vec<DVec2>, Vec<DVec2>) = wanted.unzip();
        let found = evaluator.jets(spline, &at).filter(|jets| jets.len() == at.len());
        self.jets = charted.into_iter().map(key).zip(found.into_iter().flatten()).collect();
    }

    /// The jet at a point of the chart.
    pub fn jet(&self, surface: &FaceSurface<'_>, p_uv: DVec2) -> SurfaceJet {
        // Without a device there is nothing to look for.
        let known = if self.jets.is_empty() { None } else { self.jets.get(&key(p_uv)) };
        known.copied().unwrap_or_else(|| surface.jet(p_uv))
    }
}

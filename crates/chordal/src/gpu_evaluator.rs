//! Points of faces evaluated on a GPU, in double precision, for the mesher.

use chordal_gpu::{
    DeviceChoice, Gpu, GpuError, KernelRunner, Request, Samples, Search, SurfaceSet, Variant, Wanted,
};
use chordal_nurbs::{BulkEvaluator, DVec2, DVec3, NurbsSurface, SurfaceJet};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Fewer points of one surface are not sent: a dispatch with its upload and its way back takes as long as the
/// host needs for so many (docs/gpu.md, Figures).
const FEWEST: usize = 4096;

/// A device with the kernels that the mesher needs.
#[derive(Debug)]
pub struct GpuEvaluator {
    gpu: Gpu,
    kernels: KernelRunner<f64>,
    fewest: usize,
    points: AtomicUsize,
    dispatches: AtomicUsize,
    failed: Mutex<Option<GpuError>>,
}

impl GpuEvaluator {
    /// Opens a device.
    ///
    /// # Errors
    /// As [`Gpu::open`]; [`GpuError::Lacks`] for one without double precision in shaders: positions of
    /// vertices need it.
    pub fn open(choice: DeviceChoice) -> Result<Self, GpuError> {
        let gpu = Gpu::open(choice)?;
        let kernels = KernelRunner::new(&gpu, Variant::Bernstein, Search::Host)?;
        Ok(Self {
            gpu,
            kernels,
            fewest: FEWEST,
            points: AtomicUsize::new(0),
            dispatches: AtomicUsize::new(0),
            failed: Mutex::new(None),
        })
    }

    /// Sends no fewer points than these at once.
    pub fn with_fewest(self, fewest: usize) -> Self {
        Self { fewest, ..self }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// How many points the device has evaluated, in how many dispatches.
    pub fn work(&self) -> (usize, usize) {
        (self.points.load(Ordering::Relaxed), self.dispatches.load(Ordering::Relaxed))
    }

    /// Why the device was given up, where it was: from then on the host has evaluated everything.
    pub fn failure(&self) -> Option<GpuError> {
        self.failed.lock().ok().and_then(|failed| failed.clone())
    }

    fn evaluate(&self, surface: &NurbsSurface, at: &[DVec2]) -> Result<Vec<SurfaceJet>, GpuError> {
        let mut set = SurfaceSet::<f64>::with_bezier();
        let index = set.push_surface(surface);
        let samples = Samples::new(&set, &[Request::Points { surface: index, uvs: at.to_vec() }])?;
        let found = self.kernels.evaluate(&self.gpu, &set, &samples, Wanted::Second)?;
        let frame = set.entries()[index].frame;
        let jets = found.values.chunks_exact(found.stride).map(|values| {
            let vector = |slot: usize| DVec3::from_slice(&values[3 * slot..]) * frame.size;
            SurfaceJet {
                p: frame.middle + vector(0),
                du: vector(1),
                dv: vector(2),
                duu: vector(4),
                duv: vector(5),
                dvv: vector(6),
            }
        });
        Ok(jets.collect())
    }
}

impl BulkEvaluator for GpuEvaluator {
    fn jets(&self, surface: &NurbsSurface, at: &[DVec2]) -> Option<Vec<SurfaceJet>> {
        if at.len() < self.fewest || self.failure().is_some() {
            return None;
        }
        match self.evaluate(surface, at) {
            Ok(jets) => {
                self.points.fetch_add(jets.len(), Ordering::Relaxed);
                self.dispatches.fetch_add(1, Ordering::Relaxed);
                Some(jets)
            }
            // A surface that is too large for the device does not affect others.
            Err(GpuError::TooLarge { .. } | GpuError::TooManyPoints(_)) => None,
            Err(error) => {
                if let Ok(mut failed) = self.failed.lock() {
                    failed.get_or_insert(error);
                }
                None
            }
        }
    }
}

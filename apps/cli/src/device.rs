//! `--device`: the processor or a graphics device evaluates faces with thousands of points.

use crate::args::{EvaluateArg, MeshArgs};
use chordal::tessellate::Bulk;

#[cfg(feature = "gpu")]
use std::sync::Arc;

/// The device of one run of the program; none where the CPU does everything.
pub struct Device {
    #[cfg(feature = "gpu")]
    gpu: Option<Arc<chordal::GpuEvaluator>>,
}

#[cfg(not(feature = "gpu"))]
impl Device {
    pub fn open(args: &MeshArgs) -> Result<Self, String> {
        match args.device {
            EvaluateArg::Cpu => Ok(Self {}),
            EvaluateArg::Gpu => Err("--device gpu: this build lacks the feature `gpu`; rebuild with \
                     `cargo build --release -p chordal-cli --features gpu`"
                .into()),
        }
    }

    pub fn bulk(&self) -> Bulk {
        Bulk::default()
    }

    pub fn tell(&self) {}
}

#[cfg(feature = "gpu")]
impl Device {
    pub fn open(args: &MeshArgs) -> Result<Self, String> {
        let open = || chordal::GpuEvaluator::open(chordal::gpu::DeviceChoice::Best);
        let gpu = (args.device == EvaluateArg::Gpu).then(open).transpose();
        Ok(Self { gpu: gpu.map_err(|error| format!("--device gpu: {error}"))?.map(Arc::new) })
    }

    pub fn bulk(&self) -> Bulk {
        self.gpu.as_ref().map_or_else(Bulk::default, |gpu| Bulk::new(gpu.clone()))
    }

    /// Prints what the device did, and whether it failed.
    pub fn tell(&self) {
        let Some(gpu) = &self.gpu else { return };
        let (points, dispatches) = gpu.work();
        crate::exit::say(&format!("{}: {points} points in {dispatches} dispatches", gpu.gpu().name()));
        if let Some(error) = gpu.failure() {
            crate::exit::say(&format!("from then on the CPU evaluated everything: {error}"));
        }
    }
}

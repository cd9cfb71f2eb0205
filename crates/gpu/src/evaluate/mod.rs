//! Evaluation behind one interface: five kernels, two ways to find spans, two precisions, on the device or by
//! its twins.

mod batches;
mod on_device;
mod plan;
mod run;
mod twin;

pub use on_device::OnDevice;
pub(crate) use on_device::{empty_storage, storage};
pub use plan::{Search, Variant, Wanted};
pub(crate) use run::read_back;
pub use run::{Evaluated, Evaluation, KernelRunner};
pub use twin::evaluate_twin;

//! Why the GPU could not be used; each message is one sentence.

use crate::device_choice::{ADVICE, BACKENDS, DeviceChoice};

/// What went wrong between here and the device.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter at all, or none of the requested kind.
    #[error("no {BACKENDS} device was found{choice}; {ADVICE}")]
    NoDevice {
        /// The requested kind of adapter.
        choice: DeviceChoice,
    },
    #[error("the adapter {adapter} cannot be used: it lacks {what}")]
    Lacks { adapter: String, what: String },
    #[error("the adapter {adapter} refused a device: {reason}")]
    Refused { adapter: String, reason: String },
    #[error("the device was lost: {0}")]
    Lost(String),
    #[error("{what} takes {bytes} bytes, more than the {limit} that {adapter} can bind at once")]
    TooLarge { what: String, bytes: u64, limit: u64, adapter: String },
    #[error("the device ran out of memory while {0}")]
    OutOfMemory(String),
    #[error("the device reported an error while {doing}: {reason}")]
    Device { doing: String, reason: String },
    #[error("{0} is not a surface of the set")]
    NoSuchSurface(usize),
    #[error(
        "surface {index} has another degree or another number of control points or knot spans than before"
    )]
    OtherShape { index: usize },
    #[error("cannot write the picture: {0}")]
    Picture(String),
}

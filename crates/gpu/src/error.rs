//! Why the GPU could not be used; each message is one sentence.

/// What went wrong between here and the device.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter at all, or none of the kind asked for.
    #[error(
        "no Vulkan device was found{asked}; install a graphics driver, or Mesa's software device: \
         `apt-get install mesa-vulkan-drivers libvulkan1` (Debian, Ubuntu), `dnf install mesa-vulkan-drivers \
         vulkan-loader` (Fedora), `pacman -S vulkan-swrast vulkan-icd-loader` (Arch)"
    )]
    NoDevice {
        /// Empty, or what was asked for in words that continue the sentence.
        asked: String,
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

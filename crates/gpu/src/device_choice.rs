//! Which devices may be used, and through which interfaces of the operating system they are reached.

use std::fmt;

/// Which kind of adapter may be used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DeviceChoice {
    /// Hardware if there is any, else software.
    #[default]
    Best,
    /// Discrete, integrated or virtual GPUs only.
    Hardware,
    /// Software only (Mesa lavapipe, SwiftShader, WARP).
    Software,
}

/// Continues "no device": ` in hardware`, ` in software`, or nothing.
impl fmt::Display for DeviceChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Best => "",
            Self::Hardware => " in hardware",
            Self::Software => " in software",
        })
    }
}

/// The interfaces that this build reaches devices through, in words.
pub const BACKENDS: &str = if cfg!(target_vendor = "apple") {
    "Metal"
} else if cfg!(windows) {
    "Vulkan or Direct3D 12"
} else if cfg!(target_arch = "wasm32") {
    "WebGPU"
} else {
    "Vulkan"
};

/// What a user can do where no device is found.
pub(crate) const ADVICE: &str = if cfg!(target_vendor = "apple") {
    "Metal needs macOS 10.13 or newer"
} else if cfg!(windows) {
    "install a graphics driver"
} else if cfg!(target_arch = "wasm32") {
    "use a browser with WebGPU"
} else {
    "install a graphics driver, or Mesa's software device: `apt-get install mesa-vulkan-drivers libvulkan1` \
     (Debian, Ubuntu), `dnf install mesa-vulkan-drivers vulkan-loader` (Fedora), \
     `pacman -S vulkan-swrast vulkan-icd-loader` (Arch)"
};

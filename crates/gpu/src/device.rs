//! The device: the choice of an adapter, the capabilities that it must have, and its errors.

use crate::device_choice::DeviceChoice;
use crate::error::{Capability, GpuError, Task};
use std::sync::{Arc, Mutex};
use wgpu::{Adapter, DeviceType, DownlevelFlags, Features, Limits};

/// A device with its queue.
#[derive(Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    name: String,
    software: bool,
    lost: Arc<Mutex<Option<String>>>,
}

/// Bytes of immediate data that the kernels use.
const IMMEDIATES: u32 = 64;

impl Gpu {
    /// Opens the best adapter of the requested kind.
    ///
    /// # Errors
    /// [`GpuError::NoDevice`] where there is none, [`GpuError::Lacks`] where it cannot compute,
    /// [`GpuError::Refused`] where the driver refuses.
    pub fn open(choice: DeviceChoice) -> Result<Self, GpuError> {
        Self::open_within(choice, u64::MAX)
    }

    /// As [`Self::open`], with a device that binds at most `binding` bytes at once, as if the adapter could
    /// do no more.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_within(choice: DeviceChoice, binding: u64) -> Result<Self, GpuError> {
        pollster::block_on(Self::open_async(choice, binding))
    }

    /// As [`Self::open_within`], without blocking: browsers allow nothing else.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub async fn open_async(choice: DeviceChoice, binding: u64) -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::PRIMARY,
            flags: wgpu::InstanceFlags::empty(),
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = instance.enumerate_adapters(wgpu::Backends::PRIMARY).await;
        let adapter = chosen(adapters, choice).ok_or(GpuError::NoDevice { choice })?;
        Self::from_adapter(&adapter, binding).await
    }

    async fn from_adapter(adapter: &Adapter, binding: u64) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let name = if info.driver.is_empty() {
            info.name.clone()
        } else {
            format!("{} ({} {})", info.name, info.driver, info.driver_info)
        };
        let computes = adapter.get_downlevel_capabilities().flags.contains(DownlevelFlags::COMPUTE_SHADERS);
        let mut limits = adapter.limits();
        if let Some(what) = missing(computes, adapter.features(), &limits) {
            return Err(GpuError::Lacks { adapter: name, what });
        }
        limits.max_storage_buffer_binding_size = limits.max_storage_buffer_binding_size.min(binding);
        let required = Features::IMMEDIATES;
        let optional = Features::SHADER_F64 | Features::TIMESTAMP_QUERY | Features::MULTI_DRAW_INDIRECT_COUNT;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("chordal"),
            required_features: required | (adapter.features() & optional),
            required_limits: limits,
            ..Default::default()
        };
        let (device, queue) = adapter
            .request_device(&descriptor)
            .await
            .map_err(|e| GpuError::Refused { adapter: name.clone(), reason: e.to_string() })?;
        let lost = Arc::new(Mutex::new(None));
        let slot_of_callback = lost.clone();
        device.set_device_lost_callback(move |reason, message| {
            if let Ok(mut slot) = slot_of_callback.lock() {
                *slot = Some(format!("{reason:?} {message}").trim().to_owned());
            }
        });
        Ok(Self { device, queue, name, software: info.device_type == DeviceType::Cpu, lost })
    }

    /// The adapter's name with its driver.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// True where the device is a program on the CPU.
    pub fn is_software(&self) -> bool {
        self.software
    }

    /// True where shaders can calculate in double precision.
    pub fn has_f64(&self) -> bool {
        self.device.features().contains(Features::SHADER_F64)
    }

    /// The largest storage binding in bytes.
    pub fn binding_limit(&self) -> u64 {
        let limits = self.device.limits();
        limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
    }

    /// # Errors
    /// [`GpuError::Lost`] if the device was lost.
    pub fn check(&self) -> Result<(), GpuError> {
        match self.lost.lock().ok().and_then(|slot| slot.clone()) {
            Some(reason) => Err(GpuError::Lost(reason)),
            None => Ok(()),
        }
    }

    /// Waits until everything submitted is done.
    ///
    /// # Errors
    /// [`GpuError::Lost`] if the device was lost.
    pub fn wait(&self) -> Result<(), GpuError> {
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        polled.map(|_| ()).map_err(|e| GpuError::Lost(e.to_string()))
    }

    /// Runs `work` and returns an error where the device reports one.
    ///
    /// # Errors
    /// What `work` returns, [`GpuError::Lost`], [`GpuError::OutOfMemory`] or [`GpuError::Device`].
    pub fn watched<T>(&self, task: Task, work: impl FnOnce() -> Result<T, GpuError>) -> Result<T, GpuError> {
        self.check()?;
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = work();
        let errors = [validation, internal, memory].map(|scope| pollster::block_on(scope.pop()));
        self.check()?;
        match errors.into_iter().flatten().next() {
            None => result,
            Some(wgpu::Error::OutOfMemory { .. }) => Err(GpuError::OutOfMemory(task)),
            Some(error) => Err(GpuError::Device { task, reason: error.to_string() }),
        }
    }
}

/// The first adapter of the best rank that the choice allows.
fn chosen(adapters: Vec<Adapter>, choice: DeviceChoice) -> Option<Adapter> {
    let rank = |adapter: &Adapter| match adapter.get_info().device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    };
    let allowed = |adapter: &Adapter| match choice {
        DeviceChoice::Best => true,
        DeviceChoice::Hardware => rank(adapter) < 4,
        DeviceChoice::Software => rank(adapter) == 4,
    };
    adapters.into_iter().filter(allowed).min_by_key(rank)
}

/// What the kernels need and an adapter does not have.
fn missing(computes: bool, features: Features, limits: &Limits) -> Option<Capability> {
    if !computes {
        return Some(Capability::ComputeShaders);
    }
    if !features.contains(Features::IMMEDIATES) {
        return Some(Capability::ImmediateData);
    }
    let needs = [
        (limits.max_compute_invocations_per_workgroup, 64, Capability::Workgroups as fn(u32) -> Capability),
        (limits.max_storage_buffers_per_shader_stage, 8, Capability::StorageBuffers),
        (limits.max_immediate_size, IMMEDIATES, Capability::ImmediateBytes),
        (limits.max_texture_dimension_2d, 2048, Capability::Textures),
    ];
    needs.into_iter().find(|(has, needs, _)| has < needs).map(|(has, _, lacks)| lacks(has))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device_choice::BACKENDS;

    #[test]
    fn what_is_missing_is_named() {
        let needs = |limits: &Limits| missing(true, Features::IMMEDIATES, limits);
        assert_eq!(needs(&Limits::default()), Some(Capability::ImmediateBytes(0)));
        let mut limits = Limits { max_immediate_size: 128, ..Limits::default() };
        assert_eq!(needs(&limits), None);
        limits.max_compute_invocations_per_workgroup = 0;
        assert_eq!(needs(&limits), Some(Capability::Workgroups(0)));
        limits = Limits::downlevel_webgl2_defaults();
        assert_eq!(missing(false, Features::IMMEDIATES, &limits), Some(Capability::ComputeShaders));
        let reason = missing(true, Features::empty(), &limits);
        assert_eq!(reason, Some(Capability::ImmediateData));
        let sentence = GpuError::Lacks { adapter: "an old card".into(), what: Capability::ComputeShaders };
        assert_eq!(sentence.to_string(), "the adapter an old card cannot be used: it lacks compute shaders");
        let few = Capability::Workgroups(32).to_string();
        assert_eq!(few, "compute workgroups of 64 (it has 32)");
    }

    #[test]
    fn a_missing_device_is_reported_with_advice() {
        let sentence = GpuError::NoDevice { choice: DeviceChoice::Software }.to_string();
        let start = format!("no {BACKENDS} device was found in software; ");
        assert!(sentence.starts_with(&start), "{sentence}");
        if cfg!(target_os = "linux") {
            assert!(sentence.contains("apt-get install mesa-vulkan-drivers libvulkan1"), "{sentence}");
        }
    }
}

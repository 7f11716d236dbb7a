//! The graphics device that renders: chosen, opened, and watched for errors and loss.
//!
//! It is a device of its own, beside the one the window draws with: neither can take the other down.

use super::GpuError;
use crate::task::{self, Bell};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Storage bindings that one kernel uses: the least that WebGPU promises.
const STORAGE_BUFFERS: u32 = 8;

/// What went wrong on a device outside of error scopes.
#[derive(Debug, Default)]
struct Mishaps {
    lost: Mutex<Option<String>>,
    error: Mutex<Option<GpuError>>,
    any: AtomicBool,
}

impl Mishaps {
    /// The device is lost, unless that is known already.
    fn lose(&self, why: String) {
        self.lost.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(why);
        self.any.store(true, Relaxed);
    }
}

/// An open device.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// The adapter's name and kind.
    pub info: wgpu::AdapterInfo,
    /// What the device allows.
    pub limits: wgpu::Limits,
    mishaps: Arc<Mishaps>,
}

impl Gpu {
    /// Opens the best adapter; one that runs on the processor only if `software` is welcome.
    ///
    /// # Errors
    /// If there is none, it cannot run the kernels, or it gives no device.
    pub async fn open(software: bool) -> Result<Self, GpuError> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::PRIMARY;
        let instance = wgpu::Instance::new(descriptor);
        let options = wgpu::RequestAdapterOptions { power_preference: wgpu::PowerPreference::HighPerformance, ..Default::default() };
        let adapter = instance.request_adapter(&options).await.map_err(|error| GpuError::NoAdapter(error.to_string()))?;
        Self::open_on(&adapter, software).await
    }

    /// Opens a given adapter.
    ///
    /// # Errors
    /// If it cannot run the kernels, gives no device, or runs on the processor and `software` is not welcome.
    pub async fn open_on(adapter: &wgpu::Adapter, software: bool) -> Result<Self, GpuError> {
        let (info, limits) = (named(adapter.get_info()), adapter.limits());
        check(&info, &limits, adapter.get_downlevel_capabilities().flags)?;
        if !software && info.device_type == wgpu::DeviceType::Cpu {
            return Err(GpuError::SoftwareOnly(info.name));
        }
        let descriptor =
            wgpu::DeviceDescriptor { label: Some("renderer"), required_limits: wanted(&limits), ..wgpu::DeviceDescriptor::default() };
        let (device, queue) = adapter.request_device(&descriptor).await.map_err(|error| GpuError::NoDevice(error.to_string()))?;
        let mishaps = Arc::new(Mishaps::default());
        let on_lost = Arc::clone(&mishaps);
        device.set_device_lost_callback(move |reason, message| {
            let text = if message.is_empty() { format!("{reason:?}").to_lowercase() } else { message };
            on_lost.lose(text);
        });
        let on_error = Arc::clone(&mishaps);
        device.on_uncaptured_error(Arc::new(move |error| {
            on_error.error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(of(error, "its buffers"));
            on_error.any.store(true, Relaxed);
        }));
        let limits = device.limits();
        Ok(Self { device, queue, info, limits, mishaps })
    }

    /// Did anything go wrong since it was opened?
    ///
    /// # Errors
    /// The loss of the device, or else the first error that no scope caught.
    pub fn check(&self) -> Result<(), GpuError> {
        // A loss is told when the device is polled.
        drop(self.device.poll(wgpu::PollType::Poll));
        if !self.mishaps.any.load(Relaxed) {
            return Ok(());
        }
        if let Some(why) = self.mishaps.lost.lock().unwrap_or_else(PoisonError::into_inner).clone() {
            return Err(GpuError::Lost(why));
        }
        self.mishaps.error.lock().unwrap_or_else(PoisonError::into_inner).clone().map_or(Ok(()), Err)
    }

    /// Is it this very device? (wgpu's handles count anew in every instance.)
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.mishaps, &other.mishaps)
    }

    /// Waits for a submission, or for all; in a page until `bell`, which is to be rung when it is done, rings, but not for long.
    pub(super) async fn wait(&self, submission_index: Option<wgpu::SubmissionIndex>, bell: &Bell) -> Result<(), GpuError> {
        if !task::THREADS {
            bell.rest(Some(Duration::from_millis(500))).await;
            return self.check();
        }
        let polled = self.device.poll(wgpu::PollType::Wait { submission_index, timeout: None });
        if let Err(error) = polled {
            // A device that cannot be waited for has dropped its work, and may tell so later.
            self.mishaps.lose(error.to_string());
        }
        self.check()
    }

    /// Does it run on the processor?
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Runs `make` and returns what it makes, or why the device would not; `what` is being made.
    pub(super) async fn guarded<T>(&self, what: &'static str, make: impl FnOnce() -> T) -> Result<T, GpuError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let made = make();
        // All end at once: what others do while the answers come is not for these scopes.
        let (internal, validation, memory) = (internal.pop(), validation.pop(), memory.pop());
        let errors = [internal.await, validation.await, memory.await];
        self.check()?;
        errors.into_iter().flatten().next().map_or(Ok(made), |error| Err(of(error, what)))
    }
}

/// With a name: many browsers keep it to themselves.
fn named(info: wgpu::AdapterInfo) -> wgpu::AdapterInfo {
    let name = if info.name.is_empty() { "the browser's (WebGPU)".to_owned() } else { info.name };
    wgpu::AdapterInfo { name, ..info }
}

fn of(error: wgpu::Error, what: &'static str) -> GpuError {
    match error {
        wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory(what),
        wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => GpuError::Refused(description),
    }
}

/// Can the adapter run the kernels at all?
///
/// # Errors
/// If it has no compute shaders (WebGL2 has none), or too small ones.
pub fn check(info: &wgpu::AdapterInfo, limits: &wgpu::Limits, flags: wgpu::DownlevelFlags) -> Result<(), GpuError> {
    let fail = |lacks: String| Err(GpuError::CannotCompute { adapter: info.name.clone(), lacks });
    if !flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS) {
        return fail("compute shaders".to_owned());
    }
    if limits.max_storage_buffers_per_shader_stage < STORAGE_BUFFERS {
        return fail(format!(
            "storage buffers: it has {} per kernel, {STORAGE_BUFFERS} are needed",
            limits.max_storage_buffers_per_shader_stage
        ));
    }
    if limits.max_compute_invocations_per_workgroup < 64 {
        return fail(format!("workgroups of 64 invocations: it has {}", limits.max_compute_invocations_per_workgroup));
    }
    Ok(())
}

/// WebGPU's default limits, but buffers as large as the adapter can have them.
fn wanted(adapter: &wgpu::Limits) -> wgpu::Limits {
    wgpu::Limits {
        max_buffer_size: adapter.max_buffer_size,
        max_storage_buffer_binding_size: adapter.max_storage_buffer_binding_size,
        ..wgpu::Limits::default().or_worse_values_from(adapter)
    }
}

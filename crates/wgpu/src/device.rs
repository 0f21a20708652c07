//! A device of one's own, and what devices say is wrong.

use crate::Error;

/// A device without a window, for programs that have none of their own.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// Where the adapter comes from.
    pub instance: wgpu::Instance,
    /// What the device is of.
    pub adapter: wgpu::Adapter,
    /// Makes buffers and pipelines.
    pub device: wgpu::Device,
    /// Takes what was recorded.
    pub queue: wgpu::Queue,
}

/// Features that are used where they are there: [`Timer`](crate::Timer) needs time stamps, and nothing else anything.
pub const WANTED_FEATURES: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY;

impl Gpu {
    /// The adapter that the system prefers for heavy work, with [`WANTED_FEATURES`] where it has them
    /// and the largest limits it allows. `WGPU_BACKEND`, `WGPU_ADAPTER_NAME` and the other variables of
    /// wgpu are heeded. Some tens of milliseconds.
    ///
    /// # Errors
    /// If there is no adapter, or it gives no device.
    pub fn request() -> Result<Self, Error> {
        let flags = wgpu::InstanceFlags::empty().with_env();
        Self::request_with(flags, &|_| {})
    }

    /// The same with flags of wgpu's, as for validation, and with limits that `adjust` has lowered.
    ///
    /// # Errors
    /// If there is no adapter, or it gives no device.
    pub fn request_with(
        flags: wgpu::InstanceFlags,
        adjust: &dyn Fn(&mut wgpu::Limits),
    ) -> Result<Self, Error> {
        // Otherwise wgpu panics.
        if wgpu::Instance::enabled_backend_features().is_empty() {
            let reason = "no backend was built in (feature native)".to_owned();
            return Err(Error::NoAdapter { reason });
        }
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            flags,
            ..wgpu::InstanceDescriptor::new_without_display_handle_from_env()
        });
        let adapter = pollster::block_on(find_adapter(&instance))?;
        let mut limits = adapter.limits();
        adjust(&mut limits);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("drypoint"),
            required_features: adapter.features() & WANTED_FEATURES,
            required_limits: limits,
            ..Default::default()
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| {
                Error::NoDevice { adapter: adapter.get_info().name, reason: error.to_string() }
            })?;
        Ok(Self { instance, adapter, device, queue })
    }

    /// Name of the adapter and of its driver, and whether it is software.
    pub fn name(&self) -> String {
        let info = self.adapter.get_info();
        let software = if self.is_software() { ", software" } else { "" };
        format!("{} ({:?}, {}{software})", info.name, info.backend, info.driver_info)
    }

    /// Whether a processor does the work: its times say nothing about GPUs.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }
}

async fn find_adapter(instance: &wgpu::Instance) -> Result<wgpu::Adapter, Error> {
    if let Ok(name) = std::env::var("WGPU_ADAPTER_NAME") {
        // As wgpu's own helper, which panics if there is none of that name.
        let wanted = name.to_lowercase();
        let is_wanted =
            |adapter: &wgpu::Adapter| adapter.get_info().name.to_lowercase().contains(&wanted);
        let named = instance.enumerate_adapters(wgpu::Backends::all()).await;
        let reason = format!("none has {name:?} in its name, as WGPU_ADAPTER_NAME says");
        return named.into_iter().find(is_wanted).ok_or(Error::NoAdapter { reason });
    }
    let options = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..Default::default()
    };
    let adapter = instance.request_adapter(&options).await;
    adapter.map_err(|error| Error::NoAdapter { reason: error.to_string() })
}

/// What `make` gives, or what the device said about it.
pub(crate) fn checked<T>(
    device: &wgpu::Device,
    what: &'static str,
    make: impl FnOnce() -> T,
) -> Result<T, Error> {
    let filters = [
        wgpu::ErrorFilter::OutOfMemory,
        wgpu::ErrorFilter::Internal,
        wgpu::ErrorFilter::Validation,
    ];
    let scopes = filters.map(|filter| device.push_error_scope(filter));
    let made = make();
    // All are popped, the last one first.
    let found = scopes.into_iter().rev().filter_map(|scope| pollster::block_on(scope.pop()));
    match found.collect::<Vec<_>>().pop() {
        None => Ok(made),
        Some(wgpu::Error::OutOfMemory { .. }) => Err(Error::OutOfMemory { what }),
        Some(_) if is_lost(device) => Err(Error::DeviceLost),
        Some(error) => Err(Error::Refused { what, reason: error.to_string() }),
    }
}

/// Whether the device is lost: nothing can be written to what it makes. To be asked when something failed,
/// as the callback that tells is the caller's.
fn is_lost(device: &wgpu::Device) -> bool {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("a sign of life"),
        size: 4,
        usage: wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: true,
    });
    let is_lost = buffer.get_mapped_range_mut(..).is_err();
    pollster::block_on(scope.pop()).is_some() || is_lost
}

/// A buffer with `size` bytes, or at least 16, that may hold more than the device allows.
pub(crate) fn buffer(
    device: &wgpu::Device,
    what: &'static str,
    size: u64,
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, Error> {
    allow(device, what, size, usage)?;
    let descriptor = wgpu::BufferDescriptor {
        label: Some(what),
        size: size.max(16),
        usage,
        mapped_at_creation: false,
    };
    checked(device, what, || device.create_buffer(&descriptor))
}

/// A buffer that holds `content`.
pub(crate) fn filled<T: bytemuck::Pod>(
    device: &wgpu::Device,
    what: &'static str,
    content: &[T],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, Error> {
    beginning_with(device, what, content, (0, usage))
}

/// A buffer that begins with `content` and has at least `size` bytes.
pub(crate) fn beginning_with<T: bytemuck::Pod>(
    device: &wgpu::Device,
    what: &'static str,
    content: &[T],
    (size, usage): (u64, wgpu::BufferUsages),
) -> Result<wgpu::Buffer, Error> {
    let bytes: &[u8] = bytemuck::cast_slice(content);
    let size = (bytes.len() as u64).max(size).max(16);
    allow(device, what, size, usage)?;
    let descriptor =
        wgpu::BufferDescriptor { label: Some(what), size, usage, mapped_at_creation: true };
    let buffer = checked(device, what, || device.create_buffer(&descriptor))?;
    {
        let mut view = buffer
            .slice(..bytes.len() as u64)
            .get_mapped_range_mut()
            .map_err(|_| Error::DeviceLost)?;
        view.copy_from_slice(bytes);
    }
    buffer.unmap();
    Ok(buffer)
}

/// Fails if a buffer would be larger than the device allows.
pub(crate) fn allow(
    device: &wgpu::Device,
    what: &'static str,
    bytes: u64,
    usage: wgpu::BufferUsages,
) -> Result<(), Error> {
    let limit = if usage.contains(wgpu::BufferUsages::STORAGE) {
        largest_storage(&device.limits())
    } else {
        device.limits().max_buffer_size
    };
    if bytes > limit { Err(Error::TooLarge { what, bytes, limit }) } else { Ok(()) }
}

/// Bytes that one storage binding may have.
pub(crate) fn largest_storage(limits: &wgpu::Limits) -> u64 {
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}

//! GPU time of a pass.

use std::time::Duration;

use crate::Error;
use crate::device::buffer;
use crate::readback::Readback;

/// Measures a pass by time stamps of the GPU, and never waits for them.
#[derive(Debug)]
pub struct Timer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readback: Readback,
    /// Nanoseconds for one tick.
    period: f32,
}

/// Two time stamps.
const SIZE: u64 = 16;

impl Timer {
    /// For passes of `device`.
    ///
    /// # Errors
    /// [`Error::MissingFeature`] if the device has no [`wgpu::Features::TIMESTAMP_QUERY`].
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, Error> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Err(Error::MissingFeature { feature: "time stamps", what: "a timer" });
        }
        let descriptor = wgpu::QuerySetDescriptor {
            label: Some("drypoint timer"),
            ty: wgpu::QueryType::Timestamp,
            count: 2,
        };
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        Ok(Self {
            queries: crate::device::checked(device, "a timer", || {
                device.create_query_set(&descriptor)
            })?,
            resolved: buffer(device, "a timer", SIZE, usage)?,
            readback: Readback::new(device, "a timer's answer", SIZE)?,
            period: queue.get_timestamp_period(),
        })
    }

    /// For the descriptor of the compute pass that is to be measured.
    pub fn compute_pass(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    /// For the descriptor of the render pass that is to be measured.
    pub fn render_pass(&self) -> wgpu::RenderPassTimestampWrites<'_> {
        wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    /// Asks for the time of the pass that `encoder` holds by now.
    pub fn request(&mut self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2, &self.resolved, 0);
        self.readback.request(encoder, &self.resolved);
    }

    /// The newest time that has come since the last call.
    pub fn newest(&mut self) -> Option<Duration> {
        let period = f64::from(self.period);
        self.readback.newest(|bytes| {
            let [begin, end]: [u64; 2] = bytemuck::pod_read_unaligned(&bytes[..16]);
            Duration::from_secs_f64(end.saturating_sub(begin) as f64 * period * 1e-9)
        })
    }
}

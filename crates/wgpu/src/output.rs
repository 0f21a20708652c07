//! What a frame finds, as it lies in memory: segments, arguments and counts.

use drypoint_shaders::{Arguments, Counters, Segment, Statistics, Totals};
use wgpu::BufferUsages;

use crate::Error;
use crate::device::{buffer, checked};
use crate::readback::Readback;

/// Buffers that extraction writes.
#[derive(Debug)]
pub(crate) struct Output {
    pub(crate) device: wgpu::Device,
    /// Segments that fit.
    pub(crate) capacity: u32,
    pub(crate) counters: wgpu::Buffer,
    pub(crate) totals: wgpu::Buffer,
    pub(crate) arguments: wgpu::Buffer,
    pub(crate) segments: wgpu::Buffer,
    readback: Readback,
}

impl Output {
    pub(crate) fn new(device: &wgpu::Device, capacity: u32) -> Result<Self, Error> {
        let read = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        let make = |what, size: usize, usage| buffer(device, what, size as u64, usage);
        let size = u64::from(capacity) * size_of::<Segment>() as u64;
        Ok(Self {
            device: device.clone(),
            capacity,
            counters: make("counters", size_of::<Counters>(), read)?,
            totals: make("totals", size_of::<Totals>(), read)?,
            arguments: make("arguments", size_of::<Arguments>(), read | BufferUsages::INDIRECT)?,
            segments: buffer(device, "segments", size, read | BufferUsages::VERTEX)?,
            readback: Readback::new(device, "statistics", size_of::<Totals>() as u64)?,
        })
    }

    /// Records that nothing is found yet.
    pub(crate) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        for counted in [&self.counters, &self.totals, &self.arguments] {
            encoder.clear_buffer(counted, 0, None);
        }
    }

    pub(crate) fn request_statistics(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.readback.request(encoder, &self.totals);
    }

    pub(crate) fn newest_statistics(&mut self) -> Option<Statistics> {
        let capacity = self.capacity;
        self.readback.newest(|bytes| Statistics::new(&totals_of(bytes), capacity))
    }

    pub(crate) fn read_statistics(&self, queue: &wgpu::Queue) -> Result<Statistics, Error> {
        let size = size_of::<Totals>() as u64;
        let bytes = read(&self.device, queue, &self.totals, size)?;
        Ok(Statistics::new(&totals_of(&bytes), self.capacity))
    }

    pub(crate) fn read_segments(&self, queue: &wgpu::Queue) -> Result<Vec<Segment>, Error> {
        let size = self.read_count(queue)? * size_of::<Segment>() as u64;
        let bytes = read(&self.device, queue, &self.segments, size)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    /// The number of segments, if all of them fit.
    pub(crate) fn read_count(&self, queue: &wgpu::Queue) -> Result<u64, Error> {
        let statistics = self.read_statistics(queue)?;
        match statistics.overflow() {
            Some(needed) => Err(Error::Overflow { needed, capacity: self.capacity }),
            None => Ok(statistics.segments),
        }
    }
}

fn totals_of(bytes: &[u8]) -> Totals {
    bytemuck::pod_read_unaligned(&bytes[..size_of::<Totals>()])
}

/// Waits for the GPU and reads the first bytes of a buffer.
pub(crate) fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    source: &wgpu::Buffer,
    size: u64,
) -> Result<Vec<u8>, Error> {
    if size == 0 {
        return Ok(Vec::new());
    }
    let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
    let descriptor = wgpu::BufferDescriptor {
        label: Some("what is read back"),
        size,
        usage,
        mapped_at_creation: false,
    };
    let (sender, receiver) = std::sync::mpsc::channel();
    let copy = checked(device, "what is read back", || {
        let copy = device.create_buffer(&descriptor);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(source, 0, &copy, 0, size);
        queue.submit([encoder.finish()]);
        copy.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // Nobody listens any more if polling failed.
            let _ = sender.send(result);
        });
        copy
    })?;
    device.poll(wgpu::PollType::wait_indefinitely()).map_err(|_| Error::DeviceLost)?;
    let mapped = receiver.try_recv().map_err(|_| Error::DeviceLost)?;
    mapped.map_err(|_| Error::DeviceLost)?;
    let view = copy.slice(..).get_mapped_range().map_err(|_| Error::DeviceLost)?;
    Ok(view.to_vec())
}

//! Memory through which each frame's input goes to the GPU, used again as soon as that has read it.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use crate::Error;
use crate::device::checked;

/// Mapped, and free to be written.
const FREE: u8 = 0;
/// Handed to the GPU.
const BUSY: u8 = 1;
/// Could not be mapped: the device is lost.
const LOST: u8 = 2;
/// Handed over in an encoder that was dropped: no longer mapped, and free to be mapped again.
const ABANDONED: u8 = 3;

/// Buffers of one size. There come to be as many as frames are under way at once.
#[derive(Debug)]
pub(crate) struct Staging {
    size: u64,
    slots: Vec<Slot>,
}

#[derive(Debug)]
struct Slot {
    buffer: wgpu::Buffer,
    state: Arc<AtomicU8>,
}

/// Tells what becomes of a buffer: that it is mapped, or that nobody ever will map it.
struct Report {
    state: Arc<AtomicU8>,
    outcome: u8,
}

impl Report {
    fn new(state: &Arc<AtomicU8>) -> Self {
        state.store(BUSY, Ordering::Release);
        Self { state: Arc::clone(state), outcome: ABANDONED }
    }

    fn mapped<E>(mut self, result: &Result<(), E>) {
        self.outcome = if result.is_ok() { FREE } else { LOST };
    }
}

impl Drop for Report {
    fn drop(&mut self) {
        self.state.store(self.outcome, Ordering::Release);
    }
}

impl Staging {
    /// Of buffers of `size` bytes, a multiple of 4. The first ones are made at once.
    pub(crate) fn new(device: &wgpu::Device, size: u64) -> Result<Self, Error> {
        let mut staging = Self { size, slots: Vec::new() };
        for _ in 0..3 {
            staging.add(device)?;
        }
        Ok(staging)
    }

    /// Number of buffers.
    pub(crate) fn count(&self) -> usize {
        self.slots.len()
    }

    fn add(&mut self, device: &wgpu::Device) -> Result<usize, Error> {
        let what = "the input of a frame";
        let descriptor = wgpu::BufferDescriptor {
            label: Some(what),
            size: self.size,
            usage: wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: true,
        };
        let buffer = checked(device, what, || device.create_buffer(&descriptor))?;
        self.slots.push(Slot { buffer, state: Arc::new(AtomicU8::new(FREE)) });
        Ok(self.slots.len() - 1)
    }

    /// Copies the bytes of each piece to its place in `target`, when the GPU comes to `encoder`.
    pub(crate) fn write<'a>(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::Buffer,
        pieces: impl IntoIterator<Item = (u64, &'a [u8])> + Clone,
    ) -> Result<(), Error> {
        // Free from the next poll of the device on.
        let is_abandoned = |slot: &&Slot| slot.state.load(Ordering::Acquire) == ABANDONED;
        for Slot { buffer, state } in self.slots.iter().filter(is_abandoned) {
            let report = Report::new(state);
            buffer.map_async(wgpu::MapMode::Write, .., move |result| report.mapped(&result));
        }
        let states = || self.slots.iter().map(|slot| slot.state.load(Ordering::Acquire));
        if states().any(|state| state == LOST) {
            return Err(Error::DeviceLost);
        }
        let index = match states().position(|state| state == FREE) {
            Some(index) => index,
            None => self.add(device)?,
        };
        let Slot { buffer, state } = &self.slots[index];
        let pieces = || pieces.clone().into_iter().filter(|(_, bytes)| !bytes.is_empty());
        for (offset, bytes) in pieces() {
            let range = offset..offset + bytes.len() as u64;
            let mut view =
                buffer.slice(range).get_mapped_range_mut().map_err(|_| Error::DeviceLost)?;
            view.copy_from_slice(bytes);
        }
        buffer.unmap();
        for (offset, bytes) in pieces() {
            encoder.copy_buffer_to_buffer(buffer, offset, target, offset, bytes.len() as u64);
        }
        let report = Report::new(state);
        encoder.map_buffer_on_submit(buffer, wgpu::MapMode::Write, .., move |result| {
            report.mapped(&result);
        });
        Ok(())
    }
}

//! Small results that come back from the GPU some frames later, without waiting.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::Error;
use crate::device::buffer;

/// Of a slot that holds nothing.
const FREE: u64 = 0;
/// Of a slot that the GPU has yet to fill.
const BUSY: u64 = u64::MAX;

/// Buffers for what was asked for and has not come yet.
#[derive(Debug)]
pub(crate) struct Readback {
    size: u64,
    slots: Vec<Slot>,
    /// Number of the last request; they count from 1.
    requests: u64,
}

#[derive(Debug)]
struct Slot {
    buffer: wgpu::Buffer,
    /// The number of the request that it has the answer to, or one of the two above.
    state: Arc<AtomicU64>,
}

/// Tells what becomes of a request: its number when the answer is there, or that none will ever come.
struct Report {
    state: Arc<AtomicU64>,
    outcome: u64,
}

impl Report {
    fn answered(mut self, outcome: u64) {
        self.outcome = outcome;
    }
}

impl Drop for Report {
    fn drop(&mut self) {
        self.state.store(self.outcome, Ordering::Release);
    }
}

impl Readback {
    /// For answers of `size` bytes, as many at once as a few frames ask for.
    pub(crate) fn new(device: &wgpu::Device, what: &'static str, size: u64) -> Result<Self, Error> {
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let slot =
            |_| Ok(Slot { buffer: buffer(device, what, size, usage)?, state: Arc::default() });
        Ok(Self { size, slots: (0..4).map(slot).collect::<Result<_, Error>>()?, requests: 0 })
    }

    /// Asks for the first bytes of `source` as they are when the GPU comes to this place of `encoder`.
    /// `false`, and nothing is asked, if all slots wait for the GPU: the answers to these are newer than
    /// what one could use anyhow.
    pub(crate) fn request(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        source: &wgpu::Buffer,
    ) -> bool {
        let is_free = |slot: &&Slot| slot.state.load(Ordering::Acquire) == FREE;
        let Some(slot) = self.slots.iter().find(is_free) else { return false };
        self.requests += 1;
        encoder.copy_buffer_to_buffer(source, 0, &slot.buffer, 0, self.size);
        slot.state.store(BUSY, Ordering::Release);
        // Of an encoder that is dropped, the slot is free again.
        let report = Report { state: Arc::clone(&slot.state), outcome: FREE };
        let number = self.requests;
        encoder.map_buffer_on_submit(&slot.buffer, wgpu::MapMode::Read, .., move |result| {
            // After a loss nothing comes any more.
            report.answered(if result.is_ok() { number } else { BUSY });
        });
        true
    }

    /// The newest answer that has come since the last call, through `read`.
    pub(crate) fn newest<T>(&mut self, read: impl Fn(&[u8]) -> T) -> Option<T> {
        let state = |slot: &Slot| slot.state.load(Ordering::Acquire);
        let has_arrived = |state: u64| state != FREE && state != BUSY;
        let last = self.slots.iter().map(state).filter(|&state| has_arrived(state)).max()?;
        let mut newest = None;
        for slot in self.slots.iter().filter(|slot| has_arrived(state(slot)) && state(slot) <= last)
        {
            if state(slot) == last {
                let view = slot.buffer.slice(..self.size).get_mapped_range();
                newest = view.ok().map(|view| read(&view));
            }
            slot.buffer.unmap();
            slot.state.store(FREE, Ordering::Release);
        }
        newest
    }
}

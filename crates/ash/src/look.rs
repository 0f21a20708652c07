//! How lines look, on the GPU.

use std::sync::{Mutex, PoisonError};

use ash::vk;
use ash::vk::BufferUsageFlags as Usage;
use drypoint_shaders::{DepthOrder, LineStyle, Stroke};
use glam::Mat4;

use crate::barrier::Use;
use crate::binding::{Layout, Resource, Set};
use crate::commands::Commands;
use crate::execution::Fate;
use crate::memory::Buffer;
use crate::{Device, Error};

/// A line style, and the matrix to clip space.
#[derive(Debug)]
pub(crate) struct Look {
    buffer: Buffer,
    set: Set,
    /// Of the commands that it was recorded in last.
    recorded: Mutex<Option<Fate>>,
}

impl Look {
    /// Bound by `layout`, which has nothing else.
    pub(crate) fn new(device: &Device, layout: &Layout) -> Result<Self, Error> {
        let buffer = uniform(device, "a line style", size_of::<Stroke>())?;
        let set = Set::new(layout, "the bindings of a line style", &[Resource::Buffer(&buffer)])?;
        Ok(Self { buffer, set, recorded: Mutex::new(None) })
    }

    pub(crate) fn record(&self, commands: &mut Commands, scene_to_clip: Mat4, style: &LineStyle) {
        let stroke = style.stroke(scene_to_clip);
        commands.barrier(Use::ANYTHING, Use::COPIED_TO);
        commands.update(&self.buffer, bytemuck::bytes_of(&stroke));
        commands.barrier(Use::COPIED_TO, Use::READ_BY_DRAWING);
        *self.recorded.lock().unwrap_or_else(PoisonError::into_inner) =
            Some(commands.fate().clone());
    }

    /// Fails if it was never recorded, or in commands that came to nothing.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let recorded = self.recorded.lock().unwrap_or_else(PoisonError::into_inner);
        let fate = recorded.as_ref().ok_or(Error::NoStyle)?;
        fate.check("the look of lines")
    }

    pub(crate) fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    pub(crate) fn set(&self) -> &Set {
        &self.set
    }
}

/// A buffer that is written by commands and read as a uniform.
pub(crate) fn uniform(device: &Device, what: &'static str, size: usize) -> Result<Buffer, Error> {
    Buffer::new(device, what, size as u64, Usage::UNIFORM_BUFFER | Usage::TRANSFER_DST)
}

pub(crate) const fn compare(order: DepthOrder) -> vk::CompareOp {
    match order {
        DepthOrder::Standard => vk::CompareOp::LESS_OR_EQUAL,
        DepthOrder::Reversed => vk::CompareOp::GREATER_OR_EQUAL,
    }
}

//! What goes to the GPU each frame.

use ash::vk::BufferUsageFlags as Usage;
use drypoint_shaders::{Method, Placement, Transform, Work, place};
use glam::Vec4;

use crate::barrier::Use;
use crate::commands::Commands;
use crate::execution::Fate;
use crate::memory::Buffer;
use crate::model::Model;
use crate::{Device, Error};

/// Placements and work of a frame. What is written lies in the command buffer until the GPU comes to it, so
/// that any number of frames may be under way.
#[derive(Debug)]
pub(crate) struct Input {
    pub(crate) viewpoints: Buffer,
    pub(crate) transforms: Buffer,
    pub(crate) work: Buffer,
    /// From one piece of work to the next.
    stride: usize,
    capacity: u32,
    /// As it is being written.
    placed: (Vec<Vec4>, Vec<Transform>),
    bytes: Vec<u8>,
    /// The commands that it is recorded in, if it is, and what becomes of them.
    recorded: Option<(u64, Fate)>,
}

impl Input {
    /// For so many placements, and pieces of work.
    pub(crate) fn new(device: &Device, placements: u32, pieces: usize) -> Result<Self, Error> {
        let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST;
        let buffer = |size: usize| {
            let size = size as u64 * u64::from(placements.max(1));
            Buffer::new(device, "the placements of a frame", size, usage)
        };
        let alignment = device.limits().min_uniform_buffer_offset_alignment.max(16);
        let alignment = usize::try_from(alignment).unwrap_or(256);
        let stride = size_of::<Work>().next_multiple_of(alignment);
        let (size, limit) = ((stride * pieces.max(1)) as u64, u64::from(u32::MAX));
        if size > limit {
            return Err(Error::TooLarge { what: "the work of a frame", bytes: size, limit });
        }
        Ok(Self {
            viewpoints: buffer(size_of::<Vec4>())?,
            transforms: buffer(size_of::<Transform>())?,
            work: Buffer::new(
                device,
                "the work of a frame",
                size,
                Usage::UNIFORM_BUFFER | Usage::TRANSFER_DST,
            )?,
            stride,
            capacity: placements,
            placed: (Vec::new(), Vec::new()),
            bytes: Vec::new(),
            recorded: None,
        })
    }

    /// Takes placements. Those of before are forgotten, also if it fails.
    pub(crate) fn place(
        &mut self,
        model: &Model,
        placements: &[Placement],
        method: Method,
    ) -> Result<(), Error> {
        self.recorded = None;
        let (viewpoints, transforms) = &mut self.placed;
        viewpoints.clear();
        transforms.clear();
        let (given, parts) = (placements.len(), model.part_count());
        if method == Method::Patches && !model.has_patches() && model.edge_count() > 0 {
            return Err(Error::NoPatches);
        }
        if given > self.capacity as usize {
            return Err(Error::TooManyPlacements { given, capacity: self.capacity });
        }
        if !given.is_multiple_of(parts as usize) {
            return Err(Error::UnevenPlacements { given, parts });
        }
        place(model.frames(), placements, viewpoints, transforms)
            .map_err(|index| Error::SingularPlacement { index })
    }

    /// Number of placements taken.
    pub(crate) fn count(&self) -> u32 {
        u32::try_from(self.placed.1.len()).unwrap_or(u32::MAX)
    }

    /// Records the writing of all, after whatever read it before.
    pub(crate) fn record<'a>(
        &mut self,
        commands: &mut Commands,
        work: impl Iterator<Item = &'a Work>,
    ) {
        self.bytes.clear();
        for work in work {
            self.bytes.extend_from_slice(bytemuck::bytes_of(work));
            self.bytes.resize(self.bytes.len().next_multiple_of(self.stride), 0);
        }
        commands.barrier(Use::ANYTHING, Use::COPIED_TO);
        commands.update(&self.viewpoints, bytemuck::cast_slice(&self.placed.0));
        commands.update(&self.transforms, bytemuck::cast_slice(&self.placed.1));
        commands.update(&self.work, &self.bytes);
        self.recorded = Some((commands.id(), commands.fate().clone()));
    }

    /// Fails if it is not recorded in these commands.
    pub(crate) fn check(&self, commands: &Commands) -> Result<(), Error> {
        let id = self.recorded.as_ref().map(|(id, _)| *id);
        if id == Some(commands.id()) { Ok(()) } else { Err(Error::Unprepared) }
    }

    /// Fails if it was recorded nowhere, or in commands that came to nothing.
    pub(crate) fn check_once(&self) -> Result<(), Error> {
        let (_, fate) = self.recorded.as_ref().ok_or(Error::Unprepared)?;
        fate.check("what contours hold")
    }

    /// Where a piece of work begins.
    pub(crate) fn offset(&self, piece: usize) -> u32 {
        u32::try_from(piece * self.stride).expect("offsets in a binding are below 2^32")
    }
}

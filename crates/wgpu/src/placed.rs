//! Segments as positions.

use drypoint_shaders::{Arguments, PlacedSegment};

use crate::Error;
use crate::bindings::bind;
use crate::device::buffer;
use crate::extractor::Extractor;
use crate::found::Found;
use crate::output::read;

/// The segments of contours as positions in the scene, for callers that draw lines of their own.
#[derive(Debug)]
pub struct PlacedContours {
    segments: wgpu::Buffer,
    bindings: wgpu::BindGroup,
}

impl PlacedContours {
    /// Room for all that `contours` has room for, 32 bytes each.
    ///
    /// # Errors
    /// If the GPU has not enough memory, or so many do not fit one buffer.
    pub fn new<'a>(extractor: &Extractor, contours: impl Into<Found<'a>>) -> Result<Self, Error> {
        let found = contours.into();
        let device = extractor.device();
        let usage =
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_SRC;
        let size = u64::from(found.output.capacity) * size_of::<PlacedSegment>() as u64;
        let segments = buffer(device, "placed segments", size.max(32), usage)?;
        let resources = vec![
            found.output.segments.as_entire_binding(),
            found.output.arguments.as_entire_binding(),
            found.positions.as_entire_binding(),
            wgpu::BindingResource::Buffer(found.transforms),
            segments.as_entire_binding(),
        ];
        let label = "the bindings of placed segments";
        let bindings = bind(device, label, extractor.placing_layout(), resources)?;
        Ok(Self { segments, bindings })
    }

    /// Records the placing, into the pass of [`Extractor::record`] after it, or a later one. `contours` must
    /// be those that it was made for.
    pub fn record<'a>(
        &self,
        extractor: &Extractor,
        pass: &mut wgpu::ComputePass<'_>,
        contours: impl Into<Found<'a>>,
    ) {
        pass.set_pipeline(extractor.placing());
        pass.set_bind_group(0, &self.bindings, &[]);
        let arguments = &contours.into().output.arguments;
        pass.dispatch_workgroups_indirect(arguments, Arguments::WORKGROUPS);
    }

    /// [`PlacedSegment`]s, in the order of the segments. Storage and vertex buffer.
    pub fn segments(&self) -> &wgpu::Buffer {
        &self.segments
    }

    /// Waits for the GPU and reads the placed segments of what was submitted last.
    ///
    /// # Errors
    /// [`Error::Overflow`] if not all fit, or if the device is lost.
    pub fn read<'a>(
        &self,
        queue: &wgpu::Queue,
        contours: impl Into<Found<'a>>,
    ) -> Result<Vec<PlacedSegment>, Error> {
        let output = contours.into().output;
        let size = output.read_count(queue)? * size_of::<PlacedSegment>() as u64;
        let bytes = read(&output.device, queue, &self.segments, size)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }
}

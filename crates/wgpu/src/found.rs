//! What is found, whichever kind of model it is of.

use crate::contours::Contours;
use crate::output::Output;
use crate::rig_contours::RigContours;

/// What [`Contours`] or [`RigContours`] have found, for what goes on with it: [`From`] either.
#[derive(Clone, Debug)]
pub struct Found<'a> {
    pub(crate) output: &'a Output,
    pub(crate) positions: &'a wgpu::Buffer,
    pub(crate) transforms: wgpu::BufferBinding<'a>,
    /// Number of instances that were prepared last.
    pub(crate) instances: u32,
    /// Of a rig, the first vertex that is posed and how many each instance has of these.
    pub(crate) posed: [u32; 2],
}

impl<'a> From<&'a Contours> for Found<'a> {
    fn from(contours: &'a Contours) -> Self {
        Self {
            output: contours.output(),
            positions: contours.model().positions(),
            transforms: contours.transforms(),
            instances: contours.placement_count() / contours.model().part_count().max(1),
            posed: [0; 2],
        }
    }
}

impl<'a> From<&'a RigContours> for Found<'a> {
    fn from(contours: &'a RigContours) -> Self {
        let counts = contours.model().layout().counts;
        Self {
            output: contours.output(),
            positions: contours.positions(),
            transforms: contours.transforms(),
            instances: contours.instance_count(),
            posed: [counts.first_vertex, counts.vertex_count],
        }
    }
}

//! What compute shaders have found, as lines one pixel wide.

use ash::vk;
use drypoint_shaders::{Arguments, LineStyle, THIN_LINES};
use glam::Mat4;

use crate::binding::Set;
use crate::commands::Commands;
use crate::contours::Contours;
use crate::look::{Look, compare};
use crate::mesh_pass::Attached;
use crate::pipeline::{Blending, Drawing, Formats, Pipeline};
use crate::rendering::Rendering;
use crate::shader::Shader;
use crate::{Device, Error, layouts};

/// Draws the segments of [`Contours`] by an indirect draw: the second of two passes. The same lines as a
/// [`MeshPass`](crate::MeshPass) draws in one.
#[derive(Debug)]
pub struct LinePass {
    device: Device,
    pipeline: Pipeline,
    look: Look,
}

impl LinePass {
    /// For drawing to such attachments.
    ///
    /// # Errors
    /// If the device cannot draw to such attachments, or refuses a shader.
    pub fn new(device: &Device, attached: &Attached) -> Result<Self, Error> {
        let what = "lines";
        attached.check(device, true)?;
        let shader = Shader::new(device, what, THIN_LINES)?;
        let stroke = layouts::stroke(device)?;
        let drawing = Drawing {
            what,
            stages: &[
                (vk::ShaderStageFlags::VERTEX, &shader, "line_vertex"),
                (vk::ShaderStageFlags::FRAGMENT, &shader, "line_color"),
            ],
            layouts: &[&stroke, &layouts::segments(device)?],
            has_positions: false,
            topology: vk::PrimitiveTopology::LINE_LIST,
            formats: Formats {
                color: Some(attached.color),
                depth: attached.depth.map(|(format, _)| format),
            },
            blending: Blending::Over,
            depth: attached.depth.map(|(_, order)| compare(order)),
        };
        let pipeline = drawing.pipeline(device)?;
        Ok(Self { device: device.clone(), pipeline, look: Look::new(device, &stroke)? })
    }

    /// Records the look of lines, of which the width does not count, and the matrix from the space of the scene to
    /// clip space, for what is recorded from here on. Outside of rendering.
    ///
    /// # Errors
    /// If the commands are of another device.
    pub fn prepare(
        &self,
        commands: &mut Commands,
        scene_to_clip: Mat4,
        style: &LineStyle,
    ) -> Result<(), Error> {
        commands.check(&self.device, "the pass of lines")?;
        self.look.record(commands, scene_to_clip, style);
        Ok(())
    }

    /// Draws what `contours` holds by then.
    ///
    /// # Errors
    /// If rendering is to other attachments than the pass was made for, or of another device; if the contours were not
    /// prepared in these commands; or while mesh shaders are counted.
    pub fn record(&self, rendering: &mut Rendering<'_>, contours: &Contours) -> Result<(), Error> {
        rendering.check(&self.device, "the pass of lines")?;
        contours.input.check(rendering.commands())?;
        self.look.check()?;
        let sets: [(&Set, &[u32]); 2] = [(self.look.set(), &[]), (&contours.segment_set, &[])];
        rendering.bind(&self.pipeline, "the pass of lines", &sets)?;
        rendering.draw_indirect(contours.arguments(), Arguments::LINE_LIST);
        Ok(())
    }
}

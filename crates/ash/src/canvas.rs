//! Lines with width and smooth edges, where no surface hides them.

use ash::vk;
use drypoint_shaders::{Arguments, DepthOrder, INK, LINES, Raster, View};
use glam::Vec2;

use crate::barrier::Use;
use crate::binding::{Layout, Resource, Set};
use crate::commands::Commands;
use crate::depth_pass::{DepthPass, Found, Surface};
use crate::execution::Fate;
use crate::look::Look;
use crate::memory::Image;
use crate::mesh_pass::{Attached, MeshPass};
use crate::pipeline::{Blending, Drawing, Formats, Pipeline};
use crate::rendering::{Rendering, Targets};
use crate::shader::Shader;
use crate::{Device, Error, layouts};

/// Finds how much of each pixel visible contour edges cover, as strokes of some pixels in width, and inks that.
/// Images of 5 bytes a pixel.
///
/// The lines are those of `drypoint-wgpu`'s `LinePass`, which tells how they are hidden; from compute
/// shaders or from mesh shaders, they are the same.
#[derive(Debug)]
pub struct Canvas {
    order: DepthOrder,
    depth_pass: DepthPass,
    mesh_pass: MeshPass,
    covering: Pipeline,
    inking: Pipeline,
    look: Look,
    images: Images,
}

/// What is as large as the picture.
#[derive(Debug)]
struct Images {
    size: [u32; 2],
    depth: Image,
    coverage: Image,
    /// What strokes of vertex shaders bind beside the look.
    target: Set,
    /// What strokes of mesh shaders bind with it.
    style: Set,
    /// What inking binds.
    covered: Set,
    fate: Fate,
}

/// What is drawn of one model: its contours, and the triangles that hide lines.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// Prepared, and extracted if compute shaders find them.
    pub contours: Found<'a>,
    /// Made for them.
    pub surface: &'a Surface,
}

const COVERAGE: vk::Format = vk::Format::R8_UNORM;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

impl Canvas {
    /// Of width and height in pixels, to be inked into color attachments of `format`.
    ///
    /// # Errors
    /// [`Error::PictureSize`] if the device allows no image of that size, [`Error::Format`] if it cannot draw to such
    /// images, or if it has not enough memory.
    pub fn new(
        commands: &mut Commands,
        size: [u32; 2],
        order: DepthOrder,
        format: vk::Format,
    ) -> Result<Self, Error> {
        let device = &commands.device().clone();
        Attached { color: format, depth: Some((DEPTH, order)) }.check(device, true)?;
        let look = Look::new(device, &layouts::stroke(device)?)?;
        Ok(Self {
            order,
            depth_pass: DepthPass::new(device, DEPTH, order)?,
            mesh_pass: MeshPass::strokes(device, &layouts::mesh_strokes(device)?, COVERAGE)?,
            covering: covering(device)?,
            inking: inking(device, format)?,
            images: Images::new(commands, size, (order, &look))?,
            look,
        })
    }

    /// Another width and height, in pixels.
    ///
    /// # Errors
    /// As [`Canvas::new`]; then it stays as it was.
    pub fn resize(&mut self, commands: &mut Commands, size: [u32; 2]) -> Result<(), Error> {
        commands.check(self.mesh_pass.device(), "the canvas")?;
        self.images = Images::new(commands, size, (self.order, &self.look))?;
        Ok(())
    }

    /// To make [`MeshContours`](crate::MeshContours) with that are drawn here.
    pub fn mesh_pass(&self) -> &MeshPass {
        &self.mesh_pass
    }

    /// Draws depths and strokes of `subjects` in place of what was there. Outside of rendering. The background of
    /// `view` is for whoever renders.
    ///
    /// # Errors
    /// If something is of another device, or was made in commands that were never executed; if contours were not
    /// prepared in these commands, or made for a pass with other workgroups; if a surface was made for other contours;
    /// or while shaders are counted. Nothing else is recorded then that could be inked.
    pub fn cover(
        &self,
        commands: &mut Commands,
        view: &View,
        subjects: &[Subject<'_>],
    ) -> Result<(), Error> {
        commands.check(self.mesh_pass.device(), "the canvas")?;
        let Images { size, depth, coverage, fate, .. } = &self.images;
        fate.check("the canvas")?;
        self.depth_pass.prepare(commands, view.scene_to_clip);
        self.look.record(commands, view.scene_to_clip, &view.lines);
        let undefined = vk::ImageLayout::UNDEFINED;
        let to_test = vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        let to_draw = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
        let to_read = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
        commands.transition(depth, (Use::SAMPLED, undefined), (Use::DEPTH_TESTED, to_test));
        let tested = Some((depth, DEPTH, self.order));
        let drawn = {
            let mut rendering =
                commands.render(&Targets { color: None, depth: tested, size: *size });
            subjects.iter().try_for_each(|Subject { contours, surface }| {
                self.depth_pass.record(&mut rendering, surface, *contours)
            })
        };
        commands.transition(depth, (Use::DEPTH_TESTED, to_test), (Use::SAMPLED, to_read));
        drawn?;
        commands.transition(coverage, (Use::SAMPLED, undefined), (Use::DRAWN_TO, to_draw));
        let color = Some((coverage, COVERAGE, [0.0; 4]));
        let drawn = {
            let mut rendering = commands.render(&Targets { color, depth: None, size: *size });
            let mut draw =
                |subject: &Subject<'_>| self.draw_strokes(&mut rendering, subject.contours);
            subjects.iter().try_for_each(&mut draw)
        };
        // Whatever was drawn, the image is for reading again.
        commands.transition(coverage, (Use::DRAWN_TO, to_draw), (Use::SAMPLED, to_read));
        drawn
    }

    fn draw_strokes(
        &self,
        rendering: &mut Rendering<'_>,
        contours: Found<'_>,
    ) -> Result<(), Error> {
        let Images { target, style, .. } = &self.images;
        match contours {
            Found::Mesh(contours) => self.mesh_pass.record_with(rendering, contours, style),
            Found::Compute(contours) => {
                contours.input.check(rendering.commands())?;
                let sets: [(&Set, &[u32]); 3] =
                    [(self.look.set(), &[]), (target, &[]), (&contours.segment_set, &[])];
                rendering.bind(&self.covering, "strokes", &sets)?;
                rendering.draw_indirect(contours.arguments(), Arguments::QUADS);
                Ok(())
            }
        }
    }

    /// Blends the color of the view's lines into what is rendered to, a color attachment as large as this and
    /// nothing else, by what [`Canvas::cover`] drew. Colors are multiplied by their alpha.
    ///
    /// # Errors
    /// If rendering is to something else, or of another device; if the canvas was made in commands that were never
    /// executed; or while mesh shaders are counted.
    pub fn ink(&self, rendering: &mut Rendering<'_>) -> Result<(), Error> {
        rendering.check(self.mesh_pass.device(), "the canvas")?;
        self.images.fate.check("the canvas")?;
        let sets: [(&Set, &[u32]); 2] = [(self.look.set(), &[]), (&self.images.covered, &[])];
        rendering.bind(&self.inking, "ink", &sets)?;
        rendering.draw(3);
        Ok(())
    }
}

impl Images {
    fn new(
        commands: &mut Commands,
        size: [u32; 2],
        (order, look): (DepthOrder, &Look),
    ) -> Result<Self, Error> {
        let device = &commands.device().clone();
        check_size(device, size)?;
        let usage = vk::ImageUsageFlags::SAMPLED;
        let attached = usage | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        let depth = Image::new(device, "depths", size, (DEPTH, attached))?;
        let attached = usage | vk::ImageUsageFlags::COLOR_ATTACHMENT;
        let coverage = Image::new(device, "the coverage of lines", size, (COVERAGE, attached))?;
        for image in [&depth, &coverage] {
            let undefined = (Use::ANYTHING, vk::ImageLayout::UNDEFINED);
            let to_read = (Use::SAMPLED, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
            commands.transition(image, undefined, to_read);
        }
        #[expect(clippy::cast_precision_loss, reason = "sides of images are exact in f32")]
        let pixels = Vec2::new(size[0] as f32, size[1] as f32);
        let raster = Raster { size: pixels, depth_sign: order.sign(), depth_step: 0.0 };
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let raster = commands.upload("a line target", bytemuck::bytes_of(&raster), usage)?;
        commands.barrier(Use::COPIED_TO, Use::READ_BY_DRAWING);
        let target = [Resource::Buffer(&raster), Resource::Image(&depth)];
        let style = [Resource::Buffer(look.buffer()), target[0], target[1]];
        let covered = [Resource::Image(&coverage)];
        let set =
            |layout: Layout, what, resources: &[Resource<'_>]| Set::new(&layout, what, resources);
        Ok(Self {
            size,
            target: set(layouts::line_target(device)?, "the bindings of a line target", &target)?,
            style: set(layouts::mesh_strokes(device)?, "the bindings of strokes", &style)?,
            covered: set(layouts::coverage(device)?, "the bindings of coverage", &covered)?,
            depth,
            coverage,
            fate: commands.fate().clone(),
        })
    }
}

/// Fails if the device allows no image of that size.
pub(crate) fn check_size(device: &Device, [width, height]: [u32; 2]) -> Result<(), Error> {
    let limits = device.limits();
    let limit = limits
        .max_image_dimension2_d
        .min(limits.max_framebuffer_width)
        .min(limits.max_framebuffer_height)
        .min(limits.max_viewport_dimensions[0])
        .min(limits.max_viewport_dimensions[1]);
    if [width, height].iter().all(|side| (1..=limit).contains(side)) {
        return Ok(());
    }
    Err(Error::PictureSize { width, height, limit })
}

fn covering(device: &Device) -> Result<Pipeline, Error> {
    let what = "strokes";
    let shader = Shader::new(device, what, LINES)?;
    let drawing = Drawing {
        what,
        stages: &[
            (vk::ShaderStageFlags::VERTEX, &shader, "stroke_vertex"),
            (vk::ShaderStageFlags::FRAGMENT, &shader, "stroke_coverage"),
        ],
        layouts: &[
            &layouts::stroke(device)?,
            &layouts::line_target(device)?,
            &layouts::segments(device)?,
        ],
        has_positions: false,
        topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
        formats: Formats { color: Some(COVERAGE), depth: None },
        blending: Blending::Larger,
        depth: None,
    };
    drawing.pipeline(device)
}

fn inking(device: &Device, format: vk::Format) -> Result<Pipeline, Error> {
    let what = "ink";
    let shader = Shader::new(device, what, INK)?;
    let drawing = Drawing {
        what,
        stages: &[
            (vk::ShaderStageFlags::VERTEX, &shader, "whole_screen"),
            (vk::ShaderStageFlags::FRAGMENT, &shader, "ink"),
        ],
        layouts: &[&layouts::stroke(device)?, &layouts::coverage(device)?],
        has_positions: false,
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        formats: Formats { color: Some(format), depth: None },
        blending: Blending::Over,
        depth: None,
    };
    drawing.pipeline(device)
}

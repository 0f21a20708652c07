//! Depths of the surfaces that hide lines.

use ash::vk;
use ash::vk::BufferUsageFlags as Usage;
use drypoint_mesh::Mesh;
use drypoint_shaders::{DEPTH, DepthOrder, Part, TrianglePart, Triangles};
use glam::Mat4;

use crate::barrier::Use;
use crate::binding::{Resource, Set};
use crate::commands::Commands;
use crate::contours::Contours;
use crate::execution::Fate;
use crate::input::Input;
use crate::look::{compare, uniform};
use crate::memory::Buffer;
use crate::mesh_contours::MeshContours;
use crate::model::Model;
use crate::pipeline::{Blending, Drawing, Formats, Pipeline};
use crate::rendering::Rendering;
use crate::shader::Shader;
use crate::{Device, Error, layouts};

/// Draws triangles to a depth attachment alone.
#[derive(Debug)]
pub(crate) struct DepthPass {
    pipeline: Pipeline,
    view: Buffer,
    view_set: Set,
}

/// The triangles of a model: 12 bytes each.
#[derive(Debug)]
pub struct Surface {
    model: Model,
    /// Of the contours that it was made for.
    transforms: Buffer,
    fate: Fate,
    indices: Buffer,
    set: Set,
    /// Where each part's uniform lies, and its indices.
    parts: Vec<TrianglePart>,
}

impl DepthPass {
    pub(crate) fn new(
        device: &Device,
        format: vk::Format,
        order: DepthOrder,
    ) -> Result<Self, Error> {
        let what = "depth";
        let shader = Shader::new(device, what, DEPTH)?;
        let view_layout = layouts::depth_view(device)?;
        let drawing = Drawing {
            what,
            stages: &[(vk::ShaderStageFlags::VERTEX, &shader, "place_vertex")],
            layouts: &[&view_layout, &layouts::surface(device)?],
            has_positions: true,
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            formats: Formats { color: None, depth: Some(format) },
            blending: Blending::Replace,
            depth: Some(compare(order)),
        };
        let pipeline = drawing.pipeline(device)?;
        let view = uniform(device, "a view", size_of::<Mat4>())?;
        let view_set =
            Set::new(&view_layout, "the bindings of a view", &[Resource::Buffer(&view)])?;
        Ok(Self { pipeline, view, view_set })
    }

    pub(crate) fn prepare(&self, commands: &mut Commands, scene_to_clip: Mat4) {
        commands.barrier(Use::ANYTHING, Use::COPIED_TO);
        commands.update(&self.view, bytemuck::bytes_of(&scene_to_clip));
        commands.barrier(Use::COPIED_TO, Use::READ_BY_DRAWING);
    }

    /// Draws `surface` wherever what it was made for is placed.
    pub(crate) fn record(
        &self,
        rendering: &mut Rendering<'_>,
        surface: &Surface,
        found: Found<'_>,
    ) -> Result<(), Error> {
        surface.fate.check("the surface")?;
        found.input().check(rendering.commands())?;
        if !surface.transforms.is(&found.input().transforms) {
            return Err(Error::OtherContours);
        }
        let instances = found.input().count() / surface.model.part_count();
        for TrianglePart { uniform, indices, .. } in &surface.parts {
            let offset = [*uniform];
            let sets: [(&Set, &[u32]); 2] = [(&self.view_set, &[]), (&surface.set, &offset)];
            rendering.bind(&self.pipeline, "the pass of depths", &sets)?;
            let range = (&surface.indices, indices.clone());
            rendering.draw_indexed(surface.model.positions(), range, instances);
        }
        Ok(())
    }
}

impl Surface {
    /// Records the upload of the triangles of `meshes`, those that the parts of the model of `found` were made
    /// from, in that order. Outside of rendering.
    ///
    /// # Errors
    /// [`Error::OtherMeshes`] if the model has not as many vertices, or if there is not enough memory.
    pub fn new<'a>(
        commands: &mut Commands,
        found: impl Into<Found<'a>>,
        meshes: &[&Mesh],
    ) -> Result<Self, Error> {
        let found = found.into();
        let model = found.model();
        commands.check(model.device(), "the model")?;
        if !model.is_of(meshes) {
            return Err(Error::OtherMeshes);
        }
        let alignment = commands.device().limits().min_uniform_buffer_offset_alignment;
        let alignment = usize::try_from(alignment).unwrap_or(256);
        let Triangles { indices, uniforms, parts } = Triangles::new(meshes, alignment);
        let what = "the triangles of a surface";
        let indices = commands.upload(what, bytemuck::cast_slice(&indices), Usage::INDEX_BUFFER)?;
        let uniforms =
            commands.upload("the parts of a surface", &uniforms, Usage::UNIFORM_BUFFER)?;
        commands.barrier(Use::COPIED_TO, Use::READ_BY_DRAWING);
        let part = Resource::Piece(&uniforms, size_of::<Part>() as u64);
        let resources = [part, Resource::Buffer(&found.input().transforms)];
        let layout = layouts::surface(model.device())?;
        let set = Set::new(&layout, "the bindings of a surface", &resources)?;
        let (model, transforms) = (model.clone(), found.input().transforms.clone());
        Ok(Self { model, transforms, fate: commands.fate().clone(), indices, set, parts })
    }
}

/// Contour edges found by compute shaders, or to be found by mesh shaders.
#[derive(Clone, Copy, Debug)]
pub enum Found<'a> {
    /// In an earlier pass.
    Compute(&'a Contours),
    /// When they are drawn.
    Mesh(&'a MeshContours),
}

impl<'a> Found<'a> {
    /// The model that is looked at.
    pub fn model(self) -> &'a Model {
        match self {
            Self::Compute(contours) => contours.model(),
            Self::Mesh(contours) => contours.model(),
        }
    }

    pub(crate) fn input(self) -> &'a Input {
        match self {
            Self::Compute(contours) => &contours.input,
            Self::Mesh(contours) => &contours.input,
        }
    }
}

impl<'a> From<&'a Contours> for Found<'a> {
    fn from(contours: &'a Contours) -> Self {
        Self::Compute(contours)
    }
}

impl<'a> From<&'a MeshContours> for Found<'a> {
    fn from(contours: &'a MeshContours) -> Self {
        Self::Mesh(contours)
    }
}

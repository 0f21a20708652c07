//! Depths of the surfaces that hide lines.

use drypoint_mesh::Mesh;
use drypoint_mesh::rig::Skin;
use drypoint_shaders::{DEPTH, DepthOrder, Part, TrianglePart, Triangles};
use glam::Mat4;
use wgpu::BufferUsages;

use crate::Error;
use crate::bindings::{READ, bind, layout, uniform};
use crate::contours::Contours;
use crate::device::{buffer, checked, filled};
use crate::found::Found;
use crate::raster::{Drawing, compare};
use crate::rig_contours::RigContours;
use crate::staging::Staging;

const DRAWING: wgpu::ShaderStages = wgpu::ShaderStages::VERTEX_FRAGMENT;

/// Draws [`Surface`]s into a depth texture, for renderers that have no depth of their own.
#[derive(Debug)]
pub struct DepthPass {
    device: wgpu::Device,
    surface_layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    view: wgpu::Buffer,
    view_bindings: wgpu::BindGroup,
    staging: Staging,
}

impl DepthPass {
    /// For depth textures of `format` with one sample a pixel, in render passes without color.
    ///
    /// # Errors
    /// If the device refuses the format or the shader.
    pub fn new(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        order: DepthOrder,
    ) -> Result<Self, Error> {
        let size = size_of::<Mat4>() as u64;
        let view = buffer(device, "a view", size, BufferUsages::UNIFORM | BufferUsages::COPY_DST)?;
        let (view_layout, surface_layout, pipeline) =
            checked(device, "the shaders of depth", || Self::build(device, format, order))?;
        let resources = vec![view.as_entire_binding()];
        Ok(Self {
            view_bindings: bind(device, "the bindings of a view", &view_layout, resources)?,
            staging: Staging::new(device, size)?,
            device: device.clone(),
            surface_layout,
            pipeline,
            view,
        })
    }

    fn build(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        order: DepthOrder,
    ) -> (wgpu::BindGroupLayout, wgpu::BindGroupLayout, wgpu::RenderPipeline) {
        let view_layout = layout(device, "a view", DRAWING, &[uniform::<Mat4>(false)]);
        let surface_layout = layout(device, "a surface", DRAWING, &[uniform::<Part>(true), READ]);
        let attribute = wgpu::VertexAttribute {
            format: wgpu::VertexFormat::Float32x3,
            offset: 0,
            shader_location: 0,
        };
        let drawing = Drawing {
            label: "drypoint depth",
            source: DEPTH,
            layouts: &[Some(&view_layout), Some(&surface_layout)],
            vertex: "place_vertex",
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &[attribute],
            })],
            topology: wgpu::PrimitiveTopology::TriangleList,
            depth: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(compare(order)),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            fragment: None,
            sample_count: 1,
        };
        let pipeline = drawing.pipeline(device);
        (view_layout, surface_layout, pipeline)
    }

    /// Takes the matrix from the space of the scene to clip space, where z runs from 0 to w, for what is
    /// recorded into `encoder` from here on. Perspective or orthographic.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        scene_to_clip: Mat4,
    ) -> Result<(), Error> {
        let bytes = bytemuck::bytes_of(&scene_to_clip);
        self.staging.write(&self.device, encoder, &self.view, [(0, bytes)])
    }

    /// Draws all that `contours`, which `surface` was made for, was prepared with. One draw for each part.
    ///
    /// Of a rig, one for each shape, and one for each instance that has faces that bend.
    pub fn record<'a>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        surface: &Surface,
        contours: impl Into<Found<'a>>,
    ) {
        let Found { positions, instances, posed: [first_vertex, vertex_count], .. } =
            contours.into();
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.view_bindings, &[]);
        pass.set_vertex_buffer(0, positions.slice(..));
        pass.set_index_buffer(surface.indices.slice(..), wgpu::IndexFormat::Uint32);
        for TrianglePart { uniform, indices, copies } in &surface.parts {
            pass.set_bind_group(1, &surface.bindings, &[*uniform]);
            if let Some(copies) = copies {
                pass.draw_indexed(indices.clone(), 0, 0..instances * copies);
                continue;
            }
            for instance in 0..instances {
                #[expect(
                    clippy::cast_possible_wrap,
                    reason = "vertices fit a binding, 12 bytes each"
                )]
                let base = (first_vertex + instance * vertex_count) as i32;
                pass.draw_indexed(indices.clone(), base, instance..instance + 1);
            }
        }
    }
}

/// The triangles of the model that [`Contours`] or [`RigContours`] look at: 12 bytes each.
#[derive(Debug)]
pub struct Surface {
    indices: wgpu::Buffer,
    bindings: wgpu::BindGroup,
    parts: Vec<TrianglePart>,
}

impl Surface {
    /// Uploads the triangles of `meshes`, those that the parts of the model were made from, in that order.
    ///
    /// # Errors
    /// [`Error::OtherMeshes`] if the model has not as many vertices, or if the GPU has not enough memory.
    pub fn new(pass: &DepthPass, contours: &Contours, meshes: &[&Mesh]) -> Result<Self, Error> {
        let (device, model) = (&pass.device, contours.model());
        if !model.is_of(meshes) {
            return Err(Error::OtherMeshes);
        }
        let alignment = device.limits().min_uniform_buffer_offset_alignment as usize;
        let triangles = Triangles::new(meshes, alignment);
        Self::upload(pass, triangles, contours.transforms())
    }

    /// Uploads the triangles of a rig that `contours` look at: those of each shape once, and those that bend,
    /// which are posed by what finds contours. `skin` is what the model was made of.
    ///
    /// # Errors
    /// As [`Surface::new`].
    pub fn of_rig(pass: &DepthPass, contours: &RigContours, skin: &Skin) -> Result<Self, Error> {
        let alignment = pass.device.limits().min_uniform_buffer_offset_alignment as usize;
        let uploaded = &*contours.model().uploaded;
        let (layout, bending) = (&uploaded.layout, &uploaded.bending_faces[..]);
        let most_instances = contours.capacity().instances;
        let triangles = Triangles::of_rig((layout, bending), skin, most_instances, alignment);
        Self::upload(pass, triangles.ok_or(Error::OtherMeshes)?, contours.transforms())
    }

    fn upload(
        pass: &DepthPass,
        Triangles { indices, uniforms, parts }: Triangles,
        transforms: wgpu::BufferBinding<'_>,
    ) -> Result<Self, Error> {
        let device = &pass.device;
        let uniforms = filled(device, "the parts of a surface", &uniforms, BufferUsages::UNIFORM)?;
        let size = wgpu::BufferSize::new(size_of::<Part>() as u64);
        let part = wgpu::BufferBinding { buffer: &uniforms, offset: 0, size };
        let resources =
            vec![wgpu::BindingResource::Buffer(part), wgpu::BindingResource::Buffer(transforms)];
        let layout = &pass.surface_layout;
        Ok(Self {
            bindings: bind(device, "the bindings of a surface", layout, resources)?,
            indices: filled(device, "the triangles of a surface", &indices, BufferUsages::INDEX)?,
            parts,
        })
    }
}
